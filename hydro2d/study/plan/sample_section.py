"""The section [sample] of a study file: inputs that are uncertain, each with its distribution, or a table of points."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from hydro2d.base import units
from hydro2d.base.keys import Section, Words

#: the kinds of distributions; those of numbers that may have bounds
KINDS = ("normal", "lognormal", "uniform", "choice")
BOUNDED = ("normal", "lognormal")
#: most points of a sample
MOST = 10_000

Quantity = float | int | str


def in_one_unit(values: tuple[Quantity, ...]) -> tuple[tuple[float, ...], str]:
    """Numbers in the unit of the first one, and that unit; it is empty for plain numbers. Raises ValueError."""
    first = _unit(values[0])
    if not first:
        return tuple(_plain(value) for value in values), ""
    factor, si = units.of_kinds(f"1 {first}", units.KINDS)
    return tuple(_number(value, first, si, factor) for value in values), first


def _unit(value: Quantity) -> str:
    return value.strip().partition(" ")[2].strip() if isinstance(value, str) else ""


def _plain(value: Quantity) -> float:
    if _unit(value):
        raise ValueError(f"{value!r} has a unit and the first number has none")
    return units.to_si(value, "1")


def _number(value: Quantity, unit: str, si: str, factor: float) -> float:
    own = _unit(value)
    if not own:
        raise ValueError(f"{value!r} has no unit, and the first number has {unit}")
    return float(str(value).strip().partition(" ")[0]) if own == unit else units.to_si(value, si) / factor


def _filled(values: tuple) -> tuple:
    if len(values) < 2:
        raise ValueError("needs at least two values")
    if len({str(value) for value in values}) < len(values):
        raise ValueError("has a value twice")
    return values


Pair = tuple[Quantity, Quantity]
#: how a number relates to the value of the deck
DIFFERENCE, FACTOR = "difference", "factor"


class Input(Section):
    """The distribution of a deck key, whose values are independent of those of the other keys."""

    normal: Pair | None = Field(None, description="mean and standard deviation")
    lognormal: Pair | None = Field(None, description="median, and the factor of one standard deviation: two thirds of the "
                                   "values lie between the median over it and the median times it")
    uniform: Pair | None = Field(None, description="lowest and highest value")
    choice: Annotated[tuple[Any, ...], AfterValidator(_filled)] | None = Field(None, description="values, such as materials")
    within: Pair | None = Field(None, description="with normal or lognormal: bounds; the distribution is cut off there")
    weights: tuple[float, ...] | None = Field(
        None, description="with choice: how often each value occurs, relative to the others"
    )
    relative: Literal["difference", "factor"] | None = Field(
        None, description="the numbers are added to the value of the deck, or multiply it, so that decks of different values "
        "can share an input"
    )

    @model_validator(mode="after")
    def _one(self):
        given = [kind for kind in KINDS if getattr(self, kind) is not None]
        if len(given) != 1:
            raise ValueError(f"give one of {', '.join(KINDS)}; given: {' and '.join(given) or 'none'}")
        if self.within is not None and self.kind not in BOUNDED:
            raise ValueError(f"within belongs to {' and '.join(BOUNDED)}")
        if self.weights is not None:
            self._weighed()
        if self.kind != "choice":
            self._ordered()
        if self.relative:
            self._related()
        return self

    @property
    def kind(self) -> str:
        """The kind of the distribution."""
        return next(kind for kind in KINDS if getattr(self, kind) is not None)

    def _weighed(self) -> None:
        if self.kind != "choice":
            raise ValueError("weights belongs to choice")
        if len(self.weights) != len(self.choice) or min(self.weights) <= 0.0:
            raise ValueError(f"weights has {len(self.weights)} numbers, choice {len(self.choice)} values; "
                             "give a positive number for each")

    def _related(self) -> None:
        if self.kind == "choice":
            raise ValueError("relative belongs to numbers, not to choice")
        if self.relative == FACTOR and (unit := self.numbers()[2]):
            raise ValueError(f'relative = "factor": a factor is a plain number, and the numbers are in {unit}')

    def _ordered(self) -> None:
        """Checks the numbers. Raises ValueError."""
        numbers, within, _ = self.numbers()
        first, second = numbers
        if self.kind == "uniform" and not first < second:
            raise ValueError("uniform: the second number must be greater than the first")
        if self.kind == "normal" and not second > 0.0:
            raise ValueError("normal: the standard deviation must be positive")
        if self.kind == "lognormal" and not (first > 0.0 and second > 1.0):
            raise ValueError("lognormal: the median must be positive, and the factor greater than 1")
        if within and not within[0] < within[1]:
            raise ValueError("within: the second number must be greater than the first")
        if within and self.kind == "lognormal" and within[0] < 0.0:
            raise ValueError("within: a lognormal quantity is positive")

    def numbers(self) -> tuple[tuple[float, float], tuple[float, float] | None, str]:
        """The two numbers of a distribution of numbers, its bounds, and their unit. Raises ValueError."""
        first, second = getattr(self, self.kind)
        bounds = self.within or ()
        if self.kind == "lognormal":
            (first, *bounds), unit = in_one_unit((first, *bounds))
            second = units.to_si(second, "1")
        else:
            (first, second, *bounds), unit = in_one_unit((first, second, *bounds))
        if not all(map(math.isfinite, (first, second, *bounds))):
            raise ValueError("a number is not finite")
        return (first, second), (bounds[0], bounds[1]) if bounds else None, unit


#: smallest eigenvalue of a matrix of correlations that is positive definite and not only so by round-off
DEFINITE = 1e-9


class Joint(Section):
    """Deck keys that are normally distributed together, such as the two constants of one fit."""

    keys: tuple[str, ...] = Field(description="the deck keys")
    mean: tuple[Quantity, ...] = Field(description="mean of each")
    covariance: tuple[tuple[float, ...], ...] = Field(
        description="a row of numbers for each key; a number has the unit of the mean of its row times that of its column"
    )

    @model_validator(mode="after")
    def _whole(self):
        count = len(self.keys)
        if count < 2:
            raise ValueError("keys: needs at least two keys; one alone belongs to [sample.input]")
        if twice := [key for number, key in enumerate(self.keys) if key in self.keys[:number]]:
            raise ValueError(f"keys: has {twice[0]} twice")
        if len(self.mean) != count:
            raise ValueError(f"mean: has {len(self.mean)} values, and keys {count}")
        if {len(row) for row in (self.covariance, *self.covariance)} != {count}:
            raise ValueError(f"covariance: needs {count} rows of {count} numbers, one for each key")
        means = [in_one_unit((value,))[0][0] for value in self.mean]
        if not all(map(math.isfinite, (*means, *itertools.chain(*self.covariance)))):
            raise ValueError("a number is not finite")
        self._definite()
        return self

    def _definite(self) -> None:
        """Checks the covariance. Raises ValueError."""
        numbers = range(len(self.keys))
        for i, j in itertools.combinations(numbers, 2):
            above, below = self.covariance[i][j], self.covariance[j][i]
            if not math.isclose(above, below, rel_tol=1e-9):
                raise ValueError(f"covariance: is not symmetric: row {i + 1} has {above:g} in column {j + 1}, row {j + 1} has "
                                 f"{below:g} in column {i + 1}")
        for i in numbers:
            if not self.covariance[i][i] > 0.0:
                raise ValueError(f"covariance: the variance of {self.keys[i]}, in row and column {i + 1}, must be positive")
        least = float(np.linalg.eigvalsh(self.correlation())[0])
        if least < DEFINITE:
            raise ValueError(f"covariance: is not positive definite: the smallest eigenvalue of its matrix of correlations is "
                             f"{least:.3g}")

    def correlation(self) -> np.ndarray:
        """The correlations of the keys, float64[keys, keys]."""
        covariance = np.array(self.covariance)
        deviations = np.sqrt(np.diag(covariance))
        return covariance / np.outer(deviations, deviations)


#: a change that should not matter
Change = Literal["mesh offset", "flank offset", "first step"]


def different(values: tuple) -> tuple:
    """The names of changes, each once. Raises ValueError."""
    if len(set(values)) < len(values):
        raise ValueError("names a change twice")
    if not values:
        raise ValueError("is empty; at least one entry is needed")
    return values


#: results that are words, which every table of results has
WORDS = ("status", "stop_reason", "trustworthy", "regime", "perforated", "final", "depth_is", "depth_error_is")


def _numbers(names: tuple[str, ...]) -> tuple[str, ...]:
    """Names of results that can be numbers. Raises ValueError."""
    for name in names:
        if name in WORDS:
            raise ValueError(f"{name} is a word, and samples.csv has it anyway; name numbers of summary.json")
    return names


def _by_key(table: Any) -> Any:
    """The tables of [sample.input] by deck key; sample.input.body.rod.velocity and a quoted key are the same."""
    return dict(_leaves(table, "")) if isinstance(table, dict) else table


def _leaves(table: dict, key: str) -> Iterator[tuple[str, Any]]:
    if key and not (table and all(isinstance(value, dict) for value in table.values())):
        yield key, table
        return
    for name, value in table.items():
        own = f"{key}.{name}" if key else name
        if isinstance(value, dict):
            yield from _leaves(value, own)
        else:
            yield own, value


class Sample(Section):
    """Points of uncertain inputs; every case of the study runs at each of them."""

    table: str | None = Field(
        None, min_length=1, description="CSV file, in the folder of this one, with a row for each point; a head is a deck key "
        "with the unit of its column, such as body.rod.velocity [m/s]"
    )
    method: Literal["sobol", "latin-hypercube"] | None = Field(None, description="how the points are made from the inputs")
    n: int | None = Field(None, ge=2, le=MOST, description="number of points; for sobol a power of two")
    seed: int | None = Field(None, ge=0, le=2**32, description="another seed makes other points; default 0")
    input: Annotated[dict[str, Input], BeforeValidator(_by_key)] = Field({}, description="distribution of each deck key")
    joint: tuple[Joint, ...] = Field((), description="keys that are normally distributed together")
    by: Annotated[tuple[Change, ...], AfterValidator(different)] | None = Field(
        None, description="changes that should not matter, by another amount in every row, so that what no input explains is "
        "the chance of a run; their meaning is that of [ensemble]"
    )
    results: Annotated[tuple[Words, ...], AfterValidator(_numbers)] = Field(
        (), description="numbers of summary.json that samples.csv has beside the usual ones"
    )

    @model_validator(mode="after")
    def _one_way(self):
        if (self.table is None) == (self.method is None):
            raise ValueError("give either table or method")
        if self.table is not None:
            extra = [name for name in ("n", "seed", "input", "joint") if name in self.model_fields_set]
            if extra:
                raise ValueError(f"{' and '.join(extra)}: belongs to method; a table has its own points")
        elif self.n is None or not (self.input or self.joint):
            raise ValueError(f'method = "{self.method}" needs n, and a table of its distribution for each input, such as '
                             '[sample.input."body.rod.velocity"]')
        return self
