"""Locks: one process at a time works in a directory, and a process notices when its directory is no longer its own."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple, TextIO

from hydro2d.base.errors import Error
from hydro2d.files.strange import opened

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

#: number of characters read from a lock file
MOST_SAID = 1000


class LockError(Error):
    """A directory in use by another process; the message is for the user."""


class LostPlaceError(Error):
    """A directory that was removed, renamed or taken by another process while this one worked in it; for the user."""


class Holder(NamedTuple):
    """The process that holds a lock."""

    host: str
    process: int

    @property
    def is_here(self) -> bool:
        """Whether the process is on this machine."""
        return self.host == socket.gethostname()

    def __str__(self) -> str:
        return f"process {self.process} on {self.host}"


def holder(path: Path) -> Holder | None:
    """The holder of a lock; None if the lock does not exist, or was left behind by a process on this machine."""
    try:
        with opened(path, errors="replace") as file:
            owner = _said(file.read(MOST_SAID))
            left = owner is not None and owner.is_here and _take_lock(file)
    except (FileNotFoundError, NotADirectoryError):
        return None
    return None if left else owner


def _take_lock(file: TextIO) -> bool:
    """Takes the lock of an open file, for as long as it is open, unless a process on this machine has it.

    Where the system has no such locks, the process that the file names has it, as long as it exists.
    """
    if fcntl is None:
        file.seek(0)
        by = _said(file.read(MOST_SAID))
        return by is None or not by.is_here or not _exists(by.process)
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _exists(process: int) -> bool:
    import psutil

    return psutil.pid_exists(process)


@contextmanager
def locked(path: Path, patience: float = 0.1) -> Iterator[None]:
    """Holds a lock file, which names its holder.

    patience : how long to wait for another process, s; the default is enough for one that only looks whether the lock is held

    On one machine, the lock belongs to the operating system (flock). It ends with the process, however that ends, and a reused
    process number cannot imitate it. Without flock, on Windows, the process that the file names has it, and two that begin in
    the same instant may both have it. Between machines, the contents of the file count; it is removed at the end. While the
    lock is held, `replacing` and `remove` work in its directory, or below it, only as long as this same file is still there.

    Raises LockError if another process holds the lock.
    """
    path, end = Path(path), time.monotonic() + patience
    while True:
        with opened(path, "a+", errors="replace") as file:
            free = _take_lock(file)
            if free and not _is_at(file, path):
                continue  # its former holder has removed it in the meantime
            file.seek(0)
            by = _said(file.read(MOST_SAID))
            if not free or (by is not None and not by.is_here):
                if time.monotonic() < end:
                    time.sleep(0.02)
                    continue
                who = by or "another process"
                raise LockError(f"{path.parent} is in use by {who}; if that process no longer exists, remove {path}")
            place = Path(os.path.abspath(path.parent))
            _own_locks.setdefault(place, []).append((file, path))
            try:
                _sign(file.fileno(), path)
                yield
            finally:
                _own_locks[place].remove((file, path))
                if _is_at(file, path):
                    with suppress(PermissionError):  # Windows removes no open file; an empty one names nobody
                        os.ftruncate(file.fileno(), 0)
                        path.unlink(missing_ok=True)
            return


def _sign(handle: int, path: Path) -> None:
    """Writes who this is into an open lock file, past the buffer, whose error would name no file. Raises OSError."""
    try:
        os.ftruncate(handle, 0)
        os.write(handle, f"{socket.gethostname()} {os.getpid()}\n".encode())
    except OSError as error:
        error.filename = str(path)
        raise


#: locks that this process holds, by the absolute path of their directory
_own_locks: dict[Path, list[tuple[TextIO, Path]]] = {}


def check_place(path: Path) -> None:
    """Raises LostPlaceError if this process has locked a directory above a path, and the lock is no longer there.

    The directory was then removed or renamed, and another process may be using the one that is there now.
    """
    for place in Path(os.path.abspath(path)).parents:
        for file, lock in _own_locks.get(place, ()):
            if not _is_at(file, lock):
                raise LostPlaceError(f"{place} was removed, renamed or taken by another process since this one began to write "
                                     "there; nothing more is written")


def remove(path: Path) -> None:
    """Removes a file, if it exists. Raises LostPlaceError."""
    check_place(path)
    path.unlink(missing_ok=True)


def _said(text: str) -> Holder | None:
    """The holder named in a lock file; None if none is named."""
    words = text.split()
    return Holder(words[0], int(words[1])) if len(words) == 2 and words[1].isdecimal() else None


def _is_at(file: TextIO, path: Path) -> bool:
    """Whether an open file is still the file with this name."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), os.stat(path))
    except (FileNotFoundError, NotADirectoryError):
        return False


@contextmanager
def turn(file: Path) -> Iterator[None]:
    """Waits until no other process is in such a block with this file, and makes others wait. Makes the file if necessary.

    The turn ends with the process, however that ends. Meant for short work on one machine that is merely done twice if two
    processes do it at once: if the file cannot be made (on a full disk, in a read-only folder), nobody waits.
    """
    handle = None
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        handle = os.open(file, os.O_CREAT | os.O_RDWR)
    try:
        if handle is not None and fcntl is not None:
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        if handle is not None:
            os.close(handle)
