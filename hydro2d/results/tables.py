"""The numbers of pictures as tables for CSV files: lines through the mesh, histories and holes.

A table is in long form: each row belongs to one run, and in a line-out to one time. Heads give the units, as in the pictures.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from hydro2d.base.errors import unknown
from hydro2d.base.formats import cell, shown
from hydro2d.base.units import reader_unit
from hydro2d.files.whole import replacing
from hydro2d.output import history
from hydro2d.results import figures, line_figures
from hydro2d.results.figures import HISTORIES
from hydro2d.results.line_figures import Line
from hydro2d.results.scales import FigureError

#: file ending of a table
ENDING = ".csv"


class Table(NamedTuple):
    """Heads with units, and rows of names and numbers; NaN where a field has no value."""

    heads: list[str]
    rows: list[tuple]


def head(title: str, unit: str) -> str:
    """The head of a column, "pressure [GPa]", in characters that every spreadsheet reads."""
    plain = unit.replace("³", "^3").replace("²", "^2").replace("µ", "u")
    return f"{shown(title)} [{plain}]" if plain not in ("", "1") else shown(title)


def line_outs(runs: list, field: str, line: Line | None = None, times: Sequence[float | None] = (None,)) -> Table:
    """A field along a line: a row for each run (results.Results), time in s (None: the last dump) and cell that it crosses.

    Raises FigureError as `line_figures.line_outs` does.
    """
    rows, heads, names = [], [], ()
    for curve in line_figures.curves(runs, field, line, times):
        names = ("r", "z") if curve.line.label in "rz" else (curve.line.label, "r", "z")
        heads = ["run", head("t", "µs"), *(head(name, "mm") for name in names), head(curve.shown.title, curve.shown.unit)]
        places = {curve.line.label: curve.along, "r": curve.r, "z": curve.z}
        columns = [(places[name] * 1e3).tolist() for name in names]
        rows += [(curve.run.label, curve.time * 1e6, *row) for row in zip(*columns, curve.values.tolist(), strict=True)]
    return Table(heads, rows)


def histories(runs: list, quantities: Sequence[str] = HISTORIES) -> Table:
    """Quantities against time, a row for each run (results.Results) and row of its history. Raises FigureError."""
    heads, rows = ["run", head("t", "µs")], []
    units = [reader_unit(history.unit(name)) for name in quantities]
    heads += [head(history.spoken(name), unit) for name, (unit, _) in zip(quantities, units, strict=True)]
    for run in runs:
        for name in quantities:
            if name not in run.history:
                raise FigureError(f"{run.directory}: {unknown('quantity', name, run.history)}")
        columns = [(run.history["time"] * 1e6).tolist()]
        columns += [(run.history[name] * scale).tolist() for name, (_, scale) in zip(quantities, units, strict=True)]
        rows += [(run.label, *row) for row in zip(*columns, strict=True)]
    return Table(heads, rows)


def craters(runs: list) -> Table:
    """The holes at the end: a row for each run (results.Results), target and place. Raises FigureError if no run has one."""
    heads = ["run", "target", head("depth below the original surface", "mm"), head("radius of the hole", "mm")]
    rows = [(run.label, target, *row) for run in runs for target, depth, radius in figures.holes(run)
            for row in zip(depth.tolist(), radius.tolist(), strict=True)]
    if not rows:
        raise FigureError("no run has a hole to draw")
    return Table(heads, rows)


def _cells(row: Iterable) -> list[str]:
    """A row as written to a file: numbers with ten digits, NaN as an empty cell."""
    return [cell(shown(value)) if isinstance(value, str) else "" if math.isnan(value) else f"{value:.10g}" for value in row]


def save(table: Table, path: Path) -> None:
    """Writes a table as CSV. Raises FigureError."""
    if not path.parent.is_dir():
        raise FigureError(f"{path.parent}: there is no such directory")
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(cell(head) for head in table.heads)
        writer.writerows(_cells(row) for row in table.rows)
