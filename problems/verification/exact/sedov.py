"""Sedov's blast: energy is released at a plane, an axis or a point in cold ideal gas at rest, and a strong shock runs out.

Source: Sedov, Similarity and Dimensional Methods in Mechanics (1959), chapter IV, in the form of Kamm and Timmes, On efficient
generation of numerically robust Sedov solutions, LA-UR-07-2849 (2007), for gas of uniform density. With j = 1, 2, 3 for planar,
cylindrical and spherical symmetry the shock is at R = (E t^2/(alpha rho0))^(1/(j + 2)); E is the energy of the whole space, per
area, per length, or in all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import quad

#: surface of the unit sphere of dimension j, both sides of the plane counted
SURFACE = {1: 2.0, 2: 2.0 * math.pi, 3: 4.0 * math.pi}


@dataclass(frozen=True)
class Sedov:
    """The blast of dimension j in gas of density rho0 and adiabatic index gamma, of energy E in J (per m, m^2)."""

    j: int = 3
    gamma: float = 1.4
    energy: float = 0.851072
    rho0: float = 1.0

    @cached_property
    def _ends(self) -> tuple[float, float]:
        """The parameter V at the centre and at the shock; the solution is the standard one of Kamm and Timmes between them."""
        j, g = self.j, self.gamma
        centre, shock = 2.0 / ((j + 2.0) * g), 4.0 / ((j + 2.0) * (g + 1.0))
        if not shock < 2.0 / (2.0 + j * (g - 1.0)):
            raise ValueError(f"gamma = {g:g} has no standard solution")
        return centre, shock

    def _functions(self, beyond) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """lambda = r/R, d(ln lambda)/dV, and u, rho and p over their values behind the shock, at V less that of the centre."""
        j, g = float(self.j), self.gamma
        centre, _ = self._ends
        beyond = np.asarray(beyond, dtype=float)
        v = centre + beyond
        a0, a2 = 2.0 / (j + 2.0), (1.0 - g) / (2.0 * (g - 1.0) + j)
        a1 = (j + 2.0) * g / (2.0 + j * (g - 1.0)) * (2.0 * j * (2.0 - g) / (g * (j + 2.0) ** 2) - a2)
        a3, a4, a5 = j / (2.0 * (g - 1.0) + j), a1 * (j + 2.0) / (2.0 - g), -2.0 / (2.0 - g)
        a, b, c = 0.25 * (j + 2.0) * (g + 1.0), (g + 1.0) / (g - 1.0), 0.5 * (j + 2.0) * g
        e = 0.5 * (2.0 + j * (g - 1.0))
        d = (j + 2.0) * (g + 1.0) / ((j + 2.0) * (g + 1.0) - 2.0 * (2.0 + j * (g - 1.0)))
        x1, x2, x3, x4 = a * v, b * c * beyond, d * (1.0 - e * v), b * (1.0 - c * v / g)
        place = x1**-a0 * x2**-a2 * x3**-a1
        slope = -a0 * a / x1 - a2 * b * c / x2 + a1 * d * e / x3
        return place, slope, x1 * place, x2**a3 * x3**a4 * x4**a5, x1 ** (a0 * j) * x3 ** (a4 - 2.0 * a1) * x4 ** (1.0 + a5)

    @cached_property
    def alpha(self) -> float:
        """The energy that takes the shock to R = 1 at t = 1 with rho0 = 1, by quadrature of the flow."""
        j, g = self.j, self.gamma
        speed = 2.0 / (j + 2.0)
        u2, rho2, p2 = 2.0 * speed / (g + 1.0), (g + 1.0) / (g - 1.0), 2.0 * speed**2 / (g + 1.0)

        def per(logarithm: float) -> float:
            """Energy per unit of the logarithm of V less that of the centre."""
            beyond = math.exp(logarithm)
            place, slope, u, rho, p = (float(each) for each in self._functions(beyond))
            return (0.5 * rho2 * rho * (u2 * u) ** 2 + p2 * p / (g - 1.0)) * place**j * slope * beyond

        centre, shock = self._ends
        return SURFACE[j] * quad(per, math.log(shock - centre) - 200.0, math.log(shock - centre), limit=500, epsrel=1e-11)[0]

    def radius(self, t: float) -> float:
        """R at time t, m."""
        return (self.energy * t * t / (self.alpha * self.rho0)) ** (1.0 / (self.j + 2.0))

    def time(self, radius: float) -> float:
        """Time at which the shock is at a radius, s."""
        return math.sqrt(self.alpha * self.rho0 * radius ** (self.j + 2.0) / self.energy)

    def behind(self, t: float) -> tuple[float, float, float]:
        """(rho, u, p) just behind the shock."""
        speed, g = 2.0 / (self.j + 2.0) * self.radius(t) / t, self.gamma
        return (g + 1.0) / (g - 1.0) * self.rho0, 2.0 * speed / (g + 1.0), 2.0 * self.rho0 * speed**2 / (g + 1.0)

    def central_pressure(self, t: float) -> float:
        """p at the centre, Pa."""
        return float(self.sample(np.zeros(1), t)[2][0])

    def sample(self, r, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """rho, radial velocity and p at radii r >= 0 and time t."""
        centre, shock = self._ends
        beyond = (shock - centre) * np.exp(-200.0 * np.linspace(1.0, 0.0, 20001) ** 3)
        place, _, *shares = self._functions(beyond)
        over = np.asarray(r, dtype=float) / self.radius(t)
        inside = over < 1.0
        states = zip(shares, np.array(self.behind(t))[[1, 0, 2]], strict=True)
        u, rho, p = (np.interp(over, place, share) * value for share, value in states)
        u = np.where(over < place[0], 0.0, u)
        return np.where(inside, rho, self.rho0), np.where(inside, u, 0.0), np.where(inside, p, 0.0)
