"""What becomes of rods of several strengths in their first 90 us, from `first_90us.toml`.

    python -m problems.cth_nose_shape.first_90us RUN [RUN ...]

prints a row for every run directory, as they are kept in `results/first_90us.csv`:

    rod, cells, member    the case
    force_GPa             what brakes the rod: its loss of momentum from 40 to 85 us, over its first section
    length_mm, radius_mm  of the rod at 90 us; the radius is its largest
    axial_GPa             -sigma_zz, the mean over the section from 5 to 10 mm behind the tip, at 90 us
    lateral_GPa           -(sigma_rr + sigma_tt)/2 there: by the balance of forces the pressure on the flank
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from statistics import median

import numpy as np

from hydro2d.deck import mesh as meshes
from hydro2d.results import reading
from problems import kept as results

KEPT = Path(__file__).parent / "results" / "first_90us.csv"
COLUMNS = ("rod", "cells", "member", "force_GPa", "length_mm", "radius_mm", "axial_GPa", "lateral_GPa")
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


def of_run(directory: Path) -> tuple:
    """The row of a run, in the order of COLUMNS. Raises ValueError for a run that has no such times."""
    run = reading.Results(directory)
    history, time = run.history, run.history["time"]
    if time[-1] < FORCE_TO:
        raise ValueError(f"ends at {1e6 * time[-1]:.0f} us")
    braked = np.interp([FORCE_FROM, FORCE_TO], time, history["body_rod_momentum_N_s"])
    force = -(braked[1] - braked[0]) / (FORCE_TO - FORCE_FROM) / (math.pi * meshes.body_radius(run.deck, "rod") ** 2)
    dump = run.dump(float(time[-1]))
    fields = dump.fields
    pressure = fields["Pressure [Pa]"]
    rr, zz, tt = (fields[f"Deviatoric Stress {each} [Pa]"] for each in ("rr", "zz", "tt"))
    axial, lateral = section(np.asarray(dump.r_edges), np.asarray(dump.z_edges), fields["Volume Fraction for rod"],
                             pressure - zz, pressure - 0.5 * (rr + tt))  # fmt: skip
    return (*_case(directory.name), f"{1e-9 * force:.3f}", f"{1e3 * history['rod_length_m'][-1]:.2f}",
            f"{1e3 * history['rod_max_radius_m'][-1]:.3f}", f"{1e-9 * axial:.2f}", f"{1e-9 * lateral:.2f}")


def _case(name: str) -> tuple[str, str, int]:
    """Rod, cells and number of the member from the name of a case."""
    rod, cells, *member = name.split("_")
    return rod, cells, int(member[0][1:]) if member else 0


def kept() -> list[dict[str, str]]:
    """The rows of results/first_90us.csv."""
    return results.rows(KEPT, COLUMNS)


def told(rows: list[dict[str, str]], column: str) -> str:
    """The median of a column, and with several members the least and the largest."""
    found = sorted((row[column] for row in rows), key=float)
    middle = median(map(float, found))
    digits = len(found[0].split(".")[1])
    return f"{middle:.{digits}f}" + (f" ({found[0]} to {found[-1]})" if found[0] != found[-1] else "")


def table(rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: a row for each rod and mesh."""
    lines = ["| rod | cells | runs | force, GPa | length, mm | largest radius, mm | axial, GPa | flank, GPa |",
             "|---|---|---|---|---|---|---|---|"]  # fmt: skip
    for rod, cells in dict.fromkeys((row["rod"], row["cells"]) for row in rows):
        members = [row for row in rows if (row["rod"], row["cells"]) == (rod, cells)]
        numbers = " | ".join(told(members, column) for column in COLUMNS[3:])
        lines.append(f"| {rod} | {cells} | {len(members)} | {numbers} |")
    return lines


def main(arguments: list[str]) -> int:
    """Prints the rows of the runs as CSV."""
    results.show(COLUMNS, of_run, arguments)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
