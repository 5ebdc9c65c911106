"""Phases of the step as readable lists, and the compiled functions made from them.

A phase is a list of kernels, in order, with barriers between them (`WAIT`), kernels that one part of the mesh runs alone
(`alone`), and steps that run only if a number is not zero, or is zero (`when`, `unless`). Every kernel takes its arrays and
numbers by name from a `Handle` (`by_name`); a kernel that is used in two places has parameters of its own for the arrays that
differ, which `given` names. From the list the text of a function that calls the kernels is written, as by `by_id`; a thread for
each part of the mesh runs it.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numba

from hydro2d.jit import by_name, recording
from hydro2d.jit.cache import folder_seeing, module_of, seen_by
from hydro2d.jit.calls import _compile, run_parts
from hydro2d.jit.handle import Handle, declared
from hydro2d.jit.options import ONLY_CALLS

#: a barrier: no part continues before all have reached it
WAIT = "wait"
#: arguments of compiled phases: the number of the part, and the address of the handle's table
TYPES = (numba.int64, numba.int64)


@dataclass(frozen=True)
class Run:
    """A kernel of a phase, for all parts or one alone; ``names`` gives the handle's names of own parameters that differ."""

    kernel: object
    alone: bool = False
    names: tuple[tuple[str, str], ...] = ()

    @property
    def takes(self) -> tuple[str, ...]:
        """The names in the handle of the kernel's arguments, in order; "part" is the number of the part."""
        other = dict(self.names)
        return tuple(other.get(name, name) for name in by_name.takes(self.kernel))


@dataclass(frozen=True)
class When:
    """Steps of a phase that run only if the number of this name is not zero, or if it is."""

    name: str
    steps: tuple
    zero: bool = False


def alone(kernel) -> Run:
    """A kernel that one part runs, for all."""
    return Run(kernel, alone=True)


def given(kernel, **names: str) -> Run:
    """A kernel, some of whose own parameters have another name in the handle."""
    return Run(kernel, names=tuple(names.items()))


def when(name: str, *steps) -> When:
    """Steps that run if a number of the handle is not zero."""
    return When(name, _runs(steps))


def unless(name: str, *steps) -> When:
    """Steps that run if a number of the handle is zero."""
    return When(name, _runs(steps), zero=True)


def _runs(steps) -> tuple:
    return tuple(step if isinstance(step, str | Run | When) else Run(step) for step in steps)


def _refuse(steps) -> None:
    """Raises ValueError for steps that make no sense."""
    known = declared()
    for step in steps:
        if isinstance(step, When):
            if known.get(step.name, (None, 1))[1] != 0:
                raise ValueError(f"{step.name} is no number that handles have")
            _refuse(step.steps)
        elif isinstance(step, Run):
            _refuse_kernel(step, set(known))
        elif step != WAIT:
            raise ValueError(f"{step!r} is no step of a phase")


def _refuse_kernel(step: Run, known: set[str]) -> None:
    """Raises ValueError for a kernel that cannot run as intended."""
    if not hasattr(step.kernel, "compiled"):
        raise ValueError(f"{step.kernel!r} is no kernel")
    name = step.kernel.__name__
    for parameter, _ in step.names:
        if parameter not in by_name.own_parameters(step.kernel):
            raise ValueError(f"{name} has no parameter {parameter}")
    for parameter in step.takes:
        if parameter not in known and parameter != "part":
            raise ValueError(f"{name} takes {parameter}, which is no name that handles have")
    if step.alone and "part" in step.takes:
        raise ValueError(f"{name} takes a part: it is not for one alone")
    if not step.alone and "part" not in step.takes:
        raise ValueError(f"{name} takes no part: only one part can run it")


class Phase:
    """A phase of the step, which Python calls with a handle.

    Parameters
    ----------
    name : str
    meaning : str
    steps : kernels, `WAIT`, and the results of `alone`, `given`, `when` and `unless`

    Raises ValueError for a list that makes no sense: names that are not declared, kernels that take no part and are not for one
    alone, or the other way round.

    Attributes
    ----------
    steps : tuple of Run, When and `WAIT`
    compiled : numba's function of the number of the part and the address of the handle's table
    """

    def __init__(self, name: str, meaning: str, *steps):
        self.__name__, self.__doc__ = name, meaning
        self.steps = _runs(steps)
        self._address = 0
        _refuse(self.steps)
        if len({by_name.steers(run.kernel) for run in self.runs()}) > 1:
            raise ValueError(f"{name} has kernels that steer and others, which would see numbers of before or after")

    def runs(self) -> Iterator[Run]:
        """The kernels of the phase, in order."""
        return _all_runs(self.steps)

    @property
    def is_alone(self) -> bool:
        """Whether one part runs all of it."""
        return all(run.alone for run in self.runs())

    @functools.cached_property
    def takes(self) -> frozenset[str]:
        """The names in the handle that the phase uses."""
        kernels = {name for run in self.runs() for name in run.takes if name != "part"}
        return frozenset(kernels | set(_conditions(self.steps)) | {"parts", "gate"})

    @functools.cached_property
    def compiled(self):
        kernels = list(dict.fromkeys(run.kernel for run in self.runs()))
        files = frozenset().union(*(seen_by(Path(kernel.__wrapped__.__code__.co_filename).resolve()) for kernel in kernels))
        module = module_of(f"hydro2d_phase_{self.__name__}", self._text(kernels), folder_seeing(files))
        return getattr(module, self.__name__)

    def _text(self, kernels: list) -> str:
        """The function that calls the kernels."""
        number = {kernel: f"_{k}" for k, kernel in enumerate(kernels)}
        lines = [f'"""{self.__doc__}"""', "", "from hydro2d.jit import wait", "from hydro2d.jit.handle import as_handle",
                 "from hydro2d.jit.phases import compiled_phase"]
        lines += [f"from {kernel.__module__} import {kernel.__name__} as _{k}" for k, kernel in enumerate(kernels)]
        lines += ["", "", "@compiled_phase", f"def {self.__name__}(part, address):", f'    """{self.__doc__}"""',
                  "    w = as_handle(address)", *_lines(self.steps, number, 1), ""]
        return "\n".join(lines)

    def __call__(self, handle: Handle) -> None:
        if recording.is_recording():
            recording.write_down(recording.Call(self.full_name, self.compiled, TYPES))
        elif recording.sees_each_kernel():
            self.as_python(handle)
        else:
            recording.clocked(self.__name__, self._run, handle)

    def _run(self, handle: Handle) -> None:
        run_parts(len(handle.parts) - 1, self.address, handle.address)

    @property
    def address(self) -> int:
        """The address of its compiled code."""
        if not self._address:
            with recording.first_call(self.full_name):
                self._address = self._compiled_address()
        return self._address

    @property
    def full_name(self) -> str:
        """Its name among all compiled functions."""
        return f"hydro2d.{self.__name__}"

    def _compiled_address(self) -> int:
        """Compiles the phase, or takes it from the cache, and gives the address of its code."""
        self.compiled.compile(TYPES)
        overload = self.compiled.overloads[TYPES]
        return overload.library.get_pointer_to_function(overload.fndesc.llvm_cfunc_wrapper_name)

    def as_python(self, handle: Handle, part: int = 0, wait=lambda: None) -> None:
        """Calls one kernel after another for one part; ``wait`` is what a barrier calls."""
        for step in chosen(self.steps, handle):
            if step == WAIT:
                wait()
            elif not step.alone or part == 0:
                kernel = getattr(sys.modules[step.kernel.__module__], step.kernel.__name__)
                own = step.takes[: len(by_name.own_parameters(step.kernel))]
                kernel(*(part if name == "part" else getattr(handle, name) for name in own),
                       *([handle] if by_name.takes_handle(step.kernel) else []))


def compiled_phase(function):
    """Compiles the text of a phase."""
    ONLY_CALLS.add(function)
    return _compile(function)


def _all_runs(steps) -> Iterator[Run]:
    for step in steps:
        if isinstance(step, When):
            yield from _all_runs(step.steps)
        elif step != WAIT:
            yield step


def _conditions(steps) -> Iterator[str]:
    for step in steps:
        if isinstance(step, When):
            yield step.name
            yield from _conditions(step.steps)


def chosen(steps, handle: Handle) -> Iterator:
    """The steps that the numbers of a handle choose."""
    for step in steps:
        if not isinstance(step, When):
            yield step
        elif bool(getattr(handle, step.name)) != step.zero:
            yield from chosen(step.steps, handle)


def _lines(steps, number: dict, depth: int) -> list[str]:
    """The lines of some steps of a phase."""
    at, lines = "    " * depth, []
    for step in steps:
        if step == WAIT:
            lines.append(f"{at}wait(w.gate, w.parts)")
        elif isinstance(step, When):
            lines += [f"{at}if {'not ' if step.zero else ''}w.{step.name}:", *_lines(step.steps, number, depth + 1)]
        else:
            call = f"{number[step.kernel]}({', '.join(name if name == 'part' else f'w.{name}' for name in step.takes)})"
            lines += [f"{at}if part == 0:", f"{at}    {call}"] if step.alone else [f"{at}{call}"]
    return lines
