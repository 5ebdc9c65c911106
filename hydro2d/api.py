"""The interface for programs and notebooks: `hydro2d.run`, `open_run`, `open_study`, `sweep`, and analytic models.

The other names in `hydro2d.__all__`, such as `Deck` and `Simulation`, are what the program itself uses.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hydro2d.analytic import beside, catalogue, model_deck, models
from hydro2d.analytic.catalogue import lambert_jonas
from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.deck.deck import Deck
from hydro2d.files import toml
from hydro2d.files.whole import plain, write_text
from hydro2d.output.directory import deck_hash
from hydro2d.results.reading import Results
from hydro2d.running import run as runs
from hydro2d.running.team import at_most
from hydro2d.study.ensemble import contents
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.planned import Plan
from hydro2d.study.records import study_directory
from hydro2d.study.records.table import in_files
from hydro2d.study.run import cluster
from hydro2d.study.run import sweep as sweeps
from hydro2d.study.run.choice import Choice
from hydro2d.study.samples import results
from hydro2d.study.samples.results import Samples

if TYPE_CHECKING:
    import pandas

    from hydro2d.solver.simulation import Simulation

__all__ = ["Study", "fit_residual_velocity", "open_run", "open_study", "penetration_model", "penetration_models", "run",
           "sweep"]


def run(deck: Deck | str | Path, directory: str | Path | None = None, *, threads: int | None = None, restart: bool = False,
        overwrite: bool = False, quiet: bool = False,
        columns: Mapping[str, Callable[[Simulation], float]] | None = None) -> Results:
    """Runs a deck to its end in a directory, as the command `hydro2d run` does, and opens the results.

    A notebook shows a bar and the numbers of the moment while it runs.

    Parameters
    ----------
    deck : Deck, or path of a deck file
    directory : the directory to write to; default: ``output.directory`` of the deck, else ``runs/NAME``
    threads : largest number of threads for this run; default: all that the process has. The results do not depend on it
    restart, overwrite : continue the existing run, or replace it
    quiet : prints nothing; log.txt is still written
    columns : dict of functions of the simulation, by name
        Further columns of the history, each a number; see `Simulation.columns`.

    Raises
    ------
    DeckError, RunError, LockError, SnapshotError
        The deck or the number of threads is wrong, the directory already holds a run, another process uses it, or there is
        nothing to continue from.
    ColumnError
        A column has no name for a file, or fails; ``restart=True`` continues the run.
    UnphysicalState
        The state became unphysical; the directory keeps the last good state.
    KeyboardInterrupt
        The run was interrupted; ``restart=True`` continues it.
    """
    deck = deck if isinstance(deck, Deck) else Deck.from_file(deck)
    directory = Path(directory or str(deck.output.directory))
    with at_most(threads):
        summary = runs.run(deck, directory, restart=restart, overwrite=overwrite, quiet=quiet, columns=columns,
                           theory=beside.lines)
    if summary.status == "interrupted":
        raise KeyboardInterrupt(f"{directory}: {summary.stop_reason}")
    if summary.status == "unphysical":
        raise UnphysicalState(f"{directory}: {summary.stop_reason}")
    return Results(directory, trust=True)


def open_run(directory: str | Path, *, trust: bool = False) -> Results:
    """Opens the directory of a run that has ended or is still running.

    The result gives the deck, the summary, the history, the hole, the fields of all dumps and the figures; see `Results`.

    Parameters
    ----------
    directory : the run directory
    trust : whether the code of outside models in the deck of the run may be executed. Only `Results.simulation` and
        `Results.state` need it; set it for runs whose origin you know.

    Raises ResultsError if the directory holds no run.
    """
    return Results(directory, trust=trust)


class Study(study_directory.Study):
    """A study directory, or several runs treated as a study, as `open_study` reads them.

    Attributes
    ----------
    title, name : title and name of the study
    axes : the varied quantities, in the order of the study file; empty for a folder of runs
    cases : the cases, see `Case`
    """

    def table(self, *, members: bool = False) -> pandas.DataFrame:
        """One row for each case, indexed by its name: axes, status, results, experiment, conservation, cost; SI units.

        members : for a study with an ensemble, one row for each run; by default one row for each case, with the medians of its
            members under the names that single runs have, next to them the 10 and 90 % quantiles (``depth_low_m``,
            ``depth_high_m``), and the fraction of each regime with a 90 % Wilson interval (``rigid_fraction``,
            ``rigid_fraction_low``, ``rigid_fraction_high``); ``as_experiment_fraction`` is that of the experiment's outcome
        """
        collected = contents.collect(self)
        found = collected.table_of_ensembles() if self.ensembles and not members else collected.table
        return found.set_axis(in_files(found), axis="columns").set_index("case").infer_objects()

    def samples(self, at: Mapping[str, str] | None = None) -> Samples:
        """The runs of a study with [sample] as a table of inputs and results, with spreads, fractions and Sobol indices.

        at : for a study that has axes as well, the label on each of them, such as ``{"sliding": "contact"}``

        Raises StudyError if the study has no sample, has not been run, or has no such combination of labels.
        """
        samples = results.of_study(self)
        if at is None and len(samples) > 1:
            raise StudyError(f"the study has axes: name a label on each, such as at={samples[0].labels}")
        chosen = [each for each in samples if at is None or each.labels == dict(at)]
        if not chosen:
            raise StudyError(f"{dict(at or {})} is no combination of the axes; there are "
                             f"{', '.join(str(each.labels) for each in samples)}")
        return chosen[0]


def open_study(directory: str | Path) -> Study:
    """Opens a study directory in any state of completion, or a run or a folder of runs as a study. Raises StudyError."""
    return Study(**vars(study_directory.load(Path(directory))))


def sweep(study: str | Path | Deck, axes: Mapping[str, Sequence[Any]] | None = None, *, directory: str | Path | None = None,
          overrides: Mapping[str, Any] | Sequence[str] = (), workers: int | None = None, threads: int = 1,
          only: Sequence[str] = (), resume: bool = False, overwrite: bool = False,
          quiet: bool = True) -> pandas.DataFrame:
    """Runs all cases of a study in worker processes and returns their table.

    Parameters
    ----------
    study : path of a study file, or, with `axes`, a deck or its path
    axes : dict of lists by dotted deck key
        The values to vary, such as ``{"body.rod.velocity": ["1000 m/s", "1200 m/s"]}``. The cases are all combinations.
    directory : directory of the study; default: ``out`` of its file, else ``runs/NAME``
    overrides : deck values for all cases, as in `Deck.from_file`
    workers : number of processes; default: cores of this machine / threads
    threads : number of threads per worker; the results do not depend on it
    only : patterns of names, such as ``["*ogive*"]``: runs the cases that match one of them and leaves the others for later
    resume : continue the study in the directory; cases that have ended are not run again
    overwrite : start the study again from the beginning
    quiet : prints nothing; sweep.log is still written

    Returns
    -------
    pandas.DataFrame
        One row for each case, indexed by its name: the axes as text, ``status``, depths, lengths and the other columns that
        `hydro2d report` lists, in SI units. For a case that failed or has a wrong deck, ``message`` gives the reason.

    Raises StudyError (also if no case has a valid deck), DeckError, LockError; KeyboardInterrupt if the sweep
    was interrupted (``resume=True`` continues it).

    Worker processes are spawned, so a script must call this below ``if __name__ == "__main__":``.
    """
    for name, number in (("workers", workers), ("threads", threads)):
        if number is not None and number < 1:
            raise StudyError(f"{name} = {number}: at least one is needed")
    plan = _plan(study, axes, overrides, directory)
    place = Path(directory or plan.out)
    choice = Choice(plan, only, again=overwrite and not resume)
    if choice.complete:
        raise StudyError(f"nothing to run: {choice.kept()}; overwrite=True runs them again")
    connect = cluster.local(cluster.needed(workers, threads, len(choice.selected)), threads)
    status = sweeps.sweep(choice, place, connect, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet)
    if status not in (sweeps.ALL_DONE, sweeps.SOME_FAILED):
        raise KeyboardInterrupt(f"{place}: the sweep was interrupted")
    return open_study(place).table()


def _plan(study: str | Path | Deck, axes: Mapping[str, Sequence[Any]] | None, overrides: decks.Overrides,
          directory: str | Path | None) -> Plan:
    """The cases of a study file, or of a deck and axes. Raises StudyError."""
    if axes is None:
        if isinstance(study, Deck):
            raise StudyError("a deck alone is not a study: give `axes`, the keys to vary")
        return cases.plan(Path(study), overrides, search=False, quiet=True)
    for key, values in axes.items():
        if not toml.key_parts(key):
            raise StudyError("axes: a key is empty")
        if isinstance(values, str) or not isinstance(values, Iterable):
            raise StudyError(f"axes: {key}: expected a list of values, is {values!r}")
    file = _base(study, directory) if isinstance(study, Deck) else decks.find(study)
    tables = {"deck": str(file.resolve()), "axis": [{"name": _name(key, axes), "key": key, "values": list(values)}
                                                    for key, values in axes.items()]}
    plan = cases.plan_of(plain(toml.within_limits(tables, "axes")), file.stem, overrides)
    if not any(case.text for case in plan.cases):
        raise StudyError(f"no case has a valid deck; {plan.cases[0].name}: {plan.cases[0].message}")
    return plan


def _base(deck: Deck, directory: str | Path | None) -> Path:
    """The file of a Deck in the directory of its study, named by a hash of its contents, so that it replaces no other deck."""
    if directory is None:
        raise StudyError("a study of a Deck needs a directory")
    text = toml.dumps(deck._tables)
    file = Path(directory) / f"base_{deck_hash(text)[:8]}.toml"
    file.parent.mkdir(parents=True, exist_ok=True)
    write_text(file, text)
    return file


def _name(key: str, axes: Mapping[str, object]) -> str:
    """Name of an axis: the last part of its key, or the whole key if two keys have the same last part."""
    last = [toml.key_parts(each)[-1] for each in axes]
    own = toml.key_parts(key)[-1]
    return own if last.count(own) == 1 else key


def penetration_model(name: str, deck: Deck, inputs: Mapping[str, float | str] | None = None) -> models.Case:
    """An analytic penetration model for the rod and the target of a deck, as `hydro2d model NAME --deck DECK` evaluates it.

    Parameters
    ----------
    name : name of the model, such as "tate" or "forrestal"
    deck : a deck with a rod on the axis and one target
    inputs : inputs by name in SI units, such as ``{"target.strength": 0.4e9}``, in place of those of the deck

    Returns
    -------
    models.Case
        ``values`` has all inputs by name, and ``borrowed`` names those that come from the model's example; ``rows(velocities)``
        has a dict of the outputs for each impact velocity in m/s; ``transition()`` is the velocity above which the rod is no
        longer rigid, m/s. All in SI units.

    Raises DeckError if the deck has no such rod and target, ValueError for an unknown model or an impossible input.
    """
    shot = model_deck.shot(deck)
    return models.resolve(models.named(name), models.Request(shot.rod, shot.target, inputs or {}, shot.values))


def penetration_models() -> tuple[str, ...]:
    """Names of all analytic penetration models, as `hydro2d model` lists them."""
    return tuple(catalogue.MODELS)


def fit_residual_velocity(velocities: Sequence[float], residual_velocities: Sequence[float], *,
                          p: float | None = None) -> lambert_jonas.Fit:
    """The formula of Lambert and Jonas fitted to shots through a plate: v_r = a (V^p - v_bl^p)^(1/p) above the limit v_bl.

    velocities, residual_velocities : of each shot before and behind the plate, m/s; 0 behind a plate that stopped it
    p : the exponent; by default it is fitted as well

    The result has ``limit_velocity``, the ballistic limit v_bl in m/s, ``a``, ``p``, ``standard_error`` of v_r in m/s, and the
    number of ``shots``. Raises ValueError if fewer shots perforated than there are constants to fit.
    """
    return lambert_jonas.fit(velocities, residual_velocities, p=p)
