"""A rigid wall, and the axis of symmetry."""

from __future__ import annotations

from hydro2d.mesh.edges.base import IMAGES, NOTHING, Edge


class Wall(Edge):
    """Images beyond it, no normal velocity, and nothing flows through."""

    name = "wall"
    meaning = "a rigid wall without friction, or a plane of symmetry"
    sink = "walls"

    @classmethod
    def ghost(cls) -> str:
        return IMAGES

    @classmethod
    def flow(cls) -> str:
        return NOTHING

    def constrain(self, time: float) -> float | None:
        return 0.0

    def speeds(self) -> tuple[float, ...]:
        return (0.0,)


class Axis(Wall):
    """The same, at r = 0 of a cylindrical mesh."""

    name = "axis"
    edges = ("r_min",)
    meaning = "the axis of symmetry, at r = 0"
