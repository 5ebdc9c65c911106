"""The table of a sample: one row for each run with its inputs, its state and its results, in the file samples.csv.

Nothing in it depends on the machine, the workers or an interruption: the same sample gives the same file to the byte.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from hydro2d.files import csv_tables
from hydro2d.files.csv_tables import Column, number, one_of, whole
from hydro2d.files.strange import own
from hydro2d.files.whole import write_text
from hydro2d.study.plan import sample_section, sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, Distribution
from hydro2d.study.plan.sampling import Points
from hydro2d.study.records import keeping
from hydro2d.study.records.differences import numbers
from hydro2d.study.records.keeping import MEMBER, OF_METHOD
from hydro2d.study.records.responses import OF_BODY
from hydro2d.study.records.study_directory import STATUSES, Case, Study

if TYPE_CHECKING:
    import pandas

FILE = "samples.csv"
STATUS, PERFORATED, FINAL, REGIME = "status", "perforated", "final", "regime"
#: results of a projectile; those of a kept row, without its cost
RESULTS = tuple(name for name in keeping.RESULTS if name not in (STATUS, "wall_s"))
YES, NO = "yes", "no"
SAID = {"True": YES, "False": NO}
#: what to do about a table that is not as a sweep wrote it
REMEDY = "remove the file, and hydro2d sweep with --resume writes it anew"


def write(directory: Path, sample: Points, axes: Sequence[str], cases: Sequence[Case], kept: Mapping[str, keeping.Row]) -> Path:
    """Writes the table into the directory of a study and returns its path. Raises OSError.

    axes : names of the axes of the study, without the rows;  kept : rows that the study keeps, for cases without a run, by name
    """
    file = own(Path(directory) / FILE)
    table = _table(sample, axes, cases, {name: of_kept(row, sample.results) for name, row in kept.items()})
    table.columns = [keeping.safe(name) for name in table]
    write_text(file, table.map(keeping.safe).to_csv(index=False, lineterminator="\n"))
    return file


def _table(sample: Points, axes: Sequence[str], cases: Sequence[Case], kept: Mapping[str, keeping.Row]) -> pandas.DataFrame:
    """The table as text, by the names of the cases; columns without an entry are left out, but for those of the inputs.

    kept : state and results of cases without a run, by name
    """
    results = _text([of_run(case, sample.results) if case.status in keeping.ENDED else
                     kept.get(case.name, {STATUS: case.status}) for case in cases], [case.name for case in cases])
    results = results.loc[:, [name in sample.results or any(column) for name, column in results.items()]]
    return _labels(sample, axes, cases).join(results)


def _labels(sample: Points, axes: Sequence[str], cases: Sequence[Case]) -> pandas.DataFrame:
    """Number of the row, labels of the axes, member and inputs of every case, as text."""
    members, clash = any(case.ensemble for case in cases), (sampling.AXIS, STATUS, *RESULTS)
    return _text([{sampling.AXIS: int(case.values[sampling.AXIS]),
                   **{f"{name} (axis)" if name in clash else name: case.values[name] for name in axes},
                   **({MEMBER: case.member} if members else {}), **sample.inputs_of(case.values[sampling.AXIS])}
                  for case in cases], [case.name for case in cases])


def _text(rows: Iterable[Mapping[str, object]], index: Sequence[str] | None = None) -> pandas.DataFrame:
    """Rows of values as a table of text, empty for None, NaN and what a row does not have."""
    import pandas

    table = pandas.DataFrame(rows, index=index, dtype=object)
    return table.where(table.notna(), "").map(lambda value: str(value).strip()).astype(object)


def of_run(case: Case, more: Sequence[str] = ()) -> dict[str, object]:
    """State and results of a run that has ended. ``more`` : names of further numbers of its summary."""
    summary = case.summary
    row = {name: value for name, value in keeping.results(summary).items() if name in RESULTS}
    row[PERFORATED] = SAID.get(str(row[PERFORATED]))
    known = numbers(summary)
    others = [name for name in known if name.startswith(keeping.DEFINED)]
    if row["depth_m"] is None and (body := next(iter(summary.bodies), None)):
        others += [f"bodies.{body}.{name}" for name in OF_BODY]
    row = {STATUS: case.status} | row
    return row | {name: known.get(name) for name in dict.fromkeys((*others, *more)) if name not in row}


def of_kept(kept: keeping.Row, more: Sequence[str]) -> keeping.Row:
    """State and results of a row that the study keeps. ``more`` : names of the results that the sample asks for."""
    defined = (name for name in kept if name.startswith(keeping.DEFINED))
    return ({name: kept.get(name, "") for name in (STATUS, *RESULTS, *defined, *more)}
            | {PERFORATED: SAID.get(kept[PERFORATED], "")})


def values(rows: Iterable[Mapping[str, object]], inputs: Sequence[Distribution] = ()) -> pandas.DataFrame:
    """Rows of such a table as numbers and words; NaN where a run has none."""
    table = _text(rows)
    words = {*sample_section.WORDS, OF_METHOD, *(each.head for each in inputs if each.kind == CHOICE)}
    for name, column in table.items():
        known = column.where(column != "")
        try:
            table[name] = known if name in words else known.astype(float)
        except ValueError:  # labels of an axis
            table[name] = known
    return table


def read(study: Study) -> tuple[pandas.DataFrame, dict[str, str]]:
    """The table of a study as text, by the names of its cases, and what is wrong in samples.csv by case, in words.

    The runs in its directory decide; the file has the results of the cases whose runs are not there. Raises StudyError for a
    file that is not of this study, or that no sweep can have written.
    """
    file, sample, axes = own(study.directory / FILE), study.sample, [axis.name for axis in study.axes[:-1]]
    if not file.is_file():
        raise StudyError(f"{study.directory} has no {FILE}: hydro2d sweep writes it for a study with [sample]")
    labels = _labels(sample, axes, study.cases)
    inputs = [each.head for each in sample.inputs]
    heads = [name for name in labels if name not in inputs]
    about = labels.to_dict("index")
    runs = {tuple(row[head] for head in heads): name for name, row in about.items()}
    lines: dict[str, csv_tables.Row] = {}
    for line in csv_tables.read(file, _columns(sample, heads), StudyError, REMEDY, others=_other):
        case = runs.get(tuple(line[head] for head in heads))
        if case is None or case in lines:
            of = "of no run of this study" if case is None else f"of the same run as line {lines[case].line}"
            raise StudyError(f"{file}:{line.line}: is {of}; {REMEDY}")
        for head in inputs:
            if keeping.differ(line[head], about[case][head]):
                raise StudyError(f'{file}:{line.line}: column "{head}": is {line[head]}, and the run of this line has '
                                 f"{about[case][head]}; {REMEDY}")
        lines[case] = line
    if len(lines) != len(study.cases):
        raise StudyError(f"{file} is not of this study: it has {len(lines)} rows, and there are {len(study.cases)} runs; "
                         f"{REMEDY}")
    ended = {name: {head: text for head, text in line.items() if head not in labels}
             for name, line in lines.items() if line[STATUS] in keeping.ENDED}
    table = _table(sample, axes, study.cases, ended)
    made = table.to_dict("index")
    wrong = {name: f'{file}:{lines[name].line}: column "{head}": "{text}" is ignored: the run has "{made[name][head]}"'
             for name, row in ended.items() for head, text in row.items()
             if head in table and keeping.differ(text, made[name][head])}
    return table, wrong


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
