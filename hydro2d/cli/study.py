"""Commands for studies: many runs from one file."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hydro2d.base.terminal import say, wrapped
from hydro2d.cli.base import FINEST, MOST_MEMBERS, Out, Overrides, UsageError, whole
from hydro2d.cli.workers import DEFAULT, Workers

if TYPE_CHECKING:
    from hydro2d.study.records.study_directory import Study

#: reduction of the priority of a study in the background
NICE = 10


def sweep(
    study: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Workers = DEFAULT,
    only: list[str] | None = None,
    members: Annotated[int | None, whole(1, MOST_MEMBERS)] = None,
    cells: float | None = None,
    check: bool = False,
    status: bool = False,
    background: bool = False,
    quiet: bool = False,
) -> int:
    """Runs all cases of a study, on this machine or on many.

    Example: hydro2d sweep problems/cth_nose_shape/velocity_advection.toml --workers 4 --out runs/study

    The parts of a study, sweeps and searches, run in turn, each in its own directory. If a study keeps rows of its runs in a
    file (`keep`), a run is made only if the file has no row for its deck and this version of the method.

    Parameters
    ----------
    study
        Study file (TOML): a base deck, axes to vary, exclusions; or parts. With --status, a study directory is accepted too.
    out
        Study directory; default: `out` of the study file, else runs/<name of the study file>.
    set_
        Overrides a value of the deck in all cases, as key=value; can be repeated.
    only
        Runs the cases whose names match this pattern, such as "*ogive*", or these parts; can be repeated. The others stay
        pending; --resume runs them later.
    members
        Number of members of each case, instead of that of the study file; 1 runs each case once.
    cells
        Cells across the radius of the projectile of each deck, instead of those of the decks.
    check
        Resolves all decks and prints the cases with their cells and estimated times; runs nothing.
    status
        Prints the table of the study directory; runs nothing.
    background
        Returns at once; the study continues at low priority, even if the terminal is closed.
    quiet
        Prints errors only; sweep.log is still written.
    """
    from hydro2d.study.plan.scaling import Size

    workers.check()
    if cells is not None and not 0.0 < cells <= FINEST:
        raise UsageError(f"--cells {cells:g}: must lie between 0 and {FINEST:g}")
    size = Size(members, cells)
    if _is_of_parts(study):
        if status:
            return _status_of_parts(study, out)
        if background:
            return _in_background(out or _directory(study))
        return _parts(study, out or _directory(study), set_ or [], size, workers, only or (), check=check, quiet=quiet)
    if status:
        return _status(study, out)
    from hydro2d.study.plan import cases

    if background:
        return _in_background(out or _directory(study))
    plan = cases.plan(study, set_, search=False, quiet=quiet, size=size)
    if check:
        from hydro2d.study.run import estimate
        from hydro2d.study.run.choice import Choice

        choice = Choice(plan, only or (), again=workers.anew)
        ended = estimate.show(replace(plan, cases=choice.selected), workers.number) if choice.selected else 0
        if choice.kept():
            say(wrapped(choice.kept()))
        return ended
    return run_study(plan, out or plan.out, workers, only=only or (), quiet=quiet)


def run_study(plan, out: Path, workers: Workers, *, only: Sequence[str] = (), skip: Sequence[str] = (), quiet: bool) -> int:
    """Runs the cases of a plan and prints the joint results of ensembles. Returns the exit status."""
    from hydro2d.study.records import sample_table, study_directory
    from hydro2d.study.run import sweep as sweeps
    from hydro2d.study.run.choice import Choice

    choice = Choice(plan, only, skip, again=workers.anew)
    status = sweeps.sweep(choice, out, workers.connect(len(choice.selected)), threads=workers.threads, resume=workers.resume,
                          overwrite=workers.overwrite, quiet=quiet)
    if quiet or not (out / (sample_table.FILE if plan.sample else study_directory.STUDY)).is_file():  # the disk may be full
        return status
    if plan.sample:
        _show_samples(study_directory.read(out))
    elif plan.ensemble:
        say("")
        _show_ensembles(out)
    return status


def _is_of_parts(study: Path) -> bool:
    from hydro2d.study import study_parts

    return study.is_file() and study_parts.is_of_parts(study)


def _parts(study: Path, place: Path, overrides: list[str], size, workers: Workers, only: Sequence[str], *, check: bool,
           quiet: bool) -> int:
    """Runs the parts of a study in turn. The next part runs despite a failed case, but not after an interrupt."""
    from hydro2d.study import study_parts
    from hydro2d.study.records import study_directory
    from hydro2d.study.run.sweep import SOME_FAILED

    plans = study_parts.plans(study, overrides, size, only, again=workers.anew, quiet=quiet)
    if check:
        return study_parts.show(plans, workers.number)
    worst = 0
    place.mkdir(parents=True, exist_ok=True)
    for number, each in enumerate(plans, 1):
        if not quiet:
            say(f"part {number} of {len(plans)}: {each.name}")
        directory = place / each.name
        of_part = replace(workers, resume=workers.resume and (directory / study_directory.STUDY).is_file())
        if each.plan.search:
            status = run_search(each.plan, directory, of_part, quiet=quiet)
        else:
            status = run_study(each.plan, directory, of_part, only=each.part.only, skip=each.part.skip, quiet=quiet)
        if status > SOME_FAILED:
            return status
        worst = max(worst, status)
    for line in study_parts.mixed(plans):
        say(wrapped(line))
    return worst


def _status_of_parts(study: Path, out: Path | None) -> int:
    """Prints how far each part of a study has got."""
    from hydro2d.study.records import study_directory
    from hydro2d.study.run import monitor

    for directory in sorted(file.parent for file in (out or _directory(study)).glob(f"*/{study_directory.STUDY}")):
        say(wrapped(f"{directory.name}: {monitor.counts(list(study_directory.read(directory).cases))}"))
    return 0


def _in_background(place: Path) -> int:
    """Starts this command again without --background, detached and at low priority, with its output in a file."""
    from hydro2d.base.children import detached

    place.mkdir(parents=True, exist_ok=True)
    log = place / "background.log"
    process = detached([word for word in sys.argv[1:] if word != "--background"], log, NICE)
    say(wrapped(f"process {process} runs the study in {place}; its output is in {log}; `kill {process}` stops it, and --resume "
                "continues it"))
    return 0


def transition(
    study: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Workers = DEFAULT,
    check: bool = False,
    status: bool = False,
    quiet: bool = False,
) -> int:
    """Searches for the impact velocities at which a rod stops being rigid, erodes or perforates; v50 if chance decides.

    Example: hydro2d transition problems/cth_nose_shape/transition_hemi_5083.toml --workers 2 --out runs/transition

    The search is a bisection. With a budget of runs in the study it is a sequence that gives v50, its 90 % interval and the
    width. The results are printed next to the criteria, the runs, the experiments and the predictions of the analytic models.
    The file transition.json in the study directory has the same results for programs, and `hydro2d report` shows them. If there
    are more workers than combinations of the axes, several velocities of one combination are tried at a time. --resume
    continues unfinished cases that the search still needs.

    Parameters
    ----------
    study
        Study file (TOML): a base deck, [transition] with the velocities to search, axes for several transitions. With
        --status, a study directory is accepted too.
    out
        Study directory; default: `out` of the study file, else runs/<name of the study file>.
    set_
        Overrides a value of the deck in all cases, as key=value; can be repeated.
    check
        Resolves the decks of all velocities and prints the number of runs needed and their time; runs nothing.
    status
        Prints the cases of the study directory and the transitions found so far; runs nothing.
    quiet
        Prints errors only; sweep.log and transition.json are still written.
    """
    workers.check()
    if status:
        return _status(study, out)
    from hydro2d.study.plan import cases

    plan = cases.plan(study, set_, search=True, quiet=quiet)
    if check:
        from hydro2d.study.run import estimate

        return estimate.show_search(plan, workers.number)
    return run_search(plan, out or plan.out, workers, quiet=quiet)


def run_search(plan, out: Path, workers: Workers, *, quiet: bool) -> int:
    """Runs a search and prints its transitions. Returns the exit status."""
    from hydro2d.study.search import transition as transitions

    return transitions.find(
        plan, out, workers.connect(len(plan.cases)), threads=workers.threads, resume=workers.resume,
        overwrite=workers.overwrite, quiet=quiet,
    )


def _show_ensembles(directory: Path) -> None:
    """Prints the joint results of the members of each case of a study."""
    from hydro2d.study.ensemble import contents, ensembles
    from hydro2d.study.records import responses, study_directory

    results = contents.collect(study_directory.read(directory))
    for line in ensembles.report(results.ensembles, responses.choose(results.study, results.records).y):
        say(wrapped(line))


def _show_samples(study: Study, shares: bool = True) -> None:
    """Prints the results of the sample of a study, for each combination of its axes; ``shares`` : with Sobol indices."""
    from hydro2d.study.samples import results, text

    for samples in results.of_study(study):
        say("")
        for line in text.report(samples, shares):
            say(wrapped(line))


def _status(study: Path, out: Path | None) -> int:
    from hydro2d.study.records import study_directory
    from hydro2d.study.run import monitor

    opened = study_directory.read(out or (study if study.is_dir() else _directory(study)))
    lines = monitor.status(opened)
    if opened.search is not None:
        from hydro2d.study.search import regimes

        lines += ["", *regimes.lines(opened, regimes.of_study(opened))]
    for line in lines:
        say(wrapped(line))
    if opened.sample:
        to_come = (study_directory.WAITING, study_directory.RUNNING, study_directory.INTERRUPTED)
        complete = not any(case.status in to_come for case in opened.cases)
        _show_samples(opened, shares=complete)
        if not complete:
            say("")
            say(f"The shares of the variance follow when no run is to come; `hydro2d report {opened.directory}` has them now.")
    elif opened.ensembles:
        say("")
        _show_ensembles(opened.directory)
    return 0


def _directory(study: Path) -> Path:
    """The directory of a study file's results."""
    from hydro2d.study.plan import definition

    defined, *_ = definition.read(study, [])
    return Path(defined.out or f"runs/{study.stem}")
