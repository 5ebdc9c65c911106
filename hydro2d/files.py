"""Files that are either whole or absent: written beside their place, flushed to the disk, renamed."""

from __future__ import annotations

import fcntl
import json
import math
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple


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
    """Who holds a lock; None where it is gone or its process on this machine is."""
    try:
        host, number = path.read_text(encoding="utf-8").split()
        found = Holder(host, int(number))
        if found.is_here:
            os.kill(found.process, 0)
    except (FileNotFoundError, NotADirectoryError, ProcessLookupError, ValueError):
        return None
    except PermissionError:
        pass  # alive, and somebody else's
    return found


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Holds a lock file with host and process id; that of a process that died on this host is taken over.

    Raises LockError while another process holds it.
    """
    path = Path(path)
    own = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        own.write_text(f"{socket.gethostname()} {os.getpid()}\n", encoding="utf-8")
        while True:
            try:
                os.link(own, path)  # the lock appears with its content, or not at all
                break
            except FileExistsError:
                process = holder(path)
                if process is not None:
                    hint = f"if that is gone for good, remove {path}"
                    raise LockError(f"{path.parent} is in use by {process}; {hint}") from None
                path.unlink(missing_ok=True)
    finally:
        own.unlink(missing_ok=True)
    try:
        yield
    finally:
        path.unlink(missing_ok=True)


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
