"""The mesh of a deck: its keys, and those of the segments that it is made of."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, field_validator, model_validator

from hydro2d.base import units
from hydro2d.base.keys import Length, PositiveLength, Section, within

_SEGMENTS = (
    "{to, cells}, {to, size}, {cells, size}, {to, ratio}, {cells, ratio}, {to, last}; the last three also take `first`, "
    "and without it continue the segment before; {across, cells_across} can replace size and first"
)


_UNEVEN = "neighbouring cells that differ by more cannot transmit a wave"
CellsAcross = Annotated[float, within(1.0, 1e6, "fewer resolve nothing, more do not fit on any machine")]


def radii(reach: float | str) -> float | None:
    """The number of radii that a reach such as "30 radii" means; None for a length."""
    words = reach.split() if isinstance(reach, str) else []
    try:
        return float(words[0]) if words[1:] in (["radii"], ["radius"]) else None
    except ValueError:
        return None


def _reach(value):
    """A length in m, or a number of radii as it was written."""
    count = radii(value)
    length = units.to_si(value, "m") if count is None and value != "none" else count
    if length is not None and not 0.0 < length < float("inf"):
        raise ValueError(f"must be positive, is {value}")
    return length if count is None and value != "none" else value


Reach = Annotated[float | str, BeforeValidator(_reach), WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string"}]})]


class Segment(Section):
    """A row of cells along one axis; segments follow one another. A ratio is adjusted so that the segment ends at `to`."""

    to: Length | None = Field(None, description="position of the far edge", examples=["2 cm"])
    cells: int | None = Field(None, gt=0, le=1_000_000, description="number of cells", examples=[40])
    size: PositiveLength | None = Field(
        None, description="size of every cell; must divide the length of the segment", examples=["0.5 mm"]
    )
    first: PositiveLength | None = Field(
        None, description="size of the first cell; default: previous size x ratio", examples=["0.5 mm"]
    )
    last: PositiveLength | None = Field(None, description="size of the last cell", examples=["5 mm"])
    ratio: Annotated[float, within(1e-3, 1e3, _UNEVEN)] | None = Field(
        None, description="ratio of the size of each cell to that of the cell before", examples=[1.05]
    )
    across: str | None = Field(None, description="a body whose radius sets the size of the cells", examples=["rod"])
    cells_across: CellsAcross | None = Field(None, description="cells across the radius of that body", examples=[8.5])

    @model_validator(mode="after")
    def _shape(self):
        given = {key for key in ("to", "cells", "size", "first", "last", "ratio") if getattr(self, key) is not None}
        if (self.across is None) != (self.cells_across is None):
            raise ValueError("across and cells_across go together")
        if self.across is not None:
            graded = bool(given & {"ratio", "last"})
            if ("first" if graded else "size") in given:
                raise ValueError("across already gives the size of the cells; leave out first or size")
            given.add("first" if graded else "size")
        even = ("to cells", "to size", "cells size", "to ratio", "cells ratio", "to last")
        with_first = ("to first ratio", "cells first ratio", "to first last")
        if given not in [set(entry.split()) for entry in even + with_first]:
            raise ValueError(f"{', '.join(sorted(given)) or 'nothing'} does not define a segment; it takes {_SEGMENTS}")
        return self


#: keys of a segment that are lengths
LENGTHS = ("to", "size", "first", "last")


def as_text(segment: dict[str, Any]) -> dict[str, Any]:
    """A segment with its lengths, in m, as text that gives the same lengths to the last bit."""
    return {key: units.exact(value, "m") if key in LENGTHS else value for key, value in segment.items()}


#: keys of a generated mesh
GENERATED = ("cells_across", "reach", "across", "fine")


class Mesh(Section):
    """The mesh. r = 0 is the axis of symmetry in cylindrical geometry; z is the axis a rod flies along."""

    geometry: Literal["cylindrical", "planar"] = Field("cylindrical", description="r-z with an axis, or plane strain")
    r_start: Length = Field(0.0, description="inner edge of the mesh", examples=["0 mm"])
    z_start: Length = Field(0.0, description="lower edge of the mesh", examples=["-10 cm"])
    r: tuple[Segment, ...] = Field(
        (), description="segments from r_start outward; default: by cells_across and reach",
        examples=[[{"to": "6 mm", "size": "0.5 mm"}, {"to": "8 cm", "ratio": 1.1}]],
    )
    z: tuple[Segment, ...] = Field(
        (), description="segments from z_start upward; default: by cells_across and reach",
        examples=[[{"to": "10 cm", "cells": 400}]],
    )
    cells_across: CellsAcross | None = Field(
        None, description="with reach, instead of z, or of r and z: cells across the radius of a rod or a sphere, or across "
        "the smaller of thickness and width of another body; square cells of this size cover that body, all that moves and the "
        "way ahead, and each cell beyond them is a tenth larger than the one before", examples=[8.5],
    )
    reach: Reach | None = Field(
        None, description="how far the mesh goes ahead of that body and beside it: a length, or a number of its radii; none "
        "cancels this and cells_across of an included deck", examples=["30 radii"],
    )
    across: str | None = Field(
        None, description="the body that cells_across and reach refer to; default: the one that the mesh follows, else the rod "
        "of [penetration], else the first that moves", examples=["rod"],
    )
    fine: Reach | None = Field(
        None, description="with cells_across and reach, for a rod that stays whole and is followed: how far behind its nose "
        "the cells along z stay fine, a length or a number of its radii; each cell farther back is a tenth larger than the one "
        "before, up to four fine cells; default and none: all of the rod has fine cells", examples=["7 radii"],
    )
    follow: str | None = Field(
        None, description="a body with which the whole mesh travels along z; bodies further ahead enter when the mesh "
        "reaches them; default and none: the mesh does not move",
        examples=["rod"],
    )

    @field_validator("follow", "fine")
    @classmethod
    def _nothing(cls, value: Any) -> Any:
        """``none`` cancels the value of an included deck."""
        return None if value == "none" else value

    @model_validator(mode="before")
    @classmethod
    def _cancelled(cls, data: Any) -> Any:
        """A reach of ``none`` cancels the keys of a generated mesh."""
        if isinstance(data, dict) and data.get("reach") == "none":
            return {key: value for key, value in data.items() if key not in GENERATED}
        return data

    @model_validator(mode="after")
    def _segments_or_words(self) -> Mesh:
        words = [key for key in GENERATED if getattr(self, key) is not None]
        if words and self.z:
            raise ValueError(f"give either z, its segments, or cells_across and reach; {words[-1]} and z are both given (z = "
                             '[] cancels the segments of an included deck, reach = "none" its cells_across and reach)')
        lost = [key for key in (("cells_across", "reach") if words else ("r", "z")) if not getattr(self, key)]
        if lost:
            raise ValueError(f"{' and '.join(lost)} missing: a mesh needs r and z, its segments, or cells_across and reach")
        return self
