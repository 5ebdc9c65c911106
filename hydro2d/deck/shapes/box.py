"""A rectangle in the (r, z) plane."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from pydantic import Field

from hydro2d.base.keys import Interval
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.outlines import Outline, rectangle


class Box(Body):
    """A rectangle in the (r, z) plane: a cylinder, a tube or a washer."""

    is_target: ClassVar[bool] = True
    radial_key: ClassVar[str | None] = "r"

    shape: Literal["box"] = Field(description="a rectangle in the (r, z) plane")
    r: Interval | None = Field(None, description="[inner, outer] radius; default: the whole mesh", examples=[["5 mm", "8 mm"]])
    z: Interval = Field(description="[low, high] axial position", examples=[["0 mm", "20 mm"]])

    def outline(self, r_start: float) -> Outline:
        return rectangle(self.r if self.r is not None else (r_start, math.inf), self.z)

    @property
    def thickness_in_models(self) -> float:
        return self.z[1] - self.z[0]
