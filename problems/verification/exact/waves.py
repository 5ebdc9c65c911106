"""Waves of small amplitude on the surface of a liquid, or on the interface of two, between a floor and a lid.

The interface is at z = a(t) cos(k r). With the lower liquid of density rho1 and depth H1, the upper one of rho2 and H2, and the
acceleration g downwards,

    a'' = -omega^2 a,    omega^2 = g k (rho1 - rho2)/(rho1 coth(k H1) + rho2 coth(k H2)).

Under void, rho2 = 0, this is omega^2 = g k tanh(k H1). A heavier liquid above makes omega^2 negative, and the interface
unstable: a = a0 cosh(n t) with n^2 = -omega^2 (Rayleigh and Taylor).

Source: Lamb, Hydrodynamics, 6th edition, sections 228 and 231; Taylor, Proc. R. Soc. A 201 (1950) 192. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Interface:
    """Two liquids at rest: acceleration, m/s^2, wave number, 1/m, densities, kg/m^3, and depths, m; by default void above."""

    gravity: float
    wave_number: float
    lower: float
    depth: float
    upper: float = 0.0
    height: float = math.inf

    @property
    def omega_squared(self) -> float:
        """omega^2, 1/s^2; negative where the interface is unstable."""
        k = self.wave_number
        inertia = self.lower / math.tanh(k * self.depth) + self.upper / math.tanh(k * self.height)
        return self.gravity * k * (self.lower - self.upper) / inertia

    @property
    def period(self) -> float:
        """Period of a standing wave, s."""
        return 2.0 * math.pi / math.sqrt(self.omega_squared)

    @property
    def growth(self) -> float:
        """n of an unstable interface, 1/s."""
        return math.sqrt(-self.omega_squared)

    def amplitude(self, time) -> np.ndarray:
        """a/a0 at these times, s, of an interface that begins at rest."""
        time = np.asarray(time, dtype=float)
        return np.cos(math.sqrt(self.omega_squared) * time) if self.omega_squared > 0.0 else np.cosh(self.growth * time)
