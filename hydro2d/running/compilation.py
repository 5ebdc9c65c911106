"""Announces the compilation of kernels, so that a run which waits for a minute says why."""

from __future__ import annotations

import contextlib
import hashlib
import os
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hydro2d import children, jit
from hydro2d.files import READ_ONLY, turn

EVENT = "numba:compile"
#: seconds between lines that count kernels
COUNT_SECONDS = 5.0
events = jit.compiler_events


class Compilation(events.Listener):
    """Listens to numba. Kernels from the cache are not compiled and are not counted.

    Parameters
    ----------
    say : receives lines;  begins : is called when the first compilation begins
    others : how many kernels there are and how many another process has compiled, see `Second.counts`

    Attributes
    ----------
    seconds, kernels : float, int; time spent so far, and number of functions compiled, without those inlined in others
    """

    def __init__(self, say: Callable[[str], None], begins: Callable[[], None],
                 others: Callable[[], tuple[int, int]] = lambda: (0, 0)):  # fmt: skip
        self.seconds, self.kernels = 0.0, 0
        self._begins, self._others, self._counted = begins, others, 0.0
        self._say, self._told, self._depth, self._start = say, 0.0, 0, 0.0

    def on_start(self, event) -> None:
        """A compilation begins; they nest."""
        if self._depth == 0:
            self._start = time.perf_counter()
            if self.kernels == 0:
                self._say("compiling kernels; this takes about a minute, and later runs reuse them")
                self._begins()
        self._depth += 1

    def on_end(self, event) -> None:
        """A compilation ends."""
        self._depth -= 1
        if self._depth == 0:
            self.seconds += time.perf_counter() - self._start
            self.kernels += 1
            self._count()

    def _count(self) -> None:
        """Says now and then how many kernels are compiled."""
        now = time.perf_counter()
        if self.kernels == 1:
            self._counted = self._start
        if now - self._counted >= COUNT_SECONDS:
            self._counted = now
            whole, others = self._others()
            done = self.kernels + others
            self._say(f"compiling kernels: {min(done, whole)} of {whole}" if whole else f"compiling kernels: {done} so far")

    def report(self) -> None:
        """Reports the time, if anything was compiled since the last report."""
        if self.seconds > self._told:
            what = "kernel" if self.kernels == 1 else "kernels"
            self._say(f"compiled {self.kernels} {what} in {self.seconds:.1f} s")
            self._told = self.seconds


class Second:
    """A second process that compiles the kernels of a deck from last to first, while this process begins with the first.

    Each takes from the cache what the other has compiled, and waits for a kernel that the other is compiling.

    deck : the resolved deck
    """

    def __init__(self, deck):
        self._deck, self._process = deck, None
        self._whole = self._done = 0

    def start(self) -> None:
        """Starts it, if there is a second core."""
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
        if cores < 2 or self._process:
            return
        command = children.python("hydro2d.running.compile_ahead")
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        threading.Thread(target=self._listen, args=(self._process.stdout,), daemon=True).start()
        self._process.stdin.write(self._deck.to_toml().encode())
        self._process.stdin.close()

    def _listen(self, lines) -> None:
        """Reads what it says after every kernel: how many there are that the cache had not, and how many it has compiled."""
        with lines:
            for line in lines:
                with contextlib.suppress(ValueError):
                    self._whole, self._done = (int(word) for word in line.split())

    def counts(self) -> tuple[int, int]:
        """Number of kernels to compile, by all processes, and number of those that it has compiled; zeros if not known."""
        return self._whole, self._done

    def stop(self) -> int | None:
        """Ends it. Returns its exit status if it had failed, else None."""
        if self._process is None:
            return None
        status = self._process.poll()
        if status is None:
            self._process.terminate()
            self._process.wait()
        return status or None


@contextmanager
def announced(say: Callable[[str], None], deck=None) -> Iterator[Compilation]:
    """Reports that kernels are compiled within the block, and at its end how long that took.

    deck : a resolved deck; a second process helps to compile its kernels
    """
    second = Second(deck)
    listener = Compilation(say, second.start if deck else lambda: None, second.counts)
    events.register(EVENT, listener)
    try:
        yield listener
    finally:
        events.unregister(EVENT, listener)
        listener.report()
        if status := second.stop():
            say(f"the second process for compilation failed with exit status {status}; only time was lost")


def _mark(key: str) -> Path:
    """The file that marks the kernels of a kind of deck as cached, for these sources and this processor."""
    name = hashlib.sha256(f"{key} {jit.host_cpu()}".encode()).hexdigest()[:16]
    return Path(jit.all_folder()) / f"{name}.compiled"


def is_compiled(key: str) -> bool:
    """Whether `once` has seen this key."""
    return _mark(key).exists()


def once(key: str, compile: Callable[[], None]) -> None:
    """Calls `compile` unless a process has done so for this key. Of several processes at once, one does and the others wait.

    key : name of the set of kernels
    """
    mark = _mark(key)
    if mark.exists():
        return
    with turn(mark.with_name("compiling.lock")):
        if not mark.exists():
            compile()
            try:
                mark.touch()
            except OSError as error:
                if error.errno not in READ_ONLY:
                    raise
