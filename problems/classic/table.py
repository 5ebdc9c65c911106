"""The classic shots with every advection and every sliding: a table, and the results that are kept next to the studies.

    python -m problems.classic.table RESULTS [RESULTS ...] [--keep FILE]

RESULTS is the directory of a study, finished or not, or a file in `results`. A cell of the table has the number by which a shot
is judged and the energy that the remap of velocities discarded or clipped, in per cent of the energy at the start. If a run
became unphysical, the cell says when and why. `--keep` writes all cases into a CSV file, in the order in which they were given.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import hydro2d
from problems import kept

ADVECTION = ("ke", "momentum", "both")


@dataclass(frozen=True)
class Measure:
    """The number by which a shot is judged: its name, unit, digits and expected value, and the function that reads it."""

    name: str
    unit: str
    digits: int
    expected: str
    of: Callable[[hydro2d.Results], float | None]


def _crater(run: hydro2d.Results) -> float:
    return 1e3 * run.summary.crater.depth_m


def _body(name: str, key: str, factor: float) -> Callable[[hydro2d.Results], float]:
    return lambda run: factor * run.summary.bodies[name][key]


def _pull_back(run: hydro2d.Results) -> float:
    """Fall of the rear's velocity from its peak to the least value in the microsecond after."""
    time, velocity = run.history["time"], run.history["tracer_rear_velocity_z_m_s"]
    peak = velocity.argmax()
    after = (time >= time[peak]) & (time <= time[peak] + 1e-6)
    return float(velocity[peak] - velocity[after].min())


MEASURES = {
    "crater": Measure("depth of the crater", "mm", 1, "13 or a little more", _crater),
    "taylor_bar": Measure("length of the bar", "mm", 2, "17.38", _body("bar", "z_max_m", 1e3)),
    "flyer_spall": Measure("pull-back of the rear", "m/s", 0, "169", _pull_back),
    "bumper": Measure("mean velocity of the ball", "km/s", 2, "4.56 at least", _body("ball", "velocity_m_s", 1e-3)),
    "two_plates": Measure("residual velocity", "m/s", 0, "a little less than 897",
                          lambda run: run.summary.rod_residual_velocity_m_s),
    "jacketed_rod": Measure("depth", "mm", 1, "somewhat less than 40 to 43", _crater),
    "long_rod": Measure("depth", "mm", 1, "a little less than 40", _crater),
    "block_in_hole": Measure("velocity of the block", "m/s", 1, "200", _body("block", "velocity_m_s", 1.0)),
    "jet": Measure("depth", "mm", 1, "23.2 to 23.6", _crater),
    "plate_on_wall": Measure("velocity of the disc", "m/s", 1, "a little less than 50", _body("disc", "velocity_m_s", 1.0)),
}


@dataclass(frozen=True)
class Result:
    """A case that has ended.

    shot, sliding, advection : its labels
    status : "trusted", "not trusted" or "unphysical"
    value : of its measure, in the measure's unit; None for an unphysical run
    discarded, clipped : energy that the remap of velocities discarded and `ke_bound` clipped, per cent of that at the start
    time, cycles : time of flight in us, number of cycles
    fault : the clip that the first fault names, or the kind of cell that it doubts, else its sentence; empty for a trusted run
    method : version of the method that made the run
    """

    shot: str
    sliding: str
    advection: str
    status: str
    value: float | None
    discarded: float
    clipped: float
    time: float
    cycles: int
    fault: str
    method: str

    def __str__(self) -> str:
        if self.status == "unphysical":
            return f"**unphysical after {self.time:.1f} us: {self.fault}**"
        measure = MEASURES[self.shot]
        text = f"{self.value:.{measure.digits}f}, {abs(self.discarded + self.clipped):.1f} %"
        return text if self.status == "trusted" else f"{text}, **not trusted: {self.fault}**"


COLUMNS = tuple(field.name for field in fields(Result))


def read(path: Path) -> list[Result]:
    """The ended cases of a study directory, or of a file of results. Raises hydro2d.Error, OSError."""
    return kept.read(path, COLUMNS, _kept, _of, ended=("done", "unphysical"))


def _kept(row: dict[str, str]) -> Result:
    value = float(row["value"]) if row["value"] else None
    discarded, clipped, time = (float(row[name]) for name in ("discarded", "clipped", "time"))
    labels = {name: row[name] for name in ("shot", "sliding", "advection", "status", "fault", "method")}
    return Result(**labels, value=value, discarded=discarded, clipped=clipped, time=time, cycles=int(row["cycles"]))


def _of(case: hydro2d.Case) -> Result:
    summary, shot = case.summary, case.values["shot"]
    ended = case.status == "done"
    sinks, start = summary.conservation.sinks, summary.conservation.start_energy_J
    discarded, clipped = (round(100.0 * sinks[name].energy_J / start, 2) for name in ("advection", "ke_bound"))
    value = MEASURES[shot].of(hydro2d.open_run(case.directory)) if ended else None
    status = ("trusted" if summary.trustworthy else "not trusted") if ended else "unphysical"
    return Result(shot, case.values.get("sliding", "none"), case.values["advection"], status,
                  None if value is None else round(value, 3), discarded, clipped, round(1e6 * summary.time_s, 2),
                  summary.cycles, _short(next(iter(summary.faults), "")), summary.method or "")


def _short(fault: str) -> str:
    """The clip that a fault names; "a hot cell", "a cold cell", "energy discarded"; or the fault."""
    if clip := re.search(r"(\w+) has removed ", fault):
        return clip[1]
    doubts = {f"a {what} cell": f'" is too {what} with ' for what in ("hot", "cold")}
    doubts["energy discarded"] = "velocities has discarded "
    return next((name for name, part in doubts.items() if part in fault), fault)


def keep(results: list[Result], path: Path) -> None:
    """Writes a file of results. Raises OSError."""
    kept.write(path, COLUMNS, ({**asdict(result), "value": "" if result.value is None else result.value} for result in results))


def table(results: list[Result]) -> list[str]:
    """Lines of Markdown: a row for each shot and sliding."""
    by_labels = {(result.shot, result.sliding, result.advection): result for result in results}
    lines = ["| shot | number | expected | sliding | " + " | ".join(f"`{name}`" for name in ADVECTION) + " |",
             "|---" * (4 + len(ADVECTION)) + "|"]
    for shot, sliding in dict.fromkeys((result.shot, result.sliding) for result in results):
        measure = MEASURES[shot]
        cells = " | ".join(str(by_labels.get((shot, sliding, name), "")) for name in ADVECTION)
        lines.append(f"| {shot} | {measure.name}, {measure.unit} | {measure.expected} | {sliding} | {cells} |")
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Prints the table and keeps the results. Returns 2 if there is nothing to read."""
    parser = argparse.ArgumentParser(prog="python -m problems.classic.table", description=__doc__.splitlines()[0])
    parser.add_argument("results", nargs="+", type=Path, help="the directory of a study, or a file of results")
    parser.add_argument("--keep", type=Path, help="a CSV file for all cases")
    given = parser.parse_args(arguments)
    try:
        results = [result for path in given.results for result in read(path)]
        if not results:
            raise hydro2d.StudyError("there is no case that has ended")
        if given.keep:
            keep(results, given.keep)
    except (hydro2d.Error, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    print("\n".join(table(results)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
