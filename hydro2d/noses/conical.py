"""A conical nose, given by half the angle at its tip."""

from __future__ import annotations

import math

from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.noses.base import Nose
from hydro2d.noses.profile import Cone


class Conical(Nose):
    """A cone with a sharp tip."""

    name = "conical"
    meaning = "a cone"
    keys = (Parameter("half_angle", "rad", 0.5, "half the angle at the tip; a plain number is in rad", "theta", POSITIVE,
                      example="30 deg"),)
    by_length = True

    @classmethod
    def length(cls, radius: float, half_angle: float) -> float:
        if not 0.0 < half_angle < math.pi / 2:
            raise ValueError(f"half_angle = {half_angle:g} rad: must lie between 0 and 90 degrees")
        return radius / math.tan(half_angle)

    @classmethod
    def keys_of(cls, radius: float, length: float) -> dict[str, float]:
        return {"half_angle": math.atan2(radius, length)}

    @classmethod
    def profile(cls, radius: float, length: float, half_angle: float) -> tuple[Cone]:
        return (Cone(radius, -length, 0.0, 0.0),)
