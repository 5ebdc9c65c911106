"""Progress of a sweep while it runs: a table on a terminal, plain lines elsewhere, and always sweep.log."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path

from hydro2d.base.formats import one_line, shown
from hydro2d.base.terminal import duration, number, say, several, width
from hydro2d.files.strange import opened
from hydro2d.study.records.study_directory import DONE, LOG, RUNNING, STATUSES, WAITING, Case, Study

#: seconds between lines, and between refreshes of the table
LINE_SECONDS, TABLE_SECONDS = 5.0, 1.0
HEADS = ("case", "status", "depth", "done", "time left", "worker")
#: what lies between two cells of a table of plain lines
GAP = "  "
#: lines of a terminal that are not rows of the table
FRAME = 8


def row(case: Case) -> tuple[str, ...]:
    """Name, status, depth, share done, time left and worker of a case."""
    now = case.progress
    depth = now.get("penetration_depth_m") if now else case.summary.outcome and case.summary.outcome.depth_m
    share = 1.0 if case.status == DONE else now.get("fraction")
    left = now.get("left_s")
    return (
        case.name, case.status, number(depth, 1e2, ".2f", "cm"), "-" if share is None else f"{100 * share:.0f} %",
        "-" if left is None else duration(left), f"{now.get('host', '?')}:{now.get('process', '?')}" if now else "-",
    )


def counts(cases: list[Case]) -> str:
    """'3 of 24 done, 2 running, 19 waiting'."""
    found = Counter(case.status for case in cases)
    others = [f"{found[status]} {status}" for status in STATUSES if status != DONE and found[status]]
    return ", ".join([f"{found[DONE]} of {len(cases)} done", *others])


def left(cases: list[Case], workers: int, further: int = 0) -> float | None:
    """Seconds until all cases and `further` more are done, at the mean time of finished cases; None if not known yet."""
    running = [case.progress for case in cases if case.status == RUNNING]
    rest = [now["left_s"] for now in running if now.get("left_s") is not None]
    whole = [case.summary.wall_s for case in cases if case.status == DONE and case.summary.wall_s is not None]
    whole = whole or [now["wall_s"] + now["left_s"] for now in running
                      if now.get("left_s") is not None and now.get("wall_s") is not None]
    if not whole or not workers:
        return None
    waiting = further + len([case for case in cases if case.status == WAITING]) + len(running) - len(rest)
    return (sum(rest) + waiting * sum(whole) / len(whole)) / workers


def grid(rows: list[tuple[str, ...]], heads: tuple[str, ...] = HEADS):
    """A rich table."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, header_style="")
    for name in heads:
        table.add_column(name, no_wrap=True)
    for cells in rows:
        table.add_row(*(Text(one_line(cell)) for cell in cells))
    return table


def lines(rows: list[tuple[str, ...]], heads: tuple[str, ...] = HEADS, spare: str = "") -> list[str]:
    """The progress of a sweep as plain lines, none wider than the terminal.

    Where a row does not fit, the table is without the column ``spare``; a name that is still too long has a line of its own,
    and if the rest does not fit either, every cell has one, below the name and beside its head.
    """
    table = [heads, *rows]
    if spare in heads and sum(map(max, zip(*_lengths(table), strict=True))) > width():
        left_out = heads.index(spare)
        table = [(*cells[:left_out], *cells[left_out + 1 :]) for cells in table]
    widths = [max(column) for column in zip(*_lengths(table), strict=True)]
    if len(heads[0]) + len(GAP) + sum(widths[1:]) > width():
        return [line for cells in table[1:] for line in _cell_lines(table[0], cells)]
    widths[0] = min(widths[0], max(width() - sum(widths[1:]), len(heads[0]) + len(GAP)))
    return [line for cells in table for line in _row_lines(cells, widths)]


def _lengths(table: list[tuple[str, ...]]) -> list[list[int]]:
    """Characters that each cell of a table takes, with the gap after it."""
    return [[len(cell) + len(GAP) for cell in cells[:-1]] + [len(cells[-1])] for cells in table]


def _cell_lines(heads: tuple[str, ...], cells: tuple[str, ...]) -> list[str]:
    """A row as its name and a line for each other cell, with its head."""
    longest = max(map(len, heads[1:])) + len(GAP)
    others = zip(heads[1:], cells[1:], strict=True)
    return [cells[0], *(f"{GAP}{head:<{longest}}{cell}".rstrip() for head, cell in others)]


def _row_lines(cells: tuple[str, ...], widths: list[int]) -> list[str]:
    """A row as one line, or as two, if its name is wider than its column."""
    rest = "".join(map(str.ljust, cells[1:], widths[1:])).rstrip()
    if len(cells[0]) + len(GAP) > widths[0] and rest:
        return [cells[0], " " * widths[0] + rest]
    return [(cells[0].ljust(widths[0]) + rest).rstrip()]


def status(study: Study) -> list[str]:
    """The table of a study directory and its messages."""
    failures = [f"{case.name}: {text}" for case in study.cases for text in case.message.splitlines()]
    heading = one_line(f"{study.name}: {study.title}" if study.title else study.name)
    return [heading, "", *lines([row(case) for case in study.cases], HEADS, "worker"), "", counts(study.cases), *failures]


class Board:
    """The state of all cases, and where it is reported.

    cases : as they were last read; those in `moving` are read again for every line and table
    workers : returns the number of workers
    further : number of cases expected to be added
    left_out : names of cases that this sweep does not run
    compiling : how far a worker is that compiles kernels, while the cases wait for it; empty at other times
    """

    def __init__(self, study: Study, log, quiet: bool):
        self.watch(study)
        self.moving: set[str] = set()
        self.further = 0
        self.left_out: Collection[str] = ()
        self.workers: Callable[[], int] = lambda: 0
        self.compiling: Callable[[], str] = lambda: ""
        self._log, self._quiet, self._last = log, quiet, time.monotonic()

    def watch(self, study: Study) -> None:
        """Takes a study, or the same one with other cases."""
        self.study, self.cases = study, list(study.cases)
        self.numbers = {case.name: n for n, case in enumerate(study.cases)}

    def line(self, text: str) -> None:
        """A line for the log and the screen."""
        for part in text.splitlines():
            self._write(part)
            if not self._quiet:
                self.show(part)

    def note(self, text: str) -> None:
        """Lines for the log alone."""
        for part in text.splitlines():
            self._write(part)

    def _write(self, text: str) -> None:
        try:
            self._log.write(f"{datetime.now().isoformat(timespec='seconds')}  {one_line(text)}\n")
            self._log.flush()
        except OSError as error:  # the cases go on; the screen still has it
            self.show(f"warning: {LOG} cannot be written: {error.strerror}")

    def show(self, text: str) -> None:
        say(text, flush=True)

    @property
    def chosen(self) -> list[Case]:
        """The cases that this sweep runs."""
        return [case for case in self.cases if case.name not in self.left_out]

    def counts(self) -> str:
        """'3 of 24 done, 2 running, 19 waiting', and how many cases of the study this sweep leaves out."""
        more = len(self.cases) - len(self.chosen)
        return counts(self.chosen) + (f" ({several(more, 'other')} not run)" if more else "")

    def look(self, name: str) -> Case:
        """Reads a case again."""
        number = self.numbers[name]
        self.cases[number] = self.study.case(number)
        return self.cases[number]

    def summary(self) -> str:
        for name in self.moving:
            self.look(name)
        seconds = left(self.chosen, self.workers(), self.further)
        coming = f", about {self.further} to come" if self.further else ""
        compiling = f"; {line}" if (line := self.compiling()) else ""
        return self.counts() + coming + ("" if seconds is None else f"; {duration(seconds)} left") + compiling

    def update(self) -> None:
        """Called twice a second; prints when output is due."""
        now = time.monotonic()
        if now - self._last >= LINE_SECONDS and not self._quiet:
            self._last = now
            self.show(self.summary())
            for case in self.cases:
                if case.status == RUNNING and case.progress:
                    self.show("  " + "  ".join(row(case)))

    def close(self) -> None:
        pass


class Live(Board):
    """The progress on a terminal: a table that is redrawn in place."""

    def __init__(self, study: Study, log, quiet: bool):
        from rich.live import Live as RichLive

        super().__init__(study, log, quiet)
        self._live = RichLive(refresh_per_second=2, transient=True)
        self._live.start()

    def show(self, text: str) -> None:
        self._live.console.print(shown(text), highlight=False, markup=False)

    def update(self) -> None:
        now = time.monotonic()
        if now - self._last >= TABLE_SECONDS:
            self._last = now
            self._live.update(self._picture())

    def _picture(self):
        from rich.console import Group

        total = self.summary()
        order = {RUNNING: 0, WAITING: 2}
        cases = sorted(self.chosen, key=lambda case: order.get(case.status, 1))
        shown = cases[: max(self._live.console.height - FRAME, 1)]
        hidden = [f"... and {len(cases) - len(shown)} more"] if len(shown) < len(cases) else []
        return Group(grid([row(case) for case in shown]), *hidden, total)

    def close(self) -> None:
        self._live.stop()


@contextmanager
def board(study: Study, quiet: bool) -> Iterator[Board]:
    """The board for this kind of output; it appends to the log of the study."""
    file = opened(Path(study.directory) / LOG, "a")
    kind = Live if not quiet and sys.stdout.isatty() else Board
    shown = kind(study, file, quiet)
    try:
        yield shown
    finally:
        shown.close()
        with suppress(OSError):  # lines that could not be written have been reported
            file.close()
