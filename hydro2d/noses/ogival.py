"""A tangent ogive, given by its caliber-radius-head (CRH): the radius of its arc over the diameter of the shank."""

from __future__ import annotations

import math

from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.noses.base import Nose
from hydro2d.noses.profile import Arc, tangent_arc


class Ogival(Nose):
    """With CRH psi its arc has the radius 2 a psi on a shank of radius a, and its length is a sqrt(4 psi - 1)."""

    name = "ogival"
    meaning = "a tangent ogive"
    keys = (Parameter("crh", "", 3.0, "radius of the arc in diameters (caliber-radius-head)", "psi", POSITIVE, example=3.0),)
    by_length = True

    @classmethod
    def length(cls, radius: float, crh: float) -> float:
        if not crh >= 0.5:
            raise ValueError(f"crh = {crh:g}: that of a tangent ogive is at least 0.5, a hemisphere")
        return radius * math.sqrt(4 * crh - 1)

    @classmethod
    def keys_of(cls, radius: float, length: float) -> dict[str, float]:
        if length < radius:
            raise ValueError(f"nose_length = {length:g} m: that of a tangent ogive is at least the radius, {radius:g} m")
        return {"crh": (length**2 + radius**2) / (4.0 * radius**2)}

    @classmethod
    def profile(cls, radius: float, length: float, crh: float) -> tuple[Arc]:
        return (tangent_arc(radius, length),)
