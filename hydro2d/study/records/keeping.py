"""The rows that a study keeps in the folder of its file: a CSV with one row for every run that has ended, on any machine.

A row identifies its run by the labels of the case, cells across the projectile, and member; by the set-up, a hash of everything
in the deck that can change a result; and by the version of the method. A run with a row of its set-up and of this method is up
to date, and a sweep does not repeat it. The row of another set-up or method is stale. It stays until its run has been made.
The row of a run of a sample has the values of its inputs as well, and the results that the sample names.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from hydro2d.base.method_version import METHOD
from hydro2d.base.terminal import cell, of_cell, several
from hydro2d.deck import deck as decks
from hydro2d.files.whole import read_text, write_text
from hydro2d.measure.outcome import Outcome
from hydro2d.output.directory import DECK
from hydro2d.study.plan import sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.members import cells_across, projectile
from hydro2d.study.plan.planned import Plan, Planned
from hydro2d.study.records import study_directory
from hydro2d.study.records.differences import flatten
from hydro2d.study.records.study_directory import DONE, UNPHYSICAL, Case

#: statuses of runs that have a row
ENDED = (DONE, UNPHYSICAL)
#: tables and keys of a deck that change no result
TOLD = ("name", "title", "output", "experiment", "tracer", "materials")
#: letters of a hash, and significant digits of a number, in a row
LETTERS, DIGITS = 12, 6

CELLS, MEMBER, SETUP, OF_METHOD = "cells_across", "member", "setup", "method"
#: columns after the labels of a case
RESULTS = ("status", "stop_reason", "trustworthy", "depth_m", "length_ratio", "radius_ratio", "mass_ratio", "tail_velocity_m_s",
           "residual_velocity_m_s", "regime", "hole_m3", "energy_dropped", "time_s", "cycles", "wall_s")  # fmt: skip
ORIGIN = (SETUP, OF_METHOD, "commit", "date")

#: parameters of materials that are later than the first kept rows, with the values at which they change nothing
LATER = {"hugoniot_slope_2": 0.0, "hugoniot_slope_3": 0.0}

Row = dict[str, str]


class KeptRow(Row):
    """A run of a study in a few numbers: a row of a file of kept rows, the text of each column by its name.

    The columns are those of a file that a study keeps: the labels of the case on the axes, ``cells_across`` the projectile,
    ``member`` of the ensemble, ``status``, the results in SI units, and ``setup``, ``method``, ``commit`` and ``date``; of a
    sample also its inputs, after the labels, and the results that it names. The text of a result that the run does not have is
    empty.
    """

    @property
    def labels(self) -> dict[str, str]:
        """The labels of the case by axis, the inputs of a sample, and ``cells_across``, without those that are empty."""
        others = {MEMBER, *RESULTS, *ORIGIN}
        return {name: text for name, text in self.items() if text and name not in others}


def setup(deck: decks.Deck) -> str:
    """A hash of everything in a deck that can change its results, without keys that have their default values.

    Titles, outputs, tracers and the experiment are left out. A new key of a later version leaves the hash alone, as does a new
    parameter of a material that is in LATER.
    """
    data = deck.model_dump(mode="json", exclude=set(TOLD), exclude_defaults=True)
    materials = {name: {key: _without_later(value) for key, value in material.as_deck().items() if key != "title"}
                 for name, material in deck.materials.items()}  # fmt: skip
    text = json.dumps(data | {"materials": materials}, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:LETTERS]


def _without_later(part):
    """A part of a material without parameters that are in LATER and change nothing."""
    if not isinstance(part, dict):
        return part
    return {key: value for key, value in part.items() if not (key in LATER and value == LATER[key])}


@dataclass(frozen=True)
class Wanted:
    """A case of a plan, with the entries that its row must have to be up to date.

    inputs : of a sample, by their heads;  more : names of the results that it asks for
    """

    case: Planned
    axes: tuple[str, ...]
    inputs: Row = field(default_factory=dict)
    more: tuple[str, ...] = ()

    @cached_property
    def deck(self) -> decks.Deck:
        return decks.loads(self.case.text)

    @cached_property
    def setup(self) -> str:
        return setup(self.deck)

    @cached_property
    def about(self) -> Row:
        """The columns that identify the run."""
        radius = projectile(self.deck)[1]
        cells = "" if radius is None else f"{cells_across(self.deck, radius):.4g}"
        return {**{name: self.case.values[name] for name in self.axes}, CELLS: cells, MEMBER: str(self.case.member)}

    def row(self, case: Case) -> Row:
        """The row of a run that has ended."""
        summary = case.summary
        origin = summary.get("provenance") or {}
        commit = (origin.get("git_commit") or "")[:LETTERS] + ("+" if origin.get("git_dirty") else "")
        entries = {**results(summary), SETUP: self.setup, OF_METHOD: summary.get("method", ""), "commit": commit,
                   "date": (origin.get("written") or "")[:10]}  # fmt: skip
        numbers = flatten(summary) if self.more else {}
        entries |= {name: numbers.get(name) for name in self.more}
        return self.about | self.inputs | {name: _text(value) for name, value in entries.items()}


def _inputs(sample: sampling.Points | None, case: Planned) -> Row:
    """The inputs of a case of a sample by their heads, as text; empty without a sample."""
    if sample is None:
        return {}
    values = sample.rows[int(case.values[sampling.AXIS]) - 1]
    return {each.head: value if isinstance(value, str) else repr(value)
            for each, value in zip(sample.inputs, values, strict=True)}  # fmt: skip


def results(summary: Mapping) -> dict[str, object]:
    """The results of a summary by the names of RESULTS, SI; None for those that it does not have."""
    outcome = summary.get("outcome") or {}
    values = {name: summary.get(name) for name in ("status", "stop_reason", "trustworthy", "regime", "time_s", "cycles", "wall_s")}
    values |= {name: outcome.get(name) for name in Outcome.model_fields}
    values |= {"tail_velocity_m_s": summary.get("rod_tail_velocity_m_s"),
               "hole_m3": (summary.get("crater") or {}).get("volume_m3")}  # fmt: skip
    return {name: values[name] for name in RESULTS}


def _text(value) -> str:
    if value is None:
        return ""
    return f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)


def _safe(text: str) -> str:
    """A text of a row as a cell of a file; a number stays as it is, also below zero."""
    try:
        float(text)
    except ValueError:
        return cell(text)
    return text


def kept_rows(path: str | Path) -> list[KeptRow]:
    """The runs of a study that have ended, a row for each, from what the study keeps or from its directory.

    path : a file that a study with ``keep`` has written, or the directory of a study, finished or not

    Raises StudyError, also if there is no such file or directory, and DeckError.
    """
    path = Path(path)
    return read(path) if path.is_file() else _of_directory(path)


def read(path: Path) -> list[KeptRow]:
    """The rows of a file; none if there is no such file. Raises StudyError."""
    if not path.exists():
        return []
    lines = csv.DictReader(read_text(path, StudyError).splitlines(), restval="")
    rows = list(lines)
    if rows and (missing := {*ORIGIN, *RESULTS, CELLS, MEMBER} - set(rows[0])):
        raise StudyError(f"{path}: holds no rows of a study: it has no column {', '.join(sorted(missing))}")
    return [KeptRow({name: of_cell(row[name]) for name in lines.fieldnames or ()}) for row in rows]


def _of_directory(directory: Path) -> list[KeptRow]:
    """The rows of the ended runs of a study directory. Raises StudyError, DeckError."""
    study = study_directory.read(directory)
    axes, sample, rows = tuple(axis.name for axis in study.axes), study.sample, []
    for case in study.cases:
        if case.status in ENDED:
            text = read_text(case.directory / DECK, StudyError)
            planned = Planned(case.name, case.values, case.base, list(case.overrides), text, "", case.of, case.member)
            wanted = Wanted(planned, axes, _inputs(sample, planned), sample.results if sample else ())
            rows.append(KeptRow(wanted.row(case)))
    return rows


def method_note(versions: Iterable[str]) -> str:
    """A sentence for a table of runs that are not all of the present version of the method; empty if all are.

    versions : ``method`` of the kept row or of the summary of each run; empty if it is not known
    """
    counts = Counter(version or "unknown" for version in versions)
    others = {name: number for name, number in counts.items() if name != METHOD}
    if not others:
        return ""
    listed = ", ".join(f"{number} of {name}" for name, number in sorted(others.items()))
    return f"Not all runs are of the method of {METHOD}: {listed}."


class Keeper:
    """The kept rows of a plan: those of its cases that are up to date, and new ones as cases end.

    plan : with `keep`;  cases that a search adds later are found by their decks

    Raises StudyError for an axis that is named like a column of the file, and for a file of another study.
    """

    def __init__(self, plan: Plan):
        self.path, self.axes = plan.keep, tuple(axis["name"] for axis in plan.axes)
        if taken := [name for name in self.axes if name in (CELLS, MEMBER, *RESULTS, *ORIGIN)]:
            raise StudyError(f'{plan.name}: the file of kept rows has a column "{taken[0]}" of its own; give that axis another '
                             "name")
        self.order = {axis["name"]: {label: n for n, label in enumerate(axis["values"])} for axis in plan.axes}
        self.rows = read(self.path)
        if self.rows and (strange := [name for name in self.axes if name not in self.rows[0]]):
            raise StudyError(f"{self.path}: is of another study: it has no column {strange[0]}")
        self.heads = tuple(each.head for each in plan.sample.inputs) if plan.sample else ()
        self.more = plan.sample.results if plan.sample else ()
        self.wanted = {case.name: Wanted(case, self.axes, _inputs(plan.sample, case), self.more)
                       for case in plan.cases if case.text}  # fmt: skip

    def fresh(self, names: Iterable[str]) -> set[str]:
        """Those of the cases of the plan that are up to date."""
        return self.fresh_of(self.wanted[name].case for name in names if name in self.wanted)

    def fresh_of(self, cases: Iterable[Planned]) -> set[str]:
        """The names of those cases that are up to date, of the plan or not."""
        wanted = (self.wanted.get(case.name) or Wanted(case, self.axes) for case in cases)
        return set(self._rows_of(wanted))

    def rows_of(self, names: Iterable[str]) -> dict[str, Row]:
        """The up to date rows of those cases of the plan that have one."""
        return self._rows_of(self.wanted[name] for name in names if name in self.wanted)

    def _rows_of(self, wanted: Iterable[Wanted]) -> dict[str, Row]:
        """The rows of this version of the method by the names of their cases; no deck is hashed where there are none."""
        known = {row[SETUP]: row for row in self.rows if row[OF_METHOD] == METHOD and self._is_whole(row)}
        return {each.case.name: known[each.setup] for each in wanted if each.setup in known} if known else {}

    def _is_whole(self, row: Row) -> bool:
        """Whether a row has all columns of a sample; inputs and results may have been named since it was written."""
        return all(row.get(head) for head in self.heads) and all(name in row for name in self.more)

    def stale(self, names: Sequence[str]) -> int:
        """The number of cases that have a row, but none that is up to date."""
        fresh, known = self.fresh(names), {self._identity(row) for row in self.rows}
        return sum(self._identity(self.wanted[name].about) in known for name in names
                   if name in self.wanted and name not in fresh)  # fmt: skip

    def in_words(self, names: Sequence[str]) -> str:
        """The numbers of cases that are up to date, stale, or without a row, in words."""
        fresh, stale = self.fresh(names), self.stale(names)
        missing = len(names) - len(fresh) - stale
        return f"{self.path}: {several(len(fresh), 'run')} up to date, {stale} stale, {missing} not made"

    def _identity(self, row: Row) -> tuple[str, ...]:
        return *(row[name] for name in self.axes), row[CELLS], row[MEMBER]

    def add(self, cases: Iterable[Case], planned: Iterable[Planned] = ()) -> None:
        """Writes the rows of those cases that have ended; planned : cases that the plan did not have. Raises OSError."""
        self.wanted |= {case.name: Wanted(case, self.axes) for case in planned if case.text and case.name not in self.wanted}
        new = [self.wanted[case.name].row(case) for case in cases if case.status in ENDED and case.name in self.wanted]
        new = [row for row in new if row[OF_METHOD] == METHOD and row not in self.rows]
        if not new:
            return
        self.rows = read(self.path)  # another sweep may have added some
        kept = {self._identity(row): row for row in (*self.rows, *new)}
        self.rows = sorted(kept.values(), key=self._place)
        self.path.parent.mkdir(exist_ok=True)
        text = io.StringIO()
        heads = dict.fromkeys((*self.axes, *self.heads, CELLS, MEMBER, *RESULTS, *self.more, *ORIGIN))
        table = csv.DictWriter(text, heads, restval="", extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows({name: _safe(text) for name, text in row.items()} for row in self.rows)
        write_text(self.path, text.getvalue())

    def _place(self, row: Row) -> tuple:
        """Finer meshes later, cases in the order of the study, members of a case one after another."""
        labels = [self.order[name].get(row[name], len(self.order[name])) for name in self.axes]
        return float(row[CELLS] or 0.0), *labels, *self._identity(row)[: len(self.axes)], int(row[MEMBER])
