"""Tillotson equation of state: a solid that a strong shock melts and vaporises.

With x = rho/rho0, mu = x - 1, w = e/(E0 x^2) + 1 and y = 1/x - 1:

    compressed, or expanded with e <= Eiv   p_c = (a + b/w) rho e + A mu + B mu^2
    expanded, e >= Ecv                      p_e = a rho e + (b rho e/w + A mu exp(-beta y)) exp(-alpha y^2)
    expanded, Eiv < e < Ecv                 p = [(e - Eiv) p_e + (Ecv - e) p_c]/(Ecv - Eiv)

Two choices are ours. In expansion the cold curve A mu + B mu^2 continues along its tangent once its slope has fallen to a tenth
of A: otherwise it would turn, and push material that is torn apart together again. Where e is negative, as slightly below the
isentrope at rest, w is 1.

Tillotson's equations have no temperature. Ours is that of a solid of constant specific heat about the isentrope through
(rho0, e = 0), whose Grueneisen coefficient is (1/rho) dp/de there. It leaves out the heats of melting and vaporisation.
"""

from __future__ import annotations

from math import exp

import numpy as np

from eos.layout import E0, RHO0, ROW, TABLE, TABLE_SIZE
from eos.mie_grueneisen import INVERSE_CV, INVERSE_RHO0, INVERSE_STEP, ORIGIN, cold_temperature
from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import not_inlined, point

NAME = "tillotson"
ID = 4
EQUATION = """\
x = rho/rho0,  mu = x - 1,  y = 1/x - 1,  w = e/(E0 x^2) + 1
p_c = (a + b/w) rho e + A mu + B mu^2                                      compression, or e <= Eiv
p_e = a rho e + [b rho e/w + A mu exp(-beta y)] exp(-alpha y^2)            expansion, e >= Ecv
p = [(e - Eiv) p_e + (Ecv - e) p_c]/(Ecv - Eiv)                            expansion between
T = T_s(x) + (e - e_s(x))/cv,  T_s and e_s on the isentrope through (rho0, T0, 0)"""
SOURCE = (
    "Tillotson, General Atomic report GA-3216 (1962); Melosh, Impact Cratering (1989), appendix II; the tangent of the cold "
    "curve in far expansion and the temperature are our choice"
)
VALIDITY = (
    "metals and rocks from the elastic range to vapour; p is continuous, its slopes jump at rho0, Eiv and Ecv; the temperature "
    "has no heat of melting or vaporisation, and its slopes differ from those consistent with p by 2 % at 0.1 MJ/kg and 20 % "
    "at Eiv"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at zero pressure and energy", "rho0", POSITIVE),
    Parameter("a", "", REQUIRED, "Grueneisen coefficient of the vapour", "a", POSITIVE),
    Parameter("b", "", REQUIRED, "the solid's Grueneisen coefficient in addition to a", "b", NON_NEGATIVE),
    Parameter("A", "Pa", REQUIRED, "bulk modulus at rest", "A", POSITIVE),
    Parameter("B", "Pa", REQUIRED, "second coefficient of the cold curve", "B", NON_NEGATIVE),
    Parameter("E0", "J/kg", REQUIRED, "energy in the Grueneisen coefficient", "E0", POSITIVE),
    Parameter("incipient_vaporisation", "J/kg", REQUIRED, "energy at which vaporisation begins", "Eiv", POSITIVE),
    Parameter("complete_vaporisation", "J/kg", REQUIRED, "energy at which it is complete, above Eiv", "Ecv", POSITIVE),
    Parameter("alpha", "", REQUIRED, "decay of the solid's pressure in hot expansion", "alpha", NON_NEGATIVE),
    Parameter("beta", "", REQUIRED, "decay of the cold curve in hot expansion", "beta", NON_NEGATIVE),
    Parameter("specific_heat", "J/(kg*K)", REQUIRED, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rho0 and zero energy", "T0", POSITIVE),
)

#: slots of the row, next to those that its table of temperatures shares with `mie_grueneisen`
A_VAPOUR, B_SOLID, BULK, SECOND, INVERSE_ENERGY, ALPHA = 3, 4, 5, 6, 7, 8
BETA, TURN, EIV, ECV = 12, 13, 14, 15

#: slope of the cold curve, over A, below which it continues along its tangent
LEAST_SLOPE = 0.1
#: the ends of the table, in 1 - rho0/rho
EXPANSION, COMPRESSION = 0.6, 0.8
#: largest exponent of the decay in hot expansion: exp of more is 0
FARTHEST = 700.0
#: least rho/rho0 at which the equations are evaluated, so that no power of it vanishes
THINNEST = 1e-90
#: largest error of the temperature in T ds = de - p drho/rho^2, as a share of its terms: it is based on one isentrope only
TEMPERATURE_WITHIN = 0.25


@point
def cold(mu, par):
    """(A mu + B mu^2, its derivative to mu), Pa; below TURN it decays as the pull of the vapour does."""
    near = max(mu, par[TURN])
    slope = par[BULK] + 2.0 * par[SECOND] * near
    p = near * (par[BULK] + par[SECOND] * near)
    if mu < near:
        x = max(1.0 + mu, THINNEST)
        beyond = 1.0 / x - 1.0 / (1.0 + near)
        p *= exp(-min((par[ALPHA] * beyond + par[BETA]) * beyond, FARTHEST))
        slope = p * (2.0 * par[ALPHA] * beyond + par[BETA]) / (x * x)
    return p, slope


@point
def condensed(rho, e, x, par):
    """(p_c, dp/drho, dp/de) of compressed or cold material."""
    warm = max(e, 0.0) * par[INVERSE_ENERGY]
    inverse_w = x * x / (warm + x * x)
    gamma = par[A_VAPOUR] + par[B_SOLID] * inverse_w
    p, slope = cold(x - 1.0, par)
    dgamma = 2.0 * par[B_SOLID] * inverse_w * (1.0 - inverse_w)  # rho times the derivative to rho
    dpde = rho * (par[A_VAPOUR] + par[B_SOLID] * inverse_w * inverse_w)
    return p + gamma * rho * e, (gamma + dgamma) * e + slope * par[INVERSE_RHO0], dpde


@point
def vapour(rho, e, x, par):
    """(p_e, dp/drho, dp/de) of hot expanded material, x < 1 and e > 0."""
    y = 1.0 / x - 1.0
    inverse_w = x * x / (e * par[INVERSE_ENERGY] + x * x)
    fade = exp(-min(par[ALPHA] * y * y, FARTHEST))
    tail = exp(-min(par[BETA] * y, FARTHEST))
    solid = par[B_SOLID] * rho * e * inverse_w
    pull = par[BULK] * (x - 1.0) * tail
    d_solid = par[B_SOLID] * e * par[RHO0] * inverse_w * (3.0 - 2.0 * inverse_w)
    d_pull = par[BULK] * tail * (1.0 + (x - 1.0) * par[BETA] / (x * x))
    dpdx = par[A_VAPOUR] * e * par[RHO0] + (d_solid + d_pull + (solid + pull) * 2.0 * par[ALPHA] * y / (x * x)) * fade
    dpde = rho * (par[A_VAPOUR] + par[B_SOLID] * inverse_w * inverse_w * fade)
    return par[A_VAPOUR] * rho * e + (solid + pull) * fade, dpdx * par[INVERSE_RHO0], dpde


@point
def mechanical(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho) in all regions."""
    x = max(rho * par[INVERSE_RHO0], THINNEST)
    p, dpdrho, dpde = condensed(rho, e, x, par)
    if x < 1.0 and e > par[EIV]:
        p_e, dpdrho_e, dpde_e = vapour(rho, e, x, par)
        if e >= par[ECV]:
            return p_e, dpdrho_e, dpde_e
        span = 1.0 / (par[ECV] - par[EIV])
        share = (e - par[EIV]) * span
        dpde += share * (dpde_e - dpde) + (p_e - p) * span
        p += share * (p_e - p)
        dpdrho += share * (dpdrho_e - dpdrho)
    return p, dpdrho, dpde


@not_inlined
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    explanation/equation-of-state, (12) to (14)
    """
    p, dpdrho, dpde = mechanical(rho, e, par)
    T = cold_temperature(1.0 - par[RHO0] / rho, par) + e * par[INVERSE_CV]
    return p, dpdrho, dpde, max(T, 0.0)


def row(values) -> np.ndarray:
    """Packs the parameters, by name, and the table of cold temperatures; float64[ROW].

    Raises ValueError for a missing, unknown or impossible value.
    """
    given = collect(NAME, PARAMETERS, values)
    begins, ends = given["incipient_vaporisation"], given["complete_vaporisation"]
    if ends <= begins:
        raise ValueError(f"{NAME}: complete_vaporisation = {ends:g} J/kg: must be above "
                         f"incipient_vaporisation = {begins:g} J/kg")
    par = np.zeros(ROW)
    par[RHO0], par[E0], par[INVERSE_RHO0] = given["reference_density"], 0.0, 1.0 / given["reference_density"]
    par[A_VAPOUR], par[B_SOLID], par[BULK], par[SECOND] = given["a"], given["b"], given["A"], given["B"]
    par[INVERSE_ENERGY], par[ALPHA], par[BETA] = 1.0 / given["E0"], given["alpha"], given["beta"]
    par[TURN] = max(-0.5 * (1.0 - LEAST_SLOPE) * given["A"] / given["B"], -1.0) if given["B"] > 0.0 else -1.0
    par[EIV], par[ECV], par[INVERSE_CV] = begins, ends, 1.0 / given["specific_heat"]
    origin = round((TABLE_SIZE - 1) * EXPANSION / (EXPANSION + COMPRESSION))
    step = EXPANSION / origin
    par[INVERSE_STEP], par[ORIGIN] = 1.0 / step, origin
    for way, places in ((step, range(origin, TABLE_SIZE)), (-step, range(origin, -1, -1))):
        par[TABLE:][places] = isentrope(par, given["reference_temperature"], way, len(places))
    return par


def isentrope(par: np.ndarray, T0: float, step: float, number: int) -> np.ndarray:
    """T_s - e_s/cv at 1 - rho0/rho = 0, step, 2 step and so on, on the isentrope through (rho0, T0, e = 0); K.

    de = p deta/rho0 and dT/T = (dp/de) deta/rho0 with eta = 1 - rho0/rho, by the Runge-Kutta method of fourth order.
    """
    def slopes(eta, e):
        p, _, dpde = mechanical(par[RHO0] / (1.0 - eta), e, par)
        return p / par[RHO0], dpde / par[RHO0]

    temperatures, e, log = np.zeros(number), 0.0, 0.0
    for k in range(number):
        temperatures[k] = T0 * np.exp(log) - e * par[INVERSE_CV]
        eta, total = k * step, np.zeros(2)
        at = slopes(eta, e)
        for part, weight in ((0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)):
            total += weight * np.array(at)
            at = slopes(eta + part * step, e + part * step * at[0]) if part else at
        e += step / 6.0 * total[0]
        log += step / 6.0 * total[1]
    return temperatures
