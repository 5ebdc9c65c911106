"""The base of all kinds of sources."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np
from pydantic import Field

from hydro2d.base.keys import Interval, Name, Section, field_of, with_keys
from hydro2d.base.parameters import Parameter


class Reached(NamedTuple):
    """The body of a source before the first step; arrays float64[nz, nr].

    material : materials.material.Material;  share : of every cell's volume that it fills;  mass : per radian, kg
    variables : internal variables of its models by name, to be changed
    arrival : (points float64[n, 3] as (r, z, time), speed in m/s) -> times at which a signal from them arrives within the body,
        straight or around what is not of it; inf where it does not
    """

    material: Any
    share: np.ndarray
    mass: np.ndarray
    variables: dict[str, np.ndarray]
    arrival: Callable[[np.ndarray, float], np.ndarray]


class Source(Section):
    """A table of [[source]]. What a source has given is a sink of the audit with its name, negative.

    A kind says its word in decks, its meaning and its keys, whose values are attributes, in SI.
    """

    word: ClassVar[str]
    meaning: ClassVar[str]
    keys: ClassVar[tuple[Parameter, ...]] = ()

    name: Name = Field(description="name of the source, and of its sink in the audit", examples=["beam"])
    body: str = Field(description="the body to which it gives", examples=["plate"])
    r: Interval | None = Field(None, description="its reach along r; default: the whole mesh", examples=[["0 mm", "2 mm"]])
    z: Interval | None = Field(None, description="its reach along z; default: the whole mesh", examples=[["0 mm", "5 mm"]])

    def share(self, grid) -> np.ndarray:
        """Share of every cell's volume that lies within the source's reach, float64[nz, nr]; grid : mesh.grid.Grid."""
        r, z = grid.r_edges, grid.z_edges
        radial = _overlap(0.5 * r**2, [0.5 * max(end, 0.0) ** 2 for end in self.r] if self.r else None) if grid.cylindrical \
            else _overlap(r, self.r)
        return _overlap(z, self.z)[:, None] * radial[None, :]

    def misfit(self, material) -> str | None:
        """Why the material of the body (materials.material.Material) cannot take what the source gives; None if it can."""
        return None

    def begin(self, grid, reached: Reached) -> list[str]:
        """Sets what the material of the body needs before the first step; most kinds need nothing. Returns warnings."""
        return []

    def heat(self, grid, time: float, dt: float) -> np.ndarray | None:
        """Energy that the body's material gains from ``time`` to ``time + dt`` in every cell, J/kg, float64[nz, nr].

        None from a kind that does not heat.
        """
        return None

    def push(self, grid, time: float, dt: float) -> np.ndarray | None:
        """Velocity that the body's material gains by a force per mass from ``time`` to ``time + dt`` in every cell.

        float64[2, nz, nr], m/s, radial and axial; None from a kind that does not push.
        """
        return None


def declared(kind: type[Source]) -> type[Source]:
    """The kind with its word and its keys as keys of its table; every kind needs this decorator."""
    word = Literal[kind.word], Field(description=kind.meaning)
    return with_keys(kind, {"kind": word} | {key.name: field_of(key) for key in kind.keys})


def _overlap(edges: np.ndarray, reach) -> np.ndarray:
    """Share of every interval between edges that lies within reach = (low, high); ones without a reach."""
    if reach is None:
        return np.ones(len(edges) - 1)
    inside = np.minimum(edges[1:], reach[1]) - np.maximum(edges[:-1], reach[0])
    return np.maximum(inside, 0.0) / np.diff(edges)
