"""Shocks, isentropes and releases of the equations of state of a deck, numerically: for any that is linear in the energy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from eos.dispatch import evaluate, sound_speed_squared

#: steps in log density of a release, and the expansion at which it ends; largest compression of a step of a squeeze
STEPS, THIN, SQUEEZE = 400, 1e3, 1.02
#: density at which a cold gas, which has no pressure, is no longer squeezed, kg/m^3
DENSEST = 1e9
#: the compression 1 - rho0/rho1 that no shock exceeds, and the rest of the energy's factor at that limit
MOST_ETA, LIMIT = 0.999, 1e-6


@dataclass(frozen=True)
class Material:
    """An equation of state with its parameters and internal variables; density kg/m^3, energy J/kg, pressure Pa, speeds m/s."""

    model: int
    par: np.ndarray
    internal: np.ndarray

    def pressure(self, rho: float, e: float) -> float:
        return evaluate(self.model, rho, e, self.internal, self.par)[0]

    def temperature(self, rho: float, e: float) -> float:
        return evaluate(self.model, rho, e, self.internal, self.par)[3]

    def sound(self, rho: float, e: float) -> float:
        p, dpdrho, dpde, _ = evaluate(self.model, rho, e, self.internal, self.par)
        return math.sqrt(sound_speed_squared(rho, p, dpdrho, dpde, 0.0))

    def _behind(self, rho: float, e: float, eta: float) -> tuple[float, float]:
        """Energy behind a shock that compresses by eta = 1 - rho/rho1, and the jump of velocity; inf beyond the limit."""
        rho1, volume = rho / (1.0 - eta), eta / rho
        p0, at_zero = self.pressure(rho, e), self.pressure(rho1, 0.0)
        slope = self.pressure(rho1, 1.0) - at_zero
        left = 1.0 - 0.5 * slope * volume
        if left <= LIMIT:
            return math.inf, math.inf
        e1 = (e + 0.5 * (at_zero + p0) * volume) / left
        return e1, math.sqrt(max((at_zero + slope * e1 - p0) * volume, 0.0))

    def shocked(self, rho: float, e: float, jump: float, pressure: float = math.inf) -> tuple[float, float]:
        """(rho, e) behind a shock with this jump of velocity, or with this pressure if that needs less of a jump.

        Rankine-Hugoniot. A cold gas is at the limit of its compression at once.
        """
        low, high = 0.0, MOST_ETA
        for _ in range(60):
            middle = 0.5 * (low + high)
            e1, reached = self._behind(rho, e, middle)
            weak = reached < jump and self.pressure(rho / (1.0 - middle), e1) < pressure
            low, high = (middle, high) if weak else (low, middle)
        if self._behind(rho, e, high)[1] == math.inf:
            return rho / (1.0 - low), e + 0.5 * jump**2 + max(self.pressure(rho, e), 0.0) * low / rho
        return rho / (1.0 - low), self._behind(rho, e, low)[0]

    def squeezed(self, rho: float, e: float, pressure: float) -> tuple[float, float]:
        """(rho, e) on the isentrope through (rho, e) where it reaches this pressure, if that is higher; or DENSEST."""
        step = math.log(SQUEEZE)
        while self.pressure(rho, e) < pressure and rho < DENSEST:
            half, middle = e + self.pressure(rho, e) / rho * 0.5 * step, rho * math.exp(0.5 * step)
            e += self.pressure(middle, half) / middle * step
            rho *= SQUEEZE
        return rho, e

    def released(self, rho: float, e: float) -> float:
        """Speed gained in the isentropic release from (rho, e) to zero pressure: the integral of c/rho."""
        sign = 1.0 if self.pressure(rho, e) > 0.0 else -1.0
        step, speed = -sign * math.log(THIN) / STEPS, 0.0
        for _ in range(STEPS):
            p = self.pressure(rho, e)
            if p * sign <= 0.0:
                break
            speed += self.sound(rho, e) * abs(step)
            e += p / rho * step
            rho *= math.exp(step)
        return speed
