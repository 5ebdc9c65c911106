"""The kinds of noses, and a nose of a certain size."""

from __future__ import annotations

from collections.abc import Mapping

from hydro2d.base.errors import unknown
from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.noses.base import Nose, Shaped
from hydro2d.noses.conical import Conical
from hydro2d.noses.flat import Flat
from hydro2d.noses.flat_rounded import FlatRounded
from hydro2d.noses.hemispherical import Hemispherical
from hydro2d.noses.ogival import Ogival

#: in the order of lists and pages
KINDS: tuple[type[Nose], ...] = (Flat, Hemispherical, Ogival, Conical, FlatRounded)
BY_NAME = {kind.name: kind for kind in KINDS}
#: the key that gives the length of a nose in place of its own keys
LENGTH = Parameter("nose_length", "m", None, "length of the nose", sign=POSITIVE, example="10 mm")


def owners() -> dict[Parameter, list[str]]:
    """The keys of all kinds, each with the names of the kinds that have it."""
    kinds: dict[Parameter, list[str]] = {}
    for kind in KINDS:
        for key in kind.keys:
            kinds.setdefault(key, []).append(kind.name)
    return kinds


def shaped(name: str, radius: float, given: Mapping[str, float]) -> Shaped:
    """The nose of this name on a shank of this radius (m).

    given : its keys, or `nose_length` in their place for a kind that allows it

    Raises ValueError for an unknown name, a missing key, one too many, and impossible values.
    """
    if name not in BY_NAME:
        raise ValueError(unknown("nose", name, BY_NAME))
    kind = BY_NAME[name]
    own, article = [key.name for key in kind.keys], "an" if name[0] in "aeiou" else "a"
    allowed = [*own, LENGTH.name] if kind.by_length else own
    if stray := [key for key in given if key not in allowed]:
        instead = f"; give {' or '.join(allowed)}" if allowed else ""
        raise ValueError(f"{article} {name} nose has no {' and no '.join(stray)}{instead}")
    if kind.by_length and LENGTH.name in given:
        if len(given) > 1:
            raise ValueError(f"give {' or '.join(allowed)}, not both")
        length = given[LENGTH.name]
        keys = kind.keys_of(radius, length)
    else:
        if missing := [key for key in own if key not in given]:
            raise ValueError(f"{article} {name} nose needs {' or '.join(allowed) if kind.by_length else ' and '.join(missing)}")
        keys = dict(given)
        length = kind.length(radius, **keys)
    return Shaped(kind, radius, length, keys, kind.profile(radius, length, **keys))
