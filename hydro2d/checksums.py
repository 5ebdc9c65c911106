"""Checksums: a file that a run or a study writes holds the SHA-256 of all its other bytes, which is checked before it is read.

The checksum is part of its file, so that the two are replaced together, at any moment of a run. It stands where programs that
read the format pass over it:

    .toml               a comment in the first line
    .json               the first key, `sha256`
    .vtr, .vtp, .pvd    a comment before the first element
    .h5                 behind the end of the HDF5 file

A file without one, of an earlier version or of another program, is read as it is. So is one from which a user has removed it.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import NamedTuple

from hydro2d.errors import Error
from hydro2d.strange import own


class Form(NamedTuple):
    """How a format holds a checksum: what a file begins with, and the bytes before and after the digits that follow."""

    begin: bytes
    before: bytes
    after: bytes


_COMMENT = (b"<!-- sha256 ", b" -->\n")
FORMS = {
    ".toml": Form(b"", b"# sha256 ", b"\n"),
    ".json": Form(b"{\n", b'  "sha256": "', b'",\n'),
    ".vtr": Form(b"", *_COMMENT),
    ".vtp": Form(b"", *_COMMENT),
    ".pvd": Form(b'<?xml version="1.0"?>\n', *_COMMENT),
}
HDF5 = ".h5"
#: the key in a JSON file
KEY = "sha256"
#: number of digits, and how many of them must still be digits for a damaged checksum to be known as one
DIGITS, ENOUGH = 64, 48
#: offset in an HDF5 file of the address of its end, by the version of its superblock
_ENDS = {0: 40, 1: 44, 2: 28, 3: 28}


def sealed(data: bytes, suffix: str) -> bytes:
    """The contents of a file with their checksum; as they are if the format, or a JSON file that is no table, has no place."""
    if suffix == HDF5:
        return data + b" sha256 " + _digest(data, b" sha256 ")
    form = FORMS.get(suffix)
    if form is None or not data.startswith(form.begin):
        return data
    head, tail = form.begin + form.before, form.after + data[len(form.begin) :]
    return head + _digest(head, tail) + tail


def seal(file: Path, suffix: str) -> None:
    """Gives a file that was just written its checksum."""
    file.write_bytes(sealed(file.read_bytes(), suffix))


def verified(path: Path, error: type[Error]) -> bytes:
    """The contents of a file with their checksum, which fits.

    Raises `error` with one line if the file cannot be read, and StrangeFile.
    """

    path = own(Path(path))
    try:
        if path.is_dir():
            raise error(f"{path} cannot be read: it is not a file")
        data = path.read_bytes()
    except OSError as problem:
        raise error(f"{path} cannot be read: {problem.strerror}") from None
    if not data and path.suffix in FORMS:
        raise error(f"{path} cannot be read: it is empty")
    at = _place(data, path.suffix)
    if at is not None and _digest(data[:at], data[at + DIGITS :]) != data[at : at + DIGITS]:
        raise error(f"{path} does not fit its checksum: it was damaged or changed since it was written; {_remedy(path.suffix)}")
    return data


def verified_text(path: Path, error: type[Error]) -> str:
    """The text of a file whose checksum fits, without a comment that holds the checksum. Raises `error` with one line."""
    data = verified(path, error)
    form = FORMS[path.suffix]
    if path.suffix == ".toml" and data.startswith(form.before):
        data = data[len(form.before) + DIGITS + len(form.after) :]
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise error(f"{path} cannot be read: it is not UTF-8 text") from None


def _digest(*parts: bytes) -> bytes:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part)
    return digest.hexdigest().encode()


def _place(data: bytes, suffix: str) -> int | None:
    """Where a file has the digits of its checksum; None if it has no checksum."""
    if suffix == HDF5:
        at = len(data) - DIGITS
        return at if at > 0 and (_is_digits(data[at:]) or _is_longer(data)) else None
    if suffix not in FORMS:
        return None
    head = FORMS[suffix].begin + FORMS[suffix].before
    at = len(head)
    begun = data.startswith(head) or (0 < len(data) < at and head.startswith(data))
    return at if begun or _is_digits(data[at : at + DIGITS]) else None


def _is_digits(data: bytes) -> bool:
    """Whether this was a checksum, though it may be damaged."""
    return sum(byte in b"0123456789abcdef" for byte in data) >= ENOUGH


def _is_longer(data: bytes) -> bool:
    """Whether anything stands behind the end of an HDF5 file."""
    at = _ENDS.get(data[8]) if data.startswith(b"\x89HDF\r\n\x1a\n") else None
    return at is not None and len(data) > int.from_bytes(data[at : at + 8], "little")


def _remedy(suffix: str) -> str:
    if suffix == ".toml":
        return "put it back, or remove its first line if the change is meant"
    if suffix == ".json":
        return f'put it back, or remove its key "{KEY}" if the change is meant'
    return "put it back from a copy, or repeat the run"
