"""Recent change of the residual velocity of a projectile, which shows whether it is final at the end of a run."""

from __future__ import annotations

import numpy as np

from hydro2d.measure.penetrator import Passage, Projectile
from hydro2d.output.history import Columns

VELOCITY, CHANGE, OVER = "rod_residual_velocity_m_s", "residual_velocity_change_m_s", "residual_velocity_change_over_s"


def change(columns: Columns, exits: list[Passage], measured: Projectile | None, time: float) -> dict[str, float | None]:
    """The two keys of a summary at the end, from the rows of the history and the time of perforation of the last target.

    exits : the passages through the targets;  measured : the projectile, if there is one;  time : of the end, s
    """
    velocity = measured and measured.rod_residual_velocity_m_s
    rows = columns.some(("time", VELOCITY))
    if velocity is None or VELOCITY not in rows:
        return {CHANGE: None, OVER: None}
    known = np.isfinite(rows[VELOCITY])
    times, velocities = rows["time"][known], rows[VELOCITY][known]
    if exits and exits[-1].exit_time_s is not None and exits[-1].exit_velocity_m_s is not None:
        times = np.append(exits[-1].exit_time_s, times)
        velocities = np.append(exits[-1].exit_velocity_m_s, velocities)
    began = time - measured.rod_initial_radius_m / abs(velocity) if velocity else -np.inf
    before = times[times < time]
    if not before.size:
        return {CHANGE: None, OVER: None}
    number = max(int(np.searchsorted(before, began, side="right")) - 1, 0)
    return {CHANGE: velocity - float(velocities[number]), OVER: time - float(before[number])}
