"""The repository's own source, read and parsed, for the rules to check."""

from __future__ import annotations

import ast
import functools
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path

from hydro2d.files.toml import is_study

ROOT = Path(__file__).resolve().parents[2]
PROBLEMS = ROOT / "problems"
PACKAGES = ("hydro2d", "eos", "strength")


@functools.cache
def problems() -> tuple[list[Path], list[Path]]:
    """The decks and the studies in problems."""
    files = sorted(file for file in PROBLEMS.rglob("*.toml") if file.parent.name != "materials")
    studies = [file for file in files if is_study(tomllib.loads(file.read_text(encoding="utf-8")))]
    return [file for file in files if file not in studies], studies


@functools.cache
def modules() -> dict[str, Path]:
    """Every module of the program: dotted name -> file."""
    files = {}
    for package in PACKAGES:
        for file in sorted((ROOT / package).rglob("*.py")):
            parts = file.relative_to(ROOT).with_suffix("").parts
            files[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = file
    return files


@functools.cache
def tree(file: Path) -> ast.Module:
    """The parsed file."""
    return ast.parse(file.read_text(encoding="utf-8"), str(file))


def _executed(syntax: ast.AST) -> Iterator[ast.AST]:
    """All nodes except those that only a type checker sees: `if TYPE_CHECKING:`."""
    yield syntax
    for node in ast.iter_child_nodes(syntax):
        if not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"):
            yield from _executed(node)


def imports(syntax: ast.AST, known: frozenset[str]) -> Iterator[tuple[str, int]]:
    """Modules that a module imports anywhere, also inside functions, with the line of each; no import is relative.

    ``from package import thing`` counts as package.thing where that is a module of ``known``.
    """
    for node in _executed(syntax):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, node.lineno
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield (inner if inner in known else node.module), node.lineno


def imports_of(name: str) -> list[tuple[str, int]]:
    """Modules that a module of the program imports, with the line of each."""
    return list(imports(tree(modules()[name]), frozenset(modules())))


def functions(syntax: ast.AST, *decorators: str) -> Iterator[ast.FunctionDef]:
    """Functions that carry one of the decorators by its bare name."""
    for node in ast.walk(syntax):
        if isinstance(node, ast.FunctionDef) and any(
            isinstance(mark, ast.Name) and mark.id in decorators for mark in node.decorator_list
        ):
            yield node


def calls(node: ast.AST, *names: str) -> list[ast.Call]:
    """Calls of one of these names below a node of a function or method."""
    return [
        part
        for part in ast.walk(node)
        if isinstance(part, ast.Call)
        and (getattr(part.func, "id", None) in names or getattr(part.func, "attr", None) in names)
    ]


@functools.cache
def tracked_files() -> tuple[Path, ...]:
    """Files under version control that exist in the working tree."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    files = tuple(ROOT / name for name in listed.split("\0") if name)
    return tuple(file for file in files if file.is_file())
