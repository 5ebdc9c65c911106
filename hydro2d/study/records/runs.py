"""One table of runs: a row for each, with the same columns from run directories, studies and files of kept rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hydro2d.files.csv_tables import flag, number, whole
from hydro2d.measure.result import unit
from hydro2d.output.directory import STUDY
from hydro2d.study.plan import sampling
from hydro2d.study.plan.planned import short
from hydro2d.study.records import keeping, study_directory
from hydro2d.study.records.differences import numbers
from hydro2d.study.records.keeping import CELLS, MEMBER, ORIGIN, RESULTS
from hydro2d.study.records.study_directory import Case, Study

if TYPE_CHECKING:
    import pandas

#: how the text of a kept row becomes a value, by the check of its column; that of any other column is a word
VALUES = {number: float, whole: int, flag: lambda text: text == "True"}
CHECKS = {column.name: column.check for column in keeping.COLUMNS}

Row = dict[str, object]


def runs(*places: str | Path, results: Sequence[str] = ()) -> pandas.DataFrame:
    """All runs of some places in one table, a row for each run, indexed by case and member; SI.

    places : run directories, directories of studies, folders of run directories, and files of kept rows
    results : further numbers of summary.json by their dotted names, such as "crater.mean_diameter_m"

    The columns are the labels on the axes and the inputs of a sample, which are numbers where no run has a word,
    ``cells_across``, the results of a kept row, what the deck derives, ``results``, and ``setup``, ``method``, ``commit`` and
    ``date``. A run that has not ended has a status only. A result that a run does not have is NaN, or <NA> where it is yes or
    no. ``attrs["units"]`` has the unit of
    every column that is a quantity. Numbers of a file of kept rows have six digits; of ``results`` it has those that its study
    asks for.

    Raises StudyError for a place without runs, and for a file that is not as a sweep wrote it.
    """
    import pandas

    rows = [row for place in map(Path, places) for row in (_kept(place) if place.is_file() else _made(place, results))]
    last = (*RESULTS, *(name for row in rows for name in row if name.startswith(keeping.DEFINED)), *results, *ORIGIN)
    first = dict.fromkeys(("case", MEMBER, *(name for row in rows for name in row if name not in last)))
    table = pandas.DataFrame(rows, columns=[*first, *dict.fromkeys(last)]).set_index(["case", MEMBER])
    quantities = [name for name in dict.fromkeys((CELLS, *last)) if CHECKS.get(name, number) is number and name in table]
    flags = [name for name in table if CHECKS.get(name) is flag]
    table = table.astype({**dict.fromkeys(quantities, float), **dict.fromkeys(flags, "boolean")})
    for name in (name for name in first if name in table and name not in CHECKS):
        table[name] = _numbers(table[name])
    table.attrs["units"] = {name: unit(name) for name in quantities}
    return table


def _numbers(column: pandas.Series) -> pandas.Series:
    """A column of labels, inputs or further results as numbers, if it has no words."""
    try:
        return column.map(lambda value: float(number(str(value))), na_action="ignore").astype(float)
    except ValueError:
        return column


def _kept(file: Path) -> list[Row]:
    """The runs of a file of kept rows."""
    return [{"case": _case(keeping.labels(row)), **{name: VALUES.get(CHECKS.get(name), str)(text) if text else None
                                                   for name, text in row.items()}} for row in keeping.read(file)]


def _case(labels: Mapping[str, str]) -> str:
    """The name of a case by its labels on the axes, of which the row of a sample is the last one."""
    names = [name for name in labels if name != CELLS]
    axes = names[: names.index(sampling.AXIS) + 1] if sampling.AXIS in names else names
    return "_".join(sampling.NAME.format(labels[name]) if name == sampling.AXIS else short(labels[name]) for name in axes)


def _made(directory: Path, more: Sequence[str]) -> list[Row]:
    """The runs of a directory: itself, those of a study, or those in it."""
    study = study_directory.read(directory) if (directory / STUDY).is_file() else study_directory.gather([directory])
    return [_row(study, case, more) for case in study.cases]


def _row(study: Study, case: Case, more: Sequence[str]) -> Row:
    labels = {axis.name: case.values.get(axis.name) for axis in study.axes}
    inputs = study.sample.inputs_of(case.values[sampling.AXIS]) if study.sample else {}
    row: Row = {"case": case.group, MEMBER: case.member, **labels, **inputs, "status": case.status}
    if case.status not in keeping.ENDED:
        return row
    summary = case.summary
    known = numbers(summary)
    return {**row, CELLS: summary.cells_across, **keeping.results(summary),
            **{name: value for name, value in known.items() if name.startswith(keeping.DEFINED)},
            **{name: known.get(name) for name in more}, **keeping.origin(summary)}
