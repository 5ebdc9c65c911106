"""The keys in which resolved decks differ, and those that they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hydro2d.measure.result import Result, is_number

#: keys that are particular to each run
OWN = ("name", "output.directory")
#: sections whose tables have names
NAMED = ("body", "materials", "tracer", "gauge", "source")


def flatten(value, prefix: str = "") -> dict[str, object]:
    """Plain values by dotted key, of tables and of results; entries of lists of tables by their name, else by their number."""
    if isinstance(value, (Mapping, Result)):
        entries = dict(value).items()
    elif isinstance(value, (list, tuple)) and value and all(isinstance(entry, Mapping) for entry in value):
        entries = [(entry.get("name", number), entry) for number, entry in enumerate(value)]
    else:
        return {prefix: tuple(value) if isinstance(value, (list, tuple)) else value}
    flat: dict[str, object] = {}
    for key, entry in entries:
        if not (prefix and key == "name"):
            flat.update(flatten(entry, f"{prefix}.{key}" if prefix else str(key)))
    return flat


def numbers(table: Mapping | Result) -> dict[str, float]:
    """The finite numbers of nested tables or of results by dotted key."""
    return {name: value for name, value in flatten(table).items() if is_number(value)}


def text(value, exact: bool = False) -> str:
    """A value of a deck as readable text, in SI, with six digits or exactly."""
    if value is None:
        return "not set"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return repr(value) if exact else f"{value:.6g}"
    return f"[{', '.join(text(each, exact) for each in value)}]" if isinstance(value, tuple) else str(value)


@dataclass(frozen=True)
class Differences:
    """``varying``: key -> value -> names of the cases with it; ``common``: key -> value."""

    varying: dict[str, dict[str, tuple[str, ...]]]
    common: dict[str, str]


def compare(decks: Mapping[str, dict], exact: bool = False) -> Differences:
    """Compares resolved decks, given by the names of their cases: their numbers to six digits, or exactly.

    A body, material or tracer that some decks lack is one key, "there" or "not there"; its own keys are compared among the
    decks that have it.
    """
    flat = {name: flatten(deck) for name, deck in decks.items()}
    holders: dict[str, list[str]] = {}
    for name, deck in flat.items():
        for table in dict.fromkeys(map(_table, deck)):
            holders.setdefault(table, []).append(name)
    varying, common = {}, {}
    for table, having in holders.items():
        if table and len(having) < len(flat):
            lacking = [name for name in flat if name not in having]
            varying[table] = {"there": tuple(having), "not there": tuple(lacking)}
        for key in dict.fromkeys(key for name in having for key in flat[name] if _table(key) == table and key not in OWN):
            users = _users(key, {name: flat[name] for name in having}, exact)
            if len(users) > 1:
                varying[key] = users
            elif len(having) == len(flat):
                common[key] = next(iter(users))
    return Differences(varying, common)


def _table(key: str) -> str:
    """The body, material or tracer to which a key belongs; empty for other keys."""
    parts = key.split(".")
    return ".".join(parts[:2]) if parts[0] in NAMED and len(parts) > 2 else ""


def _users(key: str, flat: Mapping[str, dict], exact: bool) -> dict[str, tuple[str, ...]]:
    """The cases with each value of a key."""
    users: dict[str, list[str]] = {}
    for name, deck in flat.items():
        users.setdefault(text(deck.get(key), exact), []).append(name)
    return {value: tuple(names) for value, names in users.items()}


def shortened(names: Sequence[str], most: int = 6) -> str:
    """A list of names, shortened, with the number of names left out."""
    rest = len(names) - most
    return ", ".join(names) if rest <= 1 else f"{', '.join(names[:most])} and {rest} more"
