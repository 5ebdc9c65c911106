"""Says that kernels are being compiled, when they are: a run that waits for a minute should say why."""

from __future__ import annotations

import fcntl
import hashlib
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hydro2d import jit

EVENT = "numba:compile"
events = jit.numba.core.event


class Compilation(events.Listener):
    """Listens to numba. Kernels that come from the cache are not compiled and count nothing.

    Attributes
    ----------
    seconds, kernels : float, int; spent so far, and on how many functions that were not inlined in another one
    """

    def __init__(self, say: Callable[[str], None]):
        self.seconds, self.kernels = 0.0, 0
        self._say, self._told, self._depth, self._start = say, 0.0, 0, 0.0

    def on_start(self, event) -> None:
        """A compilation begins; they nest."""
        if self._depth == 0:
            self._start = time.perf_counter()
            if self.kernels == 0:
                self._say("compiling kernels; this takes about a minute and is kept for later runs")
        self._depth += 1

    def on_end(self, event) -> None:
        """A compilation ends."""
        self._depth -= 1
        if self._depth == 0:
            self.seconds += time.perf_counter() - self._start
            self.kernels += 1

    def report(self) -> None:
        """Says how long it took, where anything was compiled since it was last said."""
        if self.seconds > self._told:
            what = "kernel" if self.kernels == 1 else "kernels"
            self._say(f"compiled {self.kernels} {what} in {self.seconds:.1f} s")
            self._told = self.seconds


@contextmanager
def announced(say: Callable[[str], None]) -> Iterator[Compilation]:
    """Says so while kernels are compiled within the block, and at its end how long it took."""
    listener = Compilation(say)
    events.register(EVENT, listener)
    try:
        yield listener
    finally:
        events.unregister(EVENT, listener)
        listener.report()


def _mark(key: str) -> Path:
    """The file that says that the kernels of a kind of deck are in the cache: for these sources and this processor."""
    name = hashlib.sha256(f"{key} {jit.llvmlite.binding.get_host_cpu_name()}".encode()).hexdigest()[:16]
    return Path(jit.CACHE_FOLDER) / f"{name}.compiled"


def is_compiled(key: str) -> bool:
    """Whether `once` has seen this key."""
    return _mark(key).exists()


def once(key: str, compile: Callable[[], None]) -> None:
    """Calls `compile` unless some process did for this key; of several that come at once, one does and the others wait.

    numba's cache can be spoilt by processes that compile the same kernels at the same time.

    key : names the set of kernels
    """
    mark = _mark(key)
    if mark.exists():
        return
    mark.parent.mkdir(parents=True, exist_ok=True)
    handle = os.open(mark.with_name("compiling.lock"), os.O_CREAT | os.O_RDWR)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)  # gone with the process that holds it
        if not mark.exists():
            compile()
            mark.touch()
    finally:
        os.close(handle)
