"""The velocity at which half of the rods lose a third of their length, with its interval.

    python -m problems.cth_nose_shape.transitions [FILE]

prints the table of `transition.toml` in Markdown, from the rows that its searches keep in results/transition.csv.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import hydro2d
from problems.kept import grouped

HERE = Path(__file__).parent
FILE = HERE / "results" / "transition.csv"
#: what tells one search from another
CASE = ("nose", "cells_across", "law", "plate")
#: velocities of the experiments between which the change lies, m/s: the fastest rod that stayed rigid, the next that eroded
EXPERIMENTS = {("hemispherical", "5083"): "1086 to 1200 m/s", ("hemispherical", "7039"): "1038 to 1165 m/s",
               ("ogival", "5083"): "above 1227 m/s", ("ogival", "7039"): "above 1291 m/s"}
HEAD = ("nose", "cells", "law", "plate", "experiments", "half of the rods", "90 % interval",
        "fastest that kept, slowest that lost", "runs")

Rows = list[hydro2d.KeptRow]


def velocity(row: hydro2d.KeptRow) -> float:
    """m/s"""
    return hydro2d.to_si(row["velocity"], "m/s")


def kept(row: hydro2d.KeptRow) -> bool:
    """Whether the rod of a row has kept two thirds of its length."""
    return float(row["length_ratio"]) >= hydro2d.LEAST_KEPT_LENGTH


def searches(rows: Rows) -> dict[tuple[str, ...], Rows]:
    """The finished runs of every search, the slowest first: those of the newest method of which the search has some."""
    cases = grouped((row for row in rows if row["status"] == "done"), CASE)
    newest = {case: max(row["method"] for row in members) for case, members in cases.items()}
    return {case: sorted((row for row in members if row["method"] == newest[case]), key=velocity)
            for case, members in cases.items()}


def fitted(rows: Rows):
    """v50 and the width of the change, from the rows of one search. Raises ValueError where they do not tell."""
    fit = hydro2d.fit_transition([velocity(row) for row in rows], [not kept(row) for row in rows])
    if fit is None:
        raise ValueError("the runs do not tell the velocity of the change")
    return fit


def _said(rows: Rows) -> tuple[str, str, str]:
    """v50, its interval, and the runs on both sides; where all runs end alike, which bound they give."""
    held, lost = ([f"{velocity(row):.0f}" for row in rows if kept(row) == side] for side in (True, False))
    if not (held and lost):
        return (f"above {held[-1]} m/s" if held else f"below {lost[0]} m/s"), "", ""
    try:
        fit = fitted(rows)
    except ValueError:
        return "not known", "", f"{held[-1]}, {lost[0]} m/s"
    ends = " to ".join("open" if end is None else f"{end:.0f}" for end in (fit.v50_low, fit.v50_high))
    return f"{fit.v50:.0f} m/s", f"{ends} m/s", f"{held[-1]}, {lost[0]} m/s"


def table(rows: Rows) -> list[str]:
    """Lines of Markdown: a row for each search, and what must be said of runs of other versions of the method."""
    lines = [f"| {' | '.join(HEAD)} |", "|---" * len(HEAD) + "|"]
    shown = searches(rows)
    for (nose, cells, law, plate), members in shown.items():
        half, interval, sides = _said(members)
        lines.append(f"| {nose} | {cells} | {law} | {plate} | {EXPERIMENTS[nose, plate]} | {half} | {interval} | {sides} "
                     f"| {len(members)} |")
    note = hydro2d.method_note(row["method"] for members in shown.values() for row in members)
    return [*lines, "", note] if note else lines


def main(arguments: list[str]) -> int:
    """Prints the table. Returns the exit status."""
    parser = argparse.ArgumentParser(prog="transitions", description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path, nargs="?", default=FILE, help="rows of a search; default: those that are kept")
    try:
        print("\n".join(table(hydro2d.kept_rows(parser.parse_args(arguments).file))))
    except (hydro2d.Error, OSError) as problem:
        print(problem, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
