"""A flat nose whose edge is rounded: a quarter circle between the flank and the face."""

from __future__ import annotations

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter
from hydro2d.noses.base import Nose
from hydro2d.noses.profile import Arc, Disc


class FlatRounded(Nose):
    """A face across the axis, joined to the shank by a quarter of a torus; with the shank's radius it is a hemisphere."""

    name = "flat-rounded"
    meaning = "a face across the axis with a rounded edge"
    keys = (Parameter("edge_radius", "m", REQUIRED, "radius of the rounded edge", "rho", POSITIVE, example="1 mm"),)

    @classmethod
    def length(cls, radius: float, edge_radius: float) -> float:
        if not 0.0 < edge_radius < radius:
            raise ValueError(f"edge_radius = {edge_radius:g} m: must lie between 0 and the radius, {radius:g} m")
        return edge_radius

    @classmethod
    def profile(cls, radius: float, length: float, edge_radius: float) -> tuple[Arc, Disc]:
        inner = radius - edge_radius
        return Arc(inner, -edge_radius, edge_radius, -edge_radius, 0.0), Disc(inner)
