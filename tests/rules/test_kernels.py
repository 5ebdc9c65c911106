"""Style of kernels and scalar physics."""

import ast

import pytest

from tests.rules import source

#: decorators of compiled functions; those with a parallel loop
MARKS = ("threaded", "kernel", "cell_rows", "vertex_rows", "serial", "rowwise", "not_inlined", "late_bound", "point")
PARALLEL = {"threaded"}
ALLOCATIONS = ("zeros", "empty", "ones", "full", "array", "zeros_like", "empty_like", "copy", "concatenate")
COMPILED = [
    (file, function)
    for name, file in sorted(source.modules().items())
    if not name.startswith("hydro2d.jit")
    for function in source.functions(source.tree(file), *MARKS)
]

def name_of(case) -> str:
    return f"{case[0].stem}.{case[1].name}"


def parallel_loops(function: ast.FunctionDef) -> list[ast.For]:
    return [node for node in ast.walk(function) if isinstance(node, ast.For) and source.calls(node.iter, "prange")]


def faults(function: ast.FunctionDef) -> list[str]:
    """Faults of a compiled function."""
    wrong = []
    marks = {mark.id for mark in function.decorator_list if isinstance(mark, ast.Name)}
    arguments = function.args
    if not ast.get_docstring(function):
        wrong.append("has no docstring")
    if arguments.defaults or any(default is not None for default in arguments.kw_defaults):
        wrong.append("has default arguments")
    if arguments.vararg or arguments.kwarg:
        wrong.append("takes * or ** arguments")
    loops = parallel_loops(function)
    if marks & PARALLEL:
        if len(loops) != 1 or len(source.calls(function, "prange")) != 1:
            wrong.append(f"has {len(source.calls(function, 'prange'))} prange loops, not one")
        elif loops[0] not in function.body:
            wrong.append("has its prange loop inside another statement")
    elif source.calls(function, "prange"):
        wrong.append("uses prange without being threaded")
    if source.calls(function, "wait"):
        wrong.append("waits: that is for lists of phases")
    if any(isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) for node in ast.walk(function)):
        wrong.append("stores in an attribute")
    if source.calls(function, *ALLOCATIONS):
        wrong.append("allocates")
    if source.calls(function, "print") or any(isinstance(node, (ast.Raise, ast.Assert)) for node in ast.walk(function)):
        wrong.append("prints or raises")
    for node in ast.walk(function):
        if isinstance(node, ast.Subscript) and any(is_negative(index) for index in indices(node)):
            wrong.append(f"has a negative index in line {node.lineno}")
    return wrong


def indices(node: ast.Subscript) -> list[ast.AST]:
    """Plain indices of a subscript, without those inside slices."""
    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    return [part for part in parts if not isinstance(part, ast.Slice)]


def is_negative(index: ast.AST) -> bool:
    return isinstance(index, ast.UnaryOp) and isinstance(index.op, ast.USub) and isinstance(index.operand, ast.Constant)


@pytest.mark.parametrize("mark", MARKS)
def test_there_are_functions_to_look_at(mark):
    assert any(mark in {getattr(name, "id", "") for name in function.decorator_list} for _, function in COMPILED)


@pytest.mark.parametrize("case", COMPILED, ids=name_of)
def test_compiled_functions(case):
    assert faults(case[1]) == [], f"{case[0].relative_to(source.ROOT)}: {case[1].name}, line {case[1].lineno}"


@pytest.mark.parametrize("name", sorted(source.modules()))
def test_numba_options_live_in_one_package(name):
    if name.startswith("hydro2d.jit"):
        return
    words = {"njit", "jit", "vectorize", "guvectorize", "stencil", "fastmath"}
    syntax = source.tree(source.modules()[name])
    used = {getattr(node, "id", getattr(node, "attr", getattr(node, "arg", None))) for node in ast.walk(syntax)}
    imported = {alias.name for node in ast.walk(syntax) if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert (used | imported) & words - ({"jit"} if "jit" in imported else set()) == set()


@pytest.mark.parametrize("name", sorted(source.modules()))
def test_every_module_says_what_it_is(name):
    assert ast.get_docstring(source.tree(source.modules()[name])), "a module starts with a docstring"


GOOD = '''
@kernel
def fill(n, a):
    """Sets a."""
    scale = 2.0
    for j in range(0, n):
        row = a[j]
        for i in range(n):
            row[i] = scale
'''
GOOD_THREADED = GOOD.replace("@kernel", "@threaded").replace("j in range", "j in prange")
BAD = {
    "no docstring": ('    """Sets a."""\n', ""),
    "default argument": ("(n, a)", "(n, a, b=1)"),
    "prange": ("j in range", "j in prange"),
    "prange of the package": ("j in range", "j in jit.prange"),
    "prange inside": ("i in range", "i in prange"),
    "allocation": ("scale = 2.0", "scale = np.zeros(3)"),
    "print": ("scale = 2.0", "print(n)"),
    "waits": ("scale = 2.0", "wait(gate, parts)"),
    "negative index": ("row[i] = scale", "row[-1] = scale"),
    "store in an attribute": ("row[i] = scale", "a.last = scale"),
    "store in an attribute, added": ("row[i] = scale", "a.last += scale"),
    "store in an attribute, in a tuple": ("row[i] = scale", "a.last, scale = 1.0, 2.0"),
}
BAD_THREADED = {
    "no prange": ("prange", "range"),
    "two prange": ("        for i in range(n):", "        for i in prange(n):"),
    "not outermost": ("    for j in prange(0, n):", "    if n > 0:\n     for j in prange(0, n):"),
    "serial": ("@threaded", "@serial"),
    "a row": ("@threaded", "@rowwise"),
    "what is called": ("@threaded", "@not_inlined"),
    "a kernel": ("@threaded", "@kernel"),
}
WRONG = [pytest.param(good, *change, id=f"{what}: {name}")
         for what, good, bad in (
             ("kernel", GOOD, BAD), ("threaded", GOOD_THREADED, BAD_THREADED))
         for name, change in bad.items()]


def only_function(text: str) -> ast.FunctionDef:
    return next(source.functions(ast.parse(text), *MARKS))


@pytest.mark.parametrize("good", [GOOD, GOOD_THREADED], ids=["kernel", "threaded"])
def test_a_good_function_passes(good):
    assert faults(only_function(good)) == []


@pytest.mark.parametrize(("good", "old", "new"), WRONG)
def test_a_bad_function_is_found(good, old, new):
    assert old in good
    assert faults(only_function(good.replace(old, new))) != []


def test_a_kernel_that_waits_is_found():
    """All parts must reach it: only a phase ensures that."""
    assert faults(only_function(GOOD.replace("scale = 2.0", "wait(a, n)"))) != []
