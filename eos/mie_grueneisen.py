"""Mie-Grueneisen equation of state about the Hugoniot Us = c0 + s up, with Gamma rho = Gamma0 rho0.

The reference curve is written in the compression eta = 1 - rho0/rho, in which an isentrope obeys

    de = p deta / rho0,    dT/T = Gamma0 deta,    hence    e_s' = p_ref/rho0 + Gamma0 e_s,    T_s = T0 exp(Gamma0 eta).

The cold temperature T_s - e_s/cv is tabulated once per material, uniformly in eta and with a node at eta = 0; what is
left to do per cell is one interpolation, T = T_cold(eta) + e/cv.
"""

from __future__ import annotations

import numpy as np

from eos.layout import E0, RHO0, ROW, TABLE, TABLE_SIZE
from eos.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point

NAME = "mie-grueneisen"
ID = 0
EQUATION = """\
eta = 1 - rho0/rho,  mu = rho/rho0 - 1
p = rho0 c0^2 eta (1 - Gamma0 eta/2) / (1 - s eta)^2 + Gamma0 rho0 e     compression
p = rho0 c0^2 mu + Gamma0 rho0 e                                         tension
T = T0 exp(Gamma0 eta) + (e - e_s(eta))/cv,  e_s the isentrope through (rho0, 0)"""
SOURCE = (
    "McQueen, Marsh, Taylor, Fritz & Carter, in Kinslow (ed.), High-Velocity Impact Phenomena (1970); "
    "the linear tension branch is our choice, continuous with its slope"
)
VALIDITY = (
    "solids up to s eta = 0.95, beyond which the reference curve goes on along its tangent; constant cv; neither "
    "melting nor vaporisation change p: material far below rho0 and hot has too high a pressure"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at zero pressure and energy", "rho0", POSITIVE),
    Parameter("sound_speed", "m/s", REQUIRED, "intercept of the Hugoniot Us(up)", "c0", POSITIVE),
    Parameter("hugoniot_slope", "", REQUIRED, "slope of the Hugoniot Us(up)", "s"),
    Parameter("grueneisen", "", REQUIRED, "Grueneisen coefficient at rho0", "Gamma0"),
    Parameter("specific_heat", "J/(kg*K)", REQUIRED, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rho0 and zero energy", "T0", POSITIVE),
)

#: slots of the row; the common ones are RHO0 and E0
INVERSE_RHO0, BULK, S, HALF_GAMMA, GAMMA_RHO, C0_SQUARED, GUARD, INVERSE_CV, INVERSE_STEP, ORIGIN = range(2, 12)

#: the guard on s eta, the least slope of the reference curve there in units of rho0 c0^2, and the ends of the table
SINGULARITY, LEAST_SLOPE, WIDEST, EXPANSION = 0.95, 0.1, 0.95, 0.6


@point
def reference_slope(eta, s, half_gamma):
    """d/deta of ``eta (1 - Gamma0 eta/2)/(1 - s eta)^2``: the reference pressure in units of rho0 c0^2."""
    d = 1.0 / (1.0 - s * eta)
    return d * d * ((1.0 + s * eta) * d * (1.0 - half_gamma * eta) - half_gamma * eta)


@point
def cold_temperature(eta, par):
    """T at the compression ``eta`` and e = 0 (it may be negative), held constant outside the table; K."""
    x = eta * par[INVERSE_STEP] + par[ORIGIN]
    if not x > 0.0:
        return par[TABLE]
    if x >= TABLE_SIZE - 1:
        return par[TABLE + TABLE_SIZE - 1]
    k = int(x)
    w = x - k
    return (1.0 - w) * par[TABLE + k] + w * par[TABLE + k + 1]


@point
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    explanation/equation-of-state, (1) to (4) and (6)
    """
    v = par[RHO0] / rho
    eta = 1.0 - v
    thermal = par[GAMMA_RHO] * e
    if eta >= 0.0:
        near = min(eta, par[GUARD])
        d = 1.0 / (1.0 - par[S] * near)
        slope = reference_slope(near, par[S], par[HALF_GAMMA])
        p = par[BULK] * (near * (1.0 - par[HALF_GAMMA] * near) * (d * d) + slope * (eta - near)) + thermal
        dpdrho = par[BULK] * slope * (v * v) * par[INVERSE_RHO0]
    else:
        p = par[C0_SQUARED] * (rho - par[RHO0]) + thermal
        dpdrho = par[C0_SQUARED]
    T = cold_temperature(eta, par) + e * par[INVERSE_CV]
    return p, dpdrho, par[GAMMA_RHO], max(T, 0.0)


def row(values) -> np.ndarray:
    """Packs the parameters, by name, and the table of cold temperatures; float64[ROW].

    Raises ValueError for a missing, unknown or impossible value.
    """
    given = collect(NAME, PARAMETERS, values)
    rho0, c0, s = given["reference_density"], given["sound_speed"], given["hugoniot_slope"]
    half_gamma = 0.5 * given["grueneisen"]
    guard = _guard(s, half_gamma)
    origin = round((TABLE_SIZE - 1) * EXPANSION / (EXPANSION + guard))
    step = EXPANSION / origin
    par = np.zeros(ROW)
    par[RHO0], par[E0], par[INVERSE_RHO0] = rho0, 0.0, 1.0 / rho0
    par[BULK], par[C0_SQUARED], par[S] = rho0 * c0 * c0, c0 * c0, s
    par[HALF_GAMMA], par[GAMMA_RHO], par[GUARD] = half_gamma, 2.0 * half_gamma * rho0, guard
    par[INVERSE_CV], par[INVERSE_STEP], par[ORIGIN] = 1.0 / given["specific_heat"], 1.0 / step, origin
    eta = (np.arange(TABLE_SIZE) - origin) * step
    energy = isentrope(eta, origin, c0, s, half_gamma, guard)
    isentropic = given["reference_temperature"] * np.exp(2.0 * half_gamma * eta)
    par[TABLE:] = isentropic - energy / given["specific_heat"]
    return par


def _guard(s: float, half_gamma: float) -> float:
    """The compression up to which the reference curve is used: s eta < 0.95, and a slope that is still positive."""
    eta = np.linspace(0.0, min(WIDEST, SINGULARITY / s) if s > 0.0 else WIDEST, 2001)
    falls = np.flatnonzero([reference_slope(x, s, half_gamma) < LEAST_SLOPE for x in eta])
    return float(eta[falls[0] - 1]) if falls.size else float(eta[-1])


def isentrope(eta: np.ndarray, origin: int, c0: float, s: float, half_gamma: float, guard: float) -> np.ndarray:
    """e_s at the uniform points ``eta``, with e_s = 0 at index ``origin``; J/kg.

    exp(-Gamma0 eta) e_s is the integral of exp(-Gamma0 eta) p_ref/rho0, taken by Gauss-Legendre with eight points per
    interval.
    """
    nodes, weights = np.polynomial.legendre.leggauss(8)
    step = eta[1] - eta[0]
    x = 0.5 * (eta[:-1] + eta[1:])[:, None] + 0.5 * step * nodes
    near = np.minimum(x, guard)
    tangent = reference_slope(guard, s, half_gamma)
    squeezed = near * (1.0 - half_gamma * near) / (1.0 - s * near) ** 2 + tangent * (x - near)
    reference = c0 * c0 * np.where(x < 0.0, x / (1.0 - x), squeezed)
    pieces = 0.5 * step * (reference * np.exp(-2.0 * half_gamma * x)) @ weights
    integral = np.concatenate([[0.0], np.cumsum(pieces)])
    return np.exp(2.0 * half_gamma * eta) * (integral - integral[origin])
