"""Files of results next to the studies: CSV with a row for each case."""

from __future__ import annotations

import csv
import re
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import TextIO, TypeVar

import hydro2d

R = TypeVar("R")
_BLOCK = re.compile(r"(<!-- (\S+) -->\n).*?(<!-- end -->)", re.DOTALL)


def rows(path: Path, columns: Collection[str]) -> list[dict[str, str]]:
    """The rows of a file that has at least these columns, without lines that begin with #. Raises StudyError, OSError."""
    with open(path, encoding="utf-8", newline="") as file:
        table = csv.DictReader(line for line in file if not line.startswith("#"))
        if missing := set(columns) - {*(table.fieldnames or ())}:
            raise hydro2d.StudyError(f"{path}: no file of results: it has no column {', '.join(sorted(missing))}")
        return list(table)


def read(path: Path, columns: Collection[str], of_row: Callable[[dict[str, str]], R], of_case: Callable[[hydro2d.Case], R],
         ended: Collection[str] = ("done",)) -> list[R]:
    """The results in a file with these columns, or of the cases of a study directory that have one of the states `ended`.

    Raises StudyError, OSError, and the errors of `of_row` and `of_case`.
    """
    if path.is_file():
        return [of_row(row) for row in rows(path, columns)]
    return [of_case(case) for case in hydro2d.open_study(path).cases if case.status in ended]


def write(path: Path, columns: Sequence[str], records: Iterable[dict[str, object]]) -> None:
    """Writes a file with these columns; values that a row lacks are empty. Raises OSError."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        write_to(file, columns, records)


def write_to(file: TextIO, columns: Sequence[str], records: Iterable[dict[str, object]]) -> None:
    """Writes these columns to an open file."""
    table = csv.DictWriter(file, columns, restval="", lineterminator="\n")
    table.writeheader()
    table.writerows(records)


def show(columns: Sequence[str], of_run: Callable[[Path], Sequence], runs: Iterable[str]) -> None:
    """Prints a row for each run as CSV; if `of_run` raises ValueError, prints the reason to the standard error instead."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(columns)
    for run in runs:
        try:
            table.writerow(of_run(Path(run)))
        except ValueError as problem:
            print(f"{run}: {problem}", file=sys.stderr)


def standing(summary: hydro2d.Summary) -> tuple[str, str]:
    """Whether a run is trusted, "yes" or "no", and the version of the method that made it."""
    return "yes" if summary.trustworthy else "no", summary.method


def labels(row: dict[str, str], others: Collection[str]) -> dict[str, str]:
    """The labels of a row on the axes of its study: all columns that are not empty, except `case` and these others."""
    return {name: text for name, text in row.items() if text and name != "case" and name not in others}


def told(rows: Collection[dict[str, str]], column: str) -> str:
    """The median of a column of numbers, with the least and the largest if they differ: "2.3 (1.9 to 2.6)"."""
    values = sorted((row[column] for row in rows), key=float)
    digits = max(len(each.partition(".")[2]) for each in values)
    return f"{median(map(float, values)):.{digits}f}" + (f" ({values[0]} to {values[-1]})" if values[0] != values[-1] else "")


def grouped(rows: Iterable[dict[str, str]], columns: Sequence[str]) -> dict[tuple[str, ...], list[dict[str, str]]]:
    """The rows grouped by their values in these columns, in order of appearance: the members of every case."""
    groups: dict[tuple[str, ...], list[dict[str, str]]] = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in columns), []).append(row)
    return groups


def renew(file: Path, text: str, check: bool) -> bool:
    """Writes a file of results, unless it has this text; check : writes nothing. Returns whether it has another text."""
    changed = not file.is_file() or file.read_text(encoding="utf-8") != text
    if changed:
        print(f"{file.name}: {'is another table' if check else 'written'}")
        if not check:
            file.write_text(text, encoding="utf-8")
    return changed


def filled(text: str, tables: Mapping[str, Callable[[], list[str]]]) -> str:
    """The text of a page with its tables: each stands between `<!-- NAME -->` and `<!-- end -->`, and a function makes it."""
    return _BLOCK.sub(lambda found: "\n".join([found[1].rstrip(), *tables[found[2]](), found[3]]), text)


def fill(pages: Iterable[Path], tables: Mapping[str, Callable[[], list[str]]], check: bool) -> int:
    """Fills pages, and names those that change; check : writes nothing. Returns 1 if a page that is checked would change."""
    status = 0
    for page in pages:
        text = page.read_text(encoding="utf-8")
        new = filled(text, tables)
        if new != text:
            print(f"{page.name}: {'has other tables' if check else 'filled'}")
            status = 1 if check else 0
            if not check:
                page.write_text(new, encoding="utf-8")
    return status
