"""Where a key of a deck stands: its file and line, for messages."""

from __future__ import annotations

import bisect
import functools
import re
import tomllib

from hydro2d.base.formats import in_toml

#: strings and comments of a TOML text, which are not its structure; the group is the start of a string that does not end
_QUOTED = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}|\'{3}.*?\'{3,5}|("{3}|\'{3}).*|"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'|#[^\n]*', re.DOTALL)
_CLOSING = {"[": "]", "{": "}"}


def _ending(head: str) -> str:
    """The text that completes the first lines of a valid TOML text: the ends of its open string, arrays and inline tables."""
    structure = _QUOTED.sub(r"\1", head)
    missing: list[str] = []
    for bracket in re.findall(r"[][{}]", structure):
        if bracket in _CLOSING:
            missing.append(_CLOSING[bracket])
        else:
            missing.pop()
    opened = structure[-3:] if structure.endswith(('"""', "'''")) else ""
    return opened + "".join(reversed(missing))


@functools.lru_cache(maxsize=256)
def _first_lines(text: str, number: int) -> dict | None:
    """The data in the first lines of a TOML text, with open strings, arrays and tables closed; None where they do not end."""
    lines = text.split("\n")
    head = "\n".join(lines[:number])
    try:
        return tomllib.loads(f"{head}\n{_ending(head)}" if number < len(lines) else text)
    except tomllib.TOMLDecodeError:
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
    """A key as written in a deck, on one line: ("body", 0, "name") is body[0].name."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        elif part != "[key]":  # what pydantic adds for a mistake in the key itself
            text += "." * bool(text) + (part if part.isprintable() and part else in_toml(part))
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
