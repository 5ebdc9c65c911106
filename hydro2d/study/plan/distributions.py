"""The distribution of an uncertain input: its values at points between 0 and 1, and the point of a value.

A point is the cumulative probability of a value, so that independent inputs fill the unit cube evenly, and those of a joint
distribution (joint.py) fill it as they go along with each other. A choice has levels: its
point lies within the level's share of 0 to 1. An input of a table has the empirical distribution of its column.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hydro2d.files import toml
from hydro2d.study.plan.sample_section import DIFFERENCE, FACTOR, Input, Joint, in_one_unit

#: significant digits of a value in a deck; the last bits of a quantile may differ between machines
DIGITS = 9
#: no point is nearer to 0 or 1: the quantiles there are infinite
CLOSEST = 2.0**-31
CHOICE, TABLE = "choice", "table"
#: the end of a distribution in words
RELATIVE = {DIFFERENCE: ", added to the value of the deck", FACTOR: ", times the value of the deck"}
#: smallest probability between the bounds of a distribution
LEAST = 1e-6


@dataclass(frozen=True)
class Distribution:
    """An uncertain input: a deck key and the distribution of its values.

    key : the deck key
    kind : normal, lognormal, uniform, choice, or table for a column of points
    unit : of the values, as it was written; empty for plain numbers and words
    numbers, within : parameters and bounds in this unit
    levels, weights : of a choice: its values as text, in order, and the probability of each
    column : of a table, its numbers, sorted
    relative : "difference" or "factor", for numbers that are added to the value of the deck or multiply it
    joint, correlation : the keys that are normally distributed together with this one, itself among them, and its correlation
        with each
    """

    key: str
    kind: str
    unit: str = ""
    numbers: tuple[float, ...] = ()
    within: tuple[float, float] | None = None
    levels: tuple[str, ...] = ()
    weights: tuple[float, ...] = ()
    column: tuple[float, ...] = ()
    relative: str = ""
    joint: tuple[str, ...] = ()
    correlation: tuple[float, ...] = ()

    @property
    def head(self) -> str:
        """The key with its unit, as the head of a column."""
        name = f"{self.key} ({self.relative})" if self.relative else self.key
        return f"{name} [{self.unit}]" if self.unit else name

    @property
    def words(self) -> str:
        """The distribution in words."""
        unit = f" {self.unit}" if self.unit else ""
        if self.kind == CHOICE:
            return ", ".join(f"{level} ({100 * weight:.3g} %)" for level, weight in zip(self.levels, self.weights, strict=True))
        if self.kind == TABLE:
            return f"{len(self.column)} values from {self.column[0]:.6g} to {self.column[-1]:.6g}{unit}"
        first, second = self.numbers
        bounds = f", within {self.within[0]:.6g} to {self.within[1]:.6g}{unit}" if self.within else ""
        return {
            "normal": f"normal, mean {first:.6g}{unit}, standard deviation {second:.6g}{unit}",
            "lognormal": f"lognormal, median {first:.6g}{unit}, factor {second:.6g}",
            "uniform": f"uniform from {first:.6g} to {second:.6g}{unit}",
        }[self.kind] + bounds + RELATIVE.get(self.relative, "") + "".join(
            f", correlation {number:.3g} with {key}" for key, number in zip(self.joint, self.correlation, strict=True)
            if key != self.key)

    def data(self) -> dict[str, Any]:
        """The contents as plain data, for JSON."""
        return {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items() if value}

    @classmethod
    def of_data(cls, data: dict[str, Any]) -> Distribution:
        """The inverse of `data`. Raises TypeError, ValueError, LookupError or ArithmeticError for what no distribution has."""
        made = cls(**{name: tuple(value) if isinstance(value, list) else value for name, value in data.items()})
        numbers = (*made.numbers, *made.weights, *made.column, *(made.within or ()), *made.correlation)
        texts = (made.key, made.kind, made.unit, made.relative, *made.levels, *made.joint)
        if not all(isinstance(text, str) for text in texts):
            raise TypeError(f"an input has something else than text: {made}")
        with np.errstate(divide="raise", invalid="raise"):
            count = len(made.points(made.levels or made.numbers[:1] or made.column[:1]))
        if not (all(map(_is_finite, numbers)) and count and made.words):
            raise ValueError(f"an input has no such numbers: {made}")
        return made

    def has(self, value: Any) -> bool:
        """Whether it can have a value, a number in its unit or a label."""
        return value in self.levels if self.kind == CHOICE else _is_finite(value)

    @classmethod
    def of_input(cls, key: str, given: Input) -> Distribution:
        """The distribution of an input of a study file. Raises ValueError if its bounds leave almost nothing of it."""
        if given.choice is not None:
            weights = given.weights or (1.0,) * len(given.choice)
            shares = tuple(weight / sum(weights) for weight in weights)
            return cls(key, CHOICE, levels=tuple(map(label, given.choice)), weights=shares)
        numbers, within, unit = given.numbers()
        made = cls(key, given.kind, unit, numbers, within, relative=given.relative or "")
        low, high = made._ends()
        if high - low < LEAST:
            raise ValueError(f"within: only {high - low:.1g} of the distribution lies between the bounds")
        return made

    @classmethod
    def of_joint(cls, given: Joint) -> list[Distribution]:
        """The distributions of the inputs of a joint one of a study file."""
        columns = zip(given.keys, given.mean, given.covariance, given.correlation().tolist(), strict=True)
        made = []
        for number, (key, mean, row, correlation) in enumerate(columns):
            (middle,), unit = in_one_unit((mean,))
            made.append(cls(key, "normal", unit, (middle, math.sqrt(row[number])), joint=given.keys,
                            correlation=tuple(correlation)))
        return made

    @classmethod
    def of_column(cls, key: str, unit: str, values: Sequence[Any]) -> Distribution:
        """The distribution of a column of a table: numbers, or words, each as often as it occurs."""
        if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
            return cls(key, TABLE, unit, column=tuple(sorted(map(float, values))))
        levels = tuple(dict.fromkeys(map(label, values)))
        counts = [sum(label(value) == level for value in values) for level in levels]
        return cls(key, CHOICE, levels=levels, weights=tuple(count / len(values) for count in counts))

    def values(self, points: np.ndarray) -> list[float] | list[str]:
        """The values at points between 0 and 1, float64[n]: numbers with nine digits in the unit, or labels of levels."""
        if self.kind == CHOICE:
            return [self.levels[level] for level in self.level_of(points)]
        return [float(f"{value:.{DIGITS}g}") for value in self.quantiles(points)]

    def level_of(self, points: np.ndarray) -> np.ndarray:
        """The number of the level of a choice at points between 0 and 1, int64[n]."""
        ends = np.cumsum(self.weights)[:-1]
        return np.searchsorted(ends, np.asarray(points), side="right")

    def quantiles(self, points: np.ndarray) -> np.ndarray:
        """The values of a distribution of numbers at points between 0 and 1, float64[n], in the unit."""
        u = np.clip(np.asarray(points, dtype=float), CLOSEST, 1.0 - CLOSEST)
        if self.kind == TABLE:
            return np.interp(u, self._ranks(), self.column)
        if self.kind == "uniform":
            low, high = self.numbers
            return low + u * (high - low)
        from scipy.special import ndtri

        low, high = self._ends()
        z = ndtri(np.clip(low + u * (high - low), CLOSEST, 1.0 - CLOSEST))
        first, second = self.numbers
        values = first + second * z if self.kind == "normal" else first * np.exp(math.log(second) * z)
        return values if self.within is None else np.clip(values, *self.within)

    def points(self, values: Sequence[Any]) -> np.ndarray:
        """The cumulative probability of values in the unit, float64[n]; for labels of levels the middle of their share.

        Raises ValueError for a label that is no level.
        """
        if self.kind == CHOICE:
            ends = np.cumsum(self.weights)
            middles = ends - 0.5 * np.array(self.weights)
            return np.array([middles[self.levels.index(str(value))] for value in values])
        x = np.asarray(values, dtype=float)
        if self.kind == TABLE:
            return np.interp(x, *self._steps())
        if self.kind == "uniform":
            low, high = self.numbers
            return np.clip((x - low) / (high - low), 0.0, 1.0)
        low, high = self._ends()
        return np.clip((self._below(x) - low) / (high - low), 0.0, 1.0)

    def _below(self, x: np.ndarray) -> np.ndarray:
        """Probability of values below x without the bounds."""
        from scipy.special import ndtr

        first, second = self.numbers
        with np.errstate(divide="ignore"):
            z = (x - first) / second if self.kind == "normal" else (np.log(x) - math.log(first)) / math.log(second)
        return ndtr(z)

    def _ends(self) -> tuple[float, float]:
        """Probabilities of the bounds without them."""
        if self.within is None:
            return 0.0, 1.0
        low, high = self._below(np.array(self.within))
        return float(low), float(high)

    def _ranks(self) -> np.ndarray:
        """Cumulative probabilities of the sorted numbers of a column, by the middle of each one's share."""
        count = len(self.column)
        return (np.arange(count) + 0.5) / count

    def _steps(self) -> tuple[np.ndarray, np.ndarray]:
        """The different numbers of a column and their cumulative probabilities."""
        numbers, first, counts = np.unique(self.column, return_index=True, return_counts=True)
        return numbers, (first + 0.5 * counts) / len(self.column)


def _is_finite(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def label(value: Any) -> str:
    """A value of a choice as a study file has it."""
    return value if isinstance(value, str) else toml.inline(value)
