"""The description of an analytic model: its inputs, its outputs, and how it is evaluated."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TypeVar

import numpy as np

from hydro2d.base import units
from hydro2d.base.errors import Error, unknown
from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE, REQUIRED, Required, check_sign, collect


class InputError(Error, ValueError):
    """An input that a model cannot take; the message is for the user."""


Value = float | str | None
T = TypeVar("T")

#: allowed range of an input by its unit: the ranges of decks, and that of pure numbers
REACH = {**units.REACH, "1": (1e-18, 1e18, "no pure number of an impact is so small or so large")}
#: the reason why a model gives no number although it accepts each of its inputs
BEYOND = "each of these inputs is possible, but together they are beyond what the model can compute"


@dataclass(frozen=True)
class Input:
    """One quantity that a model needs.

    ``name`` comes from the shared vocabulary (``inputs.py``); ``unit`` is in SI, "1" for a pure number. ``default`` is a
    number, a word if there are ``choices``, None if the model can do without the input, or ``REQUIRED``. ``sign`` is ``ANY``,
    ``POSITIVE``, ``NON_NEGATIVE`` or ``FRACTION`` (at least 0 and below 1).
    """

    name: str
    unit: str
    description: str
    symbol: str = ""
    default: Value | Required = REQUIRED
    sign: str = POSITIVE
    choices: tuple[str, ...] = ()

    @property
    def required(self) -> bool:
        return isinstance(self.default, Required)

    @property
    def keyword(self) -> str:
        """The name of the argument of ``evaluate``: rod.density is rod_density."""
        return self.name.replace(".", "_")

    def but(self, **changes) -> Input:
        """This input with a different default, symbol or description for one model."""
        return replace(self, **changes)

    def check(self, value: Value) -> Value:
        """The value as a float, or unchanged if it is a word; InputError if it is impossible."""
        if value is None and self.default is None:
            return None
        if self.choices:
            if value not in self.choices:
                raise InputError(f"{self.name}: {unknown('value', str(value), self.choices)}")
            return value
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise InputError(f"{self.name} = {value!r}: not a number") from None
        complain(self.name, number, self.sign)
        return _within(self.name, number, self.unit)


@dataclass(frozen=True)
class Output:
    """One quantity that a model gives; ``unit`` as for an input, "" for a word such as the regime."""

    name: str
    unit: str
    description: str
    symbol: str = ""


@dataclass(frozen=True)
class Motion:
    """The motion of a rod from first contact to the end of its penetration, arrays float64[n].

    ``time`` (s), ``velocity`` of its tail (m/s), ``depth`` of penetration (m), ``length`` of the rod (m), None if it is not an
    input of the model.
    """

    time: np.ndarray
    velocity: np.ndarray
    depth: np.ndarray
    length: np.ndarray | None = None


@dataclass(frozen=True)
class Example:
    """A shot that illustrates the model: names from the material library, and all else that the figure on its page uses."""

    rod: str
    target: str
    velocity: float
    velocities: tuple[float, float]
    values: Mapping[str, Value] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True)
class Model:
    """An analytic model, for the command line, the pages and the comparison with runs.

    ``evaluate(velocity, **values)`` takes the impact velocity in m/s and every input by keyword, in SI, and gives a
    mapping with the outputs by name. ``main`` is the output that a figure shows. ``transition(**values)``, if there is
    one, gives the impact velocity above which the rod no longer stays rigid, m/s, or None if it always does. ``motion``, if
    there is one, takes the arguments of ``evaluate`` and gives the rod as a function of time.
    """

    name: str
    title: str
    source: str
    validity: str
    inputs: tuple[Input, ...]
    outputs: tuple[Output, ...]
    main: str
    example: Example
    evaluate: Callable[..., Mapping[str, float | str]]
    transition: Callable[..., float | None] | None = None
    motion: Callable[..., Motion] | None = None

    def collect(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Every input by keyword, defaults filled in; InputError for a missing, unknown or impossible value."""
        collected = collect(self.name, self.inputs, values, "input", InputError)
        return {entry.keyword: collected[entry.name] for entry in self.inputs}

    def __call__(self, velocity: float, values: Mapping[str, Value]) -> dict[str, float | str]:
        """The outputs at one impact velocity; InputError for values outside the model's range."""
        complain("velocity", velocity, NON_NEGATIVE)
        _within("velocity", velocity, "m/s")
        given = self.collect(values)
        outputs = self._computed(lambda: dict(self.evaluate(velocity, **given)))
        lost = [name for name, value in outputs.items() if isinstance(value, float) and math.isnan(value)]
        if lost:
            raise InputError(f"{self.name}: {lost[0]} is not a number: {BEYOND}")
        return outputs

    def limit(self, values: Mapping[str, Value]) -> float | None:
        """``transition`` of these inputs by name; InputError for values outside the model's range."""
        given = self.collect(values)
        return self._computed(lambda: self.transition(**given))

    def moves(self, velocity: float, values: Mapping[str, Value]) -> Motion:
        """``motion`` at one impact velocity, with inputs by name; InputError for values outside the model's range."""
        complain("velocity", velocity)
        given = self.collect(values)
        return self._computed(lambda: self.motion(velocity, **given))

    def _computed(self, evaluation: Callable[[], T]) -> T:
        """The result of the equations. If there is none, for example because numbers overflow: InputError or nan."""
        try:
            with np.errstate(all="ignore"):
                return evaluation()
        except InputError:
            raise
        except (ArithmeticError, ValueError) as error:
            raise InputError(f"{self.name}: {error}: {BEYOND}") from None


def _within(name: str, number: float, unit: str) -> float:
    try:
        return units.in_reach(number, unit, REACH)
    except ValueError as error:
        raise InputError(f"{name} {error}") from None


def complain(name: str, number: float, sign: str = POSITIVE) -> None:
    """Raises InputError if a number is not finite or outside its range."""
    if not math.isfinite(number):
        raise InputError(f"{name} = {number}: not a finite number")
    check_sign(name, number, sign, InputError)


def positive(**numbers: float) -> None:
    """Raises InputError for the first number that is not finite and positive."""
    for name, number in numbers.items():
        complain(name, number, POSITIVE)


def non_negative(**numbers: float) -> None:
    """Raises InputError for the first number that is not finite and non-negative."""
    for name, number in numbers.items():
        complain(name, number, NON_NEGATIVE)
