"""THE field table: every field's name, centring, unit, parity, bounds, how it is remapped, and whether it is written.

The fields of the bodies that the remap carries stand in the block ``State.q[k, m, j, i]`` in the order of the table; their
integer constants are their positions there. From row ``INTERNAL`` on follow the internal variables of the body's strength
model, which the model declares as fields of its own. Remap, ghost cells and state follow from the table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

RHO, E, SRR, SZZ, SRZ, EP, DMG = range(7)

#: how many of the body fields a body carries: without strength, with strength, with strength and damage; with internal
#: variables, all that stand before them as well
CARRIED_FLUID, CARRIED_SOLID, CARRIED_DAMAGE = 2, 6, 7

#: rows that a thread carries through a phase at a time: few enough to stay in its cache
BLOCK = 32
#: rows of scratch of a block
SCRATCH = 4


@dataclass(frozen=True)
class Field:
    """One line of the field table.

    ``centring`` is "body" ([m, j, i]), "cell" ([j, i]) or "vertex" ([b, j, i]); ``parity`` the sign in a mirror; ``remap``
    what carries it: "volume", "mass", "momentum" or "" (derived, never remapped); ``least`` and ``most`` are the bounds within
    which the remap keeps it.
    """

    name: str
    symbol: str
    centring: str
    unit: str
    parity: int
    remap: str
    written: bool
    meaning: str
    least: float = -inf
    most: float = inf


FIELDS = (
    Field("volume_fraction", "vof", "body", "1", 1, "volume", True, "share of the cell that the body fills"),
    Field("density", "rho", "body", "kg/m^3", 1, "volume", True, "density of the body's material in the cell"),
    Field("energy", "e", "body", "J/kg", 1, "mass", True, "specific internal energy"),
    Field("stress_rr", "srr", "body", "Pa", 1, "volume", True, "radial deviatoric stress"),
    Field("stress_zz", "szz", "body", "Pa", 1, "volume", True, "axial deviatoric stress"),
    Field("stress_rz", "srz", "body", "Pa", -1, "volume", True, "shear stress"),
    Field("plastic_strain", "ep", "body", "1", 1, "mass", True, "equivalent plastic strain", 0.0),
    Field("damage", "dmg", "body", "1", 1, "mass", True, "damage, 1 when failed", 0.0, 1.0),
    Field("body_pressure", "pm", "body", "Pa", 1, "", True, "pressure of the body's material"),
    Field("bulk_modulus", "km", "body", "Pa", 1, "", False, "adiabatic bulk modulus rho c^2"),
    Field("temperature", "tm", "body", "K", 1, "", True, "temperature"),
    Field("pressure", "p", "cell", "Pa", 1, "", True, "pressure of the cell, void counts nothing"),
    Field("viscosity_r", "qr", "cell", "Pa", 1, "", False, "artificial viscosity against radial compression"),
    Field("viscosity_z", "qz", "cell", "Pa", 1, "", False, "artificial viscosity against axial compression"),
    Field("contact_pressure", "contact_pressure", "cell", "Pa", 1, "", True, "normal pressure at the interface of a contact"),
    Field("radial_velocity", "u", "vertex", "m/s", -1, "momentum", True, "radial velocity"),
    Field("axial_velocity", "v", "vertex", "m/s", 1, "momentum", True, "axial velocity"),
    Field("vertex_mass", "mass", "vertex", "kg", 1, "mass", False, "mass of the dual cell, per radian"),
)


#: the rows of State.q that every body has
BODY = tuple(field for field in FIELDS if field.centring == "body" and field.remap and field.name != "volume_fraction")

#: the row of State.q in which the internal variables of a body's strength model begin
INTERNAL = len(BODY)

#: columns of `remap_rules`: 1 for what is carried per mass, 0 per volume; the bounds; the sign in a mirror
PER_MASS, LEAST, MOST, PARITY = range(4)


def remap_rules(internal: Sequence[Sequence[Field]]) -> np.ndarray:
    """How every row of State.q of every body is remapped and mirrored, float64[m, k, 4] with the columns PER_MASS to PARITY.

    ``internal`` holds the internal variables of every body; a body that has fewer than another has empty rows at the end.
    """
    rows = INTERNAL + max((len(own) for own in internal), default=0)
    rules = np.zeros((len(internal), rows, 4))
    rules[..., LEAST], rules[..., MOST], rules[..., PARITY] = -inf, inf, 1
    for m, own in enumerate(internal):
        for k, field in enumerate((*BODY, *own)):
            rules[m, k] = field.remap == "mass", field.least, field.most, field.parity
    return rules
