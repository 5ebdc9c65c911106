"""Every phase of a cycle and every public name of hydro2d is named in a test."""

import ast
import functools

import pytest

import hydro2d
from hydro2d import jit
from hydro2d.kernels import between_phases, lagrangian_step, remap_step
from hydro2d.measure import tracers
from tests.rules import source

MODULES = lagrangian_step, remap_step, between_phases, tracers
PHASES = sorted(name for module in MODULES for name, value in vars(module).items() if isinstance(value, jit.Phase))


def named(syntax: ast.AST) -> set[str]:
    """The strings of a text, and its attributes and imports with the names before them: `remap.tidy` of `hydro2d.kernels`."""
    found = set()
    for node in ast.walk(syntax):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            found.add(f"{node.value.id}.{node.attr}")
        elif isinstance(node, ast.ImportFrom):
            found |= {f"{node.module.split('.')[-1]}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.add(node.value)
    return found


@functools.cache
def all_named() -> set[str]:
    return set().union(*(named(source.tree(file)) for file in (source.ROOT / "tests").rglob("*.py")))


def test_names_are_found():
    assert {"find_contact", "carry_bodies"} <= set(PHASES)
    text = "from hydro2d.kernels.remap import tidy\nhydro2d.run(['deform'])"
    assert named(ast.parse(text)) == {"remap.tidy", "hydro2d.run", "deform"}


@pytest.mark.parametrize("name", PHASES)
def test_every_phase_is_named_in_a_test(name):
    places = {f"{module.__name__.split('.')[-1]}.{name}" for module in MODULES}
    assert (places | {name}) & all_named()


@pytest.mark.parametrize("name", hydro2d.__all__)
def test_every_public_name_is_named_in_a_test(name):
    assert {f"hydro2d.{name}", f"{hydro2d._PLACES[name].split('.')[-1]}.{name}"} & all_named()
