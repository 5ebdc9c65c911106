"""The decorators of compiled functions, and functions that choose among models."""

from __future__ import annotations

import functools
import importlib
import inspect
from types import FunctionType, ModuleType

import numba
import numpy as np

from hydro2d.base.errors import Error
from hydro2d.jit import barrier, by_name, recording, store
from hydro2d.jit.cache import all_folder, folder_of, module_of
from hydro2d.jit.handle import call_at
from hydro2d.jit.options import INNER, OPTIONS
from hydro2d.jit.recording import called
from hydro2d.jit.shipped import places

if numba.config.DISABLE_JIT:
    raise Error("NUMBA_DISABLE_JIT is set, and without compiled code a cycle takes minutes: unset it")


def _compile(function, kept: bool = True, **options):
    """numba's compilation; if the code is kept, it is in the folder that belongs to the function's file."""
    compiled = numba.njit(function, **{**OPTIONS, **options})
    if kept:
        compiled._cache = store.Kept(function, *places(folder_of(function.__code__.co_filename)))
    return compiled


class Inner:
    """A function that compiled code calls: part of the machine code of its callers, with none of its own.

    Python may call it as well; it is then compiled separately and kept in the cache.
    """

    def __init__(self, function, kept: bool = True, **options):
        function = by_name.flat(function)
        functools.update_wrapper(self, function)
        self.__signature__ = inspect.signature(by_name.source(function))
        INNER.add(function)
        self._options = {"kept": kept, **options}
        self.inner = _compile(function, kept=False, no_cpython_wrapper=True, no_cfunc_wrapper=True, **options)
        self._numba_type_ = self.inner._numba_type_

    @functools.cached_property
    def whole(self):
        """The function that Python calls."""
        function = self.__wrapped__
        twin = FunctionType(function.__code__, function.__globals__, function.__name__, function.__defaults__)
        twin.__module__, twin.__qualname__, twin.__doc__ = function.__module__, function.__qualname__, function.__doc__
        return _compile(twin, **self._options)

    def __call__(self, *arguments):
        return self.whole(*by_name.values(self, arguments))

    def __getattr__(self, name: str):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.whole, name)


def rowwise(function):
    """A piece of kernels: one row of one phase. Its text becomes part of each kernel that calls it."""
    return Inner(function, inline="always")


def point(function):
    """Compiles a scalar function of physics."""
    return Inner(function, forceinline=True)


def late_bound(function):
    """`point` for a function that calls functions chosen only when kernels are loaded; it is not kept in the cache by itself.

    The folder of the cache is named when a function is defined, before models from outside are added. Kernels that
    contain such a function are kept as usual.
    """
    return Inner(function, forceinline=True, kept=False)


def not_inlined(function):
    """Compiles a function that is called, not inlined: rarely used code need not be compiled again at every call."""
    return Inner(function)


def modules(package: str, *names: str) -> tuple[ModuleType, ...]:
    """The modules of a package, in order: a list of models."""
    return tuple(importlib.import_module(f"{package}.{name}") for name in names)


def by_id(models: tuple[ModuleType, ...], function: str, arguments: str, meaning: str, otherwise: str = 'float("nan")'):
    """A ``@point`` function ``function(model, arguments)`` that calls the function of this name of the model with that ID.

    A chain of comparisons, written to a file in the cache folder, because numba caches neither functions assembled at run
    time nor those that take other functions. Models without the function, and unknown ids, give ``otherwise``.
    """
    models, lines = _chain(models, function, f"@point\ndef {function}(model, {arguments}):", "point", meaning)
    for k, model in enumerate(models):
        lines += [f"    if model == {model.ID}:", f"        return _{k}({arguments})"]
    text = "\n".join([*lines, f"    return {otherwise}", ""])
    return getattr(module_of(f"hydro2d_by_id_{function}", text, all_folder()), function)


def rows_by_id(models: tuple[ModuleType, ...], function: str, name: str, arguments: str, cells: str, values: str, into: str,
               meaning: str):
    """A ``@rowwise`` function ``name(model, arguments)`` that evaluates a function of the model with that ID in many cells.

    The chain of comparisons is outside the loop over the cells, so the compiler can vectorise the loop.

    cells : the loop, such as "x in range(number)";  values : the arguments of the model's function in a cell;  into : the
    place for its value. Unknown ids give NaN.
    """
    models, lines = _chain(models, function, f"@rowwise\ndef {name}(model, {arguments}):", "rowwise", meaning)
    word = "if"
    for k, model in enumerate(models):
        lines += [f"    {word} model == {model.ID}:", f"        for {cells}:", f"            {into} = _{k}({values})"]
        word = "elif"
    lines += ["    else:", f"        for {cells}:", f'            {into} = float("nan")', ""]
    return getattr(module_of(f"hydro2d_rows_by_id_{name}", "\n".join(lines), all_folder()), name)


def _chain(models: tuple[ModuleType, ...], function: str, head: str, mark: str, meaning: str):
    """The models that have the function, and the first lines of a text that calls them as _0, _1 and so on.

    Raises ValueError for two models with one ID.
    """
    ids = [model.ID for model in models]
    for number in ids:
        if ids.count(number) > 1:
            raise ValueError(f"ID {number} belongs to {' and '.join(m.__name__ for m in models if m.ID == number)}")
    models = tuple(model for model in models if hasattr(model, function))
    lines = [f'"""{meaning}"""', "", f"from hydro2d.jit import {mark}"]
    lines += [f"from {model.__name__} import {function} as _{k}" for k, model in enumerate(models)]
    return models, [*lines, "", "", head, f'    """{meaning}"""']


def returns(function, arguments: str) -> tuple[str, ...]:
    """Compiles a ``@point`` function of a model and gives the types of the values that it returns, such as ("float64",)."""
    arrays = ("par", "internal")
    types = tuple(numba.float64[::1] if name in arrays else numba.float64 for name in arguments.split(", "))
    function.compile(types)
    return_type = function.overloads[types].signature.return_type
    if isinstance(return_type, numba.types.BaseTuple):
        return tuple(map(str, return_type))
    return () if return_type == numba.types.none else (str(return_type),)


@functools.partial(Inner, forceinline=True, fastmath={"reassoc"})
def plus(total, term):
    """total + term, with the terms of a loop in any order, so that the compiler can sum in lanes. It hides no NaN."""
    return total + term


def kernel(function):
    """Compiles loops over the rows of one part of the mesh, for phases to call, each thread with a part of its own.

    The compiler assumes that no two of its arrays overlap; a test checks this for every call.
    """
    return called(Inner(function, noalias=True))


def cell_rows(function):
    """`kernel` for a function of one row of cells, ``function(j, w)``, called for every row of its part."""
    return kernel(by_name.in_rows(function, by_name.CELLS))


def vertex_rows(function):
    """`cell_rows` for rows of vertices, of which the last part has one more."""
    return kernel(by_name.in_rows(function, by_name.VERTICES))


def threaded(function):
    """Compiles loops over the mesh that are not in a phase of the step; their outermost ``prange`` runs over rows."""
    return called(_compile(function, parallel=True))


def serial(function):
    """Compiles loops that one thread runs: short lists, boundaries."""
    return called(Inner(function))


def control(function):
    """`serial` for what stands between the phases of a step: it may set numbers of the handle, ``w.dt = 1e-9``.

    Other functions take numbers as they were when their phase began. A phase with one that steers has no others.
    """
    return serial(by_name.steering(function))


@point
def wait(gate, parts):
    """Makes the threads of a phase, one for each part, wait for one another.

    gate : int64[GATE], the same for all;  parts : int64[number of parts + 1]
    """
    if parts.shape[0] > 2:
        barrier.meet(gate, parts.shape[0] - 1, 0)


prange = numba.prange
#: words of a gate
GATE = barrier.WORDS
set_threads = numba.set_num_threads


def threads() -> int:
    """The number of threads that kernels run on."""
    return numba.get_num_threads()


def max_threads() -> int:
    """The number of threads numba was started with; scratch memory is sized by it."""
    return numba.config.NUMBA_NUM_THREADS


@functools.partial(_compile, parallel=True)
def run_parts(number, function, address):
    """Calls compiled code, at an address, once for each part of the mesh, all at the same time: a phase of the step.

    All phases use this one parallel loop.
    """
    for part in numba.prange(number):
        call_at(function, numba.int64(part), address)


@functools.partial(_compile, parallel=True)
def _all_meet(gate, number, rounds, met):
    for part in numba.prange(number):
        met[part] = barrier.meet(gate, number, rounds)


@functools.cache
def _threads_meet(number: int) -> bool:
    """Whether the turns of a parallel loop run at the same time on this number of threads, as a `phase` needs."""
    met = np.zeros(number, dtype=np.bool_)
    _all_meet(np.zeros(GATE, dtype=np.int64), number, 500, met)
    return bool(met.all())


def parts_at_once() -> int:
    """The number of parts that a `phase` can have: that of threads, or one while each kernel is timed.

    One as well if a loop is not given all its threads at the same time, as a limit of OpenMP (OMP_THREAD_LIMIT) may cause.
    """
    number = 1 if recording.sees_each_kernel() else threads()
    return number if number == 1 or _threads_meet(number) else 1
