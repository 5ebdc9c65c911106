"""The table of a sample: one row for each run with its inputs, its state and its results, in the file samples.csv.

Nothing in it depends on the machine, the workers or an interruption: the same sample gives the same file to the byte.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

from hydro2d.base.terminal import of_cell
from hydro2d.files.strange import own
from hydro2d.files.whole import read_text, write_text
from hydro2d.measure.outcome import CUT, RESTED
from hydro2d.measure.result import is_number
from hydro2d.study.plan import sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.sampling import Points
from hydro2d.study.records import keeping, table
from hydro2d.study.records.differences import flatten
from hydro2d.study.records.keeping import MEMBER
from hydro2d.study.records.responses import OF_BODY
from hydro2d.study.records.study_directory import DONE, Case

FILE = "samples.csv"
STATUS, PERFORATED, RESIDUAL, REGIME = "status", "perforated", "residual_velocity_m_s", "regime"
#: results of a projectile; those of a kept row, without its cost, and whether it perforates
RESULTS = (*(name for name in keeping.RESULTS if name not in (STATUS, "wall_s")), PERFORATED)
YES, NO = "yes", "no"

Row = dict[str, object]


def write(directory: Path, sample: Points, axes: Sequence[str], cases: Sequence[Case], kept: Mapping[str, keeping.Row]) -> Path:
    """Writes the table into the directory of a study and returns its path. Raises OSError.

    axes : names of the axes of the study, without the rows;  kept : rows that the study keeps, for cases without a run, by name
    """
    file = own(Path(directory) / FILE)
    write_text(file, table.to_csv(rows(sample, axes, cases, kept)))
    return file


def rows(sample: Points, axes: Sequence[str], cases: Sequence[Case], kept: Mapping[str, keeping.Row]) -> list[Row]:
    """The rows of the table in the order of the cases; columns without an entry are left out, but for those of the inputs."""
    results = [_results(case, kept.get(case.name, {}), sample.results) for case in cases]
    names = [name for name in dict.fromkeys(name for each in results for name in each)
             if any(each.get(name) not in (None, "") for each in results) or name in sample.results]  # fmt: skip
    members = any(case.ensemble for case in cases)
    labels = {name: f"{name} (axis)" if name in (sampling.AXIS, STATUS, *RESULTS) else name for name in axes}
    return [_about(case, sample, labels, members) | {name: each.get(name) for name in names}
            for case, each in zip(cases, results, strict=True)]  # fmt: skip


def _about(case: Case, sample: Points, labels: Mapping[str, str], members: bool) -> Row:
    """Number of the row, labels of the axes, member, inputs."""
    row = int(case.values[sampling.AXIS])
    own = {labels[name]: case.values[name] for name in labels}
    inputs = {each.head: value for each, value in zip(sample.inputs, sample.rows[row - 1], strict=True)}
    return {sampling.AXIS: row, **own, **({MEMBER: case.member} if members else {}), **inputs}


def _results(case: Case, kept: keeping.Row, more: Sequence[str]) -> Row:
    """State and results of a case: those of its run, or of the row that the study keeps; only the state before its end."""
    if case.status not in keeping.ENDED:
        return {STATUS: case.status} if not kept else of_kept(kept, more)
    summary = case.summary
    row = {name: value for name, value in keeping.results(summary).items() if name in RESULTS}
    perforated = (summary.get("outcome") or {}).get(PERFORATED)
    row[PERFORATED] = None if perforated is None else YES if perforated else NO
    numbers = {name: value for name, value in flatten(summary).items() if is_number(value)}
    others = [name for name in numbers if name.startswith("derived.")]
    if row["depth_m"] is None and (body := next(iter(summary.get("bodies") or ()), None)):
        others += [f"bodies.{body}.{name}" for name in OF_BODY]
    row = {STATUS: case.status} | row
    return row | {name: numbers.get(name) for name in dict.fromkeys((*others, *more)) if name not in row}


def of_kept(kept: keeping.Row, more: Sequence[str]) -> Row:
    """State and results of a row that the study keeps. ``more`` : names of the results that the sample asks for."""
    row: Row = {name: kept.get(name, "") for name in (STATUS, *RESULTS, *more) if name != PERFORATED}
    if kept.get("depth_m") and kept[REGIME] != "left the mesh":
        stopped = not kept[RESIDUAL] or kept["stop_reason"].startswith(RESTED)
        row[PERFORATED] = NO if stopped else YES
        if stopped and kept[STATUS] == DONE and kept["stop_reason"] not in CUT:
            row[RESIDUAL] = "0"
    return row


def read(directory: Path) -> dict[str, list[str]]:
    """The table of a study as text by column. Raises StudyError."""
    file = own(Path(directory) / FILE)
    if not file.is_file():
        raise StudyError(f"{directory} has no {FILE}: hydro2d sweep writes it for a study with [sample]")
    lines = list(csv.reader(read_text(file, StudyError).splitlines(), strict=True))
    if not lines or any(len(line) != len(lines[0]) for line in lines) or sampling.AXIS not in lines[0]:
        raise StudyError(f"{file} is not a table of a sample")
    return {of_cell(name): [of_cell(line[number]) for line in lines[1:]] for number, name in enumerate(lines[0])}
