"""The uniform collapse (Noh's second problem): gas that converges with a velocity proportional to the distance.

With t in units of the collapse time, u = -r/(1 - t), rho = rho0 (1 - t)^-j, e = e0 (1 - t)^(-j (gamma - 1)), for j = 1, 2, 3.
There is no shock and no gradient of pressure: every particle keeps its velocity and follows its isentrope.

Source: Noh, J. Comput. Phys. 72 (1987) 78, section 4; the problem Noh2 of ExactPack.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Collapse:
    """The collapse of dimension j of gas of density rho0 and energy e0, complete at the time `end`, s."""

    j: int = 3
    gamma: float = 5.0 / 3.0
    rho0: float = 1.0
    e0: float = 1.0
    end: float = 1.0

    def at(self, t: float) -> tuple[float, float, float]:
        """(rho, p, e) everywhere at t before the end."""
        left = 1.0 - t / self.end
        rho, e = self.rho0 * left**-self.j, self.e0 * left ** (-self.j * (self.gamma - 1.0))
        return rho, (self.gamma - 1.0) * rho * e, e

    def velocity(self, r, t: float) -> np.ndarray:
        """Radial velocity at radii r."""
        return -np.asarray(r, dtype=float) / (self.end - t)

    def untouched(self, radius: float, t: float) -> float:
        """The radius that a rarefaction from the surface, at `radius` at the start, has reached.

        In the coordinate of the particles, r/(1 - t), it runs inward at c/(1 - t), and c = c0 (1 - t)^(-j (gamma - 1)/2); t is
        in units of the end.
        """
        power = 0.5 * self.j * (self.gamma - 1.0)
        c0 = (self.gamma * (self.gamma - 1.0) * self.e0) ** 0.5
        left = 1.0 - t / self.end
        return left * (radius - c0 * self.end * (left**-power - 1.0) / power)
