"""Warnings about what a deck says of a shot as a whole: directions, velocities, times, and which body is hard."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hydro2d.deck.layout import axis_edges, extent
from hydro2d.deck.mesh import body
from hydro2d.deck.sections import Deck
from hydro2d.mesh.edges.registry import BY_NAME

#: velocity of an impact up to which the Hugoniots of solids are measured, m/s; faster ones melt and vaporise what they hit
FASTEST_MEASURED = 10_000.0
#: an end time in which a body flies so many times the length of the deck is a mistake in its unit
FLIGHTS = 300.0


def mistakes(deck: Deck) -> Iterator[str]:
    """What is allowed and hardly meant, one sentence each."""
    yield from _flying_away(deck)
    yield from _weaker(deck)
    yield from _tied_rod(deck)
    yield from _too_fast(deck)
    yield from _too_long(deck)


def _flying_away(deck: Deck) -> Iterator[str]:
    """Rods and balls that leave a target behind them and have nothing ahead."""
    for entry in deck.body:
        speed = entry.velocity[1]
        if speed == 0.0 or not (entry.is_slender or entry.shape == "sphere"):
            continue
        edge = BY_NAME.get(deck.boundaries.z_max if speed > 0.0 else deck.boundaries.z_min)
        others = {other.name: extent(other, deck, "z") for other in deck.body if other is not entry and other.is_target
                  and other.velocity[1] * np.sign(speed) < abs(speed)}
        low, high = extent(entry, deck, "z")
        behind = [name for name, (start, end) in others.items() if (end <= low if speed > 0.0 else start >= high)]
        if behind and len(behind) == len(others) and not (edge and edge.constrains()):
            yield (f'body "{entry.name}": flies away from "{behind[0]}", at {speed:g} m/s along z; turn the sign of its '
                   "velocity, or put it on the other side")


def _yield_stress(deck: Deck, name: str) -> float | None:
    """Of a body, Pa; None if its strength model has no such number."""
    entry = body(deck, name)
    number = deck.materials[entry.material].strength.numbers.get("yield_stress")
    return number.value * (entry.strength_factor or 1.0) if number else None


def _weaker(deck: Deck) -> Iterator[str]:
    """Hard bodies that are weaker than one that is not hard."""
    own = {entry.name: stress for entry in deck.body if (stress := _yield_stress(deck, entry.name))}
    soft = {name: stress for name, stress in own.items() if name not in deck.sliding.hard}
    for name in deck.sliding.hard:
        strongest = max(soft, key=soft.__getitem__, default=None)
        if name in own and strongest and soft[strongest] > own[name]:
            yield (f'sliding.hard: "{name}" yields at {own[name] * 1e-9:.3g} GPa and "{strongest}", which is not hard, at '
                   f'{soft[strongest] * 1e-9:.3g} GPa; name the stronger body')


def _tied_rod(deck: Deck) -> Iterator[str]:
    """A rod and a target that are tied to each other because the deck does not mention sliding."""
    if deck.penetration is None or deck.sliding.method != "none" or "method" in deck.sliding.model_fields_set:
        return
    rod, target = deck.penetration.rod, deck.penetration.targets[0]
    strong = all(deck.materials[body(deck, name).material].has_strength for name in (rod, target))
    if strong and body(deck, rod).is_slender:
        yield (f'sliding: is not given, so that "{rod}" and "{target}" are tied where they touch; method = "contact" with '
               f'hard = ["{rod}"] lets them slide and part, method = "none" keeps them tied')


def _too_fast(deck: Deck) -> Iterator[str]:
    """Impacts that are faster than any with which the equation of state of a body was measured."""
    speeds = [entry.velocity[1] for entry in deck.body]
    fastest = max((abs(a - b) for a in speeds for b in speeds), default=0.0)
    solids = [entry.name for entry in deck.body if deck.materials[entry.material].eos.name == "mie-grueneisen"]
    if fastest > FASTEST_MEASURED and solids:
        names = ", ".join(f'"{name}"' for name in solids)
        yield (f"an impact at {fastest * 1e-3:g} km/s vaporises solids, and mie-grueneisen, of {names}, has no vapour and is "
               f'measured up to {FASTEST_MEASURED * 1e-3:g} km/s; take a material with "tillotson" or a table')


def _too_long(deck: Deck) -> Iterator[str]:
    """An end time in which a body would fly much farther than the deck reaches."""
    speed = max((abs(entry.velocity[1]) for entry in deck.body), default=0.0)
    if deck.stop.time is None or speed == 0.0:
        return
    ends = [*axis_edges(deck, "z")[[0, -1]], *(end for entry in deck.body for end in extent(entry, deck, "z"))]
    ends = [end for end in ends if np.isfinite(end)]
    length = float(max(ends) - min(ends))
    if speed * deck.stop.time > FLIGHTS * length:
        yield (f"stop.time: in {deck.stop.time:g} s a body at {speed:g} m/s flies {speed * deck.stop.time:.3g} m, and the deck "
               f"is {length:.3g} m long; look at the unit")
