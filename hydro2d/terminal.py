"""Text on its way to a terminal, a log or a figure: characters that could steer a terminal are spelled out.

Titles, names and messages can come from someone else's files. Everything that hydro2d prints passes through `say`, and
everything that it logs through `one_line`.
"""

from __future__ import annotations

import re
import shutil
import sys
import textwrap
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

#: characters in a line where there is no terminal: a file or another program gets every line whole
NO_TERMINAL = 1_000_000
#: a line goes on below its last column if that begins before this share of the width, else so many characters further in
#: than it begins
MOST_INDENT, FURTHER = 0.7, 4
#: categories of characters that are not shown but change what is: control, direction of writing, lines
_STEERING = frozenset(("Cc", "Cf", "Zl", "Zp"))


def shown(text: object) -> str:
    """A text in which only line feeds and tabs are not to be seen; other such characters are spelled out, as in \\x1b."""
    text = str(text)
    if text.isprintable():
        return text
    return "".join(map(_shown, text))


def _shown(character: str) -> str:
    kind = unicodedata.category(character)
    if kind == "Cs":  # a byte of a name that is no text
        return "?"
    return character if character in "\n\t" or kind not in _STEERING else character.encode("unicode_escape").decode()


def one_line(text: object) -> str:
    """The same on one line."""
    return shown(text).replace("\n", "\\n")


def duration(seconds: float, tenths: bool = False) -> str:
    """'1 h 02 min', '3 min 20 s', '12 s'; with ``tenths`` also '3.1 s', for what was measured."""
    if tenths and seconds < 9.95:
        return f"{seconds:.1f} s"
    seconds = round(seconds)
    if seconds >= 3600:
        return f"{seconds // 3600} h {seconds % 3600 // 60:02d} min"
    if seconds >= 60:
        return f"{seconds // 60} min {seconds % 60:02d} s"
    return f"{seconds} s"


def several(number: object, what: str) -> str:
    """'1 cell', '2 cells'."""
    return f"{number} {what}{'' if str(number) == '1' else 's'}"


def cell(text: str) -> str:
    """A text as a cell or a head of a CSV file: none that a spreadsheet would take for a formula."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text


def width() -> int:
    """Characters in a line of the terminal that the output goes to; NO_TERMINAL if it goes elsewhere and COLUMNS is not set."""
    return shutil.get_terminal_size((NO_TERMINAL, 24)).columns


def wrapped(text: str) -> str:
    """Lines that break at words where the terminal is narrower, and go on below the last of their columns.

    Columns have two spaces or more between them.
    """
    return "\n".join(map(_wrapped, text.split("\n")))


def _wrapped(line: str) -> str:
    begin, first = max((gap.end() for gap in re.finditer(r"\s{2,}", line)), default=0), len(line) - len(line.lstrip())
    indent = begin if begin < MOST_INDENT * width() else first + FURTHER
    return textwrap.fill(line, width(), subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)


def say(text: object, file: TextIO | None = None, flush: bool = False) -> None:
    """Prints a text; file : default: the standard output. Raises OSError, which names the stream."""
    with _named():
        print(shown(text), file=file or sys.stdout, flush=flush)


def flush() -> None:
    """Writes what was printed and not yet written. Raises OSError, which names the stream."""
    with _named():
        sys.stdout.flush()


@contextmanager
def _named() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        error.filename = error.filename or "the standard output"
        raise
