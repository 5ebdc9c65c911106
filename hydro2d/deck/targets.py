"""The projectile of a deck with [penetration], and the bodies that it is to go through, in order."""

from __future__ import annotations

from hydro2d.deck import deck as decks
from hydro2d.measure.shot import Flight, Target
from hydro2d.mesh.edges.registry import BY_NAME


def direction(deck) -> float:
    """Of the flight of the projectile along z, 1 or -1."""
    shot = deck.penetration
    return float(decks.heading(decks.body(deck, shot.rod), decks.body(deck, shot.targets[0])))


def flight(deck) -> Flight:
    """The projectile of a deck with [penetration].

    The edge behind it of a mesh that follows it is none through which it can leave: what flows out there is debris.
    """
    body, edges, along = decks.body(deck, deck.penetration.rod), deck.boundaries, direction(deck)
    behind = -along if deck.mesh.follow == body.name else 0.0
    exits = tuple(end for end, kind in ((-1, edges.z_min), (1, edges.z_max)) if BY_NAME[kind].flow() and end != behind)
    radius, length = body.own_radius if body.is_slender else None, decks.axial_length(deck, body)
    return Flight(decks.slots(deck).index(body.join or body.name), along, radius or None, length or None, exits)


def targets(deck) -> list[Target]:
    """The targets of a deck with [penetration], in its order.

    The face of the first one is where the deck has it; a depth is measured from there.
    """
    names, result = decks.slots(deck), []
    for number, name in enumerate(deck.penetration.targets):
        low, high = decks.extent(decks.body(deck, name), deck, "z")
        front, rear = (low, high) if direction(deck) > 0 else (high, low)
        surface = decks.surface(deck) if number == 0 else front
        joined = [decks.extent(entry, deck, "z") for entry in deck.body if name in (entry.name, entry.join)]
        result.append(Target(name, names.index(name), min(z for z, _ in joined), max(z for _, z in joined), surface, rear,
                            decks.body(deck, name).velocity[1]))
    return result


def thickness(deck) -> float | None:
    """From the face of the first target to the rear of the last, m, gaps included; None if the last one has no rear."""
    through = targets(deck)
    has_rear = decks.body(deck, through[-1].name).is_target
    return float(f"{abs(through[-1].rear - through[0].surface):.12g}") if has_rear else None
