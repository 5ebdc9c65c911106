"""Numbers packed for a page: whole numbers of few bits between the least and the greatest value, differences, deflate, base64.

`assets/data.js` unpacks them. Values of a field at a time are stored as levels, 0 for the least and `last_level` for the
greatest of them, so that no value is off by more than `largest_error`. Levels are replaced by their differences along r and
along z, modulo 2^16, which are small where a field is smooth, and split into their high and low bytes.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field

import numpy as np

#: bits of a level that can be chosen; the last level of each stands for what is no number
BITS = (8, 10, 12, 14, 16)
#: bits where none are asked for, with which a value is off by 0.003 % of the range of its field at a time, or less
DEFAULT_BITS = 14
#: a compression that takes half the time of the strongest, for 2 % more
STRENGTH = 6


def last_level(bits: int) -> int:
    """The level of the greatest value; the one above it stands for what is no number."""
    return (1 << bits) - 2


def largest_error(low: float, high: float, bits: int) -> float:
    """How far a value may be from the one that was packed."""
    return 0.5 * (high - low) / last_level(bits)


def levels_of(values: np.ndarray, low: float, high: float, bits: int) -> np.ndarray:
    """Levels of values between low and high, shape as given, uint16."""
    top = last_level(bits)
    finite = np.isfinite(values)
    scaled = (np.where(finite, values, low) - low) * (top / (high - low))
    return np.where(finite, np.clip(np.rint(scaled), 0, top), top + 1).astype(np.uint16)


def packed(levels: np.ndarray) -> bytes:
    """Levels (nz, nr) as bytes: all high bytes of the differences, then all low bytes, deflated."""
    differences = np.diff(np.diff(levels, axis=0, prepend=np.uint16(0)), axis=1, prepend=np.uint16(0))
    return _deflated(np.stack([differences >> 8, differences & 255]).astype(np.uint8))


def packed_column(values: np.ndarray, kind: str) -> bytes:
    """Real numbers (n,) of a kind of numpy, "<f4" or "<f8", as bytes: the first bytes of all, the second, ..., deflated."""
    plain = np.ascontiguousarray(values, dtype=kind)
    return _deflated(plain.view(np.uint8).reshape(len(plain), -1).T)


def _deflated(numbers: np.ndarray) -> bytes:
    return zlib.compress(np.ascontiguousarray(numbers).tobytes(), STRENGTH)


@dataclass
class Store:
    """Pieces of packed numbers one after the other in a text; each begins at a multiple of four letters, three bytes."""

    _parts: list[str] = field(default_factory=list)
    _bytes: int = 0

    def add(self, data: bytes) -> list[int]:
        """Stores a piece; returns its first byte and its length."""
        place = [self._bytes, len(data)]
        self._bytes += len(data) + -len(data) % 3
        self._parts.append(base64.b64encode(data + bytes(-len(data) % 3)).decode("ascii"))
        return place

    @property
    def text(self) -> str:
        """All pieces in base64."""
        return "".join(self._parts)
