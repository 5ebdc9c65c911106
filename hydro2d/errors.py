"""Messages about wrong decks: file, line, key, what is allowed, and the nearest valid name."""

from __future__ import annotations

import bisect
import difflib
import functools
import itertools
import tomllib
from collections.abc import Iterable
from contextlib import contextmanager

#: largest number of lines in a message, and of characters in a line
MOST_LINES, LONGEST_LINE = 50, 2000


def limited(message: str) -> str:
    """A message short enough to read: its first lines, without the middle of long ones."""
    lines = message.split("\n")
    kept = [line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE // 2]} ... {line[-LONGEST_LINE // 2 :]}"
            for line in lines[:MOST_LINES]]  # fmt: skip
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


#: what may be missing after the first lines of a TOML file: ends of strings, arrays and inline tables
_ENDINGS = tuple(end + "".join(brackets) for depth in range(4) for end in ("", '"""', "'''")
                 for brackets in itertools.product("]}", repeat=depth))  # fmt: skip


@functools.lru_cache(maxsize=256)
def _first_lines(text: str, number: int) -> dict | None:
    """The data in the first lines of a TOML text, with open strings, arrays and tables closed; None where they do not end."""
    head = "\n".join(text.split("\n")[:number])
    for ending in _ENDINGS:
        try:
            return tomllib.loads(f"{head}\n{ending}")
        except tomllib.TOMLDecodeError:
            continue
    return None


def line_of(path: tuple, text: str) -> int | None:
    """Line of a key in a valid TOML text, None if it has no such key; elements of arrays are counted from 0.

    tomllib gives values without line numbers: the line is the first that has to be read for the key to be there.
    """
    text = text.replace("\r\n", "\n")
    last = text.count("\n") + 1

    def is_there(number: int) -> bool:
        while (data := _first_lines(text, number)) is None:
            number += 1
        return _has(data, path)

    return bisect.bisect_left(range(last + 1), True, key=is_there) if is_there(last) else None


def _has(data, path: tuple) -> bool:
    for part in path:
        if not (part in data if isinstance(data, dict) else isinstance(data, list) and part in range(len(data))):
            return False
        data = data[part]
    return True


def spelled(path: tuple) -> str:
    """A key as written in a deck: ("body", 0, "name") is body[0].name."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else str(part)
    return text


class Sources:
    """The files from which a deck was assembled, so that a key can be traced to its line.

    They are searched in order of precedence: command line, the deck, its includes.
    """

    def __init__(self) -> None:
        self._files: list[tuple[str, dict, str]] = []
        self._set: dict[tuple, str] = {}

    def add(self, name: str, data: dict, text: str) -> None:
        """Registers a file, before the files that it includes. Its lines are searched only when one is needed."""
        self._files.append((name, data, text))

    @property
    def number(self) -> int:
        """Number of files."""
        return len(self._files)

    def add_override(self, path: tuple, said: str) -> None:
        """Registers an override under its name in messages; the path has names where arrays hold named entries."""
        self._set.pop(path, None)  # the last override comes last
        self._set[path] = said

    def where(self, path: tuple, merged: dict) -> str:
        """'deck.toml:12' for the key, or for the nearest enclosing table that is in a file; '' if none is."""
        named = _named(path, merged)
        for key, said in reversed(self._set.items()):
            if named[: len(key)] == key:
                return said
        for length in range(len(named), 0, -1):
            for name, data, text in self._files:
                line = _line_of(named[:length], data, text)
                if line is not None:
                    return f"{name}:{line}"
        return self._files[0][0] if self._files else ""


def _named(path: tuple, data) -> tuple:
    """The path with the index of a named entry replaced by its name, if it is the first entry with this name."""
    result: tuple = ()
    for part in path:
        if isinstance(data, list) and isinstance(part, int) and part < len(data):
            entries, data = data, data[part]
            name = data.get("name") if isinstance(data, dict) else None
            result += (name if isinstance(name, str) and entry_index(entries, name) == part else part,)
        else:
            data = data.get(part) if isinstance(data, dict) else None
            result += (part,)
    return result


def _line_of(named: tuple, data, text: str) -> int | None:
    path: tuple = ()
    for part in named:
        if isinstance(data, list):
            index = entry_index(data, part)
            if index is None:
                return None
            path, data = path + (index,), data[index]
        elif isinstance(data, dict) and part in data:
            path, data = path + (part,), data[part]
        else:
            return None
    return line_of(path, text)


def entry_index(entries: list, key) -> int | None:
    """Index of the entry with a name, or with a number counted from 0; None if there is none."""
    for index, entry in enumerate(entries):
        if isinstance(entry, dict) and entry.get("name") == key:
            return index
    text = str(key)
    return int(text) if text.isdigit() and int(text) < len(entries) else None
