"""A plate across the axis."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from pydantic import Field

from hydro2d.base.keys import Length, PositiveLength
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.outlines import Outline, rectangle


class Plate(Body):
    """A plate across the axis, from `z_front` towards +z."""

    is_target: ClassVar[bool] = True
    extent_word: ClassVar[str] = "thickness"

    shape: Literal["plate"] = Field(description="a plate across the axis")
    z_front: Length = Field(description="axial position of the face with the smaller z", examples=["0 mm"])
    thickness: PositiveLength = Field(description="extent along z", examples=["12 mm"])
    radius: PositiveLength | None = Field(
        None, description="outer radius; default: the plate reaches the edge of the mesh", examples=["25 cm"]
    )

    def outline(self, r_start: float) -> Outline:
        r = (r_start, math.inf) if self.radius is None else (-self.radius, self.radius)
        return rectangle(r, (self.z_front, self.z_front + self.thickness))

    @property
    def own_radius(self) -> float | None:
        return self.radius

    @property
    def thickness_in_models(self) -> float:
        return self.thickness
