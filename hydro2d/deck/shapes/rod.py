"""A rod on the axis, with one of the kinds of noses."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field, model_validator

from hydro2d.base import units
from hydro2d.base.keys import Length, PositiveLength, optional, with_keys
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.outlines import Arc, Line, Outline, solid
from hydro2d.noses import profile
from hydro2d.noses.base import Shaped
from hydro2d.noses.registry import BY_NAME, KINDS, LENGTH, owners, shaped

#: the keys that say how large a nose is
NOSE_KEYS = (*(key.name for key in owners()), LENGTH.name)

if TYPE_CHECKING:
    NoseName = str
else:
    NoseName = Literal[tuple(BY_NAME)]


class _Rod(Body):
    """A rod on the axis. `length` is the total length, nose included; the nose points along `direction`."""

    extent_word: ClassVar[str] = "length"
    must_be_whole: ClassVar[bool] = True
    is_slender: ClassVar[bool] = True

    shape: Literal["rod"] = Field(description="a rod on the axis")
    nose: NoseName = Field("flat", description="profile of the nose")
    radius: PositiveLength | None = Field(None, description="radius of the shank", examples=["3.378 mm"])
    diameter: PositiveLength | None = Field(
        None, description="diameter of the shank, instead of `radius`", examples=["6.756 mm"]
    )
    length: PositiveLength = Field(description="total length, nose included", examples=["97.8 mm"])
    tip: Length = Field(description="axial position of the tip of the nose", examples=["0 mm"])
    direction: Literal[1, -1] = Field(1, description="+1: the nose points to +z")

    @model_validator(mode="before")
    @classmethod
    def _radius_or_diameter(cls, data):
        if isinstance(data, dict) and data.get("radius") is not None and data.get("diameter") is not None:
            if units.to_si(data["diameter"], "m") != 2 * units.to_si(data["radius"], "m"):
                raise ValueError("radius and diameter are both given and disagree")
        return data

    @model_validator(mode="after")
    def _geometry(self):
        if self.radius is None and self.diameter is None:
            raise ValueError("a rod needs its radius or its diameter")
        if self.length < (nose := self.shaped_nose.length):
            raise ValueError(
                f"length ({self.length:g} m) is the total length and must not be less than the length of the nose ({nose:g} m)"
            )
        return self

    @property
    def rod_radius(self) -> float:
        """Radius of the shank in m, from the radius or the diameter in the deck."""
        return self.radius if self.radius is not None else self.diameter / 2

    @property
    def shaped_nose(self) -> Shaped:
        """The nose, from its keys in the deck."""
        given = {key: getattr(self, key) for key in NOSE_KEYS if getattr(self, key) is not None}
        return shaped(self.nose, self.rod_radius, given)

    @property
    def projectile_rank(self) -> int:
        return 2

    def outline(self, r_start: float) -> Outline:
        return rod_outline(self.shaped_nose, self.length, self.tip, self.direction)

    @property
    def own_radius(self) -> float:
        return self.rod_radius

    @property
    def size(self) -> tuple[float, float]:
        return 2.0 * self.rod_radius, self.length

    def resolved_width(self, r_start: float) -> float:
        return self.rod_radius

    @property
    def lies_on_axis(self) -> bool:
        return True

    @property
    def nose_direction(self) -> int:
        return self.direction


def rod_outline(nose: Shaped, length: float, tip: float, direction: int) -> Outline:
    """A rod of total ``length`` on the axis with its nose at ``tip``, pointing along ``direction`` (1 or -1); lengths in m."""
    base, tail = tip - direction * nose.length, tip - direction * length
    slabs = [solid(min(base, tail), max(base, tail), Line(nose.radius))] if base != tail else []
    for piece in nose.pieces:
        if isinstance(piece, profile.Disc):
            continue  # a slab ends there
        start, end = tip + direction * piece.start, tip + direction * piece.end
        curve: Arc | Line
        if isinstance(piece, profile.Arc):
            curve = Arc(piece.centre_r, tip + direction * piece.centre_z, piece.radius)
        else:
            curve = Line(piece.start_r, start, direction * (piece.end_r - piece.start_r) / (piece.end - piece.start))
        slabs.append(solid(min(start, end), max(start, end), curve))
    return Outline(tuple(slabs))


def _nose_keys() -> dict:
    """Type and field of the keys of all kinds of noses."""
    keys = {key.name: optional(key, f"{', '.join(names)} nose: {key.description}") for key, names in owners().items()}
    lengths = [kind for kind in KINDS if kind.by_length]
    instead = " or ".join(f"`{key.name}`" for kind in lengths for key in kind.keys)
    names = ", ".join(kind.name for kind in lengths)
    return keys | {LENGTH.name: optional(LENGTH, f"{names} nose: {LENGTH.description}, instead of {instead}")}


if TYPE_CHECKING:
    Rod = _Rod
else:
    Rod = with_keys(_Rod, _nose_keys())
