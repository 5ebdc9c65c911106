"""Noses with sizes that any kind can have."""

from hydro2d.noses.base import Shaped
from hydro2d.noses.registry import BY_NAME
from hydro2d.penetration import inputs

#: every kind
SHAPES = tuple(BY_NAME)


def a_nose(shape: str, diameter: float, crh: float = 3.0, half_angle: float = 0.5, edge: float = 0.3) -> Shaped:
    """A nose on a shank of this diameter, m; edge : radius of a rounded edge over that of the shank."""
    return inputs.nose(shape, diameter, crh=crh, half_angle=half_angle, edge_radius=0.5 * edge * diameter)
