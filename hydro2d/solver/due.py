"""Outputs that are due at intervals."""

from __future__ import annotations

import math


class Due:
    """Output times k interval, k = 0, 1, ...: due at the first cycle at or after each; several at once count as one."""

    def __init__(self, interval: float):
        self.interval, self.count = interval, 0

    @property
    def next(self) -> float:
        """The time at which the next output is due, s."""
        return self.count * self.interval

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
