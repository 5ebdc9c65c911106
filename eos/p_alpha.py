"""P-alpha: a porous material, whose pores close under pressure, over the equation of state of its solid.

The distention alpha = rho_s/rho is the volume of the material over that of its solid. The internal variable is A, the
distention once the pressure is released; it falls from alpha0 to 1 as the pores crush. Below the crush curve the pores close
and open elastically: with h = c/c_s, the sound speeds of the porous material and of its solid,

    rho_s/rho_s0 = (A rho/rho_s0)^(h^2),    h = 1 + (A - 1)/(alpha0 - 1) (c_e/c_s - 1),

At low pressure this gives c = h c_s and Herrmann's d(alpha)/dp = alpha^2/K_s (1 - 1/h^2).
"""

from __future__ import annotations

import math

import numpy as np

from eos import solid
from eos.layout import E0, RHO0, SOLID_AT
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import late_bound, point
from hydro2d.mesh.fields import Field

NAME = "p-alpha"
ID = 3
#: it builds on the model that `solid` names in the deck
OVER_SOLID = True
EQUATION = """\
p = p_s(rho_s, e)/alpha,  rho_s = alpha rho,  T = T_s(rho_s, e)
alpha <= 1 + (alpha_e - 1) ((P_s - p)/(P_s - P_e))^n,  P_e < p < P_s;  alpha = 1 from P_s on
below it elastic: rho_s/rho_s0 = (A rho/rho_s0)^(h^2),  h = 1 + (A - 1)/(alpha0 - 1) (c_e/c_s - 1),  A falls only by crushing"""
SOURCE = (
    "Herrmann, J. Appl. Phys. 40 (1969) 2490; pressure over alpha: Carroll & Holt, J. Appl. Phys. 43 (1972) 759; power of the "
    "crush curve: Jutzi, Benz & Michel, Icarus 198 (2008) 242; the closed form of the elastic range is ours"
)
VALIDITY = (
    "crushing that does not depend on the rate; pores do not open again in tension; the elastic energy around the pores is not "
    "counted, so that only alpha = 1 or c_e = c_s is fully consistent"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at rest, with the pores", "rho0", POSITIVE),
    Parameter("solid_density", "kg/m^3", REQUIRED, "density of the solid at rest, above reference_density", "rho_s0", POSITIVE),
    Parameter("elastic_sound_speed", "m/s", REQUIRED, "bulk sound speed at rest, with the pores", "c_e", POSITIVE),
    Parameter("elastic_pressure", "Pa", REQUIRED, "pressure at which crushing begins", "P_e", POSITIVE),
    Parameter("crush_pressure", "Pa", REQUIRED, "pressure at which all pores are closed", "P_s", POSITIVE),
    Parameter("crush_exponent", "", 2.0, "exponent of the crush curve", "n", POSITIVE),
)
#: parameters of the solid that are taken from parameters of this model
GIVEN_TO_SOLID = {"reference_density": "solid_density"}
INTERNAL = (
    Field("distention", "", "body", "1", 1, "mass", True, "volume over that of the solid, once the pressure is released", 1.0,
          initial=lambda par: par[VIRGIN]),
)

#: slots of the row; the common ones are RHO0 and E0. VIRGIN is alpha0, DISTENTION alpha_e, where the crush curve begins
SOLID_MODEL, SOLID_RHO, P_ELASTIC, P_CRUSH, EXPONENT, VIRGIN, DISTENTION, SLOPE = range(2, 10)

#: tolerance of the search on the crush curve, and its largest number of steps
_TOLERANCE, _ITERATIONS = 1e-12, 80
#: distance from the crush curve of a state outside the table of the solid
_BEYOND = math.inf


@point
def solid_density(rho, distention, par):
    """(rho_s, h^2) at density ``rho``, kg/m^3: explanation/equation-of-state, (10)."""
    if distention <= 1.0:
        return rho, 1.0
    h = 1.0 + (distention - 1.0) * par[SLOPE]
    compression = distention / par[VIRGIN] * (rho / par[RHO0])  # of the solid, were it not elastic: exactly 1 at rest
    return par[SOLID_RHO] * compression ** (h * h), h * h


@point
def density_of_solid(rho, internal, par):
    """Density of the solid, kg/m^3, at density ``rho`` and these internal variables."""
    return solid_density(rho, internal[0], par)[0]


@late_bound
def evaluate(rho, e, internal, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    The derivatives are those of the elastic range. explanation/equation-of-state, (9) and (10)
    """
    rho_s, square = solid_density(rho, internal[0], par)
    p_s, dpdrho, dpde, T = solid.evaluate(int(par[SOLID_MODEL]), rho_s, e, par[SOLID_AT:])
    share = rho / rho_s
    p = share * p_s
    return p, square * dpdrho + (1.0 - square) * p / rho, share * dpde, T


@point
def crushed(p, par):
    """The largest distention at the pressure ``p``, Pa: explanation/equation-of-state, (11)."""
    if p >= par[P_CRUSH]:
        return 1.0
    left = min((par[P_CRUSH] - p) / (par[P_CRUSH] - par[P_ELASTIC]), 1.0)
    return 1.0 + (par[DISTENTION] - 1.0) * left ** par[EXPONENT]


@late_bound
def excess(rho, e, distention, par):
    """(excess of the distention over the crush curve, pressure in Pa) of material that has ``distention`` at rest.

    Outside the table of the solid the excess is infinite, positive where the solid is compressed and negative where it is
    expanded, and the pressure is NaN.
    """
    rho_s, _ = solid_density(rho, distention, par)
    p = rho / rho_s * solid.evaluate(int(par[SOLID_MODEL]), rho_s, e, par[SOLID_AT:])[0]
    if math.isnan(p):
        return _BEYOND if rho_s > par[SOLID_RHO] else -_BEYOND, p
    return rho_s / rho - crushed(p, par), p


@late_bound
def update(rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal):
    """Crushes the pores until the distention is on the crush curve at density ``rho`` and energy ``e``, or all are closed.

    By a bracketed secant (Illinois) in the distention at rest, with which the excess rises. explanation/equation-of-state, (11)

    The search may begin outside the table of the solid; it then halves the bracket until both ends are inside. If no state in
    the table lies on the curve, the material is left in a state outside the table.
    """
    high = internal[0]
    if high <= 1.0:
        return
    above, p = excess(rho, e, high, par)
    if p <= par[P_ELASTIC] or (above <= 0.0 and p < par[P_CRUSH]):
        return
    low = 1.0
    below, p = excess(rho, e, low, par)
    if below >= 0.0:
        internal[0] = 1.0
        return
    side = 0
    for _ in range(_ITERATIONS):
        if high - low <= _TOLERANCE:
            break
        if above - below < _BEYOND:
            middle = (low * above - high * below) / (above - below)
        else:
            middle = 0.5 * (low + high)
        between, p = excess(rho, e, middle, par)
        if between > 0.0:
            high, above = middle, between
            below = 0.5 * below if side == 1 else below
            side = 1
        else:
            low, below = middle, between
            above = 0.5 * above if side == -1 else above
            side = -1
        if between == 0.0:
            break
    if above < _BEYOND:
        internal[0] = low


def row(values, over, *table) -> np.ndarray:
    """Packs the parameters, by name, and those of the solid, whose module is ``over``; float64[SOLID_AT + its own].

    table : that of the solid (`hydro2d.materials.sesame.Table`), if it has one

    Raises ValueError for a missing, unknown or impossible value, and for a material that is denser than its solid.
    """
    own = {parameter.name for parameter in PARAMETERS}
    given = collect(NAME, PARAMETERS, {name: value for name, value in values.items() if name in own})
    rest = {name: value for name, value in values.items() if name not in own}
    below = over.row({**rest, **{name: given[source] for name, source in GIVEN_TO_SOLID.items()}}, *table)
    rho0, rho_s0, lowest, highest = (given[name] for name in (
        "reference_density", "solid_density", "elastic_pressure", "crush_pressure"))
    if rho0 >= rho_s0:
        raise ValueError(f"{NAME}: reference_density = {rho0:g}, with the pores, must be below solid_density = {rho_s0:g}")
    if lowest >= highest:
        raise ValueError(f"{NAME}: elastic_pressure = {lowest:g} must be below crush_pressure = {highest:g}")
    p, dpdrho, dpde, _ = over.evaluate(rho_s0, below[E0], below)
    sound = math.sqrt(dpdrho + p * dpde / rho_s0**2)
    ratio = given["elastic_sound_speed"] / sound
    if ratio > 1.0:
        raise ValueError(f"{NAME}: elastic_sound_speed = {given['elastic_sound_speed']:g} is above the {sound:g} of the solid")
    alpha0 = rho_s0 / rho0
    par = np.zeros(SOLID_AT + below.size)
    par[RHO0], par[E0], par[SOLID_MODEL], par[SOLID_RHO] = rho0, below[E0], over.ID, rho_s0
    par[P_ELASTIC], par[P_CRUSH], par[EXPONENT] = lowest, highest, given["crush_exponent"]
    par[VIRGIN], par[SLOPE] = alpha0, (ratio - 1.0) / (alpha0 - 1.0)
    par[SOLID_AT:] = below

    def above(compression: float) -> float:
        """Pressure of the virgin material less that at which it crushes; NaN outside the table of the solid."""
        rho_s = rho_s0 * compression ** (ratio * ratio)
        rho = rho0 * compression
        return rho / rho_s * over.evaluate(rho_s, below[E0], below)[0] - lowest

    low, high = 1.0, 2.0
    if above(high) <= 0.0:
        raise ValueError(f"{NAME}: elastic_pressure = {lowest:g} is reached at no density below twice that at rest")
    for _ in range(60):
        compression = 0.5 * (low + high)
        low, high = (compression, high) if above(compression) <= 0.0 else (low, compression)
    if math.isnan(above(high)):
        raise ValueError(f"{NAME}: elastic_pressure = {lowest:g} is not reached in the table of the solid")
    par[DISTENTION] = alpha0 * compression ** (ratio * ratio - 1.0)
    return par
