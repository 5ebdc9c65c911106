"""Descriptions of material models: their parameters, and their pages for ``hydro2d info``.

A model is a module with the constants ``NAME`` (its name in decks), ``ID`` (the integer that kernels compare), ``EQUATION``,
``SOURCE``, ``VALIDITY`` and ``PARAMETERS``, and a function ``row(values)`` that packs the parameters into the one-dimensional
float64 array that its ``@point`` functions read.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any, Protocol

from hydro2d.base.errors import unknown
from hydro2d.base.tables import Table


class Required:
    """The default of a parameter that must be given."""

    def __repr__(self) -> str:
        return "required"


REQUIRED = Required()

SIGNS = ANY, POSITIVE, NON_NEGATIVE, FRACTION = "any", "positive", "non-negative", "fraction"


def check_sign(name: str, number: float, sign: str, error: type[ValueError] = ValueError) -> None:
    """Raises an error for a number outside its range; sign : ANY, POSITIVE, NON_NEGATIVE or FRACTION (at least 0, below 1)."""
    inside = {ANY: True, POSITIVE: number > 0.0, NON_NEGATIVE: number >= 0.0, FRACTION: 0.0 <= number < 1.0}[sign]
    if not inside:
        raise error(f"{name} = {number:g}: must be {'at least 0 and below 1' if sign == FRACTION else sign}")


@dataclass(frozen=True)
class Parameter:
    """One number of a material model, or one key of an edge, a nose or a source.

    ``unit`` is in SI, and empty for a pure number. ``default`` is a float, ``REQUIRED``, or None if it may be left out; only a
    parameter with an infinite default may be infinite. ``sign`` is ``ANY``, ``POSITIVE`` or ``NON_NEGATIVE``. ``from_eos``
    marks a property of the material that its equation of state also has, under the same name. ``example`` is a value as written
    in a deck, for its reference page. With ``table`` the value is not one number but a table of rows; ``unit`` then has
    the unit of each column, with commas, and ``sign`` is that of the last one.
    """

    name: str
    unit: str
    default: float | Required | None
    description: str
    symbol: str = ""
    sign: str = NON_NEGATIVE
    from_eos: bool = False
    example: Any = None
    table: Table | None = None

    @property
    def required(self) -> bool:
        return isinstance(self.default, Required)

    def check(self, value: float) -> float:
        """The value as a float. Raises ValueError if it is not a number or outside the range of the parameter."""
        number = float(value)
        if math.isnan(number) or (math.isinf(number) and number != self.default):
            raise ValueError(f"{self.name} = {number:g}: not a finite number")
        check_sign(self.name, number, self.sign)
        return number


class Declared(Protocol):
    """A quantity that a model declares: a parameter of a material model, an input of an analytic one."""

    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def default(self) -> Any: ...

    def check(self, value: Any) -> Any:
        """The value as the model takes it. Raises ValueError for an impossible one."""


def collect(model: str, declared: Iterable[Declared], values: Mapping[str, Any], noun: str = "parameter",
            error: type[ValueError] = ValueError) -> dict[str, Any]:
    """Every declared quantity by name, with defaults filled in.

    noun : word for a quantity in messages;  error : raised for a missing, unknown or impossible value
    """
    known = {each.name: each for each in declared}
    for name in values:
        if name not in known:
            raise error(f"{model}: {unknown(noun, str(name), known)}")
    collected = {}
    for name, each in known.items():
        value = values.get(name, each.default)
        if isinstance(value, Required):
            unit = "" if each.unit in ("", "1") else f", {each.unit}"
            raise error(f"{model}: {noun} {name!r} is missing ({each.description}{unit})")
        try:
            collected[name] = each.check(value)
        except ValueError as problem:
            raise error(f"{model}: {problem}") from None
    return collected


@dataclass(frozen=True)
class Description:
    """The page of a model in ``hydro2d info``."""

    name: str
    kind: str
    equation: str
    source: str
    validity: str
    parameters: tuple[Parameter, ...]

    def table(self) -> list[tuple[str, str, str, str, str]]:
        """Rows (name, symbol, unit, default, description)."""
        return [
            (entry.name, entry.symbol, entry.unit or "1", _shown(entry.default), entry.description)
            for entry in self.parameters
        ]

    def __str__(self) -> str:
        rows = [("parameter", "symbol", "unit", "default", "meaning"), *self.table()]
        widths = [max(len(row[column]) for row in rows) for column in range(5)]
        lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
        table = "\n".join(lines) if self.parameters else "no parameters"
        head = f"{self.name} ({self.kind})\n\n{self.equation}"
        return f"{head}\n\nValidity: {self.validity}\nSource: {self.source}\n\n{table}\n"


def _shown(default: float | Required | None) -> str:
    return f"{default:g}" if isinstance(default, (int, float)) else repr(default)


def described(module: ModuleType, kind: str) -> Description:
    """The description of a model, from the constants of its module."""
    return Description(module.NAME, kind, module.EQUATION, module.SOURCE, module.VALIDITY, module.PARAMETERS)


def by_name(name: str, kind: str, models: Mapping[str, ModuleType]) -> ModuleType:
    """The module of a model. Raises ValueError with the nearest name if there is none."""
    if name not in models:
        raise ValueError(unknown(kind, name, models))
    return models[name]
