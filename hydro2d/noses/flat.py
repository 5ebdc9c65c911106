"""A flat nose: a face across the axis."""

from __future__ import annotations

from hydro2d.noses.base import Nose
from hydro2d.noses.profile import Disc


class Flat(Nose):
    """The end of a cylinder."""

    name = "flat"
    meaning = "a face across the axis"

    @classmethod
    def length(cls, radius: float) -> float:
        return 0.0

    @classmethod
    def profile(cls, radius: float, length: float) -> tuple[Disc]:
        return (Disc(radius),)
