"""The length of the next step and its cause; the least speed of sound, the speed limit of a vertex; whether steps collapse."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.physics import waves

#: vertices may be this many times faster than the fastest body at the start, or than the slowest wave
SPEED_LIMIT_FACTOR = 5.0
#: least speed of sound as a share of the speeds of a shot, and the largest square of it, (m/s)^2
SOUND_SHARE, SOUND_MOST = 1e-2, 1.0
#: cause of a step that only grows from the one before
GROWTH = "growth"
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


def chosen(cycle) -> tuple[float, str]:
    """The time step, s, and its cause: the term and the cell that set it, the ramp of the first cycles, the growth from step to
    step, or the velocity of an edge."""
    s, g, numerics = cycle.state, cycle.grid, cycle.method.numerics
    j, (cause, i) = int(s.least_row[0]), s.cause
    first = numerics.initial_dt_factor
    ramp = min(1.0, first + (1.0 - first) * cycle.number / max(numerics.ramp_cycles, 1))
    dt, said = float(s.row_step[j]) * ramp, f"{waves.CAUSES[cause]} at r = {g.rc[i] * 1e3:.3f} mm, z = {g.zc[j] * 1e3:.3f} mm"
    if ramp < 1.0:
        said += " (ramp)"
    if cycle.dt > 0.0 and dt > numerics.max_growth * cycle.dt:
        dt, said = numerics.max_growth * cycle.dt, GROWTH
    crossing, edge = cycle.method.boundaries.least_crossing(cycle.edges.widths, cycle.time, cycle.time + dt)
    if dt > numerics.advective_courant * crossing:
        dt, said = numerics.advective_courant * crossing, f"velocity of the edge {edge}"
    return dt, said


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

    def collapse(self, dt: float, cause: str) -> bool:
        """Adds a step, s, with its cause; whether PATIENCE of them were below COLLAPSED times the median.

        A step that only grows is not counted among these: it recovers. After True the count begins again.
        """
        number = math.floor(CLASSES * math.log2(dt))
        self._covered[number] = self._covered.get(number, 0.0) + dt
        self._taken += 1
        if self._taken % PATIENCE == 0:
            self.median = self._middle()
        if dt >= COLLAPSED * self.median:
            self._low = 0
        elif cause != GROWTH:
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
