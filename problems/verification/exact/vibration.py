"""The free radial vibration of an elastic sphere and of a long elastic cylinder.

The sphere of radius a moves as u = A j1(x r/a) cos(omega t), omega = x c_l/a, where its surface is free if
x cot(x) = 1 - (x c_l/(2 c_s))^2; the cylinder as u = A J1(x r/a) cos(omega t), where x J0(x) = 2 (c_s/c_l)^2 J1(x).

Source: Lamb, Proc. London Math. Soc. 13 (1882) 189; Love, A Treatise on the Mathematical Theory of Elasticity, section 196.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import j0, j1, spherical_jn


@dataclass(frozen=True)
class Elastic:
    """A solid of density rho, kg/m^3, with a bulk sound speed, m/s, and a shear modulus, Pa."""

    rho: float
    bulk_speed: float
    shear: float

    @property
    def longitudinal(self) -> float:
        """c_l, m/s."""
        return math.sqrt(self.bulk_speed**2 + 4.0 * self.shear / (3.0 * self.rho))

    @property
    def transverse(self) -> float:
        """c_s, m/s."""
        return math.sqrt(self.shear / self.rho)


def sphere(solid: Elastic) -> float:
    """x of the lowest radial vibration of a sphere."""
    ratio = solid.longitudinal / (2.0 * solid.transverse)
    return float(brentq(lambda x: x / math.tan(x) - 1.0 + (x * ratio) ** 2, 1e-3, math.pi - 1e-9, xtol=1e-14))


def cylinder(solid: Elastic) -> float:
    """x of the lowest radial vibration of a long cylinder, in plane strain."""
    ratio = solid.transverse / solid.longitudinal
    return float(brentq(lambda x: x * j0(x) - 2.0 * ratio**2 * j1(x), 1e-3, 3.8, xtol=1e-14))


def period(solid: Elastic, radius: float, x: float) -> float:
    """Period of a vibration, s."""
    return 2.0 * math.pi * radius / (x * solid.longitudinal)


def shape(x: float, share) -> np.ndarray:
    """Displacement over that of the surface at these shares of the radius of a sphere."""
    return spherical_jn(1, x * np.asarray(share, dtype=float)) / spherical_jn(1, x)
