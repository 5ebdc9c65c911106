"""The table of a sample: one row for each run with its inputs, its state and its results, in the file samples.csv.

Nothing in it depends on the machine, the workers or an interruption: the same sample gives the same file to the byte.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from hydro2d.files import csv_tables
from hydro2d.files.csv_tables import Column, number, one_of, whole
from hydro2d.files.strange import own
from hydro2d.files.whole import write_text
from hydro2d.measure.result import is_number
from hydro2d.study.plan import sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.sampling import Points
from hydro2d.study.records import keeping, table
from hydro2d.study.records.differences import flatten
from hydro2d.study.records.keeping import MEMBER
from hydro2d.study.records.responses import OF_BODY
from hydro2d.study.records.study_directory import STATUSES, Case, Study

FILE = "samples.csv"
STATUS, PERFORATED, FINAL, REGIME = "status", "perforated", "final", "regime"
#: results of a projectile; those of a kept row, without its cost
RESULTS = tuple(name for name in keeping.RESULTS if name not in (STATUS, "wall_s"))
YES, NO = "yes", "no"
#: what to do about a table that is not as a sweep wrote it
REMEDY = "remove the file, and hydro2d sweep with --resume writes it anew"

Row = dict[str, object]


def write(directory: Path, sample: Points, axes: Sequence[str], cases: Sequence[Case], kept: Mapping[str, keeping.Row]) -> Path:
    """Writes the table into the directory of a study and returns its path. Raises OSError.

    axes : names of the axes of the study, without the rows;  kept : rows that the study keeps, for cases without a run, by name
    """
    file = own(Path(directory) / FILE)
    results = {name: of_kept(row, sample.results) for name, row in kept.items()}
    write_text(file, table.to_csv(rows(sample, axes, cases, results)))
    return file


def rows(sample: Points, axes: Sequence[str], cases: Sequence[Case], kept: Mapping[str, Row]) -> list[Row]:
    """The rows of the table in the order of the cases; columns without an entry are left out, but for those of the inputs.

    kept : state and results of cases without a run, by name
    """
    results = [_results(case, kept.get(case.name), sample.results) for case in cases]
    names = [name for name in dict.fromkeys(name for each in results for name in each)
             if any(each.get(name) not in (None, "") for each in results) or name in sample.results]
    members = any(case.ensemble for case in cases)
    return [_run(case, axes, members) | sample.inputs_of(case.values[sampling.AXIS]) | {name: each.get(name) for name in names}
            for case, each in zip(cases, results, strict=True)]


def _run(case: Case, axes: Sequence[str], members: bool) -> Row:
    """Number of the row, labels of the axes, member."""
    labels = {f"{name} (axis)" if name in (sampling.AXIS, STATUS, *RESULTS) else name: case.values[name] for name in axes}
    return {sampling.AXIS: int(case.values[sampling.AXIS]), **labels, **({MEMBER: case.member} if members else {})}


def _results(case: Case, kept: Row | None, more: Sequence[str]) -> Row:
    """State and results of a case: those of its run, or the kept ones; only the state before its end."""
    if case.status not in keeping.ENDED:
        return kept or {STATUS: case.status}
    summary = case.summary
    row = {name: value for name, value in keeping.results(summary).items() if name in RESULTS}
    row[PERFORATED] = None if row[PERFORATED] is None else YES if row[PERFORATED] else NO
    numbers = {name: value for name, value in flatten(summary).items() if is_number(value)}
    others = [name for name in numbers if name.startswith(keeping.DEFINED)]
    if row["depth_m"] is None and (body := next(iter(summary.bodies), None)):
        others += [f"bodies.{body}.{name}" for name in OF_BODY]
    row = {STATUS: case.status} | row
    return row | {name: numbers.get(name) for name in dict.fromkeys((*others, *more)) if name not in row}


def of_kept(kept: keeping.Row, more: Sequence[str]) -> Row:
    """State and results of a row that the study keeps. ``more`` : names of the results that the sample asks for."""
    said = {"True": YES, "False": NO}.get(kept[PERFORATED], "")
    defined = (name for name in kept if name.startswith(keeping.DEFINED))
    return {name: kept.get(name, "") for name in (STATUS, *RESULTS, *defined, *more)} | {PERFORATED: said}


class Table(NamedTuple):
    """The table of a study as text by column, a cell for each case, and what is wrong in samples.csv by case, in words."""

    columns: dict[str, list[str]]
    wrong: dict[str, str]


def read(study: Study) -> Table:
    """The table of a study. The runs in its directory decide; the file has the results of the cases whose runs are not there.

    Raises StudyError for a file that is not of this study, or that no sweep can have written.
    """
    file, sample, axes = own(study.directory / FILE), study.sample, [axis.name for axis in study.axes[:-1]]
    if not file.is_file():
        raise StudyError(f"{study.directory} has no {FILE}: hydro2d sweep writes it for a study with [sample]")
    members = any(case.ensemble for case in study.cases)
    runs = {_texts(_run(case, axes, members)): case for case in study.cases}
    heads = list(_run(study.cases[0], axes, members))
    lines: dict[str, csv_tables.Row] = {}
    for line in csv_tables.read(file, _columns(sample, heads), StudyError, REMEDY, others=_other):
        case = runs.get(tuple(line[head] for head in heads))
        if case is None or case.name in lines:
            of = "of no run of this study" if case is None else f"of the same run as line {lines[case.name].line}"
            raise StudyError(f"{file}:{line.line}: is {of}; {REMEDY}")
        for head, value in sample.inputs_of(case.values[sampling.AXIS]).items():
            if keeping.differ(line[head], str(value)):
                raise StudyError(f'{file}:{line.line}: column "{head}": is {line[head]}, and the run of this line has {value}; '
                                 f"{REMEDY}")
        lines[case.name] = line
    if len(lines) != len(study.cases):
        raise StudyError(f"{file} is not of this study: it has {len(lines)} rows, and there are {len(study.cases)} runs; "
                         f"{REMEDY}")
    others = (*heads, *(each.head for each in sample.inputs))
    ended = {name: {head: text for head, text in line.items() if head not in others}
             for name, line in lines.items() if line[STATUS] in keeping.ENDED}
    made = rows(sample, axes, study.cases, ended)
    columns = dict(zip(made[0], map(list, zip(*map(_texts, made), strict=True)), strict=True))
    wrong = {}
    for place, case in enumerate(study.cases):
        for head, text in ended.get(case.name, {}).items():
            if head in columns and keeping.differ(text, right := columns[head][place]):
                where = f'{file}:{lines[case.name].line}: column "{head}"'
                wrong[case.name] = f'{where}: "{text}" is ignored: the run has "{right}"'
    return Table(columns, wrong)


def _texts(row: Row) -> tuple[str, ...]:
    return tuple("" if value is None or value != value else str(value).strip() for value in row.values())


def _columns(sample: Points, heads: Sequence[str]) -> list[Column]:
    """The columns of the table; ``heads`` : those of number of the row, labels of the axes, and member."""
    results = [replace(column, required=False) for column in keeping.OF_RESULTS if column.name in RESULTS
               and column.name != PERFORATED]
    return [
        *(Column(head, whole if head in (sampling.AXIS, MEMBER) else str, empty=head not in (sampling.AXIS, MEMBER))
          for head in heads),
        *map(keeping.input_column, sample.inputs), Column(STATUS, one_of(*STATUSES), empty=False),
        *results, Column(PERFORATED, one_of(YES, NO), required=False),
        *(Column(name, number, required=False) for name in sample.results if name not in (*RESULTS, STATUS)),
    ]


def _other(head: str) -> Column | None:
    """The column of a quantity that a deck derives, or of a body."""
    return Column(head, number) if head.startswith((keeping.DEFINED, "bodies.")) else None
