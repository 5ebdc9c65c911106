"""Text on its way to a terminal, a log or a figure: characters that could steer a terminal are spelled out.

Titles, names and messages can come from someone else's files. Everything that hydro2d prints passes through `say`, and
everything that it logs through `one_line`.
"""

from __future__ import annotations

import inspect
import re
import shutil
import sys
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from hydro2d.base.formats import shown

#: width without a terminal: a file or another program gets every line whole
NO_TERMINAL = 1_000_000
#: a wrapped line continues below its last column if that begins within this share of the width, else this many characters
#: further in than the line begins
MOST_INDENT, FURTHER = 0.7, 4


def duration(seconds: float, tenths: bool = False) -> str:
    """'1 h 02 min', '3 min 20 s', '12 s'; with ``tenths`` also '3.1 s', for measured times."""
    if tenths and seconds < 9.95:
        return f"{seconds:.1f} s"
    seconds = round(seconds)
    if seconds >= 3600:
        return f"{seconds // 3600} h {seconds % 3600 // 60:02d} min"
    if seconds >= 60:
        return f"{seconds // 60} min {seconds % 60:02d} s"
    return f"{seconds} s"


def moment(seconds: float) -> str:
    """A time of the simulation in microseconds, or in a larger unit for longer times."""
    for name, scale in (("s", 1.0), ("ms", 1e3)):
        if seconds * scale >= 10:
            return f"{seconds * scale:.3f} {name}"
    return f"{seconds * 1e6:.3f} us"


def number(value, scale: float, form: str, unit: str) -> str:
    """A quantity in the reader's unit; "-" if there is no value."""
    if value is None or value != value:
        return "-"
    return f"{value * scale:{form}} {unit}"


def several(number: object, what: str) -> str:
    """'1 cell', '2 cells'."""
    return f"{number} {what}{'' if str(number) == '1' else 's'}"


def width() -> int:
    """Width of the terminal that shows the output, characters; NO_TERMINAL without one, unless COLUMNS is set."""
    return shutil.get_terminal_size((NO_TERMINAL, 24)).columns


def wrapped(text: str) -> str:
    """Lines wrapped at words to the width of the terminal, and continued below their last column.

    Columns have two or more spaces between them.
    """
    return "\n".join(map(_wrapped, text.split("\n")))


def _wrapped(line: str) -> str:
    begin, first = max((gap.end() for gap in re.finditer(r"\s{2,}", line)), default=0), len(line) - len(line.lstrip())
    indent = begin if begin < MOST_INDENT * width() else first + FURTHER
    return textwrap.fill(line, width(), subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)


def flowing(text: str) -> str:
    """A docstring whose paragraphs are one line each, so that help wraps them to the width of the terminal."""
    lines: list[str] = []
    for line in inspect.cleandoc(text).split("\n"):
        before, words = lines[-1] if lines else "", line.lstrip()
        names = line == words and "Parameters" in lines  # the name of a parameter stands alone
        if before and words and not names and before.startswith(" ") == line.startswith(" ") and words != "Parameters":
            lines[-1] = f"{before} {words}"
        else:
            lines.append(line)
    return "\n".join(lines)


def say(text: object, file: TextIO | None = None, flush: bool = False) -> None:
    """Prints a text; file : default: the standard output. Raises OSError, which names the stream."""
    with _named():
        print(shown(text), file=file or sys.stdout, flush=flush)


def flush() -> None:
    """Writes out the buffered output. Raises OSError, which names the stream."""
    with _named():
        sys.stdout.flush()


@contextmanager
def _named() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        error.filename = error.filename or "the standard output"
        raise
