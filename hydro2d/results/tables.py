"""The numbers of pictures as tables for CSV files: lines through the mesh, histories and holes.

A table is in long form: each row belongs to one run, and in a line-out to one time. Heads give the units, as in the pictures.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hydro2d.base.errors import unknown
from hydro2d.base.formats import cell, shown
from hydro2d.base.units import reader_unit
from hydro2d.files.whole import replacing
from hydro2d.output import history
from hydro2d.results import figures, line_figures
from hydro2d.results.figures import HISTORIES
from hydro2d.results.line_figures import Line
from hydro2d.results.scales import FigureError

if TYPE_CHECKING:
    import pandas

#: file ending of a table
ENDING = ".csv"


def head(title: str, unit: str) -> str:
    """The head of a column, "pressure [GPa]", in characters that every spreadsheet reads."""
    plain = unit.replace("³", "^3").replace("²", "^2").replace("µ", "u")
    return f"{shown(title)} [{plain}]" if plain not in ("", "1") else shown(title)


def line_outs(runs: list, field: str, line: Line | None = None, times: Sequence[float | None] = (None,)) -> pandas.DataFrame:
    """A field along a line: a row for each run (results.Results), time in s (None: the last dump) and cell that it crosses.

    Raises FigureError as `line_figures.line_outs` does.
    """
    import pandas

    parts = []
    for curve in line_figures.curves(runs, field, line, times):
        places = {curve.line.label: curve.along, "r": curve.r, "z": curve.z}
        names = ("r", "z") if curve.line.label in "rz" else places
        parts.append(pandas.DataFrame({"run": curve.run.label, head("t", "µs"): curve.time * 1e6,
                                       **{head(name, "mm"): places[name] * 1e3 for name in names},
                                       head(curve.shown.title, curve.shown.unit): curve.values}))
    return pandas.concat(parts)


def histories(runs: list, quantities: Sequence[str] = HISTORIES) -> pandas.DataFrame:
    """Quantities against time, a row for each run (results.Results) and row of its history. Raises FigureError."""
    import pandas

    parts = []
    for run in runs:
        part = {"run": run.label, head("t", "µs"): run.history["time"] * 1e6}
        for name in quantities:
            if name not in run.history:
                raise FigureError(f"{run.directory}: {unknown('quantity', name, run.history)}")
            unit, scale = reader_unit(history.unit(name))
            part[head(history.spoken(name), unit)] = run.history[name] * scale
        parts.append(pandas.DataFrame(part))
    return pandas.concat(parts)


def craters(runs: list) -> pandas.DataFrame:
    """The holes at the end: a row for each run (results.Results), target and place. Raises FigureError if no run has one."""
    import pandas

    parts = [pandas.DataFrame({"run": run.label, "target": target, head("depth below the original surface", "mm"): depth,
                               head("radius of the hole", "mm"): radius})
             for run in runs for target, depth, radius in figures.holes(run)]
    if not any(map(len, parts)):
        raise FigureError("no run has a hole to draw")
    return pandas.concat(parts)


def save(table: pandas.DataFrame, path: Path) -> None:
    """Writes a table as CSV, numbers with ten digits. Raises FigureError."""
    if not path.parent.is_dir():
        raise FigureError(f"{path.parent}: there is no such directory")
    words = {name: column.map(lambda text: cell(shown(text))) for name, column in table.items() if name in ("run", "target")}
    with replacing(path) as temporary:
        table.assign(**words).to_csv(temporary, index=False, header=list(map(cell, table)), float_format="%.10g",
                                     lineterminator="\n")
