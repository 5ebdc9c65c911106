"""A number of the deck about the method is declared in its section, and stands nowhere else but where it is read."""

import ast

import pytest

from hydro2d.base.method_sections import METHOD_SECTIONS, numbers
from tests.rules import source

KEYS = sorted(key for section in METHOD_SECTIONS for key in numbers(section))
DECLARED = "hydro2d.base.method_sections"
#: what only carries numbers from the deck to kernels
CARRIERS = ("hydro2d.solver.method", "hydro2d.kernels.names")


def written(syntax: ast.AST, key: str) -> int:
    """How often a text has a key as a variable, an attribute, a parameter, a keyword or a word."""
    return sum(key in (getattr(node, "id", None), getattr(node, "attr", None), getattr(node, "arg", None),
                       getattr(node, "value", None)) for node in ast.walk(syntax))


def read(syntax: ast.AST, key: str) -> int:
    """How often a text reads a key of an object."""
    return sum(isinstance(node, ast.Attribute) and node.attr == key for node in ast.walk(syntax))


def readers(key: str, *packages: str) -> dict[str, int]:
    """How often each module of these packages reads a key, those that do."""
    counts = {name: read(source.tree(file), key) for name, file in source.modules().items()
              if name.startswith(packages) and name != DECLARED}
    return {name: count for name, count in counts.items() if count}


def test_numbers_are_found():
    assert {"courant", "ramp_cycles", "active_region", "friction", "max_opening"} <= set(KEYS)
    assert not {"advection", "hard", "yield_factor", "boundary_layer", "tension"} & set(KEYS)


@pytest.mark.parametrize("module", CARRIERS)
def test_what_carries_numbers_names_none(module):
    assert [key for key in KEYS if written(source.tree(source.modules()[module]), key)] == []


@pytest.mark.parametrize("text", ["Method(courant=n[0])", "n.courant", "courant: float", "Work('courant', '', '')",
                                  "def f(courant): ..."])
def test_a_copy_is_found(text):
    assert written(ast.parse(text), "courant") == 1


@pytest.mark.parametrize("key", KEYS)
def test_every_number_is_read(key):
    assert readers(key, "hydro2d.kernels", "hydro2d.solver", "hydro2d.materials"), "a key of the deck that does nothing"


@pytest.mark.parametrize("key", ["viscosity_linear", "viscosity_quadratic"])
def test_a_coefficient_of_viscosity_is_read_for_the_viscosity_and_for_the_step(key):
    assert readers(key, "hydro2d.kernels", "hydro2d.physics", "hydro2d.solver") == {"hydro2d.kernels.cell_viscosity": 2}
