"""Functions that take arrays and numbers by their names: written with a handle ``w``, compiled with a parameter for each name.

A function whose last parameter is ``w`` uses ``w.u[b, j, i]`` and ``w.dt``, and calls others like it as ``other(j, i, w)``.
The compiled function has a parameter for every name that it, or a function it calls, uses::

    @kernel                                     @kernel
    def slow_down(part, w):                     def slow_down(part, w__dt, w__parts, w__u):
        for j in range(rows(part, w)):              for j in range(rows(part, w__parts)):
            w.u[0, j, 0] -= w.dt                        w__u[0, j, 0] -= w__dt

So no name is written only to pass it on, yet the names are arguments, and the compiler can assume that their memory does not
overlap. From Python such a function is called with any object that has the names as attributes.

A function that steers (`steering`) may also set numbers, ``w.dt = 1e-9``: it reads and writes them in the handle's table.
"""

from __future__ import annotations

import ast
import functools
import inspect
import linecache
from types import CodeType, FunctionType

from hydro2d.base.parsing import parsed
from hydro2d.jit.handle import TABLE, declared, row_of

#: the parameter that stands for all names, and the prefix of the parameters that replace it
HANDLE, PREFIX = "w", "w__"
#: the rows of a part that `in_rows` goes through: of cells, and of vertices (one more in the last part)
CELLS = "range(w.parts[part], w.parts[part + 1])"
VERTICES = "range(w.parts[part], w.parts[part + 1] + (1 if part == w.parts.shape[0] - 2 else 0))"


def takes(function) -> tuple[str, ...]:
    """Parameters of a compiled function, in order: its own, then the names that it uses from a handle."""
    return (*own_parameters(function), *(function.named if takes_handle(function) else ()))


def takes_handle(function) -> bool:
    """Whether a compiled function takes a handle."""
    return "named" in getattr(function, "__dict__", ())


def own_parameters(function) -> tuple[str, ...]:
    """The parameters of a function without the handle."""
    written = tuple(inspect.signature(source(function)).parameters)
    return written[:-1] if takes_handle(function) else written


def source(function):
    """A function as Python runs it: with a handle, if it takes one."""
    return function.source if takes_handle(function) else function


def values(function, arguments: tuple) -> tuple:
    """The arguments of a call as compiled code takes them: with the values of its names in place of the handle."""
    if not takes_handle(function):
        return arguments
    *own, handle = arguments
    return (*own, *(getattr(handle, name) for name in function.named))


def in_rows(function, rows: str) -> FunctionType:
    """A function of one row, ``function(j, w)``, for all rows of a part: ``function(part, w)``.

    rows : `CELLS` or `VERTICES`. A function that needs to know the part has it as a parameter.

    Raises ValueError for a function that takes no handle, whose first parameter is not ``j``, or that returns.
    """
    tree = _definition(function)
    parameters = [each.arg for each in tree.args.args]
    if parameters[0] != "j" or parameters[-1] != HANDLE:
        raise _mistake(function, tree, f"does not take a row j first and {HANDLE} last")
    for node in ast.walk(tree):
        if isinstance(node, ast.Return):
            raise _mistake(function, node, "returns, which would leave out the rest of the rows")
    body = tree.body[1:] if ast.get_docstring(tree) else tree.body
    loop = ast.For(ast.Name("j", ast.Store()), parsed(rows, "eval").body, body, [])
    for node in (loop, *ast.walk(loop.target), *ast.walk(loop.iter)):
        ast.copy_location(node, tree)
    tree.body = [*tree.body[: len(tree.body) - len(body)], loop]
    tree.args.args = [ast.copy_location(ast.arg("part"), tree), *(each for each in tree.args.args[1:] if each.arg != "part")]
    made = _made(function, tree)
    made.tree = tree
    return made


def steering(function):
    """Marks a function that may set numbers of the handle."""
    function.steers = True
    return function


def steers(function) -> bool:
    """Whether a function, compiled or not, may set numbers of the handle."""
    return getattr(source(function), "steers", False)


def flat(function) -> FunctionType:
    """The function that is compiled: with a parameter for every name that it uses if its last one is a handle, else unchanged.

    Its attribute ``named`` has these names; ``source`` is the given function.

    Raises ValueError for names that are not declared, for one that is assigned and is no number or not in a function that
    steers, for a handle used other than by its names or as the last argument of a function that takes one, for such a function
    that is not defined yet, and for variables that begin with PREFIX.
    """
    if [*inspect.signature(function).parameters][-1:] != [HANDLE]:
        return function
    tree = _definition(function)
    rewriting = _Rewriting(function)
    last = tree.args.args.pop()
    tree.body = [rewriting.visit(statement) for statement in tree.body]
    named = tuple(sorted(rewriting.names))
    tree.args.args += [ast.copy_location(ast.arg(PREFIX + name), last) for name in named]
    made = _made(function, tree)
    made.named, made.source = named, function
    return made


class _Rewriting(ast.NodeTransformer):
    """Replaces names by parameters."""

    def __init__(self, function):
        self._function, self._known, self.names = function, declared(), set()

    def _value(self, name: str, node: ast.expr, context: ast.expr_context | None = None) -> ast.expr:
        """What stands for a name: its parameter, or for a number of a function that steers its place in the table."""
        kind, axes = self._known[name]
        if axes or not steers(self._function):
            self.names.add(name)
            return ast.copy_location(ast.Name(PREFIX + name, ast.Load()), node)
        table = TABLE[float if kind is float else int]
        self.names.add(table)
        place = f"{PREFIX}{table}[{row_of(name)}, 0]"
        value = parsed(place if kind is not bool or context else f"({place} != 0)", "eval").body
        if context:
            value.ctx = context
        for each in ast.walk(value):
            ast.copy_location(each, node)
        return value

    def visit_Attribute(self, node: ast.Attribute):
        if not _is_handle(node.value):
            return self.generic_visit(node)
        if node.attr not in self._known:
            raise _mistake(self._function, node, f"uses {HANDLE}.{node.attr}, which is no name that handles have")
        if isinstance(node.ctx, ast.Load):
            return self._value(node.attr, node)
        if self._known[node.attr][1] or not steers(self._function):
            raise _mistake(self._function, node, f"assigns {HANDLE}.{node.attr}")
        return self._value(node.attr, node, node.ctx)

    def visit_Call(self, node: ast.Call):
        if node.args and _is_handle(node.args[-1]):
            called = self._function.__globals__.get(getattr(node.func, "id", ""))
            if not takes_handle(called):
                raise _mistake(self._function, node, f"gives {HANDLE} to {ast.unparse(node.func)}, which is no compiled "
                                                     "function that takes one, or is not defined yet")
            node.args[-1:] = [self._value(name, node.args[-1]) for name in called.named]
        return self.generic_visit(node)

    def visit_Name(self, node: ast.Name):
        if node.id == HANDLE:
            raise _mistake(self._function, node, f"uses {HANDLE} otherwise than by a name or as the last argument of a call")
        if node.id.startswith(PREFIX) and isinstance(node.ctx, ast.Store):
            raise _mistake(self._function, node, f"has a variable {node.id}, which begins like the parameters of names")
        return node


def _is_handle(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id == HANDLE


def _mistake(function, node: ast.AST, what: str) -> ValueError:
    return ValueError(f"{function.__code__.co_filename}:{node.lineno}: {function.__name__} {what}")


@functools.lru_cache(maxsize=2)
def _last_lines(text: str) -> dict[tuple[str, int], int]:
    """The last line of every function of a text, by its name and its first line, that of its decorator."""
    return {(node.name, min([node.lineno, *(mark.lineno for mark in node.decorator_list)])): node.end_lineno
            for node in parsed(text).body if isinstance(node, ast.FunctionDef)}


def _definition(function) -> ast.FunctionDef:
    """The syntax tree of a function, or what `in_rows` has made of it.

    Raises ValueError for a function that is not at the top level of a file: nested in another, or made at run time.
    """
    if hasattr(function, "tree"):
        return function.tree
    code = function.__code__
    lines, before = linecache.getlines(code.co_filename, function.__globals__), code.co_firstlineno - 1
    last = _last_lines("".join(lines)).get((function.__name__, code.co_firstlineno))
    if last is None:
        raise ValueError(f"{code.co_filename}:{code.co_firstlineno}: {function.__name__} takes {HANDLE}, which only functions "
                         "of files can, not those within others")
    return parsed("\n" * before + "".join(lines[before:last])).body[0]


def _made(function, tree: ast.FunctionDef) -> FunctionType:
    """The function of a changed syntax tree, with the file, lines, module and name of the original."""
    for number, mark in enumerate(tree.decorator_list):  # not called, but they set the first line of the function
        tree.decorator_list[number] = ast.copy_location(ast.Name("mark", ast.Load()), mark)
    module = compile(ast.Module([tree], []), function.__code__.co_filename, "exec", dont_inherit=True)
    code = next(each for each in module.co_consts if isinstance(each, CodeType) and each.co_name == function.__name__)
    made = FunctionType(code.replace(co_qualname=function.__qualname__), function.__globals__, function.__name__)
    made.__module__, made.__qualname__ = function.__module__, function.__qualname__
    return made
