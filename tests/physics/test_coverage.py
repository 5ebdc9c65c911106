"""Every scalar function of physics has a test of its own."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.rules import source

HERE = Path(__file__).parent
PACKAGE = "hydro2d.physics"
POINTS = sorted(
    (name.removeprefix(f"{PACKAGE}."), function.name)
    for name, file in source.modules().items()
    if name.startswith(f"{PACKAGE}.")
    for function in source.functions(source.tree(file), "point")
)


def touched(syntax: ast.Module, package: str = PACKAGE) -> Iterator[tuple[str, str]]:
    """(module, function) of a package that a test file names: as ``module.function`` or by importing it."""
    modules = {}
    for node in ast.walk(syntax):
        if isinstance(node, ast.ImportFrom) and node.module == package:
            modules.update({alias.asname or alias.name: alias.name for alias in node.names})
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"{package}."):
            inner = node.module.removeprefix(f"{package}.")
            for alias in node.names:
                modules[alias.asname or alias.name] = f"{inner}.{alias.name}"
                yield inner, alias.name
    for node in ast.walk(syntax):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            yield modules[node.value.id], node.attr


TESTED = {pair for file in HERE.glob("test_*.py") for pair in touched(source.tree(file))}


def test_there_are_functions_to_look_for():
    assert ("contact_faces", "end_apertures") in POINTS


@pytest.mark.parametrize(("module", "function"), POINTS)
def test_every_point_function_has_a_direct_test(module, function):
    assert (module, function) in TESTED, f"no file in tests/physics uses {PACKAGE}.{module}.{function}"


def test_a_function_that_no_test_names_is_found():
    text = f"from {PACKAGE} import contact_faces as c\nfrom {PACKAGE}.waves import impedances\nc.end_apertures(0.0, 0.0)\n"
    assert set(touched(ast.parse(text))) == {("contact_faces", "end_apertures"), ("waves", "impedances")}
