"""`hydro2d converge`: an ensemble on several meshes; scatter within a mesh is separated from change between meshes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hydro2d.base.errors import DeckError
from hydro2d.base.version import __version__
from hydro2d.deck import deck as decks
from hydro2d.files.whole import write_json
from hydro2d.study.ensemble import extrapolation
from hydro2d.study.ensemble.contents import Contents
from hydro2d.study.ensemble.ensembles import Ensemble
from hydro2d.study.ensemble.extrapolation import GridConvergence, Level, Limit
from hydro2d.study.plan import meshes
from hydro2d.study.plan.cases import plan_of
from hydro2d.study.plan.definition import Overrides, StudyError
from hydro2d.study.plan.planned import Plan
from hydro2d.study.records import responses
from hydro2d.study.records.responses import DEPTH, LENGTH_RATIO, Response, raw
from hydro2d.study.run.monitor import lines

FILE, AXIS = "convergence.json", "cells"
HEADS = ("cells", "members", "mean", "scatter", "error of the mean", "change", "regimes")


@dataclass(frozen=True)
class Meshes:
    """A response on several meshes, from the coarsest to the finest.

    regimes : on each mesh, in words;  limit : the value for cells of zero size, or why there is none
    index : grid convergence index of the means; None with fewer than three meshes, or where a mean describes no run
    """

    response: Response
    levels: list[Level]
    regimes: list[str]
    limit: Limit
    index: GridConvergence | None = None

    def lines(self) -> list[str]:
        """The table of the meshes, and the conclusions."""
        means = [each.mean for each in self.levels]
        changes = ["", *(f"{fine - coarse:+.3g}" for coarse, fine in itertools.pairwise(means))][: len(means)]
        rows = [(f"{each.cells:g}", str(each.count), f"{each.mean:.4g}", f"{each.scatter:.2g}", f"{each.error:.2g}", change,
                 regime)
                for each, change, regime in zip(self.levels, changes, self.regimes, strict=True)]
        return [self.response.title, *lines(rows, HEADS), *self._conclusion()]

    def _conclusion(self) -> list[str]:
        if not self.levels:
            return [f"it does not extrapolate: {self.limit.words}"]
        within = math.sqrt(sum(each.scatter**2 for each in self.levels) / len(self.levels))
        between = max(each.mean for each in self.levels) - min(each.mean for each in self.levels)
        words = [f"scatter within a mesh {within:.2g}, change between the meshes {between:.2g} {self.response.unit}".rstrip()]
        if self.index is not None:
            words.append(f"grid convergence index of the three finest meshes, from their means: {self.index}")
        limit = self.limit
        if limit.value is None:
            return [*words, f"it does not extrapolate: {limit.words}"]
        unit = f" {self.response.unit}" if self.response.unit else ""
        return [*words, f"extrapolated: {limit.value:.4g}{unit}, {limit.low:.4g} to {limit.high:.4g} (90 %), order "
                       f"{limit.order:.2g}; {limit.words}"]

    def data(self) -> dict:
        """For programs; values in SI."""
        factor = self.response.factor
        return {
            "name": self.response.name,
            "meshes": [{"cells": each.cells, "members": each.count, "mean": each.mean / factor,
                        "scatter": each.scatter / factor, "error": each.error / factor, "regimes": regime}
                       for each, regime in zip(self.levels, self.regimes, strict=True)],
            "extrapolated": None if self.limit.value is None else {
                "value": self.limit.value / factor, "low": self.limit.low / factor, "high": self.limit.high / factor,
                "order": self.limit.order},
            "grid_convergence_index": self.index and self.index.index,
            "in_words": self.limit.words,
        }


def plan(deck: Path, cells: Sequence[float], ensemble: dict, overrides: Overrides) -> Plan:
    """A study of a deck with an ensemble on each mesh. Raises StudyError, DeckError."""
    file = decks.find(deck)
    base = decks.load(file, overrides)
    try:
        variants = {f"{number:g}": meshes.settings(base, number) for number in cells}
    except DeckError as error:
        raise StudyError(f"{file}: {error}") from None
    tables = {
        "title": f"{file.stem} on {len(cells)} meshes", "deck": str(file.resolve()),
        "axis": [{"name": AXIS, "variants": variants}], "ensemble": ensemble,
    }
    return plan_of(tables, file.stem, overrides)


def sequences(contents: Contents, names: Sequence[str] = ()) -> list[Meshes]:
    """The responses of a study on several meshes; ``names``: as --y of a report, by default depth and loss of length."""
    choice = responses.choose(contents.study, contents.records, y=names)
    shown = list(choice.y)
    if not names and any(each.value("rod_length_m") is not None for each in contents.records):
        shown = [shown[0], responses.response(LENGTH_RATIO), *shown[1:]]
    by_cells = sorted(contents.ensembles, key=_cells)
    return [_sequence(by_cells, y) for y in shown]


def _cells(each: Ensemble) -> float:
    return float(each.members[0].case.values[AXIS])


def _sequence(ensembles: Sequence[Ensemble], y: Response) -> Meshes:
    samples = [(_cells(each), [value * y.factor for record in each.ended if (value := raw(record, y.name)) is not None])
               for each in ensembles]
    known = [(cells, values) for cells, values in samples if len(values) > 1]
    levels = [extrapolation.level(cells, values) for cells, values in known]
    regimes = [each.regimes for each, (_, values) in zip(ensembles, samples, strict=True) if len(values) > 1]
    said = [", ".join(f"{regime} {share.successes} of {share.trials}" for regime, share in each.items()) for each in regimes]
    kinds, index = {regime for each in regimes for regime in each}, None
    if len(known) < len(ensembles):
        few = ", ".join(f"{cells:g}" for cells, values in samples if len(values) < 2)
        limit = Limit(None, None, None, None, f"fewer than two members have ended on {few} cells")
    elif len(kinds) > 1:
        limit = Limit(None, None, None, None, f"runs end in {len(kinds)} ways ({', '.join(sorted(kinds))}), and a mean "
                                              "describes none of them")
    elif y.name == DEPTH and any(each.bound is not None for each in ensembles):
        limit = Limit(None, None, None, None, "some depths are lower bounds, since the projectile perforated or left the mesh")
    else:
        limit = extrapolation.limit(levels, [values for _, values in known])
        index = extrapolation.grid_convergence({each.cells: each.mean for each in levels}) if len(levels) > 2 else None
    return Meshes(y, levels, said, limit, index)


def write(directory: Path, meshes: Sequence[Meshes]) -> None:
    """Writes convergence.json. Raises OSError."""
    write_json(directory / FILE, {"version": __version__, "responses": [each.data() for each in meshes]})
