"""The kinds of edges. A new one is a file in this folder and its class in ``KINDS``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hydro2d.mesh.edges.base import IMAGES, Edge
from hydro2d.mesh.edges.held import Held
from hydro2d.mesh.edges.outflow import Outflow, Transmit
from hydro2d.mesh.edges.piston import Piston
from hydro2d.mesh.edges.pressure import Pressure
from hydro2d.mesh.edges.velocity import Velocity
from hydro2d.mesh.edges.wall import Anvil, Axis, Wall

KINDS: tuple[type[Edge], ...] = (Axis, Wall, Anvil, Held, Outflow, Transmit, Velocity, Piston, Pressure)

BY_NAME = {kind.name: kind for kind in KINDS}


def words(edge: str) -> tuple[str, ...]:
    """Names of the kinds that an edge can be of."""
    return tuple(kind.name for kind in KINDS if edge in kind.edges)


def made(edge: str, boundaries: Mapping[str, Any]) -> Edge:
    """The edge of this name that the table [boundaries] of a resolved deck describes."""
    kind = BY_NAME[boundaries[edge]]
    result = kind(**{key.name: boundaries[f"{edge}_{key.name}"] for key in kind.keys})
    result.place = edge
    return result


def halved(geometry: str, r_start: float, r_min: str) -> bool:
    """Whether a mesh is one half of a symmetric whole: it is cylindrical, or it starts at r = 0 with a plane of symmetry."""
    kind = BY_NAME.get(r_min)
    return geometry == "cylindrical" or (r_start == 0.0 and kind is not None and kind.ghost() == IMAGES and kind.constrains())
