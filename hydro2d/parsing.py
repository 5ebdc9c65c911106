"""Python text as a syntax tree, one text at a time."""

from __future__ import annotations

import ast
import threading

_one_at_a_time = threading.Lock()


def parsed(text: str, mode: str = "exec") -> ast.AST:
    """The tree that `ast.parse` gives. Raises what it raises.

    Python counts the depth of the tree for all threads together, and fails with a SystemError where two threads parse at once.
    """
    with _one_at_a_time:
        return ast.parse(text, mode=mode)
