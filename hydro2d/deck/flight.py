"""Cells across a piece of a line, at the start and as its own velocity carries it through the mesh."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from hydro2d.deck.checks import travel
from hydro2d.deck.layout import extent
from hydro2d.deck.mesh import body, cells_between
from hydro2d.deck.sections import Deck
from hydro2d.deck.shapes.registry import AnyBody

AXES = ("r", "z")
#: (radial, axial), m/s
Velocity = tuple[float, float]

#: fraction of a number of cells, or of a length, that is round-off
ROUNDING = 1e-9


class Count(NamedTuple):
    """A number of cells, and words that say where it applies: none for the start."""

    cells: float
    where: str = ""

    @property
    def in_words(self) -> str:
        return f"{self.cells:.1f}" if self.cells >= 1.0 else f"{self.cells:.2g}"


@dataclass(frozen=True)
class Flights:
    """The mesh of a deck, and how bodies fly through it. edges : those of the cells by axis, m"""

    deck: Deck
    edges: dict[str, np.ndarray]

    def counts(self, axis: str, low: float, high: float, velocity: Velocity, least: int) -> list[Count]:
        """The number of cells from low to high (m) at the start, and the fewest later, each only if below ``least``.

        velocity : (radial, axial) in m/s, of the piece until a body of this velocity meets another one
        """
        start, later = self.begin(axis, low, high, velocity), self._fewest(axis, low, high, velocity)
        few = [count for count in (start, later) if count.cells < least - ROUNDING]
        return few if later.in_words != start.in_words else few[:1]

    def begin(self, axis: str, low: float, high: float, velocity: Velocity) -> Count:
        """The cells from low to high at the start; ahead of a body that the mesh follows, where that body reaches them."""
        edges, where = self.edges[axis], ""
        if axis == "z" and (direction := travel(self.deck)):
            leader = body(self.deck, self.deck.mesh.follow)
            tip, near = (max, min) if direction > 0 else (min, max)
            ahead = direction * (near(low, high) - tip(extent(leader, self.deck, "z")))
            if ahead > 0.0 and direction * (leader.velocity[1] - velocity[1]) > 0.0:
                low, high, where = low - direction * ahead, high - direction * ahead, f' where "{leader.name}" reaches it'
        cells = cells_between(edges, low, high)
        return Count(math.inf if cells == 0.0 or (low <= edges[0] and high >= edges[-1]) else cells, where)

    def _fewest(self, axis: str, low: float, high: float, velocity: Velocity) -> Count:
        """The fewest cells from low to high on the way, while the whole piece is on the mesh."""
        edges, speed = self.edges[axis], velocity[AXES.index(axis)]
        through = speed - (body(self.deck, self.deck.mesh.follow).velocity[1] if axis == "z" and travel(self.deck) else 0.0)
        if speed == 0.0 or through == 0.0 or low < edges[0] or high > edges[-1] or self.begin(axis, low, high, velocity).where:
            return Count(math.inf)
        room = edges[-1] - high if through > 0.0 else low - edges[0]
        longest = min(room / abs(through), *self._ends(velocity))
        times = np.concatenate([(edges - low) / through, (edges - high) / through, [longest]])
        times = np.sort(times[(times >= 0.0) & (times <= longest)])
        cells = [cells_between(edges, low + through * time, high + through * time) for time in times]
        n = int(np.argmin(np.round(cells, 9)))
        place = 0.5 * (low + high) + speed * times[n]
        return Count(cells[n], f" at {axis} = {place * 1e3:.4g} mm, which it reaches after {times[n] * 1e6:.3g} us")

    def _ends(self, velocity: Velocity) -> Iterator[float]:
        """Times at which flights with this velocity end, s: the end of the run, and encounters of bodies that have it."""
        deck = self.deck
        yield math.inf if deck.stop.time is None else deck.stop.time
        leader = None if deck.mesh.follow is None else body(deck, deck.mesh.follow).velocity
        for entry, other in product(deck.body, deck.body):
            if entry.velocity in (velocity, leader) and entry.velocity != other.velocity:
                yield from self._encounters(entry, other)

    def _encounters(self, entry: AnyBody, other: AnyBody) -> Iterator[float]:
        """When two bodies that lie side by side meet along an axis, by their velocities along it."""
        ends = {axis: (extent(entry, self.deck, axis), extent(other, self.deck, axis)) for axis in AXES}
        for axis, across, closing in zip(AXES, AXES[::-1], np.subtract(entry.velocity, other.velocity).tolist(), strict=True):
            (low, high), (other_low, other_high) = ends[axis]
            gap = other_low - high if closing > 0.0 else low - other_high
            beside = max(low for low, _ in ends[across]) < min(high for _, high in ends[across])
            if beside and closing != 0.0 and gap >= -ROUNDING * (high - low):
                yield max(gap, 0.0) / abs(closing)
