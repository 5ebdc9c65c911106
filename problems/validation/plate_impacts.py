"""Free-surface velocities of plate impacts of 5083 aluminium beside the measured records.

    python -m problems.validation.plate_impacts [STUDY_DIRECTORY] [--check]

prints a row for every run of plate_impacts_5083.toml, as results/plate_impacts.csv keeps them. Without a directory, the table
of README.md is filled from the kept rows; with --check, only compared. `draw` makes the picture of how-to/free-surface-velocity
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

import hydro2d
from problems import kept as results
from problems.spall import read

HERE = Path(__file__).parent
KEPT, RECORDS = HERE / "results" / "plate_impacts.csv", HERE / "plate_impacts_5083.csv"
#: velocity at which a record begins, m/s; time after that at which the elastic front is over, us
START, FRONT = 20.0, 0.03
#: times between which the median is the plateau, us; share of it below which the release has come
PLATEAU, RELEASED = (0.5, 0.9), 0.95
#: share of the time between the fronts at which the ramp is read
RAMP = 0.7


@dataclass(frozen=True)
class Features:
    """Numbers of a free-surface velocity: velocities in m/s, times in us after the elastic front.

    front : velocity behind the elastic front;  ramp : further rise before the plastic front;  delay : of the plastic front,
    where half of it is reached;  rise : of the plastic front from a quarter to three quarters;  plateau;  release : its end;
    pull_back : from the plateau to the first lowest velocity after it
    """

    front: float
    ramp: float
    delay: float
    rise: float
    plateau: float
    release: float
    pull_back: float


COLUMNS = ("shot", "law", *(each.name for each in fields(Features)), "method")


def begun(time: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Times after the elastic front, where the velocity is START."""
    return time - crossed(time, velocity, START)


def crossed(time: np.ndarray, velocity: np.ndarray, level: float) -> float:
    """The first time at which a velocity reaches a level. Raises ValueError if it never does."""
    above = np.flatnonzero(velocity >= level)
    if above.size == 0 or above[0] == 0:
        raise ValueError(f"the velocity does not rise through {level:.4g} m/s")
    k = int(above[0])
    return float(np.interp(level, velocity[k - 1:k + 1], time[k - 1:k + 1]))


def features(time: np.ndarray, velocity: np.ndarray) -> Features:
    """The numbers of a record. time : us;  velocity : m/s. Raises ValueError for a record without both fronts and a release."""
    since = begun(time, velocity)
    front = float(np.interp(FRONT, since, velocity))
    grid = np.linspace(*PLATEAU, 101)
    plateau = float(np.median(np.interp(grid, since, velocity)))
    low, delay, high = (crossed(since, velocity, front + share * (plateau - front)) for share in (0.25, 0.5, 0.75))
    after = since > PLATEAU[1]
    fallen = np.flatnonzero(velocity[after] < RELEASED * plateau)
    if fallen.size == 0:
        raise ValueError("the record ends before the release")
    k = int(np.flatnonzero(after)[0] + fallen[0])
    release = float(np.interp(-RELEASED * plateau, -velocity[k - 1:k + 1], since[k - 1:k + 1]))
    ramp = float(np.interp(RAMP * delay, since, velocity)) - front
    return Features(front, ramp, delay, high - low, plateau, release, plateau - read.pull_back(velocity)[1])


def records() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """The measured records by shot: time in us after the elastic front, velocity in m/s."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in results.rows(RECORDS, ("shot", "time_us", "velocity_m_s")):
        found.setdefault(row["shot"], []).append((float(row["time_us"]), float(row["velocity_m_s"])))
    return {shot: (np.array(points)[:, 0], np.array(points)[:, 1]) for shot, points in found.items()}


def of_run(run: hydro2d.Run) -> tuple[np.ndarray, np.ndarray]:
    """Time in us and velocity of the tracer at the rear in m/s, of a run."""
    velocity = run.to_pandas()["tracer_rear_velocity_z_m_s"]
    return velocity.index.to_numpy() * 1e6, velocity.to_numpy()


def rows_of(directory: Path) -> list[tuple]:
    """A row for every finished case of a study directory, in the order of COLUMNS; cases without its numbers are named."""
    found = []
    for case in hydro2d.open_study(directory).cases:
        if case.status == "done":
            run = hydro2d.open_run(case.directory)
            try:
                numbers = [f"{value:.4g}" for value in astuple(features(*of_run(run)))]
            except ValueError as problem:
                print(f"{case.name}: {problem}", file=sys.stderr)
                continue
            found.append((case.values["shot"], case.values["law"], *numbers, run.summary.method))
    return found


def table() -> list[str]:
    """The kept rows beside the records, as lines of the README's table."""
    kept = results.rows(KEPT, COLUMNS)
    lines = ["| shot | law | elastic front | ramp | delay | rise | plateau | release | pull-back |",
             "|---|---|---|---|---|---|---|---|---|"]
    for shot, record in records().items():
        measured = features(*record)
        lines.append(f"| {shot} | **measured** | " + " | ".join(_told(measured)) + " |")
        for row in kept:
            if row["shot"] == shot:
                found = Features(*(float(row[each.name]) for each in fields(Features)))
                lines.append(f"| | {row['law']} | " + " | ".join(_told(found)) + " |")
    return lines


def _told(each: Features) -> list[str]:
    return [f"{each.front:.0f} m/s", f"{each.ramp:.0f} m/s", f"{each.delay:.3f} us", f"{1e3 * each.rise:.0f} ns",
            f"{each.plateau:.0f} m/s", f"{each.release:.2f} us", f"{each.pull_back:.0f} m/s"]


def draw(directory: Path | str, file: Path | str) -> None:
    """A figure of the records and of the runs of a study directory, by shot; runs that no front has left are not in it."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(12.0, 3.8), layout="constrained")
    cases = [case for case in hydro2d.open_study(directory).cases if case.status == "done"]
    for place, (shot, (time, velocity)) in zip(axes, records().items(), strict=True):
        for case in cases:
            if case.values["shot"] == shot:
                mine, rear = of_run(hydro2d.open_run(case.directory))
                if rear.max() > START:
                    place.plot(begun(mine, rear), rear, linewidth=1.0, label=case.values["law"])
        place.plot(time, velocity, color="black", linewidth=1.4, label="measured")
        place.set(xlim=(-0.05, 2.1), title=shot, xlabel="time after the elastic front [us]")
    axes[0].set_ylabel("velocity of the rear [m/s]")
    axes[0].legend(fontsize=7)
    figure.savefig(file, dpi=110)
    plt.close(figure)


def main(arguments: Sequence[str] | None = None) -> int:
    """Prints the rows of a study directory as CSV, or fills the table of the README. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", nargs="?", type=Path, help="a study directory")
    parser.add_argument("--check", action="store_true", help="write nothing; status 1 if the page has another table")
    given = parser.parse_args(arguments)
    if given.study is None:
        return results.fill([HERE / "README.md"], {"plate_impacts": table}, given.check)
    results.write_to(sys.stdout, COLUMNS, (dict(zip(COLUMNS, row, strict=True)) for row in rows_of(given.study)))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
