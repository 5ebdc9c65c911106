"""Array views in compiled functions are assigned one by one.

Inside ``prange`` numba 0.68 silently loses writes to views that come from a tuple (``a, b = x[j], y[j]``). The rule covers
every compiled loop, so that nobody has to think about where it matters; scalars may come from tuples.
"""

import ast

import pytest

from tests.rules import source

COMPILED = [
    (file, function)
    for name, file in sorted(source.modules().items())
    if not name.startswith("hydro2d.jit")
    for function in source.functions(source.tree(file), "kernel", "cell_rows", "vertex_rows", "serial", "threaded")
]


def views_through_tuples(function: ast.FunctionDef) -> list[int]:
    """Lines in which a literal tuple with an array view in it is assigned.

    A subscript is a view if it has a slice, or fewer indices than the array has elsewhere in the function, or if the
    name that it is given is itself subscripted.
    """
    rank: dict[str, int] = {}
    for node in ast.walk(function):
        if isinstance(node, ast.Subscript) and isinstance(node.value, (ast.Name, ast.Attribute)):
            base = ast.unparse(node.value)
            rank[base] = max(rank.get(base, 0), len(indices(node)))

    def is_view(value: ast.AST, target: ast.AST | None) -> bool:
        if isinstance(value, ast.IfExp):
            return is_view(value.body, target) or is_view(value.orelse, target)
        if isinstance(value, (ast.Tuple, ast.List)):
            names = target.elts if isinstance(target, (ast.Tuple, ast.List)) else [None] * len(value.elts)
            return any(is_view(*pair) for pair in zip(value.elts, names, strict=False))
        if not isinstance(value, ast.Subscript):
            return False
        base = ast.unparse(value.value)
        return (any(isinstance(part, ast.Slice) for part in indices(value)) or len(indices(value)) < rank.get(base, 0)
                or getattr(target, "id", None) in rank)

    return [
        node.lineno
        for node in ast.walk(function)
        if isinstance(node, ast.Assign) and holds_tuple(node.value)
        and any(is_view(node.value, target) for target in node.targets)
    ]


def holds_tuple(value: ast.AST) -> bool:
    if isinstance(value, ast.IfExp):
        return holds_tuple(value.body) or holds_tuple(value.orelse)
    return isinstance(value, (ast.Tuple, ast.List))


def indices(node: ast.Subscript) -> list[ast.AST]:
    return node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]


@pytest.mark.parametrize("case", COMPILED, ids=lambda case: f"{case[0].stem}.{case[1].name}")
def test_no_views_through_tuples(case):
    file, function = case
    assert views_through_tuples(function) == [], f"{file.relative_to(source.ROOT)}: {function.name}"


KERNEL = """
@kernel
def add(n, x, y, z):
    for j in prange(n):
        {line}
        for i in range(n):
            {body}
"""


@pytest.mark.parametrize(("line", "body"), [
    ("a, b = x[j], y[j]", "a[i] = b[i]"),
    ("(a, b), c = (x[0, j], y[j]), 1.0", "a[i] = b[i] + c"),
    ("a, b = x[j, 0:n], y[j, 0:n]", "work(a, b)"),
    ("a, b = (x[j], y[j]) if n > 2 else (y[j], x[j])", "a[i] = b[i]"),
    ("a, b = x[j], y[j]", "work(a, b, x[j, i], y[j, i])"),
    ("a, b = w.x[j], w.y[j]", "work(a, b, w.x[j, i], w.y[j, i])"),
    ("a, b = x[j], 2.0", "a[i] = b"),
])
def test_views_through_tuples_are_found(line, body):
    function = next(source.functions(ast.parse(KERNEL.format(line=line, body=body)), "kernel"))
    assert views_through_tuples(function) == [5]


@pytest.mark.parametrize(("line", "body"), [
    ("a = x[j]", "a[i] = 1.0"),
    ("a, b = x[j], y[j]", "z[i] = a + b"),
    ("a, b = (x[j], y[j]) if n > 2 else (y[j], x[j])", "z[i] = a + b"),
    ("a, b = 2.0 * x[j, 1], y[j, 1] - 1.0", "z[i] = a + b"),
    ("a, b = point(x[j], y[j])", "z[i] = a + b"),
])
def test_scalars_may_come_from_tuples(line, body):
    function = next(source.functions(ast.parse(KERNEL.format(line=line, body=body)), "kernel"))
    assert views_through_tuples(function) == []
