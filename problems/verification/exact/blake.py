"""Blake's problem: a constant pressure begins to act in a spherical cavity in an elastic medium.

Source: Blake, J. Acoust. Soc. Am. 24 (1952) 211, in the form of Hutchens, LA-UR-05-8159, which ExactPack has as `Blake`; the
cylindrical cavity by the Laplace transform of the same equations. The medium is linear; SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import kv


@dataclass(frozen=True)
class Cavity:
    """A cavity of this radius, m, in a medium with Lame's constants, Pa, in which the pressure acts from time 0."""

    radius: float = 0.1
    pressure: float = 1e6
    rho: float = 3000.0
    lame: float = 25e9
    shear: float = 25e9

    @property
    def longitudinal(self) -> float:
        """Speed of longitudinal waves, m/s."""
        return float(np.sqrt((self.lame + 2.0 * self.shear) / self.rho))

    def displacement(self, r, t: float) -> np.ndarray:
        """Radial displacement at radii r in the undeformed medium, m; zero ahead of the wave.

        It follows from the potential phi(s)/r of the reduced time s = t - (r - a)/c, u = d/dr(phi/r), which oscillates as

            phi = -a^3 p/(4 G) (1 - exp(-n s)(cos(b s) + (n/b) sin(b s))).
        """
        r = np.asarray(r, dtype=float)
        phi, rate, _ = self._potential(r, t)
        return -phi / r**2 - rate / (self.longitudinal * r)

    def velocity(self, r, t: float) -> np.ndarray:
        """Radial velocity, m/s."""
        r = np.asarray(r, dtype=float)
        _, rate, second = self._potential(r, t)
        return -rate / r**2 - second / (self.longitudinal * r)

    def mean_pressure(self, r, t: float) -> np.ndarray:
        """-(trace of the stress)/3, Pa: -K times the divergence of the displacement, which is phi''/(c^2 r)."""
        r = np.asarray(r, dtype=float)
        _, _, second = self._potential(r, t)
        return -(self.lame + 2.0 / 3.0 * self.shear) * second / (self.longitudinal**2 * r)

    def _potential(self, r: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """phi and its first and second derivatives by the reduced time, zero ahead of the wave."""
        c, a = self.longitudinal, self.radius
        ratio = self.shear / (self.lame + 2.0 * self.shear)
        n = 2.0 * ratio * c / a
        b = 2.0 * c / a * np.sqrt(ratio * (1.0 - ratio))
        s = np.maximum(t - (r - a) / c, 0.0)
        there = t > (r - a) / c
        size, decay = -self.pressure * a**3 / (4.0 * self.shear), np.exp(-n * s)
        whole = n * n + b * b
        phi = size * (1.0 - decay * (np.cos(b * s) + n / b * np.sin(b * s)))
        rate = size * decay * whole / b * np.sin(b * s)
        second = size * decay * whole * (np.cos(b * s) - n / b * np.sin(b * s))
        return tuple(np.where(there & (r >= a), each, 0.0) for each in (phi, rate, second))


def cylindrical(cavity: Cavity, r, t: float, terms: int = 48) -> np.ndarray:
    """Radial displacement around a cylindrical cavity at radii r behind the wave, m, in plane strain.

    Its Laplace transform is u(s) = A K1(k r) with k = s/c and (lame + 2 G) du/dr + lame u/r = -p/s at the wall. It is inverted
    with the cotangent contour of Trefethen, Weideman and Schmelzer, BIT Numer. Math. 46 (2006) 653, after the delay of the
    wave, exp(-s (r - a)/c), was taken out.
    """
    a, c, lame, shear = cavity.radius, cavity.longitudinal, cavity.lame, cavity.shear
    displacements = []
    for each in np.atleast_1d(np.asarray(r, dtype=float)):
        left = t - (each - a) / c
        if left <= 0.0:
            displacements.append(0.0)
            continue
        angle = (2.0 * np.arange(terms) + 1.0) * np.pi / terms - np.pi
        s = terms / left * (0.5017 * angle / np.tan(0.6407 * angle) - 0.6122 + 0.2645j * angle)
        ds = terms / left * (0.5017 / np.tan(0.6407 * angle) - 0.5017 * 0.6407 * angle / np.sin(0.6407 * angle) ** 2 + 0.2645j)
        k = s / c
        scaled = np.exp(k * a) * kv(1, k * a), np.exp(k * each) * kv(1, k * each), np.exp(k * a) * kv(0, k * a)
        slope = -k * scaled[2] - scaled[0] / a  # of K1(k r) at the wall
        amplitude = -cavity.pressure / s / ((lame + 2.0 * shear) * slope + lame * scaled[0] / a)
        displacements.append(float(np.real(-1j / terms * np.sum(np.exp(s * left) * amplitude * scaled[1] * ds))))
    return np.array(displacements)
