"""The melting line of a material: its melting temperature against its density. From that temperature on it has no strength.

Lindemann's criterion says that a crystal melts when its atoms vibrate by a certain share of their distance. With
d ln(theta)/d ln(rho) = Gamma for the Debye temperature theta it gives d ln(Tm)/d ln(rho) = 2 (Gamma - 1/3). Steinberg, Cochran
and Guinan let Gamma = Gamma0 - a (1 - 1/eta), eta = rho/rho0, and the integral from eta = 1 is their melting line.

A line is a row of `ROW` numbers, `NONE` for a material without one. Strength models with a melting line of their own use the
same functions. The line needs an exponential and a power. Since ln(eta) >= 1 - 1/eta, ln(eta) <= eta - 1 and
exp(y) >= 1 + y, it is never below Tm0 (1 + y) with y = 2a(1 - 1/eta) + k (1 - 1/eta) for k >= 0 or + k (eta - 1) for
k < 0, k = 2(Gamma0 - a - 1/3). The exact melting point is needed only for material hotter than that. In a row of cells the
compiler evaluates both sides of every choice, for several cells at once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import exp, log, point

NAME = "melting"
EQUATION = """\
G = Y = 0 from Tm = Tm0 exp(2a(1 - 1/eta)) eta^(2(Gamma0 - a - 1/3)) on,  eta = rho/rho0"""
SOURCE = "Steinberg, Cochran & Guinan, J. Appl. Phys. 51 (1980) 1498, after Lindemann, Phys. Z. 11 (1910) 609"
VALIDITY = "metals whose solid has one phase; no heat of fusion: melting changes neither the temperature nor the pressure"

PARAMETERS = (
    Parameter("melt_temperature", "K", REQUIRED, "melting temperature at rho0", "Tm0", POSITIVE),
    Parameter("melt_exponent", "", 1.5, "volume correction of the melting law", "a"),
    Parameter("grueneisen", "", REQUIRED, "Grueneisen coefficient at rho0", "Gamma0", from_eos=True),
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at rest", "rho0", POSITIVE, from_eos=True),
)

#: indices in a line: Tm0, 2a, k and 1/rho0; and their number
MELT, TWO_A, K, INVERSE_RHO0 = range(4)
ROW = 4
#: the line of a material that never melts
NONE = (math.inf, 0.0, 0.0, 0.0)


@point
def melting_temperature(eta, melt, two_a, k):
    """Tm at the compression ``eta`` = rho/rho0, K, with Tm0 = ``melt``: explanation/strength, (8)."""
    return melt * exp(two_a * (1.0 - 1.0 / eta) + k * log(eta))


@point
def is_solid(T, eta, melt, two_a, k):
    """Whether the temperature ``T``, K, is below the melting temperature at ``eta``; true for a NaN, so that it stays one."""
    w = 1.0 - 1.0 / eta
    bend = k * (w if k >= 0.0 else eta - 1.0)
    if melt * (1.0 + two_a * w + bend) > T:
        return True
    return not T >= melting_temperature(eta, melt, two_a, k)


@point
def melts(line):
    """Whether there is a melting line."""
    return line[MELT] < math.inf


@point
def solid_modulus(modulus, rho, T, line):
    """The shear ``modulus``, Pa, of a material with a melting ``line``: zero at the line and above."""
    return modulus if is_solid(T, rho * line[INVERSE_RHO0], line[MELT], line[TWO_A], line[K]) else 0.0


def row(values: Mapping[str, float]) -> np.ndarray:
    """The line from its parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    line = np.zeros(ROW)
    line[MELT], line[TWO_A] = given["melt_temperature"], 2.0 * given["melt_exponent"]
    line[K] = 2.0 * (given["grueneisen"] - given["melt_exponent"] - 1.0 / 3.0)
    line[INVERSE_RHO0] = 1.0 / given["reference_density"]
    return line


def temperature(eta: float, line: np.ndarray) -> float:
    """Tm of a ``line`` at the compression ``eta`` = rho/rho0, K."""
    return float(melting_temperature(eta, line[MELT], line[TWO_A], line[K]))
