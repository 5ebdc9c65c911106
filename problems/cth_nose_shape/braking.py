"""The force that brakes a rod in its first 90 us, and its effect on the rod, from `first_90us.toml` and `nose_force.toml`.

    python -m problems.cth_nose_shape.braking [STUDY ...]

prints the tables of both studies in Markdown, from what is kept of them in `results`. With directories of these studies it
first writes their finished cases to the files that are kept. A file has the labels of a case, its number as a member, and

    force_GPa             what brakes the rod: its loss of momentum from 40 to 85 us, over its first section
    length_mm, radius_mm  of the rod at 90 us; the radius is its largest
    axial_GPa             -sigma_zz, the mean over the section from 5 to 10 mm behind the tip, at 90 us
    lateral_GPa           -(sigma_rr + sigma_tt)/2 there: by the balance of forces the pressure on the flank
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import numpy as np

import hydro2d
from problems import kept as results

HERE = Path(__file__).parent
MEASURED = ("force_GPa", "length_mm", "radius_mm", "axial_GPa", "lateral_GPa")
#: the labels of the cases of each study
STUDIES = {"first_90us": ("rod", "cells"), "nose_force": ("plate", "velocity")}
#: time over which the force is taken, s, and part of the rod behind its tip over which stresses are, m
FORCE_FROM, FORCE_TO = 40e-6, 85e-6
NEAR, FAR = 5e-3, 10e-3


def section(r_edges, z_edges, fraction, axial, lateral) -> tuple[float, float]:
    """Means of two stresses over the section of a rod, from NEAR to FAR behind its tip.

    r_edges, z_edges : m;  fraction : of the rod, float64[j, i];  axial, lateral : Pa, float64[j, i]

    The tip is the foremost cell on the axis that is at least half full. Raises ValueError where there is none.
    """
    full = np.flatnonzero(fraction[:, 0] >= 0.5)
    if full.size == 0:
        raise ValueError("there is no rod on the axis")
    centres = 0.5 * (z_edges[1:] + z_edges[:-1])
    behind = z_edges[full[-1] + 1] - centres
    here = (behind >= NEAR) & (behind <= FAR)
    weights = (fraction * np.diff(np.square(r_edges)) * np.diff(z_edges)[:, None])[here]
    return tuple(float((each[here] * weights).sum() / weights.sum()) for each in (axial, lateral))


def measure(directory: Path) -> dict[str, str]:
    """The values of MEASURED of a run. Raises ValueError for one that ends too early, hydro2d.Error."""
    run = hydro2d.open_run(directory)
    history, time = run.history, run.history["time"]
    if time[-1] < FORCE_TO:
        raise ValueError(f"{directory}: ends at {1e6 * time[-1]:.0f} us")
    before, after = np.interp([FORCE_FROM, FORCE_TO], time, history["body_rod_momentum_N_s"])
    force = (before - after) / (FORCE_TO - FORCE_FROM) / (math.pi * run.deck.body_named("rod").rod_radius ** 2)
    dump = run.dump(float(time[-1]))
    pressure = dump.fields["Pressure [Pa]"]
    rr, zz, tt = (dump.fields[f"Deviatoric Stress {each} [Pa]"] for each in ("rr", "zz", "tt"))
    axial, lateral = section(np.asarray(dump.r_edges), np.asarray(dump.z_edges), dump.fields["Volume Fraction for rod"],
                             pressure - zz, pressure - 0.5 * (rr + tt))
    told = (f"{1e-9 * force:.3f}", f"{1e3 * history['rod_length_m'][-1]:.2f}", f"{1e3 * history['rod_max_radius_m'][-1]:.3f}",
            f"{1e-9 * axial:.2f}", f"{1e-9 * lateral:.2f}")
    return dict(zip(MEASURED, told, strict=True))


def columns(study: str) -> tuple[str, ...]:
    """The columns of the file that is kept of a study."""
    return (*STUDIES[study], "member", *MEASURED)


def file(study: str) -> Path:
    """Where a study is kept."""
    return HERE / "results" / f"{study}.csv"


def kept(study: str) -> list[dict[str, str]]:
    """The rows that are kept of a study. Raises StudyError, OSError."""
    return results.rows(file(study), columns(study))


def keep(directory: Path) -> None:
    """Writes the finished cases of a study to its file. Raises StudyError, OSError, and what `measure` raises."""
    cases = [case for case in hydro2d.open_study(directory).cases if case.status == "done"]
    study = next((name for name, labels in STUDIES.items() if cases and tuple(cases[0].values) == labels), None)
    if study is None:
        raise hydro2d.StudyError(f"{directory}: no finished case of {' or '.join(STUDIES)}")
    results.write(file(study), columns(study),
                  [{**case.values, "member": case.member, **measure(case.directory)} for case in cases])


def rods(rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: a row for each rod and mesh."""
    lines = ["| rod | cells | runs | force, GPa | length, mm | largest radius, mm | axial, GPa | flank, GPa |",
             "|---|---|---|---|---|---|---|---|"]
    for rod, cells in dict.fromkeys((row["rod"], row["cells"]) for row in rows):
        members = [row for row in rows if (row["rod"], row["cells"]) == (rod, cells)]
        numbers = " | ".join(results.told(members, column) for column in MEASURED)
        lines.append(f"| {rod} | {cells} | {len(members)} | {numbers} |")
    return lines


def forces(rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: for each plate the force, the pressure on the flank and their difference at each velocity."""
    velocities = list(dict.fromkeys(row["velocity"] for row in rows))
    lines = ["| GPa | " + " | ".join(velocities) + " |", "|---" * (len(velocities) + 1) + "|"]
    for plate in dict.fromkeys(row["plate"] for row in rows):
        here = {row["velocity"]: row for row in rows if row["plate"] == plate}
        force, flank = ({at: float(row[name]) for at, row in here.items()} for name in ("force_GPa", "lateral_GPa"))
        left = {at: force[at] - flank[at] for at in here}
        for word, found in (("force over the section", force), ("pressure on the flank", flank), ("difference", left)):
            cells = [f"{found[at]:.2f}" if at in found else "" for at in velocities]
            lines.append(f"| {plate}, {word} | " + " | ".join(cells) + " |")
    return lines


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="*", type=Path, metavar="STUDY")
    given = parser.parse_args(arguments)
    try:
        for directory in given.studies:
            keep(directory)
        print("\n".join([*rods(kept("first_90us")), "", *forces(kept("nose_force"))]))
    except (hydro2d.Error, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
