"""Preston-Tonks-Wallace: thermally activated flow up to some 1e7/s, dragged dislocations from 1e9/s on, and saturation.

Stresses are multiples of twice the shear modulus, temperatures of the melting temperature, and rates of gamma xi, where xi is
the rate at which a transverse wave crosses an atom.
"""

from __future__ import annotations

import math

import numpy as np

from hydro2d.base.parameters import FRACTION, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import erf, exp, log, point
from strength import melting
from strength.layout import ROW, SHEAR, YIELD
from strength.steinberg_guinan import cube_root

NAME = "preston-tonks-wallace"
ID = 10
CONSTANT_MODULUS = False
THERMAL = True
EQUATION = """\
Y = 2 G t(ep),  t = ts + ((s0 - ty)/p) ln{1 - [1 - exp(-q)] exp[-p theta ep/((s0 - ty) (exp(q) - 1))]}
q = p (ts - ty)/(s0 - ty)
ts = max(s0 - (s0 - sinf) erf(a), s0 x^beta),  ty = max(y0 - (y0 - yinf) erf(a), min(y1 x^y2, s0 x^beta))
x = max(rate, rate_min)/(gamma xi),  a = max(0, -kappa (T/Tm) ln x),  xi = (1/2) (4 pi rho/(3 m))^(1/3) (G/rho)^(1/2)
G = G0 (1 + A p/eta^(1/3)) (1 - alpha T/Tm),  G = Y = 0 from Tm on, the melting line of steinberg-guinan"""
SOURCE = "Preston, Tonks & Wallace, J. Appl. Phys. 93 (2003) 211; that a is not below 0 is ours"
VALIDITY = "metals from 1e-3 to 1e12/s; plastic strain only hardens; the rate matters from rate_min on"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus at rest and absolute zero", "G0", POSITIVE),
    Parameter("modulus_softening", "", 0.0, "relative decrease of G up to the melting temperature", "alpha", FRACTION),
    Parameter("pressure_coefficient", "1/Pa", 0.0, "relative increase of G per pressure", "A"),
    Parameter("theta", "", REQUIRED, "initial rate of hardening", "theta"),
    Parameter("p", "", 0.0, "how hardening depends on the stress; 0: Voce's law", "p"),
    Parameter("s0", "", REQUIRED, "saturation stress at absolute zero", "s0", POSITIVE),
    Parameter("s_inf", "", REQUIRED, "saturation stress near melting, at a low rate", "sinf", POSITIVE),
    Parameter("y0", "", REQUIRED, "yield stress at absolute zero", "y0", POSITIVE),
    Parameter("y_inf", "", REQUIRED, "yield stress near melting, at a low rate", "yinf", POSITIVE),
    Parameter("y1", "", REQUIRED, "yield stress at the rate gamma xi by the law of medium rates", "y1", POSITIVE),
    Parameter("y2", "", REQUIRED, "exponent of the rate in the law of medium rates", "y2"),
    Parameter("beta", "", REQUIRED, "exponent of the rate where dislocations are dragged", "beta"),
    Parameter("kappa", "", REQUIRED, "dependence on temperature", "kappa"),
    Parameter("gamma", "", REQUIRED, "rate of the change from activation to drag over xi", "gamma", POSITIVE),
    Parameter("molar_mass", "kg/mol", REQUIRED, "mass of a mole of atoms", "M", POSITIVE, example="180.948 g/mol"),
    Parameter("lowest_rate", "1/s", 1e-3, "strain rate below which the rate does not matter", "rate_min", POSITIVE),
    *melting.PARAMETERS,
)

#: slots of the row; the common ones are SHEAR and YIELD, and LOG_RATE is ln x at a rate, density and modulus of 1 in SI
G0, SOFTENING, PRESSURE, THETA, P, S0, S_INF, Y0, Y_INF, LOG_Y1, Y2, BETA, KAPPA, LOG_RATE, LOWEST, MELT = range(2, 18)
TWO_A, K, INVERSE_RHO0 = range(18, 21)
#: temperature of the modulus and yield stress in the common slots, K; atoms in a mole
ROOM, AVOGADRO = 298.0, 6.02214076e23
#: q below which hardening is Voce's, and 1 - ts/ty below which nothing hardens
SMALL, SATURATED = 1e-6, 1e-12


@point
def homologous(T, eta, par):
    """Temperature over the melting temperature at the compression ``eta``."""
    return T / melting.melting_temperature(eta, par[MELT], par[TWO_A], par[K])


@point
def modulus(p, eta, hot, par):
    """Shear modulus, Pa, at the homologous temperature ``hot``: explanation/strength, (21)."""
    G = par[G0] * (1.0 + par[PRESSURE] * p / cube_root(eta)) * (1.0 - par[SOFTENING] * hot)
    return 0.0 if hot >= 1.0 or G < 0.0 else G  # a NaN stays one


@point
def larger(a, b):
    """The larger of the two, NaN if ``b`` is one."""
    return a if a > b else b


@point
def hardened(ep, saturated, virgin, par):
    """Stress at plastic strain ``ep`` between those of ``virgin`` and ``saturated`` material: explanation/strength, (24)."""
    rise, span = saturated - virgin, par[S0] - virgin
    hardens = rise > SATURATED * saturated
    rise = rise if hardens else 1.0
    span = span if hardens else 1.0
    q = par[P] * rise / span
    voce = q < SMALL
    steps = exp(SMALL if voce else q)
    left = (1.0 - 1.0 / steps) * exp(-par[P] * par[THETA] * ep / (span * (steps - 1.0)))
    curved = span * log(1.0 - left) / (1.0 if voce else par[P])
    return saturated + ((-rise * exp(-par[THETA] * ep / rise) if voce else curved) if hardens else 0.0)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus at pressure ``p``, density ``rho`` and temperature ``T``, Pa."""
    eta = rho * par[INVERSE_RHO0]
    return modulus(p, eta, homologous(T, eta, par), par)


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, its ``rate`` (1/s), temperature ``T``, pressure ``p`` and density ``rho``, Pa.

    explanation/strength, (22) to (24)
    """
    eta, lowest = rho * par[INVERSE_RHO0], par[LOWEST]
    hot = homologous(T, eta, par)
    G = modulus(p, eta, hot, par)
    x = par[LOG_RATE] + log(lowest if rate < lowest else rate) + log(rho) / 6.0 - 0.5 * log(1.0 if G == 0.0 else G)
    a = -par[KAPPA] * hot * x
    activation = erf(0.0 if a < 0.0 else a)
    dragged = par[S0] * exp(par[BETA] * x)
    medium = exp(par[LOG_Y1] + par[Y2] * x)
    saturated = larger(dragged, par[S0] - (par[S0] - par[S_INF]) * activation)
    virgin = larger(medium if medium < dragged else dragged, par[Y0] - (par[Y0] - par[Y_INF]) * activation)
    return 2.0 * G * hardened(0.0 if ep < 0.0 else ep, saturated, virgin, par)


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    for low, high in (("s_inf", "s0"), ("y_inf", "y0"), ("y0", "s0"), ("y_inf", "s_inf"), ("s0", "y1"), ("beta", "y2")):
        if given[low] > given[high]:
            raise ValueError(f"{NAME}: {low} = {given[low]:g} is above {high} = {given[high]:g}: must not be")
    par, line = np.zeros(ROW), melting.row({parameter.name: given[parameter.name] for parameter in melting.PARAMETERS})
    par[G0], par[SOFTENING], par[PRESSURE] = given["shear_modulus"], given["modulus_softening"], given["pressure_coefficient"]
    par[THETA], par[P], par[S0], par[S_INF] = given["theta"], given["p"], given["s0"], given["s_inf"]
    par[Y0], par[Y_INF], par[LOG_Y1], par[Y2] = given["y0"], given["y_inf"], math.log(given["y1"]), given["y2"]
    par[BETA], par[KAPPA], par[LOWEST] = given["beta"], given["kappa"], given["lowest_rate"]
    atoms = 4.0 * math.pi / 3.0 * AVOGADRO / given["molar_mass"]  # per mass, times 4 pi/3
    par[LOG_RATE] = -math.log(given["gamma"] * 0.5 * atoms ** (1.0 / 3.0))
    par[MELT], par[TWO_A], par[K], par[INVERSE_RHO0] = line
    rho0 = given["reference_density"]
    par[SHEAR] = shear_modulus(0.0, rho0, ROOM, par)
    par[YIELD] = flow_stress(0.0, 0.0, ROOM, 0.0, rho0, par)
    return par
