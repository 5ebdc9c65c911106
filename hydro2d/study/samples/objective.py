"""A shot as a function of keys of its deck, for optimisers: called with their values, it runs the deck and gives a number.

`Objective.suggest` and `Objective.ingest` take and give lists of dicts of numbers, after the standard for generators of CAMPA
(https://generator-standard.readthedocs.io), which libEnsemble, Xopt and Optimas share.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import ValidationError

from hydro2d.base.errors import in_words, unknown
from hydro2d.deck import deck as decks
from hydro2d.deck.deck import Deck
from hydro2d.files import toml
from hydro2d.output.directory import deck_hash
from hydro2d.study.plan import sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, Distribution, label
from hydro2d.study.plan.sample_section import Input
from hydro2d.study.records import sample_table, study_directory
from hydro2d.study.records.study_directory import DONE
from hydro2d.study.run.case import run_case
from hydro2d.study.samples import results, surrogates

#: letters of the hash of a deck in the name of its directory; fewest points among which a suggestion is chosen
LETTERS, CANDIDATES = 16, 2047
#: the key of a point's name in the standard for generators
ID = "_id"
GOALS = ("minimize", "maximize", "explore")


class Objective:
    """A result of a deck as a function of some of its keys.

    Parameters
    ----------
    deck : Deck, or path of a deck file
    keys : dict by dotted deck key
        The lowest and the highest value of each, such as ``{"body.rod.velocity": ("1000 m/s", "1200 m/s")}``, or a set of
        values.
    result : a number of summary.json or of samples.csv, or an outcome, as for `Samples.values`
    directory : folder of the runs, one directory each; a point that has been run is read from there
    goal : "minimize", "maximize" or "explore", for `suggest`
    threads : largest number of threads of a run
    seed : of the suggestions

    Attributes
    ----------
    variables : dict by name, such as ``body.rod.velocity [m/s]``: the bounds as [low, high], or the set of values
    data : the points that `ingest` was given, each with its result

    Raises StudyError, DeckError for a key that the deck does not have.
    """

    def __init__(self, deck: Deck | str | Path, keys: Mapping[str, Any], result: str, *, directory: str | Path,
                 goal: Literal["minimize", "maximize", "explore"] = "minimize", threads: int = 1, seed: int = 0):  # fmt: skip
        if goal not in GOALS:
            raise StudyError(unknown("goal", goal, GOALS))
        if not keys:
            raise StudyError("keys: is empty; at least one key with its bounds is needed")
        self.deck = deck if isinstance(deck, Deck) else Deck.from_file(deck)
        self.result, self.directory, self.goal, self.threads, self.seed = result, Path(directory), goal, threads, seed
        self.inputs = tuple(_input(key, given) for key, given in keys.items())
        self._levels = {each.key: {level: value for level, value in zip(each.levels, _sorted(keys[each.key]), strict=True)}
                        for each in self.inputs if each.kind == CHOICE}  # fmt: skip
        self.variables = {each.head: set(self._levels[each.key].values()) if each.kind == CHOICE else list(each.numbers)
                          for each in self.inputs}  # fmt: skip
        self.data: list[dict[str, Any]] = []
        self._given = 0
        for point in np.vstack([np.full(len(self.inputs), share) for share in (0.0, 1.0)]):
            self.deck_at(self._point(point))  # the ends of all keys make valid decks

    def __call__(self, point: Mapping[str, Any]) -> float:
        """The result at a point: runs its deck, or reads the run that there is already.

        point : values by deck key, ``{"body.rod.velocity": "1086 m/s"}``, or by name, ``{"body.rod.velocity [m/s]": 1086.0}``;
            a key that it does not have keeps the value of the deck

        Raises StudyError for an unknown key, a run that failed, or one without this result; DeckError.
        """
        text = self.deck_at(point).to_toml()
        self.directory.mkdir(parents=True, exist_ok=True)
        place = self.directory / deck_hash(text)[:LETTERS]
        outcome = run_case(place, text, threads=self.threads)
        if outcome.status != DONE:
            raise StudyError(f"{place}: the run is {outcome.status}: {outcome.message}")
        (case,) = study_directory.load(place).cases
        case = replace(case, values={sampling.AXIS: "1"})
        (row,) = sample_table.rows(sampling.Points((), ((),), (), "table"), (), (case,), {})
        columns = {name: np.array([value]) for name, value in row.items() if value is not None}
        study = study_directory.Study(place, "", "", (), (case,))
        value = float(results.Samples(case.name, (), columns, study, [case.name]).values(self.result)[0])
        if not np.isfinite(value):
            raise StudyError(f"{place}: the run has no {self.result}")
        return value

    def deck_at(self, point: Mapping[str, Any]) -> Deck:
        """The deck at a point, as for a call. Raises StudyError for an unknown key, DeckError for an impossible value."""
        names = {name: each for each in self.inputs for name in (each.key, each.head)}
        overrides = {}
        for name, value in point.items():
            if name in (ID, self.result):
                continue
            if name not in names:
                raise StudyError(unknown("key", name, {each.head for each in self.inputs}))
            each = names[name]
            bare = each.unit and isinstance(value, (int, float)) and not isinstance(value, bool)
            overrides[each.key] = f"{float(value)!r} {each.unit}" if bare else value
        settings = [toml.assigned(key, value) for key, value in overrides.items()]
        return decks.of_tables(self.deck._tables, settings, self.deck.name)

    def suggest(self, num_points: int | None = None) -> list[dict[str, Any]]:
        """The next points, each a dict of a number or a value by name. Default: one point.

        They fill the bounds evenly (Sobol's sequence). From as many results on as a surrogate needs, if they differ, they are
        the best points of functions that the results allow, a function for each point (Thompson sampling), unless the goal is
        to explore. Results that are NaN do not count.
        """
        number = 1 if num_points is None else operator.index(num_points)
        if number < 1:
            raise ValueError(f"num_points = {number}: at least one is needed")
        from scipy.stats import qmc

        first, self._given = self._given, self._given + number
        known = [each for each in self.data if np.isfinite(each[self.result])]
        values = np.array([each[self.result] for each in known])
        explores = self.goal == "explore" or len(known) < len(self.inputs) + surrogates.FEWEST or not surrogates.vary(values)
        engine = qmc.Sobol(len(self.inputs), scramble=True, seed=np.random.default_rng(self.seed))
        candidates = engine.random_base2(max(CANDIDATES, self._given - 1).bit_length())
        if explores:
            return [self._point(point) for point in candidates[first : self._given]]
        cube = np.column_stack([each.points([each_point[each.head] if each.kind != CHOICE else label(each_point[each.head])
                                             for each_point in known]) for each in self.inputs])  # fmt: skip
        made = surrogates.fit(self.inputs, cube, values)
        sign = 1.0 if self.goal == "minimize" else -1.0
        drawn = made.draws(candidates, max(number, 5), seed=self.seed + self._given)[:number]
        return [self._point(candidates[int(np.argmin(sign * each))]) for each in drawn]

    def ingest(self, results: Sequence[Mapping[str, Any]]) -> None:
        """Takes evaluated points: dicts of the values of all keys by name, and of the result, NaN for a run without it.

        Raises ValueError for a wrong point; then none of them is added.
        """
        if isinstance(results, Mapping):
            raise ValueError("results: expected a list of points, is a single one")
        points = []
        for point in results:
            missing = [name for name in (*self.variables, self.result) if name not in point]
            if missing:
                raise ValueError(f"a point has no {missing[0]}: {dict(point)}")
            try:
                points.append({**point, self.result: float(point[self.result])})
            except (TypeError, ValueError):
                raise ValueError(f"{self.result} is not a number: {dict(point)}") from None
        self.data += points

    def _point(self, cube: np.ndarray) -> dict[str, Any]:
        """A point of the unit cube as values by name."""
        values = {each.head: each.values(np.array([share]))[0] for each, share in zip(self.inputs, cube, strict=True)}
        return {each.head: self._levels[each.key][values[each.head]] if each.kind == CHOICE else values[each.head]
                for each in self.inputs}  # fmt: skip


def _sorted(given: Any) -> list[Any]:
    return sorted(given, key=str)


def _input(key: str, given: Any) -> Distribution:
    """The bounds or the values of a key as a distribution. Raises StudyError."""
    table = {"choice": tuple(_sorted(given))} if isinstance(given, (set, frozenset)) else {"uniform": given}
    try:
        return Distribution.of_input(key, Input.model_validate(table))
    except ValidationError as error:
        raise StudyError(f"{key}: {in_words(error.errors()[0])}") from None
