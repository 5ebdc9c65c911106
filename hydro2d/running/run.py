"""A run and its directory: cycles, due outputs, progress, and the summary.

    deck.toml         the deck with every default written out
    summary.json      the results, their provenance, and what was conserved
    progress.json     the progress, while it runs
    history.h5        quantities against time, and the hole in the target at the end
    restart.h5        the state to continue from, bitwise (and restart.previous.h5)
    vtk/, *.pvd       fields, outlines and tracers for ParaView
    log.txt           the log

An output is due at the first cycle at or after its time, so outputs never change a time step. An interrupted run
continues bitwise as if it had not been interrupted.
"""

from __future__ import annotations

import os
import time as clock
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from hydro2d.base import interrupt as interrupts
from hydro2d.base.errors import UnphysicalState
from hydro2d.base.interrupt import Interrupt, signals
from hydro2d.base.method_version import METHOD
from hydro2d.base.version import __version__
from hydro2d.deck import formulas
from hydro2d.deck.warnings import warnings
from hydro2d.files.locks import locked, remove
from hydro2d.files.toml import model_tables
from hydro2d.files.whole import write_json, write_text
from hydro2d.measure.penetrator import Projectile
from hydro2d.measure.summary import PROJECTILE, Conservation, Experiment, Flyer, Progress, Summary
from hydro2d.output import snapshot
from hydro2d.output.directory import (
    DECK,
    HISTORY,
    LOCK,
    LOG,
    PROGRESS,
    SUMMARY,
    RunError,
    check_free,
    check_own,
    clear,
    deck_hash,
)
from hydro2d.output.history import History, HistoryError
from hydro2d.output.series import Series
from hydro2d.output.vtk import FOLDER
from hydro2d.running import provenance, residual_velocity
from hydro2d.running.outputs import Attempts, writing
from hydro2d.running.progress import Clock
from hydro2d.running.reporting import reporter
from hydro2d.running.team import Team
from hydro2d.solver.due import Due
from hydro2d.solver.recorder import ColumnError, check, row

if TYPE_CHECKING:
    from hydro2d.jit.compilation import Compilation

#: cycles between copies of the last good state in memory
GOOD_EVERY = 100
#: seconds between writes of the history, and their largest share of the wall time
FLUSH_SECONDS, FLUSH_SHARE = 10.0, 0.1
#: seconds between writes of progress.json
PROGRESS_SECONDS = 3.0

DONE, WRONG_INPUT, UNPHYSICAL = 0, 2, 3
#: parts of the time of a run, as keys of the summary
COSTS = ("cycles_s", "compilation_s", "outputs_s", "set_up_s")

#: function that makes lines from a deck and the summary of its run
Theory = Callable[[Any, Summary], list[str]]

#: sections of a deck that may differ when a run is continued
FREE_SECTIONS = ("name", "title", "stop", "output", "experiment", "derived", "result")


def check_same_deck(now: str, before: str) -> None:
    """Raises RunError if two resolved decks differ in anything that affects the state."""
    decks = [tomllib.loads(text) for text in (now, before)]
    new, old = ({**{table["model"]: table["code"] for _, table in model_tables(data) if table.pop("code_from", "")},
                 **{f"{path[1]}, its table": table["table_data"] for path, table in model_tables(data)
                    if table.pop("table_from", "")}} for data in decks)
    changed = sorted(key for key in {*decks[0], *decks[1]} - {*FREE_SECTIONS} if decks[0].get(key) != decks[1].get(key))
    if changed:
        models = [f"the code of the model {name}" for name in sorted(new.keys() & old.keys()) if new[name] != old[name]]
        raise RunError(
            f"the deck differs from that of the run in {', '.join([*changed, *models])} "
            f"(a restart may change only {', '.join(FREE_SECTIONS)})"
        )


class Run:
    """One run in one directory.

    Parameters
    ----------
    deck : the resolved deck
    directory : the directory to write to
    restart : whether to continue from restart.h5 of the directory
    report : see reporting.reporter
    columns : further columns of the history, see Simulation.columns
    compiled : the listener to compilation, see compilation.announced
    theory : lines for the end of the run, from its deck and its summary
    """

    def __init__(self, deck, directory: Path, *, restart: bool, report, columns: Mapping[str, Callable] | None = None,
                 compiled: Compilation | None = None, theory: Theory | None = None):
        from hydro2d.jit import threads
        from hydro2d.solver.simulation import Simulation

        self.started = clock.perf_counter()
        self.compiled, self._theory = compiled, theory
        self.spent = dict.fromkeys(COSTS, 0.0)
        self.deck, self.directory, self.report = deck, Path(directory), report
        self.deck_text = deck.to_toml()
        self.warnings = warnings(deck)
        self.provenance = provenance.collect(threads()) | {"models": models_from_outside(deck)}
        self.sim = Simulation(deck)
        self.warnings += self.sim.warnings
        self.sim.columns.update(columns or {})
        self.wall_before = 0.0
        self.stepped, self.timed_from = 0, 0.0
        self.due = {"history": Due(deck.output.history_interval), "vtk": Due(deck.output.vtk_interval)}
        rows = dumps = 0
        unwritten: dict[str, list[float]] = {}
        #: rows that the history has lost, in words
        self.lacking: list[str] = []
        if restart:
            saved, problems = snapshot.read_latest(self.directory)
            for problem in problems:
                report.line(f"warning: {problem}; continuing from the one before")
            check_same_deck(self.deck_text, saved.deck)
            with snapshot.fitting(self.directory):
                self.sim.load_restart_arrays(saved.arrays)
                self.sim.load_restart_scalars(saved.scalars)
                for name, due in self.due.items():
                    due.resume(saved.run["due"][name], self.sim.time)
                rows, dumps, self.wall_before = (saved.run[name] for name in ("rows", "dumps", "wall_s"))
                self.spent |= saved.run.get("spent", {})  # files of earlier versions lack it
                unwritten, self.lacking = saved.run["unwritten"], saved.run["lacking"]
        #: number of doubts that have been reported
        self._said = len(self.sim.doubts())
        self.history = self._history(rows, unwritten)
        self.history.about = {"title": deck.title, "version": f"hydro2d {__version__}", "deck": self.deck_text}
        self.series = Series(self.directory, deck.output.fields, dumps)
        if self.series.repaired:
            report.line(f"warning: {self.series.repaired}")
        self.clock, self.team = Clock(deck.stop, self.history), Team(threads())
        self.flushed = self.saved_at = self.published = clock.perf_counter()
        self.good, self.flush_every = None, FLUSH_SECONDS
        remove(self.directory / SUMMARY)
        write_text(self.directory / DECK, self.deck_text, checksum=True)
        self.spent["set_up_s"] += clock.perf_counter() - self.started - self._first_calls()

    def _first_calls(self) -> float:
        """Seconds spent so far in first calls of kernels, which compile them or read them from the cache."""
        return self.compiled.seconds if self.compiled else 0.0

    @contextmanager
    def _spending(self, on: str) -> Iterator[None]:
        """Adds the time of the block, without first calls of kernels, to the cost named ``on``."""
        began = clock.perf_counter() - self._first_calls()
        yield
        self.spent[on] += clock.perf_counter() - self._first_calls() - began

    def costs(self) -> dict[str, float]:
        """Seconds spent on each of COSTS, in this process and in earlier ones."""
        kind = "compilation_s" if self.compiled and self.compiled.happened else "set_up_s"
        return self.spent | {kind: self.spent[kind] + self._first_calls()}

    def theory(self, summary: Summary) -> list[str]:
        """Lines below the depth of a finished run."""
        return self._theory(self.deck, summary) if self._theory and summary.status == "done" else []

    def _history(self, rows: int, unwritten: dict[str, list[float]]) -> History:
        """The history to continue, with the rows that only the restart file has; a damaged file is renamed."""
        path = self.directory / HISTORY
        try:
            history = History(path, rows - len(unwritten.get("time", ())), unwritten)
            if len(history) < rows:
                self.lacking.append(f"{HISTORY} lacks {rows - len(history)} of {rows} rows before a restart")
                self.report.line(f"warning: {path} lacks {rows - len(history)} of {rows} rows before the restart")
            return history
        except HistoryError as error:
            aside = path.with_name(f"damaged-{HISTORY}")
            if path.exists():
                path.replace(aside)
            history = History(path, 0, unwritten)
            self.lacking.append(f"{HISTORY} lacks {rows - len(history)} of {rows} rows before a restart")
            self.report.line(f"warning: {error}; a new history is started; the old file is now {aside.name}")
            return history

    @property
    def wall(self) -> float:
        """Seconds spent on the run, in this process and in earlier ones."""
        return self.wall_before + clock.perf_counter() - self.started

    def execute(self, interrupt: Interrupt) -> Summary:
        """Runs until there is a reason to stop. Returns the summary, which is also in summary.json."""
        self.report.begin(self)
        reason = self.sim.stop_reason()
        with self._spending("outputs_s"):
            self._outputs()
        try:
            while reason is None and not interrupt.reason:
                with self._spending("cycles_s"):
                    self._step()
                if self.stepped == 1:
                    self._begun()
                with self._spending("outputs_s"):
                    self._outputs()
                reason = self.sim.stop_reason()
            self.sim.refuse_nonsense()
            self._refuse_not_finite()
        except UnphysicalState as error:
            return self._finish("unphysical", str(error))
        except (OSError, ColumnError) as error:  # in an output: the state is intact
            self._save_after(error, self.good if self.sim.not_finite() else self._snapshot())
        except MemoryError as error:
            self._save_after(error, self.good)
        finally:
            self.team.all()
        if reason is None:
            return self._finish("interrupted", f"interrupted ({interrupt.reason})")
        return self._finish("done", reason)

    def _begun(self) -> None:
        """Called after the first cycle, in which kernels are loaded; the pace is measured from here on."""
        self.timed_from = self.spent["cycles_s"]
        for text in self.compiled.closing_lines() if self.compiled else ():
            self.report.line(text)

    def _step(self) -> None:
        """Cycles up to the next output, or fewer."""
        if self.stepped == 0:
            self.stepped += self.sim.advance(cycles=1)
            self.clock.begin(self.sim)
        else:
            self.stepped += self.team.run(lambda: self.sim.advance(self._next_output()))

    def _next_output(self) -> float:
        """The time at which an output is due or the run is over, s."""
        return min(*(due.next for due in self.due.values()), self.sim.last_time)

    # ------------------------------------------------------------------------------------------------ outputs

    def _outputs(self) -> None:
        """Writes all outputs that are due after a cycle."""
        sim, now = self.sim, clock.perf_counter()
        with self._due("history") as is_due:
            if is_due:
                self._append(row(sim))
        with self._due("vtk") as is_due, writing(self.directory / FOLDER):
            if is_due:
                self._refuse_not_finite()
                self.series.dump(sim)
        if now - self.saved_at >= self.deck.output.restart_interval:
            self._refuse_not_finite()
            attempts = Attempts()
            self._save(self._snapshot(), attempts)
            attempts.conclude()
        if sim.cycle % GOOD_EVERY == 0:
            self._refuse_not_finite()
            self.good = self._snapshot(self.good)
        if now - self.flushed >= self.flush_every:
            with writing(self.directory / HISTORY):
                self._write_history()
        if now - self.published >= PROGRESS_SECONDS:
            with writing(self.directory / PROGRESS):
                self._publish()
        with writing(self.directory / LOG):
            self._say_doubts()
            self.report.update(self)

    def _say_doubts(self) -> None:
        """Reports each reason not to trust the run once, when it is found."""
        for doubt in (doubts := self.sim.doubts())[self._said :]:
            self.report.line(f"NOT TRUSTWORTHY from here on: {doubt}")
        self._said = len(doubts)

    def _append(self, values: dict) -> None:
        """Adds a row to the history; its energies would show a state that is not finite."""
        if not np.isfinite([values["internal_energy_J"], values["kinetic_energy_J"]]).all():
            self._refuse_not_finite()
        self.history.append(values)

    def _refuse_not_finite(self) -> None:
        """Raises UnphysicalState if the state, which is about to be written, has a number that is not finite."""
        if wrong := self.sim.not_finite():
            raise UnphysicalState(wrong)

    @contextmanager
    def _due(self, name: str) -> Iterator[bool]:
        """Yields whether an output is due now; if it fails within the block, it is due again when the run continues."""
        due = self.due[name]
        count = due.count
        try:
            yield due(self.sim.time)
        except Exception:
            due.count = count
            raise

    def _publish(self) -> None:
        """Writes progress.json, which other programs read."""
        measured, outlook = self.sim.diagnostics(), self.clock.look(self.sim)
        write_json(self.directory / PROGRESS, Progress(
            time_s=self.sim.time, cycles=self.sim.cycle, fraction=outlook.share, left_s=outlook.left, wall_s=self.wall,
            penetration_depth_m=measured.get("penetration_depth_m"),
            rod_tail_velocity_m_s=measured.get("rod_tail_velocity_m_s"), host=self.provenance["host"], process=os.getpid(),
        ).model_dump())
        self.published = clock.perf_counter()

    def _snapshot(self, reuse: snapshot.Snapshot | None = None) -> snapshot.Snapshot:
        """A copy of the state, which may reuse the memory of an earlier copy."""
        arrays = self.sim.restart_arrays()
        copies = reuse.arrays if reuse else {name: np.empty_like(array) for name, array in arrays.items()}
        for name, array in arrays.items():
            np.copyto(copies[name], array)
        return snapshot.Snapshot(
            arrays=copies,
            scalars=self.sim.restart_scalars(),
            run={
                "due": {name: due.saved() for name, due in self.due.items()},
                "rows": len(self.history),
                "lacking": self.lacking,
                "dumps": len(self.series),
                "wall_s": self.wall,
                "spent": self.costs(),
            },
            deck=self.deck_text,
            provenance=self.provenance,
        )

    def _write_history(self) -> None:
        """Writes the history; if this takes long because of many stations, it is written less often."""
        began = clock.perf_counter()
        self.history.write()
        self.flushed = clock.perf_counter()
        self.flush_every = max(FLUSH_SECONDS, (self.flushed - began) / FLUSH_SHARE)

    def _save(self, state: snapshot.Snapshot, attempts: Attempts) -> None:
        """Writes the history and the restart file, which refers to its rows and keeps those that could not be written."""
        with attempts.writing(self.directory / HISTORY):
            self._write_history()
        state.run["unwritten"] = self.history.unwritten(state.run["rows"])
        with attempts.writing(self.directory / snapshot.NAME):
            snapshot.write(self.directory / snapshot.NAME, state)
        self.saved_at = clock.perf_counter()

    def _save_after(self, error: Exception, state: snapshot.Snapshot | None) -> NoReturn:
        """Writes a restart file after an error, or keeps the previous one, and raises the error."""
        attempts = Attempts(error)
        if state is not None:
            self._save(state, attempts)
        with attempts.writing(self.directory / PROGRESS):
            remove(self.directory / PROGRESS)
        attempts.conclude()
        raise error

    def _finish(self, status: str, reason: str) -> Summary:
        """Writes the last outputs; if one fails, the others are still written.

        The summary comes last, and says that the run was interrupted if anything else could not be written. A restart file
        never counts the extra row and dump that are written after the end.
        """
        attempts = Attempts()
        with self._spending("outputs_s"):
            self._last_outputs(status, attempts)
        with attempts.writing(self.directory / SUMMARY):
            summary = self.summary(*(("interrupted", attempts.failures) if attempts.failures else (status, reason)))
            remove(self.directory / PROGRESS)
            write_json(self.directory / SUMMARY, summary.model_dump())
        attempts.conclude()
        with writing(self.directory / LOG):
            self.report.end(self, summary)
        return summary

    def _last_outputs(self, status: str, attempts: Attempts) -> None:
        """Writes the restart file, the last row and the last dump; nothing of a state that is not finite: the restart file is
        of an earlier one."""
        if wrong := self.sim.not_finite():
            with attempts.writing(self.directory / LOG):
                self.report.line(f"warning: the state at the end is not written: {wrong}")
        else:
            with attempts.writing(self.directory / HISTORY):
                self.history.craters, self.history.debris = self.sim.holes(), self.sim.debris()
        state = self.good if status == "unphysical" else self._snapshot()
        if state is not None:
            self._save(state, attempts)
        if status != "interrupted" and not wrong:
            if self.history.last_time != self.sim.time:
                with attempts.writing(self.directory / HISTORY):
                    if last := self._last_row(status):
                        self.history.append(last)
                    self.history.write()
            if self.series.last_time != self.sim.time:
                with attempts.writing(self.directory / FOLDER):
                    self.series.dump(self.sim)
        with attempts.writing(self.directory / LOG):
            if text := self.team.thread_use():
                self.report.line(text)

    def _last_row(self, status: str) -> dict[str, Any]:
        """The row of the end. A user's column or result may fail in an unphysical state; the row is then empty."""
        try:
            return row(self.sim)
        except ColumnError as error:
            if status != "unphysical":
                raise
            self.report.line(f"warning: {error}")
            return {}

    def summary(self, status: str, reason: str) -> Summary:
        """The contents of summary.json."""
        sim, cycles, targets = self.sim, self.stepped - 1, self.sim.of_targets()
        last = self._last_row(status) if sim.formulas or sim.own_results else {}
        pace, own = self.spent["cycles_s"] - self.timed_from, [name for own in sim.own_results.values() for name in own.lines]
        faults = (sim.faults() or [reason] * (status == "unphysical")) + sim.doubts() + self.lacking
        if (wrong := sim.not_finite()) and wrong not in faults:
            faults.append(f"null stands for what could not be computed: {wrong}")
        projectile = Projectile(**measured) if (measured := sim.diagnostics()) else None
        settling = residual_velocity.change(self.history, list(targets.values()), projectile, sim.time)
        return Summary(
            **(projectile or {}),
            deck=self.deck.name, title=self.deck.title, deck_sha256=deck_hash(self.deck_text),
            setup=self.deck.setup, cells_across=self.deck.cells_across, version=__version__,
            method=METHOD, status=status, stop_reason=reason, trustworthy=not faults, faults=faults, notes=sim.notes(),
            time_s=sim.time, cycles=sim.cycle, wall_s=self.wall, **self.costs(), cells=sim.grid.cells,
            ns_per_cell_cycle=1e9 * pace / (sim.grid.cells * cycles) if cycles > 0 else None,
            outcome=sim.outcome(status, reason),
            projectile=projectile and Flyer(body=sim.projectile, **{new: projectile[old] for old, new in PROJECTILE.items()},
                                            **settling),
            crater=next((target.crater for target in targets.values()), None), targets=targets,
            derived={name: last.get(name) for name in (*own, *sim.formulas)},
            bodies=sim.of_bodies(), stations=sim.stations.measure(),
            experiment=experiment(self.deck), conservation=Conservation(**sim.conservation()), provenance=self.provenance)


def models_from_outside(deck) -> list[dict]:
    """What of a deck is not part of hydro2d, code of models and results, and tables: kind, name, file and SHA-256."""
    models = [about for material in deck.materials.values()
              for about in (*(model.about() for model in material.from_outside()), *material.tables())]
    return models + [own.about(name) for name, own in formulas.own_results(deck).items()]


def experiment(deck) -> Experiment | None:
    """The experiment in a deck, or None."""
    measured = deck.experiment
    return measured and Experiment(penetration_m=measured.penetration, qualifier=measured.qualifier,
                                   residual_velocity_m_s=measured.residual_velocity, source=measured.source)


def run(deck, directory: Path | None = None, *, restart=False, overwrite=False, quiet=False,
        interrupt: Interrupt | None = None, columns: Mapping[str, Callable] | None = None, second: bool | None = None,
        theory: Theory | None = None) -> Summary:
    """Runs a deck in a directory and returns its summary.

    deck : a resolved deck, from deck.load
    directory : default: the directory in the deck
    restart, overwrite : continue an existing run, or replace it
    quiet : prints nothing (log.txt is still written)
    interrupt : may be called from anywhere to stop the run after the cycle, with a restart file
    columns : further columns of the history, functions of the simulation by name
    second : whether a second process helps to compile the kernels; default: if the run may use more than one thread
    theory : lines for the end of a finished run, from its deck and its summary, printed below the depth

    Raises RunError, SnapshotError, LockError (another process uses the directory), StrangeFile.
    """
    from hydro2d.jit import shipped, threads
    from hydro2d.jit.compilation import announced

    directory = Path(directory or deck.output.directory)
    interrupt = interrupt or Interrupt()
    check(columns or {})
    check_free(directory, restart=restart, overwrite=overwrite)
    directory.mkdir(parents=True, exist_ok=True)
    check_own(directory)
    with locked(directory / LOCK):
        for left in (*directory.glob(".*.tmp"), *(directory / FOLDER).glob(".*.tmp")):  # of a process that was killed
            left.unlink(missing_ok=True)
        if not restart:
            clear(directory)
        with (
            reporter(directory / LOG, quiet=quiet, gone=lambda: interrupt("SIGPIPE")) as report,
            signals(interrupt),
            announced(report, deck if (threads() > 1 if second is None else second) else None) as compiled,
        ):
            this_run = Run(deck, directory, restart=restart, report=report, columns=columns, compiled=compiled, theory=theory)
            if not quiet and (advice := shipped.advice()):
                report.line(advice)
            return this_run.execute(interrupt)


def exit_status(summary: Summary) -> int:
    """0 for done, 3 for unphysical, 128 plus its number after a signal, as in shells."""
    if summary.status == "interrupted":
        return interrupts.status(summary.stop_reason or "")
    return UNPHYSICAL if summary.status == "unphysical" else DONE
