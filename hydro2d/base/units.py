"""Conversion of quantities: "1086 m/s" to SI on input, SI to the reader's unit on output.

A table holds the common units. Pint, which takes long to import, converts all others.

A number without a unit that a program gives is in SI. In a deck without numbers = "SI" it is refused: `bare` marks the numbers
of such a deck, and `to_si` refuses a marked number, unless it is 0 or the quantity is a plain number. `of_argument` refuses it
in the arguments of commands.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterable, Mapping

#: names of quantities by their SI unit
KINDS = {
    "1": "a plain number",
    "m": "a length",
    "s": "a time",
    "kg": "a mass",
    "m/s": "a velocity",
    "1/s": "a rate",
    "kg/m^3": "a density",
    "Pa": "a pressure",
    "1/Pa": "a reciprocal pressure",
    "K": "a temperature",
    "1/K": "a reciprocal temperature",
    "J": "an energy",
    "J/kg": "a specific energy",
    "J/(kg*K)": "a specific heat",
    "W/kg": "a power per mass",
    "rad": "an angle",
}

#: common units: name -> (SI unit, factor)
COMMON = {
    "m": ("m", 1.0), "cm": ("m", 1e-2), "mm": ("m", 1e-3), "um": ("m", 1e-6), "km": ("m", 1e3),
    "s": ("s", 1.0), "ms": ("s", 1e-3), "us": ("s", 1e-6), "ns": ("s", 1e-9),
    "m/s": ("m/s", 1.0), "km/s": ("m/s", 1e3), "mm/us": ("m/s", 1e3), "cm/us": ("m/s", 1e4),
    "kg/m^3": ("kg/m^3", 1.0), "kg/m3": ("kg/m^3", 1.0), "g/cm^3": ("kg/m^3", 1e3), "g/cm3": ("kg/m^3", 1e3),
    "Pa": ("Pa", 1.0), "kPa": ("Pa", 1e3), "MPa": ("Pa", 1e6), "GPa": ("Pa", 1e9), "Mbar": ("Pa", 1e11),
    "/Mbar": ("1/Pa", 1e-11), "K": ("K", 1.0), "/K": ("1/K", 1.0), "J/kg": ("J/kg", 1.0), "rad": ("rad", 1.0),
    "kg": ("kg", 1.0), "g": ("kg", 1e-3), "J": ("J", 1.0), "1/s": ("1/s", 1.0), "/s": ("1/s", 1.0),
}

#: smallest nonzero and largest meaningful value in each unit for an impact, and the reason
REACH = {
    "m": (1e-15, 1e6, "no mesh of an impact is longer than 1000 km, and nothing in it is smaller than a nucleus"),
    "s": (1e-21, 1e6, "no impact lasts longer than days, and no time step is so short"),
    "kg": (1e-18, 1e15, "no projectile is so light or so heavy"),
    "m/s": (1e-12, 1e6, "matter that meets at more than 1000 km/s is a plasma, which no model here describes"),
    "kg/m^3": (1e-9, 1e6, "no matter on earth is denser, and no thinner matter is a continuum"),
    "Pa": (1e-12, 1e15, "no equation of state here reaches further"),
    "J/kg": (1e-12, 1e13, "no equation of state here reaches further"),
    "K": (1e-9, 1e8, "no equation of state here reaches further"),
    "rad": (1e-15, 1e3, "that is more than a hundred turns"),
    "rad/s": (1e-12, 1e9, "no body spins so fast"),
}

#: by SI unit: the unit probably meant by a number below the first bound, or from the second one on
MEANT = {
    "m": ((0.0, ""), (0.2, "mm")),
    "s": ((0.0, ""), (1e-2, "us")),
    "kg": ((0.0, ""), (0.1, "g")),
    "m/s": ((20.0, "km/s"), (math.inf, "")),
    "kg/m^3": ((30.0, "g/cm^3"), (math.inf, "")),
    "Pa": ((1e4, "GPa"), (math.inf, "")),
    "J/kg": ((1e3, "kJ/kg"), (math.inf, "")),
    "rad": ((0.0, ""), (1.6, "deg")),
}

#: largest number of characters in a quantity
LONGEST = 200
#: a power of a unit; a power of a power, which may be an endless number; a digit other than the 1 of 1/s
_POWER = re.compile(r"(?:\*\*|\^)\s*\(?\s*[+-]?\d{1,2}(?:\.\d{1,6})?(?:\s*/\s*\d{1,2})?(?![\d.])\s*\)?")
_TOWER = re.compile(r"(?:\*\*|\^)[^*/]*(?:\*\*|\^)")
_DIGIT = re.compile(r"[02-9]|1(?=[\d.])")

_NUMBER = re.compile(r"\s*([+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")


def in_reach(value: float, unit: str, reach: Mapping[str, tuple[float, float, str]] = REACH) -> float:
    """The value. Raises ValueError if it is outside the meaningful range of its unit in ``reach``."""
    least, most, reason = reach.get(unit, (0.0, math.inf, ""))
    if not math.isnan(value) and value != 0.0 and not least <= abs(value) <= most:
        bound = f"beyond {most:g}" if abs(value) > most else f"nearer to 0 than {least:g}"
        raise ValueError(f"is {value:g} {unit}, {bound}: {reason}")
    return value


class BareFloat(float):
    """A number without a unit, from a deck without numbers = "SI"."""


class BareInt(int):
    """A whole number without a unit, from a deck without numbers = "SI"."""


def bare(value):
    """A copy of tables, lists or a value whose numbers are marked as needing a unit if their quantity has one."""
    if isinstance(value, Mapping):
        return {key: bare(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [bare(entry) for entry in value]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return value
    return BareInt(value) if isinstance(value, int) else BareFloat(value)


def without_unit(value: float, unit: str) -> str:
    """The message for a number of a deck that lacks its unit: the probable meaning, or the key that makes it SI."""
    meant, si = _meant(value, unit)
    if_si = f", if {si} is meant" if meant != si else ""
    return f'{value:.12g} has no unit; write "{meant}" (or numbers = "SI" at the top of the deck{if_si})'


def _meant(value: float, unit: str) -> tuple[str, str]:
    """The probable meaning of a number without a unit, and its meaning in SI: "95.25 mm" and "95.25 m"."""
    (low, small), (high, large) = MEANT.get(unit, ((0.0, ""), (math.inf, "")))
    si = f"{value:.12g} {unit.removeprefix('1')}"
    meant = small if abs(value) < low else large if abs(value) >= high else ""
    return f"{value:.12g} {meant}" if meant else si, si


def exact(value: float, unit: str) -> str:
    """A number in an SI unit as text that is read back to the last bit."""
    return f"{float(value)!r} {unit}"


def kind(unit: str) -> str:
    """The name of a quantity with this SI unit, with its article."""
    return KINDS.get(unit, f"a quantity in {unit}")


@functools.cache
def _registry():
    import pint

    return pint.UnitRegistry(cache_folder=None)


@functools.lru_cache(maxsize=4096)
def _parsed(text: str, unit: str) -> float:
    """SI value of a string with a unit. The message of the ValueError for a wrong one says what was expected."""
    if len(text) > LONGEST:
        raise ValueError(f'"{text[:20]} ..." is too long for a number with a unit; {_expected(unit)}')
    match = _NUMBER.match(text)
    if match is None:
        raise ValueError(f'"{text}" is not a number with a unit; {_expected(unit)}')
    number, name = float(match.group(1)), match.group(2)
    if not name:
        if unit == "1":
            return number
        raise ValueError(f'"{text}" has no unit; {_expected(unit)}')
    known, factor = COMMON.get(name, ("", 0.0))
    if known == unit and factor == 1.0:
        return number
    si = number * factor if known == unit else _by_pint(text, number, name, unit)
    return float(f"{si:.15g}")  # 18.16 g/cm^3 is 18160, not 18159.999999999996


def parts(text: str) -> tuple[float, str]:
    """The number of a quantity and its unit, as it is written: "1.2 km/s" is 1.2 and "km/s". Raises ValueError."""
    match = _NUMBER.match(text)
    if match is None:
        raise ValueError(f'"{text}" is not a number with its unit')
    return float(match.group(1)), match.group(2)


def written(value, unit: str) -> tuple[str, float]:
    """The common unit in which a quantity is written, and its factor; the SI unit ``unit`` for numbers and other text."""
    match = _NUMBER.match(value) if isinstance(value, str) else None
    name = match.group(2) if match else unit
    known, factor = COMMON.get(name, ("", 1.0))
    return (name, factor) if known == unit else (unit, 1.0)


def _by_pint(text: str, number: float, name: str, unit: str) -> float:
    """The SI value for any unit that pint knows, before rounding."""
    import pint

    registry = _registry()
    try:
        if _TOWER.search(name) or _DIGIT.search(_POWER.sub("", _spelled(name))):
            raise ValueError("a number that may take forever")
        quantity = registry.Quantity(number, registry.parse_units(_spelled(name)))
    except Exception as problem:  # pint raises a dozen kinds for text that is not a unit
        raise ValueError(f'"{name}" is not a unit; {_expected(unit)}') from problem
    try:
        return quantity.to("dimensionless" if unit == "1" else unit).magnitude
    except pint.DimensionalityError:
        raise ValueError(f'"{text}" is {_name_of(quantity)}; {_expected(unit)}') from None


def _spelled(name: str) -> str:
    """A unit as pint reads it: kg/m3 is kg/m^3, /Pa is 1/Pa."""
    name = re.sub(r"(?<=[A-Za-z])(\d)", r"^\1", name)
    return "1" + name if name.startswith("/") else name


def _name_of(quantity) -> str:
    for unit, name in KINDS.items():
        if quantity.check(_registry().parse_units("dimensionless" if unit == "1" else unit).dimensionality):
            return name
    return f"a quantity in {quantity.units:~}"


def _expected(unit: str) -> str:
    if unit == "1":
        return "expected a plain number"
    return f'expected {kind(unit)}: a number in {unit} or a string such as "1.5 {unit}"'


def to_si(value: float | str, unit: str) -> float:
    """SI value of a number (taken as SI, unless it is marked as bare) or of a string with a unit.

    Parameters
    ----------
    value : float or str
        A quantity, such as ``"1.2 km/s"``.
    unit : str
        The SI unit of the quantity, such as ``"m/s"``; "1" for a plain number.

    Raises
    ------
    ValueError
        The value is not finite, has no unit, or has a unit of another dimension; the message says what was expected.
    """
    if isinstance(value, (BareFloat, BareInt)) and value != 0 and unit != "1" and math.isfinite(value):
        raise ValueError(without_unit(value, unit))
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError(f"{value!r} is not a quantity; {_expected(unit)}")
    number = _parsed(value, unit) if isinstance(value, str) else float(value)
    if not math.isfinite(number):
        raise ValueError(f"{value!r} is not finite; {_expected(unit)}")
    return number


def read(value: float | str, unit: str) -> float:
    """`to_si` of a value in a deck, which must be `in_reach` as well."""
    return in_reach(to_si(value, unit), unit)


def of_argument(text: str, unit: str) -> float:
    """SI value of an argument of a command: a number with its unit, or a bare one if it is 0 or the quantity is a plain number.

    Raises ValueError, whose message says what to type.
    """
    try:
        number = float(text)
    except ValueError:
        return to_si(text, unit)
    if number != 0 and unit != "1" and math.isfinite(number):
        meant, si = _meant(number, unit)
        or_si = f' (or "{si}", if that is meant)' if meant != si else ""
        raise ValueError(f'{number:.12g} has no unit; write "{meant}"{or_si}')
    return to_si(number, unit)


def of_kinds(text: str, kinds: Iterable[str]) -> tuple[float, str]:
    """SI value of a string with a unit of one of several kinds, and its SI unit, one of ``kinds``. Raises ValueError."""
    match = _NUMBER.match(text)
    known, _ = COMMON.get(match.group(2), ("", 0.0)) if match else ("", 0.0)
    for unit in [known] if known in kinds else kinds:
        try:
            return to_si(text, unit), unit
        except ValueError:
            continue
    raise ValueError(f'"{text}" is not a quantity; expected a number with a unit, such as "8 mm"')


def from_si(value: float, si_unit: str, unit: str) -> float:
    """An SI value in the reader's unit: from_si(0.448, "m", "cm") is 44.8."""
    if si_unit == unit:
        return float(value)
    registry = _registry()
    return float(registry.Quantity(value, registry.parse_units(si_unit)).to(registry.parse_units(unit)).magnitude)


def show(value: float, si_unit: str, unit: str | None = None, digits: int = 4) -> str:
    """An SI value as text in the reader's unit: show(0.448, "m", "cm") is "44.8 cm"."""
    unit = unit or si_unit
    return f"{from_si(value, si_unit, unit):.{digits}g}" + ("" if unit == "1" else f" {unit}")


#: the reader's unit of a quantity in SI, and how many of them make one SI unit
READER = {
    "m": ("mm", 1e3), "m2": ("cm²", 1e4), "m3": ("cm³", 1e6), "s": ("µs", 1e6), "kg": ("g", 1e3), "J": ("kJ", 1e-3),
    "Pa": ("GPa", 1e-9), "J/kg": ("MJ/kg", 1e-6), "kg/m3": ("g/cm³", 1e-3),
}


def reader_unit(unit: str) -> tuple[str, float]:
    """The reader's unit for an SI unit, and the factor from SI to it; an SI unit that has none is its own."""
    return READER.get(unit, (unit, 1.0))
