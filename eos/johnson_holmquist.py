"""Johnson-Holmquist equation of state of brittle solids (JH-2): a polynomial, and the pressure that crushed material gains.

When damage weakens compressed material, the elastic energy that its deviator loses becomes pressure: broken pieces need more
room. With mu = rho/rho0 - 1,

    p = K1 mu + K2 mu^2 + K3 mu^3 + dP   (mu < 0: K1 mu + dP),
    dP' = sqrt((K1 mu + dP)^2 + 2 beta K1 dU) - K1 mu,

dU the energy per volume that damage has released in the step.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from eos.layout import E0, RHO0, ROW
from hydro2d.base.parameters import ANY, NON_NEGATIVE, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point
from hydro2d.mesh.fields import Field

NAME = "johnson-holmquist"
ID = 5
EQUATION = """\
p = K1 mu + K2 mu^2 + K3 mu^3 + dP,  in expansion K1 mu + dP;  mu = rho/rho0 - 1
dP grows with damage to sqrt((K1 mu + dP)^2 + 2 beta K1 dU) - K1 mu,  dU the elastic energy that damage releases
T = T0 + (e - e_c)/cv,  e_c the energy of compression"""
SOURCE = "Johnson & Holmquist, High-Pressure Science and Technology 1993, AIP Conf. Proc. 309 (1994) 981"
VALIDITY = "ceramics and glass with the strength and damage models of the same name; heat does not change the pressure"
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at zero pressure", "rho0", POSITIVE),
    Parameter("K1", "Pa", REQUIRED, "bulk modulus", "K1", POSITIVE),
    Parameter("K2", "Pa", 0.0, "coefficient of mu^2", "K2", ANY),
    Parameter("K3", "Pa", 0.0, "coefficient of mu^3", "K3", ANY),
    Parameter("bulking", "", 1.0, "share of the released elastic energy that becomes pressure", "beta", NON_NEGATIVE),
    Parameter("specific_heat", "J/(kg*K)", REQUIRED, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rho0 and zero energy", "T0", POSITIVE),
)
INTERNAL = (Field("bulking_pressure", "", "body", "Pa", 1, "volume", True, "pressure that crushed material has gained", 0.0),)

#: slots of the row; the common ones are RHO0 and E0
K1, K2, K3, BULKING, INVERSE_CV, T0 = range(2, 8)


@point
def evaluate(rho, e, internal, par):
    """(p, dp/drho, dp/de, T) at density ``rho`` > 0 and specific energy ``e``; SI. explanation/equation-of-state, (15)"""
    mu = rho / par[RHO0] - 1.0
    near = max(mu, 0.0)
    p = par[K1] * mu + near * near * (par[K2] + par[K3] * near)
    slope = par[K1] + near * (2.0 * par[K2] + 3.0 * par[K3] * near)
    # int p drho/rho^2 by its series about rho0, p/rho0 mu/2: exact to order mu^2, to which the polynomial is known
    cold = 0.5 * p * mu / rho
    return p + internal[0], slope / par[RHO0], 0.0, max(par[T0] + (e - cold) * par[INVERSE_CV], 0.0)


@point
def update(rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal):
    """Turns the elastic energy that damage has ``released`` (J/m^3) into pressure: explanation/equation-of-state, (16)."""
    if released > 0.0:
        bulk = par[K1] * (rho / par[RHO0] - 1.0)
        before = max(bulk + internal[0], 0.0)
        internal[0] += sqrt(before * before + 2.0 * par[BULKING] * par[K1] * released) - before


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW].

    Raises ValueError for a missing, unknown or impossible value, or a polynomial that does not rise throughout compression.
    """
    given = collect(NAME, PARAMETERS, values)
    first, second, third = given["K1"], given["K2"], given["K3"]
    turns = second < 0.0 and (third <= 0.0 or second * second >= 3.0 * first * third)
    if turns or third < 0.0:
        raise ValueError(f"{NAME}: with K1 = {first:g}, K2 = {second:g}, K3 = {third:g} Pa the pressure does not rise "
                         "with density everywhere")
    par = np.zeros(ROW)
    par[RHO0], par[E0] = given["reference_density"], 0.0
    par[K1], par[K2], par[K3], par[BULKING] = first, second, third, given["bulking"]
    par[INVERSE_CV], par[T0] = 1.0 / given["specific_heat"], given["reference_temperature"]
    return par
