"""Actions due after a cycle: outputs at their intervals, and functions that a program passes to a simulation."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base import units

if TYPE_CHECKING:
    from hydro2d.solver.simulation import Simulation


class Due:
    """Output times k interval, k = 0, 1, ...: due at the first cycle at or after each; several at once count as one."""

    def __init__(self, interval: float):
        self.interval, self.count = interval, 0

    def saved(self) -> list:
        """Data for a restart file."""
        return [self.interval, self.count]

    def resume(self, saved: list, time: float) -> None:
        """Continues from data saved at `time`; if the interval has changed since, from the next time of the new one."""
        interval, count = saved
        self.count = count if interval == self.interval else math.floor(time / self.interval) + 1

    def __call__(self, time: float) -> bool:
        """Whether an output is due at `time`; if so, the next one is moved beyond it."""
        if time < self.count * self.interval:
            return False
        self.count = max(math.floor(time / self.interval), self.count) + 1
        if (self.count - 1) * self.interval > time:  # the division was rounded up
            self.count -= 1
        return True


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
