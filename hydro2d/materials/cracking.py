"""Materials whose damage model opens cracks: their further requirements, and their equation of state."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base.errors import DeckError

if TYPE_CHECKING:
    from hydro2d.materials.material import Material


def opens_cracks(damage: ModuleType) -> bool:
    """Whether a damage model opens cracks."""
    return hasattr(damage, "tension_left")


def cracking_pressure(material: Material, tension: float) -> float:
    """The tension at which its cracks open, Pa: the fracture pressure that the deck gives it, ``tension``.

    Raises DeckError without one, and for a strength model that the damage of cracks would weaken.
    """
    name = material.damage.name
    if material.fracture_pressure is None:
        raise DeckError(f"material {material.name}: {name} needs a fracture_pressure, the tension at which cracks open")
    if not np.isfinite(tension):
        raise DeckError(f"material {material.name}: {name} opens cracks at the fracture pressure, which failure.tensile = "
                        '"none" switches off; write tensile = "material"')
    if hasattr(material.strength.module("strength"), "weakened"):
        raise DeckError(f"material {material.name}: the strength model {material.strength.name} falls with a damage of its own "
                        f"and does not go with {name}")
    return tension


def require_that_it_fails(material: Material, damage: ModuleType, strength: ModuleType) -> None:
    """Raises DeckError where a fracture_stress contradicts the models: failed material has no strength and no cracks."""
    if opens_cracks(damage):
        raise DeckError(f"material {material.name}: {material.damage.name} opens cracks at the fracture_pressure; it does not "
                        "go with a fracture_stress, beyond which material fails at once")
    if hasattr(strength, "weakened"):
        raise DeckError(f"material {material.name}: the strength model {material.strength.name} falls with a damage of its own "
                        "and does not go with a fracture_stress")


def over(material: Material, of_solid: np.ndarray) -> tuple[ModuleType, np.ndarray]:
    """The equation of state of the cracked material and its row, from the row of the sound material.

    Raises DeckError if that has internal variables.
    """
    from eos import cracked

    solid = material.eos.module("eos")
    if hasattr(solid, "INTERNAL"):
        raise DeckError(f"material {material.name}: {material.damage.name} needs an equation of state without internal "
                        f"variables, and {material.eos.name} has some")
    return cracked, cracked.row(solid.ID, of_solid)
