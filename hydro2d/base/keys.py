"""The base of every section of a deck: strict, frozen tables, and numbers with units."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, cast

from annotated_types import GroupedMetadata
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema

from hydro2d.base import units
from hydro2d.base.parameters import ANY, NON_NEGATIVE, POSITIVE, Parameter

#: characters of a name
LONGEST_NAME = 200


def _name(value: str) -> str:
    """A name that can be used in tables, file names and datasets."""
    if not value.strip():
        raise ValueError("is empty")
    if len(value) > LONGEST_NAME:
        raise ValueError(f"has {len(value)} characters; a name has at most {LONGEST_NAME}")
    bad = sorted({character for character in value if character in "/\\" or not character.isprintable()})
    if bad:
        raise ValueError(f"{value!r} has {', '.join(map(repr, bad))}, which names of fields and files cannot contain")
    if value in (".", ".."):
        raise ValueError(f"{value!r} is a folder, not a name")
    return value


#: the name of a body, a tracer or a run
Name = Annotated[str, AfterValidator(_name)]


class Section(BaseModel):
    """A table of the deck: undeclared keys are errors, and values never change after loading."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        """The keys whose values differ from their defaults."""
        fields = type(self).model_fields
        for name, value in super().__repr_args__():
            if name not in fields or fields[name].is_required() or value != fields[name].default:
                yield name, value

    def __str__(self) -> str:
        return repr(self)


def one_of(kinds: Mapping[str, type[Section]], key: str) -> Any:
    """The type of a table that is one of several kinds of sections; the word under ``key`` selects the kind."""
    union, annotated = functools.reduce(operator.or_, kinds.values()), cast(Any, Annotated)
    return annotated[union, Field(discriminator=key)] if len(kinds) > 1 else union  # pydantic discriminates from two on


def _positive(value: float) -> float:
    if value <= 0:
        raise ValueError(f"must be positive, is {value:g}")
    return value


def _not_negative(value: float) -> float:
    if value < 0:
        raise ValueError(f"must not be negative, is {value:g}")
    return value


def _fraction(value: float) -> float:
    if not 0 <= value <= 1:
        raise ValueError(f"must lie between 0 and 1, is {value:g}")
    return value


def _to_si(value, unit: str) -> float:
    return units.in_reach(units.to_si(value, unit), unit)


@dataclass(frozen=True)
class Quantity(GroupedMetadata):
    """Marks a float as a number in ``unit``, given in SI or as a string with a unit, and kept in SI: Annotated[float, ...]."""

    unit: str
    check: Callable[[float], float] | None = None

    def __iter__(self) -> Iterator[object]:
        schema: dict[str, Any] = {"type": "number", "x-unit": self.unit}
        if self.unit != "1":
            schema = {"anyOf": [{"type": "number"}, {"type": "string"}], "x-unit": self.unit}
        yield BeforeValidator(partial(_to_si, unit=self.unit))
        if self.check is not None:
            yield AfterValidator(self.check)
        yield WithJsonSchema(schema)


def within(low: float, high: float, reason: str, unit: str = "1") -> Quantity:
    """A number between two bounds; the message gives the reason for the bounds: Annotated[float, within(...)]."""

    def check(value: float) -> float:
        if not low <= value <= high:
            raise ValueError(f"must lie between {low:g} and {high:g}, is {value:g}: {reason}")
        return value

    return Quantity(unit, check)


Length = Annotated[float, Quantity("m")]
PositiveLength = Annotated[float, Quantity("m", _positive)]
Time = Annotated[float, Quantity("s", _not_negative)]
PositiveTime = Annotated[float, Quantity("s", _positive)]
Speed = Annotated[float, Quantity("m/s")]
PositiveSpeed = Annotated[float, Quantity("m/s", _positive)]
NotNegativeSpeed = Annotated[float, Quantity("m/s", _not_negative)]
PositiveDensity = Annotated[float, Quantity("kg/m^3", _positive)]
Pressure = Annotated[float, Quantity("Pa")]
Temperature = Annotated[float, Quantity("K", _not_negative)]
SpecificEnergy = Annotated[float, Quantity("J/kg")]
Angle = Annotated[float, Quantity("rad", _positive)]
Number = Annotated[float, Quantity("1")]
PositiveNumber = Annotated[float, Quantity("1", _positive)]
Fraction = Annotated[float, Quantity("1", _fraction)]
NotNegative = Annotated[float, Quantity("1", _not_negative)]


#: checks of numbers by the sign of a declared key
_SIGNS: dict[str, Callable[[float], float] | None] = {ANY: None, POSITIVE: _positive, NON_NEGATIVE: _not_negative}


def type_of(declared: Parameter) -> Any:
    """The type of a key that a kind of edge or nose declares: a number in its unit, within the range of its sign."""
    return Annotated[float, Quantity(declared.unit or "1", _SIGNS[declared.sign])]


def optional(declared: Parameter, description: str, kind: Any = None) -> tuple[Any, Any]:
    """Type and field of a declared key that a table may leave out, for `pydantic.create_model`; kind : in place of a number."""
    return (kind or type_of(declared)) | None, Field(None, description=description, examples=[declared.example])


def _pair(value, unit: str) -> tuple[float, float]:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise ValueError(f"expected two numbers or strings in {unit}, [first, second]")
    return _to_si(value[0], unit), _to_si(value[1], unit)


def _interval(value) -> tuple[float, float]:
    low, high = _pair(value, "m")
    if not low < high:
        raise ValueError(f"the second must be greater than the first, is [{low:g}, {high:g}]")
    return low, high


def _velocity(value) -> tuple[float, float]:
    if isinstance(value, (list, tuple)):
        return _pair(value, "m/s")
    return 0.0, _to_si(value, "m/s")


_ITEM_SCHEMA = {"anyOf": [{"type": "number"}, {"type": "string"}]}
_PAIR_SCHEMA = {"type": "array", "items": _ITEM_SCHEMA, "minItems": 2, "maxItems": 2}

#: [low, high] in metres
Interval = Annotated[tuple[float, float], BeforeValidator(_interval), WithJsonSchema({**_PAIR_SCHEMA, "x-unit": "m"})]
#: [r, z] in metres
Point = Annotated[
    tuple[float, float],
    BeforeValidator(partial(_pair, unit="m")),
    WithJsonSchema({**_PAIR_SCHEMA, "x-unit": "m"}),
]
#: axial velocity, or [radial, axial], in m/s
Velocity = Annotated[
    tuple[float, float],
    BeforeValidator(_velocity),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string"}, _PAIR_SCHEMA], "x-unit": "m/s"}),
]
