"""A rigid wall, and the axis of symmetry."""

from __future__ import annotations

from hydro2d.mesh.edges.base import IMAGES, NOTHING, OUT, PUSH, Edge


class Wall(Edge):
    """Images beyond it, no normal velocity, and no flow through it."""

    name = "wall"
    in_words = "a wall"
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
    """The axis of symmetry, a wall at r = 0 of a cylindrical mesh."""

    name = "axis"
    edges = ("r_min",)
    meaning = "the axis of symmetry, at r = 0"


class Anvil(Edge):
    """Images beyond it, and a normal velocity that never points outward; where bodies leave it, void comes in."""

    name = "anvil"
    in_words = "an anvil"
    meaning = "a rigid wall without friction that only pushes: bodies that touch it may leave it"
    sink = "walls"

    @classmethod
    def ghost(cls) -> str:
        return IMAGES

    @classmethod
    def flow(cls) -> str:
        return OUT

    @classmethod
    def traction(cls) -> str:
        return PUSH
