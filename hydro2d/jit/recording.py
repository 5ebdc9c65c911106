"""Records of kernel calls: how long they took, and which calls a cycle would make."""

from __future__ import annotations

import functools
import gc
import inspect
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from hydro2d.files.locks import turn
from hydro2d.jit import by_name
from hydro2d.jit.cache import all_folder
from hydro2d.jit.options import compiler_events, is_cached

#: the event of a kernel's first call in a process, in which it is compiled, read from the cache, or waited for while another
#: process compiles it; its data has the name as "kernel"
FIRST_CALL = "hydro2d:first-call"
#: wall seconds and calls by the name of a phase, or of a kernel that Python calls, filled while `profiling(True)` is on
timings: dict[str, list[float]] = {}
_profiling, _each_kernel = False, False


def profiling(on: bool, each_kernel: bool = False) -> None:
    """Switches the timing of phases on or off and discards earlier measurements.

    each_kernel : phases run as Python, on one part of the mesh, so that the clock sees every kernel in them
    """
    global _profiling, _each_kernel
    _profiling, _each_kernel = on, on and each_kernel
    timings.clear()


def sees_each_kernel() -> bool:
    """Whether phases run as Python."""
    return _each_kernel


@dataclass(frozen=True)
class Call:
    """A kernel and the types of the arguments that it was called with."""

    name: str
    compiled: object
    types: tuple

    def compile(self) -> None:
        """Compiles the kernel for these types, or takes it from the cache, while no other process does."""
        with first_call(self.name):
            self.compiled.compile(self.types)

    def is_compiled(self) -> bool:
        """Whether the kernel is compiled for these types, in this process or in the cache."""
        return self.types in self.compiled.overloads or is_cached(self.compiled, self.types)


#: calls of kernels while they are recorded instead of made
_calls: list[Call] | None = None


@contextmanager
def recorded() -> Iterator[list[Call]]:
    """Within the block kernels do nothing: their calls are recorded."""
    global _calls
    _calls = calls = []
    try:
        yield calls
    finally:
        _calls = None


def is_recording() -> bool:
    """Whether calls of kernels are recorded instead of made."""
    return _calls is not None


@contextmanager
def first_call(name: str) -> Iterator[None]:
    """The first call of a kernel in this process, while no other process makes its own; triggers FIRST_CALL."""
    with (compiler_events.trigger_event(FIRST_CALL, data={"kernel": name}), turn(Path(all_folder()) / f"{name}.lock"),
          _without_garbage_collection()):
        yield


@contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Switches off garbage collection, which would search the millions of objects of a compilation again and again."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def write_down(call: Call) -> None:
    """Records a call instead of making it: see `is_recording`."""
    _calls.append(call)


def clocked(name: str, function: Callable, *arguments):
    """Calls a function, timed under this name while `profiling(True)` is on."""
    if not _profiling:
        return function(*arguments)
    start = time.perf_counter()
    result = function(*arguments)
    entry = timings.setdefault(name, [0.0, 0])
    entry[0] += time.perf_counter() - start
    entry[1] += 1
    return result


def called(compiled):
    """A function to call in a kernel's place: timed, recorded, and the first time in one process at a time."""
    function = compiled.__wrapped__
    name = f"{function.__module__}.{function.__name__}"

    def first(*arguments):
        nonlocal run
        with first_call(name):
            result = compiled(*arguments)
        run = compiled if by_name.takes_handle(function) else getattr(compiled, "whole", compiled)
        return result

    run = first

    @functools.wraps(function)
    def call(*arguments):
        if is_recording():
            values = by_name.values(function, arguments)
            return write_down(Call(name, compiled, tuple(compiled.typeof_pyval(value) for value in values)))
        return clocked(function.__name__, run, *arguments) if _profiling else run(*arguments)

    call.__signature__ = inspect.signature(by_name.source(function))
    call.compiled, call._numba_type_ = compiled, compiled._numba_type_  # so that compiled functions can call it
    return call
