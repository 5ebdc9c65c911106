"""Python processes that hydro2d starts: none takes a module from the current directory, where a stranger's files may be."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

#: the variable by which Python leaves the current directory out of the places where it looks for modules
SAFE = "PYTHONSAFEPATH"


def python(module: str) -> list[str]:
    """The command that runs a module of hydro2d in a process of its own."""
    return [sys.executable, "-P", "-m", module]


def detached(arguments: Sequence[str], log: Path, nice: int) -> int:
    """Starts the command `hydro2d` with these arguments in a session of its own. Returns the number of the process.

    log : file for what it prints, which is added to;  nice : by how much its priority is lowered
    """
    command = ["nice", "-n", str(nice), *python("hydro2d"), *arguments]
    with open(log, "a", encoding="utf-8") as file:
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file, stderr=file, start_new_session=True).pid


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
