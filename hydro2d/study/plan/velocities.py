"""The velocities of a search for a transition: equally spaced, so that runs can be reused and have readable names."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hydro2d.base.errors import DeckError
from hydro2d.base.formats import in_toml
from hydro2d.deck import deck as decks
from hydro2d.study.plan import ranges
from hydro2d.study.plan.definition import ROUND, TOLERANCE, Range, Transition

#: name of the axis of a search
AXIS = "velocity"
#: largest relative difference between the velocity of the key and the impact velocity
SAME = 1e-9


@dataclass(frozen=True)
class Budget:
    """Budget of a search with chance: runs for each combination of the axes, runs of a round, seed of changes between runs."""

    runs: int
    round: int
    seed: int


@dataclass(frozen=True)
class Velocities:
    """The velocities that a search may try.

    key : deck key;  labels : velocities as in a deck, the slowest first; with a budget only the two ends
    tolerance : largest width of a bracket, m/s;  of : the outcome searched, as in a study file;  depth : threshold, m
    budget : None for a bisection
    """

    key: str
    labels: tuple[str, ...]
    tolerance: float = TOLERANCE
    of: str = "regime"
    depth: float | None = None
    budget: Budget | None = None

    @classmethod
    def of_study(cls, key: str, given: Transition, names: tuple[str, ...]) -> Velocities:
        """The velocities of a study file, with its defaults."""
        budget = Budget(given.budget, given.round or ROUND, given.seed or 0) if given.budget is not None else None
        return cls(key, names, given.tolerance or TOLERANCE, given.of, given.depth, budget)


def labels(given: Transition) -> tuple[str, ...]:
    """Velocities one tolerance apart, from the slowest; the last step may be shorter. With a budget, only both ends.

    Raises ValueError for too many.
    """
    first, last = (f"{speed:.12g} m/s" for speed in (given.from_, given.to))
    if given.budget is not None:
        return first, last
    step = f"{math.copysign(given.tolerance or TOLERANCE, given.to):.12g} m/s"
    speeds = ranges.values(Range.model_validate({"from": first, "to": last, "step": step}))
    return (*speeds, *([] if speeds[-1] == last else [last]))


def speed(label: str) -> float:
    """Impact velocity of a label, m/s."""
    return abs(float(label.split()[0]))


def key(bases: Iterable[tuple[Path, Sequence[str]]]) -> str:
    """The velocity key of the penetrating rod in these decks, given as files with overrides; wrong decks are ignored.

    Raises ValueError if all decks are wrong, one has no rod, or the rods have different names.
    """
    rods, problems = set(), []
    for file, overrides in bases:
        try:
            deck = decks.load(file, overrides)
        except DeckError as error:
            problems.append(str(error))
            continue
        if deck.penetration is None:
            raise ValueError(f"{file.name} has no projectile and target; [penetration] names them")
        rods.add(deck.penetration.rod)
    if not rods:
        raise ValueError(f"all decks are wrong: {problems[0]}")
    if len(rods) > 1:
        raise ValueError(f"the projectiles of the decks have different names ({', '.join(sorted(rods))}); give key")
    return f"body.{in_toml(rods.pop())}.velocity"


def fault(deck: decks.Deck, key: str, label: str) -> str | None:
    """Why a deck with this velocity under the key does not have this impact velocity; None if it does."""
    if deck.penetration is None:
        return "the deck has no projectile and target; [penetration] names them"
    impact = decks.impact_velocity(deck)
    if math.isclose(impact, speed(label), rel_tol=SAME):
        return None
    return f"with {key} = {label} the projectile hits the target at {impact:g} m/s; the key must set the impact velocity"
