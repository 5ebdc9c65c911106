"""Errors for users, and messages about wrong names and values: what is allowed, and the nearest valid name."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from contextlib import contextmanager

#: largest number of lines in a message, and of characters in a line
MOST_LINES, LONGEST_LINE = 50, 2000


def limited(message: str) -> str:
    """A message short enough to read: its first lines, without the middle of long ones."""
    lines = message.split("\n")
    kept = [line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE // 2]} ... {line[-LONGEST_LINE // 2 :]}"
            for line in lines[:MOST_LINES]]
    return "\n".join([*kept, f"and {len(lines) - MOST_LINES} more"] if len(lines) > MOST_LINES else kept)


class Error(Exception):
    """Base of the errors that hydro2d raises for its users; the message says what is wrong and what is allowed."""

    def __init__(self, *said: object):
        super().__init__(*(limited(part) if isinstance(part, str) else part for part in said))


class DeckError(Error):
    """A deck, a material or a command line is wrong; the message is for its author."""


class TargetError(Error):
    """Code cannot be compiled for the processor that HYDRO2D_TARGET asks for."""


class MissingPackage(Error, ImportError):
    """A package of one of hydro2d's extras is not installed; the message has the command that installs it."""


@contextmanager
def from_extra(extra: str, wanted: str):
    """Wraps imports of packages that only an extra installs. Raises MissingPackage.

    extra : its name in pyproject.toml
    wanted : the feature that needs the package, at the beginning of the message
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "a package").partition(".")[0]
        raise MissingPackage(f"{wanted} needs {package}, which is not installed: pip install 'hydro2d[{extra}]'") from None


class UnphysicalState(Error):
    """The state has become physically impossible; the message gives the place, the body and the values."""


#: a name is near another if they share this fraction of their letters, as difflib counts: two of three letters
NEAR = 0.65
#: a name of at least this many letters is near those that begin with it
BEGINNING = 3


def nearest(name: str, allowed: Iterable[str]) -> str | None:
    """The allowed name that looks most like ``name``, or else begins with it; None if none is near."""
    name = str(name).lower()
    if len(name) > LONGEST_NAME:
        return None
    names = [str(entry) for entry in allowed]
    lower = {entry.lower(): entry for entry in reversed(names)}
    matches = difflib.get_close_matches(name, list(lower), n=1, cutoff=NEAR)
    if not matches and len(name) >= BEGINNING:
        matches = sorted((entry for entry in lower if entry.startswith(name)), key=len)
    return lower[matches[0]] if matches else None


#: largest number of names that a message lists, and of characters of a name that is compared with others
MOST_NAMES, LONGEST_NAME = 40, 200


def unknown(what: str, name: str, allowed: Iterable[str]) -> str:
    """'unknown material "W_aloy"; did you mean "W_alloy"? (allowed: ...)'; only the nearest names of a long list."""
    names = sorted(str(entry) for entry in allowed)
    close = nearest(name, names)
    hint = f'; did you mean "{close}"?' if close else ""
    if len(names) > MOST_NAMES:
        word = name[:LONGEST_NAME].lower()
        near = sorted(names, key=lambda each: -difflib.SequenceMatcher(None, word, each.lower()).ratio())[:MOST_NAMES]
        return f'unknown {what} "{name}"{hint} ({len(names)} are allowed, such as {", ".join(sorted(near))})'
    return f'unknown {what} "{name}"{hint} (allowed: {", ".join(names) or "none"})'


def in_words(entry: dict) -> str:
    """The message for one of pydantic's errors, without its place. The caller, who knows the table, handles unknown keys."""
    kind = entry["type"]
    if kind == "missing":
        return "is missing"
    if kind == "value_error":
        return str(entry["ctx"]["error"])
    if kind == "literal_error":
        words = [word.strip("' ") for word in entry["ctx"]["expected"].replace(" or ", ", ").split(",")]
        return unknown("value", str(entry["input"]), [{"False": "false", "True": "true"}.get(word, word) for word in words])
    message = entry["msg"][0].lower() + entry["msg"][1:]
    return f"{message.replace('input ', '')}, is {entry['input']!r}"
