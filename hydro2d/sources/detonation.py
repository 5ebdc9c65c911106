"""Detonation: the points at which an explosive is lit, and the speed at which the detonation runs from them."""

from __future__ import annotations

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter
from hydro2d.base.tables import Table
from hydro2d.sources.base import Reached, Source, declared

#: equations of state that a detonation can burn, by name
EXPLOSIVES = ("jwl",)
#: cell widths over which the detonation burns the material of a cell
WIDTHS = 2.5
#: share of a cell that must lie within the reach of the source
HALF = 0.5
#: most points of one detonation
MOST = 1000


@declared
class Detonation(Source):
    """Lights an explosive: every cell at the time at which the detonation arrives there, straight or around obstacles.

    It gives no energy by itself: that of the explosive is in its equation of state. explanation/explosives
    """

    word = "detonation"
    meaning = "detonation points of an explosive"
    keys = (
        Parameter("points", "m, m, s", REQUIRED, "table of [r, z, time] at which the detonation begins; beside the axis of an "
                  "r-z mesh a point is a ring", example=[["0 mm", "0 mm", "0 us"]],
                  table=Table(("r", "z", "time"), fewest=1, most=MOST)),
        Parameter("widths", "", WIDTHS, "cell widths over which the detonation burns the explosive", sign=POSITIVE,
                  example=2.5),
        Parameter("speed", "m/s", None, "speed of the detonation; default: detonation_velocity of the explosive", sign=POSITIVE,
                  example="6930 m/s"),
    )

    def misfit(self, material) -> str | None:
        """Why the material of the body cannot be lit, or None; material : materials.material.Material."""
        if material.eos.name not in EXPLOSIVES:
            return (f'body "{self.body}" is no explosive: the equation of state of {material.name} is {material.eos.name}, not '
                    f"{' or '.join(EXPLOSIVES)}")
        return None

    def begin(self, grid, reached: Reached) -> list[str]:
        """Sets light times and burning times of the explosive. Raises DeckError for a point outside of it."""
        speed = self.speed or reached.material.eos.numbers["detonation_velocity"].value
        for r, z, _ in self.points:
            if not self._holds(grid, reached.share, r, z):
                raise DeckError(f'source "{self.name}": the point (r, z) = ({r:g}, {z:g}) m lies outside of its explosive, '
                                f'body "{self.body}"')
        light = reached.arrival(np.array(self.points), speed)
        before, lit = reached.variables["light_time"], np.isfinite(light)
        there = (reached.share > 0.0) & (self.share(grid) >= HALF)
        duration = self.widths * np.minimum.outer(np.diff(grid.z_edges), np.diff(grid.r_edges)) / speed
        first = there & lit & (light < before)
        light, duration = self._not_before(grid, light, duration, speed)
        before[first] = light[first]
        reached.variables["burn_time"][first] = duration[first]
        dark = float(np.sum(reached.mass[there & ~lit]) / max(np.sum(reached.mass), 1e-300))
        return [f'source "{self.name}": no detonation reaches {dark:.2%} of body "{self.body}", which does not burn'
                ] if dark > 0.0 else []

    def _not_before(self, grid, light: np.ndarray, duration: np.ndarray, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Light and burning times, s, of cells that would begin to burn before their point is lit: they begin with it and end
        as before."""
        from eos.jwl import LEAD  # decks are read without kernels

        light, duration = light.copy(), duration.copy()
        z, r = np.meshgrid(grid.zc[grid.inside[0]], grid.rc[grid.inside[1]], indexing="ij")
        for at_r, at_z, time in self.points:
            near = np.isclose(light, time + np.hypot(r - at_r, z - at_z) / speed, rtol=1e-9, atol=0.0)
            near &= light - LEAD * duration < time
            duration[near] = light[near] + (1.0 - LEAD) * duration[near] - time
            light[near] = time + LEAD * duration[near]
        return light, duration

    @staticmethod
    def _holds(grid, share: np.ndarray, r: float, z: float) -> bool:
        """Whether one of the cells that the point lies in, or on the edge of, has some of the body."""
        (z_edges, r_edges), small = (grid.z_edges, grid.r_edges), 1e-9
        j = (z_edges[:-1] <= z + small * np.diff(z_edges)) & (z <= z_edges[1:] + small * np.diff(z_edges))
        i = (r_edges[:-1] <= r + small * np.diff(r_edges)) & (r <= r_edges[1:] + small * np.diff(r_edges))
        return bool((share[np.ix_(j, i)] > 0.0).any())
