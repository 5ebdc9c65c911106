"""Explosive: an unreacted solid that a burn fraction turns into detonation products after Jones, Wilkins and Lee (JWL).

With V = rho0/rho, mu = rho/rho0 - 1, E = rho0 e the energy per initial volume, and the burn fraction F,

    p = (1 - F) rho0 c0^2 mu + F p_JWL(V, E),   1 - F/0.01, at least 0, instead of 1 - F where mu < 0,
    p_JWL = A (1 - omega/(R1 V)) exp(-R1 V) + B (1 - omega/(R2 V)) exp(-R2 V) + omega E/V.

The unreacted solid at rest has the energy of the detonation, e0 = E0/rho0; the products have that energy less the work they
have done. F follows from a light time, which a source in the deck assigns to the material before the first step.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from eos.layout import E0, RHO0, ROW
from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import exp, point
from hydro2d.mesh.fields import Field

NAME = "jwl"
ID = 6
EQUATION = """\
p = (1 - F) rho0 c0^2 mu + F p_JWL(V, E),  V = rho0/rho,  mu = 1/V - 1,  E = rho0 e
where mu < 0, max(1 - F/0.01, 0) instead of 1 - F: what has begun to burn bears no tension
p_JWL = A (1 - omega/(R1 V)) exp(-R1 V) + B (1 - omega/(R2 V)) exp(-R2 V) + omega E/V
F = max(F, 0.64 + (t - t_light)/t_burn, beta (1 - V)/(1 - V_CJ)) up to 1
T = (1 - F) (T0 + (e - E0/rho0)/cv) + F (E - A/R1 exp(-R1 V) - B/R2 exp(-R2 V))/(rho0 cv)"""
SOURCE = (
    "Lee, Finger & Collins, UCID-16189 (1973); burn fraction: Wilkins, and LS-DYNA's *MAT_HIGH_EXPLOSIVE_BURN [recalled]"
)
VALIDITY = (
    "detonations that start at points named in the deck and run at the speed the constants give; no initiation by a shock, no "
    "failure below a critical diameter; the temperature is rough, with one specific heat"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at rest", "rho0", POSITIVE),
    Parameter("A", "Pa", REQUIRED, "first pressure of the products", "A", POSITIVE),
    Parameter("B", "Pa", REQUIRED, "second pressure of the products", "B", POSITIVE),
    Parameter("R1", "", REQUIRED, "exponent of the first pressure", "R1", POSITIVE),
    Parameter("R2", "", REQUIRED, "exponent of the second pressure", "R2", POSITIVE),
    Parameter("omega", "", REQUIRED, "Grueneisen parameter of the products", "omega", POSITIVE),
    Parameter("detonation_energy", "Pa", REQUIRED, "energy of the detonation per initial volume, J/m^3", "E0", POSITIVE),
    Parameter("detonation_velocity", "m/s", REQUIRED, "speed of the detonation; the constants must give it within 1 %", "D",
              POSITIVE),
    Parameter("cj_pressure", "Pa", REQUIRED, "Chapman-Jouguet pressure; the constants must give it within 1 %", "P_CJ",
              POSITIVE),
    Parameter("sound_speed", "m/s", 2500.0, "bulk sound speed of the unreacted solid", "c0", POSITIVE),
    Parameter("compression_burn", "", 0.0, "burn fraction by compression over (1 - V)/(1 - V_CJ); 0: by time alone", "beta",
              NON_NEGATIVE),
    Parameter("specific_heat", "J/(kg*K)", 1000.0, "specific heat, for the temperature alone", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rest", "T0", POSITIVE),
)
#: light time of material that no detonation reaches, s
NEVER = 1e3
INTERNAL = (
    Field("burn_fraction", "", "body", "1", 1, "mass", True, "share of the explosive that has burnt", 0.0, 1.0),
    Field("light_time", "", "body", "s", 1, "mass", True, "time at which the detonation arrives", 0.0, initial=NEVER),
    Field("burn_time", "", "body", "s", 1, "mass", True, "time in which all of it burns", 0.0, initial=1.0),
)
#: internal variables of fully burnt material
SPENT = 1.0, NEVER, 1.0
#: indices of the internal variables
BURNT, LIGHT, BURN_TIME = range(3)

#: burn fraction from which on the unreacted solid bears no tension
BROKEN = 0.01
#: share of the burn time before the light time, at which the detonation reaches the middle of a cell: half of the explosive has
#: then burnt up to half a cell ahead of the detonation, and half of the pressure is reached as far behind it (0.7 of a cell
#: along a diagonal of the mesh); see explanation/explosives
LEAD = 0.64

#: slots of the row; the common ones are RHO0 and E0
FIRST, SECOND, R1, R2, OMEGA, C0_SQUARED, COMPRESSED, HEAT, T0 = range(2, 11)

#: largest relative difference between D and P_CJ from the constants and those stated
TOLERANCE = 0.01
#: volumes over the initial one between which the Chapman-Jouguet state is sought
_LEAST, _MOST = 0.4, 0.999


@point
def products(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, cold energy in J/m^3) of the products. explanation/explosives, (2)"""
    first, second = par[R1] * par[RHO0] / rho, par[R2] * par[RHO0] / rho
    a, b = par[FIRST] * exp(-first), par[SECOND] * exp(-second)
    gas = par[OMEGA] * e
    p = a * (1.0 - par[OMEGA] / first) + b * (1.0 - par[OMEGA] / second) + gas * rho
    dpdrho = (a * (first - par[OMEGA] - par[OMEGA] / first) + b * (second - par[OMEGA] - par[OMEGA] / second)) / rho + gas
    return p, dpdrho, par[OMEGA] * rho, a / par[R1] + b / par[R2]


@point
def evaluate(rho, e, internal, par):
    """(p, dp/drho, dp/de, T) at density ``rho`` > 0, energy ``e`` and constant burn fraction; SI.

    explanation/explosives, (1)
    """
    burnt = internal[BURNT]
    solid = 1.0 - burnt
    bearing = solid if rho > par[RHO0] else max(1.0 - burnt / BROKEN, 0.0)
    p, dpdrho, dpde, cold = products(rho, e, par)
    stiffness = par[C0_SQUARED]
    hot = e - cold / par[RHO0]
    T = solid * max(par[T0] + (e - par[E0]) * par[HEAT], 0.0) + burnt * max(hot * par[HEAT], 0.0)
    return (bearing * stiffness * (rho - par[RHO0]) + burnt * p, bearing * stiffness + burnt * dpdrho, burnt * dpde, T)


@point
def update(rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal):
    """Burns by the time before and after the detonation arrives and by compression; the burn fraction never falls.

    explanation/explosives, (3)
    """
    lit = LEAD + (time - internal[LIGHT]) / internal[BURN_TIME]
    compressed = par[COMPRESSED] * (1.0 - par[RHO0] / rho)
    internal[BURNT] = min(max(max(internal[BURNT], lit), compressed), 1.0)


def cj_state(par: np.ndarray) -> tuple[float, float, float]:
    """(D in m/s, P_CJ in Pa, V_CJ) of a row: where the Rayleigh line touches the Hugoniot of the products, to round-off.

    Raises ValueError if there is no such point. explanation/explosives, (4)
    """
    rest = float(par[RHO0])

    def state(volume: float) -> tuple[float, float]:
        """(pressure on the Hugoniot, slope of the isentrope through it over that of the Rayleigh line, less 1)."""
        rho = rest / volume
        cold, dpdrho, dpde, _ = products(rho, par[E0], par)
        heat = 0.5 * (1.0 - volume) / rest
        p = cold / (1.0 - dpde * heat)
        dpdrho += par[OMEGA] * p * heat
        return p, (dpdrho + p * dpde / rho**2) * rho * rho / rest * (1.0 - volume) / p - 1.0

    low, high = _LEAST, _MOST
    if not (state(low)[1] > 0.0 > state(high)[1]):
        raise ValueError(f"{NAME}: the constants have no Chapman-Jouguet state")
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if state(middle)[1] > 0.0 else (low, middle)
    p = state(low)[0]
    return sqrt(p / (rest * (1.0 - low))), p, low


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW].

    Raises ValueError for a missing, unknown or impossible value, and for constants that give another detonation velocity or
    Chapman-Jouguet pressure than those stated.
    """
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(ROW)
    par[RHO0], par[E0] = given["reference_density"], given["detonation_energy"] / given["reference_density"]
    par[FIRST], par[SECOND], par[R1], par[R2] = given["A"], given["B"], given["R1"], given["R2"]
    par[OMEGA], par[C0_SQUARED] = given["omega"], given["sound_speed"] ** 2
    par[HEAT], par[T0] = 1.0 / given["specific_heat"], given["reference_temperature"]
    speed, pressure, volume = cj_state(par)
    if abs(speed / given["detonation_velocity"] - 1.0) > TOLERANCE or abs(pressure / given["cj_pressure"] - 1.0) > TOLERANCE:
        raise ValueError(
            f"{NAME}: the constants contradict each other: detonation_velocity = {given['detonation_velocity']:g} m/s and "
            f"cj_pressure = {given['cj_pressure']:g} Pa are stated, {speed:.5g} m/s and {pressure:.5g} Pa follow from the rest"
        )
    par[COMPRESSED] = given["compression_burn"] / (1.0 - volume)
    return par
