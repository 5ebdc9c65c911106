"""Results: what a run says, each declared once, with its type, its unit and its meaning, beside the function that measures it.

The name of a result is the same in a history, a summary, a table and a formula, and ends in its unit: `rod_length_m`. From its
declaration follow the columns of history.h5, the keys of summary.json and what they may hold, the rows that studies keep, the
names in formulas of a deck, and the reference page.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, NamedTuple, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, ValidationInfo

from hydro2d.base.errors import unknown

#: unit by ending of the name, the longest first
UNITS = {
    "_m3_J": "m3/J", "_kg_m3": "kg/m3", "_J_kg": "J/kg", "_J_m2": "J/m2", "_m_s2": "m/s2", "_m_s": "m/s", "_N_s": "N s",
    "_Pa_s": "Pa s", "_rad": "rad", "_1_s": "1/s", "_kg": "kg", "_Pa": "Pa", "_m2": "m2", "_m3": "m3", "_K": "K", "_J": "J",
    "_N": "N", "_W": "W", "_s": "s", "_m": "m",
}

#: in the context of a validation: the values are those of a file, in which a number is finite
OF_A_FILE = "of a file"


def unit(name: str) -> str:
    """Unit of a quantity, from the end of its name; "1" if it has none."""
    if name in ("time", "dt"):
        return "s"
    return next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "1")


def is_number(value: object) -> bool:
    """Whether a value of a deck or a file is a finite number; true and false are none."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def _finite(value: Any, info: ValidationInfo) -> Any:
    if info.context == OF_A_FILE and value is not None and not is_number(value):
        raise ValueError("is no finite number")
    return value


#: a number, or None where there is none
Number = Annotated[float | None, BeforeValidator(_finite)]


def result(meaning: str, *, short: str = "", each: str = "", whole: bool = False, default: Any = None) -> Any:
    """A field of a Result.

    meaning : for the reference page, in one sentence
    short : name for formulas of a deck, beside its own
    each : of a table with an entry for each of several things, what these are, in capitals
    whole : of a table, whether the reference page names it without what is in it
    default : value of a summary that lacks it, as those of earlier versions do
    """
    extra = {key: value for key, value in (("short", short), ("each", each), ("whole", whole)) if value}
    return Field(default, description=meaning, json_schema_extra=extra)


class Listed(NamedTuple):
    """A result by its dotted name, its meaning, and whether it is a number."""

    name: str
    meaning: str
    number: bool


class Result(BaseModel):
    """What is measured together; values never change. Unknown keys of a file are passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore", strict=True, arbitrary_types_allowed=True)

    def __getitem__(self, name: str) -> Any:
        """A result by its name, as tables and formulas have it. Raises KeyError for a name that there is not."""
        if name not in self:
            raise KeyError(unknown("result", name, self.keys()))
        return getattr(self, name)

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def keys(self) -> list[str]:
        """The names of the results, so that ** passes them on."""
        return [*type(self).model_fields, *(self.model_extra or ())]

    @classmethod
    def meanings(cls) -> dict[str, str]:
        """The meaning of each result by its name, in the order of their declaration, without tables within."""
        return {name: field.description or "" for name, field in cls.model_fields.items() if _within(field.annotation) is None}

    @classmethod
    def short(cls) -> dict[str, str]:
        """The names of results by their short names."""
        return {word: name for name in cls.model_fields if (word := cls._extra(name).get("short"))}

    @classmethod
    def listed(cls, prefix: str = "") -> Iterator[Listed]:
        """Each result and those within by dotted name; where there is one table of each of several, a word stands for all."""
        for name, field in cls.model_fields.items():
            within, each = _within(field.annotation), cls._extra(name).get("each")
            path = f"{prefix}{name}" + (f".{each}" if each else "")
            if within is None or cls._extra(name).get("whole"):
                kinds = _parts(field.annotation)
                yield Listed(path, field.description or "", float in kinds or int in kinds)
                continue
            about = f"{field.description}: " if field.description else ""
            yield from (inner._replace(meaning=about + inner.meaning) for inner in within.listed(f"{path}."))

    @classmethod
    def _extra(cls, name: str) -> Mapping[str, Any]:
        extra = cls.model_fields[name].json_schema_extra
        return extra if isinstance(extra, dict) else {}  # type: ignore[return-value]

    @classmethod
    def sound(cls, data: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
        """The contents of a file without values of the wrong kind, and the dotted names of these."""
        kept, odd = _copy(data), []
        while True:
            try:
                cls.model_validate(kept, context=OF_A_FILE)
            except ValidationError as error:
                for place in {_keys(each["loc"]): None for each in error.errors()}:
                    odd.append(".".join(place))
                    _drop(kept, place)
                continue
            return kept, sorted(odd)


def _parts(annotation: Any) -> list[Any]:
    """A type and all types in it."""
    return [annotation, *(part for each in get_args(annotation) for part in _parts(each))]


def _within(annotation: Any) -> type[Result] | None:
    """The Result that a field holds, alone or in a table with one of each; None if it holds a value."""
    return next((part for part in _parts(annotation) if isinstance(part, type) and issubclass(part, Result)), None)


def _copy(data: Mapping[str, Any]) -> dict[str, Any]:
    return {str(key): _copy(value) if isinstance(value, Mapping) else value for key, value in data.items()}


def _keys(place: tuple[int | str, ...]) -> tuple[str, ...]:
    """The keys of the tables that lead to a value, up to a list."""
    numbers = [n for n, part in enumerate(place) if not isinstance(part, str)]
    return tuple(str(part) for part in place[: numbers[0] if numbers else None])


def _drop(data: dict[str, Any], place: tuple[str, ...]) -> None:
    for key in place[:-1]:
        data = data.get(key, {})
    data.pop(place[-1], None)
