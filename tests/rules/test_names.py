"""Names are not written only to be passed on: kernels take arrays and numbers from a handle (`hydro2d.jit.by_name`)."""

import ast

import pytest

from tests.rules import source

#: largest number of names in signatures and calls of hydro2d/kernels per line, and of parameters of any function there
MOST_NAMES, MOST_PARAMETERS = 2650 / 6188, 20
KERNELS = [file for name, file in sorted(source.modules().items()) if name.startswith("hydro2d.kernels.")]


def names_in(tree: ast.AST) -> int:
    """Parameters, and arguments that are names."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    arguments = [each for node in ast.walk(tree) if isinstance(node, ast.Call) for each in node.args]
    return sum(len(node.args.args) for node in functions) + sum(isinstance(each, ast.Name) for each in arguments)


def test_names_are_counted():
    assert names_in(ast.parse("def f(part, a, w):\n    g(part, a, w.b, 1.0, w)\n")) == 6


def test_few_names_are_written_to_be_passed_on():
    names = {file.stem: names_in(source.tree(file)) for file in KERNELS}
    lines = sum(len(file.read_text(encoding="utf-8").splitlines()) for file in KERNELS)
    assert sum(names.values()) <= MOST_NAMES * lines, names


@pytest.mark.parametrize("file", KERNELS, ids=lambda file: file.stem)
def test_no_function_has_many_parameters(file):
    counts = {node.name: len(node.args.args) for node in ast.walk(source.tree(file)) if isinstance(node, ast.FunctionDef)}
    assert {name: number for name, number in counts.items() if number > MOST_PARAMETERS} == {}
