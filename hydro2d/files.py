"""Files that are either whole or absent: written beside their place, flushed to the disk, renamed."""

from __future__ import annotations

import fcntl
import json
import math
import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple, TextIO


def sync(path: Path) -> None:
    """Flushes a closed file, or the names in a folder, to the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Gives a temporary name in the same folder; renames it to `path` on success, removes it on an exception."""
    path = Path(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        yield temporary
        sync(temporary)
        os.replace(temporary, path)
        sync(path.parent)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def hdf5(path: Path) -> Iterator:
    """Gives an h5py.File in memory and writes it to the disk at the end, where a full disk is one OSError.

    (A file on the disk meets it again with every object that is closed, which h5py prints and goes on.)
    """
    import h5py

    with h5py.File(path.name, "w", driver="core", backing_store=False, libver=("earliest", "v110")) as file:
        yield file
        file.flush()
        image = file.id.get_file_image()
    path.write_bytes(image)


def write_text(path: Path, text: str) -> None:
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


class LockError(Exception):
    """A directory that another process works in; the message is for the user."""


class Holder(NamedTuple):
    """Who holds a lock."""

    host: str
    process: int

    @property
    def is_here(self) -> bool:
        """Whether that is a process of this machine."""
        return self.host == socket.gethostname()

    def __str__(self) -> str:
        return f"process {self.process} on {self.host}"


def holder(path: Path) -> Holder | None:
    """Who holds a lock; None where it is gone, or was left behind by a process of this machine."""
    try:
        with open(path, encoding="utf-8") as file:
            found = _said(file.read())
            left = found is not None and found.is_here and _taken(file)
    except (FileNotFoundError, NotADirectoryError):
        return None
    return None if left else found


def _taken(file: TextIO) -> bool:
    """Takes the lock of an open file, as long as that is open, if no process of this machine has it."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Holds a lock file, which says who does.

    On one machine the lock is the system's (flock): it ends with the process, however that ends, and no number of a process
    that comes again can feign it. Between machines what the file says counts, which is removed at the end.

    Raises LockError while another process holds it.
    """
    path, tries = Path(path), 5
    while True:
        with open(path, "a+", encoding="utf-8") as file:
            free = _taken(file)
            if free and not _is_at(file, path):
                continue  # the holder before has removed it meanwhile
            if not free and tries:  # it may be one that only looks whether it is held
                tries -= 1
                time.sleep(0.02)
                continue
            file.seek(0)
            by = _said(file.read())
            if not free or (by is not None and not by.is_here):
                who = by or "another process"
                raise LockError(f"{path.parent} is in use by {who}; if that is gone for good, remove {path}")
            file.truncate(0)
            file.write(f"{socket.gethostname()} {os.getpid()}\n")
            file.flush()
            try:
                yield
            finally:
                path.unlink(missing_ok=True)
            return


def _said(text: str) -> Holder | None:
    """Who a lock file says that holds it; None where it says nothing."""
    words = text.split()
    return Holder(words[0], int(words[1])) if len(words) == 2 and words[1].isdecimal() else None


def _is_at(file: TextIO, path: Path) -> bool:
    """Whether an open file is still the one of this name."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), os.stat(path))
    except FileNotFoundError:
        return False


def _plain(value):
    """Numbers of numpy as numbers of Python; what is not finite as null, which JSON has no other word for."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def write_json(path: Path, value) -> None:
    write_text(path, json.dumps(_plain(value), indent=2, allow_nan=False) + "\n")


@contextmanager
def turn(file: Path) -> Iterator[None]:
    """Waits until no other process is in such a block with this file, which is made if need be, and keeps others waiting.

    The turn ends with the process, however it ends. Meant for short work on one machine.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    handle = os.open(file, os.O_CREAT | os.O_RDWR)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)
