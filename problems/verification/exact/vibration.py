"""Free vibrations of an elastic sphere, radial and spheroidal of the second degree, and of a long elastic cylinder.

The sphere of radius a moves as u = A j1(x r/a) cos(omega t), omega = x c_l/a, where its surface is free if
x cot(x) = 1 - (x c_l/(2 c_s))^2; the cylinder as u = A J1(x r/a) cos(omega t), where x J0(x) = 2 (c_s/c_l)^2 J1(x).

The spheroidal vibration of degree 2, 0S2, changes the sphere into a spheroid and back, long and flat in turn. With
P = P2(cos theta), h = omega/c_l and k = omega/c_s it is u_r = U P, u_theta = V dP/dtheta,

    U = A h j2'(h r) + 6 B j2(k r)/r,    V = A j2(h r)/r + B (j2(k r)/r + k j2'(k r)),

where A/B and omega leave no stress at the surface: -(c_l^2/c_s^2 - 2) h^2 A j2(h r) + 2 U' = 0 and U/r + V' - V/r = 0.

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


class Spheroidal:
    """The lowest spheroidal vibration of degree 2 of a free sphere, 0S2.

    x : k a, of the shear wave number and the radius
    """

    def __init__(self, solid: Elastic):
        self.ratio = solid.longitudinal / solid.transverse
        self.x = float(brentq(lambda x: np.linalg.det(self._stress(x)), 2.0, 3.0, xtol=1e-14))
        (a, b), _ = self._stress(self.x)
        self.share = -b / a  # A/B

    def _stress(self, x: float) -> np.ndarray:
        """Radial and tangential stress at the surface of A alone and of B alone, over the shear modulus; the radius is 1."""
        h = x / self.ratio
        (a, a1, a2), (b, b1, b2) = _second(h), _second(x)
        radial = (-(self.ratio**2 - 2.0) * h**2 * a + 2.0 * h**2 * a2, 12.0 * (x * b1 - b))
        tangential = (2.0 * (h * a1 - a), 6.0 * b + (x * b1 - b + x**2 * b2) - (b + x * b1))
        return np.array([radial, tangential])

    def period(self, solid: Elastic, radius: float) -> float:
        """Period, s."""
        return 2.0 * math.pi * radius / (self.x * solid.transverse)

    def displacement(self, r, z, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacements along r and z, of arbitrary size, at points in or near a sphere of this radius about the origin, m."""
        far = np.maximum(np.hypot(r, z), 1e-9 * radius)
        sine, cosine, share = r / far, z / far, far / radius
        (a, a1, _), (b, b1, _) = _second(self.x / self.ratio * share), _second(self.x * share)
        radial = (self.share * self.x / self.ratio * a1 + 6.0 * b / share) * 0.5 * (3.0 * cosine**2 - 1.0)
        along = -(self.share * a / share + b / share + self.x * b1) * 3.0 * cosine * sine
        return radial * sine + along * cosine, radial * cosine - along * sine


def _second(x) -> tuple:
    """j2 and its first and second derivatives."""
    value, slope = spherical_jn(2, x), spherical_jn(2, x, derivative=True)
    return value, slope, -2.0 * slope / x - (1.0 - 6.0 / x**2) * value
