"""The contents of a report, read from the cases of a study."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from hydro2d.study.ensemble.ensembles import Ensemble, cases, grouped
from hydro2d.study.records import experiments, record, table
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record, Setup
from hydro2d.study.records.responses import Choice
from hydro2d.study.records.study_directory import Study
from hydro2d.study.search import regimes

if TYPE_CHECKING:
    import pandas


@dataclass
class Contents:
    """The cases of a study, as read.

    groups, measurements : by setup;  belonging : the measurement of each case by its name;  table : a row for each case, in SI
    notes : on data that could not be used
    """

    study: Study
    records: list[Record]
    groups: dict[Setup, list[Record]]
    measurements: dict[Setup, list[Measurement]]
    belonging: dict[str, Measurement]
    table: pandas.DataFrame
    notes: list[str]

    @property
    def ensembles(self) -> list[Ensemble]:
        """The ensembles of the study; a run outside ensembles is one by itself."""
        return grouped(self.records, self.belonging)

    @cached_property
    def transitions(self) -> list[regimes.Transitions]:
        """The results of a search, one for each combination of the axes; empty for any other study."""
        return regimes.of_study(self.study, self.records) if self.study.search else []

    def table_of_ensembles(self, choice: Choice | None = None) -> pandas.DataFrame:
        """One row for each ensemble; ``choice``: drawn responses, whose columns are added."""
        return cases(self.study, self.ensembles, self.table, choice)


def collect(study: Study, trust: bool = False) -> Contents:
    """Reads every case and finds its measurement; trust : see record.read."""
    records = [record.read(case, trust) for case in study.cases]
    notes = [f"{each.case.name}: {problem}" for each in records for problem in each.problems]
    notes += [f"{said}, so that analytic models may be missing; --trust runs it"
              for said in dict.fromkeys(said for each in records for said in each.unread)]
    groups: dict[Setup, list[Record]] = {}
    for each in records:
        if each.setup:
            groups.setdefault(each.setup, []).append(each)
    unplaced = experiments.unplaced(records)
    known, belonging, lost = {}, {}, set()
    for setup, members in groups.items():
        placed = [each for each in members if _key(each) not in unplaced]
        known[setup] = experiments.measured(setup, placed)
        for each in members:
            measurement = experiments.belonging(each, known[setup])
            if measurement is not None:
                belonging[each.case.name] = measurement
            elif _key(each) in unplaced and not any(experiments.same_depth(each, entry) for entry in known[setup]):
                lost.add(_key(each))
    notes += [_said(key, unplaced[key]) for key in unplaced if key in lost]
    return Contents(study, records, groups, known, belonging, table.cases(study, records, belonging), notes)


def _key(each: Record) -> tuple:
    return each.experiment.get("source"), each.experiment.get("penetration")


def _said(key: tuple, velocities: set[float]) -> str:
    source, depth = key
    return (
        f"Decks at {len(velocities)} impact velocities name one experiment ({source}: {depth * 100:.4g} cm). It is not used "
        "for runs without a shot in the catalogue; experiment.velocity in a deck says at which velocity it was measured."
    )
