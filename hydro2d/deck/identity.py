"""What tells runs apart: a hash of everything in a deck that can change its results, and the cells across the projectile."""

from __future__ import annotations

import hashlib
import json

import numpy as np

from hydro2d.deck.layout import edges
from hydro2d.deck.mesh import body_radius
from hydro2d.deck.sections import Deck

#: letters of a hash
LETTERS = 12
#: tables and keys of a deck that change no result
TOLD = ("name", "title", "output", "experiment", "tracer", "materials")
#: parameters of materials that are later than the first kept rows, with the values at which they change nothing
LATER = {"hugoniot_slope_2": 0.0, "hugoniot_slope_3": 0.0}


def setup(deck: Deck) -> str:
    """A hash of everything in a deck that can change its results, without keys that have their default values.

    Titles, outputs, tracers and the experiment are left out. A new key of a later version leaves the hash alone, as does a new
    parameter of a material that is in LATER.
    """
    data = deck.model_dump(mode="json", exclude=set(TOLD), exclude_defaults=True)
    materials = {name: {key: _without_later(value) for key, value in material.as_deck().items() if key != "title"}
                 for name, material in deck.materials.items()}
    text = json.dumps(data | {"materials": materials}, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:LETTERS]


def _without_later(part):
    """A part of a material without parameters that are in LATER and change nothing."""
    if not isinstance(part, dict):
        return part
    return {key: value for key, value in part.items() if not (key in LATER and value == LATER[key])}


def with_radius(deck: Deck) -> tuple[str, float] | tuple[None, None]:
    """Name and radius in m of the penetrating body, or of the first body that has a radius; None without such a body."""
    names = [deck.penetration.rod] if deck.penetration else [body.name for body in deck.body]
    return next(((name, radius) for name in names if (radius := body_radius(deck, name)) is not None), (None, None))


def cells_to(deck: Deck, radius: float) -> float:
    """Number of cells from the axis to a radius, counted in fractions of the cell that the radius cuts."""
    along_r = edges(deck)[0]
    return float(np.interp(radius, along_r, np.arange(len(along_r))))


def cells_across(deck: Deck) -> float | None:
    """Number of cells across the radius of the projectile, or of the first body that has one; None without such a body."""
    radius = with_radius(deck)[1]
    return None if radius is None else cells_to(deck, radius)
