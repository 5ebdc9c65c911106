"""Results from outside: numbers that a user's own Python file measures, which the deck names as ``[result.NAME]``.

The file has one class of results and a function that measures them:

    class Rim(Result):
        rim_height_m: Number = result("height of the lip above the face of the plate")

    def measure(sim):
        return Rim(rim_height_m=...)

Names, meanings and units are read from the text without running it. The code runs only where its deck may be run: when it is
loaded with trust, and for every row of a history. Its text is part of the resolved deck.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from hydro2d import jit
from hydro2d.base.parsing import parsed
from hydro2d.base.units import COMMON
from hydro2d.materials.form import imported
from hydro2d.materials.outside import ModelError, line_of, raised
from hydro2d.measure.result import UNITS, Result, is_number, unit

#: packages that a file of results may import, beside Python's own modules
ALLOWED = ("numpy", "scipy", "hydro2d", "eos", "strength")
STEM = "hydro2d_result"
#: words at the end of a name that stand for a unit; in lower case, as people write them
_WORDS = {"".join(filter(str.isalnum, word)).lower() for word in (*COMMON, *UNITS, "mps", "Nm", "kJ", "MJ", "deg")}


@dataclass(frozen=True)
class OwnResult:
    """A file of results that has passed the checks of its form.

    file : its name in messages;  text : the whole file;  lines : the line that declares each result, by name
    """

    file: str
    text: str
    kind: str
    lines: Mapping[str, int]
    line: int

    def trust(self) -> None:
        """Runs the file now and lets simulations run it. Raises ModelError."""
        self.load()
        _trusted.add(self.text)

    def load(self) -> Callable[[Any], Result]:
        """Runs the file and returns its function ``measure``. Raises ModelError."""
        try:
            module = _module(self.text)
        except (KeyboardInterrupt, ModelError):
            raise
        except BaseException as error:  # it may raise anything, and end the process
            raise ModelError(f"{self.file}{raised(error, STEM, 'cannot be imported:')}") from None
        return module.measure

    def measure(self, sim: Any) -> dict[str, float | None]:
        """The results of a simulation by name. Raises ModelError, also for a file that nobody has trusted."""
        if self.text not in _trusted:
            raise ModelError(f"the code of the results in {self.file}, which the deck of the run carries, is not run; "
                             "--trust, in Python trust=True, runs it")
        measure = self.load()
        try:
            found = measure(sim)
        except KeyboardInterrupt:
            raise
        except ValidationError as error:
            first = error.errors()[0]
            raise ModelError(f"{self.file}:{line_of(error, STEM)}: {'.'.join(map(str, first['loc']))} is {first['input']!r}, "
                             "not a number; write float(...), or None without one") from None
        except BaseException as error:
            said = raised(error, STEM, "measure raises")
            raise ModelError(f"{self.file}{said}; correct it, and --restart continues the run") from None
        if type(found).__name__ != self.kind or not isinstance(found, Result):
            raise ModelError(f"{self.file}:{self.line}: measure returns {type(found).__name__}; return {self.kind}(...)")
        for name, line in self.lines.items():
            if found[name] is not None and not is_number(found[name]):
                raise ModelError(f"{self.file}:{line}: {name} is {found[name]}; return None where there is no number")
        return {name: found[name] for name in self.lines}

    def about(self, name: str) -> dict[str, str]:
        """Its entry in a summary; name : in the deck."""
        return {"kind": "result", "name": name, "file": self.file, "sha256": hashlib.sha256(self.text.encode()).hexdigest()}


#: texts that this process may run, because the user has loaded a deck with them
_trusted: set[str] = set()


@functools.cache
def _module(text: str) -> Any:
    return jit.module_of(STEM, text)


@functools.cache
def of_text(text: str, file: str) -> OwnResult:
    """The results that a text declares, without running it. Raises ModelError with file, line and remedy."""
    try:
        tree = parsed(text)
    except SyntaxError as error:
        raise ModelError(f"{file}:{error.lineno or 1}: is not Python: {error.msg}") from None
    except (MemoryError, RecursionError):
        raise ModelError(f"{file}:1: is nested too deep") from None
    if wrong := next(_wrong(tree), None):
        raise ModelError(f"{file}:{wrong[0]}: {wrong[1]}")
    kind, measure = _class(tree)[0], _function(tree)[0]
    lines = {name: field.lineno for name, field in _fields(kind)}
    return OwnResult(file, text, kind.name, lines, measure.lineno)


def _class(tree: ast.Module) -> list[ast.ClassDef]:
    return [node for node in tree.body if isinstance(node, ast.ClassDef)
            and any(ast.unparse(base).split(".")[-1] == "Result" for base in node.bases)]


def _function(tree: ast.Module) -> list[ast.FunctionDef]:
    return [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == "measure"]


def _fields(kind: ast.ClassDef) -> Iterator[tuple[str, ast.AnnAssign]]:
    for node in kind.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id, node


def _wrong(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Line and message of everything that is wrong with the form of a file."""
    for name, line in imported(tree):
        if (top := name.split(".")[0]) not in ALLOWED and top not in sys.stdlib_module_names:
            yield line, f"imports {name}; a file of results may import {', '.join(ALLOWED)} and Python's own modules"
    kinds, functions = _class(tree), _function(tree)
    if len(kinds) != 1:
        last = kinds[-1].lineno if kinds else 1
        yield last, f"has {len(kinds)} classes of results; write one, such as class Rim(Result)"
    if not functions:
        yield 1, "has no function measure(sim); it returns the results of a simulation"
    elif len(functions[-1].args.args) != 1:
        yield functions[-1].lineno, "measure takes one argument, the simulation: write def measure(sim)"
    if kinds and not list(_fields(kinds[0])):
        yield kinds[0].lineno, 'has no results; write one as rim_height_m: Number = result("what it is")'
    for name, field in _fields(kinds[0]) if kinds else ():
        if (declared := ast.unparse(field.annotation)) != "Number":
            yield field.lineno, f"{name} is declared as {declared}; a result of a file is a Number"
        if not (isinstance(field.value, ast.Call) and field.value.args and isinstance(field.value.args[0], ast.Constant)
                and field.value.args[0].value):
            yield field.lineno, f'{name} has no meaning; write {name}: Number = result("what it is")'
        if ending := wrong_ending(name):
            yield field.lineno, (f"{name} ends in {ending}, which no unit of results is written as; numbers are in SI, "
                                 f"and the ending is one of {', '.join(UNITS)}")


def wrong_ending(name: str) -> str:
    """The end of a name that looks like a unit and is none of a result, such as mm or km_s; empty if there is none."""
    parts, known = name.split("_"), unit(name)
    stated = next((ending.count("_") for ending in UNITS if name.endswith(ending)), 0)
    before = parts[-stated - 1] if len(parts) > stated + 1 else ""
    if known != "1" and (before == "per" or before.lower() in _WORDS and before != "in"):
        return "_".join(parts[-stated - 1:])
    return parts[-1] if known == "1" and len(parts) > 1 and parts[-1].lower() in _WORDS else ""
