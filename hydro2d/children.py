"""Python processes that hydro2d starts: none takes a module from the current directory, where a stranger's files may be."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

#: the variable by which Python leaves the current directory out of the places where it looks for modules
SAFE = "PYTHONSAFEPATH"


def python(module: str) -> list[str]:
    """The command that runs a module of hydro2d in a process of its own."""
    return [sys.executable, "-P", "-m", module]


@contextmanager
def safe() -> Iterator[None]:
    """For all Python processes that are started within the block, by whatever library."""
    before = os.environ.get(SAFE)
    os.environ[SAFE] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[SAFE]
        else:
            os.environ[SAFE] = before
