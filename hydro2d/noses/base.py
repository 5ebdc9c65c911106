"""The base of all kinds of noses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hydro2d.base.parameters import Parameter
from hydro2d.noses.profile import Piece


class Nose:
    """A kind of nose. A kind has a length and a profile, which follow from its keys and the radius of the shank.

    ``name`` is its word in decks and analytic models. ``keys`` are numbers that a deck must give; their defaults are those of
    the analytic models, REQUIRED if there is none. With ``by_length`` a deck may give `nose_length` in their place.
    """

    name: ClassVar[str]
    meaning: ClassVar[str]
    keys: ClassVar[tuple[Parameter, ...]] = ()
    by_length: ClassVar[bool] = False

    @classmethod
    def length(cls, radius: float, **keys: float) -> float:
        """Length of the nose, m. Raises ValueError for keys that no nose has."""
        raise NotImplementedError

    @classmethod
    def keys_of(cls, radius: float, length: float) -> dict[str, float]:
        """The keys of a nose of this length, for a kind with ``by_length``. Raises ValueError for an impossible length."""
        raise NotImplementedError

    @classmethod
    def profile(cls, radius: float, length: float, **keys: float) -> tuple[Piece, ...]:
        """The pieces of the meridian, from the base to the tip."""
        raise NotImplementedError


@dataclass(frozen=True)
class Shaped:
    """A nose of a certain size on a shank of this ``radius``: its ``kind``, ``length`` (m), ``keys`` and ``pieces``."""

    kind: type[Nose]
    radius: float
    length: float
    keys: dict[str, float]
    pieces: tuple[Piece, ...]
