"""The velocity at which half of the hemispherical rods lose a third of their length, with its interval.

    python -m problems.cth_nose_shape.transitions [STUDY ...]

prints the table of `transition_members.toml` and `transition_members_weaker.toml` in Markdown, from results/transitions.csv.
With the directories of these searches it first writes what has been found there to that file: for each finished run the labels
of its case, its velocity, the share of the rod's length that is left at the end, and the depth.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from hydro2d.mesh.regime import LEAST_KEPT
from hydro2d.study import layout, logit, velocities
from hydro2d.study.layout import StudyError
from problems import kept as results

HERE = Path(__file__).parent
FILE = HERE / "results" / "transitions.csv"
COLUMNS = ("law", "plate", "velocity_m_s", "length_left", "depth_cm")
#: velocities of the experiments between which the change lies, m/s: the fastest rod that stayed rigid, the next that eroded
EXPERIMENTS = {"5083": (1086.0, 1200.0), "7039": (1038.0, 1165.0)}


def of_case(case: layout.Case) -> dict[str, str]:
    """The row of a finished case."""
    told = case.summary
    return {
        "law": case.values["law"], "plate": case.values["plate"],
        "velocity_m_s": f"{velocities.speed(case.values[velocities.AXIS]):g}",
        "length_left": f"{told['rod_length_m'] / told['rod_initial_length_m']:.3f}",
        "depth_cm": f"{1e2 * told['penetration_depth_m']:.2f}",
    }  # fmt: skip


def kept(row: dict[str, str]) -> bool:
    """Whether the rod of a row has kept two thirds of its length."""
    return float(row["length_left"]) >= LEAST_KEPT


def grouped(rows: list[dict[str, str]]) -> dict[tuple[str, ...], list[dict[str, str]]]:
    """Rows by law and plate, the slowest first."""
    found = results.grouped(rows, ("law", "plate"))
    return {case: sorted(members, key=lambda row: float(row["velocity_m_s"])) for case, members in found.items()}


def found(rows: list[dict[str, str]]) -> logit.Fit:
    """v50 and the width of the change from the rows of one law and plate. Raises ValueError where they do not tell."""
    fit = logit.fit([float(row["velocity_m_s"]) for row in rows], [not kept(row) for row in rows])
    if fit is None:
        raise ValueError("the runs do not tell the velocity of the change")
    return fit


def table(rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: a row for each law and plate."""
    lines = ["| law | plate | experiments | half of the rods | 90 % interval | fastest that kept, slowest that lost | runs |",
             "|---|---|---|---|---|---|---|"]  # fmt: skip
    for (law, plate), members in grouped(rows).items():
        fit = found(members)
        low, high = EXPERIMENTS[plate]
        fastest = max(float(row["velocity_m_s"]) for row in members if kept(row))
        slowest = min(float(row["velocity_m_s"]) for row in members if not kept(row))
        ends = " to ".join("open" if end is None else f"{end:.0f}" for end in (fit.v50_low, fit.v50_high))
        lines.append(f"| {law} | {plate} | {low:.0f} to {high:.0f} m/s | {fit.v50:.0f} m/s | {ends} m/s "
                     f"| {fastest:.0f}, {slowest:.0f} m/s | {len(members)} |")  # fmt: skip
    return lines


def main(arguments: list[str]) -> int:
    """Prints the table. Returns the exit status."""
    parser = argparse.ArgumentParser(prog="transitions", description=__doc__.splitlines()[0])
    parser.add_argument("studies", type=Path, nargs="*", metavar="STUDY", help="directory of a search, to be kept")
    studies = parser.parse_args(arguments).studies
    try:
        if studies:
            cases = [case for study in studies for case in layout.read(study).cases if case.status == layout.DONE]
            results.write(FILE, COLUMNS, map(of_case, cases))
        print("\n".join(table(results.rows(FILE, COLUMNS))))
    except (StudyError, OSError) as problem:
        print(problem, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
