"""Models from outside: an equation of state, strength or damage model in a user's own file or installed package.

A model is one Python file with the contents of a file in ``eos`` or ``strength``, except an ID. Its text is part of the
resolved deck, so that restarts and workers have it on any machine. It is imported from a copy with a hash of the text in its
name, and compiled with the models of hydro2d if it is known before the kernels are loaded.
"""

from __future__ import annotations

import functools
import hashlib
import re
import traceback
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import metadata, util
from pathlib import Path
from types import ModuleType

import numpy as np

import eos.registry
import strength.registry
from eos.layout import ROW as EOS_ROW
from hydro2d import jit
from hydro2d.base.errors import DeckError
from hydro2d.files.whole import read_text
from hydro2d.materials import form, quantities
from strength.layout import DAMAGE_ROW
from strength.layout import ROW as STRENGTH_ROW

#: IDs of models from outside begin here
FIRST_ID = 1000
#: what numba says of a function that needs memory
NO_OBJECTS = "NRT required but not enabled"


class ModelError(DeckError):
    """A model from outside is wrong, or is registered too late; the message is for its author."""


@dataclass(frozen=True)
class Kind:
    """A part of a material whose model can come from outside.

    models, added : those of hydro2d by name, and those from outside that kernels know;  functions : see eos/registry.py
    with_memory : functions and required ones of a model with internal variables, if they differ
    """

    part: str
    title: str
    package: str
    models: dict[str, ModuleType]
    added: list[ModuleType]
    functions: dict[str, tuple[str, int]]
    required: tuple[str, ...]
    flags: tuple[str, ...]
    length: int
    with_memory: tuple[dict[str, tuple[str, int]], tuple[str, ...]] | None = None

    def interface(self, module: ModuleType) -> tuple[dict[str, tuple[str, int]], tuple[str, ...]]:
        """The functions that a model may have, and those that it must have."""
        if self.with_memory and hasattr(module, "INTERNAL"):
            return self.with_memory
        return self.functions, self.required


_STRENGTH = strength.registry
KINDS = {
    kind.part: kind
    for kind in (
        Kind("eos", "equation of state", "eos", eos.registry.MODELS, eos.registry.ADDED, eos.registry.FUNCTIONS,
             eos.registry.REQUIRED, (), EOS_ROW, (eos.registry.MEMORY_FUNCTIONS, eos.registry.MEMORY_REQUIRED)),
        Kind("strength", "strength model", "strength", _STRENGTH.STRENGTH_MODELS, _STRENGTH.STRENGTH_ADDED,
             _STRENGTH.STRENGTH_FUNCTIONS, _STRENGTH.STRENGTH_REQUIRED, ("CONSTANT_MODULUS", "THERMAL"), STRENGTH_ROW),
        Kind("damage", "damage model", "strength", _STRENGTH.DAMAGE_MODELS, _STRENGTH.DAMAGE_ADDED,
             _STRENGTH.DAMAGE_FUNCTIONS, _STRENGTH.DAMAGE_REQUIRED, ("THERMAL",), DAMAGE_ROW),
    )
}


@dataclass(frozen=True)
class Outside:
    """A model from outside that has passed the checks of its form.

    file : its name in messages and summaries;  text : the whole file
    """

    kind: Kind
    file: str
    text: str
    module: ModuleType

    @property
    def name(self) -> str:
        return self.module.NAME

    def offer(self) -> bool:
        """Adds it to the models that kernels can use. Returns False if they are loaded without it."""
        _offered.setdefault((self.text, self.kind.part), self.file)
        if self.module in self.kind.added:
            return True
        if not jit.add_model(self.kind.package, self.module.__name__):
            return False
        self.kind.added.append(self.module)
        return True

    def require(self, what: str = "") -> Outside:
        """Returns itself. Raises ModelError, beginning with `what`, if the kernels of this process are loaded without it."""
        if not self.offer():
            raise ModelError(
                f"{what}the kernels of this process were loaded without the {self.kind.title} {self.name} of {self.file}; "
                "load the deck, or call hydro2d.register, before kernels are loaded, or start a new process")
        return self

    def row(self, values: Mapping[str, float], *base: object) -> np.ndarray:
        """The row of these parameters, float64[n]; base : further arguments of the model's `row`.

        Raises ValueError for values that the model refuses, ModelError if its `row` fails or returns what kernels cannot read.
        """
        try:
            row = self.module.row(values, *base)
        except (ValueError, KeyboardInterrupt):
            raise
        except BaseException as error:
            raise ModelError(f"{self.file}{raised(error, self.module.__name__, 'row raises')}") from None
        if wrong := form.wrong_row(row, self.kind, values):
            raise ModelError(f"{self.file}: {wrong}")
        return row

    def about(self) -> dict:
        """Its entry in a summary."""
        digest = hashlib.sha256(self.text.encode()).hexdigest()
        return {"kind": self.kind.part, "name": self.name, "file": self.file, "sha256": digest}


#: files of the models that this process has offered, by text and part
_offered: dict[tuple[str, str], str] = {}


def offered() -> list[tuple[str, str, str]]:
    """Text, file and part of these models, for ``take_over`` in another process."""
    return [(text, file, part) for (text, part), file in _offered.items()]


def is_known(text: str, part: str) -> bool:
    """Whether this process has run this text as a model, because the user requested it."""
    return (text, part) in _offered


def take_over(models: Iterable[tuple[str, str, str]]) -> None:
    """Offers the models that another process has ``offered``. A model that comes too late is reported when it is used."""
    for text, file, part in models:
        from_text(text, file, part).offer()


def register(*models: str | Path) -> None:
    """Makes models of your own known: paths of files, or names of models that installed packages offer.

    Loading a deck makes its models known. Call this only if kernels are loaded before the deck, for example because another
    simulation ran first.

    Raises ModelError for a wrong model, or if the kernels are already loaded.
    """
    for model in models:
        offers = [] if Path(model).is_file() else [each for part in KINDS if (each := from_package(part, str(model)))]
        for each in offers or [read(model)]:
            each.require()


def read(path: str | Path, part: str | None = None) -> Outside:
    """The model in a file; `part` is one of KINDS, or None to infer it from the functions. Raises ModelError."""
    path = Path(path)
    text = read_text(path, ModelError)
    part = part or form.part(text, {kind.part: kind.required for kind in KINDS.values()})
    if part is None:
        needed = "; ".join(f"{kind.title}: {' and '.join(kind.required)}" for kind in KINDS.values())
        raise ModelError(f"{path}: has none of the functions that identify a model ({needed})")
    return from_text(text, path.name, part, str(path))


def from_text(text: str, file: str, part: str, place: str | None = None) -> Outside:
    """The model in a text; `file` is its name, `place` its name in messages. Raises ModelError."""
    try:
        return Outside(KINDS[part], file, text, _checked(text, part))
    except ModelError as error:
        raise ModelError(f"{place or file}{error}") from None


def in_packages(part: str) -> dict[str, metadata.EntryPoint]:
    """Entry points of installed packages by the names of their models."""
    return {entry.name: entry for entry in metadata.entry_points(group=f"hydro2d.{part}")}


def from_package(part: str, name: str) -> Outside | None:
    """The model with a name in an installed package; None if there is none. Raises ModelError."""
    entry = in_packages(part).get(name)
    if entry is None:
        return None
    package = f"{entry.dist.name} {entry.dist.version}" if entry.dist else "a package"
    place = f"{entry.module} ({package})"
    try:
        spec = util.find_spec(entry.module)
    except ImportError:
        spec = None
    if spec is None or not spec.origin or not Path(spec.origin).is_file():
        raise ModelError(f"{place}: the entry point {name} names a module that cannot be found")
    model = from_text(Path(spec.origin).read_text(encoding="utf-8"), place, part)
    if model.name != name:
        raise ModelError(f"{place}: the entry point is called {name} and the model {model.name}; the names must be the same")
    return model


# ------------------------------------------------------------------------------------------------ is it in order


@functools.cache
def _checked(text: str, part: str) -> ModuleType:
    """The module of a text, with its ID. Raises ModelError, without the file name at the beginning."""
    kind = KINDS[part]
    module = _module(text, kind)
    fault = form.fault(module, kind)
    if fault is None:
        fault = next((mistake for name in kind.interface(module)[0] if (mistake := _compiled(module, name, kind))), None)
    if fault is not None:
        raise ModelError(f": {fault}")
    digest = hashlib.sha256(f"{part} {text}".encode()).hexdigest()
    module.ID = FIRST_ID + int(digest[:12], 16)
    quantities.declare(getattr(module, "INTERNAL", ()))
    return module


def _module(text: str, kind: Kind) -> ModuleType:
    stem = f"hydro2d_{kind.part}_model"
    try:
        if wrong := form.wrong_import(text, kind.package) or form.wrong_statement(text):
            raise ModelError(f":{wrong[0]}: {wrong[1]}")
        return jit.module_of(stem, text)
    except SyntaxError as error:
        raise ModelError(f":{error.lineno or 1}: is not Python: {error.msg}") from None
    except (ModelError, KeyboardInterrupt):
        raise
    except BaseException as error:  # a model may raise anything, and end the process
        raise ModelError(raised(error, stem, "cannot be imported:")) from None


def _compiled(module: ModuleType, name: str, kind: Kind) -> str | None:
    """Why a function of a model cannot be compiled, or how its return value is wrong; None if there is no fault."""
    arguments, count = kind.interface(module)[0][name]
    if not hasattr(module, name):
        return None
    try:
        types = jit.returns(getattr(module, name), arguments)
    except Exception as error:
        line = re.search(rf'{module.__name__}\.py", line (\d+)', str(error))
        return f"{name} does not compile{f', line {line[1]}' if line else ''}: {_line(error)}"
    if types != ("float64",) * count:
        numbers = {0: "nothing", 1: "one number"}.get(count, f"{count} numbers")
        return f"{name} returns {', '.join(types) or 'nothing'}, not {numbers} (write 1.0, not 1, and return on every path)"
    return None


def line_of(error: BaseException, stem: str) -> int:
    """The last line that an exception passed in the text of a model whose module's name begins with `stem`."""
    frames = traceback.extract_tb(error.__traceback__)
    return [1, *(frame.lineno or 1 for frame in frames if Path(frame.filename).name.startswith(stem))][-1]


def raised(error: BaseException, stem: str, what: str) -> str:
    """":LINE: what EXCEPTION: its message", for an exception in the text of a model whose module's name begins with `stem`."""
    name, said = type(error).__name__, _line(error)
    return f":{line_of(error, stem)}: {what} {name}" + (f": {said}" if said != name else "")


def _line(error: BaseException) -> str:
    """The message of an exception on one line, without the frame that numba adds; its name if it has no message."""
    try:
        said = str(error)
    except Exception:  # raised by an exception of the model's own
        said = ""
    lines = [line.strip() for line in said.splitlines() if line.strip() and not line.startswith("Failed in nopython")]
    return lines[0].replace(NO_OBJECTS, "it makes an array, a list or another object") if lines else type(error).__name__
