"""The length of the next step and its cause; the least speed of sound, the speed limit of a vertex; whether steps collapse."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.kernels.between.choose_step import EDGE, GROWTH
from hydro2d.physics import waves

#: vertices may be this many times faster than the fastest body at the start, or than the slowest wave
SPEED_LIMIT_FACTOR = 5.0
#: least speed of sound as a share of the speeds of a shot, and the largest square of it, (m/s)^2
SOUND_SHARE, SOUND_MOST = 1e-2, 1.0
#: a step below this share of the median has collapsed if it stays there for this many cycles, in which it does not only grow
COLLAPSED, PATIENCE = 1e-3, 100
#: classes of steps in a factor of two
CLASSES = 8


def sound_floor(speed: float, sound_speeds) -> float:
    """Least square of the speed of sound, m^2/s^2: that of a hundredth of the speeds of a shot, at most that of 1 m/s.

    speed : with which its bodies may meet, m/s, 0 if they are at rest;  sound_speeds : of the bodies at rest, m/s
    """
    scale = max(speed, float(sound_speeds.max()))
    return min((SOUND_SHARE * scale) ** 2, SOUND_MOST) if scale > 0.0 else SOUND_MOST


def speed_limit(state, sound_speeds) -> float:
    """Greatest speed of a vertex, m/s, from the velocities of a state at the start and the bodies' sound speeds at rest."""
    fastest = float(np.sqrt(np.max(state.u**2 + state.v**2)))
    return SPEED_LIMIT_FACTOR * max(fastest, float(sound_speeds.min()))


def by_edges(cycle) -> None:
    """Shortens the step so that material moving with an edge does not cross too much of the cells next to it."""
    handle, numerics = cycle.given.handle, cycle.method.numerics
    crossing, edge = cycle.method.boundaries.least_crossing(cycle.edges.widths, cycle.time, cycle.time + cycle.dt)
    if cycle.dt > numerics.advective_courant * crossing:
        handle.update(dt=numerics.advective_courant * crossing, limited_by=EDGE)
        cycle.edges.limiting = edge


def cause(cycle) -> str:
    """What has set the time step, in words: the term and the cell, the ramp of the first cycles, the growth from step to step,
    or the velocity of an edge."""
    handle, g = cycle.given.handle, cycle.grid
    if handle.limited_by == GROWTH:
        return "growth"
    if handle.limited_by == EDGE:
        return f"velocity of the edge {cycle.edges.limiting}"
    j, (term, i) = int(cycle.state.least_row[0]), cycle.state.cause
    return (f"{waves.CAUSES[term]} at r = {g.rc[i] * 1e3:.3f} mm, z = {g.zc[j] * 1e3:.3f} mm"
            + (" (ramp)" if handle.ramped else ""))


class Steps:
    """The steps of a run so far, and whether they have collapsed.

    The median is that over time: longer steps have covered half of the time so far. Thousands of collapsed steps cover next to
    no time, so they do not move it as they would a median over cycles. It is found anew every PATIENCE cycles.

    Attributes
    ----------
    median : s; 0 before the first PATIENCE steps
    """

    def __init__(self) -> None:
        self.median = 0.0
        self._covered: dict[int, float] = {}
        self._taken = self._low = 0

    def collapse(self, dt: float, grown: bool) -> bool:
        """Adds a step, s; whether PATIENCE of them were below COLLAPSED times the median.

        A step that has only grown from the one before (``grown``) is not counted among these: it recovers. After True the count
        begins again.
        """
        number = math.floor(CLASSES * math.log2(dt))
        self._covered[number] = self._covered.get(number, 0.0) + dt
        self._taken += 1
        if self._taken % PATIENCE == 0:
            self.median = self._middle()
        if dt >= COLLAPSED * self.median:
            self._low = 0
        elif not grown:
            self._low += 1
        if self._low < PATIENCE:
            return False
        self._low = 0
        return True

    def _middle(self) -> float:
        """The median, s, from the time that the steps of each class have covered."""
        numbers = sorted(self._covered)
        covered = np.cumsum([self._covered[number] for number in numbers])
        return 2.0 ** ((numbers[int(np.searchsorted(covered, 0.5 * covered[-1]))] + 0.5) / CLASSES)

    def saved(self) -> dict:
        """Data for a restart file."""
        return {"covered": sorted(self._covered.items()), "taken": self._taken, "low": self._low, "median": self.median}

    def resume(self, saved: dict) -> None:
        """Continues from the result of `saved`."""
        self._covered = dict(saved["covered"])
        self._taken, self._low, self.median = (saved[name] for name in ("taken", "low", "median"))
