"""The conditions at the four edges of a mesh, as the numbers that kernels take."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from hydro2d.mesh.edges.base import BOTH_WAYS, DASHPOTS, EDGES, IMAGES, NOTHING, PRESSURE, PUSH, Edge
from hydro2d.mesh.edges.registry import made
from hydro2d.mesh.sinks import SINKS


class BoundaryConditions:
    """The edges of a mesh.

    Parameters
    ----------
    edges : four Edge, in the order of EDGES

    Attributes
    ----------
    velocity : float64[8], normal velocity of constrained edges, then velocity along edges that hold, m/s, towards higher r or
        z, at the time of the last `drive`
    pressure : float64[4], from beyond on what lies at an edge, Pa, in the middle of that step
    """

    def __init__(self, edges: tuple[Edge, ...]):
        self.edges, self.velocity, self.pressure = edges, np.zeros(8), np.zeros(4)
        for n, edge in enumerate(edges):
            self.velocity[n], self.velocity[4 + n] = edge.constrain(0.0) or 0.0, edge.slide() or 0.0
        self._pressing = [(n, edge) for n, edge in enumerate(edges) if edge.presses()]
        self._driven = [(n, edge) for n, edge in enumerate(edges) if len(set(edge.speeds())) > 1]
        self._moving = [(n, edge) for n, edge in enumerate(edges) if any(edge.speeds())]

    @classmethod
    def of(cls, boundaries: Mapping[str, Any]) -> BoundaryConditions:
        """The edges that the table [boundaries] of a resolved deck describes."""
        return cls(tuple(made(edge, boundaries) for edge in EDGES))

    @property
    def changes(self) -> bool:
        """Whether `drive` ever changes anything."""
        return bool(self._driven or self._pressing)

    @property
    def moves(self) -> bool:
        """Whether an edge ever has a velocity."""
        return bool(self._moving)

    def drive(self, time: float, dt: float = 0.0) -> None:
        """Sets `velocity` to its values at the end of a step, a time in s, and `pressure` to those in the middle of it."""
        for n, edge in self._driven:  # the velocities of the others never change
            self.velocity[n] = edge.constrain(time)
        for n, edge in self._pressing:
            self.pressure[n] = edge.pressure(time - 0.5 * dt)

    def least_crossing(self, widths, start: float, end: float) -> tuple[float, str]:
        """The least time in which material moving with an edge crosses a width, s, and the name of that edge.

        widths : float[4], of the cells next to the edges, m;  start, end : interval in which the velocity of an edge counts, s

        inf if no edge moves.
        """
        return min(((widths[n] / speed if (speed := edge.fastest(start, end)) > 0.0 else np.inf, EDGES[n])
                    for n, edge in self._moving), default=(np.inf, ""))

    @cached_property
    def sinks(self) -> list[str]:
        """Sinks of the edges, in addition to those that every run has."""
        return sorted({edge.sink for edge in self.edges} - set(SINKS))

    @cached_property
    def _flags(self) -> dict[str, tuple[bool, ...]]:
        return {
            "mirrors": tuple(edge.ghost() == IMAGES for edge in self.edges),
            "constrains": tuple(edge.constrains() for edge in self.edges),
            "opens": tuple(edge.flow() != NOTHING for edge in self.edges),
            "supplies": tuple(edge.flow() == BOTH_WAYS for edge in self.edges),
            "drives": tuple(any(edge.speeds()) or bool(edge.slide()) or edge.presses() for edge in self.edges),
            "holds": tuple(edge.slide() is not None for edge in self.edges),
            "loads": tuple(edge.traction() in (DASHPOTS, PRESSURE) for edge in self.edges),
            "pushes": tuple(edge.traction() == PUSH for edge in self.edges),
        }

    def having(self, flag: str) -> tuple[bool, ...]:
        """For each edge whether it mirrors, constrains, opens, supplies, drives, holds, loads or pushes; often called."""
        return self._flags[flag]
