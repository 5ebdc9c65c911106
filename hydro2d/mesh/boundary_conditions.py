"""THE table of boundary conditions: what lies beyond an edge of the mesh, what holds its vertices, what flows through it.

The deck's words, the kernels' flags and the reference page follow from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

#: the edges of the mesh, in the order of every array over them
EDGES = ("r_min", "r_max", "z_min", "z_max")


@dataclass(frozen=True)
class Boundary:
    """One line of the table.

    ``mirrors``: ghost cells are images of the cells inside, else copies of the last one. ``holds``: the normal velocity of the
    edge's vertices is given, 0 or that of the deck. ``opens``: bodies flow through. ``supplies``: what flows in is what stands
    beside the edge, else void. ``transmits``: the edge is held with the traction of an endless plate.
    """

    name: str
    edges: tuple[str, ...]
    mirrors: bool
    holds: bool
    opens: bool
    supplies: bool
    transmits: bool
    meaning: str


BOUNDARIES = (
    Boundary("axis", ("r_min",), True, True, False, False, False, "the axis of symmetry, at r = 0"),
    Boundary("wall", EDGES, True, True, False, False, False, "a rigid wall without friction, or a plane of symmetry"),
    Boundary("outflow", EDGES, False, False, True, False, False,
             "an open end: bodies leave as if the mesh went on, and nothing but void comes in"),
    Boundary("transmit", EDGES, False, False, True, True, True,
             "the cut through an endless plate: it lets waves out and holds what they press on"),
    Boundary("velocity", EDGES, False, True, True, True, False,
             "the normal velocity is prescribed; where it points inward, more of what stands beside the edge comes in"),
)

BY_NAME = {boundary.name: boundary for boundary in BOUNDARIES}


def halved(geometry: str, r_start: float, r_min: str) -> bool:
    """Whether a mesh is one half of a symmetric whole: it is cylindrical, or it starts at r = 0 with a plane of symmetry."""
    return geometry == "cylindrical" or (r_start == 0.0 and r_min in BY_NAME and BY_NAME[r_min].mirrors)


def words(edge: str) -> tuple[str, ...]:
    """Names of the boundary conditions that an edge can have."""
    return tuple(boundary.name for boundary in BOUNDARIES if edge in boundary.edges)


@dataclass(frozen=True)
class BoundaryConditions:
    """What stands at the four edges of a mesh.

    kinds : four Boundary, in the order of EDGES;  velocity : float64[4], normal velocity of those that hold, m/s, towards
    higher r or z
    """

    kinds: tuple[Boundary, ...]
    velocity: np.ndarray

    @cached_property
    def _flags(self) -> dict[str, tuple[bool, ...]]:
        names = ("mirrors", "holds", "opens", "supplies", "transmits")
        return {name: tuple(getattr(kind, name) for kind in self.kinds) for name in names}

    def having(self, flag: str) -> tuple[bool, ...]:
        """For each edge whether its boundary condition has a flag of the table; asked many times a cycle."""
        return self._flags[flag]
