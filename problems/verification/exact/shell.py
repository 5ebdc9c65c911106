"""A shell that runs inward and stops when plastic work has used up its kinetic energy.

The material is rigid and perfectly plastic and keeps its volume: u = -u0 (R0/r)^(j - 1). The kinetic
energy at the start equals the plastic work up to the stop.

Source: Howell and Ball, J. Comput. Phys. 175 (2002) 128; Verney, in Behaviour of Dense Media under High Dynamic Pressures
(1968) 293. The stopping radius of the inner face follows from the integrals below.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq


@dataclass(frozen=True)
class Shell:
    """A shell of dimension j = 2 (cylindrical) or 3 (spherical) with radii inner < outer, m, density, and yield stress, Pa."""

    j: int
    inner: float
    outer: float
    rho: float
    yield_stress: float

    def work(self, stop: float) -> float:
        """Plastic work over Y R0^j and over 4 pi (sphere) or 2 pi (cylinder, per length), when the inner face is at `stop`.

        The equivalent strain is 2 ln(r0/r) in a sphere and 2/sqrt(3) ln(r0/r) in plane strain.
        """
        a = self.outer / self.inner - 1.0
        low = stop / self.inner
        if self.j == 3:
            each = quad(lambda x: x * x * math.log1p((3.0 * a + 3.0 * a * a + a**3) / x**3), low, 1.0, epsrel=1e-12)[0]
            return 2.0 / 3.0 * each
        each = quad(lambda x: x * math.log1p(a * (2.0 + a) / (x * x)), low, 1.0, epsrel=1e-12)[0]
        return each / math.sqrt(3.0)

    def kinetic(self) -> float:
        """Kinetic energy over u0^2 Y R0^j and over 4 pi or 2 pi, for a speed u0 of the inner face."""
        if self.j == 3:
            return 0.5 * self.rho / self.yield_stress * (1.0 - self.inner / self.outer)
        return 0.5 * self.rho / self.yield_stress * math.log(self.outer / self.inner)

    def path(self, speed: float, points: int = 2000) -> tuple[np.ndarray, np.ndarray]:
        """Times, s, and radii of the inner face, m, from the start to the stop, from the energy left at each radius."""
        stop = self.stop(speed)
        share = (np.arange(points) + 0.5) / points
        radius = stop + (self.inner - stop) * share**2  # the speed falls as the root of the distance left
        outer = (radius**self.j + self.outer**self.j - self.inner**self.j) ** (1.0 / self.j)
        mass = 1.0 - radius / outer if self.j == 3 else np.log(outer / radius)
        mass *= 0.5 * self.rho / self.yield_stress * (radius / self.inner) ** self.j
        whole = self.work(stop)
        left = np.array([whole - self.work(each) for each in radius])
        steps = 2.0 * (self.inner - stop) * share / points / np.sqrt(left / mass)
        time = steps[::-1].cumsum() - 0.5 * steps[::-1]
        return np.concatenate([[0.0], time, [steps.sum()]]), np.concatenate([[self.inner], radius[::-1], [stop]])

    def speed(self, stop: float) -> float:
        """The speed of the inner face at the start, m/s, with which it stops at a radius, m."""
        return math.sqrt(self.work(stop) / self.kinetic())

    def stop(self, speed: float) -> float:
        """The radius at which the inner face stops, m. Raises ValueError for a shell that closes."""
        if self.speed(1e-9 * self.inner) < speed:
            raise ValueError(f"a shell with {speed:g} m/s closes")
        return float(brentq(lambda radius: self.speed(radius) - speed, 1e-9 * self.inner, self.inner, xtol=1e-14))
