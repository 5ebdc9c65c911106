"""Noh's problem: cold ideal gas runs at unit speed towards a plane, an axis or a point and piles up behind a shock.

Source: Noh, JCP 72 (1987) 78. With j = 1, 2, 3 for planar, cylindrical and spherical symmetry, the shock moves at
D = (gamma - 1)/2 |u0|; ahead of it rho = rho0 (1 + |u0| t/r)^(j - 1), behind it rho = rho0 ((gamma + 1)/(gamma - 1))^j,
u = 0 and e = u0^2/2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Noh:
    """Noh's problem of dimension j with inflow speed ``speed`` (positive) and density rho0."""

    j: int
    gamma: float = 5 / 3
    rho0: float = 1.0
    speed: float = 1.0

    @property
    def shock_speed(self) -> float:
        """Speed of the outgoing shock."""
        return (self.gamma - 1) / 2 * self.speed

    @property
    def rho(self) -> float:
        """Density behind the shock."""
        return self.rho0 * ((self.gamma + 1) / (self.gamma - 1)) ** self.j

    @property
    def e(self) -> float:
        """Specific internal energy behind the shock."""
        return self.speed**2 / 2

    @property
    def p(self) -> float:
        """Pressure behind the shock."""
        return (self.gamma - 1) * self.rho * self.e

    def sample(self, r, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """rho, radial velocity and p at radii r > 0 and time t."""
        r = np.asarray(r, dtype=float)
        behind = r < self.shock_speed * t
        rho = np.where(behind, self.rho, self.rho0 * (1 + self.speed * t / r) ** (self.j - 1))
        return rho, np.where(behind, 0.0, -self.speed), np.where(behind, self.p, 0.0)
