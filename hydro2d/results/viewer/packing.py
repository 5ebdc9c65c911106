"""Numbers packed for a page: integers of few bits between the smallest and largest value, differences, deflate, base64.

`assets/data.js` unpacks them. Values of a field at a time are stored as levels, 0 for the smallest and `last_level` for the
largest, so that no value is off by more than half a level. Levels are replaced by their differences along r and along z, modulo
2^16, which are small where a field is smooth, and split into their high and low bytes.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field

import numpy as np

#: allowed numbers of bits of a level; the last level of each stands for non-finite values
BITS = (8, 10, 12, 14, 16)
#: default number of bits, with which a value is off by at most 0.003 % of the range of its field at a time
DEFAULT_BITS = 14
#: a compression that takes half the time of the strongest, and 2 % more space
STRENGTH = 6


def last_level(bits: int) -> int:
    """The level of the largest value; the one above it stands for non-finite values."""
    return (1 << bits) - 2


def levels_of(values: np.ndarray, low: float, high: float, bits: int) -> np.ndarray:
    """Levels of values between low and high, same shape, uint16."""
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
    """Pieces of packed numbers, one after the other in a text; each begins at a multiple of four characters, three bytes."""

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
