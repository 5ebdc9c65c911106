"""Starts Python processes that import nothing from the current directory, which may hold a stranger's files."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

#: environment variable that keeps Python from looking for modules in the current directory
SAFE = "PYTHONSAFEPATH"


def python(module: str) -> list[str]:
    """The command that runs a module of hydro2d in a separate process."""
    return [sys.executable, "-P", "-m", module]


def detached(arguments: Sequence[str], log: Path, nice: int) -> int:
    """Starts the command `hydro2d` with these arguments in a new session. Returns the number of the process.

    log : file to which its output is appended;  nice : by how much its priority is lowered
    """
    lowered = ["nice", "-n", str(nice)] if shutil.which("nice") else []
    flags = sum(getattr(subprocess, name, 0) for name in ("DETACHED_PROCESS", "BELOW_NORMAL_PRIORITY_CLASS"))  # of Windows
    with open(log, "a", encoding="utf-8") as file:
        return subprocess.Popen([*lowered, *python("hydro2d"), *arguments], stdin=subprocess.DEVNULL, stdout=file, stderr=file,
                                start_new_session=True, creationflags=flags).pid


@contextmanager
def safe() -> Iterator[None]:
    """Sets SAFE for all Python processes started within the block, by any library."""
    before = os.environ.get(SAFE)
    os.environ[SAFE] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[SAFE]
        else:
            os.environ[SAFE] = before
