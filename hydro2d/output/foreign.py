"""Checks files of a run that come from someone else: they must not lead to other files or claim more than they hold."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from hydro2d.base.errors import Error

#: largest ratio of a value to its compressed size: that of gzip is 1032, that of LZ4 255
RATIO = 1100
#: number of bytes that any file may claim
FREE = 1 << 16
#: number of bytes at the start of a VTK file within which its description must end
HEAD = 1 << 20
_NAME = re.compile(r"[^/\\\0]+\.vt[rp]")
_COUNTS = re.compile(rb"(?:NumberOf(?:Points|Lines|Verts|Strips|Polys|Tuples|Components))=\"([^\"]*)\"")
_OFFSET = re.compile(rb"offset=\"(\d+)\"")
_EXTENT = re.compile(rb"(?:WholeExtent|Extent)=\"([^\"]*)\"")


def check_names(files: Iterable[str | None], folder: str) -> None:
    """Raises ValueError if a series names a file that is not a VTK file in the folder next to it."""
    for file in files:
        place, slash, name = (file or "").partition("/")
        if place != folder or not slash or not _NAME.fullmatch(name) or name.startswith("."):
            raise ValueError(f"it names the file {file!r}; a series may name only VTK files in {folder}/")


def check_xml(text: bytes) -> None:
    """Raises ValueError for XML with declarations, which can name other files and grow without bound."""
    if b"<!" in text.replace(b"<!--", b"") or b"\0" in text:
        raise ValueError("it has declarations, which no file of hydro2d has")


def check_vtk(path: Path, error: type[Error]) -> None:
    """Raises `error` if a VTK file declares entities, or describes more values than its size can hold."""
    with open(path, "rb") as file:
        head, marker, _ = file.read(HEAD).partition(b"<AppendedData")
    try:
        if not marker:
            raise ValueError("its values are not appended to its description")
        check_xml(head)
        extents = [[int(word) for word in text.split()] for text in _EXTENT.findall(head)]
        sizes = [math.prod(high - low + 1 for low, high in zip(each[::2], each[1::2], strict=True)) for each in extents]
        largest = max([*sizes, *(int(text) for text in _COUNTS.findall(head))], default=0)
        _check_blocks(path, head)
        if 4 * largest > FREE + RATIO * path.stat().st_size:
            raise ValueError(f"it describes {largest} values, more than its size can hold")
    except ValueError as problem:
        raise error(f"{path} is damaged, or not a file of a run: {problem}") from None


def _check_blocks(path: Path, head: bytes) -> None:
    """Raises ValueError if a block of values is not in the place or of the size that VTK expects without a check.

    Each array begins with the number of its blocks, their size, the size of the last one if it is smaller, and the size of each
    in the file.
    """
    if b'compressor="vtkLZ4DataCompressor"' not in head:
        raise ValueError("it is not compressed with LZ4")
    word = 8 if b'header_type="UInt64"' in head else 4
    whole = path.stat().st_size
    with open(path, "rb") as file:
        start = file.read(HEAD + FREE).index(b"_", len(head)) + 1
        for offset in sorted({int(text) for text in _OFFSET.findall(head)}):
            file.seek(start + offset)
            count, size, last = _numbers(file.read(3 * word), 3, word)
            if count == 0 and b"RectilinearGrid" not in head:
                continue
            if not 0 < count <= whole // word or not 0 < size or last > size or count * size > FREE + RATIO * whole:
                raise ValueError(f"it has {count} blocks of {size} bytes, which it cannot hold")
            packed = sum(_numbers(file.read(count * word), count, word))
            if start + offset + (3 + count) * word + packed > whole:
                raise ValueError("its blocks end beyond its end")


def _numbers(data: bytes, count: int, word: int) -> list[int]:
    if len(data) < count * word:
        raise ValueError("its blocks begin beyond its end")
    return [int.from_bytes(data[at : at + word], "little") for at in range(0, count * word, word)]


def check_hdf5(file, ratio: int = RATIO) -> None:
    """Raises ValueError if an h5py.File leads to other files, has groups in groups, or claims more than its size can hold.

    ratio : most bytes of values for each byte of the file; 1 for a file that is written without compression
    """
    import h5py

    claimed, size = 0, file.id.get_filesize()
    for group in (file, *(file[name] for name in file if _is_hard(file, name) and isinstance(file[name], h5py.Group))):
        for name in group:
            if not _is_hard(group, name):
                raise ValueError(f"{name!r} is a link")
            entry = group[name]
            if isinstance(entry, h5py.Group) and group is not file:
                raise ValueError(f"{name!r} is a group in a group")
            if isinstance(entry, h5py.Dataset):
                _check_dataset(entry)
                claimed += entry.nbytes + _length_of_texts(entry)
    if claimed > FREE + ratio * size:
        raise ValueError(f"it claims {claimed} bytes of values, more than its {size} bytes can hold")


def _length_of_texts(dataset) -> int:
    """Bytes of the texts of a dataset. Each is a length and an address in the file, and many can have one address."""
    if dataset.dtype.kind != "O" or not dataset.size:
        return 0
    if dataset.chunks or dataset.id.get_offset() is None:
        raise ValueError(f"the texts of {dataset.name!r} are in pieces")
    with open(dataset.file.filename, "rb") as raw:
        raw.seek(dataset.id.get_offset())
        return int(np.frombuffer(raw.read(16 * dataset.size), "<u4")[::4].sum(dtype=np.int64))


def _is_hard(group, name: str) -> bool:
    import h5py

    return isinstance(group.get(name, getlink=True), h5py.HardLink)


def _check_dataset(dataset) -> None:
    if dataset.external or dataset.is_virtual:
        raise ValueError(f"the values of {dataset.name!r} are in another file")
    if dataset.nbytes > FREE + RATIO * dataset.id.get_storage_size():
        raise ValueError(f"{dataset.name!r} claims {dataset.nbytes} bytes, more than the file can hold")
