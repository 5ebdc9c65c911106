"""A detonation that runs from a rigid wall: the Taylor rarefaction behind it, for products with any isentrope."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np


class Taylor:
    """The self-similar flow behind a plane Chapman-Jouguet detonation that starts at a rigid wall, x = 0, at time 0.

    Along the isentrope from the Chapman-Jouguet state down to rest, du = c d(rho)/rho and x/t = u + c; from there to the wall
    the products are at rest.

    Parameters
    ----------
    speed : D, m/s;  rest : rho0, kg/m^3;  pressure : P_CJ, Pa
    sound : (rho, p) -> c on the isentrope, m/s
    """

    def __init__(self, speed: float, rest: float, pressure: float, sound: Callable[[float, float], float], steps: int = 20000):
        self.speed = speed
        u = pressure / (rest * speed)
        rho, p = rest * speed / (speed - u), pressure
        rows = [(rho, u, p, u + sound(rho, p))]
        step = -1.0 / steps
        while u > 0.0:
            c = sound(rho, p)
            half = rho * (1.0 + 0.5 * step), p + 0.5 * step * rho * c * c
            middle = sound(*half)
            rho, u, p = rho * (1.0 + step), u + step * rho / half[0] * middle, p + step * rho / half[0] * half[0] * middle**2
            rows.append((rho, u, p, u + sound(rho, p)))
        last, before = np.array(rows[-1]), np.array(rows[-2])
        rows[-1] = tuple(before + before[1] / (before[1] - last[1]) * (last - before))  # where u is zero
        self.rho, self.u, self.p, self.x_over_t = np.array(rows[::-1]).T

    def at(self, x, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(density, velocity, pressure) at points behind the front, x < D t."""
        y = np.asarray(x) / time
        return tuple(np.interp(y, self.x_over_t, each, left=end) for each, end in
                     ((self.rho, self.rho[0]), (self.u, 0.0), (self.p, self.p[0])))


def mader(x, time: float, speed: float = 8000.0, rest: float = 1875.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(density, velocity, pressure) of Mader's problem in closed form, gamma = 3: c + u = x/t, u - c = -D/2."""
    y = np.maximum(np.asarray(x) / time, 0.5 * speed)
    u, c = 0.5 * (y - 0.5 * speed), 0.5 * (y + 0.5 * speed)
    cj = rest * speed**2 / 4.0
    rho = 4.0 / 3.0 * rest * c / (0.75 * speed)
    return rho, u, cj * (c / (0.75 * speed)) ** 3


def wall_pressure(gamma: float) -> float:
    """Pressure over the Chapman-Jouguet pressure where a detonation meets a rigid wall head on, by the shock relations."""
    return (5.0 * gamma + 1.0 + sqrt(17.0 * gamma**2 + 2.0 * gamma + 1.0)) / (4.0 * gamma)
