"""A shot as a function of keys of its deck, for optimisers: called with their values, it runs the deck and gives a number.

`Objective.suggest` and `Objective.ingest` take and give lists of dicts of numbers, after the standard for generators of CAMPA
(https://generator-standard.readthedocs.io), which libEnsemble, Xopt and Optimas share.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import ValidationError

from hydro2d.base.errors import in_words, unknown
from hydro2d.deck import deck as decks
from hydro2d.deck.deck import Deck
from hydro2d.files import toml
from hydro2d.files.locks import turn
from hydro2d.files.whole import plain
from hydro2d.output.directory import deck_hash
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, DIGITS, Distribution, label
from hydro2d.study.plan.sample_section import Input, in_one_unit
from hydro2d.study.records import sample_table, study_directory
from hydro2d.study.records.study_directory import DONE, INTERRUPTED
from hydro2d.study.run.case import run_case
from hydro2d.study.samples import results, surrogates

#: letters of the hash of a deck in the name of its directory; fewest points among which a suggestion is chosen
LETTERS, CANDIDATES = 16, 2047
#: best points around which more candidates are drawn, and the standard deviations of the steps from them, as shares of a range
BEST, STEPS = 2, (0.1, 0.03, 0.01, 0.003, 0.001)
#: folder of the files by which callers of one point take turns
TURNS = ".turns"
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
                 goal: Literal["minimize", "maximize", "explore"] = "minimize", threads: int = 1, seed: int = 0):
        if goal not in GOALS:
            raise StudyError(unknown("goal", goal, GOALS))
        if not keys:
            raise StudyError("keys: is empty; at least one key with its bounds is needed")
        self.deck = deck if isinstance(deck, Deck) else Deck.from_file(deck)
        self.result, self.directory, self.goal, self.threads, self.seed = result, Path(directory), goal, threads, seed
        self.inputs = tuple(_input(key, given) for key, given in keys.items())
        self._levels = {each.key: {level: value for level, value in zip(each.levels, _sorted(keys[each.key]), strict=True)}
                        for each in self.inputs if each.kind == CHOICE}
        self.variables = {each.head: set(self._levels[each.key].values()) if each.kind == CHOICE else list(each.numbers)
                          for each in self.inputs}
        self.data: list[dict[str, Any]] = []
        self._suggested: list[tuple[Any, ...]] = []
        for point in self._points(np.repeat([[0.0], [1.0]], len(self.inputs), axis=1)):
            self.deck_at(point)  # the ends of all keys make valid decks

    def __call__(self, point: Mapping[str, Any]) -> float:
        """The result at a point: runs its deck, or reads the run that there is already.

        point : values by deck key, ``{"body.rod.velocity": "1086 m/s"}``, or by name, ``{"body.rod.velocity [m/s]": 1086.0}``;
            a key that it does not have keeps the value of the deck

        Waits for a thread or process of this machine that runs the same point, and reads its run.

        Raises StudyError for an unknown key, None or a key given twice, a run that failed, or one without this result;
        DeckError; KeyboardInterrupt if the run was interrupted: the next call continues it.
        """
        text = self.deck_at(point).to_toml()
        self.directory.mkdir(parents=True, exist_ok=True)
        place = self.directory / deck_hash(text)[:LETTERS]
        with turn(self.directory / TURNS / place.name):
            outcome = run_case(place, text, threads=self.threads)
        if outcome.status == INTERRUPTED:
            raise KeyboardInterrupt(f"{place}: {outcome.message}")
        if outcome.status != DONE:
            raise StudyError(f"{place}: the run is {outcome.status}: {outcome.message}")
        (case,) = study_directory.load(place).cases
        run = sample_table.values([sample_table.of_run(case)])
        value = float(results.Samples(case.name, (), run, summaries=[case.summary]).values(self.result)[0])
        if not np.isfinite(value):
            raise StudyError(f"{place}: the run has no {self.result}")
        return value

    def deck_at(self, point: Mapping[str, Any]) -> Deck:
        """The deck at a point, as for a call.

        Raises StudyError for an unknown key, None or a key given twice, DeckError for an impossible value.
        """
        names = {name for each in self.inputs for name in (each.key, each.head)}
        for name in point:
            if name not in names and name not in (ID, self.result):
                raise StudyError(unknown("key", name, {each.head for each in self.inputs}))
        settings = []
        for each, value in self._values(point):
            with_unit = f"{float(value)!r} {each.unit}" if each.unit and _is_number(value) else value
            settings.append(toml.assigned(each.key, with_unit))
        return decks.of_tables(self.deck._tables, settings, self.deck.name)

    def _values(self, point: Mapping[str, Any]) -> list[tuple[Distribution, Any]]:
        """The inputs that a point has, each with its value without numpy's types. Raises StudyError."""
        values = []
        for each in self.inputs:
            names = [name for name in dict.fromkeys((each.key, each.head)) if name in point]
            if len(names) > 1:
                raise StudyError(f"{each.key}: is given twice, as {' and '.join(names)}; leave one of them out")
            if not names:
                continue
            value = plain(point[names[0]])
            if value is None:
                raise StudyError(f"{names[0]}: is None; a value is needed")
            values.append((each, value))
        return values

    def suggest(self, num_points: int | None = None) -> list[dict[str, Any]]:
        """The next points, each a dict of a number or a value by name. Default: one point.

        They fill the bounds evenly (Sobol's sequence). From as many results on as a surrogate needs, if they differ, they are
        the best points of functions that the results allow, a function for each point (Thompson sampling), unless the goal is
        to explore. Half of the points among which each is chosen are near the best results. Results that are NaN do not count.

        All points differ from each other, from those in `data` and from those suggested before. Only where the keys have sets
        of values and too few combinations are left, earlier ones follow the last new ones; a call reads their runs.
        """
        number = 1 if num_points is None else operator.index(num_points)
        if number < 1:
            raise ValueError(f"num_points = {number}: at least one is needed")
        known = [each for each in self.data if np.isfinite(each[self.result])]
        values = np.array([each[self.result] for each in known])
        explores = self.goal == "explore" or len(known) < len(self.inputs) + surrogates.FEWEST or not surrogates.vary(values)
        cube = self._explored(number) if explores else self._improved(number, known, values)
        points = self._points(cube)
        self._suggested += [tuple(point.values()) for point in points]
        return points

    def _explored(self, number: int) -> np.ndarray:
        """The next points of Sobol's sequence, float64[number, d]."""
        return self._fresh(self._sobol(number), number)[:number]

    def _improved(self, number: int, known: list[dict[str, Any]], values: np.ndarray) -> np.ndarray:
        """The best points of functions that the results, float64[n], of known points allow, float64[number, d]."""
        seed, sign = self.seed + len(self._suggested) + number, 1.0 if self.goal == "minimize" else -1.0
        cube = np.column_stack([each.points([point[each.head] if each.kind != CHOICE else label(point[each.head])
                                             for point in known]) for each in self.inputs])
        evenly = self._sobol(number)
        best = cube[np.argsort(sign * values, kind="stable")[:BEST]]
        candidates = self._fresh(np.vstack([evenly, _near(best, len(evenly), seed)]), number)
        made = surrogates.fit(self.inputs, cube, values)
        chosen: list[int] = []
        for drawn in sign * made.draws(candidates, max(number, 5), seed=seed)[:number]:
            drawn[chosen] = np.inf
            chosen.append(int(np.argmin(drawn)))
        return candidates[chosen]

    def _sobol(self, number: int) -> np.ndarray:
        """The first points of Sobol's sequence, float64[n, d], at least as many new ones as a number."""
        from scipy.stats import qmc

        engine = qmc.Sobol(len(self.inputs), scramble=True, seed=np.random.default_rng(self.seed))
        return engine.random_base2(max(CANDIDATES, len(self.data) + len(self._suggested) + number - 1).bit_length())

    def _fresh(self, cube: np.ndarray, number: int) -> np.ndarray:
        """The points of a cube, float64[n, d], that are new and differ; if these are fewer than a number, others follow."""
        used = {tuple(point[name] for name in self.variables) for point in self.data} | {*self._suggested}
        rows: dict[tuple[Any, ...], int] = {}
        for row, point in enumerate(self._points(cube)):
            rows.setdefault(tuple(point.values()), row)
        fresh = [row for values, row in rows.items() if values not in used]
        if len(fresh) < number:
            again = [row for values, row in rows.items() if values in used]
            return cube[np.resize([*fresh, *again], number)]
        return cube[fresh]

    def ingest(self, results: Sequence[Mapping[str, Any]]) -> None:
        """Takes evaluated points: dicts of the values of all keys, as for a call, and of the result, NaN for a run without it.

        Raises StudyError for a wrong point: without a key or with one given twice, with a value outside the bounds or the set
        of values, with a result that is no number; then none of them is added.
        """
        if isinstance(results, Mapping):
            raise StudyError("results: expected a list of points, is a single one")
        self.data += [self._taken(point) for point in results]

    def _taken(self, point: Mapping[str, Any]) -> dict[str, Any]:
        """An evaluated point as `data` has it: values by name, in the unit of the name. Raises StudyError."""
        values = {each.head: self._level(each, value) if each.kind == CHOICE else _number(each, value)
                  for each, value in self._values(point)}
        missing = [*(name for name in self.variables if name not in values), *({self.result} - point.keys())]
        if missing:
            raise StudyError(f"a point has no {missing[0]}: {dict(point)}")
        try:
            result = float(point[self.result])
        except (TypeError, ValueError):
            raise StudyError(f"{self.result} is not a number: {dict(point)}") from None
        keys = {each.key for each in self.inputs}
        return {name: value for name, value in point.items() if name not in keys} | values | {self.result: result}

    def _level(self, each: Distribution, value: Any) -> Any:
        """The value of a set that equals a given one, such as 1.0 for 1. Raises StudyError."""
        for own in self._levels[each.key].values():
            if own == value and isinstance(own, bool) == isinstance(value, bool):
                return own
        raise StudyError(f"{each.head}: {unknown('value', str(value), each.levels)}")

    def _points(self, cube: np.ndarray) -> list[dict[str, Any]]:
        """Points of the unit cube, float64[n, d], as values by name."""
        columns = [each.values(shares) for each, shares in zip(self.inputs, cube.T, strict=True)]
        own = [[self._levels[each.key][str(value)] for value in column] if each.kind == CHOICE else column
               for each, column in zip(self.inputs, columns, strict=True)]
        return [dict(zip(self.variables, values, strict=True)) for values in zip(*own, strict=True)]


def _near(best: np.ndarray, number: int, seed: int) -> np.ndarray:
    """Points near the best ones, float64[n, d], in the unit cube: float64[number, d]."""
    generator, row = np.random.default_rng(seed), np.arange(number)
    sizes = np.array(STEPS)[row // len(best) % len(STEPS), None]
    steps = sizes * generator.standard_normal((number, best.shape[1]))
    return np.clip(best[row % len(best)] + steps, 0.0, 1.0)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _number(each: Distribution, given: Any) -> float:
    """A number, or a text with a unit, as a number in the unit of a key, within its bounds but for round-off.

    Raises StudyError.
    """
    low, high = each.numbers
    expected = f"expected a number from {low:.6g} to {high:.6g}{each.unit and ' '}{each.unit}"
    value = float(given) if _is_number(given) else float("nan")
    if isinstance(given, str):
        with suppress(ValueError):
            value = in_one_unit((f"1 {each.unit}" if each.unit else 1, given))[0][1]
    slack = 10.0 ** (1 - DIGITS) * max(abs(low), abs(high))
    if not low - slack <= value <= high + slack:  # also if it is NaN
        raise StudyError(f"{each.head}: is {given!r}; {expected}")
    return value


def _sorted(given: Any) -> list[Any]:
    return sorted(map(plain, given), key=str)


def _input(key: str, given: Any) -> Distribution:
    """The bounds or the values of a key as a distribution. Raises StudyError."""
    table = {"choice": tuple(_sorted(given))} if isinstance(given, (set, frozenset)) else {"uniform": plain(given)}
    try:
        return Distribution.of_input(key, Input.model_validate(table))
    except ValidationError as error:
        raise StudyError(f"{key}: {in_words(error.errors()[0])}") from None
