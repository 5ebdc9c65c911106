"""Mie-Grueneisen equation of state about the Hugoniot Us = c0 + s up, or one that curves.

The curved one is Steinberg's: Us = c0 + s up + s2 (up/Us) up + s3 (up/Us)^2 up. Since up/Us = eta behind a shock, it is
Us = c0/D with D = 1 - s eta - s2 eta^2 - s3 eta^3, and the pressure on it rho0 c0^2 eta/D^2.

Gamma rho = Gamma0 rho0 in compression and Gamma = Gamma0 in expansion, so that the thermal pressure of expanded
material falls with its density. The reference curve is written in the compression eta = 1 - rho0/rho, in which an
isentrope obeys de = p deta/rho0 and dT/T = Gamma rho deta/rho0, hence

    e_s' = p_ref/rho0 + Gamma0 e_s,            T_s = T0 exp(Gamma0 eta)             compression
    e_s' = p_ref/rho0 + Gamma0 e_s/(1 - eta),  T_s = T0 (1 - eta)^-Gamma0           expansion

The cold temperature T_s - e_s/cv is tabulated once per material, uniformly in eta and with a node at eta = 0. A cell then
needs one interpolation, T = T_cold(eta) + e/cv.
"""

from __future__ import annotations

import numpy as np

from eos.layout import E0, RHO0, ROW, TABLE, TABLE_SIZE
from hydro2d.base.parameters import ANY, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point

NAME = "mie-grueneisen"
ID = 0
EQUATION = """\
eta = 1 - rho0/rho,  mu = rho/rho0 - 1
D = 1 - s eta - s2 eta^2 - s3 eta^3
p = rho0 c0^2 eta (1 - Gamma0 eta/2) / D^2 + Gamma0 rho0 e               compression
p = rho0 c0^2 mu + Gamma0 rho e                                          expansion
T = T_s(eta) + (e - e_s(eta))/cv,  T_s and e_s on the isentrope through (rho0, T0, 0)"""
SOURCE = (
    "McQueen, Marsh, Taylor, Fritz & Carter, in Kinslow (ed.), High-Velocity Impact Phenomena (1970); "
    "s2 and s3 as in Steinberg, Equation of State and Strength Properties of Selected Materials, UCRL-MA-106439 (1996); "
    "the expansion branch is our choice: linear, continuous in p, and Gamma constant so that hot material can expand"
)
VALIDITY = (
    "solids, and liquids under pressure, up to D = 0.05, beyond which the reference curve continues along its tangent; "
    "constant cv; neither melting nor vaporisation changes p: far below rho0 the material is still as stiff as a solid with "
    "Gamma0 e in c^2"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at zero pressure and energy", "rho0", POSITIVE),
    Parameter("sound_speed", "m/s", REQUIRED, "intercept of the Hugoniot Us(up)", "c0", POSITIVE),
    Parameter("hugoniot_slope", "", REQUIRED, "slope of the Hugoniot Us(up)", "s"),
    Parameter("hugoniot_slope_2", "", 0.0, "second coefficient S2 of a curved Hugoniot", "s2", ANY),
    Parameter("hugoniot_slope_3", "", 0.0, "third coefficient S3 of a curved Hugoniot, with S2 alone", "s3", ANY),
    Parameter("grueneisen", "", REQUIRED, "Grueneisen coefficient at rho0", "Gamma0"),
    Parameter("specific_heat", "J/(kg*K)", REQUIRED, "specific heat at constant volume", "cv", POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rho0 and zero energy", "T0", POSITIVE),
)

#: slots of the row; the common ones are RHO0 and E0
INVERSE_RHO0, BULK, S, HALF_GAMMA, GAMMA_RHO, C0_SQUARED, GUARD, INVERSE_CV, INVERSE_STEP, ORIGIN, S2, S3 = range(2, 14)

#: the guard on 1 - D, the least slope of the reference curve there in units of rho0 c0^2, and the ends of the table
SINGULARITY, LEAST_SLOPE, WIDEST, EXPANSION = 0.95, 0.1, 0.95, 0.6


@point
def slowness(eta, s, s2, s3):
    """D = c0/Us at the compression ``eta`` behind a shock: 1 - s eta - s2 eta^2 - s3 eta^3."""
    return 1.0 - s * eta - eta * eta * (s2 + s3 * eta)


@point
def reference_slope(eta, s, s2, s3, half_gamma):
    """d/deta of ``eta (1 - Gamma0 eta/2)/D^2``: the reference pressure in units of rho0 c0^2."""
    d = 1.0 / slowness(eta, s, s2, s3)
    steeper = 1.0 + s * eta + eta * eta * (3.0 * s2 + 5.0 * s3 * eta)  # D - 2 eta dD/deta
    return d * d * (steeper * d * (1.0 - half_gamma * eta) - half_gamma * eta)


@point
def cold_temperature(eta, par):
    """T at the compression ``eta`` and e = 0 (it may be negative), held constant outside the table; K."""
    x = eta * par[INVERSE_STEP] + par[ORIGIN]
    x = x if x > 0.0 else 0.0  # a NaN too
    x = min(x, TABLE_SIZE - 1.0)
    k = min(int(x), TABLE_SIZE - 2)
    w = x - k
    return (1.0 - w) * par[TABLE + k] + w * par[TABLE + k + 1]


@point
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    explanation/equation-of-state, (1) to (4) and (6)
    """
    v = par[RHO0] / rho
    eta = 1.0 - v
    gamma = 2.0 * par[HALF_GAMMA]
    near = min(max(eta, 0.0), par[GUARD])
    d = 1.0 / slowness(near, par[S], par[S2], par[S3])
    slope = reference_slope(near, par[S], par[S2], par[S3], par[HALF_GAMMA])
    # both branches first: choosing between two values in memory is a slow gather, between two computed numbers it is not
    squeezed = par[BULK] * (near * (1.0 - par[HALF_GAMMA] * near) * (d * d) + slope * (eta - near))
    stretched = par[C0_SQUARED] * (rho - par[RHO0])
    squeezed_slope, stretched_slope = par[BULK] * slope * (v * v) * par[INVERSE_RHO0], par[C0_SQUARED] + gamma * e
    squeezed_heat, stretched_heat = par[GAMMA_RHO], gamma * rho
    compressed = eta >= 0.0
    p = squeezed if compressed else stretched
    dpdrho = squeezed_slope if compressed else stretched_slope
    dpde = squeezed_heat if compressed else stretched_heat
    T = cold_temperature(eta, par) + e * par[INVERSE_CV]
    return p + dpde * e, dpdrho, dpde, max(T, 0.0)


def row(values) -> np.ndarray:
    """Packs the parameters, by name, and the table of cold temperatures; float64[ROW].

    Raises ValueError for a missing, unknown or impossible value.
    """
    given = collect(NAME, PARAMETERS, values)
    rho0, c0 = given["reference_density"], given["sound_speed"]
    slopes = given["hugoniot_slope"], given["hugoniot_slope_2"], given["hugoniot_slope_3"]
    if slopes[2] != 0.0 == slopes[1]:
        raise ValueError(f"{NAME}: hugoniot_slope_3 = {slopes[2]:g} without hugoniot_slope_2: a cubic Hugoniot needs both")
    half_gamma = 0.5 * given["grueneisen"]
    guard = _guard(slopes, half_gamma)
    origin = round((TABLE_SIZE - 1) * EXPANSION / (EXPANSION + guard))
    step = EXPANSION / origin
    par = np.zeros(ROW)
    par[RHO0], par[E0], par[INVERSE_RHO0] = rho0, 0.0, 1.0 / rho0
    par[BULK], par[C0_SQUARED] = rho0 * c0 * c0, c0 * c0
    par[S], par[S2], par[S3] = slopes
    par[HALF_GAMMA], par[GAMMA_RHO], par[GUARD] = half_gamma, 2.0 * half_gamma * rho0, guard
    par[INVERSE_CV], par[INVERSE_STEP], par[ORIGIN] = 1.0 / given["specific_heat"], 1.0 / step, origin
    eta = (np.arange(TABLE_SIZE) - origin) * step
    energy = isentrope(eta, origin, c0, slopes, half_gamma, guard)
    par[TABLE:] = given["reference_temperature"] * heating(eta, 2.0 * half_gamma) - energy / given["specific_heat"]
    return par


def _guard(slopes: tuple[float, float, float], half_gamma: float) -> float:
    """The compression up to which the reference curve is used: D > 0.05, and a slope that is still positive."""
    s, s2, s3 = slopes
    end = min(WIDEST, SINGULARITY / s) if s > 0.0 else WIDEST
    if s2 != 0.0:
        roots = np.roots([s3, s2, s, -SINGULARITY])
        end = min([WIDEST, *(root.real for root in roots if root.imag == 0.0 and root.real > 0.0)])
    eta = np.linspace(0.0, end, 2001)
    falls = np.flatnonzero([reference_slope(x, *slopes, half_gamma) < LEAST_SLOPE for x in eta])
    return float(eta[falls[0] - 1]) if falls.size else float(eta[-1])


def heating(eta, gamma: float):
    """T_s/T0 on an isentrope; e_s scales with it too where the reference pressure is zero."""
    return np.where(eta < 0.0, (1.0 - np.minimum(eta, 0.0)) ** -gamma, np.exp(gamma * eta))


def isentrope(eta: np.ndarray, origin: int, c0: float, slopes: tuple[float, float, float], half_gamma: float, guard: float
              ) -> np.ndarray:
    """e_s at the uniform points ``eta``, with e_s = 0 at index ``origin``; J/kg.

    e_s T0/T_s is the integral of (T0/T_s) p_ref/rho0, taken by Gauss-Legendre with eight points per interval.
    """
    nodes, weights = np.polynomial.legendre.leggauss(8)
    step = eta[1] - eta[0]
    x = 0.5 * (eta[:-1] + eta[1:])[:, None] + 0.5 * step * nodes
    near = np.minimum(x, guard)
    (s, s2, s3), tangent = slopes, reference_slope(guard, *slopes, half_gamma)
    behind = 1.0 - s * near - near * near * (s2 + s3 * near)
    squeezed = near * (1.0 - half_gamma * near) / behind**2 + tangent * (x - near)
    reference = c0 * c0 * np.where(x < 0.0, x / (1.0 - x), squeezed)
    pieces = 0.5 * step * (reference / heating(x, 2.0 * half_gamma)) @ weights
    integral = np.concatenate([[0.0], np.cumsum(pieces)])
    return heating(eta, 2.0 * half_gamma) * (integral - integral[origin])
