"""Reports the progress of the compilation of kernels and measures its time.

All waiting before kernels run counts: compilation, and waiting for another process that compiles the same kernel. One line,
"compiling kernels: 14 of 23, 21 s", is updated every second in a `moving.Place`.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import threading
import time
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np

from hydro2d import jit
from hydro2d.base import children, moving
from hydro2d.base.terminal import duration, several
from hydro2d.files.locks import turn
from hydro2d.files.strange import StrangeFile, opened
from hydro2d.files.whole import write_text

COMPILE = "numba:compile"
#: seconds between updates of the line; a first call that takes longer has more to do than read a kernel
BEAT = 1.0
#: most characters of the line that a process which compiles leaves for others
LONGEST_STATE = 1000
events = jit.compiler_events


class Compilation(events.Listener):
    """Listens to first calls of kernels and to numba.

    Parameters
    ----------
    place : where the line is shown
    second : the second process that helps, if there is one
    by_default : whether it is silent while another one listens

    Attributes
    ----------
    happened : bool; whether anything was compiled or waited for. Kernels read from the cache do not count
    """

    def __init__(self, place: moving.Place, second: Second | None = None, by_default: bool = False):
        self.happened = False
        self._place, self._second, self._by_default = place, second, by_default
        self._needed: set[str] = set()
        self._done: set[str] = set()
        self._listed, self._moved, self._reported = True, False, 0.0
        self._seconds, self._start, self._depth = 0.0, 0.0, 0
        self._kernel, self._ended, self._lock = "", threading.Event(), threading.RLock()

    @property
    def seconds(self) -> float:
        """Seconds spent so far in first calls of kernels and in compilations."""
        return self._seconds + (time.perf_counter() - self._start if self._depth else 0.0)

    @property
    def state(self) -> tuple[int, int | None]:
        """Number of kernels compiled so far, by any process, and of all that must be compiled, None if that is not known."""
        return len(self._needed & self._done), len(self._needed) if self._listed else None

    def progress_line(self, doing: str = "compiling") -> str:
        """Line such as "compiling kernels: 14 of 23, 21 s"."""
        done, whole = self.state
        count = f"{done} of {whole}" if whole else f"{done} so far"
        return f"{doing} kernels: {count}, {duration(self.seconds)}"

    def expect(self, names: Collection[str] | None) -> None:
        """Announces the kernels that must be compiled; None: not known."""
        self._listed = self._listed and names is not None
        self._needed |= set(names or ())
        if self._second and len(self._needed) > 1:
            self._second.start(self.done)

    def done(self, name: str) -> None:
        """Counts a kernel as compiled, by this process or by the second one."""
        self._done.add(name)

    def on_start(self, event) -> None:
        """Called when a first call or a compilation begins; these nest."""
        with self._lock:
            self._depth += 1
            if event.kind == jit.FIRST_CALL:
                self._kernel = event.data["kernel"]
            else:
                self.happened = True
                self._needed |= {self._kernel} - {""}
            if self._depth == 1:
                self._start, self._ended = time.perf_counter(), threading.Event()
                threading.Thread(target=self._tick, args=(self._ended,), daemon=True).start()
            if self._moved:
                self._move()

    def on_end(self, event) -> None:
        """Called when it ends."""
        with self._lock:
            if event.kind == jit.FIRST_CALL:
                self.done(event.data["kernel"])
                self._kernel = ""
            if self._depth == 1:
                self._seconds = self.seconds
                self._ended.set()
            self._depth = max(self._depth - 1, 0)
            if self._depth == 0 and self._moved:
                with suppress(OSError):
                    self._place.rest(self.progress_line("compiled"))

    def _tick(self, ended: threading.Event) -> None:
        """Updates the line at every whole second of `seconds`."""
        while not ended.wait(BEAT - self.seconds % BEAT):
            with self._lock:
                self.happened = self.happened or time.perf_counter() - self._start >= BEAT
                if self.happened and not ended.is_set():
                    self._moved = True
                    self._move()

    def _move(self) -> None:
        if self._by_default and len(_listening) > 1:
            return
        done, whole = self.state
        with suppress(OSError):  # nobody reads the output; the next print raises the error
            self._place.move(self.progress_line(), done / whole if whole else None)

    def closing_lines(self) -> list[str]:
        """Lines for the log after the first cycle, once the kernels of a run are compiled. Ends the second process."""
        lines = []
        done, _ = self.state
        if self.happened and done and self.seconds > self._reported:  # a slow load of compiled code is no compilation
            lines.append(f"compiled {several(done, 'kernel')} in {duration(self.seconds, tenths=True)}")
            self._reported = self.seconds
        status = self._second.stop() if self._second else None
        return lines + ([f"the second process for compilation failed with exit status {status}; only time was lost"] if status
                        else [])

    def listen(self) -> None:
        """Begins to listen."""
        _listening.append(self)
        for kind in (COMPILE, jit.FIRST_CALL):
            events.register(kind, self)

    def stop(self) -> None:
        """Ends listening, and the second process."""
        _listening.remove(self)
        for kind in (COMPILE, jit.FIRST_CALL):
            events.unregister(kind, self)
        if self._second:
            self._second.stop()


#: the current listeners
_listening: list[Compilation] = []


class Second:
    """A second process that compiles the kernels of a deck from last to first, while this process begins with the first.

    Each reads from the cache the kernels that the other has compiled, and waits for one that the other is compiling.

    deck : the resolved deck
    """

    def __init__(self, deck):
        self._deck, self._process = deck, None

    def start(self, done: Callable[[str], None]) -> None:
        """Starts the process, if there is a second core. ``done`` gets the name of every kernel that it has compiled."""
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
        if cores < 2 or self._process:
            return
        command = children.python("hydro2d.running.compile_ahead")
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        threading.Thread(target=self._listen, args=(self._process.stdout, done), daemon=True).start()
        with suppress(BrokenPipeError):  # its exit status shows the failure
            self._process.stdin.write(self._deck.to_toml().encode())
            self._process.stdin.close()

    @staticmethod
    def _listen(lines, done: Callable[[str], None]) -> None:
        with lines:
            for line in lines:
                done(line.decode(errors="replace").strip())

    def stop(self) -> int | None:
        """Ends the process. Returns its exit status if it had failed, else None."""
        process, self._process = self._process, None
        if process is None:
            return None
        status = process.poll()
        if status is None:
            process.terminate()
            process.wait()
        return status or None


@contextmanager
def announced(place: moving.Place, helped=None) -> Iterator[Compilation]:
    """Shows a line in a place while kernels are compiled within the block.

    helped : a resolved deck, whose kernels a second process helps to compile
    """
    listener = Compilation(place, Second(helped) if helped else None)
    listener.listen()
    try:
        yield listener
    finally:
        listener.stop()


def expect(key: str, calls: Callable[[], Iterable[jit.Call]]) -> None:
    """Announces the kernels that must be compiled to all listeners; without any, shows a line from here on (`moving.place`).

    key : name of the set of kernels;  calls : lists them, and is called until all of them are in the cache
    """
    if jit.is_recording():
        return
    if not _listening:
        Compilation(moving.place(), by_default=True).listen()
    if is_compiled(key := f"first cycle {key}"):
        return
    names = _missing(calls)
    if names:
        for each in _listening:
            each.expect(names)
    elif names is None:
        for each in _listening:
            each.expect(None)
    else:
        _touch(_mark(key))


def _missing(calls: Callable[[], Iterable[jit.Call]]) -> list[str] | None:
    """Names of the kernels that are not compiled yet; None where they cannot be listed."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return [call.name for call in calls() if not call.is_compiled()]
    except Exception:  # any error may occur before anything is computed; the deck is run next and raises it
        return None


def _mark(key: str) -> Path:
    """The file that marks the kernels of a kind of deck as cached, for these sources and this processor."""
    name = hashlib.sha256(key.encode()).hexdigest()[:16]
    return Path(jit.all_folder()) / f"{name}.compiled"


def _touch(mark: Path) -> None:
    """Makes the file; if it cannot be written, the kernels are listed again each time."""
    with suppress(OSError):
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()


def is_compiled(key: str) -> bool:
    """Whether `once` has seen this key."""
    return os.path.exists(_mark(key))


def once(key: str, compile: Callable[[], None]) -> None:
    """Calls `compile` unless a process has done so for this key. Among several processes, one calls it and the others wait.

    key : name of the set of kernels
    """
    if is_compiled(key):
        return
    mark = _mark(key)
    with turn(mark.with_name("compiling.lock")):
        if not is_compiled(key):
            state = _Shared(_state(key))
            try:
                with announced(state):
                    compile()
            finally:
                state.remove()
            _touch(mark)


class _Shared:
    """A file that shows the state to other processes."""

    def __init__(self, path: Path):
        self._path = path

    def move(self, text: str, share: float | None) -> None:
        write_text(self._path, text)

    def rest(self, text: str) -> None:
        pass

    def remove(self) -> None:
        with suppress(OSError):
            self._path.unlink(missing_ok=True)


def _state(key: str) -> Path:
    return _mark(key).with_suffix(".state")


def progress_of(key: str) -> str:
    """The line of the process that compiles these kernels by `once`, on this machine; empty if none does."""
    with suppress(OSError, UnicodeDecodeError, StrangeFile), opened(_state(key)) as file:
        return file.read(LONGEST_STATE).strip()
    return ""
