"""The place of compiled code: a folder named by a hash of everything that the code depends on.

numba's own cache notices an edit of the file that holds a function, but not of the files that this one calls. The compiled
code of a file is therefore kept in a folder with a hash of this package, of the file, of everything in hydro2d that it
imports, directly or through others, of the models from outside that it can see, and of the compiler, its options and the
processor that it compiles for. So it is never stale, and an edit recompiles only code that can see it. `store` has the format.
"""

from __future__ import annotations

import ast
import atexit
import functools
import hashlib
import linecache
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import ModuleType

from hydro2d.base.parsing import executed, parsed
from hydro2d.base.terminal import say
from hydro2d.jit import target

#: this package, and the folder that holds hydro2d, eos and strength
HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
#: folders whose files the texts written at run time may all see
COMPILED = ("hydro2d/physics", "hydro2d/kernels", "eos", "strength")
#: files of this package that do not change code, only where it is kept
NO_CODE = ("cache.py", "compilation.py", "shipped.py", "store.py", "target.py")


@functools.cache
def _source_files() -> frozenset[Path]:
    """Every file of the compiled folders, and all files that these import."""
    return frozenset().union(*(seen_by(file) for folder in COMPILED for file in (ROOT / folder).glob("**/*.py")))


@functools.cache
def root() -> str:
    """The folder for all compiled code: HYDRO2D_CACHE_DIR, in the user's cache, or a `_private` one.

    Its contents are executed, so nobody else may be able to write to it. An empty variable counts as not set. A relative
    HYDRO2D_CACHE_DIR is the user's own choice of a place below the current directory; a relative XDG_CACHE_HOME counts as not
    set, as its specification asks: it would be a folder of any directory in which a command happens to run.
    """
    if chosen := os.environ.get("HYDRO2D_CACHE_DIR"):
        return os.path.abspath(chosen)
    home = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if not home.is_absolute():
        home = Path.home() / ".cache"
    if not os.access(home if home.exists() else home.parent, os.W_OK):
        return _private(os.path.join(tempfile.gettempdir(), f"hydro2d-{_user()}"))
    return str(home / "hydro2d")


def _user() -> int:
    """The number of the user; 0 where users have none, and every file belongs to 0."""
    return os.getuid() if hasattr(os, "getuid") else 0


def _private(folder: str) -> str:
    """The folder, made if need be, if it is the user's alone; else a new one for this process and its children."""
    with suppress(FileExistsError):
        os.mkdir(folder, 0o700)
    status = os.lstat(folder)
    if stat.S_ISDIR(status.st_mode) and status.st_uid == _user() and not status.st_mode & 0o077:
        return folder
    fresh = tempfile.mkdtemp(prefix="hydro2d-")
    atexit.register(shutil.rmtree, fresh, ignore_errors=True)
    os.environ["HYDRO2D_CACHE_DIR"] = fresh
    say_once(f"{folder} is not a private folder of this user: what is compiled is not kept (HYDRO2D_CACHE_DIR names one)")
    return fresh


@functools.cache
def say_once(text: str) -> None:
    """A line on the error output, the first time in this process."""
    with suppress(OSError):  # nobody reads it; the run goes on
        say(f"hydro2d: {text}", file=sys.stderr, flush=True)


@contextmanager
def kept_if_possible() -> Iterator[None]:
    """Says once if the files that the block writes cannot be kept: the disk may be full, or writing is not allowed."""
    try:
        yield
    except OSError as error:
        say_once(f"{root()} cannot be written ({error.strerror or error}): what is compiled is not kept "
                 "(HYDRO2D_CACHE_DIR names another place)")


def folder_for(files: Iterable[Path], models: Iterable[str] = ()) -> str:
    """The folder for code that depends on these files and models from outside: named by a hash of their text."""
    digest = hashlib.sha256(repr(sorted(target.description().items())).encode())
    for name, file in sorted((_relative(file), file) for file in files):
        digest.update(name.encode())
        digest.update(file.read_bytes())
    for model in sorted(models):
        digest.update(model.encode())
    return os.path.join(root(), digest.hexdigest()[:16])


def _relative(file: Path) -> str:
    """The path of a file of hydro2d from the folder that holds it, the same on every machine; of another file, its name."""
    return file.relative_to(ROOT).as_posix() if ROOT in file.parents else file.name


@functools.cache
def _imported(file: Path) -> frozenset[Path]:
    """The files of hydro2d, eos and strength that a file imports, and the packages that they are in."""
    names = set()
    for node in ast.walk(parsed(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return frozenset(there for name in names for there in _files_of(name))


def _packages_around(file: Path) -> list[Path]:
    """The packages of hydro2d, eos or strength that a file is in, except hydro2d itself."""
    if ROOT not in file.parents:
        return []
    return _files_of(".".join(file.parent.relative_to(ROOT).parts))


def _files_of(name: str) -> list[Path]:
    """The file of a module of hydro2d, eos or strength and those of the packages around it; none for other modules.

    The package hydro2d itself, which imports the rest on demand, is left out.
    """
    parts = name.split(".")
    if parts[0] not in ("hydro2d", "eos", "strength"):
        return []
    places = [ROOT.joinpath(*parts[: n + 1]) for n in range(parts[0] == "hydro2d", len(parts))]
    return [file for place in places for file in (place.with_suffix(".py"), place / "__init__.py") if file.is_file()]


@functools.cache
def seen_by(file: Path) -> frozenset[Path]:
    """A file, those of this package, and every other file of hydro2d that it imports, directly or through others.

    The packages around a file count as imported: Python runs them first, and that of the kernels declares the names of handles,
    whose order compiled phases contain. Models are chosen by lists of names: a file that sees the `dispatch` of `eos` or
    `strength` sees all of the folder.
    """
    seen, waiting = {each for each in HERE.glob("*.py") if each.name not in NO_CODE}, [file]
    while waiting:
        each = waiting.pop()
        if each in seen:
            continue
        seen.add(each)
        waiting += [*_imported(each), *_packages_around(each)]
        if each.stem == "dispatch":
            waiting += each.parent.glob("*.py")
    return frozenset(seen)


@functools.cache
def folder_of(file: str) -> str:
    """The folder for the compiled code of a file; for a text made at run time the one that its path names, if any."""
    path = Path(file).resolve()
    if generated(file) is not None and path.parent.parent == Path(root()).resolve():
        return str(path.parent)
    if generated(file) is not None or ROOT not in path.parents:
        return all_folder()
    return folder_seeing(seen_by(path))


def folder_seeing(files: frozenset[Path]) -> str:
    """The folder for code that depends on these files and on the models from outside that they can see."""
    return folder_for(files, [model for package, models in _added.items() if ROOT / package / "dispatch.py" in files
                              for model in models])


@functools.cache
def all_folder() -> str:
    """The folder for code that depends on all sources and all models from outside."""
    return folder_for(_source_files(), [model for models in _added.values() for model in models])


def sources() -> str:
    """A hash of the sources of all processes (those without models from outside) and of all else that code depends on."""
    return os.path.basename(folder_for(_source_files()))


#: names of the models from outside, by the package whose `dispatch` chooses among them
_added: dict[str, set[str]] = {"eos": set(), "strength": set()}


def add_model(package: str, name: str) -> bool:
    """Adds a model from outside for the `dispatch` of a package; False if that has already been loaded without it.

    name : of the model's module, as `module_of` makes it, with a hash of the text
    """
    if name in _added[package]:
        return True
    if f"{package}.dispatch" in sys.modules:
        return False
    _added[package].add(name)
    folder_of.cache_clear()
    all_folder.cache_clear()
    return True


#: texts that were made at run time, by the path that their functions name as their file
_generated: dict[str, str] = {}


def generated(file: str) -> str | None:
    """The text of a file that exists only here; None for any other."""
    return _generated.get(file)


def module_of(stem: str, text: str, folder: str = "") -> ModuleType:
    """The module of a Python text; its name is the stem and a hash of the text. No file is written that could be damaged.

    folder : of the path that tracebacks name; no file exists there
    """
    name = f"{stem}_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    module = ModuleType(name)
    module.__file__ = file = os.path.join(folder or "models", f"{name}.py")
    _generated[file] = text
    linecache.cache[file] = len(text), None, text.splitlines(keepends=True), file
    sys.modules[name] = module
    try:
        executed(text, file, vars(module))
    except BaseException:
        del sys.modules[name]
        raise
    return module
