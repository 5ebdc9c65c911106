"""Steinberg-Guinan shear modulus and yield stress, and the melting line that ends both (strength/melting.py)."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point, power
from strength import melting
from strength.layout import ROW, SHEAR, YIELD

NAME = "steinberg-guinan"
ID = 3
CONSTANT_MODULUS = False
THERMAL = True
EQUATION = """\
G = G0 [1 + A p/eta^(1/3) - B (T - T0)],  not below 0,  eta = rho/rho0
Y = Y0 min((1 + beta (ep + ep0))^n, Ymax/Y0) G/G0
G = Y = 0 from Tm = Tm0 exp(2a(1 - 1/eta)) eta^(2(Gamma0 - a - 1/3)) on"""
SOURCE = "Steinberg, Cochran & Guinan, J. Appl. Phys. 51 (1980) 1498"
VALIDITY = "metals at strain rates above about 1e5/s, where the rate no longer matters; without Tm0 nothing melts"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus at rest", "G0", POSITIVE),
    Parameter("yield_stress", "Pa", REQUIRED, "initial yield stress at rest", "Y0", POSITIVE),
    Parameter("max_yield_stress", "Pa", math.inf, "upper bound of the work-hardened Y at rest", "Ymax", POSITIVE),
    Parameter("hardening_coefficient", "", 0.0, "factor of the plastic strain", "beta"),
    Parameter("hardening_exponent", "", 1.0, "exponent of work hardening", "n"),
    Parameter("initial_strain", "", 0.0, "plastic strain the material has already", "ep0"),
    Parameter("pressure_coefficient", "1/Pa", 0.0, "relative increase of G per pressure", "A"),
    Parameter("temperature_coefficient", "1/K", 0.0, "relative decrease of G per temperature", "B"),
    Parameter("modulus_temperature", "K", 300.0, "temperature at which G = G0 at rest", "T0", POSITIVE),
    Parameter("melt_temperature", "K", math.inf, "melting temperature at rho0", "Tm0", POSITIVE),
    Parameter("melt_exponent", "", 1.5, "volume correction of the melting law", "a"),
    Parameter("grueneisen", "", REQUIRED, "Grueneisen coefficient at rho0", "Gamma0", from_eos=True),
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at rest", "rho0", POSITIVE, from_eos=True),
)

#: slots of the row; the common ones are SHEAR and YIELD
BETA, EXPONENT, STRAIN0, CAP, PRESSURE, TEMPERATURE, T0, MELT, TWO_A, K, INVERSE_RHO0 = range(2, 13)


@point
def cube_root(x):
    """x^(1/3) of a positive number: near 1 two steps of Halley from the tangent there, which are exact to round-off."""
    if x < 0.7 or x > 1.5:
        return power(x, 1.0 / 3.0)
    y = (2.0 + x) / 3.0
    for _ in range(2):
        cube = y * y * y
        y = y * (cube + 2.0 * x) / (2.0 * cube + x)
    return y


@point
def relative_modulus(p, rho, T, par):
    """G/G0, zero from melt on: explanation/strength, (6)."""
    eta = rho * par[INVERSE_RHO0]
    if not melting.is_solid(T, eta, par[MELT], par[TWO_A], par[K]):
        return 0.0
    relative = 1.0 + par[PRESSURE] * p / cube_root(eta) - par[TEMPERATURE] * (T - par[T0])
    return 0.0 if relative < 0.0 else relative  # a NaN stays one


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus at pressure ``p``, density ``rho`` and temperature ``T``, Pa."""
    return par[SHEAR] * relative_modulus(p, rho, T, par)


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, temperature ``T``, pressure ``p`` and density ``rho``, Pa.

    explanation/strength, (7)
    """
    base, cap = 1.0 + par[BETA] * (ep + par[STRAIN0]), par[CAP]
    hardened = power(1.0 if base < 1.0 else base, par[EXPONENT])
    return par[YIELD] * (cap if hardened > cap else hardened) * relative_modulus(p, rho, T, par)


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if given["max_yield_stress"] < given["yield_stress"]:
        raise ValueError(f"{NAME}: max_yield_stress is below yield_stress")
    par = np.zeros(ROW)
    par[SHEAR], par[YIELD] = given["shear_modulus"], given["yield_stress"]
    par[BETA], par[EXPONENT] = given["hardening_coefficient"], given["hardening_exponent"]
    par[STRAIN0], par[CAP] = given["initial_strain"], given["max_yield_stress"] / given["yield_stress"]
    par[PRESSURE], par[TEMPERATURE] = given["pressure_coefficient"], given["temperature_coefficient"]
    par[T0], par[MELT] = given["modulus_temperature"], given["melt_temperature"]
    par[TWO_A] = 2.0 * given["melt_exponent"]
    par[K] = 2.0 * (given["grueneisen"] - given["melt_exponent"] - 1.0 / 3.0)
    par[INVERSE_RHO0] = 1.0 / given["reference_density"]
    return par
