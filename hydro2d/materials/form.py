"""The form of a model's file: the imports that it may have, and the constants and functions that it must have."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Iterator, Mapping
from types import ModuleType

import numpy as np

from eos.layout import RHO0
from hydro2d.base.parameters import SIGNS, Parameter, Required
from hydro2d.base.parsing import parsed
from hydro2d.materials import quantities
from hydro2d.mesh.fields import Field

#: texts that each model has
WORDS = ("NAME", "EQUATION", "SOURCE", "VALIDITY")
#: keys of a model's table in a deck that cannot be parameters
KEYS = ("model", "file", "code", "code_from", "source", "confidence", "note")
#: modules of hydro2d that models use, in addition to those of their own package
GROUND = ("hydro2d.jit", "hydro2d.base.parameters", "hydro2d.mesh.fields")


def part(text: str, required: Mapping[str, tuple[str, ...]]) -> str | None:
    """The part of a material for which a text is a model, by the functions that each part requires; None if there is none."""
    try:
        names = {node.name for node in parsed(text).body if isinstance(node, ast.FunctionDef)}
    except (SyntaxError, MemoryError, RecursionError):
        return next(iter(required))  # its import reports the mistake
    return next((name for name, functions in required.items() if names & set(functions)), None)


def imported(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Names of modules that a file imports, with lines; ``from a import b`` gives a.b, which may be a module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = "." * node.level + (f"{node.module}." if node.module else "")
            yield from ((f"{module}{alias.name}", node.lineno) for alias in node.names)


def wrong_import(text: str, package: str) -> tuple[int, str] | None:
    """Line of the first import that a model of ``package`` must not have, and the reason; None if all are allowed.

    Compiled code is kept by the text of the file alone, and the file is copied alone.
    """
    for name, line in imported(parsed(text)):
        top = name.split(".")[0]
        ours = any(f"{name}.".startswith(f"{place}.") for place in (*GROUND, package))
        choosing = name.split(".")[:2] in ([package, "dispatch"], [package, "radial_return"])
        if choosing or not (ours or top == "numpy" or top in sys.stdlib_module_names):
            allowed = f"numpy, Python's own modules, {', '.join(GROUND)} and modules of {package}"
            return line, f"imports {name}; a model may import {allowed}" + (", but not those that choose" if choosing else "")
    return None


def wrong_statement(text: str) -> tuple[int, str] | None:
    """Line of the first statement in a compiled function of a model that no kernel can execute, and the reason; None if there
    is none."""
    compiled = (each for each in parsed(text).body if isinstance(each, ast.FunctionDef) and each.decorator_list)
    return next(((node.lineno, f"{each.name} {wrong}") for each in compiled for node in ast.walk(each)
                 if (wrong := _impossible(node))), None)


def _impossible(node: ast.AST) -> str:
    """Why a kernel cannot execute a part of a function; empty if it can."""
    if isinstance(node, ast.Raise | ast.Assert):
        return "raises an exception, which a kernel cannot; let it return math.nan, which ends the run as unphysical"
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print":
        return "prints, which a kernel cannot"
    if isinstance(node, ast.Subscript) and not isinstance(node.ctx, ast.Load) and ast.unparse(node.value) == "par":
        return "writes into par, which all cells of the material share"
    return ""


def wrong_row(row: object, kind, values: Mapping[str, float]) -> str | None:
    """How the result of a model's `row` for these parameters differs from what kernels read; None if it does not.

    kind : an outside.Kind
    """
    least = "at least " if kind.part == "eos" else ""
    if not (isinstance(row, np.ndarray) and row.ndim == 1 and row.dtype == np.float64
            and (row.size == kind.length or (least and row.size > kind.length))):
        return (f"row gives {getattr(row, 'dtype', type(row).__name__)} {getattr(row, 'shape', '')}, not float64 "
                f"({least}{kind.length},)")
    if np.isnan(row).any():
        return f"row has NaN in slot {np.isnan(row).argmax()}"
    density = values["reference_density"] if kind.part == "eos" else None
    if density is not None and row[RHO0] != density:
        return f"slot RHO0 = {RHO0} of the row is {row[RHO0]:g}, not reference_density, {density:g}"
    return None


def fault(module: ModuleType, kind) -> str | None:
    """The first mistake in the file of a model, in words; None if there is none. ``kind`` is an outside.Kind."""
    return next((wrong for check in (_constants, _parameters, _functions, _variables) for wrong in check(module, kind)), None)


def _constants(module: ModuleType, kind) -> Iterator[str]:
    for name in WORDS:
        if not isinstance(getattr(module, name, None), str) or not getattr(module, name).strip():
            yield f"needs {name}, a text"
    if module.NAME in kind.models:
        yield f"the NAME {module.NAME!r} is taken by a {kind.title} of hydro2d; give the model another one"
    if not module.NAME.isprintable() or set(module.NAME) & set("/\\\"' "):
        yield f"the NAME {module.NAME!r} has blanks, slashes or quotation marks"
    for name in kind.flags:
        if not isinstance(getattr(module, name, None), bool):
            yield f"needs {name}, True or False"


def _parameters(module: ModuleType, kind) -> Iterator[str]:
    given = getattr(module, "PARAMETERS", None)
    if not isinstance(given, tuple) or not all(isinstance(entry, Parameter) for entry in given):
        yield "needs PARAMETERS, a tuple of hydro2d.base.parameters.Parameter"
        return
    names = [entry.name for entry in given]
    for entry in given:
        if not isinstance(entry.default, Required | int | float):
            yield f"the default of the parameter {entry.name} is {entry.default!r}, not a number or REQUIRED"
        if entry.sign not in SIGNS:
            yield f"the sign of the parameter {entry.name} is {entry.sign!r}, not one of {', '.join(SIGNS)}"
    for name in names:
        if names.count(name) > 1:
            yield f"has the parameter {name} twice"
        if name in KEYS or not name.isidentifier():
            yield f"has a parameter {name!r}, which cannot be a key of a deck's model"
    if kind.part == "eos" and "reference_density" not in names:
        yield "needs the parameter reference_density, kg/m^3"
    if not callable(getattr(module, "row", None)):
        yield "needs a function row(values), which packs the parameters"


def _functions(module: ModuleType, kind) -> Iterator[str]:
    functions, required = kind.interface(module)
    for name in required:
        if not hasattr(module, name):
            yield f"needs a function {name}({functions[name][0]})"
    for name, (arguments, _) in functions.items():
        function = getattr(module, name, None)
        if function is None:
            continue
        if not hasattr(function, "py_func"):
            yield f"{name} is not compiled: put @point before it"
            return
        parameters = inspect.signature(function.py_func).parameters.values()
        if ", ".join(str(parameter) for parameter in parameters) != arguments:
            yield f"{name} takes ({', '.join(str(parameter) for parameter in parameters)}), not ({arguments})"
        if not function.py_func.__doc__:
            line = function.py_func.__code__.co_firstlineno
            yield (f'{name}, line {line}, has no docstring: write what the function returns and in which unit under its `def`, '
                   'such as """Flow stress, Pa."""')


def _variables(module: ModuleType, kind) -> Iterator[str]:
    given = getattr(module, "INTERNAL", ())
    if not isinstance(given, tuple) or not all(isinstance(entry, Field) for entry in given):
        yield "INTERNAL is a tuple of hydro2d.mesh.fields.Field"
    elif given and kind.part == "damage":
        yield f"has internal variables, which a {kind.title} cannot"
    for entry in given:
        kinds = entry.centring == "body", entry.remap in ("mass", "volume"), entry.parity in (1, -1), entry.name.isidentifier()
        if not all(kinds):
            yield (f'the internal variable {entry.name!r}: centring is "body", remap is "mass" or "volume", parity is 1 or -1, '
                   "and the name is a word of letters, digits and underscores")
        known = quantities.BY_KEY.get(entry.name)
        if known is not None and not known.internal:
            yield f"the internal variable {entry.name} has the name of a field"
        elif known is not None and known.unit != quantities.unit(entry):
            yield f"the internal variable {entry.name} is known in {known.unit or 'no unit'}, not in {entry.unit}"
