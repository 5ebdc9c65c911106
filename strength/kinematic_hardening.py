"""Linear hardening that shifts the yield surface, widens it, or both."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import REQUIRED, Parameter, collect
from hydro2d.jit import point
from hydro2d.mesh.fields import Field
from strength.layout import ROW, SHEAR, YIELD
from strength.rotation import turned

NAME = "kinematic-hardening"
ID = 5
CONSTANT_MODULUS = True
THERMAL = False
EQUATION = """\
sqrt(3/2 (s - a):(s - a)) = Y,  Y = Y0 + b H ep,  da = 2/3 (1 - b) H d(plastic strain), turned with the material,
G constant"""
SOURCE = "Prager, J. Appl. Mech. 23 (1956) 493; mixed with isotropic hardening as by Krieg & Key, ASME AMD-20 (1976) 125"
VALIDITY = "loads that reverse at strains of some per cent; the back stress grows without bound, and nothing softens"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("yield_stress", "Pa", REQUIRED, "initial yield stress in tension", "Y0"),
    Parameter("hardening_modulus", "Pa", 0.0, "slope of the tensile stress over the plastic strain", "H"),
    Parameter("isotropic_share", "", 0.0, "share of the hardening that widens the yield surface, 0 to 1", "b"),
)
INTERNAL = (
    Field("back_stress_rr", "", "body", "Pa", 1, "volume", True, "radial back stress, the centre of the yield surface"),
    Field("back_stress_zz", "", "body", "Pa", 1, "volume", True, "axial back stress; the hoop one is minus the sum"),
    Field("back_stress_rz", "", "body", "Pa", -1, "volume", True, "back stress in shear"),
)

#: slots of the row; the common ones are SHEAR and YIELD
WIDENING, SHIFTING = range(2, 4)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Radius of the yield surface at plastic strain ``ep``, as a tensile stress, Pa: explanation/strength, (11)."""
    return par[YIELD] + par[WIDENING] * ep


@point
def kinematic_modulus(par):
    """Tensile back stress per plastic strain, Pa: explanation/strength, (12)."""
    return par[SHIFTING]


@point
def back_stress(internal):
    """(rr, zz, rz) of the centre of the yield surface, Pa."""
    return internal[0], internal[1], internal[2]


@point
def turn(spin, internal):
    """Turns the back stress with the material, by ``spin`` = W dt: explanation/strength, (1)."""
    internal[0], internal[1], internal[2] = turned(internal[0], internal[1], internal[2], spin)


@point
def melted(internal):
    """Clears the back stress: a melt has none, and starts without it when it freezes."""
    internal[0], internal[1], internal[2] = 0.0, 0.0, 0.0


@point
def harden(dep, rr, zz, rz, par, internal):
    """Shifts the centre by the plastic strain ``dep`` along the unit direction (rr, zz, rz): explanation/strength, (12).

    The direction is (s - a) over its von Mises norm.
    """
    shift = par[SHIFTING] * dep
    internal[0] += shift * rr
    internal[1] += shift * zz
    internal[2] += shift * rz


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if not 0.0 <= given["isotropic_share"] <= 1.0:
        raise ValueError(f"{NAME}: isotropic_share is {given['isotropic_share']:g}, not between 0 and 1")
    par = np.zeros(ROW)
    par[SHEAR], par[YIELD] = given["shear_modulus"], given["yield_stress"]
    par[WIDENING] = given["isotropic_share"] * given["hardening_modulus"]
    par[SHIFTING] = given["hardening_modulus"] - par[WIDENING]
    return par
