"""Descriptions of material models: their parameters, and their pages for ``hydro2d info``.

A model is a module with the constants ``NAME`` (its name in decks), ``ID`` (the integer that kernels compare), ``EQUATION``,
``SOURCE``, ``VALIDITY`` and ``PARAMETERS``, and a function ``row(values)`` that packs the parameters into the one-dimensional
float64 array that its ``@point`` functions read.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import ModuleType


class Required:
    """The default of a parameter that must be given."""

    def __repr__(self) -> str:
        return "required"


REQUIRED = Required()

ANY, POSITIVE, NON_NEGATIVE = "any", "positive", "non-negative"


@dataclass(frozen=True)
class Parameter:
    """One number of a material model.

    ``unit`` is in SI, and empty for a pure number. ``default`` is a float or ``REQUIRED``; only a parameter with an infinite
    default may be infinite. ``sign`` is ``ANY``, ``POSITIVE`` or ``NON_NEGATIVE``. ``from_eos`` marks a property of the
    material that its equation of state also has, under the same name.
    """

    name: str
    unit: str
    default: float | Required
    description: str
    symbol: str = ""
    sign: str = NON_NEGATIVE
    from_eos: bool = False

    @property
    def required(self) -> bool:
        return isinstance(self.default, Required)

    def check(self, value: float) -> float:
        """The value as a float. Raises ValueError if it is not a number or outside the range of the parameter."""
        number = float(value)
        if math.isnan(number) or (math.isinf(number) and number != self.default):
            raise ValueError(f"{self.name} = {value}: not a finite number")
        if (self.sign == POSITIVE and number <= 0.0) or (self.sign == NON_NEGATIVE and number < 0.0):
            raise ValueError(f"{self.name} = {value}: must be {self.sign}")
        return number


def collect(model: str, parameters: Iterable[Parameter], values: Mapping[str, float]) -> dict[str, float]:
    """Every parameter of a model by name, with defaults filled in.

    Raises ValueError for a missing, unknown or impossible value.
    """
    known = {parameter.name: parameter for parameter in parameters}
    for name in values:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise ValueError(f"{model}: unknown parameter {name!r}{hint} (known: {', '.join(known) or 'none'})")
    collected = {}
    for name, parameter in known.items():
        if name not in values and parameter.required:
            unit = f", {parameter.unit}" if parameter.unit else ""
            raise ValueError(f"{model}: parameter {name!r} is missing ({parameter.description}{unit})")
        try:
            collected[name] = parameter.check(values.get(name, parameter.default))
        except ValueError as error:
            raise ValueError(f"{model}: {error}") from None
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


def _shown(default: float | Required) -> str:
    return repr(default) if isinstance(default, Required) else f"{default:g}"


def described(module: ModuleType, kind: str) -> Description:
    """The description of a model, from the constants of its module."""
    return Description(module.NAME, kind, module.EQUATION, module.SOURCE, module.VALIDITY, module.PARAMETERS)


def by_name(name: str, kind: str, models: Mapping[str, ModuleType]) -> ModuleType:
    """The module of a model. Raises ValueError with the nearest name if there is none."""
    if name not in models:
        near = difflib.get_close_matches(name, models, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(f"no {kind} is named {name!r}{hint} (known: {', '.join(models)})")
    return models[name]
