"""Lock files as other processes hold them."""

from __future__ import annotations

import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def held(path: Path, process: int | None = None) -> Iterator[None]:
    """A lock that a process of this machine holds, which calls itself by this number."""
    with open(path, "w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.write(f"{socket.gethostname()} {process or os.getppid()}\n")
        file.flush()
        yield
    path.unlink(missing_ok=True)
