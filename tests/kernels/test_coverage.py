"""Every kernel, and every function of mixed cells, has a test that calls it by its name."""

import ast

import pytest

from tests.physics.test_coverage import touched
from tests.rules import source

PACKAGE = "hydro2d.kernels"
#: files of which every compiled function has a test of its own: they compute physics, one cell at a time
MIXED = {"cut_cells", "mixed", "mixed_strength", "plastic_return"}
LOOPS = ("kernel", "cell_rows", "vertex_rows", "serial", "threaded")
CALLED = sorted(
    (name.removeprefix(f"{PACKAGE}."), function.name)
    for name, file in source.modules().items()
    if name.startswith(f"{PACKAGE}.")
    for function in source.functions(source.tree(file), *LOOPS, *(("point", "not_inlined", "rowwise")
                                                                  if file.stem in MIXED else ()))
)
FILES = sorted((source.ROOT / "tests" / "kernels").glob("test_*.py"))
TESTED = {pair for file in FILES for pair in touched(source.tree(file), PACKAGE)}


def test_there_are_functions_to_look_for():
    assert {("remap", "sweep_z"), ("sliding", "slip_zones"), ("mixed", "soften")} <= set(CALLED)
    assert ("vertex_forces", "accelerate_row") not in CALLED


@pytest.mark.parametrize(("module", "function"), CALLED)
def test_every_kernel_is_named_in_a_test(module, function):
    assert (module, function) in TESTED, f"no file in tests/kernels uses {PACKAGE}.{module}.{function}"


def test_a_kernel_that_no_test_names_is_found():
    text = f"from {PACKAGE} import remap\nfrom {PACKAGE} import mixed as m\nremap.tidy()\nm.soften()\n"
    assert set(touched(ast.parse(text), PACKAGE)) == {("remap", "tidy"), ("mixed", "soften")}
