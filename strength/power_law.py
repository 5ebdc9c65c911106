"""Power-law hardening in the total strain, as in cavity-expansion theory.

sigma = Y0 (E eps/Y0)^n with eps = ep + sigma/E. With x = sigma/Y0 and a = E ep/Y0 this is x = (a + x)^n. Its root lies
at x >= 1, where f = x - (a + x)^n is convex and increasing. The number of steps is fixed and nothing branches, so that rows of
cells are evaluated together.
"""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point, power
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


@point
def binomial(d, n):
    """(1 + d)^n by its series to d^10, for |d| below about a third."""
    a2, a3, a4 = (n - 1.0) * (1 / 2) * d, (n - 2.0) * (1 / 3) * d, (n - 3.0) * (1 / 4) * d
    a5, a6, a7 = (n - 4.0) * (1 / 5) * d, (n - 5.0) * (1 / 6) * d, (n - 6.0) * (1 / 7) * d
    a8, a9, a10 = (n - 7.0) * (1 / 8) * d, (n - 8.0) * (1 / 9) * d, (n - 9.0) * (1 / 10) * d
    low = 1.0 + a2 * (1.0 + a3 * (1.0 + a4))
    high = 1.0 + a6 * (1.0 + a7 * (1.0 + a8 * (1.0 + a9 * (1.0 + a10))))
    return 1.0 + n * d * (low + (a2 * a3) * (a4 * a5) * high)


@point
def halley_step(f, w, value, n):
    """Step of Halley's method for f = x - w^n, relative to w = a + x, with ``value`` = w^n."""
    slope = w - n * value  # of f, times w
    return -f * slope / (slope * slope - 0.5 * (1.0 - n) * n * value * f)


@point
def hardening(a, n):
    """The root x >= 1 of x = (a + x)^n, for 0 <= n < 1, to round-off; a below 0 counts as 0.

    With b = a/(1 - n) the tangent at a = 0 is (1 + b)^n, and x = r (1 + b)^n where r = (m + y (r - 1))^n, y = (1 + b)^(n - 1)
    and m = y + (1 - n) b/(1 + b), between 1 - n and 1: the first trial is a step of Newton's method from r = 1. Two steps of
    Halley's method follow, and in the second (a + x)^n is that of the first times a binomial series.
    """
    a = 0.0 if a < 0.0 else a
    b = a * (1.0 / (1.0 - n))
    tangent, inverse = power(1.0 + b, n), 1.0 / (1.0 + b)
    y = tangent * inverse
    m = y + (1.0 - n) * (b * inverse)
    started = binomial(m - 1.0, n)  # m^n
    x = tangent * started * (m - n * y) / (m - n * y * started)
    w = a + x
    value = power(w, n)
    f = x - value
    d = halley_step(f, w, value, n)
    series = binomial(d, n)
    return x + w * (d + (1.0 + d) * halley_step(f + w * d + value * (1.0 - series), w * (1.0 + d), value * series, n))


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
    """The initial yield stress: the material only hardens."""
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
