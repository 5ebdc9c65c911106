"""A sweep: gives the cases of a study to dask, and reports their results.

A `choice.Choice` decides which cases a study has and which of them run next.
"""

from __future__ import annotations

import logging
import queue
import socket
import time
import uuid
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from hydro2d.base.formats import in_shell
from hydro2d.base.interrupt import Interrupt, signals, status
from hydro2d.base.method_version import METHOD
from hydro2d.base.terminal import duration, say, several
from hydro2d.deck import deck as decks
from hydro2d.files.locks import LockError, locked
from hydro2d.files.whole import write_json
from hydro2d.jit import compilation
from hydro2d.output.directory import SUMMARY, clear
from hydro2d.solver.first_cycle import kernels
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.planned import Plan
from hydro2d.study.records import study_directory
from hydro2d.study.records.study_directory import (
    CASES,
    DONE,
    ENDED,
    FAILED,
    FAILED_STATUS,
    INTERRUPTED,
    INVALID,
    LOCK,
    STUDY,
    UNPHYSICAL,
    WAITING,
    Case,
    Study,
)
from hydro2d.study.run import monitor
from hydro2d.study.run.case import Outcome, is_older
from hydro2d.study.run.choice import Choice

ALL_DONE, SOME_FAILED = 0, 3
#: seconds between checks for a finished case, a signal, and the table
BEAT = 0.5
#: seconds without any worker of this machine, whose successors start within seconds, after which a sweep ends
LONELY = 120.0
#: seconds between two tables of a sample while it runs
TABLE_SECONDS = 5.0


def changes(plan: Plan, directory: Path, *, resume: bool, overwrite: bool) -> list[str]:
    """Changes since the study directory was last written, in words.

    Raises StudyError if there is a study and neither `resume` nor `overwrite` is given, or if the decks of its cases have
    changed.
    """
    if directory.exists() and not directory.is_dir():
        raise StudyError(f"{directory} is a file, not a directory")
    notices = []
    if (directory / SUMMARY).exists():
        raise StudyError(f"{directory} holds a run; give the study a directory of its own")
    if (directory / STUDY).exists():
        before = study_directory.read(directory)
        if not (resume or overwrite) and any(case.directory.exists() for case in before.cases):
            raise StudyError(
                f"{directory} already holds a study ({monitor.counts(before.cases)}); {plan.again} continues it, "
                "--overwrite starts it again from the beginning"
            )
        notices = _changes(plan, before, overwrite)
    elif resume:
        raise StudyError(f"{directory}: there is no study to continue")
    return notices


def _changes(plan: Plan, before: Study, overwrite: bool) -> list[str]:
    """Cases that have come, gone, or changed."""
    old = {case.name: case for case in before.cases}
    new = {case.name: case for case in plan.cases}
    begun = [name for name in new if name in old and old[name].directory.exists()]
    changed = [name for name in begun if old[name].deck_sha256 != new[name].sha256]
    older = [name for name in begun if name not in changed and is_older(old[name].summary)]
    for names, why in ((changed, "had a different deck when the study was begun"),
                       (older, f"ran with another version of the method than that of {METHOD}")):
        if names and not overwrite:
            raise StudyError(f"{before.directory}: {_names(names)} {why}; "
                             "--overwrite runs them again from the beginning, --out makes a separate study")
    added, gone = [name for name in new if name not in old], [name for name in old if name not in new]
    notices = [f"{_names(added)} new"] if added else []
    if gone and plan.search is None:  # a search may draw the velocity of a run that has not ended again
        notices.append(f"{_names(gone)} no longer in the study; the files in {CASES} are kept")
    notices += [f"{_names(changed)} with a different deck than before"] if changed else []
    return notices + ([f"{_names(older)} with another version of the method than before"] if older else [])


def _names(names: list[str]) -> str:
    """'3 cases (a, b, c)'."""
    shown = ", ".join(names[:5]) + (", ..." if len(names) > 5 else "")
    return f"{several(len(names), 'case')} ({shown})"


def sweep(choice: Choice, directory: Path, connect: AbstractContextManager, *, threads: int = 1, resume: bool = False,
          overwrite: bool = False, quiet: bool = False) -> int:
    """Runs the chosen cases of a study and returns the exit status.

    connect : gives a dask client, see cluster.local, joined and slurm
    threads : numba threads of a case
    resume : continue the study in the directory
    overwrite : run cases again from the beginning: with resume those whose deck has changed, without it all

    Raises StudyError, LockError (another sweep uses the directory).
    """
    if choice.complete:
        corrected = _kept(choice, study_directory.of_plan(choice.compared(directory), directory).cases)
        for text in () if quiet else (f"{choice.plan.name}: nothing to run; {choice.kept()}", *corrected):
            say(text)
        _from_kept(choice, directory)
        return ALL_DONE
    notices, interrupt = changes(choice.compared(directory), directory, resume=resume, overwrite=overwrite), Interrupt()
    study_directory.make(directory)
    with locked(directory / LOCK):
        if overwrite:
            cases = study_directory.of_plan(choice.plan, directory).cases
            _clear(case for case in cases if case.name not in choice.left_out and (not resume or is_older(case.summary)))
        study_directory.write(choice.begin(directory), directory)
        return _sweep(choice, study_directory.read(directory), notices, connect, interrupt, threads, overwrite, quiet)


def _from_kept(choice: Choice, directory: Path) -> None:
    """Makes the directory of a sample whose results are all in the rows that its study keeps, with its table."""
    if choice.plan.sample is not None:
        study_directory.make(directory)
        with locked(directory / LOCK):
            study_directory.write(choice.plan, directory)
            study = study_directory.read(directory)
            choice.tabulate(study, study.cases)


def _sweep(choice: Choice, study: Study, notices: list[str], connect: AbstractContextManager, interrupt: Interrupt,
           threads: int, overwrite: bool, quiet: bool) -> int:
    with monitor.board(study, quiet) as board, signals(interrupt), _dask_told(board):
        board.line(choice.heading(study))
        for text in (*choice.plan.notes, *notices, choice.kept()):
            board.line(text)
        started = time.perf_counter()
        with connect as client:
            spent = _Sweep(choice, client, board, threads, overwrite).run(interrupt)
        return _end(board, interrupt, time.perf_counter() - started, spent, choice.plan.again)


def _kept(choice: Choice, cases: Sequence[Case]) -> list[str]:
    """Adds rows to the file that the study keeps. Returns what there is to say; without the file the cases run all the same."""
    try:
        return choice.keep(cases)
    except (LockError, StudyError) as error:
        return [f"{error}; the rows of the runs are not written"]
    except OSError as error:
        return [f"{choice.plan.keep} cannot be written: {error.strerror or error}"]


def _clear(cases: Iterable[Case]) -> None:
    """Removes the files of runs from the cases."""
    for case in cases:
        if case.directory.is_dir():
            clear(case.directory)
            (case.directory / FAILED).unlink(missing_ok=True)


class _Sweep:
    """The tasks that dask has, by the key of their future."""

    def __init__(self, choice: Choice, client, board: monitor.Board, threads: int, overwrite: bool):
        self.choice, self.client, self.board = choice, client, board
        self.threads, self.overwrite = threads, overwrite
        self.texts = {case.name: case.text for case in choice.plan.cases}
        self.name = uuid.uuid4().hex[:12]
        self.tasks: dict[str, Case] = {}
        self.compiling = False
        self.spent = 0.0
        self.ended: queue.Queue = queue.Queue()
        self.counted, self.count = -BEAT, 0
        self.tabulated = self.heard = time.monotonic()
        board.workers, board.left_out = self.workers, choice.left_out

    def workers(self) -> int:
        """Number of workers; the scheduler is asked once per beat."""
        if time.monotonic() - self.counted >= BEAT:
            self.count, self.counted = len(self.client.scheduler_info(n_workers=-1)["workers"]), time.monotonic()
        return self.count

    def run(self, interrupt: Interrupt) -> float:
        """Runs until every case has ended and no more are wanted. Returns the seconds that they took in their workers."""
        announced = False
        self._keep(self.board.cases)
        self._tabulate()
        self._begin()
        while self.tasks:
            if interrupt.reason:
                if not announced:
                    self.board.line(f"{interrupt.reason}: running cases write their restart files and stop")
                    announced = True
                self._stop(interrupt.reason)
            if self._is_alone():
                self._give_up()
                break
            future = self._ended()
            case = None if future is None else self._take(future)
            if not interrupt.reason:
                self._begin()
            if case is not None:
                outcome = _outcome(future)
                future.release()
                self._finish(case, outcome)
                if time.monotonic() - self.tabulated > TABLE_SECONDS:
                    self._tabulate()
            self.board.update()
        self._tabulate()
        return self.spent

    def _begin(self) -> None:
        """Gives dask the cases that are wanted now."""
        while names := self.choice.wanted(self.board.cases, self.board.moving, self._room()):
            if not set(names) <= set(self.board.numbers):
                self._enlarge(names)
            todo = [case for name in names if (case := self.board.look(name)).status not in ENDED]
            if todo and not self.compiling:
                self.compiling = True
                key = kernels(decks.loads(self.texts[todo[0].name]))
                if not compilation.is_compiled(key):
                    self.board.compiling = partial(compilation.progress_of, key)
                    self.board.line("kernels not compiled by earlier runs are compiled first")
            for case in todo:
                self._give(case)
        self.board.further = self.choice.further(self.board.cases, self.board.moving)

    def _room(self) -> int:
        """Number of further cases that can run; one is given out even before the first worker has started."""
        return max(max(self.workers(), 1) - len(self.board.moving), 0)

    def _enlarge(self, names: Sequence[str]) -> None:
        """Adds further cases to the study. If its file cannot be written, the cases still run and the log has the reason."""
        plan = self.choice.enlarged(names)
        self.texts |= {case.name: case.text for case in plan.cases}
        try:
            study_directory.write(plan, self.board.study.directory)
        except OSError as error:
            self.board.line(f"{self.board.study.directory}: the study cannot be written: {error.strerror or error}")
        self.board.watch(study_directory.of_plan(plan, self.board.study.directory))

    def _give(self, case: Case) -> None:
        from hydro2d.study.run import worker

        key = f"{case.name}-{self.name}"
        self.tasks[key] = case
        self.board.moving.add(case.name)
        future = self.client.submit(
            worker.work, self.name, str(case.directory.resolve()), self.texts[case.name], self.threads,
            self.overwrite, key=key, pure=False,
        )
        future.add_done_callback(self.ended.put)

    def _stop(self, reason: str) -> None:
        from hydro2d.study.run import worker

        self.client.run(worker.stop, self.name, reason, on_error="ignore")

    def _is_alone(self) -> bool:
        """Whether all workers of this machine have ended for good; on a cluster others may come at any time."""
        import distributed

        if self.workers() or not isinstance(getattr(self.client, "cluster", None), distributed.LocalCluster):
            self.heard = time.monotonic()
        return time.monotonic() - self.heard > LONELY

    def _give_up(self) -> None:
        """Reports the cases that nobody runs any more."""
        words = "no worker is left: they were killed, or had no memory; the log of dask is in sweep.log"
        for case in self.tasks.values():
            self.board.moving.discard(case.name)
            self._finish(self.board.look(case.name), Outcome(FAILED_STATUS, words, "lost", socket.gethostname()))

    def _ended(self):
        """The future of a case that has ended, or None after a beat without any."""
        try:
            future = self.ended.get(timeout=BEAT)
            if future.status != "lost":
                return future
            future.add_done_callback(self.ended.put)  # the worker that had its outcome has died: dask runs it once more
            return None
        except queue.Empty:
            return None

    def _take(self, future) -> Case:
        """The case that has ended. Its worker is free for the next case before this one is examined."""
        case = self.tasks.pop(future.key)
        self.board.moving.discard(case.name)
        return self.board.look(case.name)

    def _finish(self, case: Case, outcome: Outcome) -> None:
        """Reports the outcome of a case."""
        self.spent += outcome.wall_s
        if outcome.status == FAILED_STATUS and case.status not in ENDED:  # its worker may die as it ends
            self._record(case, outcome)
            case = self.board.look(case.name)
        elif outcome.status == FAILED_STATUS:
            outcome = replace(outcome, status=case.status, message=case.message)
        name, *shown = monitor.row(case)
        depth = "" if shown[1] == "-" else f"depth {shown[1]}"
        words = [outcome.status, depth if outcome.status == DONE else outcome.message]
        words += [f"in a second attempt after {outcome.first}"] if outcome.first else []
        words += [] if outcome.fresh else ["already finished" if outcome.status == DONE else "not begun"]
        where = f"({duration(outcome.wall_s)}, {outcome.host})" if outcome.host else ""
        self.board.line(f"{name}: {', '.join(filter(None, words))} {where}".rstrip())
        if outcome.trace:
            self.board.note(outcome.trace)
        self.board.line(self.choice.news(self.board.cases, case.name))
        self._keep([case])

    def _keep(self, cases: Sequence[Case]) -> None:
        for text in _kept(self.choice, cases):
            self.board.line(text)

    def _tabulate(self) -> None:
        """Writes the table of a sample. If it cannot be written, the cases run all the same."""
        try:
            self.choice.tabulate(self.board.study, self.board.cases)
        except OSError as error:
            self.board.line(f"{self.board.study.directory}: the table of the sample cannot be written: "
                            f"{error.strerror or error}")
        self.tabulated = time.monotonic()

    def _record(self, case: Case, outcome: Outcome) -> None:
        """Writes failed.json; if that is impossible, the log has the reason."""
        try:
            case.directory.mkdir(exist_ok=True)
            write_json(case.directory / FAILED, {
                "reason": outcome.message, "kind": outcome.kind, "host": outcome.host,
                "time": datetime.now(UTC).isoformat(timespec="seconds"),
            })
        except OSError as error:
            self.board.note(f"{case.name}: {FAILED} cannot be written: {error.strerror}")


def _outcome(future) -> Outcome:
    """The result of a task, or why dask gave it up."""
    import distributed

    if future.status == "finished":
        return Outcome(**future.result())
    about = {"status": FAILED_STATUS, "host": socket.gethostname()}
    if future.status != "error":
        return Outcome(**about, kind="lost", message=f"the scheduler lost it ({future.status})")
    error = future.exception()
    if isinstance(error, distributed.scheduler.KilledWorker):
        times = error.allowed_failures + 1
        words = f"its worker died {times} times (killed, out of memory, or a crash); the log of dask is in sweep.log"
        return Outcome(**about, kind="KilledWorker", message=words)
    return Outcome(**about, kind=type(error).__name__, message=f"{type(error).__name__}: {error}")


def _end(board: monitor.Board, interrupt: Interrupt, seconds: float, spent: float, again: str) -> int:
    """Prints the final lines and returns the exit status. again : the option that continues the study"""
    cases = [board.look(case.name) for case in board.cases]
    for case in board.chosen:
        if case.status in (FAILED_STATUS, UNPHYSICAL, INVALID):
            for text in case.message.splitlines():
                board.line(f"{case.name}: {case.status}: {text}")
    of_workers = duration(spent, tenths=True)
    board.line(f"{board.counts()}, in {duration(seconds)}; the cases took {of_workers} in their workers")
    if interrupt.reason:
        board.line(f"interrupted ({interrupt.reason}); {again} continues")
        return status(interrupt.reason)
    if any(case.status in (WAITING, INTERRUPTED) for case in cases):
        board.line(f"{again} continues")
    if any(case.status == DONE for case in board.chosen):
        board.line(f"a page of all cases: hydro2d report {in_shell(board.study.directory)}")
    return ALL_DONE if all(case.status == DONE for case in board.chosen) else SOME_FAILED


class _ToLog(logging.Handler):
    """Writes the messages of dask to sweep.log."""

    def __init__(self, board: monitor.Board):
        super().__init__(logging.WARNING)
        self.board = board

    def emit(self, record) -> None:
        self.board.note(f"{record.name}: {record.getMessage()}")


@contextmanager
def _dask_told(board: monitor.Board) -> Iterator[None]:
    """Sends the messages of dask, such as those about dead workers, to the log of the sweep instead of the screen."""
    import distributed  # noqa: F401  (it sets its own handlers when it is imported)

    logger, handler = logging.getLogger("distributed"), _ToLog(board)
    before, logger.handlers = logger.handlers, [handler]
    try:
        yield
    finally:
        logger.handlers = before
