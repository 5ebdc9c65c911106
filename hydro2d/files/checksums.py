"""Checksums: each file that a run or a study writes holds the SHA-256 of all its other bytes, which is checked before reading.

The checksum is part of the file, so that both are always replaced together. It is in a place that programs which read the
format ignore:

    .toml               a comment in the first line
    .json               the first key, `sha256`
    .vtr, .vtp, .pvd    a comment before the first element
    .h5                 after the end of the HDF5 file

A file without a checksum, of an earlier version or another program, is read as it is. So is one whose checksum a user removed.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from hydro2d.base.errors import Error
from hydro2d.files.strange import own


class Form(NamedTuple):
    """Where a format holds a checksum: the first bytes of a file, and the bytes before and after the digits."""

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
#: number of digits, and how many must still be digits for a damaged checksum to be recognised
DIGITS, ENOUGH = 64, 48
#: number of first bytes that show whether there is a checksum, and bytes read at a time
BEGIN, PIECE = 1 << 10, 1 << 24
#: largest size of a text and of any other file, bytes
MOST_TEXT, MOST_DATA = 1 << 28, 1 << 36
#: offset in an HDF5 file of the address of its end, by the version of its superblock
_ENDS = {0: 40, 1: 44, 2: 28, 3: 28}


def sealed(data: bytes, suffix: str) -> bytes:
    """The contents of a file with their checksum; unchanged if the format, or a JSON file that is no table, cannot hold one."""
    if suffix == HDF5:
        return data + b" sha256 " + _digest(data, b" sha256 ")
    form = FORMS.get(suffix)
    if form is None or not data.startswith(form.begin):
        return data
    head, tail = form.begin + form.before, form.after + data[len(form.begin) :]
    return head + _digest(head, tail) + tail


def seal(file: Path, suffix: str) -> None:
    """Adds the checksum to a file that was just written."""
    file.write_bytes(sealed(file.read_bytes(), suffix))


def verify(path: Path, error: type[Error]) -> None:
    """Checks a file against its checksum, piece by piece.

    Raises `error` with one line if the file cannot be read or does not match its checksum, and StrangeFile.
    """
    _verified(path, error, MOST_DATA, lambda piece: None)


def verified(path: Path, error: type[Error]) -> bytes:
    """The contents of a text file, checksum included, once it is verified. Raises what `verify` raises."""
    pieces: list[bytes] = []
    _verified(path, error, MOST_TEXT, pieces.append)
    return b"".join(pieces)


def _verified(path: Path, error: type[Error], most: int, take: Callable[[bytes], object]) -> None:
    """Checks a file of at most ``most`` bytes and passes its contents to ``take``, piece by piece."""
    path = own(Path(path))
    try:
        if path.is_dir():
            raise error(f"{path} cannot be read: it is not a file")
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            if size > most:
                raise error(f"{path} cannot be read: it has {size} bytes; at most {most} are allowed")
            begin = file.read(BEGIN)
            file.seek(max(size - DIGITS, 0))
            place, written = _place(begin, file.read(), size, path.suffix), b""
            file.seek(0)
            digest = hashlib.sha256()
            for length, counts in ((size, True),) if place is None else ((place, True), (DIGITS, False), (size, True)):
                while length and (piece := file.read(min(length, PIECE))):
                    length -= len(piece)
                    take(piece)
                    if counts:
                        digest.update(piece)
                    else:
                        written += piece
    except OSError as problem:
        raise error(f"{path} cannot be read: {problem.strerror}") from None
    if not size and path.suffix in FORMS:
        raise error(f"{path} cannot be read: it is empty")
    if place is not None and digest.hexdigest().encode() != written:
        raise error(f"{path} does not fit its checksum: it was damaged or changed since it was written; {_remedy(path.suffix)}")


def verified_text(path: Path, error: type[Error]) -> str:
    """The text of a verified file, without the comment that holds the checksum. Raises `error` with one line."""
    data = verified(path, error)
    form = FORMS[path.suffix]
    if path.suffix == ".toml" and data.startswith(form.before):
        data = data[len(form.before) + DIGITS + len(form.after) :]
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise error(f"{path} cannot be read: it is not UTF-8 text") from None


def begins_with_one(text: str) -> bool:
    """Whether the text of a deck begins with a checksum, as decks written by hydro2d do."""
    return text.startswith(FORMS[".toml"].before.decode())


def _digest(*parts: bytes) -> bytes:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part)
    return digest.hexdigest().encode()


def _place(begin: bytes, end: bytes, size: int, suffix: str) -> int | None:
    """Offset of the checksum's digits in a file of a given size; None if it has no checksum.

    begin, end : the first BEGIN and the last DIGITS bytes of the file
    """
    if suffix == HDF5:
        at = size - DIGITS
        return at if at > 0 and (_is_digits(end) or _is_longer(begin, size)) else None
    if suffix not in FORMS:
        return None
    head = FORMS[suffix].begin + FORMS[suffix].before
    at = len(head)
    begun = begin.startswith(head) or (0 < len(begin) < at and head.startswith(begin))
    return at if begun or _is_digits(begin[at : at + DIGITS]) else None


def _is_digits(data: bytes) -> bool:
    """Whether this is a checksum, perhaps a damaged one."""
    return sum(byte in b"0123456789abcdef" for byte in data) >= ENOUGH


def _is_longer(begin: bytes, size: int) -> bool:
    """Whether anything follows the end of an HDF5 file."""
    at = _ENDS.get(begin[8]) if begin.startswith(b"\x89HDF\r\n\x1a\n") and len(begin) > 8 else None
    return at is not None and size > int.from_bytes(begin[at : at + 8], "little")


def _remedy(suffix: str) -> str:
    if suffix == ".toml":
        return "put it back, or remove its first line if the change is intended"
    if suffix == ".json":
        return f'put it back, or remove its key "{KEY}" if the change is intended'
    return "put it back from a copy, or repeat the run"
