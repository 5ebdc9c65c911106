"""Stiffened gas: a liquid or solid whose pressure is linear in density.

With p_inf = rho0 c0^2/gamma and e measured from the state (rho0, p = 0), the usual form
p = (gamma - 1) rho (e - q) - gamma p_inf is the one below, which vanishes exactly at rho0. Its isentrope through that
state is, with x = rho/rho0,

    e_s = c0^2 [ 1/(gamma x) - 1/(gamma - 1) + x^(gamma-1) / (gamma (gamma-1)) ],    T_s = T0 x^(gamma-1).
"""

from __future__ import annotations

import numpy as np

from eos.layout import E0, RHO0, ROW
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point

NAME = "stiffened-gas"
ID = 2
EQUATION = """\
p = c0^2 (rho - rho0) + (gamma - 1) rho e
T = T0 x^(gamma-1) + (e - e_s(x))/cv,  x = rho/rho0,  e_s the isentrope through (rho0, 0)"""
SOURCE = "Harlow & Amsden, Fluid Dynamics, LA-4700 (1971)"
VALIDITY = "liquids and weakly shocked solids; the sound speed at rest is c0; constant gamma and cv"
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at zero pressure and energy", "rho0", POSITIVE),
    Parameter("sound_speed", "m/s", REQUIRED, "sound speed at rest", "c0", POSITIVE),
    Parameter("adiabatic_index", "", REQUIRED, "exponent, above 1", "gamma", POSITIVE),
    Parameter("specific_heat", "J/(kg*K)", REQUIRED, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rho0 and zero energy", "T0", POSITIVE),
)

#: slots of the row; the common ones are RHO0 and E0
C0_SQUARED, GAMMA_MINUS_ONE, INVERSE_CV, INVERSE_RHO0, ADIABAT, RECIPROCAL, CONSTANT = range(2, 9)


@point
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    explanation/equation-of-state, (8)
    """
    grueneisen = par[GAMMA_MINUS_ONE]
    p = par[C0_SQUARED] * (rho - par[RHO0]) + grueneisen * rho * e
    dpdrho = par[C0_SQUARED] + grueneisen * e
    x = rho * par[INVERSE_RHO0]
    cold = par[ADIABAT] * x**grueneisen - par[RECIPROCAL] / x + par[CONSTANT]
    return p, dpdrho, grueneisen * rho, max(cold + e * par[INVERSE_CV], 0.0)


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    gamma, cv = given["adiabatic_index"], given["specific_heat"]
    if gamma <= 1.0:
        raise ValueError(f"{NAME}: adiabatic_index = {gamma}: must be above 1")
    c0_squared = given["sound_speed"] ** 2
    par = np.zeros(ROW)
    par[RHO0], par[E0], par[INVERSE_RHO0] = given["reference_density"], 0.0, 1.0 / given["reference_density"]
    par[C0_SQUARED], par[GAMMA_MINUS_ONE], par[INVERSE_CV] = c0_squared, gamma - 1.0, 1.0 / cv
    par[RECIPROCAL], par[CONSTANT] = c0_squared / (gamma * cv), c0_squared / ((gamma - 1.0) * cv)
    par[ADIABAT] = given["reference_temperature"] - (par[CONSTANT] - par[RECIPROCAL])
    return par
