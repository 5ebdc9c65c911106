"""THE field table: every field's name, centring, unit, parity, bounds, how it is remapped, and whether it is written.

The fields of the bodies that the remap carries stand in the block ``State.q[k, m, j, i]`` in the order of the table; their
integer constants are their positions there. Remap, ghost cells and state follow from the table.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

RHO, E, SRR, SZZ, SRZ, EP, DMG = range(7)

#: how many of the body fields a body carries: without strength, with strength, with strength and damage
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


#: the rows of State.q
BODY = tuple(field for field in FIELDS if field.centring == "body" and field.remap and field.name != "volume_fraction")
BODY_FIELDS = len(BODY)

#: for every row of State.q: whether it is carried per mass (else per volume), and its bounds
BY_MASS = tuple(field.remap == "mass" for field in BODY)
LEAST, MOST = tuple(field.least for field in BODY), tuple(field.most for field in BODY)
BOUNDED = tuple(field.least > -inf or field.most < inf for field in BODY)
#: the rows of State.q that change their sign in a mirror
ODD = tuple(k for k, field in enumerate(BODY) if field.parity < 0)
