"""Where compiled code is kept: in a folder that is named by a hash of all that it depends on.

numba's own cache notices an edit of the file that holds a function, not of the files that this one calls. What is compiled of
a file is therefore kept in a folder with a hash of this package, of the file, of all of hydro2d that it imports, itself or
through others, and of the models from outside that it can see: it is never stale, and an edit compiles anew what can see it and
nothing else.
"""

from __future__ import annotations

import ast
import atexit
import functools
import hashlib
import importlib.util
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from types import ModuleType

import numba

from hydro2d.files import replacing
from hydro2d.parsing import parsed

#: this package, and the folder that holds hydro2d, eos and strength
HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
#: folders of which the texts that are written at run time may see all
COMPILED = ("hydro2d/physics", "hydro2d/kernels", "eos", "strength")


@functools.cache
def _source_files() -> frozenset[Path]:
    """Every file of the compiled folders, with all that these import."""
    return frozenset().union(*(seen_by(file) for folder in COMPILED for file in (ROOT / folder).glob("**/*.py")))


@functools.cache
def _cache_root() -> str:
    """The folder under which all that is compiled is kept: HYDRO2D_CACHE_DIR, in the user's cache, or a `_private` one.

    What is in it is executed, so it must be nobody else's to write to. An empty variable counts as not set. A relative
    HYDRO2D_CACHE_DIR is the user's own choice of a place below the current directory; a relative XDG_CACHE_HOME counts as not
    set, as its specification asks: it would be a folder of whatever directory a command happens to run in.
    """
    if root := os.environ.get("HYDRO2D_CACHE_DIR"):
        return os.path.abspath(root)
    home = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if not home.is_absolute():
        home = Path.home() / ".cache"
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


def folder_for(files: Iterable[Path], models: Iterable[str] = ()) -> str:
    """The folder for what depends on these files and models from outside: named by a hash of their text."""
    digest = hashlib.sha256(numba.__version__.encode())
    for file in sorted(files):
        digest.update(file.name.encode())
        digest.update(file.read_bytes())
    for model in sorted(models):
        digest.update(model.encode())
    return os.path.join(_cache_root(), digest.hexdigest()[:16])


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


def _files_of(name: str) -> list[Path]:
    """The file of a module of hydro2d, eos or strength and those of the packages around it; none for what is no such module.

    The package hydro2d itself, which hands out the rest on demand, is left out.
    """
    parts = name.split(".")
    if parts[0] not in ("hydro2d", "eos", "strength"):
        return []
    places = [ROOT.joinpath(*parts[: n + 1]) for n in range(parts[0] == "hydro2d", len(parts))]
    return [file for place in places for file in (place.with_suffix(".py"), place / "__init__.py") if file.is_file()]


@functools.cache
def seen_by(file: Path) -> frozenset[Path]:
    """A file, those of this package, and every other file of ours that it imports, itself or through others.

    Models are chosen by lists of names: who sees the `dispatch` of `eos` or `strength` sees all of the folder.
    """
    found, waiting = set(HERE.glob("*.py")), [file]
    while waiting:
        each = waiting.pop()
        if each in found:
            continue
        found.add(each)
        waiting += _imported(each)
        if each.stem == "dispatch":
            waiting += each.parent.glob("*.py")
    return frozenset(found)


@functools.cache
def folder_of(file: str) -> str:
    """The folder for what is compiled of a file."""
    path = Path(file).resolve()
    if ROOT not in path.parents:
        return all_folder()
    seen = seen_by(path)
    return folder_for(seen, [model for package, models in _added.items() if ROOT / package / "dispatch.py" in seen
                             for model in models])


@functools.cache
def all_folder() -> str:
    """The folder for what depends on all sources and all models from outside."""
    return folder_for(_source_files(), [model for models in _added.values() for model in models])


#: names of the models from outside, by the package whose `dispatch` chooses among them
_added: dict[str, set[str]] = {"eos": set(), "strength": set()}


def add_model(package: str, name: str) -> bool:
    """Adds a model from outside to what the `dispatch` of a package sees; False where that is loaded without it already.

    name : of the model's module, as `module_of` makes it: it has a hash of the text
    """
    if name in _added[package]:
        return True
    if f"{package}.dispatch" in sys.modules:
        return False
    _added[package].add(name)
    folder_of.cache_clear()
    all_folder.cache_clear()
    return True


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
