"""Every numba option of the code, in one place.

``@point``   a scalar function of physics, inlined by the compiler into the loops that call it
``@apart``   a function that kernels call for what is rare
``@rowwise`` one row of one phase, a piece of kernels
``@kernel``  loops over the mesh, threaded over rows by one outermost ``prange``
``@serial``  loops over a short list, one thread

numba's own cache notices an edit of the file that holds a function, not of the files that this one calls. What is compiled
of a file is therefore kept in a folder with a hash of this file, of all that it imports, and of the models from outside that it
can see: it is never stale, and an edit compiles anew what can see it and nothing else.
"""

from __future__ import annotations

import ast
import atexit
import functools
import hashlib
import importlib.util
import inspect
import os
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import llvmlite.binding
import numba
from numba.core import caching
from numba.parfors import parfor_lowering

from hydro2d.files import replacing, turn


def _source_files() -> list[Path]:
    """Every Python file whose text can end up in a compiled kernel."""
    here = Path(__file__).resolve().parent
    folders = [here / "physics", here / "kernels", here.parent / "eos", here.parent / "strength"]
    modules = sorted(file for folder in folders for file in folder.glob("**/*.py"))
    alone = [here / name for name in ("parameters.py", "mesh/fields.py", "mesh/grid.py", "materials/rows.py")]
    return [Path(__file__).resolve(), *alone, *modules]


@functools.cache
def _cache_root() -> str:
    """The folder under which all that is compiled is kept: HYDRO2D_CACHE_DIR, in the user's cache, or a `_private` one.

    What is in it is executed, so it must be nobody else's to write to.
    """
    root = os.environ.get("HYDRO2D_CACHE_DIR")
    if root is not None:
        return root
    home = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    if not os.access(home if home.exists() else home.parent, os.W_OK):
        return _private(os.path.join(tempfile.gettempdir(), f"hydro2d-{os.getuid()}"))
    return str(home / "hydro2d")


def _private(folder: str) -> str:
    """The folder, made if need be, if it is the user's own alone; else a new one for this process and what it starts."""
    with suppress(FileExistsError):
        os.mkdir(folder, 0o700)
    found = os.lstat(folder)
    if stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o077:
        return folder
    fresh = tempfile.mkdtemp(prefix="hydro2d-")
    atexit.register(shutil.rmtree, fresh, ignore_errors=True)
    os.environ["HYDRO2D_CACHE_DIR"] = fresh
    print(f"hydro2d: {folder} is not a private folder of this user: what is compiled is not kept (HYDRO2D_CACHE_DIR names one)",
          file=sys.stderr)
    return fresh


def _folder_for(files: Iterable[Path], models: Iterable[str] = ()) -> str:
    """The folder for what depends on these files and models from outside: named by a hash of their text."""
    digest = hashlib.sha256(numba.__version__.encode())
    for file in sorted(files):
        digest.update(file.name.encode())
        digest.update(file.read_bytes())
    for model in sorted(models):
        digest.update(model.encode())
    return os.path.join(_cache_root(), digest.hexdigest()[:16])


@functools.cache
def _imported(file: Path) -> frozenset[str]:
    """Names of the modules that a file imports, and of what it imports from them, which may be modules."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return frozenset(names)


@functools.cache
def _sources() -> dict[str, Path]:
    """The source files by the names of their modules."""
    root = Path(__file__).resolve().parent.parent
    return {".".join(file.relative_to(root).with_suffix("").parts): file for file in _source_files()}


@functools.cache
def _seen_by(file: Path) -> frozenset[Path]:
    """A source file, this one, and every other source that it imports, itself or through others.

    Models are chosen by lists of names: who sees the `dispatch` of `eos` or `strength` sees all of the folder.
    """
    sources, found, waiting = _sources(), {Path(__file__).resolve()}, [file]
    while waiting:
        each = waiting.pop()
        if each in found:
            continue
        found.add(each)
        names = _imported(each)
        folders = {each.parent.name} if each.stem == "dispatch" else set()
        waiting += [there for name, there in sources.items() if name in names or name.split(".")[0] in folders]
    return frozenset(found)


@functools.cache
def _folder_of(file: str) -> str:
    """The folder for what is compiled of a file."""
    path = Path(file).resolve()
    if path not in _sources().values():
        return CACHE_FOLDER
    seen = _seen_by(path)
    return _folder_for(seen, [model for package, models in _added.items() if _sources()[f"{package}.dispatch"] in seen
                              for model in models])


def add_model(package: str, name: str) -> bool:
    """Adds a model from outside to what the `dispatch` of a package sees; False where that is loaded without it already.

    name : of the model's module, as `module_of` makes it: it has a hash of the text
    """
    global CACHE_FOLDER
    if name in _added[package]:
        return True
    if f"{package}.dispatch" in sys.modules:
        return False
    _added[package].add(name)
    _folder_of.cache_clear()
    CACHE_FOLDER = _folder_for(_source_files(), [model for models in _added.values() for model in models])
    return True


def _compile(function, **options):
    """numba's compilation, with the cache in the folder that belongs to the function's file."""
    numba.config.CACHE_DIR = _folder_of(function.__code__.co_filename)
    return numba.njit(function, **{**_COMMON, **options})


#: names of the models from outside, by the package whose `dispatch` chooses among them
_added: dict[str, set[str]] = {"eos": set(), "strength": set()}
#: for what depends on all sources
CACHE_FOLDER = _folder_for(_source_files())
numba.config.THREADING_LAYER = "omp"

# rows are views into a dozen arrays: the loops are vectorised only if that many checks that they do not overlap are allowed
llvmlite.binding.set_option("hydro2d", "-vectorize-memory-check-threshold=1024")

#: without NRT numba counts no references to arrays. Nothing here makes or keeps one, and the counts, atomic operations around
#: each call, took a third of the time of a shot with contact
_COMMON = {"cache": True, "error_model": "numpy", "fastmath": False, "nogil": True, "_nrt": False}

#: wall seconds and calls per kernel name, filled while `profiling(True)` is on
timings: dict[str, list[float]] = {}
_profiling = False


def profiling(on: bool) -> None:
    """Switches the timing of kernels on or off and forgets what was measured."""
    global _profiling
    _profiling = on
    timings.clear()


def _arguments_apart() -> None:
    """Tells numba that the arrays that a kernel is given do not overlap, as a test asserts of every call.

    numba takes it for granted only where a kernel makes no view of a view. Without it every vector loop is preceded by
    hundreds of comparisons of addresses, a tenth of the time of a cycle.
    """
    create = parfor_lowering._create_gufunc_for_parfor_body
    signature = inspect.signature(create)

    @functools.wraps(create)
    def without_aliases(*arguments, **named):
        bound = signature.bind(*arguments, **named)
        bound.arguments["has_aliases"] = False
        return create(*bound.args, **bound.kwargs)

    parfor_lowering._create_gufunc_for_parfor_body = without_aliases


_arguments_apart()


def _one_writes_at_a_time() -> None:
    """Lets one process at a time add to a folder of numba's cache: two at once can give one name to two functions."""
    save = caching.IndexDataCacheFile.save

    @functools.wraps(save)
    def alone(self, key, data):
        with turn(Path(self._cache_path) / "saving.lock"):
            save(self, key, data)

    caching.IndexDataCacheFile.save = alone


_one_writes_at_a_time()


def rowwise(function):
    """A piece of kernels: one row of one phase. Its text becomes part of each kernel that calls it."""
    return _compile(function, inline="always")


def point(function):
    """Compiles a scalar function of physics."""
    return _compile(function, forceinline=True)


def apart(function):
    """Compiles a function that is called, not inlined: what runs rarely need not be compiled again at every place."""
    return _compile(function)


def modules(package: str, *names: str) -> tuple[ModuleType, ...]:
    """The modules of a package, in order: a list of models."""
    return tuple(importlib.import_module(f"{package}.{name}") for name in names)


def by_id(models: tuple[ModuleType, ...], function: str, arguments: str, meaning: str, otherwise: str = 'float("nan")'):
    """A ``@point`` function ``function(model, arguments)`` that calls the function of this name of the model with that ID.

    A chain of comparisons, written to a file in the cache folder: numba caches neither functions that are put together at run
    time nor those that are handed other functions. Models without the function, and unknown ids, give ``otherwise``.
    """
    ids = [model.ID for model in models]
    for number in ids:
        if ids.count(number) > 1:
            raise ValueError(f"ID {number} belongs to {' and '.join(m.__name__ for m in models if m.ID == number)}")
    models = tuple(model for model in models if hasattr(model, function))
    lines = [f'"""{meaning}"""', "", "from hydro2d.jit import point"]
    lines += [f"from {model.__name__} import {function} as _{k}" for k, model in enumerate(models)]
    lines += ["", "", "@point", f"def {function}(model, {arguments}):", f'    """{meaning}"""']
    for k, model in enumerate(models):
        lines += [f"    if model == {model.ID}:", f"        return _{k}({arguments})"]
    text = "\n".join([*lines, f"    return {otherwise}", ""])
    return getattr(module_of(f"hydro2d_by_id_{function}", text, CACHE_FOLDER), function)


def module_of(stem: str, text: str, folder: str | None = None) -> ModuleType:
    """The module of a Python text, whose name is the stem and a hash of the text: it is written to a file, then imported.

    folder : where the file is kept; default: that of the texts of models from outside
    """
    name = f"{stem}_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    file = Path(folder or os.path.join(_cache_root(), "models")) / f"{name}.py"
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        with replacing(file) as temporary:
            temporary.write_text(text, encoding="utf-8")
            os.utime(temporary, (0, 0))  # numba takes a file with another time for another file
    spec = importlib.util.spec_from_file_location(name, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def returns(function, arguments: str) -> tuple[str, ...]:
    """Compiles a ``@point`` function of a model; the types of the values that it returns, such as ("float64",)."""
    arrays = ("par", "internal")
    types = tuple(numba.float64[::1] if name in arrays else numba.float64 for name in arguments.split(", "))
    function.compile(types)
    found = function.overloads[types].signature.return_type
    if isinstance(found, numba.types.BaseTuple):
        return tuple(map(str, found))
    return () if found == numba.types.none else (str(found),)


@functools.partial(_compile, forceinline=True, fastmath={"reassoc"})
def plus(total, term):
    """total + term, the terms of a loop in any order: what lets the compiler sum in lanes. It hides no NaN."""
    return total + term


@dataclass(frozen=True)
class Call:
    """A kernel and the types of the arguments that it was called with."""

    name: str
    compiled: object
    types: tuple

    def compile(self) -> None:
        """Compiles the kernel for these types, or takes it from the cache, while no other process does."""
        with turn(_kernel_lock(self.name)):
            self.compiled.compile(self.types)


#: calls of kernels, while they are written down and not done
_calls: list[Call] | None = None


@contextmanager
def recorded() -> Iterator[list[Call]]:
    """Within the block kernels do nothing: their calls are written down."""
    global _calls
    _calls = found = []
    try:
        yield found
    finally:
        _calls = None


def _kernel_lock(name: str) -> Path:
    return Path(CACHE_FOLDER) / f"{name}.lock"


def _called(function, compiled):
    """What the rest of the code calls in a kernel's place: timed, written down, and the first time alone of all processes."""
    name, known = f"{function.__module__}.{function.__name__}", False

    @functools.wraps(function)
    def call(*arguments):
        nonlocal known
        if _calls is not None:
            _calls.append(Call(name, compiled, tuple(compiled.typeof_pyval(value) for value in arguments)))
            return None
        start = time.perf_counter()
        if known:
            result = compiled(*arguments)
        else:
            known = True
            with turn(_kernel_lock(name)):
                result = compiled(*arguments)
        if _profiling:
            entry = timings.setdefault(function.__name__, [0.0, 0])
            entry[0] += time.perf_counter() - start
            entry[1] += 1
        return result

    call.compiled = compiled
    return call


def kernel(function):
    """Compiles loops over the mesh whose outermost ``prange`` runs over rows.

    Array views inside the ``prange`` must be assigned one by one: through a tuple (``a, b = x[j], y[j]``) numba 0.68
    loses writes to them, silently. A test holds every kernel against its own source, interpreted.
    """
    return _called(function, _compile(function, parallel=True))


def serial(function):
    """Compiles loops that one thread runs: short lists, boundaries."""
    return _called(function, _compile(function))


prange = numba.prange
set_threads = numba.set_num_threads


def threads() -> int:
    """The number of threads that kernels run on."""
    return numba.get_num_threads()


def max_threads() -> int:
    """The number of threads numba was started with; scratch memory is sized by it."""
    return numba.config.NUMBA_NUM_THREADS
