"""The Riemann problem of two (stiffened) ideal gases, p = (gamma - 1) rho e - gamma p_inf.

Source: Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, chapter 4; with p + p_inf in place of p for
the stiffened gas. Everything in one consistent system of units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True)
class Gas:
    """A constant state of a stiffened gas; ``p_inf = 0`` is the ideal gas."""

    rho: float
    u: float
    p: float
    gamma: float
    p_inf: float = 0.0

    @property
    def c(self) -> float:
        """Sound speed."""
        return math.sqrt(self.gamma * (self.p + self.p_inf) / self.rho)

    def velocity_change(self, p: float) -> float:
        """Size of the velocity change across the wave that leads from this state to pressure p."""
        pi, pi0, g = p + self.p_inf, self.p + self.p_inf, self.gamma
        if p > self.p:
            return (p - self.p) * math.sqrt(2 / self.rho / ((g + 1) * pi + (g - 1) * pi0))
        return 2 * self.c / (g - 1) * ((pi / pi0) ** ((g - 1) / (2 * g)) - 1)

    def density_behind(self, p: float) -> float:
        """Density behind the wave that leads from this state to pressure p."""
        ratio, g = (p + self.p_inf) / (self.p + self.p_inf), self.gamma
        if p > self.p:
            k = (g - 1) / (g + 1)
            return self.rho * (ratio + k) / (k * ratio + 1)
        return self.rho * ratio ** (1 / g)


@dataclass(frozen=True)
class Riemann:
    """Solution of the Riemann problem ``left | right``, self-similar in x/t."""

    left: Gas
    right: Gas
    p: float
    u: float

    @property
    def rho_left(self) -> float:
        """Density between the left wave and the contact."""
        return self.left.density_behind(self.p)

    @property
    def rho_right(self) -> float:
        """Density between the contact and the right wave."""
        return self.right.density_behind(self.p)

    def _wave(self, gas: Gas, side: int) -> tuple[float, float]:
        """Speeds of the wave's outer and inner edge; side is -1 left, +1 right."""
        behind = gas.density_behind(self.p)
        if self.p > gas.p:
            speed = gas.u + side * (side * (self.u - gas.u)) * behind / (behind - gas.rho)
            return speed, speed
        c_behind = math.sqrt(gas.gamma * (self.p + gas.p_inf) / behind)
        return gas.u + side * gas.c, self.u + side * c_behind

    @property
    def left_wave(self) -> tuple[float, float]:
        """Speeds of the left wave's head and tail; equal for a shock."""
        return self._wave(self.left, -1)

    @property
    def right_wave(self) -> tuple[float, float]:
        """Speeds of the right wave's head and tail; equal for a shock."""
        return self._wave(self.right, +1)

    def sample(self, xi) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """rho, u, p at the similarity coordinates xi = x/t."""
        xi = np.asarray(xi, dtype=float)
        rho, u, p = np.empty(xi.shape), np.empty(xi.shape), np.empty(xi.shape)
        for gas, side, here in ((self.left, -1, xi < self.u), (self.right, +1, xi >= self.u)):
            head, tail = self._wave(gas, side)
            outside = here & (side * xi >= side * head)
            behind = here & (side * xi <= side * tail)
            rho[outside], u[outside], p[outside] = gas.rho, gas.u, gas.p
            rho[behind], u[behind], p[behind] = gas.density_behind(self.p), self.u, self.p
            fan = here & ~outside & ~behind
            g = gas.gamma
            c = 2 / (g + 1) * (gas.c - side * (g - 1) / 2 * (gas.u - xi[fan]))
            rho[fan] = gas.rho * (c / gas.c) ** (2 / (g - 1))
            u[fan] = xi[fan] - side * c
            p[fan] = (gas.p + gas.p_inf) * (c / gas.c) ** (2 * g / (g - 1)) - gas.p_inf
        return rho, u, p


def solve(left: Gas, right: Gas) -> Riemann:
    """Solves the Riemann problem; ValueError where a vacuum opens."""
    approach = left.u - right.u
    low = -min(left.p_inf, right.p_inf) * (1 - 1e-14) if min(left.p_inf, right.p_inf) > 0 else 0.0

    def excess(p: float) -> float:
        return left.velocity_change(p) + right.velocity_change(p) - approach

    if excess(low) >= 0:
        raise ValueError("a vacuum opens between the two states")
    high = 2 * max(left.p, right.p)
    while excess(high) < 0:
        high *= 2
    p = brentq(excess, low, high, xtol=1e-300, rtol=1e-15, maxiter=500)
    u = 0.5 * (left.u + right.u) + 0.5 * (right.velocity_change(p) - left.velocity_change(p))
    return Riemann(left, right, p, u)


def sod() -> Riemann:
    """Sod's shock tube: (1, 0, 1) | (0.125, 0, 0.1), gamma = 1.4 (Sod, JCP 27 (1978) 1)."""
    return solve(Gas(1.0, 0.0, 1.0, 1.4), Gas(0.125, 0.0, 0.1, 1.4))
