"""The layout of a deck: the edges of its mesh, and the outline, extent, slot and group of every body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hydro2d.deck import mesh
from hydro2d.deck.sections import Deck
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.outlines import Outline


@dataclass(frozen=True)
class Placed:
    """A body in its place: its outline, and smallest and largest coordinate (m) along "r" and "z"."""

    body: Body
    outline: Outline
    extent: dict[str, tuple[float, float]]


class Layout:
    """The layout of a deck. Every part is computed when it is first asked for.

    slots : names of the bodies with their own place in the arrays, in the order of index m
    groups : body group of every slot, that is, its velocity field: 1 for the hard bodies of a contact, else 0
    edges : edges of the cells in m without ghosts by axis, float64[n + 1]; asking for them raises MeshError for a segment
        that cannot be divided into cells
    bodies : in the order of the deck
    """

    def __init__(self, deck: Deck):
        self._deck = deck
        hard = deck.sliding.hard if deck.sliding.method == "contact" else ()
        self.slots = [entry.name for entry in deck.body if entry.join is None]
        self.groups = [int(name in hard) for name in self.slots]

    def belongs_to(self, deck: Deck) -> bool:
        """Whether it is the layout of a deck, all of whose sections that it depends on are these."""
        mine = self._deck
        return deck is mine or (deck.mesh is mine.mesh and deck.body is mine.body and deck.sliding is mine.sliding)

    @cached_property
    def edges(self) -> dict[str, np.ndarray]:
        return {axis: _constant(mesh.edges_along(self._deck, axis)) for axis in ("r", "z")}

    @cached_property
    def bodies(self) -> tuple[Placed, ...]:
        start = self._deck.mesh.r_start
        outlines = [entry.outline(start) for entry in self._deck.body]
        return tuple(Placed(entry, outline, {axis: outline.extent(axis) for axis in ("r", "z")})
                     for entry, outline in zip(self._deck.body, outlines, strict=True))

    def of(self, body: Body) -> Placed:
        """A body of the deck in its place."""
        return next(placed for placed in self.bodies if placed.body is body)


def _constant(values: np.ndarray) -> np.ndarray:
    values.setflags(write=False)
    return values


def layout(deck: Deck) -> Layout:
    """The layout of a deck, which is made once."""
    if deck._layout is None or not deck._layout.belongs_to(deck):
        deck._layout = Layout(deck)
    return deck._layout


def extent(body: Body, deck: Deck, axis: str) -> tuple[float, float]:
    """Smallest and largest coordinate of a body along an axis, m."""
    return layout(deck).of(body).extent[axis]


def axis_edges(deck: Deck, axis: str) -> np.ndarray:
    """Edges along "r" or "z", float64[n + 1]. Raises MeshError for a segment that cannot be divided into cells."""
    return layout(deck).edges[axis]


def edges(deck: Deck) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the cells in m without ghosts: float64[nr + 1] in r, float64[nz + 1] in z."""
    return axis_edges(deck, "r"), axis_edges(deck, "z")


def slots(deck: Deck) -> list[str]:
    """Names of the bodies with their own place in the arrays, in the order of index m."""
    return list(layout(deck).slots)


def body_groups(deck: Deck) -> list[int]:
    """Body group of every slot, that is, its velocity field: 1 for the hard bodies of a contact, else 0."""
    return list(layout(deck).groups)


def body_at(deck: Deck, r: float, z: float) -> str | None:
    """Name of the body that has a point at the start, of the first one of those that are joined; None for void."""
    return next((placed.body.join or placed.body.name for placed in layout(deck).bodies
                 if any(low <= z <= high for low, high in placed.outline.chords("z", r))), None)
