"""The rod and the target of an input deck, as the analytic models need them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hydro2d.analytic.model_materials import Given
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.materials.material import Material
from hydro2d.solver import insertion


@dataclass(frozen=True)
class Shot:
    """A deck's rod and target: their materials, the impact velocity in m/s, and the geometry by input name."""

    name: str
    rod: Material
    target: Material
    velocity: float
    nose: str
    values: dict[str, Given]


def read(path: Path) -> Shot:
    """The shot of a deck file. Raises DeckError if the deck is wrong or has no rod and target."""
    return shot(decks.load(path))


def shot(deck: decks.Deck) -> Shot:
    """The shot of a resolved deck."""
    if deck.penetration is None or deck.mesh.geometry != "cylindrical":
        raise DeckError(f"{deck.name}: needs a rod on the axis and a target, named in [penetration]")
    rod, target = (decks.body(deck, getattr(deck.penetration, key)) for key in ("rod", "target"))
    if rod.nose_direction is None:
        raise DeckError(f'{deck.name}: the penetrator "{rod.name}" is a {rod.shape}; the models need a rod')
    if len(deck.penetration.targets) > 1:
        raise DeckError(f"{deck.name}: the rod penetrates {', '.join(deck.penetration.targets)}; the models allow one target")
    for body in (rod, target):
        if body.strength_factor not in (None, 1.0):
            raise DeckError(f"{deck.name}: the models take the strength of a material as it is, and the deck scales that of "
                            f'"{body.name}" (strength_factor = {body.strength_factor:g})')
    numbers = {**_rod(rod, deck.materials[rod.material]), **_target(target)}
    values = {name: Given(value, f"deck {deck.name}") for name, value in numbers.items()}
    return Shot(deck.name, deck.materials[rod.material], deck.materials[target.material], decks.impact_velocity(deck),
                rod.nose, values)


def _rod(rod, material: Material) -> dict[str, float | str]:
    """Diameter, mass, length of the cylinder of that mass, and nose."""
    R = rod.rod_radius
    volume = _volume(rod)
    density = rod.density if rod.density is not None else material.reference_density
    values = {
        "rod.diameter": 2.0 * R,
        "rod.mass": density * volume,
        "rod.length": volume / (math.pi * R**2),
        "nose.shape": rod.nose,
    }
    if rod.density is not None:
        values["rod.density"] = density
    return values | {f"nose.{key}": value for key, value in rod.shaped_nose.keys.items()}


def _volume(rod) -> float:
    """Volume of the rod, m^3, from the share of the surrounding cylinder that it fills."""
    outline = rod.outline(0.0)
    edges = np.array(outline.extent("z"))
    share = insertion.fractions([outline], np.array([0.0, rod.rod_radius]), edges, cylindrical=True)
    return float(share[0, 0, 0]) * math.pi * rod.rod_radius**2 * (edges[1] - edges[0])


def _target(target) -> dict[str, float]:
    thickness = target.thickness_in_models
    return {} if thickness is None else {"target.thickness": thickness}
