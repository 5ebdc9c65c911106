"""How many threads a run uses: all that it may, while that is faster than one.

Kernels wait for each other some forty times a cycle. Two threads on a small mesh gain nothing by it; where another process
holds a core, every one of these waits lasts until the operating system lets the second thread run again. The results do not
depend on the number of threads, so a run may change it between any two cycles.
"""

from __future__ import annotations

import statistics
import time
from collections import deque
from collections.abc import Callable

from hydro2d import jit

#: cycles of each number of threads in a trial
TRIAL = 5
#: the next trial comes after so many times the seconds of the last one, and after so many seconds at least
REST, LEAST = 20.0, 2.0
#: it comes after this part of the rest if the median of so many cycles is longer than in the last trial, by this factor
EARLY, LATE, SLOWER = 0.25, 20, 1.5


class Team:
    """Chooses the number of threads from the seconds that cycles take.

    Now and then a trial runs a few cycles on every number that comes into question: all threads, a half and a quarter of them,
    and one. The one with the shortest median is used until the next trial.

    Parameters
    ----------
    most : int, the largest number of threads
    use : sets the number of threads
    clock : gives seconds

    Attributes
    ----------
    threads : int, in use now
    cycles : dict, cycles that were run on each number
    """

    def __init__(self, most: int, use: Callable[[int], None] = jit.set_threads, clock: Callable[[], float] = time.perf_counter):
        self.most, self._use, self._clock = most, use, clock
        self.threads, self.cycles = most, {}
        self._options = sorted({most, most // 2, most // 4, 1} - {0}, reverse=True)
        self._trial: dict[int, list[float]] = {n: [] for n in self._options}
        self._recent: deque[float] = deque(maxlen=LATE)
        self._expected, self._early, self._until = 0.0, 0.0, 0.0

    def run(self, cycle: Callable[[], None]) -> float:
        """One cycle, on as many threads as the last trial found best, or as this one asks for; its seconds."""
        if self._trial:
            self._set(next(n for n in self._options if len(self._trial[n]) < TRIAL))
        before = self._clock()
        cycle()
        seconds = self._clock() - before
        self.cycles[self.threads] = self.cycles.get(self.threads, 0) + 1
        self._observe(seconds)
        return seconds

    def told(self) -> str:
        """'2 threads in 93 % of the cycles, 1 in 7 %'; empty for a run on one."""
        if self.most == 1 or not self.cycles:
            return ""
        total = sum(self.cycles.values())
        first, *rest = sorted(self.cycles, key=self.cycles.get, reverse=True)
        share = {n: f"{100.0 * count / total:.0f} %" for n, count in self.cycles.items()}
        told = f"{first} thread{'s' * (first > 1)} in {share[first]} of the cycles"
        return ", ".join([told, *(f"{n} in {share[n]}" for n in rest)])

    def all(self) -> None:
        """Back to all threads."""
        self._set(self.most)

    def _set(self, threads: int) -> None:
        if threads != self.threads:
            self._use(threads)
            self.threads = threads

    def _observe(self, seconds: float) -> None:
        if self._trial:
            self._trial[self.threads].append(seconds)
            if all(len(found) == TRIAL for found in self._trial.values()):
                self._decide()
            return
        self._recent.append(seconds)
        slow = len(self._recent) == LATE and statistics.median(self._recent) > SLOWER * self._expected
        if self._clock() >= (self._early if slow else self._until):
            self._trial = {n: [] for n in self._options}

    def _decide(self) -> None:
        medians = {n: statistics.median(found) for n, found in self._trial.items()}
        self._set(min(medians, key=medians.get))
        rest = max(REST * sum(sum(found) for found in self._trial.values()), LEAST)
        now = self._clock()
        self._expected, self._early, self._until = medians[self.threads], now + EARLY * rest, now + rest
        self._recent.clear()
        self._trial = {}
