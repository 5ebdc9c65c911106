"""Noh's problem for any equation of state: a cylinder or a sphere, at rho0 and no pressure, that converges at a uniform speed.

There is no length in it, so that the flow depends on x = r/t alone. Ahead of the shock it is isentropic,

    u' = -(j - 1) (u/x)/(1 - (u - x)^2/c^2),    rho' = rho (x - u) u'/c^2,    p' = c^2 rho',

from u = -U, rho0 and p = 0 at infinity. At x = D stands the shock behind which the material is at rest, and that state fills
the rest. In one dimension, j = 1, nothing changes ahead of it.

Source: Velikovich and Giuliani, Phys. Rev. E 98 (2018) 013105; Noh, J. Comput. Phys. 72 (1987) 78. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from problems.verification.exact.impact import Solid

#: x at which the integration begins and the least at which it ends, over the sum of sound speed and speed
FAR, NEAR = 1e8, 1e-2


@dataclass(frozen=True)
class NohSolid:
    """Noh's problem of dimension j for a Mie-Grueneisen solid with an inflow speed (positive), m/s."""

    j: int
    solid: Solid
    speed: float

    @cached_property
    def _ahead(self):
        """Dense solution in ln(x) of u, rho and e, inward to where the flow would be sonic."""

        def along(log_x: float, y: np.ndarray) -> list[float]:
            x, (u, rho, e) = np.exp(log_x), y
            squared = self.solid.sound_speed_squared(rho, e)
            slope = -(self.j - 1) * (u / x) / (1.0 - (u - x) ** 2 / squared)
            compression = (x - u) * slope / squared
            return [x * slope, x * rho * compression, x * self.solid.pressure(rho, e) / rho * compression]

        def sonic(log_x: float, y: np.ndarray) -> float:
            return (y[0] - np.exp(log_x)) ** 2 / self.solid.sound_speed_squared(y[1], y[2]) - 1.0 - 1e-6

        sonic.terminal = True
        first, last = np.log(np.multiply((FAR, NEAR), self.solid.c0 + self.speed))
        return solve_ivp(along, (first, last), [-self.speed, self.solid.rho0, 0.0], events=sonic, dense_output=True,
                         rtol=1e-10, atol=1e-12)

    def _behind(self, x: float) -> tuple[float, float, float, float]:
        """Density, pressure and energy at rest behind a shock at x by mass and momentum, and the excess of its pressure."""
        u, rho, e = self._ahead.sol(np.log(x))
        p = self.solid.pressure(rho, e)
        density = rho * (x - u) / x
        pressure = p - rho * (x - u) * u
        energy = e + 0.5 * (p + pressure) * (1.0 / rho - 1.0 / density)
        return density, pressure, energy, self.solid.pressure(density, energy) - pressure

    @cached_property
    def shock_speed(self) -> float:
        """D, m/s."""
        least = float(np.exp(self._ahead.t[-1])) * (1.0 + 1e-9)
        most = 3.0 * (self.solid.c0 + self.speed)
        return float(brentq(lambda x: self._behind(x)[3], least, most, xtol=1e-9))

    @property
    def behind(self) -> tuple[float, float, float]:
        """Density, pressure and specific energy behind the shock."""
        return self._behind(self.shock_speed)[:3]

    def sample(self, r, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density, radial velocity and pressure at radii r > 0."""
        x = np.asarray(r, dtype=float) / time
        log_x = np.clip(np.log(x), np.log(self.shock_speed), self._ahead.t[0])
        u, rho, e = self._ahead.sol(log_x.ravel()).reshape(3, *x.shape)
        p = np.vectorize(self.solid.pressure)(rho, e)
        inside = x < self.shock_speed
        density, pressure, _ = self.behind
        return np.where(inside, density, rho), np.where(inside, 0.0, u), np.where(inside, pressure, p)
