"""Chooses the fastest number of threads for a run, up to the maximum.

Threads wait for each other dozens of times a cycle. On a small mesh, a second thread gains nothing. If another process uses a
core, each of these waits lasts until the operating system lets the second thread run again. The results do not depend on
the number of threads, so a run may change it between any two cycles.
"""

from __future__ import annotations

import statistics
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hydro2d import jit
from hydro2d.base.errors import Error
from hydro2d.base.terminal import several

#: calls of compiled code, of a few cycles each, in a trial for each number of threads
TRIAL = 5
#: the next trial comes after this many times the duration of the last one, and after at least this many seconds
REST, LEAST = 20.0, 2.0
#: it comes after this fraction of that interval if the median of this many calls exceeds that of the trial by this factor
EARLY, LATE, SLOWER = 0.25, 20, 1.5


class ThreadsError(Error):
    """A number of threads that this process cannot use; the message is for the user."""


@contextmanager
def at_most(threads: int | None) -> Iterator[None]:
    """Uses at most this many threads within the block; None: as many as before. Raises ThreadsError."""
    if threads is None:
        yield
        return
    if not 1 <= threads <= jit.max_threads():
        raise ThreadsError(f"threads = {threads}: this process can use from 1 to {jit.max_threads()}; the environment variable "
                           "NUMBA_NUM_THREADS sets the largest number before hydro2d is imported")
    before = jit.threads()
    jit.set_threads(threads)
    try:
        yield
    finally:
        jit.set_threads(before)


class Team:
    """Chooses the number of threads from the duration of cycles.

    At intervals, a trial runs some cycles with each candidate: all threads, a half and a quarter of them, and one. The number
    with the shortest median is used until the next trial.

    Parameters
    ----------
    most : int, the largest number of threads
    use : sets the number of threads
    clock : returns seconds

    Attributes
    ----------
    threads : int, the number in use
    cycles : dict, the cycles run with each number of threads
    """

    def __init__(self, most: int, use: Callable[[int], None] = jit.set_threads, clock: Callable[[], float] = time.perf_counter):
        self.most, self._use, self._clock = most, use, clock
        self.threads, self.cycles = most, {}
        self._options = sorted({most, most // 2, most // 4, 1} - {0}, reverse=True)
        self._trial: dict[int, list[float]] = {n: [] for n in self._options}
        self._recent: deque[float] = deque(maxlen=LATE)
        self._tried, self._expected, self._early, self._until = 0.0, 0.0, 0.0, 0.0

    def run(self, cycles: Callable[[], int]) -> int:
        """Runs cycles with the best number of threads of the last trial, or the next of this one. Returns how many it were.

        cycles : runs some and returns their number
        """
        if self._trial:
            self._set(next(n for n in self._options if len(self._trial[n]) < TRIAL))
        before = self._clock()
        done = cycles()
        self.cycles[self.threads] = self.cycles.get(self.threads, 0) + done
        self._observe(self._clock() - before, done)
        return done

    def thread_use(self) -> str:
        """Text such as '2 threads in 93 % of the cycles, 1 in 7 %'; empty for a run on one thread."""
        if self.most == 1 or not self.cycles:
            return ""
        total = sum(self.cycles.values())
        first, *rest = sorted(self.cycles, key=self.cycles.get, reverse=True)
        share = {n: f"{100.0 * count / total:.0f} %" for n, count in self.cycles.items()}
        leading = f"{several(first, 'thread')} in {share[first]} of the cycles"
        return ", ".join([leading, *(f"{n} in {share[n]}" for n in rest)])

    def all(self) -> None:
        """Returns to all threads."""
        self._set(self.most)

    def _set(self, threads: int) -> None:
        if threads != self.threads:
            self._use(threads)
            self.threads = threads

    def _observe(self, seconds: float, done: int) -> None:
        if self._trial:
            self._trial[self.threads].append(seconds / done)
            self._tried += seconds
            if all(len(times) == TRIAL for times in self._trial.values()):
                self._decide()
            return
        self._recent.append(seconds / done)
        slow = len(self._recent) == LATE and statistics.median(self._recent) > SLOWER * self._expected
        if self._clock() >= (self._early if slow else self._until):
            self._trial = {n: [] for n in self._options}

    def _decide(self) -> None:
        medians = {n: statistics.median(times) for n, times in self._trial.items()}
        self._set(min(medians, key=medians.get))
        rest, self._tried = max(REST * self._tried, LEAST), 0.0
        now = self._clock()
        self._expected, self._early, self._until = medians[self.threads], now + EARLY * rest, now + rest
        self._recent.clear()
        self._trial = {}
