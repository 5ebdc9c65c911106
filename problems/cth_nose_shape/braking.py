"""The force that brakes a rod in its first 90 us, and its effect on the rod, from `nose_force.toml`.

    python -m problems.cth_nose_shape.braking [STUDY]

prints the table of the study in Markdown, from what is kept of it in `results`. With a directory of the study it first writes
its finished cases to the file that is kept. The file has the labels of a case, its number as a member, the version of the
method, and

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
#: what is kept, and its columns
FILE = HERE / "results" / "nose_force.csv"
LABELS = ("nose", "plate", "velocity")
COLUMNS = (*LABELS, "member", *MEASURED, "method")
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
    """The values of MEASURED of a run, and the version of its method.

    Raises ValueError for a run that ends too early, hydro2d.Error.
    """
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
    return dict(zip(MEASURED, told, strict=True)) | {"method": run.summary.method}


def kept() -> list[dict[str, str]]:
    """The rows that are kept. Raises StudyError, OSError."""
    return results.rows(FILE, COLUMNS)


def keep(directory: Path) -> None:
    """Writes the finished cases of the study to its file. Raises StudyError, OSError, and what `measure` raises."""
    cases = [case for case in hydro2d.open_study(directory).cases if case.status == "done"]
    if not cases or tuple(cases[0].values) != LABELS:
        raise hydro2d.StudyError(f"{directory}: no finished case of nose_force.toml")
    results.write(FILE, COLUMNS, [{**case.values, "member": case.member, **measure(case.directory)} for case in cases])


def forces(rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: the force on each nose in each plate against the velocity."""
    velocities = list(dict.fromkeys(row["velocity"] for row in rows))
    lines = ["| force over the section, GPa | " + " | ".join(velocities) + " |", "|---" * (len(velocities) + 1) + "|"]
    for nose, plate in dict.fromkeys((row["nose"], row["plate"]) for row in rows):
        found = {row["velocity"]: float(row["force_GPa"]) for row in rows if (row["nose"], row["plate"]) == (nose, plate)}
        cells = [f"{found[at]:.2f}" if at in found else "" for at in velocities]
        lines.append(f"| {nose} nose, {plate} | " + " | ".join(cells) + " |")
    note = hydro2d.method_note(row["method"] for row in rows)
    return [*lines, "", note] if note else lines


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", nargs="?", type=Path)
    given = parser.parse_args(arguments)
    try:
        if given.study:
            keep(given.study)
        print("\n".join(forces(kept())))
    except (hydro2d.Error, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
