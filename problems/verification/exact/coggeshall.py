"""Two of Coggeshall's flows of an ideal gas: every distance from the centre grows or shrinks by the same factor R(t).

With k = 1 for a cylinder and 2 for a sphere, and s = r/R,

    u = r R'/R,    rho = rho0 s^b R^-(k + 1),    p = P(s) R^(-gamma (k + 1)).

Flow 1 is free of forces: R = 1 - t/T and P is uniform. In flow 2 the pressure grows outwards and slows an expansion,

    R = (1 + t/T)^a,    a = 2/((gamma - 1)(k + 1) + 2),    P = a (1 - a) rho0 s^(b + 2)/((b + 2) T^2).

Source: Coggeshall, Phys. Fluids A 3 (1991) 757, flows 1 and 2 (the same in ExactPack), which need no heat conduction here;
times are counted from a start at which R = 1. Lengths in m, SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Free:
    """Flow 1, a collapse within the time T, s: density at 1 m and pressure at the start."""

    k: int
    b: float
    gamma: float
    rho0: float
    p0: float
    end: float

    @property
    def rate(self) -> float:
        """Velocity over radius at the start, 1/s."""
        return -1.0 / self.end

    @property
    def pressure_power(self) -> float:
        """Power of the radius with which the pressure grows."""
        return 0.0

    def scale(self, time: float) -> float:
        """R."""
        return 1.0 - time / self.end

    def sample(self, r, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density, radial velocity and pressure at radii r."""
        scale, r = self.scale(time), np.asarray(r, dtype=float)
        rho = self.rho0 * (r / scale) ** self.b * scale ** -(self.k + 1)
        return rho, -r / (self.end - time), np.full(r.shape, self.p0 * scale ** (-self.gamma * (self.k + 1)))

    def untouched(self, outer: float, time: float, steps: int = 4000) -> float:
        """Radius that sound from `outer` has reached at a time."""
        r, dt = outer, time / steps
        for n in range(steps):
            rho, u, p = self.sample(np.array(r), (n + 0.5) * dt)
            r += dt * (float(u) - float(np.sqrt(self.gamma * p / rho)))
        return r


@dataclass(frozen=True)
class Slowed:
    """Flow 2, an expansion: density at 1 m at the start, and T, s. It is faster than sound, so that nothing outside is felt."""

    k: int
    b: float
    gamma: float
    rho0: float
    start: float

    @property
    def power(self) -> float:
        """a."""
        return 2.0 / ((self.gamma - 1.0) * (self.k + 1) + 2.0)

    @property
    def rate(self) -> float:
        """Velocity over radius at the start, 1/s."""
        return self.power / self.start

    @property
    def pressure_power(self) -> float:
        """Power of the radius with which the pressure grows."""
        return self.b + 2.0

    def scale(self, time: float) -> float:
        """R."""
        return (1.0 + time / self.start) ** self.power

    def sample(self, r, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density, radial velocity and pressure at radii r."""
        scale, a, r = self.scale(time), self.power, np.asarray(r, dtype=float)
        share = r / scale
        pressure = a * (1.0 - a) * self.rho0 * share ** (self.b + 2.0) / ((self.b + 2.0) * self.start**2)
        return (self.rho0 * share**self.b * scale ** -(self.k + 1), a * r / (self.start + time),
                pressure * scale ** (-self.gamma * (self.k + 1)))


def shell_mean(power: float, inner: float, outer: float, k: int) -> float:
    """Mean of r^power by volume between two radii."""
    n = k + 1
    return n / (n + power) * (outer ** (n + power) - inner ** (n + power)) / (outer**n - inner**n)
