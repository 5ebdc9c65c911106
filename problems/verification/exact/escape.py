"""Products of a plane detonation that escape into vacuum at both ends of the charge, gamma = 3.

The charge fills 0 < x < L and is lit at its free end x = 0 at time 0. With gamma = 3, u + c and u - c are each constant along
straight lines. Behind the detonation, which reaches x = L at T = L/D,

    u + c = x/t,  u - c = -D/2        the wave of Taylor, which here ends in vacuum at x = -D t/2;
    u - c = (x - L)/(t - T)           after T, where a rarefaction from the other end has come: x > L - D (t - T)/2.

The products reach as far as x = D t, where u = D and c = 0.

Source: Fickett and Davis, Detonation (1979), section 2C; the second rarefaction is that of Fickett and Rivard's test,
LA-5910-MS (1974), which ExactPack has as the escape of explosive products, with a piston behind the charge. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Escape:
    """A charge of density rho0, kg/m^3, speed of detonation, m/s, and length, m."""

    rho0: float
    speed: float
    length: float

    @property
    def cj_pressure(self) -> float:
        """Pressure of Chapman and Jouguet, rho0 D^2/4, Pa."""
        return 0.25 * self.rho0 * self.speed**2

    @property
    def energy(self) -> float:
        """Energy of the detonation per volume of the charge, rho0 D^2/(2 (gamma^2 - 1)), J/m^3."""
        return self.rho0 * self.speed**2 / 16.0

    def ends(self, time: float) -> tuple[float, float]:
        """Where the products end, m, after the charge has burnt."""
        return -0.5 * self.speed * time, self.speed * time

    def sample(self, x, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density, velocity and pressure after the charge has burnt; zero in vacuum."""
        x, end = np.asarray(x, dtype=float), self.length / self.speed
        plus = x / time
        minus = np.maximum((x - self.length) / (time - end), -0.5 * self.speed)
        c = np.maximum(0.5 * (plus - minus), 0.0)
        u = np.where(c > 0.0, 0.5 * (plus + minus), 0.0)
        rho = 4.0 / 3.0 * self.rho0 * c / (0.75 * self.speed)
        return rho, u, self.cj_pressure * (c / (0.75 * self.speed)) ** 3
