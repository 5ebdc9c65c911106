"""Messages about wrong decks: file, line, key, what is allowed, and the nearest valid name.

tomllib gives values without line numbers, so ``key_lines`` reads the text a second time and notes the line of each key.
"""

from __future__ import annotations

import difflib
import functools
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


class _Scanner:
    """Reads TOML that tomllib has accepted and notes the line of every key and of every array element."""

    def __init__(self, text: str):
        self.text, self.at, self.line = text, 0, 1
        self.lines: dict[tuple, int] = {}
        self.counts: dict[tuple, int] = {}

    def run(self) -> dict[tuple, int]:
        prefix: tuple = ()
        while self._skip(newlines=True):
            if self._next() == "[":
                prefix = self._header()
            else:
                self._pair(prefix)
        return self.lines

    def _next(self, length: int = 1) -> str:
        return self.text[self.at : self.at + length]

    def _take(self, length: int = 1) -> str:
        text = self._next(length)
        self.at += length
        self.line += text.count("\n")
        return text

    def _skip(self, newlines: bool) -> bool:
        """Skips blanks and comments; False at the end of the text."""
        while self.at < len(self.text):
            character = self._next()
            if character == "#":
                while self.at < len(self.text) and self._next() != "\n":
                    self.at += 1
            elif character in " \t\r" or (newlines and character == "\n"):
                self._take()
            else:
                return True
        return False

    def _note(self, path: tuple, line: int) -> None:
        for length in range(1, len(path) + 1):
            self.lines.setdefault(path[:length], line)

    def _header(self) -> tuple:
        line, array = self.line, self._next(2) == "[["
        self._take(2 if array else 1)
        keys = self._dotted()
        self._take(2 if array else 1)
        path = self._resolved(keys[:-1])
        if array:
            place = path + keys[-1:]
            index = self.counts.get(place, 0)
            self.counts[place] = index + 1
            path = place + (index,)
        else:
            path = self._resolved(keys)
        self._note(path, line)
        return path

    def _resolved(self, keys: tuple) -> tuple:
        """Keys, with the index of the latest element where a key names an array of tables."""
        path: tuple = ()
        for key in keys:
            path += (key,)
            if path in self.counts:
                path += (self.counts[path] - 1,)
        return path

    def _dotted(self) -> tuple:
        keys = []
        while True:
            self._skip(newlines=False)
            keys.append(self._key())
            self._skip(newlines=False)
            if self._next() != ".":
                return tuple(keys)
            self._take()

    def _key(self) -> str:
        if self._next() in "\"'":
            return self._string()
        start = self.at
        while self._next() and (self._next().isalnum() or self._next() in "-_"):
            self.at += 1
        return self.text[start : self.at]

    def _string(self) -> str:
        quote = self._next()
        ends = quote * 3 if self._next(3) == quote * 3 else quote
        self._take(len(ends))
        start = self.at
        while self._next(len(ends)) != ends:
            self._take(2 if quote == '"' and self._next() == "\\" else 1)
        text = self.text[start : self.at]
        self._take(len(ends))
        while len(ends) == 3 and self._next() == quote:  # a quotation mark may stand before the closing three
            self._take()
        return text

    def _pair(self, prefix: tuple) -> None:
        line = self.line
        path = prefix + self._dotted()
        self._note(path, line)
        self._take()  # =
        self._skip(newlines=False)
        self._value(path)

    def _value(self, path: tuple) -> None:
        character = self._next()
        if character in "\"'":
            self._string()
        elif character == "[":
            self._list(path)
        elif character == "{":
            self._inline_table(path)
        else:
            while self._next() and self._next() not in ",]}#\n":
                self.at += 1

    def _list(self, path: tuple) -> None:
        self._take()
        index = 0
        while self._skip(newlines=True) and self._next() != "]":
            self._note(path + (index,), self.line)
            self._value(path + (index,))
            index += 1
            self._skip(newlines=True)
            if self._next() == ",":
                self._take()
        self._take()

    def _inline_table(self, path: tuple) -> None:
        self._take()
        while self._skip(newlines=True) and self._next() != "}":
            self._pair(path)
            self._skip(newlines=True)
            if self._next() == ",":
                self._take()
        self._take()


@functools.lru_cache(maxsize=16)
def key_lines(text: str) -> dict[tuple, int]:
    """Line of every key of a valid TOML text; elements of arrays are addressed by their index, from 0."""
    return _Scanner(text.replace("\r\n", "\n")).run()


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
                line = _line_of(named[:length], data, key_lines(text))
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


def _line_of(named: tuple, data, lines: dict[tuple, int]) -> int | None:
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
    return lines.get(path)


def entry_index(entries: list, key) -> int | None:
    """Index of the entry with a name, or with a number counted from 0; None if there is none."""
    for index, entry in enumerate(entries):
        if isinstance(entry, dict) and entry.get("name") == key:
            return index
    text = str(key)
    return int(text) if text.isdigit() and int(text) < len(entries) else None
