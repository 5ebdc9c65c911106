"""What a projectile and its targets are before anything has moved: that from which they are measured."""

from __future__ import annotations

from typing import NamedTuple


class Target(NamedTuple):
    """A body that is penetrated.

    name, m : of the body;  low, high : its extent along the axis at the start, with all that is joined to it, m
    surface, rear : axial positions of the face that the rod meets and of the other one, m, at the start
    velocity : axial, m/s, with which the target moves if nothing touches it
    """

    name: str
    m: int
    low: float
    high: float
    surface: float
    rear: float
    velocity: float = 0.0

    def at(self, time: float) -> Target:
        """The target as it would be then if nothing had touched it."""
        way = self.velocity * time
        return self._replace(low=self.low + way, high=self.high + way, surface=self.surface + way, rear=self.rear + way)


class Flight(NamedTuple):
    """The body that penetrates.

    m : its slot;  direction : of its flight along z, 1 or -1
    radius, length : of the deck, m; None for one without, or one that does not lie wholly in the mesh
    exits : the ends of the mesh along z through which it can leave, -1 and 1
    """

    m: int
    direction: float
    radius: float | None
    length: float | None
    exits: tuple[int, ...]
