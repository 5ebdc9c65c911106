"""Python text as a syntax tree, one text at a time."""

from __future__ import annotations

import ast
import threading

_one_at_a_time = threading.Lock()


def parsed(text: str, mode: str = "exec") -> ast.AST:
    """The tree that `ast.parse` gives. Raises what it raises.

    Python counts the depth of the tree for all threads together, and raises SystemError if two threads parse at once.
    """
    with _one_at_a_time:
        return ast.parse(text, mode=mode)


def executed(text: str, file: str, names: dict) -> None:
    """Executes the text of a module in the namespace `names`; tracebacks name `file`. Raises what the text raises."""
    exec(compile(parsed(text), file, "exec"), names)
