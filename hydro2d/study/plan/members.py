"""The members of an ensemble: one deck with changes that should not matter, each time by another amount.

Member 0 is the deck unchanged. Member n has the n-th point of Roberts' additive sequence: its k-th coordinate is the
fractional part of s + n / phi^k, where phi is the root above 1 of x^(d + 1) = x + 1 in d dimensions and s a number that follows
from the seed. The points cover the unit cube evenly for any number of members, and the n-th does not depend on their number:
an ensemble can be enlarged, and its runs are kept.
Source: M. Roberts, "The unreasonable effectiveness of quasirandom sequences" (2018).
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from hydro2d.base import units
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.deck.identity import cells_to, with_radius
from hydro2d.files import toml
from hydro2d.mesh.edges.registry import BY_NAME
from hydro2d.study.plan.definition import Ensemble
from hydro2d.study.plan.sample_section import Sample

#: largest shift of the mesh and of the flank of the projectile, as fractions of a cell; largest reduction of the first step
SHIFT, FLANK, STEP = 0.5, 0.25, 0.004
#: digits of the values, so that a record has all of them
DIGITS = 6
#: advice if a deck does not allow a change
OTHER = 'repeat it by another change, such as "first step"'
#: keys of a segment of the mesh that are positions, and that are sizes
POSITIONS, SIZES = ("to",), ("size", "first", "last")


@dataclass(frozen=True)
class Knob:
    """A change that should not matter.

    name : as in `by`;  key : one that an axis must not also set, unless it sets the whole mesh under the key `unless`
    value : function from a point in 0 to 1 to the amount that a record keeps
    overrides : of the deck for an amount; raises DeckError if the deck does not allow the change
    """

    name: str
    key: str
    unless: str
    value: Callable[[float], float]
    overrides: Callable[[decks.Deck, float], list[str]]


def _segments(deck: decks.Deck, axis: str, changed: Callable[[str, float], float]) -> list[str]:
    """Overrides of the lengths of the segments of an axis."""
    settings = []
    for number, segment in enumerate(getattr(deck.mesh, axis)):
        for key in (*POSITIONS, *SIZES, "cells_across"):
            value = getattr(segment, key)
            if value is not None and (new := changed(key, value)) != value:
                written = new if key == "cells_across" else units.exact(new, "m")
                settings.append(f"mesh.{axis}.{number}.{key}={toml.inline(written)}")
    return settings


def _free(deck: decks.Deck, what: str, edges: tuple[str, ...]) -> None:
    """Raises DeckError if an edge of the mesh is a boundary that must not move against the bodies."""
    for edge in edges:
        kind = getattr(deck.boundaries, edge)
        if BY_NAME[kind].constrains():
            raise DeckError(f'{what}: the edge {edge} = "{kind}" must not move against the bodies; {OTHER}')


def _shifted(deck: decks.Deck, fraction: float) -> list[str]:
    """The mesh shifted along z by a fraction of its smallest cell."""
    _free(deck, "mesh offset", ("z_min", "z_max"))
    shift = fraction * float(np.min(np.diff(decks.edges(deck)[1])))
    start = f"mesh.z_start={toml.inline(units.exact(deck.mesh.z_start + shift, 'm'))}"
    return [start, *_segments(deck, "z", lambda key, value: value + shift if key in POSITIONS else value)]


def _stretched(deck: decks.Deck, fraction: float) -> list[str]:
    """The mesh stretched along r so that the flank of the projectile lies a fraction of a cell farther in, counted in cells."""
    _, radius = with_radius(deck)
    if radius is None:
        raise DeckError(f"flank offset: the deck has no projectile with a radius; {OTHER}")
    if deck.mesh.r_start != 0.0:
        raise DeckError(f"flank offset: the mesh does not begin at r = 0; {OTHER}")
    _free(deck, "flank offset", ("r_max",))
    across = cells_to(deck, radius)
    factor = across / (across + fraction)
    return _segments(deck, "r", lambda key, value: value / factor if key == "cells_across" else value * factor)


def _first_step(deck: decks.Deck, factor: float) -> list[str]:
    """The first time step changed by a factor."""
    return [f"numerics.initial_dt_factor={toml.inline(deck.numerics.initial_dt_factor * factor)}"]


KNOBS = {knob.name: knob for knob in (
    Knob("mesh offset", "mesh.z_start", "mesh.z", lambda x: SHIFT * (2.0 * x - 1.0), _shifted),
    Knob("flank offset", "mesh.r_start", "mesh.r", lambda x: FLANK * (2.0 * x - 1.0), _stretched),
    Knob("first step", "numerics.initial_dt_factor", "", lambda x: 1.0 - STEP * x, _first_step),
)}


def amounts(ensemble: Ensemble, number: int) -> dict[str, float]:
    """The changes of a member by name: fractions of a cell and the factor of the first step; empty for member 0."""
    if number == 0:
        return {}
    dimensions, start = len(ensemble.by), random.Random(ensemble.seed).random()
    phi = 2.0
    for _ in range(100):  # a contraction: x = (1 + x)^(1 / (d + 1))
        phi = (1.0 + phi) ** (1.0 / (dimensions + 1))
    points = [(start + number * phi ** -(k + 1)) % 1.0 for k in range(dimensions)]
    return _changes(ensemble.by, points)


def amounts_of_row(sample: Sample, row: int) -> dict[str, float]:
    """The changes of a row of a sample by name; rows are counted from 1. They are drawn at random, by the seed and the row.

    A sequence that fills the unit cube evenly, as that of members, would go along with that of the inputs.
    """
    generator = random.Random(f"{sample.seed or 0}, row {row}")
    return _changes(sample.by or (), [generator.random() for _ in sample.by or ()])


def _changes(by: Iterable[str], points: Iterable[float]) -> dict[str, float]:
    """Changes by name, from a point between 0 and 1 for each."""
    return {name: round(KNOBS[name].value(point), DIGITS) for name, point in zip(by, points, strict=True)}


def allowed(deck: decks.Deck) -> tuple[str, ...]:
    """The default changes, without those that a deck does not allow."""
    changes = []
    for each in Ensemble.model_fields["by"].default:
        try:
            KNOBS[each].overrides(deck, KNOBS[each].value(1.0))
        except DeckError:
            continue
        changes.append(each)
    return tuple(changes)


def overrides(deck: decks.Deck, changed: Mapping[str, float]) -> list[str]:
    """The overrides that make a member of a deck; segments of its mesh that it does not have yet are written out first.

    Raises DeckError if the deck does not allow a change.
    """
    settings = [text for name, amount in changed.items() for text in KNOBS[name].overrides(deck, amount)]
    segments = decks.written_segments(deck) if any(text.startswith("mesh.") for text in settings) else {}
    return [*(f"{key}={toml.inline(value)}" for key, value in segments.items()), *settings]


def name(case: str, number: int) -> str:
    """Name of a member: member 0 has that of its case, so that runs made before there was an ensemble belong to it."""
    return case if case and number == 0 else "_".join(filter(None, (case, f"m{number}")))




def conflict(by: Iterable[str], settings: Iterable[str]) -> tuple[str, str] | None:
    """A change whose key a value of an axis also sets, and that key; None if there is none.

    An axis over the whole mesh may be combined with an offset, which is then a fraction of a cell of each mesh.
    """
    for knob in (KNOBS[name] for name in by):
        if knob.key in settings and knob.unless not in settings:
            return knob.name, knob.key
    return None
