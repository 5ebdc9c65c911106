"""Lock files as held by other processes."""

from __future__ import annotations

import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def held(path: Path, process: int | None = None) -> Iterator[None]:
    """A lock held by a process of this machine that gives this number as its own."""
    with open(path, "w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.write(f"{socket.gethostname()} {process or os.getppid()}\n")
        file.flush()
        yield
    path.unlink(missing_ok=True)
