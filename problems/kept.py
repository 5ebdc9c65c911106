"""Files of results that lie beside the studies: CSV with a row for each case."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable, Collection, Iterable, Sequence
from pathlib import Path
from statistics import median
from typing import TypeVar

from hydro2d.study import layout
from hydro2d.study.layout import StudyError

R = TypeVar("R")


def rows(path: Path, columns: Collection[str]) -> list[dict[str, str]]:
    """The rows of a file that has at least these columns. Raises StudyError, OSError."""
    with open(path, encoding="utf-8", newline="") as file:
        table = csv.DictReader(file)
        if missing := set(columns) - {*(table.fieldnames or ())}:
            raise StudyError(f"{path}: no file of results: it has no column {', '.join(sorted(missing))}")
        return list(table)


def read(path: Path, columns: Collection[str], of_row: Callable[[dict[str, str]], R], of_case: Callable[[layout.Case], R],
         ended: Collection[str] = (layout.DONE,)) -> list[R]:  # fmt: skip
    """The results in a file with these columns, or of the cases of a study directory that have one of the states `ended`.

    Raises StudyError, OSError, and what `of_row` and `of_case` raise.
    """
    if path.is_file():
        return [of_row(row) for row in rows(path, columns)]
    return [of_case(case) for case in layout.read(path).cases if case.status in ended]


def write(path: Path, columns: Sequence[str], found: Iterable[dict[str, object]]) -> None:
    """Writes a file with these columns; what a row lacks is empty. Raises OSError."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(found)


def show(columns: Sequence[str], of_run: Callable[[Path], Sequence], runs: Iterable[str]) -> None:
    """Prints a row for each run as CSV; of a run for which `of_run` raises ValueError it says on the standard error why."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(columns)
    for run in runs:
        try:
            table.writerow(of_run(Path(run)))
        except ValueError as problem:
            print(f"{run}: {problem}", file=sys.stderr)


def labels(row: dict[str, str], others: Collection[str]) -> dict[str, str]:
    """The labels of a row on the axes of its study: all columns that have something, without `case` and these others."""
    return {name: text for name, text in row.items() if text and name != "case" and name not in others}


def told(rows: Collection[dict[str, str]], column: str) -> str:
    """The median of a column of numbers, and of several that differ the least and the largest: "2.3 (1.9 to 2.6)"."""
    found = sorted((row[column] for row in rows), key=float)
    digits = max(len(each.partition(".")[2]) for each in found)
    return f"{median(map(float, found)):.{digits}f}" + (f" ({found[0]} to {found[-1]})" if found[0] != found[-1] else "")


def grouped(rows: Iterable[dict[str, str]], columns: Sequence[str]) -> dict[tuple[str, ...], list[dict[str, str]]]:
    """The rows by what they have in these columns, in the order in which they come: the members of every case."""
    found: dict[tuple[str, ...], list[dict[str, str]]] = {}
    for row in rows:
        found.setdefault(tuple(row[name] for name in columns), []).append(row)
    return found
