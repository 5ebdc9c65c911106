"""Fills the tables of the pages of the study from kept rows.

    python -m problems.cth_nose_shape.pages [--check]

A table stands between `<!-- NAME -->` and `<!-- end -->`, and is what the function of that name in TABLES makes of the rows.
With --check nothing is written, and the status is 1 if a page has another table. A test does the same.
"""

from __future__ import annotations

import argparse
import functools
import sys
from collections.abc import Callable
from pathlib import Path

import hydro2d
from problems import kept
from problems.cth_nose_shape import (
    braking,
    convergence,
    findings,
    heads,
    members,
    plate_laws,
    probability,
    rigid_rod,
    transitions,
)

HERE = Path(__file__).parent
PAGES = tuple(HERE.parents[1] / "docs" / "explanation" / f"{name}.md" for name in (
    "rigid-rod", "nose-shape", "uncertain-shots", "resolution", "eroding-heads"))
RESULTS = HERE / "results"
#: cells across the rod of the tables of all twelve shots
USUAL = 5.5
HEMISPHERICAL, OGIVAL = rigid_rod.NOSES.values()


def _twelve(cells: float | None = USUAL) -> list[rigid_rod.Result]:
    return rigid_rod.read(RESULTS / "twelve_shots.csv", cells)


def _shots() -> list[str]:
    runs = _twelve()
    return [*members.table(members.grouped(runs)), *rigid_rod.notes(runs)]


def _scores() -> list[str]:
    return [*members.scores(members.grouped(_twelve())), *rigid_rod.notes(_twelve())]


def _holes() -> list[str]:
    runs = [*_twelve(None), *rigid_rod.read(convergence.FILE)]
    return [*rigid_rod.holes(runs), *rigid_rod.notes(runs)]


def _transitions() -> list[str]:
    return transitions.table(hydro2d.runs(*transitions.FILES))


def _of_advection(make: Callable[[findings.Runs], list[str]],
                  take: Callable[[rigid_rod.Result], bool] = lambda run: True) -> Callable[[], list[str]]:
    def lines() -> list[str]:
        runs = list(filter(take, rigid_rod.read(findings.FILE)))
        return [*make(findings.grouped(runs)), *rigid_rod.notes(runs)]

    return lines


def _depths(nose: str) -> Callable[[], list[str]]:
    return _of_advection(lambda found: findings.depths(found, nose), lambda run: run.shot is not None and run.shot.nose == nose)


@functools.cache
def _samples(nose: str = HEMISPHERICAL) -> dict[rigid_rod.Shot, hydro2d.Samples]:
    return probability.samples(nose=nose)


@functools.cache
def _inferred() -> probability.Inference:
    return probability.inferred(_samples())


def _uncertain_notes(nose: str) -> list[str]:
    runs = rigid_rod.read(RESULTS / "uncertain_shots.csv", USUAL)
    return rigid_rod.notes([run for run in runs if run.shot is not None and run.shot.nose == nose])


TABLES: dict[str, Callable[[], list[str]]] = {
    "shots": _shots, "scores": _scores, "holes": _holes, "transitions": _transitions,
    "meshes": lambda: convergence.tables(convergence.found()),
    "softening": lambda: convergence.table(convergence.softening(), convergence.DEPTH),
    "forces": lambda: braking.forces(braking.kept()),
    "heads": lambda: [*heads.table(heads.cases(heads.kept())), *rigid_rod.notes(heads.kept())],
    "laws_5083": lambda: plate_laws.table("5083"), "laws_7039": lambda: plate_laws.table("7039"),
    "hemispherical": _depths(HEMISPHERICAL),
    "ogival": _depths(OGIVAL),
    "schemes": _of_advection(lambda found: findings.compared(found, HEMISPHERICAL, "advection")),
    "failures": _of_advection(lambda found: findings.compared(found, HEMISPHERICAL, "failure")),
    "slidings": _of_advection(lambda found: findings.compared(found, HEMISPHERICAL, "sliding")),
    "uncertain_outcomes": lambda: [*probability.outcomes(_samples()), *_uncertain_notes(HEMISPHERICAL)],
    "uncertain_ogival": lambda: [*probability.outcomes(_samples(OGIVAL)), *_uncertain_notes(OGIVAL)],
    "uncertain_laws": lambda: probability.likelihoods(_inferred()),
    "uncertain_foretold": lambda: probability.foretold(_samples()),
    "uncertain_strengths": lambda: probability.strengths(_inferred()),
    "uncertain_velocities": lambda: probability.halves(_inferred()),
    "uncertain_by_law": lambda: probability.halves_by_law(_samples(), _inferred()),
    "uncertain_slopes": lambda: probability.slopes(_inferred()),
    "uncertain_shares": lambda: probability.shares(_samples() | _samples(OGIVAL)),
}


def filled(text: str) -> str:
    """The text of a page with the tables that the kept rows make."""
    return kept.filled(text, TABLES)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    return kept.fill(PAGES, TABLES, parser.parse_args(arguments).check)


if __name__ == "__main__":
    sys.exit(main())
