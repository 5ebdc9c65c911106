"""How kernels and scalar physics are written."""

import ast
import importlib

import pytest

from hydro2d.jit import options
from tests.rules import source

#: decorators of functions that are compiled; those of which a loop is parallel
MARKS = ("phase", "threaded", "kernel", "serial", "rowwise", "apart", "late", "point")
PARALLEL = {"phase", "threaded"}
ALLOCATIONS = ("zeros", "empty", "ones", "full", "array", "zeros_like", "empty_like", "copy", "concatenate")
COMPILED = [
    (file, function)
    for name, file in sorted(source.modules().items())
    if not name.startswith("hydro2d.jit")
    for function in source.functions(source.tree(file), *MARKS)
]

#: names of what a phase may call: by all parts, and by one
KERNELS, SERIAL = ({function.name for file in sorted((source.ROOT / "hydro2d/kernels").glob("*.py"))
                    for function in source.functions(source.tree(file), mark)} for mark in ("kernel", "serial"))


def name_of(case) -> str:
    return f"{case[0].stem}.{case[1].name}"


def parallel_loops(function: ast.FunctionDef) -> list[ast.For]:
    return [node for node in ast.walk(function) if isinstance(node, ast.For) and source.calls(node.iter, "prange")]


def faults(function: ast.FunctionDef) -> list[str]:
    """What is wrong with a compiled function."""
    found = []
    marks = {mark.id for mark in function.decorator_list if isinstance(mark, ast.Name)}
    arguments = function.args
    if not ast.get_docstring(function):
        found.append("has no docstring")
    if arguments.defaults or any(default is not None for default in arguments.kw_defaults):
        found.append("has default arguments")
    if arguments.vararg or arguments.kwarg:
        found.append("takes * or ** arguments")
    loops = parallel_loops(function)
    if marks & PARALLEL:
        if len(loops) != 1 or len(source.calls(function, "prange")) != 1:
            found.append(f"has {len(source.calls(function, 'prange'))} prange loops, not one")
        elif loops[0] not in function.body:
            found.append("has its prange loop inside another statement")
        elif "phase" in marks:
            found += faults_of_places(loops[0]) + faults_beside(loops[0], function)
    elif source.calls(function, "prange"):
        found.append("uses prange without being a phase or threaded")
    if "phase" not in marks and source.calls(function, "wait"):
        found.append("waits without being a phase")
    if any(isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) for node in ast.walk(function)):
        found.append("stores in an attribute")
    if source.calls(function, *ALLOCATIONS):
        found.append("allocates")
    if source.calls(function, "print") or any(isinstance(node, (ast.Raise, ast.Assert)) for node in ast.walk(function)):
        found.append("prints or raises")
    for node in ast.walk(function):
        if isinstance(node, ast.Subscript) and any(is_negative(index) for index in indices(node)):
            found.append(f"has a negative index in line {node.lineno}")
    return found


def faults_of_places(loop: ast.For) -> list[str]:
    """What is wrong with the loop of a phase: it runs over all parts, and does nothing but call, wait and choose."""
    if ast.unparse(loop.target) != "place" or ast.unparse(loop.iter) != "prange(parts.shape[0] - 1)":
        return ["does not loop over the places of all parts"]
    first, *rest = loop.body
    if ast.unparse(first) != "part = int64(place)":
        return ["does not make the place a part first"]
    return [fault for statement in rest for fault in faults_of_statement(statement)]


def faults_of_statement(statement: ast.stmt, some: bool = False, one: bool = False) -> list[str]:
    """What a statement of a phase is but the call of a kernel by all parts, that of a serial function by one, that of `wait` by
    all, and an `if` around such.

    some, one : whether it is for some parts only, and for the first part alone
    """
    where = f"in line {statement.lineno}"
    if isinstance(statement, ast.If):
        found = [f"calls a function {where} to choose" for _ in calls_in(statement.test)]
        some = some or any(getattr(node, "id", "") == "part" for node in ast.walk(statement.test))
        first = one or ast.unparse(statement.test).split(" and ")[-1] == "part == 0"
        return (found + [fault for inner in statement.body for fault in faults_of_statement(inner, some, first)]
                + [fault for inner in statement.orelse for fault in faults_of_statement(inner, some, one)])
    if not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call)):
        return [f"does something other than to call {where}"]
    call = statement.value
    name, arguments = ast.unparse(call.func), [ast.unparse(argument) for argument in call.args]
    if call.keywords or any(calls_in(argument) for argument in call.args):
        return [f"calls by keyword or within a call {where}"]
    if name == "wait":
        return [f"waits elsewhere or not with all parts {where}"] if some or arguments != ["gate", "parts"] else []
    if name.split(".")[-1] in KERNELS:
        return [f"calls {name} for some parts or not for the part {where}"] if some or arguments.count("part") != 1 else []
    if name.split(".")[-1] in SERIAL:
        return [f"calls {name} {where} by more than one part"] if not one or "part" in arguments else []
    return [f"calls {name} {where}, which is neither a kernel nor serial"]


def faults_beside(loop: ast.For, function: ast.FunctionDef) -> list[str]:
    """What is wrong with the statements of a phase beside its loop: they may give names to arrays and numbers."""
    beside = [statement for statement in function.body[1:] if statement is not loop]
    return [f"does something other than to name in line {statement.lineno}" for statement in beside
            if not isinstance(statement, ast.Assign) or calls_in(statement)
            or any(isinstance(node, ast.Subscript) for target in statement.targets for node in ast.walk(target))]


def calls_in(node: ast.AST) -> list[ast.AST]:
    return [part for part in ast.walk(node) if isinstance(part, ast.Call)]


def indices(node: ast.Subscript) -> list[ast.AST]:
    """Plain indices of a subscript, without those inside slices."""
    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    return [part for part in parts if not isinstance(part, ast.Slice)]


def is_negative(index: ast.AST) -> bool:
    return isinstance(index, ast.UnaryOp) and isinstance(index.op, ast.USub) and isinstance(index.operand, ast.Constant)


@pytest.mark.parametrize("mark", MARKS)
def test_there_are_functions_to_look_at(mark):
    assert any(mark in {getattr(name, "id", "") for name in function.decorator_list} for _, function in COMPILED)


def test_what_is_not_optimised_does_nothing_but_call():
    """Every function that LLVM is kept from optimising is a phase, and every phase is kept from it."""
    phases = {(file.stem, function.name) for file, function in COMPILED
              if any(getattr(mark, "id", "") == "phase" for mark in function.decorator_list)}
    for file, _ in phases:
        importlib.import_module(f"hydro2d.kernels.{file}")
    only_calls = {function for function in options.ONLY_CALLS if function.__module__.startswith("hydro2d.kernels.")}
    assert {(function.__module__.split(".")[-1], function.__name__) for function in only_calls} == phases


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
GOOD_PHASE = '''
@phase
def close(parts, n, u, v, gate):
    """Closes cells."""
    low, high = (u, v) if n == 1 else (v, u)
    for place in prange(parts.shape[0] - 1):
        part = int64(place)
        remap.tidy(part, parts, n + 1, low, high[0])
        wait(gate, parts)
        if u.shape[0] > 1 and part == 0:
            contact_velocities.settle(parts, u, v)
        if n == 3:
            wait(gate, parts)
        elif part == 0:
            contact_velocities.settle(parts, v, u)
'''
BAD = {
    "no docstring": ('    """Sets a."""\n', ""),
    "default argument": ("(n, a)", "(n, a, b=1)"),
    "prange": ("j in range", "j in prange"),
    "prange of the package": ("j in range", "j in jit.prange"),
    "prange inside": ("i in range", "i in prange"),
    "allocation": ("scale = 2.0", "scale = np.zeros(3)"),
    "print": ("scale = 2.0", "print(n)"),
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
    "what is called": ("@threaded", "@apart"),
    "a kernel": ("@threaded", "@kernel"),
}
#: a statement of the loop of GOOD_PHASE, with what follows it
STATEMENT = "        wait(gate, parts)\n        if"
BAD_PHASE = {
    "no prange": ("in prange", "in range"),
    "two prange": (STATEMENT, f"        for j in prange(n):\n    {STATEMENT}"),
    "another prange before": ("    low, high", "    for j in prange(n):\n        wait(gate, parts)\n    low, high"),
    "not outermost": ("    for place in prange", "    if n > 0:\n     for place in prange"),
    "not over the parts": ("parts.shape[0] - 1", "parts.shape[0]"),
    "over rows": ("for place in", "for row in"),
    "the number of the place": ("part = int64(place)", "part = place"),
    "stores in an array": (STATEMENT, f"        u[0] = 1.0\n{STATEMENT}"),
    "adds to an array": (STATEMENT, f"        u[0] += 1.0\n{STATEMENT}"),
    "stores before the loop": ("    low, high =", "    u[0], high ="),
    "calls before the loop": ("    low, high =", "    remap.tidy(0, parts, n, u, v)\n    low, high ="),
    "calls for a name": ("(u, v) if n == 1 else (v, u)", "remap.fade(u, v)"),
    "names something": (STATEMENT, f"        low = u\n{STATEMENT}"),
    "allocates": ("high[0])", "np.zeros(3))"),
    "makes a loop": (STATEMENT, f"        for k in range(3):\n    {STATEMENT}"),
    "calls a point": ("remap.tidy(", "remap.fade("),
    "calls what numpy has": ("remap.tidy(", "np.copyto("),
    "calls within a call": ("n + 1", "max(n, 1)"),
    "calls by keyword": ("high[0])", "vof=high[0])"),
    "calls to choose": ("n == 3", "max(n, 3) == 3"),
    "a kernel for the first part": ("remap.tidy(part, parts", "remap.tidy(0, parts"),
    "a kernel for some parts": ("contact_velocities.settle(parts, u, v)", "remap.tidy(part, parts, n, low, high)"),
    "all parts call what is serial": (" and part == 0", ""),
    "another part calls what is serial": ("elif part == 0", "elif part > 0"),
    "others call what is serial": ("elif part == 0", "else"),
    "waits for others": ("wait(gate, parts)\n        if u", "wait(gate, rows)\n        if u"),
    "one part waits": ("contact_velocities.settle(parts, u, v)", "wait(gate, parts)"),
    "the other parts wait": ("        if n == 3:", "        elif n == 3:"),
    "some parts wait": ("if n == 3", "if part < n"),
    "stores in an attribute": (STATEMENT, f"        parts.last = 1\n{STATEMENT}"),
    "stores in an attribute before": ("    low, high =", "    parts.last, high ="),
    "stores where it chooses": ("            wait(gate, parts)\n", "            u[0] = 1.0\n"),
    "returns": ("            wait(gate, parts)\n", "            return\n"),
    "a kernel": ("@phase", "@kernel"),
}
WRONG = [pytest.param(good, *change, id=f"{what}: {name}")
         for what, good, bad in (
             ("kernel", GOOD, BAD), ("threaded", GOOD_THREADED, BAD_THREADED), ("phase", GOOD_PHASE, BAD_PHASE))
         for name, change in bad.items()]


def only_function(text: str) -> ast.FunctionDef:
    return next(source.functions(ast.parse(text), *MARKS))


@pytest.mark.parametrize("good", [GOOD, GOOD_THREADED, GOOD_PHASE], ids=["kernel", "threaded", "phase"])
def test_a_good_function_passes(good):
    assert faults(only_function(good)) == []


@pytest.mark.parametrize(("good", "old", "new"), WRONG)
def test_a_bad_function_is_found(good, old, new):
    assert old in good
    assert faults(only_function(good.replace(old, new))) != []


def test_a_kernel_that_waits_is_found():
    """All parts must come to it: only a phase knows that they do."""
    assert faults(only_function(GOOD.replace("scale = 2.0", "wait(a, n)"))) != []
