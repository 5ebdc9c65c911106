"""Numbers without a unit that a program puts into a deck: they are in SI units, and here those are found that are not.

A ball with radius = 2.5 is five metres thick, and was meant to be of 2.5 mm. A text with its unit is never questioned.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Mapping
from typing import Any

from hydro2d import toml
from hydro2d.deck.sections import Deck
from hydro2d.errors import spelled

#: by SI unit: smallest and largest number that is taken without its unit, zero aside, and the unit that else was meant
TAKEN = {"m": (0.0, 1.0, "mm"), "s": (0.0, 0.1, "us"), "m/s": (10.0, math.inf, "km/s")}
#: keys of speeds that may be small, since they are no speeds of bodies, and of a time on the clock of the wall
FREE = ("restart_interval", "speed_below", "residual_velocity", "speed", "r_min_velocity", "r_max_velocity", "z_min_velocity",
        "z_max_velocity")  # fmt: skip
#: tables whose numbers the models check
OTHERS = ("materials",)


@functools.cache
def _units() -> dict[str, str]:
    """The SI units of the keys of a deck, by the last part of the key."""
    sections = Deck.model_json_schema()["$defs"].values()
    keys = {key: part for section in sections for key, part in section.get("properties", {}).items()}
    found = {}
    for key, part in keys.items():
        unit = next((each["x-unit"] for each in (part, *part.get("anyOf", ())) if "x-unit" in each), None)
        if unit in TAKEN and key not in FREE:
            found[key] = unit
    return found | {"r": "m", "z": "m", "reach": "m"}  # of boxes, tracers and gauges; those of meshes hold tables


def questionable(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, str]]:
    """Key and message of every number in tables, or under a key, that is probably meant in another unit.

    path : keys that lead to the value, names or numbers
    """
    if isinstance(value, Mapping):
        for key, entry in value.items():
            if (*path, key)[0] not in OTHERS:
                yield from questionable(entry, (*path, key))
    elif isinstance(value, (list, tuple)):
        for number, entry in enumerate(value):
            yield from questionable(entry, (*path, number))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        names = [part for part in path if isinstance(part, str) and not part.isdecimal()]
        unit = _units().get(names[-1]) if names else None
        if unit is None or value == 0.0:
            return
        least, most, meant = TAKEN[unit]
        if not least <= abs(value) <= most and math.isfinite(value):
            yield path, (f"{value:g} without a unit is {value:g} {unit}; write \"{value:g} {meant}\", or "
                         f"\"{value:g} {unit}\" if that is meant")  # fmt: skip


def of_override(key: str, value: Any) -> list[str]:
    """What is questionable in an override by dotted key, one message for each number."""
    return [f"{spelled(path)}: {said}" for path, said in questionable(value, tuple(toml.key_parts(key)))]
