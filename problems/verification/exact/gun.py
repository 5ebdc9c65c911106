"""A gun whose gas is still a simple wave: a projectile of finite mass in front of gas at rest, in a tube with nothing ahead.

Until a wave returns from the breech every C- characteristic leaves the gas at rest, so that u = 2 (c0 - c)/(gamma - 1) on the
projectile, and m du/dt = p0 (1 - (gamma - 1) u/(2 c0))^(2 gamma/(gamma - 1)), with m the mass per area. Hence

    u = 2 c0/(gamma - 1) [1 - (1 + t/tau)^(-(gamma - 1)/(gamma + 1))],    tau = 2 m c0/((gamma + 1) p0).

Source: Love and Pidduck, Phil. Trans. R. Soc. A 222 (1922) 167; Seigel, The Theory of High Speed Guns, AGARDograph 91 (1965).
SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Gun:
    """Gas of density rho0, kg/m^3, and pressure p0, Pa, behind a projectile of this mass per area, kg/m^2."""

    rho0: float
    p0: float
    gamma: float
    mass: float

    @property
    def c0(self) -> float:
        """Sound speed of the gas at rest, m/s."""
        return float(np.sqrt(self.gamma * self.p0 / self.rho0))

    @property
    def tau(self) -> float:
        """The time within which the acceleration falls, s."""
        return 2.0 * self.mass * self.c0 / ((self.gamma + 1.0) * self.p0)

    def velocity(self, time) -> np.ndarray:
        """Velocity of the projectile, m/s."""
        g = self.gamma
        return 2.0 * self.c0 / (g - 1.0) * (1.0 - (1.0 + np.asarray(time) / self.tau) ** (-(g - 1.0) / (g + 1.0)))

    def position(self, time) -> np.ndarray:
        """Distance that the projectile has moved, m: the integral of the velocity."""
        g, s = self.gamma, np.asarray(time) / self.tau
        return 2.0 * self.c0 * self.tau / (g - 1.0) * (s - 0.5 * (g + 1.0) * ((1.0 + s) ** (2.0 / (g + 1.0)) - 1.0))

    def pressure(self, u) -> np.ndarray:
        """Pressure of gas with the velocity u, Pa."""
        g = self.gamma
        return self.p0 * (1.0 - 0.5 * (g - 1.0) * np.asarray(u) / self.c0) ** (2.0 * g / (g - 1.0))

    def sample(self, x, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density, velocity and pressure of gas at x, m, from the projectile's start, before a wave returns from the breech.

        The C- characteristic that leaves the projectile at s is straight: x = X(s) + (u(s) - c(s)) (t - s).
        """
        g = self.gamma
        left = np.linspace(0.0, time, 4001)
        u = self.velocity(left)
        c = self.c0 - 0.5 * (g - 1.0) * u
        u = np.interp(x, self.position(left) + (u - c) * (time - left), u)
        return self.rho0 * (1.0 - 0.5 * (g - 1.0) * u / self.c0) ** (2.0 / (g - 1.0)), u, self.pressure(u)

    def returned(self, time: float, length: float) -> float:
        """Where the first wave is that the breech reflects, m: the C+ characteristic from x = -length at length/c0."""

        def speed(t: float, x: np.ndarray) -> np.ndarray:
            u = self.sample(x, t)[1]
            return self.c0 + (1.0 - 0.5 * (self.gamma - 1.0)) * u

        start = length / self.c0
        return -length if time <= start else float(solve_ivp(speed, (start, time), [-length], rtol=1e-7).y[0, -1])
