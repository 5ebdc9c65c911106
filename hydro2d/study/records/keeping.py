"""The rows that a study keeps in the folder of its file: a CSV with one row for every run that has ended, on any machine.

A row identifies its run by the labels of the case, cells across the projectile, and member; by the set-up, a hash of everything
in the deck that can change a result; and by the version of the method. A run with a row of its set-up and of this method is up
to date, and a sweep does not repeat it. The row of another set-up or method is stale. It stays until its run has been made.
The row of a run of a sample has the values of its inputs as well, and the results that the sample names. What [derived] of the
deck defines and files of [result] measure has a column each.
"""

from __future__ import annotations

import csv
import io
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from hydro2d.base.formats import cell
from hydro2d.base.method_version import METHOD
from hydro2d.base.terminal import several
from hydro2d.deck import deck as decks
from hydro2d.deck.identity import LETTERS
from hydro2d.files import csv_tables
from hydro2d.files.csv_tables import Column, flag, like, number, one_of, whole
from hydro2d.files.locks import locked
from hydro2d.files.whole import write_text
from hydro2d.measure.outcome import AT_LEAST, AT_MOST, COMPUTED, CUT, EXACT, NONE, Outcome, rested
from hydro2d.measure.regime import LEFT, REGIMES
from hydro2d.measure.summary import Provenance, Summary
from hydro2d.study.plan import sampling, velocities
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, Distribution
from hydro2d.study.plan.planned import Plan, Planned
from hydro2d.study.records.differences import numbers
from hydro2d.study.records.study_directory import DONE, UNPHYSICAL, Case

#: statuses of runs that have a row
ENDED = (DONE, UNPHYSICAL)
#: significant digits of a number in a row
DIGITS = 6

CELLS, MEMBER, SETUP, OF_METHOD = "cells_across", "member", "setup", "method"
#: columns after the labels of a case
RESULTS = ("status", "stop_reason", "trustworthy", *Outcome.model_fields, "tail_velocity_m_s", "regime", "hole_m3", "time_s",
           "cycles", "wall_s")
#: those that rows of earlier versions lack
LATER = ("perforated", "final", "depth_is", "depth_error_m", "depth_error_percent", "depth_error_is", "residual_error_m_s")
ORIGIN = (SETUP, OF_METHOD, "commit", "date")
#: beginning of the columns of what decks define
DEFINED = "derived."
#: results that depend on the machine
OF_MACHINE = ("wall_s",)
#: the regime of rows that were kept before the length of a rod told the two apart
UNDECIDED = "rigid or deforming"
#: the columns of results, and of every file of kept rows but for the labels of the cases
_WORDS = {"status": Column("status", one_of(*ENDED), empty=False), "stop_reason": Column("stop_reason"),
          "trustworthy": Column("trustworthy", flag), "regime": Column("regime", one_of(*REGIMES, UNDECIDED)),
          "perforated": Column("perforated", flag), "final": Column("final", flag),
          "depth_is": Column("depth_is", one_of(COMPUTED, AT_LEAST)),
          "depth_error_is": Column("depth_error_is", one_of(EXACT, AT_LEAST, AT_MOST, NONE))}
OF_RESULTS = tuple(replace(_WORDS.get(name) or Column(name, number), required=name not in LATER) for name in RESULTS)
COLUMNS = (
    Column(CELLS, number), Column(MEMBER, whole, empty=False), *OF_RESULTS,
    Column(SETUP, like(rf"[0-9a-f]{{{LETTERS}}}", f"a hash of {LETTERS} digits from 0 to f")),
    Column(OF_METHOD, like(r"\d{4}-\d\d-\d\d(\.\d+)?", "a version, such as 2026-01-31")),
    Column("commit"), Column("date", like(r"\d{4}-\d\d-\d\d", "a date as 2026-01-31")),
)
#: the check of a velocity of a search
OF_SPEED = like(r"-?\d+(\.\d+)?(e[+-]?\d+)? m/s", "a velocity in m/s")
#: what to do about a file that is not as a sweep wrote it
REMEDY = "correct it, or bring back the file as a sweep of this study wrote it"
#: how long a sweep waits for another one that writes into the file, s
PATIENCE = 60.0


Row = dict[str, str]


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
        return self.deck.setup

    @cached_property
    def about(self) -> Row:
        """The columns that identify the run."""
        across = self.deck.cells_across
        cells = "" if across is None else f"{across:.4g}"
        return {**{name: self.case.values[name].strip() for name in self.axes}, CELLS: cells, MEMBER: str(self.case.member)}

    def row(self, case: Case) -> Row:
        """The row of a run that has ended."""
        entries = {**results(case.summary), **origin(case.summary), SETUP: self.setup}
        known = numbers(case.summary)
        more = (*(name for name in known if name.startswith(DEFINED)), *self.more)
        entries |= {name: known.get(name) for name in more if name not in entries}
        return self.about | self.inputs | {name: _text(value) for name, value in entries.items()}


def _inputs(sample: sampling.Points | None, case: Planned) -> Row:
    """The inputs of a case of a sample by their heads, as text; empty without a sample."""
    if sample is None:
        return {}
    inputs = sample.inputs_of(case.values[sampling.AXIS])
    return {head: value if isinstance(value, str) else repr(value) for head, value in inputs.items()}


def results(summary: Summary) -> dict[str, object]:
    """The results of a summary by the names of RESULTS, SI; None for those that it does not have."""
    values = dict(summary) | dict(summary.outcome or Outcome())
    values |= {"tail_velocity_m_s": summary.rod_tail_velocity_m_s, "hole_m3": summary.crater and summary.crater.volume_m3}
    return {name: values[name] for name in RESULTS}


def origin(summary: Summary) -> dict[str, str | None]:
    """The set-up, the version of the method, the commit and the date of a run by the names of ORIGIN."""
    about = summary.provenance or Provenance()
    commit = (about.git_commit or "")[:LETTERS] + ("+" if about.git_dirty else "")
    return {SETUP: summary.setup, OF_METHOD: summary.method, "commit": commit, "date": (about.written or "")[:10]}


def _text(value) -> str:
    if value is None:
        return ""
    return f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)


def safe(text: str) -> str:
    """A text of a row as a cell of a file; a number stays as it is, also below zero."""
    try:
        float(text)
    except ValueError:
        return cell(text)
    return text


def labels(row: Row) -> Row:
    """The labels of the case by axis, the inputs of a sample, and ``cells_across``, without those that are empty."""
    others = {MEMBER, *RESULTS, *ORIGIN}
    return {name: text for name, text in row.items() if text and name not in others and not name.startswith(DEFINED)}


def read(path: Path, own: Sequence[Column] = (), axes: Sequence[str] | None = None) -> list[csv_tables.Row]:
    """The rows of a file, each run once; none if there is no such file.

    own : further columns that the study has;  axes : their names; None: all columns but those of every file

    Raises StudyError for a cell that no run can have, and for two rows of a run, or of a set-up, with different results.
    """
    if not path.exists():
        return []
    common = {column.name for column in COLUMNS}
    columns = (*COLUMNS, *(column for column in own if column.name not in common))
    kept: dict[tuple, csv_tables.Row] = {}
    for row in csv_tables.read(path, columns, StudyError, REMEDY, others=_other):
        _renew(row)
        run = tuple(labels(row).items() if axes is None else (row[name] for name in axes)), row[CELLS], row[MEMBER]
        of_setup = (row[SETUP], row[OF_METHOD]) if row[SETUP] else run
        for same, what in ((run, "run"), (of_setup, "set-up")):
            other = kept.setdefault((what, *same), row)
            if name := next((name for name in (SETUP, OF_METHOD, *RESULTS)
                             if row[name] != other[name] and name not in OF_MACHINE), ""):
                here, there = row[name], f'line {other.line} has "{other[name]}" for the same {what}'
                raise StudyError(f'{path}:{row.line}: column "{name}": "{here}", and {there}; remove the line that is wrong')
    return [row for (what, *_), row in kept.items() if what == "run"]


def _other(head: str) -> Column:
    """A column of a file that is not known beforehand: of what decks define, else of any text."""
    return Column(head, number) if head.startswith(DEFINED) else Column(head)


def _renew(row: Row) -> None:
    """Adds to a row of an earlier version what its shot came to.

    Such a row of a shot that perforates has the place where its nose was: its depth, the thickness of the target, is not known.
    """
    row.update({name: "" for name in LATER if name not in row})
    if row["perforated"] or not row["regime"]:
        return
    left = row["regime"] == LEFT
    stopped = not row["residual_velocity_m_s"] or rested(row["stop_reason"])
    row["perforated"] = "" if left else str(not stopped)
    row["depth_is"] = COMPUTED if stopped and not left else AT_LEAST
    row["final"] = str(row["status"] == DONE and (not stopped or left or row["stop_reason"] not in CUT))
    if stopped and not left and row["final"] == "True":
        row["residual_velocity_m_s"] = "0"
    if not stopped and not left:
        row["depth_m"] = ""


def input_column(each: Distribution, stale: bool = False) -> Column:
    """The column of an input; stale : whether the table may have rows of older set-ups, without it or with other words."""
    words = each.kind == CHOICE
    check = (str if stale else one_of(*each.levels)) if words else number
    return Column(each.head, check, required=not stale, empty=stale)


def differ(one: str, other: str) -> bool:
    """Whether two cells differ by more than the digits that a row or a spreadsheet leaves of a number."""
    try:
        return not math.isclose(float(one), float(other), rel_tol=1e-5, abs_tol=0.0)
    except ValueError:
        return one != other


def method_note(versions: Iterable[object]) -> str:
    """A sentence for a table of runs that are not all of the present version of the method; empty if all are.

    versions : ``method`` of each run; empty or NaN if it is not known
    """
    counts = Counter(version if isinstance(version, str) and version else "unknown" for version in versions)
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
        inputs = plan.sample.inputs if plan.sample else ()
        self.heads = tuple(each.head for each in inputs)
        self.more = plan.sample.results if plan.sample else ()
        self.wanted = {case.name: Wanted(case, self.axes, _inputs(plan.sample, case), self.more)
                       for case in plan.cases if case.text}
        checks = {velocities.AXIS: OF_SPEED} if plan.search else {sampling.AXIS: whole} if plan.sample else {}
        labels = (Column(axis, checks.get(axis, str), empty=axis not in checks) for axis in self.axes)
        self.columns = (*labels, *(input_column(each, stale=True) for each in inputs),
                        *(Column(name, number, required=False) for name in self.more))
        self.made: dict[tuple[str, ...], Row] = {}
        self._read()

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
                   if name in self.wanted and name not in fresh)

    def in_words(self, names: Sequence[str]) -> str:
        """The numbers of cases that are up to date, stale, or without a row, in words."""
        fresh, stale = self.fresh(names), self.stale(names)
        missing = len(names) - len(fresh) - stale
        return f"{self.path}: {several(len(fresh), 'run')} up to date, {stale} stale, {missing} not made"

    def _identity(self, row: Row) -> tuple[str, ...]:
        return *(row[name] for name in self.axes), row[CELLS], row[MEMBER]

    def add(self, cases: Iterable[Case], planned: Iterable[Planned] = ()) -> list[str]:
        """Writes the rows of those cases that have ended; planned : cases that the plan did not have.

        Rows that another process writes at the same time are kept. Returns what was wrong in the rows of these runs and of
        their set-ups, in words. Raises OSError, LockError, and StudyError if the file can no longer be read.
        """
        self.wanted |= {case.name: Wanted(case, self.axes) for case in planned if case.text and case.name not in self.wanted}
        rows = {case.name: self.wanted[case.name].row(case) for case in cases
                if case.status in ENDED and case.name in self.wanted}
        self.made |= {self._identity(row): row for row in rows.values() if row[OF_METHOD] == METHOD}
        if not self.wrong and not self._unwritten():
            return []
        self.path.parent.mkdir(exist_ok=True)
        with locked(self.path.with_name(f".{self.path.name}.lock"), PATIENCE):
            self._read()
            said = [*self.wrong, *self._unwritten()]
            self.rows = sorted(({self._identity(row): row for row in self.rows} | self.made).values(), key=self._place)
            self._write()
        self.wrong = []
        return [words for words in said if words]

    def _unwritten(self) -> list[str]:
        """An entry for each row of a run that the file does not have: what its row says instead, or "" if nothing is wrong."""
        known, found = {self._identity(row): row for row in self.rows}, []
        for identity, row in self.made.items():
            other = known.get(identity)
            if other is None or any(other.get(name, "") != text for name, text in row.items()):
                found.append("" if other is None or other[SETUP] != row[SETUP] or other[OF_METHOD] != METHOD
                             else self._corrected(other, row, "its run"))
        return found

    def _corrected(self, row: csv_tables.Row, right: Row, source: str) -> str:
        """What is wrong in a row, in words; empty if only digits or the machine differ. ``source`` : of the right entries."""
        for name, text in right.items():
            if name not in (*OF_MACHINE, "commit", "date") and differ(row.get(name, ""), text):
                return f'{self.path}:{row.line}: column "{name}": "{row.get(name, "")}" is corrected: {source} has "{text}"'
        return ""

    def _read(self) -> None:
        """Reads the file. Rows of the set-ups of the plan get the labels and inputs of their cases. Raises StudyError."""
        self.rows = read(self.path, self.columns, self.axes)
        mine: dict[str, list[Row]] = {}
        if any(row[OF_METHOD] == METHOD for row in self.rows):
            for wanted in self.wanted.values():
                mine.setdefault(wanted.setup, []).append(wanted.about | wanted.inputs)
        self.wrong = []
        for row in self.rows:
            of_setup = mine.get(row[SETUP])
            if of_setup and not any(right.items() <= row.items() for right in of_setup):
                self.wrong.append(self._corrected(row, of_setup[0], "its set-up"))
                row.update(of_setup[0])

    def _write(self) -> None:
        text = io.StringIO()
        defined = sorted({name for row in self.rows for name in row if name.startswith(DEFINED)})
        heads = dict.fromkeys((*self.axes, *self.heads, CELLS, MEMBER, *RESULTS, *defined, *self.more, *ORIGIN))
        table = csv.DictWriter(text, heads, restval="", extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows({name: safe(text) for name, text in row.items()} for row in self.rows)
        write_text(self.path, text.getvalue())

    def _place(self, row: Row) -> tuple:
        """Finer meshes later, cases in the order of the study, members of a case one after another."""
        labels = [self.order[name].get(row[name], len(self.order[name])) for name in self.axes]
        return float(row[CELLS] or 0.0), *labels, *self._identity(row)[: len(self.axes)], int(row[MEMBER])
