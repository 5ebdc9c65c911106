"""The length of a step: the least that a cell allows, a ramp in the first cycles, a bounded growth from step to step."""

from hydro2d.jit import control

#: what has set a step: a cell, the growth from the step before, the velocity of an edge
CELL, GROWTH, EDGE = 0, 1, 2


@control
def choose_step_length(w):
    """The time step, and what has set it.

    Reads    least_row [3]; row_step [j]
    """
    first = w.initial_dt_factor
    ramp = min(1.0, first + (1.0 - first) * w.cycle / max(w.ramp_cycles, 1))
    dt = w.row_step[w.least_row[0]] * ramp
    w.limited_by, w.ramped = CELL, ramp < 1.0
    if w.dt > 0.0 and dt > w.max_growth * w.dt:
        dt = w.max_growth * w.dt
        w.limited_by, w.ramped = GROWTH, False
    w.dt = dt


@control
def begin_step(w):
    """Where the step ends, and how far the mesh travels in it; asks for help if the step is too small or not a number."""
    w.time, w.advance = w.reached + w.dt, w.mesh_speed * w.dt
    w.asks = 0 if w.dt_min < w.dt < 1e300 else 1


@control
def end_step(w):
    """Counts a step that is over, and keeps its length and whether the growth had set it.

    Writes   lengths [n]; grown [n]
    """
    here = w.cycle % w.lengths.shape[0]
    w.lengths[here], w.grown[here] = w.dt, w.limited_by == GROWTH
    w.reached = w.time
    w.cycle += 1


@control
def look_at_clock(w):
    """Asks to leave the tape once a time or a number of cycles is reached."""
    w.asks = 1 if w.reached >= w.until or w.cycle >= w.last_cycle else 0
