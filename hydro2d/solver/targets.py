"""The bodies that a rod is to go through, in order."""

from __future__ import annotations

from typing import NamedTuple

from hydro2d.deck import deck as decks


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


def targets(deck, direction: float) -> list[Target]:
    """The targets of a deck with [penetration], in its order, for a rod that flies towards +z (1) or -z (-1).

    The face of the first one is where the deck has it; a depth is measured from there.
    """
    names, result = decks.slots(deck), []
    for number, name in enumerate(deck.penetration.targets):
        low, high = decks.extent(decks.body(deck, name), deck, "z")
        front, rear = (low, high) if direction > 0 else (high, low)
        surface = decks.surface(deck) if number == 0 else front
        joined = [decks.extent(entry, deck, "z") for entry in deck.body if name in (entry.name, entry.join)]
        result.append(Target(name, names.index(name), min(z for z, _ in joined), max(z for _, z in joined), surface, rear,
                            decks.body(deck, name).velocity[1]))  # fmt: skip
    return result
