"""The length of the next step and its cause; the least speed of sound, and the speed limit of a vertex."""

from __future__ import annotations

import numpy as np

from hydro2d.physics import waves

#: vertices may be this many times faster than the fastest body at the start, or than the slowest wave
SPEED_LIMIT_FACTOR = 5.0
#: least speed of sound as a share of the speeds of a shot, and the largest square of it, (m/s)^2
SOUND_SHARE, SOUND_MOST = 1e-2, 1.0


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
    s, g, method = cycle.state, cycle.grid, cycle.method
    j, (cause, i) = int(s.least_row[0]), s.cause
    ramp = min(1.0, method.initial_dt_factor + (1.0 - method.initial_dt_factor) * cycle.number / max(method.ramp_cycles, 1))
    dt, said = float(s.row_step[j]) * ramp, f"{waves.CAUSES[cause]} at r = {g.rc[i] * 1e3:.3f} mm, z = {g.zc[j] * 1e3:.3f} mm"
    if ramp < 1.0:
        said += " (ramp)"
    if cycle.dt > 0.0 and dt > method.max_growth * cycle.dt:
        dt, said = method.max_growth * cycle.dt, "growth"
    crossing, edge = method.boundaries.least_crossing(cycle.edges.widths, cycle.time, cycle.time + dt)
    if dt > method.advective_courant * crossing:
        dt, said = method.advective_courant * crossing, f"velocity of the edge {edge}"
    return dt, said
