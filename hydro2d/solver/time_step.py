"""The length of the next step and its cause; the speed limit of a vertex."""

from __future__ import annotations

import numpy as np

from hydro2d.physics import waves

#: vertices may be this many times faster than the fastest body at the start, or than the slowest wave
SPEED_LIMIT_FACTOR = 5.0


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
