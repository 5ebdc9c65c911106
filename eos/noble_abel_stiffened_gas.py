"""Noble-Abel stiffened gas: a stiffened gas whose molecules take a volume that cannot be compressed.

In its usual form, with v = 1/rho, p = (gamma - 1)(e - q)/(v - b) - gamma p_inf. Here e is measured from the state
(rho0, p = 0), and the sound speed at rest stands in place of p_inf:

    p_inf = rho0 c0^2 (1 - beta)/gamma,  beta = b rho0,    q = -p_inf gamma (1/rho0 - b)/(gamma - 1)

which gives the form below. Its isentrope through that state is, with y = (v0 - b)/(v - b),

    p_s = p_inf (y^gamma - 1),    e_s = p_inf [(v0 - b)(y^(gamma-1) - 1)/(gamma - 1) + v - v0],    T_s = T0 y^(gamma-1).
"""

from __future__ import annotations

import numpy as np

from eos.layout import E0, RHO0, ROW
from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point

NAME = "noble-abel-stiffened-gas"
ID = 9
EQUATION = """\
x = rho/rho0,  beta = b rho0,  D = 1 - beta x
p = [rho0 c0^2 (1 - beta)(x - 1) + (gamma - 1) rho e]/D
T = T0 y^(gamma-1) + (e - e_s(x))/cv,  y = x (1 - beta)/D,  e_s the isentrope through (rho0, 0)"""
SOURCE = (
    "Le Metayer & Saurel, The Noble-Abel stiffened-gas equation of state, Phys. Fluids 28 (2016) 046102; the free reference "
    "temperature is our choice, theirs is p_inf (1/rho0 - b)/((gamma - 1) cv)"
)
VALIDITY = (
    "liquids, from cavitation to some GPa, and dense gases; constant gamma and cv; below beta x = 0.95, beyond which D is "
    "constant, so that the pressure stays finite"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at zero pressure and energy", "rho0", POSITIVE),
    Parameter("sound_speed", "m/s", REQUIRED, "sound speed at rest", "c0", POSITIVE),
    Parameter("adiabatic_index", "", REQUIRED, "exponent, above 1", "gamma", POSITIVE),
    Parameter("covolume", "m^3/kg", REQUIRED, "volume that the molecules take, below 1/rho0", "b", NON_NEGATIVE),
    Parameter("specific_heat", "J/(kg*K)", REQUIRED, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rho0 and zero energy", "T0", POSITIVE),
)

#: slots of the row; the common ones are RHO0 and E0
COLD, GAMMA_MINUS_ONE, BETA, INVERSE_CV, INVERSE_RHO0, ADIABAT, RECIPROCAL, CONSTANT = range(2, 10)

#: least D: where the molecules would touch it is 0
CLOSEST = 0.05


@point
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    explanation/equation-of-state, (8b)
    """
    grueneisen, x = par[GAMMA_MINUS_ONE], rho * par[INVERSE_RHO0]
    room = 1.0 - par[BETA] * x
    touches = room < CLOSEST
    room = max(room, CLOSEST)
    p = (par[COLD] * (rho - par[RHO0]) + grueneisen * rho * e) / room
    squeeze = 0.0 if touches else p * par[BETA] * par[INVERSE_RHO0]
    dpdrho = (par[COLD] + grueneisen * e + squeeze) / room
    y = x * (1.0 - par[BETA]) / room
    cold = par[ADIABAT] * y**grueneisen - par[RECIPROCAL] / x + par[CONSTANT]
    return p, dpdrho, grueneisen * rho / room, max(cold + e * par[INVERSE_CV], 0.0)


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    gamma, cv, rho0 = given["adiabatic_index"], given["specific_heat"], given["reference_density"]
    beta = given["covolume"] * rho0
    if gamma <= 1.0:
        raise ValueError(f"{NAME}: adiabatic_index = {gamma}: must be above 1")
    if beta >= 1.0 - CLOSEST:
        raise ValueError(f"{NAME}: covolume = {given['covolume']:g}: the molecules must take less than {1.0 - CLOSEST:g} of "
                         f"the volume at rest, 1/reference_density = {1.0 / rho0:g} m^3/kg")
    stiffness = given["sound_speed"] ** 2 * (1.0 - beta)  # gamma p_inf/rho0
    par = np.zeros(ROW)
    par[RHO0], par[E0], par[INVERSE_RHO0] = rho0, 0.0, 1.0 / rho0
    par[COLD], par[GAMMA_MINUS_ONE], par[BETA], par[INVERSE_CV] = stiffness, gamma - 1.0, beta, 1.0 / cv
    # e_s/cv = adiabat (y^(gamma-1) - 1) + reciprocal (1/x - 1)
    adiabat, par[RECIPROCAL] = stiffness * (1.0 - beta) / (gamma * (gamma - 1.0) * cv), stiffness / (gamma * cv)
    par[ADIABAT], par[CONSTANT] = given["reference_temperature"] - adiabat, adiabat + par[RECIPROCAL]
    return par
