"""Ideal gas with constant specific heats."""

from __future__ import annotations

import numpy as np

from eos.layout import E0, RHO0, ROW
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point

NAME = "ideal-gas"
ID = 1
EQUATION = "p = (gamma - 1) rho e,  T = e/cv"
SOURCE = "textbook"
VALIDITY = "gases of constant specific heats, e >= 0; no tension"
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at rest", "rho0", POSITIVE),
    Parameter("adiabatic_index", "", REQUIRED, "ratio of specific heats, above 1", "gamma", POSITIVE),
    Parameter("specific_heat", "J/(kg*K)", 717.5, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_energy", "J/kg", 0.0, "specific internal energy at rest", "e0"),
)

#: slots of the row; the common ones are RHO0 and E0
GAMMA_MINUS_ONE, INVERSE_CV = 2, 3


@point
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    explanation/equation-of-state, (7)
    """
    dpdrho = par[GAMMA_MINUS_ONE] * e
    dpde = par[GAMMA_MINUS_ONE] * rho
    return dpdrho * rho, dpdrho, dpde, max(e * par[INVERSE_CV], 0.0)


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if given["adiabatic_index"] <= 1.0:
        raise ValueError(f"{NAME}: adiabatic_index = {given['adiabatic_index']}: must be above 1")
    par = np.zeros(ROW)
    par[RHO0], par[E0] = given["reference_density"], given["reference_energy"]
    par[GAMMA_MINUS_ONE], par[INVERSE_CV] = given["adiabatic_index"] - 1.0, 1.0 / given["specific_heat"]
    return par
