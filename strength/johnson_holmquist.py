"""Johnson-Holmquist strength of brittle solids (JH-2): from intact to crushed material as damage grows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import log, point, power
from strength.layout import ROW, SHEAR, YIELD

NAME = "johnson-holmquist"
ID = 7
CONSTANT_MODULUS = True
THERMAL = False
EQUATION = """\
Y = Yi - D (Yi - Yf),  Yi = S A (p* + T*)^N R,  Yf = S min(B p*^M R, sf_max), not above Yi
p* = p/P_HEL,  T* = T/P_HEL,  S = 1.5 (HEL - P_HEL),  R = 1 + C ln max(1, rate/rate0),  G constant;  D is the damage"""
SOURCE = "Johnson & Holmquist, High-Pressure Science and Technology 1993, AIP Conf. Proc. 309 (1994) 981"
VALIDITY = (
    "ceramics and glass under pressure; with the damage of the same name, crushed material keeps the strength Yf and bears no "
    "tension; `bulking` in the equation of state sets the pressure that it gains"
)
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G", POSITIVE),
    Parameter("A", "", REQUIRED, "strength of intact material over S at p* + T* = 1", "A", POSITIVE),
    Parameter("B", "", REQUIRED, "strength of crushed material over S at p* = 1", "B", NON_NEGATIVE),
    Parameter("C", "", 0.0, "increase per e-fold of strain rate", "C", NON_NEGATIVE),
    Parameter("M", "", REQUIRED, "exponent of crushed material", "M", NON_NEGATIVE),
    Parameter("N", "", REQUIRED, "exponent of intact material", "N", NON_NEGATIVE),
    Parameter("T", "Pa", REQUIRED, "largest hydrostatic tension of intact material", "T", NON_NEGATIVE),
    Parameter("HEL", "Pa", REQUIRED, "Hugoniot elastic limit: axial stress", "HEL", POSITIVE),
    Parameter("P_HEL", "Pa", REQUIRED, "pressure at the Hugoniot elastic limit", "P_HEL", POSITIVE),
    Parameter("crushed_limit", "", 1e30, "largest strength of crushed material over S", "sf_max", POSITIVE),
    Parameter("reference_rate", "1/s", 1.0, "strain rate below which the rate does not matter", "rate0", POSITIVE),
)

#: slots of the row; the common ones are SHEAR and YIELD
INTACT, CRUSHED, RATE, CRUSHED_EXPONENT, INTACT_EXPONENT, TENSION, INVERSE_P, LIMIT, INVERSE_RATE0 = range(2, 11)

#: largest relative difference of P_HEL from the value that the equation of state, the shear modulus and HEL give
CONSISTENT = 0.01


@point
def by_rate(rate, par):
    """1 + C ln max(1, rate/rate0)."""
    return 1.0 + par[RATE] * log(max(rate * par[INVERSE_RATE0], 1.0))


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress of intact material, Pa: explanation/strength, (14)."""
    pressed = max(p * par[INVERSE_P] + par[TENSION], 0.0)
    return par[INTACT] * power(pressed, par[INTACT_EXPONENT]) * by_rate(rate, par) if pressed > 0.0 else 0.0


@point
def weakened(flow, rate, p, damage, par):
    """Flow stress of damaged material from that of intact material, ``flow``, Pa: explanation/strength, (15)."""
    pressed = max(p * par[INVERSE_P], 0.0)
    crushed = par[CRUSHED] * power(pressed, par[CRUSHED_EXPONENT]) * by_rate(rate, par) if pressed > 0.0 else 0.0
    return flow - damage * (flow - min(min(crushed, par[LIMIT]), flow))


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if given["HEL"] <= given["P_HEL"]:
        raise ValueError(f"{NAME}: HEL = {given['HEL']:g} Pa: must be above P_HEL = {given['P_HEL']:g} Pa")
    scale = 1.5 * (given["HEL"] - given["P_HEL"])
    par = np.zeros(ROW)
    par[SHEAR], par[INTACT], par[CRUSHED] = given["shear_modulus"], scale * given["A"], scale * given["B"]
    par[RATE], par[INVERSE_RATE0] = given["C"], 1.0 / given["reference_rate"]
    par[CRUSHED_EXPONENT], par[INTACT_EXPONENT] = given["M"], given["N"]
    par[INVERSE_P], par[LIMIT] = 1.0 / given["P_HEL"], scale * given["crushed_limit"]
    par[TENSION] = given["T"] * par[INVERSE_P]
    par[YIELD] = flow_stress(0.0, 0.0, 298.0, 0.0, 1.0, par)
    return par


def check_with(values: Mapping[str, float], pressure) -> None:
    """Raises ValueError if P_HEL contradicts HEL, the shear modulus and the equation of state.

    Uniaxial compression to HEL has 1 - rho0/rho = mu/(1 + mu) and so HEL = p(mu) + 4/3 G mu/(1 + mu).

    pressure : function from mu = rho/rho0 - 1 to the pressure without heat, Pa
    """
    hel, shear, low, high = values["HEL"], values["shear_modulus"], 0.0, 1.0
    for _ in range(60):
        mu = 0.5 * (low + high)
        below = pressure(mu) + 4.0 / 3.0 * shear * mu / (1.0 + mu) < hel
        low, high = (mu, high) if below else (low, mu)
    p_hel = pressure(low)
    if abs(p_hel - values["P_HEL"]) > CONSISTENT * values["P_HEL"]:
        raise ValueError(f"{NAME}: P_HEL = {values['P_HEL']:g} Pa, but HEL = {hel:g} Pa, the shear modulus and the equation of "
                         f"state give {p_hel:g} Pa: the constants contradict each other")
