"""Tables in CSV that a person or a spreadsheet may have changed: read as their columns are declared, or refused.

What a spreadsheet changes without changing a value is read: a byte order mark, CRLF, quotes, spaces around cells, lines and
last columns without an entry, TRUE for True. Everything else is refused in one line with the file, the line and the column.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hydro2d.base.errors import Error, nearest, unknown
from hydro2d.base.formats import of_cell, one_line
from hydro2d.files.whole import read_text

#: the lines that git puts into a file that two branches have changed
_CONFLICT = re.compile(r"(<{7}|\|{7}|={7}|>{7})(\s|$)")
#: marks between cells that a table must not have, as spreadsheets write them where numbers have commas
_OTHER_MARKS = {";": "semicolons", "\t": "tabs"}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def number(text: str) -> str:
    """The text of a finite number. Raises ValueError for any other text."""
    if not _NUMBER.fullmatch(text):
        commas = "; write a point in numbers, and no marks between thousands" if "," in text else ""
        raise ValueError(f'"{text}" is not a number{commas}')
    if not math.isfinite(float(text)):
        raise ValueError(f'"{text}" is not a finite number')
    return text


def whole(text: str) -> str:
    """The text of a whole number that is not negative. Raises ValueError for any other text."""
    if not re.fullmatch(r"\d{1,15}", text, re.ASCII):
        raise ValueError(f'"{text}" is not a whole number')
    return str(int(text))


def flag(text: str) -> str:
    """True or False, in any capitals. Raises ValueError for any other text."""
    return one_of("True", "False")(text.capitalize())


def one_of(*words: str) -> Callable[[str], str]:
    """A check of a text that must be one of these words."""

    def check(text: str) -> str:
        if text not in words:
            raise ValueError(unknown("word", text, words))
        return text

    return check


def like(pattern: str, what: str) -> Callable[[str], str]:
    """A check of a text that must match a pattern; what : the pattern in words, for messages."""

    def check(text: str) -> str:
        if not re.fullmatch(pattern, text):
            raise ValueError(f'"{text}" is not {what}')
        return text

    return check


@dataclass(frozen=True)
class Column:
    """A column of a table.

    name : its head, with the unit if it has one
    check : gives the text of a cell as it is read; raises ValueError with what is wrong
    required : whether a table must have it;  empty : whether a cell may be empty
    """

    name: str
    check: Callable[[str], str] = str
    required: bool = True
    empty: bool = True


class Row(dict[str, str]):
    """A row of a table, the text of each cell by the head of its column; ``line`` is its line in the file, 0 without one."""

    line = 0


def lines(path: Path, error: type[Error]) -> list[tuple[int, list[str]]]:
    """The lines of a table that have an entry: their numbers in the file, and their cells without spaces around them.

    Raises `error` if the file cannot be read, is not CSV with commas, or has the marks of a merge that git has not finished.
    """
    text = read_text(path, error)
    for at, line in enumerate(text.split("\n"), 1):
        if _CONFLICT.match(line):
            raise error(f"{path}:{at}: has a mark of git between two versions of the file; keep one of them")
    reader, found, at = csv.reader(io.StringIO(text), strict=True), [], 1
    try:
        for cells in reader:
            if any(entries := [cell.strip() for cell in cells]):
                found.append((at, entries))
            at = reader.line_num + 1
    except csv.Error as problem:
        raise error(f"{path}:{at}: is not a table with commas: {problem}") from None
    if found and len(heads := found[0][1]) == 1 and (mark := next((mark for mark in _OTHER_MARKS if mark in heads[0]), "")):
        raise error(f"{path}: the cells are separated by {_OTHER_MARKS[mark]}; write commas, and points in numbers")
    return found


def read(path: Path, columns: Iterable[Column], error: type[Error], remedy: str, *,
         others: Callable[[str], Column | None] = lambda head: None) -> list[Row]:
    """The rows of a table, in the order of the file; columns that it need not have and has not are left out.

    columns : those with known heads;  others : the column of any other head, None if there must be no such column
    remedy : what the user can do, at the end of a message

    Raises `error`, in one line, for whatever is not as it is declared.
    """
    found, at, rows = lines(path, error), 1, []
    try:
        chosen = _chosen(found[0][1] if found else [], {column.name: column for column in columns}, others)
        for at, cells in found[1:]:
            rows.append(_row(chosen, cells))
            rows[-1].line = at
    except ValueError as wrong:
        raise error(one_line(f"{path}:{at}: {wrong}; {remedy}")) from None
    return rows


def _chosen(heads: Sequence[str], declared: dict[str, Column], others: Callable[[str], Column | None]) -> list[Column | None]:
    """The columns of a table in their order; None for the last ones without a head. Raises ValueError."""
    names = [of_cell(head) for head in heads]
    strange = [name for name in names if name and name not in declared]
    for name, column in declared.items():
        if name in names:
            continue
        if bare := next((head for head in strange if name.startswith(f"{head} [")), ""):
            raise ValueError(f'column "{bare}": has no unit, and must be "{name}"')
        if column.required:
            near = nearest(name, strange)
            raise ValueError(f'has no column "{name}"' + (f' (perhaps "{near}" is meant)' if near else ""))
    while names and not names[-1]:
        names.pop()
    columns: dict[str, Column] = {}
    for place, name in enumerate(names, 1):
        if not name:
            raise ValueError(f"column {place} has no head")
        if name in columns:
            raise ValueError(f'column "{name}": is there twice')
        column = declared.get(name) or others(name)
        if column is None:
            raise ValueError(unknown("column", name, declared))
        columns[name] = column
    return [*columns.values(), *[None] * (len(heads) - len(names))]


def _row(columns: Sequence[Column | None], cells: Sequence[str]) -> Row:
    """A row of a table. Raises ValueError."""
    if len(cells) != len(columns):
        raise ValueError(f"has {len(cells)} cells, and the line of heads {len(columns)}")
    row = Row()
    for column, text in zip(columns, map(of_cell, cells), strict=True):
        if column is None and text:
            raise ValueError(f'"{text}" is in a column without a head')
        if column is not None:
            row[column.name] = _entry(column, text)
    return row


def _entry(column: Column, text: str) -> str:
    """The text of a cell as its column has it. Raises ValueError."""
    try:
        if not (text or column.empty):
            raise ValueError("is empty")
        return column.check(text) if text else ""
    except ValueError as wrong:
        raise ValueError(f'column "{column.name}": {wrong}') from None
