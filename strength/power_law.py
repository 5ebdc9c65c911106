"""Power-law hardening in the total strain, as in cavity-expansion theory.

sigma = Y0 (E eps/Y0)^n with eps = ep + sigma/E. With x = sigma/Y0 and a = E ep/Y0 this is x = (a + x)^n. Its root lies
at x >= 1, where f = x - (a + x)^n is convex and increasing; Halley's method from x = 1 converges cubically.
"""

from __future__ import annotations

import numpy as np

from hydro2d.jit import point
from hydro2d.parameters import POSITIVE, REQUIRED, Parameter, collect
from strength.layout import ROW, SHEAR, YIELD

NAME = "power-law"
ID = 4
CONSTANT_MODULUS = True
THERMAL = False
EQUATION = "Y = Y0 (E eps/Y0)^n,  eps = ep + Y/E the total strain,  G = E/(2 (1 + nu)) constant"
SOURCE = "Forrestal, Luk & Brar, Mech. Mater. 10 (1990) 97; Luk & Piekutowski, Int. J. Impact Engng 11 (1991) 323"
VALIDITY = "aluminium alloys at moderate strain rates; independent of rate, temperature and pressure; n < 1"
PARAMETERS = (
    Parameter("youngs_modulus", "Pa", REQUIRED, "Young's modulus", "E", POSITIVE),
    Parameter("poisson_ratio", "", REQUIRED, "Poisson's ratio", "nu"),
    Parameter("yield_stress", "Pa", REQUIRED, "initial yield stress", "Y0", POSITIVE),
    Parameter("hardening_exponent", "", REQUIRED, "exponent of the total strain", "n"),
)

#: slots of the row; the common ones are SHEAR and YIELD
EXPONENT, STIFFNESS = 2, 3

_ITERATIONS = 8
_SMALL = 1e-5


@point
def hardening(a, n):
    """The root x >= 1 of x = (a + x)^n, for a >= 0 and 0 <= n < 1, to round-off."""
    x = 1.0
    if not a > 0.0 or n == 0.0:
        return x
    for _ in range(_ITERATIONS):
        w = a + x
        power = w**n
        f = x - power
        slope = 1.0 - n * power / w
        curvature = n * (1.0 - n) * power / (w * w)
        step = f * slope / (slope * slope - 0.5 * f * curvature)
        x -= step
        if abs(step) < _SMALL:
            return x
    return x


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, Pa: explanation/strength, (9)."""
    return par[YIELD] * hardening(par[STIFFNESS] * ep, par[EXPONENT])


@point
def yield_floor(par):
    """The flow stress only hardens."""
    return par[YIELD]


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if given["poisson_ratio"] > 0.5:
        raise ValueError(f"{NAME}: poisson_ratio = {given['poisson_ratio']}: must not exceed 1/2")
    if given["hardening_exponent"] >= 1.0:
        raise ValueError(f"{NAME}: hardening_exponent = {given['hardening_exponent']}: must be below 1")
    par = np.zeros(ROW)
    par[SHEAR] = given["youngs_modulus"] / (2.0 * (1.0 + given["poisson_ratio"]))
    par[YIELD], par[EXPONENT] = given["yield_stress"], given["hardening_exponent"]
    par[STIFFNESS] = given["youngs_modulus"] / given["yield_stress"]
    return par
