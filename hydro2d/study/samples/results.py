"""The results of a sample: a table of inputs and results, with spreads, fractions, Sobol indices and figures."""

from __future__ import annotations

import operator
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base.errors import unknown
from hydro2d.measure.regime import REGIMES
from hydro2d.measure.summary import Summary
from hydro2d.study.ensemble.chance import Share, Spread, spread, wilson, wilson_interval
from hydro2d.study.plan import sample_section, sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, Distribution
from hydro2d.study.records import sample_table
from hydro2d.study.records.differences import numbers
from hydro2d.study.records.keeping import MEMBER, OF_METHOD
from hydro2d.study.records.sample_table import FINAL, NO, PERFORATED, REGIME, STATUS, YES
from hydro2d.study.records.study_directory import DONE, Study
from hydro2d.study.samples import sobol, surrogates

if TYPE_CHECKING:
    import pandas

#: results in words that have a fraction of each word
OUTCOMES = (REGIME, PERFORATED)
#: their words, whether or not a run has them
WORDS = {REGIME: REGIMES, PERFORATED: (YES, NO)}
#: results that the summary of a sample shows if they vary; most of them beside those that the study asks for
USUAL, MOST_USUAL = ("depth_m", "residual_velocity_m_s", "length_ratio"), 3
#: points of the cube at which the effect of an input is taken: 10 % and 90 % of its values
LOW, HIGH = 0.1, 0.9
#: an outcome as a condition on a column
CONDITION = re.compile(r"(?P<name>\S+)\s*(?P<sign>>=|<=|>|<|=)\s*(?P<limit>.+?)\s*")
SIGNS = {">": operator.gt, "<": operator.lt, ">=": operator.ge, "<=": operator.le}


@dataclass(frozen=True)
class Fraction:
    """The fraction of the rows of a sample with an outcome.

    outcome : its word;  share : runs with it, runs that ended, the fraction and its 90 % Wilson interval
    low, high : bounds of the fraction in the whole sample, if none or all of the runs that did not end had it
    """

    outcome: str
    share: Share
    low: float
    high: float


@dataclass(frozen=True)
class Effect:
    """The change of a result over an input from 10 to 90 % of its values, the other inputs at their medians, by a surrogate.

    low, high : the result at either end; for a choice the smallest and the largest of its levels
    at_low, at_high : the values of the input there
    """

    input: str
    low: float
    high: float
    at_low: str
    at_high: str


class Samples:
    """The runs of a sample as a table, and what follows from them.

    Attributes
    ----------
    title : of the study, with the labels of its axes
    inputs : the uncertain deck keys with their distributions
    table : pandas.DataFrame, a row for each run
        ``row`` (of the table of points, from 1), the inputs by their head, such as ``body.rod.velocity [m/s]``, ``status``, and
        the results in SI units, as in samples.csv; NaN where a run has none
    labels : dict of the label on each axis of the study, by name; empty without axes
    """

    def __init__(self, title: str, inputs: Sequence[Distribution], table: pandas.DataFrame, *, wanted: Sequence[str] = (),
                 labels: Mapping[str, str] | None = None, wrong: Sequence[str] = (), summaries: Sequence[Summary] = ()):
        self.title, self.inputs, self.table, self.wanted = title, tuple(inputs), table, tuple(wanted)
        self.labels, self._wrong, self._summaries = dict(labels or {}), wrong, summaries

    def __len__(self) -> int:
        return len(self.table)

    def __repr__(self) -> str:
        return f"<Samples {self.title}: {len(self)} runs, {int(self.ended.sum())} done; inputs {', '.join(self.heads)}>"

    @property
    def heads(self) -> list[str]:
        """The columns of the inputs."""
        return [each.head for each in self.inputs]

    @cached_property
    def ended(self) -> np.ndarray:
        """Which runs are done, bool[runs]. The others failed, became unphysical, or have not ended."""
        return (self.table[STATUS] == DONE).to_numpy()

    @property
    def results(self) -> list[str]:
        """The names of the results of the table."""
        about = {sampling.AXIS, MEMBER, STATUS, OF_METHOD, *self.heads}
        return [name for name in self.table if name not in about]

    @property
    def usual(self) -> list[str]:
        """The results that are shown if none is named: those that the study asks for, and depth and others if they vary."""
        asked = [name for name in self.wanted if len(_finite(self.values(name)))]
        others = [name for name in self.results if name.startswith(("derived.", "bodies."))]
        varied = [name for name in dict.fromkeys((*USUAL, *others)) if name in self.table and name not in asked
                  and surrogates.vary(_finite(self.values(name)))]
        return [*asked, *varied[: max(0, MOST_USUAL - len(asked))]]

    @property
    def missed(self) -> list[str]:
        """Messages about results that the study asks for and that no run has, though some are done."""
        if not self.ended.any():
            return []
        empty = [name for name in self.wanted if not len(_finite(self.values(name)))]
        known = self._known.difference(empty, sample_section.WORDS)
        return [f"sample.results: no run has such a number: {unknown('result', name, known)}" for name in empty]

    @property
    def doubts(self) -> list[str]:
        """Messages about runs that are done but are not trusted, or were cut off before the projectile was seen to rest.

        Before them come those about entries of samples.csv that the runs contradict.
        """
        doubts, count = [*self._wrong], int(self.ended.sum())
        if poor := self._with("trustworthy", "False"):
            doubts.append(f"{poor} of {count} runs are not trustworthy; the summary of each says why")
        if short := self._with(FINAL, "False"):
            doubts.append(f"{short} of {count} runs ended at their end time or number of cycles with the projectile still "
                          "moving: their depths and outcomes are not final")
        return doubts

    def _with(self, name: str, word: str) -> int:
        """The number of runs that are done with a word in a column."""
        return int((self.table.loc[self.ended, name] == word).sum()) if name in self.table else 0

    # ------------------------------------------------------------------------------------------------ one number a run

    def is_outcome(self, result: str) -> bool:
        """Whether a result is an outcome, which is true or false for each run."""
        return result == PERFORATED or CONDITION.fullmatch(result) is not None

    def values(self, result: str) -> np.ndarray:
        """A result as numbers, float64[runs], NaN for runs that are not done.

        result : a number of the table or of summary.json; or an outcome, which is 1 where it is true and 0 elsewhere:
            ``perforated``, ``regime = eroding``, ``depth_m > 0.35``

        Raises StudyError for an unknown name.
        """
        if result == PERFORATED:
            result = f"{PERFORATED} = {YES}"
        match = CONDITION.fullmatch(result)
        if match is None:
            return np.where(self.ended, self._numbers(result), np.nan)
        column, name = self._column(match["name"]), match["name"]
        return np.where(self.ended & column.notna(), self._is_true(column, name, match["sign"], match["limit"]), np.nan)

    def _is_true(self, column: pandas.Series, name: str, sign: str, limit: str) -> pandas.Series:
        if sign == "=":
            if not _is_words(column):
                raise StudyError(f"{name} = {limit}: {name} is a number; compare it by > or <")
            words = {*column.dropna(), *WORDS.get(name, ())}
            if limit not in words:
                raise StudyError(f"{name} = {limit}: {unknown('outcome', limit, words)}")
            return column == limit
        try:
            number = float(limit)
        except ValueError:
            raise StudyError(f"{name} {sign} {limit}: {limit} is not a number; results are in SI units") from None
        if _is_words(column):
            raise StudyError(f"{name} {sign} {limit}: {name} is a word; compare it by =")
        return SIGNS[sign](column, number)

    def _numbers(self, name: str) -> pandas.Series:
        column = self._column(name)
        if _is_words(column):
            raise StudyError(f'{name} is a word; name an outcome, such as "{name} = {min(column.dropna(), default="rigid")}"')
        return column

    def _column(self, name: str) -> pandas.Series:
        """A column of the table, or a number of the summaries of the runs."""
        for table in (self.table, self._of_summaries):
            if name in table:
                return table[name]
        raise StudyError(unknown("result", name, self._known))

    @cached_property
    def _of_summaries(self) -> pandas.DataFrame:
        """The numbers of the summaries of the runs by dotted name."""
        import pandas

        known = [numbers(each.model_dump(exclude={"provenance"})) for each in self._summaries]
        return pandas.DataFrame(known, self.table.index if known else None, dtype=float)

    @property
    def _known(self) -> set[str]:
        """The names of results, of the table and of the summaries."""
        return {*self.results, *self._of_summaries}

    def by_row(self, result: str) -> tuple[np.ndarray, np.ndarray]:
        """The rows with a result, int64[n], and their results, float64[n]: means over the members of a row."""
        import pandas

        means = pandas.Series(self.values(result)).groupby(self.table[sampling.AXIS].to_numpy(int)).mean().dropna()
        return means.index.to_numpy(), means.to_numpy()

    # ------------------------------------------------------------------------------------------------ spreads and fractions

    def spread(self, result: str) -> Spread | None:
        """Median of a result, its 10 % and 90 % quantiles, and the number of runs; None if no run has it."""
        return spread(_finite(self.values(result)))

    def fractions(self, outcome: str) -> dict[str, Fraction]:
        """The fraction of each outcome by its word, the most frequent first.

        outcome : ``regime``, ``perforated``, another column of words, or a condition such as ``depth_m > 0.35``, whose words
            are "yes" and "no"

        With members of an ensemble, the interval is that of as many runs as there are rows, since members are no further draws
        of the inputs. Raises StudyError for an unknown name, and if no run is done.
        """
        if CONDITION.fullmatch(outcome):
            numbers = self.values(outcome)
            words = self.table[STATUS].mask(numbers == 1.0, YES).mask(numbers == 0.0, NO).mask(np.isnan(numbers))
        elif _is_words(words := self._column(outcome)):
            words = words.where(self.ended)
        else:
            raise StudyError(f"{outcome} is a number; give a condition, such as \"{outcome} > 0.1\"")
        counts = Counter(words.dropna())
        trials, missing = counts.total(), len(self) - counts.total()
        if not trials:
            raise StudyError(f"{outcome}: no run has it yet")
        rows = self.table[sampling.AXIS][words.notna()].nunique()
        return {word: Fraction(word, _share(number, trials, rows), number / len(self), (number + missing) / len(self))
                for word, number in counts.most_common()}

    # ------------------------------------------------------------------------------------------------ what decides a result

    @lru_cache(maxsize=16)  # noqa: B019 (a sample lives as long as its study)
    def surrogate(self, result: str) -> surrogates.Surrogate:
        """The surrogate of a result, with its error ``q2`` and ``rmse``; called with points of the unit cube it gives the mean.

        result : as for `values`

        Raises StudyError for an unknown result, too few rows, or a result that does not vary.
        """
        rows, values = self.by_row(result)
        try:
            return surrogates.fit(self.inputs, self.cube(rows), values)
        except StudyError as error:
            raise StudyError(f"{result}: {error}") from None

    def points(self, values: Mapping[str, Sequence | np.ndarray]) -> np.ndarray:
        """Points of the unit cube, float64[n, inputs], for the surrogate: those with these values of the inputs.

        values : of every input by its deck key or its column, in the unit of the column, n each

        Raises StudyError for an unknown or a missing input.
        """
        names = {name: each for each in self.inputs for name in (each.key, each.head)}
        given = {}
        for name, own in values.items():
            if name not in names:
                raise StudyError(unknown("input", name, self.heads))
            given[names[name]] = own
        if missing := [each.head for each in self.inputs if each not in given]:
            raise StudyError(f"there are no values of {missing[0]}")
        return np.column_stack([each.points(given[each]) for each in self.inputs])

    def cube(self, rows: np.ndarray) -> np.ndarray:
        """The points of rows in the unit cube, float64[n, inputs]: the cumulative probability of each value."""
        chosen = self.table.drop_duplicates(sampling.AXIS).set_index(sampling.AXIS).loc[rows]
        return np.column_stack([each.points(chosen[each.head]) for each in self.inputs])

    @lru_cache(maxsize=16)  # noqa: B019
    def indices(self, result: str) -> sobol.Indices:
        """The Sobol indices of a result with 90 % intervals: the share of its variance that each input explains.

        Raises StudyError as `surrogate` does, and if the surrogate predicts less than half of the variance.
        """
        return sobol.indices(result, self.surrogate(result))

    def effects(self, result: str) -> list[Effect]:
        """The effect of each input on a result, the largest first. Raises StudyError as `surrogate` does."""
        made = self.surrogate(result)
        effects = [self._effect(made, number) for number in range(len(self.inputs))]
        return sorted(effects, key=lambda each: -abs(each.high - each.low))

    def _effect(self, made: surrogates.Surrogate, number: int) -> Effect:
        each = self.inputs[number]
        if each.kind == CHOICE:
            at = each.points(each.levels)
            values = made(surrogates.along(self.inputs, number, at))
            low, high = int(values.argmin()), int(values.argmax())
            return Effect(each.head, float(values[low]), float(values[high]), each.levels[low], each.levels[high])
        low, high = map(float, made(surrogates.along(self.inputs, number, np.array([LOW, HIGH]))))
        ends = [f"{value:.4g} {each.unit}".rstrip() for value in each.quantiles(np.array([LOW, HIGH]))]
        return Effect(each.head, low, high, *ends)

    def scatter(self, result: str):
        """A matplotlib Figure: the result against each input, and the surrogate along it with the others at their medians."""
        from hydro2d.study.samples import drawing

        return drawing.scatter(self, result)

    def tornado(self, result: str):
        """A matplotlib Figure: the effect of each input on the result from 10 to 90 % of its values, by the surrogate.

        Raises StudyError as `surrogate` does.
        """
        from hydro2d.study.samples import drawing

        return drawing.tornado(self, result)


def _is_words(column: pandas.Series) -> bool:
    return column.dtype.kind not in "if"


def _finite(values: np.ndarray) -> np.ndarray:
    return values[np.isfinite(values)]


def _share(successes: int, trials: int, rows: int) -> Share:
    """A fraction of runs with its interval; of as many runs as rows if rows have members."""
    share = wilson(successes, trials)
    if rows == trials:
        return share
    low, high = wilson_interval(share.fraction, rows)
    return share._replace(low=low, high=high)


# ------------------------------------------------------------------------------------------------ of a study


def of_study(study: Study) -> list[Samples]:
    """The samples of a study: one for each combination of its axes. Raises StudyError if it has none, or not yet."""
    if study.sample is None:
        raise StudyError(f"{study.directory} is not a study with [sample]")
    table, wrong = sample_table.read(study)
    cases, axes = {case.name: case for case in study.cases}, [axis.name for axis in study.axes[:-1]]
    table = sample_table.values(table.drop(columns=[*axes, *(f"{name} (axis)" for name in axes)], errors="ignore"),
                                study.sample.inputs)
    groups: dict[tuple[str, ...], list[str]] = {}
    for case in study.cases:
        groups.setdefault(tuple(case.values[name] for name in axes), []).append(case.name)
    return [Samples(", ".join([study.title, *(axis.said(label) for axis, label in zip(study.axes, labels, strict=False))]),
                    study.sample.inputs, table.loc[names], wanted=study.sample.results,
                    labels=dict(zip(axes, labels, strict=True)), wrong=[wrong[name] for name in names if name in wrong],
                    summaries=[cases[name].summary for name in names])
            for labels, names in groups.items()]
