"""Two-wave compaction of a porous material: an elastic precursor, and the shock that crushes the pores behind it.

Independent of eos/p_alpha.py: it uses the jump conditions and the crush curve alone. The solid is Mie-Grueneisen about a
straight Hugoniot in compression.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from scipy.optimize import brentq


class State(NamedTuple):
    """Behind a wave: its speed into the material at rest, m/s, velocity, m/s, pressure, Pa, density, kg/m^3, energy, J/kg."""

    speed: float
    u: float
    p: float
    rho: float
    e: float
    alpha: float


@dataclass(frozen=True)
class Porous:
    """A porous material; SI. ``c_e`` is its elastic sound speed, the precursor of which is weak enough to be a sound wave."""

    rho0: float
    rho_s: float
    c_e: float
    p_e: float
    p_s: float
    c0: float
    s: float
    gamma: float
    n: float = 2.0

    def solid_pressure(self, rho: float, e: float) -> float:
        """Pressure of the solid: McQueen and others (1970)."""
        eta = 1.0 - self.rho_s / rho
        if eta < 0.0:
            return self.c0**2 * (rho - self.rho_s) + self.gamma * rho * e
        cold = self.c0**2 * eta * (1 - self.gamma * eta / 2) / (1 - self.s * eta) ** 2
        return self.rho_s * (cold + self.gamma * e)

    def precursor(self) -> State:
        """The state behind the precursor, at the pressure at which crushing begins."""
        u = self.p_e / (self.rho0 * self.c_e)
        rho = self.rho0 / (1 - u / self.c_e)
        e = 0.5 * u * u
        solid = brentq(lambda each: self.solid_pressure(each, e) * rho / each - self.p_e, self.rho_s, 1.1 * self.rho_s)
        return State(self.c_e, u, self.p_e, rho, e, solid / rho)

    def alpha(self, p: float, elastic: float) -> float:
        """The crush curve from the distention at the end of the elastic range."""
        return 1.0 if p >= self.p_s else 1.0 + (elastic - 1.0) * ((self.p_s - p) / (self.p_s - self.p_e)) ** self.n

    def behind(self, piston: float) -> State:
        """The state behind the second wave, ahead of a piston, m/s, or at a wall that is hit at that speed."""
        first = self.precursor()

        def state(p: float) -> State:
            jump = piston - first.u
            mass = (p - first.p) / jump  # through the wave, per area and time: rho1 (U - u1)
            rho = 1.0 / (1.0 / first.rho - jump / mass)
            e = first.e + 0.5 * (p + first.p) * (1.0 / first.rho - 1.0 / rho)
            return State(first.u + mass / first.rho, piston, p, rho, e, self.alpha(p, first.alpha))

        def error(p: float) -> float:
            trial = state(p)
            return self.solid_pressure(trial.rho * trial.alpha, trial.e) / trial.alpha - p

        least = first.p + 1.001 * first.rho * (piston - first.u) ** 2
        return state(brentq(error, least, 50.0 * least + 1e10, xtol=1.0))
