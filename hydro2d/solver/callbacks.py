"""Functions that a program passes to a simulation, called at intervals."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base import units
from hydro2d.solver.due import Due

if TYPE_CHECKING:
    from hydro2d.solver.simulation import Simulation


def every(interval: int | float | str, call: Callable[[Simulation], object]) -> Callable[[Simulation], None]:
    """A callback for `Simulation.run` that calls a function at intervals instead of after every cycle.

    Parameters
    ----------
    interval : int, float or str
        A whole number counts cycles. A number with a decimal point is a time in s, and text a time with its unit, such as
        ``"1 us"``: the function is called at the first cycle at or after each multiple of it.
    call : function of the simulation
        Its result is ignored.

    Raises ValueError for an interval that is not positive.
    """
    cycles = isinstance(interval, (int, np.integer)) and not isinstance(interval, bool)
    period: float = int(interval) if cycles else units.to_si(interval, "s")
    if not period > 0:
        raise ValueError(f"the interval of a callback must be positive, is {interval!r}")
    due, of = Due(period), None

    def after(sim: Simulation) -> None:
        nonlocal of
        if cycles:
            if sim.cycle % period == 0:
                call(sim)
            return
        if of is not sim:  # the first call for this simulation: earlier times do not count
            of, due.count = sim, math.floor((sim.time - sim.dt) / period) + 1
        if due(sim.time):
            call(sim)

    return after
