"""The base of every section of a deck: strict, frozen tables, and numbers with units."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Any, TypeVar, cast

from annotated_types import GroupedMetadata
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema, create_model

from hydro2d.base import units
from hydro2d.base.parameters import ANY, NON_NEGATIVE, POSITIVE, Parameter
from hydro2d.base.tables import Rows

S = TypeVar("S", bound="Section")

#: characters of a name, and bytes of the name of a folder, to which others are added
LONGEST_NAME = 200


def _words(value: str, bad: str = "") -> str:
    """A name in tables, pages and pictures: of printable characters, but for those of ``bad``."""
    if not value.strip():
        raise ValueError("is empty")
    if len(value) > LONGEST_NAME:
        raise ValueError(f"has {len(value)} characters; a name has at most {LONGEST_NAME}")
    if wrong := sorted({character for character in value if character in bad or not character.isprintable()}):
        raise ValueError(f"{value!r} has {', '.join(map(repr, wrong))}, which names of fields and files cannot contain")
    return value


def _name(value: str) -> str:
    """A name that can be used in file names and datasets as well."""
    if _words(value, "/\\") in (".", ".."):
        raise ValueError(f"{value!r} is a folder, not a name")
    return value


def _folder(value: str) -> str:
    """A name that a folder of any file system can have."""
    if (size := len(_name(value).encode())) > LONGEST_NAME:
        raise ValueError(f"has {size} bytes; the name of a folder has at most {LONGEST_NAME}")
    return value


#: the name of an axis, a variant, a material or a result
Words = Annotated[str, AfterValidator(_words)]
#: the name of a body, a tracer, a gauge or a source
Name = Annotated[str, AfterValidator(_name)]
#: the name of a run or of a part of a study, which becomes that of its folder
FolderName = Annotated[str, AfterValidator(_folder)]


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


def _is(value: float, written: object) -> str:
    """'is -2 inch', as it was written, or 'is -0.0508' for a number."""
    return f"is {written if isinstance(written, str) else format(value, 'g')}"


def _positive(value: float, written: object = None) -> float:
    if value <= 0:
        raise ValueError(f"must be positive, {_is(value, written)}")
    return value


def _not_negative(value: float, written: object = None) -> float:
    if value < 0:
        raise ValueError(f"must not be negative, {_is(value, written)}")
    return value


def _fraction(value: float, written: object = None) -> float:
    if not 0 <= value <= 1:
        raise ValueError(f"must lie between 0 and 1, {_is(value, written)}")
    return value


@dataclass(frozen=True)
class Quantity(GroupedMetadata):
    """Marks a float as a number in ``unit``, given in SI or as a string with a unit, and kept in SI: Annotated[float, ...]."""

    unit: str
    check: Callable[..., float] | None = None

    def read(self, value: Any) -> float:
        """The SI value, checked; a message has it as it was written. Raises ValueError."""
        number = units.read(value, self.unit)
        return number if self.check is None else self.check(number, value)

    def __iter__(self) -> Iterator[object]:
        schema: dict[str, Any] = {"type": "number", "x-unit": self.unit}
        if self.unit != "1":
            schema = {"anyOf": [{"type": "number"}, {"type": "string"}], "x-unit": self.unit}
        yield BeforeValidator(self.read)
        yield WithJsonSchema(schema)


def within(low: float, high: float, reason: str, unit: str = "1") -> Quantity:
    """A number between two bounds; the message gives the reason for the bounds: Annotated[float, within(...)]."""

    def check(value: float, written: object = None) -> float:
        if not low <= value <= high:
            raise ValueError(f"must lie between {low:g} and {high:g}, {_is(value, written)}: {reason}")
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
Number = Annotated[float, Quantity("1")]
PositiveNumber = Annotated[float, Quantity("1", _positive)]
Fraction = Annotated[float, Quantity("1", _fraction)]
NotNegative = Annotated[float, Quantity("1", _not_negative)]


#: checks of numbers by the sign of a declared key
_SIGNS: dict[str, Callable[..., float] | None] = {ANY: None, POSITIVE: _positive, NON_NEGATIVE: _not_negative}


def type_of(declared: Parameter) -> Any:
    """The type of a declared key: a number in its unit, or a table of rows, within the range of its sign."""
    table, unit, check = declared.table, declared.unit or "1", _SIGNS[declared.sign]
    if table is None:
        return Annotated[float, Quantity(unit, check)]
    read = BeforeValidator(partial(table.read, unit=unit, check=check))
    return Annotated[float | Rows if table.or_number else Rows, read, WithJsonSchema(table.schema(unit))]


def field_of(declared: Parameter) -> tuple[Any, Any]:
    """Type and field of a declared key, for `with_keys`: a key without a default may be left out."""
    kind, default = type_of(declared), ... if declared.required else declared.default
    return (kind | None if default is None else kind,
            Field(default, description=declared.description, examples=[declared.example]))


def optional(declared: Parameter, description: str) -> tuple[Any, Any]:
    """`field_of` a key that may be left out of a table that is shared by several kinds."""
    return field_of(replace(declared, default=None, description=description))


def with_keys(section: type[S], keys: Mapping[str, tuple[Any, Any]]) -> type[S]:
    """The section, under the same name, with more keys: the type and the field of each."""
    name, page, place = section.__name__.lstrip("_"), section.__doc__, section.__module__
    return create_model(name, __base__=section, __doc__=page, __module__=place, **cast(Any, keys))


def _pair(value, unit: str) -> tuple[float, float]:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise ValueError(f"expected two numbers or strings in {unit}, [first, second]")
    return units.read(value[0], unit), units.read(value[1], unit)


def _interval(value) -> tuple[float, float]:
    low, high = _pair(value, "m")
    if not low < high:
        raise ValueError(f"the second must be greater than the first, is [{low:g}, {high:g}]")
    return low, high


def _velocity(value) -> tuple[float, float]:
    if isinstance(value, (list, tuple)):
        return _pair(value, "m/s")
    return 0.0, units.read(value, "m/s")


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
