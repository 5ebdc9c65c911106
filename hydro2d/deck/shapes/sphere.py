"""A sphere or a shell."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from hydro2d.base import units
from hydro2d.base.keys import PositiveLength
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.outlines import Arc, Outline, Slab


def _centre(value) -> tuple[float, float]:
    if isinstance(value, (list, tuple)):
        if len(value) != 2:
            raise ValueError("expected an axial position or [r, z]")
        return units.to_si(value[0], "m"), units.to_si(value[1], "m")
    return 0.0, units.to_si(value, "m")


class Sphere(Body):
    """A sphere or a shell on the axis (a circle anywhere in planar geometry)."""

    extent_word: ClassVar[str] = "diameter"

    shape: Literal["sphere"] = Field(description="a sphere or a shell")
    centre: Annotated[
        tuple[float, float],
        BeforeValidator(_centre),
        WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string"}, {"type": "array"}], "x-unit": "m"}),
    ] = Field(description="axial position of the centre, or [r, z]; with r > 0 in r-z the body is a ring", examples=["-5 mm"])
    radius: PositiveLength = Field(description="outer radius", examples=["5 mm"])
    inner_radius: PositiveLength | None = Field(None, description="inner radius of a shell", examples=["4 mm"])

    @model_validator(mode="after")
    def _shell(self):
        if self.inner_radius is not None and not self.inner_radius < self.radius:
            raise ValueError("inner_radius must be smaller than radius")
        return self

    @property
    def projectile_rank(self) -> int:
        return 1 if self.velocity[1] != 0.0 else 0

    def outline(self, r_start: float) -> Outline:
        return sphere_outline(*self.centre, self.radius, self.inner_radius or 0.0)

    @property
    def own_radius(self) -> float:
        return self.radius

    def resolved_width(self, r_start: float) -> float:
        return self.radius

    def reach_radius(self, r_start: float) -> float:
        inner, outer = self.outline(r_start).extent("r")
        return 0.5 * (outer - inner)

    @property
    def lies_on_axis(self) -> bool:
        return self.centre[0] == 0.0 and self.inner_radius is None


def sphere_outline(r: float, z: float, radius: float, inner_radius: float = 0.0) -> Outline:
    """A sphere, or a shell, about (r, z); split where its curves turn."""
    slabs = []
    levels = [z - radius, z - inner_radius, z, z + inner_radius, z + radius]
    for low, high in zip(levels, levels[1:], strict=False):
        if not low < high:
            continue
        left, right = Arc(r, z, radius, -1.0), Arc(r, z, radius, 1.0)
        if abs(low + high - 2 * z) < 2 * inner_radius:
            slabs.append(Slab(low, high, left, Arc(r, z, inner_radius, -1.0)))
            slabs.append(Slab(low, high, Arc(r, z, inner_radius, 1.0), right))
        else:
            slabs.append(Slab(low, high, left, right))
    return Outline(tuple(slabs))
