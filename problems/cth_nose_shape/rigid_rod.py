"""Depth against velocity for the rods of the shots: tables of the runs of studies.

    python -m problems.cth_nose_shape.rigid_rod RESULTS [RESULTS ...]

RESULTS is the directory of a study, finished or not, or a file in `results`, which has the rows that a sweep keeps. If several
have the same case, the last one counts. Three tables are printed in Markdown. In the first each row is a shot, each column a
variant of whatever else the studies vary, and the experiments stand beside the runs. The second has the transitions, by the
loss of length and by the depth, and the third the kinetic energy over the volume of the hole. A line below them says which
versions of the method the runs are of, if they are not all of the present one. `problems.cth_nose_shape.members` draws them.
"""

from __future__ import annotations

import argparse
import functools
import itertools
import math
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas

import hydro2d
from problems import kept

#: the shots of the study, and a deck with the materials of its rods and plates for each alloy
EXPERIMENTS = Path(__file__).with_name("experiments.csv")
DECKS = {alloy: EXPERIMENTS.with_name(f"hemi_{alloy}_{velocity}.toml") for alloy, velocity in (("5083", 1296), ("7039", 1248))}
#: the label of a shot: nose, alloy and velocity; without a nose it means a hemispherical one
SHOT = re.compile(r"(?:(hemi|ogive)[- ])?(5083|7039)[- ](\d+)")
#: noses by what labels and decks call them
NOSES = {"hemi": "hemispherical", "ogive": "ogival"}
#: the axis of the shots; those that make a shot in a search for a transition
SHOTS, SEARCHED, NOSE, CELLS = "shot", ("plate", "velocity"), "nose", "cells_across"
#: plates of the shots; rods and plates
ALLOYS = ("5083", "7039")
RODS = tuple(itertools.product(NOSES.values(), ALLOYS))
#: thickness of the plates, cm; mass of the rods, kg
PLATE, MASS = 53.34, 0.063
#: materials of the library with the laws of the rod, by what tables call the laws
LAWS = {"Steinberg-Guinan": "W_alloy", "Johnson-Cook, sintered": "W_sintered", "Johnson-Cook, 90W": "W_90_7_3",
        "Johnson-Cook, Y925": "W_Y925"}
#: marks runs that are not trustworthy
DOUBTFUL = "†"
#: words for the loss of length of rods, by the largest loss in per cent
LOSSES = {10.0: "up to a tenth of the length lost", 100.0 / 3.0: "up to a third", 100.0: "more"}
COLOURS = ("#1f4e79", "#c26a1b", "#4f7942", "#8b3a62", "#5b6770")


@dataclass(frozen=True, order=True)
class Shot:
    """A row of the table: nose, alloy and velocity (m/s), in this order."""

    nose: str
    alloy: str
    velocity: float

    @classmethod
    def named(cls, label: str) -> Shot | None:
        """The shot that the label of a case names; None if it names none."""
        found = SHOT.fullmatch(label)
        return found and cls(NOSES[found[1] or "hemi"], found[2], float(found[3]))

    def __str__(self) -> str:
        return f"{self.nose}, {self.alloy}, {self.velocity:g} m/s"


@dataclass(frozen=True)
class Experiment:
    """Depth (m), whether it is "measured", "estimated" or "at least", its hydrodynamic limit, and the length of the rod (m)."""

    depth: float
    kind: str
    limit: float
    length: float

    @property
    def rigid(self) -> bool:
        """Whether the rod stayed rigid, by its depth."""
        return self.depth > self.limit

    def __str__(self) -> str:
        return {"at least": "perforated", "estimated": f"{self.depth * 1e2:.1f} cm (estimated)"}.get(
            self.kind, f"{self.depth * 1e2:.1f} cm")


@dataclass(frozen=True)
class Result:
    """A finished run.

    labels : its label on every axis, and the cells across the rod;  member : its number in an ensemble
    depth, residual : depth in cm if it came to rest, velocity in m/s if it left the plate; the other is None
    loss : of length, per cent;  regime : of the summary;  hole : volume of the hole in cm3, None where it was not kept
    method : version of the method;  trusted : whether the audit of the run found nothing wrong
    """

    labels: dict[str, str]
    member: int
    depth: float | None
    loss: float
    residual: float | None
    regime: str
    hole: float | None
    method: str
    trusted: bool = True

    @property
    def identity(self) -> tuple:
        """Labels and member, which no other run has."""
        return *self.labels.items(), self.member

    @property
    def shot(self) -> Shot | None:
        """None for a case that is none of the shots' rods and plates."""
        if SHOTS in self.labels:
            return Shot.named(self.labels[SHOTS])
        plate, velocity = (self.labels.get(axis, "") for axis in SEARCHED)
        nose = self.labels.get(NOSE, NOSES["hemi"])
        return Shot(nose, plate, hydro2d.to_si(velocity, "m/s")) if plate in ALLOYS and velocity else None

    @property
    def column(self) -> str:
        """The values that the case varies in addition to the shot; cells across the rod only if they are asked for."""
        of_shot = (SHOTS,) if SHOTS in self.labels else (*SEARCHED, NOSE)
        return ", ".join(label for axis, label in self.labels.items() if axis not in (*of_shot, CELLS))

    @property
    def held(self) -> bool:
        """Whether two thirds of its length are left, as in a search for the loss of length."""
        return self.loss <= 100.0 * (1.0 - hydro2d.LEAST_KEPT_LENGTH)

    @property
    def reach(self) -> float:
        """Depth in cm, and the thickness of the plate for a rod that perforates."""
        return PLATE if self.depth is None else self.depth

    def __str__(self) -> str:
        lost = f"{self.loss:z.1f} %" if self.loss < 10.0 else f"{self.loss:.0f} %"
        return f"perforated at {self.residual:.0f} m/s, {lost}" if self.depth is None else f"{self.depth:.1f} cm, {lost}"


@functools.cache
def experiments() -> dict[Shot, Experiment]:
    """The twelve shots."""
    by_shot = {}
    for row in kept.rows(EXPERIMENTS, ("nose", "target", "velocity_m_s", "depth_cm", "depth_is", "length_cm")):
        alloy = row["target"].removeprefix("Al")
        length = 1e-2 * float(row["length_cm"])
        limit = length * math.sqrt(_density_ratio(alloy))
        shot = Shot(row["nose"], alloy, float(row["velocity_m_s"]))
        by_shot[shot] = Experiment(1e-2 * float(row["depth_cm"]), row["depth_is"], limit, length)
    return by_shot


@functools.cache
def _density_ratio(alloy: str) -> float:
    """Density of the rods over that of a plate."""
    deck = hydro2d.Deck.from_file(DECKS[alloy])
    rod, plate = (deck.materials[deck.body_named(name).material].reference_density for name in ("rod", "plate"))
    return rod / plate


def read(path: Path, cells: float | None = None) -> list[Result]:
    """The finished runs of the directory of a study, or of a file of kept rows; cells : those across the rod, else all.

    Raises hydro2d.Error, OSError.
    """
    table = hydro2d.runs(path)
    done = table[(table["status"] == "done") & ((table[CELLS] == cells) if cells is not None else True)]
    axes = done.loc[:, : "status"].columns[:-1]
    return [_of({axis: _label(run[axis]) for axis in axes if pandas.notna(run[axis])}, member, run)
            for (_, member), run in done.iterrows()]


def _label(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def _of(labels: dict[str, str], member: int, run: pandas.Series) -> Result:
    def number(name: str, factor: float = 1.0) -> float | None:
        return None if pandas.isna(run[name]) else round(factor * run[name], 9)

    depth, residual = (None, number("residual_velocity_m_s")) if run["perforated"] is True else (number("depth_m", 1e2), None)
    loss = round(100.0 * (1.0 - run["length_ratio"]), 9)
    return Result(labels, member, depth, loss, residual, run["regime"], number("hole_m3", 1e6), run["method"],
                  run["trustworthy"] is not False)


def columns(results: list[Result]) -> dict[str, dict[Shot, Result]]:
    """The results of shots, by column and shot."""
    found: dict[str, dict[Shot, Result]] = {}
    for result in results:
        if result.shot is not None:
            found.setdefault(result.column, {})[result.shot] = result
    return found


def table(found: dict[str, dict[Shot, Result]]) -> list[str]:
    """Lines of Markdown."""
    measured = experiments()
    shots = sorted({shot for cases in found.values() for shot in cases})
    lines = ["| shot | experiment | " + " | ".join(found) + " |", "|---" * (len(found) + 2) + "|"]
    for shot in shots:
        cells = [str(cases.get(shot, "")) for cases in found.values()]
        lines.append(f"| {shot} | {measured.get(shot, '')} | " + " | ".join(cells) + " |")
    return lines


def transitions(found: dict[str, dict[Shot, Result]]) -> list[str]:
    """Lines of Markdown: the transitions of every rod, by the loss of a third of its length and by the hydrodynamic limit."""
    limits = {(shot.nose, shot.alloy): 1e2 * told.limit for shot, told in experiments().items()}
    measured = {shot: 1e2 * told.depth for shot, told in experiments().items()}
    lines = ["| rod | transition | experiment | " + " | ".join(found) + " |", "|---" * (len(found) + 3) + "|"]
    for rod in RODS:
        of_rod = [{shot.velocity: case for shot, case in cases.items() if (shot.nose, shot.alloy) == rod}
                  for cases in found.values()]
        if not any(of_rod):
            continue
        by_length = [_length(cases) for cases in of_rod]
        depths = [{shot.velocity: depth for shot, depth in measured.items() if (shot.nose, shot.alloy) == rod}]
        depths += [{at: case.reach for at, case in cases.items()} for cases in of_rod]
        by_limit = [_deeper(each, limits[rod]) for each in depths]
        lines += [f"| {', '.join(rod)} | a third of the length lost |  | " + " | ".join(by_length) + " |",
                  f"| | depth no longer above {limits[rod]:.1f} cm | " + " | ".join(by_limit) + " |"]
    return lines


def _bracket(changed: Mapping[float, bool]) -> str:
    """From the fastest rod before the slowest that has changed, to that one; empty without rods."""
    high = min((at for at, yes in changed.items() if yes), default=None)
    low = max((at for at, yes in changed.items() if not yes and (high is None or at < high)), default=None)
    if low is None or high is None:
        return f"above {low:g} m/s" if low is not None else f"below {high:g} m/s" if high is not None else ""
    return f"{low:g} to {high:g} m/s"


def _length(cases: dict[float, Result]) -> str:
    """The transition by the loss of length."""
    return _bracket({at: not case.held for at, case in cases.items()})


def _deeper(depths: dict[float, float], limit: float) -> str:
    """The transition by depth, to rods that go no deeper than the limit; rods slower than all that went deeper are left out."""
    first = min((at for at, depth in depths.items() if depth > limit), default=math.inf)
    return _bracket({at: depth <= limit for at, depth in depths.items() if at >= first}) or ("none deeper" if depths else "")


def notes(results: list[Result]) -> list[str]:
    """Lines below the tables: how many runs are not to be trusted, and not of the present version of the method."""
    doubtful = sum(not result.trusted for result in results)
    faults = f"{DOUBTFUL} {doubtful} run{'s' * (doubtful != 1)} with a fault in the audit, such as too much energy lost."
    of_methods = hydro2d.method_note(result.method for result in results)
    return [line for each in (faults if doubtful else "", of_methods) if each for line in ("", each)]


def holes(results: list[Result]) -> list[str]:
    """Lines of Markdown: kinetic energy over the volume of the hole in GPa, by nose, loss of length and alloy."""
    ratios: dict[tuple[str, str, str], list[float]] = {}
    for result in results:
        if result.shot is not None and result.hole and result.depth is not None:
            lost = next(words for most, words in LOSSES.items() if result.loss <= most)
            energy = 0.5 * MASS * result.shot.velocity**2
            ratios.setdefault((result.shot.nose, lost, result.shot.alloy), []).append(1e-3 * energy / result.hole)
    lines = ["| rods | runs in 5083 | energy over volume | runs in 7039 | energy over volume |", "|---|---|---|---|---|"]
    for nose, lost in itertools.product(NOSES.values(), LOSSES.values()):
        there = [ratios.get((nose, lost, alloy), []) for alloy in ("5083", "7039")]
        cells = [f"{len(each)} | {_range(each)} GPa" if each else "0 |" for each in there]
        if any(there):
            lines.append(f"| {nose}, {lost} | " + " | ".join(cells) + " |")
    return lines


def _range(values: list[float]) -> str:
    least, most = f"{min(values):.1f}", f"{max(values):.1f}"
    return least if least == most else f"{least} to {most}"


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", type=Path)
    given = parser.parse_args(arguments)
    try:
        results = list({result.identity: result for path in given.results for result in read(path)}.values())
        found = columns(results)
        if not found:
            print("there is no finished case of a shot", file=sys.stderr)
            return 2
        print("\n".join([*table(found), "", *transitions(found), "", *holes(results), *notes(results)]))
    except (hydro2d.Error, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
