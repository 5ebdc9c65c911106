"""Files that are either complete or absent: written under a temporary name, flushed to disk, then renamed."""

from __future__ import annotations

import json
import math
import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from hydro2d.base.errors import Error
from hydro2d.files.checksums import KEY, MOST_TEXT, sealed, verified_text
from hydro2d.files.locks import check_place
from hydro2d.files.strange import StrangeFile, opened


def sync(path: Path) -> None:
    """Flushes a closed file, or the names in a folder, to disk; Windows opens no folder."""
    folder = path.is_dir()
    if folder and os.name == "nt":
        return
    handle = os.open(path, os.O_RDONLY if folder else os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yields a temporary name in the same folder, which is renamed to `path` on success and removed on an exception."""
    path = Path(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{secrets.token_hex(4)}.tmp")  # no link can wait at a random name
    check_place(path)
    try:
        yield temporary
        sync(temporary)
        check_place(path)
        os.replace(temporary, path)
        sync(path.parent)
    except OSError as error:
        if error.errno is not None and error.filename in (None, str(temporary)):
            error.filename = str(path)
        raise
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def hdf5(path: Path) -> Iterator:
    """Yields an h5py.File in memory and writes it to disk at the end, so that a full disk raises one OSError.

    With a file on disk, h5py would print the error again for every object that is closed, and go on. The format is that of HDF5
    1.8, in which an attribute may be larger than 64 KiB.
    """
    import h5py

    with h5py.File(path.name, "w", driver="core", backing_store=False, libver=("v108", "v110")) as file:
        yield file
        file.flush()
        image = file.id.get_file_image()
    path.write_bytes(sealed(image, ".h5"))


def read_text(path: Path, error: type[Error]) -> str:
    """The text of a file that a user wrote. Raises `error` with one line if it cannot be read, or is not UTF-8 text."""
    try:
        with opened(path, encoding="utf-8-sig", links=True) as file:
            if (size := os.fstat(file.fileno()).st_size) > MOST_TEXT:
                raise error(f"{path}: cannot be read: it has {size} bytes; at most {MOST_TEXT} are allowed")
            return file.read()
    except StrangeFile as problem:
        raise error(str(problem)) from None
    except OSError as problem:
        raise error(f"{path}: cannot be read: {problem.strerror}") from None
    except UnicodeDecodeError:
        raise error(f"{path}: is not UTF-8 text") from None


def write_text(path: Path, text: str, *, checksum: bool = False) -> None:
    """Writes a text, with its checksum if requested."""
    data = text.encode("utf-8")
    with replacing(path) as temporary:
        temporary.write_bytes(sealed(data, Path(path).suffix) if checksum else data)


def plain(value):
    """A copy that TOML and JSON can hold: numpy numbers and arrays as Python numbers and lists, paths as text."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value) if isinstance(value, Path) else value


def _finite(value):
    """Plain data with null for non-finite numbers, which JSON cannot represent."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def read_json(path: Path, error: type[Error]) -> dict:
    """The table in a JSON file whose checksum fits. Raises `error` with one line."""
    text = verified_text(path, error)
    try:
        table = json.loads(text)
    except (ValueError, RecursionError) as problem:
        raise error(f"{path} cannot be read: {problem}") from None
    if not isinstance(table, dict):
        raise error(f"{path} cannot be read: it is not a table")
    table.pop(KEY, None)
    return table


def write_json(path: Path, value) -> None:
    write_text(path, json.dumps(_finite(plain(value)), indent=2, allow_nan=False) + "\n", checksum=True)
