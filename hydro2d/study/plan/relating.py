"""Inputs of a sample that relate to the value of the deck: a number that is added to it, or that multiplies it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from hydro2d.base import units
from hydro2d.deck.deck import Deck
from hydro2d.files import toml
from hydro2d.files.key_lines import Sources
from hydro2d.study.plan.distributions import Distribution
from hydro2d.study.plan.sample_section import FACTOR

#: significant digits of the value in a deck
DIGITS = 12


def completed(tables: Mapping[str, Any], inputs: Sequence[Distribution], read: Callable[[], Deck]) -> Mapping[str, Any]:
    """The tables with the numbers to which inputs relate and that materials of the deck take from those they are based on.

    tables : of the deck, as they are written;  read : makes the deck, if a number is missing

    Raises DeckError for a wrong deck.
    """
    deck = None
    for key in [each.key for each in inputs if each.relative and toml.value_of(tables, each.key) is None]:
        match toml.key_parts(key):
            case ["materials", name, _] | ["materials", name, _, _] as parts:
                deck = deck or read()
                material = deck.materials.get(name)
                if number := material and material.number(*parts[2:]):
                    exact = number.value if number.unit == "1" else units.exact(number.value, number.unit)
                    tables = toml.override(dict(tables), key, exact, key, Sources())
    return tables


def value(tables: Mapping[str, Any], each: Distribution, given: float | str) -> float | str:
    """The value of a deck key for a number of its input.

    tables : of the deck, as they are written;  given : the number of the input, in its unit

    Raises ValueError if the deck has no number under the key, or one of another quantity.
    """
    own = toml.value_of(tables, each.key)
    if own is None:
        raise ValueError(f"the deck gives no value of {each.key}, to which the input could relate; leave out relative")
    if isinstance(own, bool) or not isinstance(own, (int, float, str)):
        raise ValueError(f"{each.key} of the deck is {toml.inline(own)}, not a number")
    if each.relative == FACTOR:
        number, unit = _split(own)
        return _written(number * float(given), unit)
    if not each.unit:
        return _written(units.to_si(own, "1") + float(given), "")
    amount, _ = _split(given)
    factor, si = units.of_kinds(f"1 {each.unit}", units.KINDS)
    return _written(units.to_si(own, si) / factor + amount, each.unit)


def _split(text: float | str) -> tuple[float, str]:
    """Number and unit of a value as it is written; the unit must begin at zero, as degC does not. Raises ValueError."""
    if not isinstance(text, str):
        return float(text), ""
    number, unit = units.parts(text)
    if unit and units.of_kinds(f"0 {unit}", units.KINDS)[0] != 0.0:
        raise ValueError(f'"{text}": {unit} does not begin at zero; write the value of the deck in another unit')
    return number, unit


def _written(number: float, unit: str) -> float | str:
    value = float(f"{number:.{DIGITS}g}")
    return f"{value!r} {unit}" if unit else value
