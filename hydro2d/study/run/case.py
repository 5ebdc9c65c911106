"""One case in one directory: begun, continued or already finished. It can be run any number of times, after any failure."""

from __future__ import annotations

import socket
import time
import traceback
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from hydro2d import jit
from hydro2d.base.errors import DeckError
from hydro2d.base.interrupt import Interrupt
from hydro2d.base.method_version import METHOD
from hydro2d.deck import deck as decks
from hydro2d.files import checksums
from hydro2d.files.locks import LockError, LostPlaceError, holder
from hydro2d.files.strange import StrangeFile
from hydro2d.jit import compilation
from hydro2d.materials.quantities import FieldError
from hydro2d.measure.summary import Summary
from hydro2d.output import snapshot
from hydro2d.output.directory import DECK, LOCK, PROGRESS, RunError, check_free, deck_hash
from hydro2d.output.history import HistoryError
from hydro2d.output.vtk import VtkError
from hydro2d.running import compile_all, run
from hydro2d.running.outputs import said
from hydro2d.solver.first_cycle import kernels
from hydro2d.study.records.study_directory import DONE, FAILED, FAILED_STATUS, UNPHYSICAL, state

#: exceptions that are reported in one line, without a traceback
TOLD = (DeckError, FieldError, HistoryError, LockError, LostPlaceError, StrangeFile, VtkError, RunError,
        snapshot.SnapshotError)
FULL = "No space left on device"
#: seconds in which neither lock nor progress of a process on another machine change before it loses its lock; progress.json is
#: written every 3
LONGEST_SILENCE = 120.0
#: longest time in seconds for a worker to end after its sweep was killed
ENDING = 60.0


@dataclass(frozen=True)
class Outcome:
    """The outcome of an attempt.

    status : one of layout.STATUSES;  message : why it is not done;  kind : kind of failure;  wall_s : time of this attempt;
    fresh : False if the result already existed;  trace : traceback of an unexpected failure;  first : what ended the first of
    two attempts
    """

    status: str
    message: str = ""
    kind: str = ""
    host: str = ""
    wall_s: float = 0.0
    fresh: bool = True
    trace: str = ""
    first: str = ""

    def plain(self) -> dict:
        return asdict(self)


def run_case(directory: str | Path, deck_text: str, *, threads: int = 1, overwrite: bool = False,
             interrupt: Interrupt | None = None) -> Outcome:
    """Runs a resolved deck in a directory, continues it from its restart file, or detects that it is done.

    directory : its parent must exist, so that a machine without access to the study's disk says so
    deck_text : resolved TOML, as from Deck.to_toml
    threads : number of threads for the kernels; the results do not depend on it
    overwrite : replace a run of another deck in the directory; without it such a run is a failure
    interrupt : may be called from anywhere to stop the run after the cycle, with a restart file

    A case that fails for a reason other than its physics or a mistake of its user is tried once more. Never raises; the message
    of the outcome says what went wrong.
    """
    directory = Path(directory)
    outcome = _attempt(directory, deck_text, threads, overwrite, interrupt)
    if not outcome.trace or (interrupt and interrupt.reason):
        return outcome
    again = _attempt(directory, deck_text, threads, overwrite, interrupt)
    return replace(again, wall_s=outcome.wall_s + again.wall_s, trace=again.trace or outcome.trace, first=outcome.message)


def _attempt(directory: Path, deck_text: str, threads: int, overwrite: bool, interrupt: Interrupt | None) -> Outcome:
    started = time.perf_counter()
    about = {"host": socket.gethostname()}
    try:
        finished = _finished(directory, deck_text)
        fresh = finished is None
        summary = finished or _run(directory, deck_text, threads, overwrite, interrupt)
        if summary.status != DONE:
            about["message"] = summary.stop_reason
        about |= {"status": summary.status, "fresh": fresh}
    except Exception as error:
        about |= _failure(error, directory)
    return Outcome(**about, wall_s=time.perf_counter() - started)


def _finished(directory: Path, deck_text: str) -> Summary | None:
    """The summary of a finished run of this deck. A run that ended as unphysical counts, because it would do so again."""
    sha256 = deck_hash(deck_text)
    present = state(directory, sha256)
    ended = present["status"] in (DONE, UNPHYSICAL) and present["summary"].deck_sha256 == sha256
    return present["summary"] if ended and not is_older(present["summary"]) else None


def is_older(summary: Summary) -> bool:
    """Whether an ended run is of another version of the method."""
    return bool(summary) and summary.method != METHOD


def _run(directory: Path, deck_text: str, threads: int, overwrite: bool, interrupt: Interrupt | None) -> Summary:
    if not directory.parent.is_dir():
        raise RunError(f"{directory.parent} does not exist on {socket.gethostname()}; workers need the study's file system")
    _wait_for_silence(directory, interrupt)
    deck = decks.loads(deck_text)
    restart = _can_continue(directory, deck_text, overwrite)
    jit.set_threads(min(threads, jit.max_threads()))
    # a second process helps: the other workers of the study wait meanwhile
    compilation.once(kernels(deck), lambda: compile_all.run_briefly(deck, second=True))
    summary = run.run(deck, directory, restart=restart, overwrite=not restart, quiet=True, interrupt=interrupt)
    (directory / FAILED).unlink(missing_ok=True)  # not before: dask may repeat a case whose failure the sweep has recorded
    return summary


def _wait_for_silence(directory: Path, interrupt: Interrupt | None) -> None:
    """Waits for a worker on this machine that is still ending, for example after its sweep was killed.

    Removes the lock of a process on another machine that shows no progress while this one watches, because its worker is gone;
    clocks of other machines do not count. A process that still shows progress keeps its lock, and the run reports that.
    """
    lock, began = directory / LOCK, time.monotonic()
    heard, signs = began, _signs(directory)
    while not (interrupt and interrupt.reason):
        by = holder(lock)
        if by is None or time.monotonic() - began > (ENDING if by.is_here else 2 * LONGEST_SILENCE):
            return
        if (now := _signs(directory)) != signs:
            heard, signs = time.monotonic(), now
        if not by.is_here and time.monotonic() - heard > LONGEST_SILENCE:
            lock.unlink(missing_ok=True)
            return
        time.sleep(min(0.2, LONGEST_SILENCE))


def _signs(directory: Path) -> list[tuple[int, int]]:
    """Marks that change as long as the process that runs in a directory lives."""
    stats = (file.stat() for name in (LOCK, PROGRESS) if (file := directory / name).exists())
    return [(each.st_ino, each.st_mtime_ns) for each in stats]


def _can_continue(directory: Path, deck_text: str, overwrite: bool) -> bool:
    """Whether there is a restart file of this deck. Raises RunError if the directory holds a run of another deck."""
    check_free(directory, restart=False, overwrite=True)
    file = directory / DECK
    if not file.is_file():
        return False
    if checksums.verified_text(file, RunError) != deck_text:
        if not overwrite:
            raise RunError(f"{directory} holds a run of another deck; --overwrite removes it")
        return False
    return any((directory / name).is_file() for name in (snapshot.NAME, snapshot.PREVIOUS))


def _failure(error: Exception, directory: Path) -> dict:
    """The outcome that describes an exception to the user."""
    text = " ".join(str(error).split())
    if FULL in text:
        place = error.filename if isinstance(error, OSError) and error.filename is not None else directory
        message, trace = f"the disk is full: {place} could not be written; free some space and continue", ""
    elif isinstance(error, TOLD):
        message, trace = text, ""
    elif isinstance(error, MemoryError):
        message, trace = said(error), ""
    elif isinstance(error, OSError):
        message, trace = f"{error.filename or directory}: {error.strerror or text}", ""
    else:
        message, trace = f"{type(error).__name__}: {text}", traceback.format_exc()
    return {"status": FAILED_STATUS, "message": message, "kind": type(error).__name__, "trace": trace}
