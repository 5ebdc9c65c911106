"""A hemispherical nose."""

from __future__ import annotations

from hydro2d.noses.base import Nose
from hydro2d.noses.profile import Arc, tangent_arc


class Hemispherical(Nose):
    """Half a sphere of the shank's radius."""

    name = "hemispherical"
    meaning = "half a sphere"

    @classmethod
    def length(cls, radius: float) -> float:
        return radius

    @classmethod
    def profile(cls, radius: float, length: float) -> tuple[Arc]:
        return (tangent_arc(radius, length),)
