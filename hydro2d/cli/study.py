"""The commands for studies: many runs from one file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from hydro2d.cli.base import Count, Out, Overrides, UsageError
from hydro2d.terminal import say


def sweep(
    study: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Count | None = None,
    threads: Count = 1,
    scheduler: str | None = None,
    slurm: Path | None = None,
    only: list[str] | None = None,
    resume: bool = False,
    overwrite: bool = False,
    check: bool = False,
    status: bool = False,
    quiet: bool = False,
) -> int:
    """Runs all cases of a study, on this machine or on many.

    Example: hydro2d sweep problems/cth_nose_shape/velocity_advection.toml --workers 4 --out runs/study

    Parameters
    ----------
    study
        Study file (TOML): a base deck, axes to vary, exclusions. With --status, a study directory is accepted too.
    out
        Study directory; default: `out` of the study file, else runs/<name of the study file>.
    set_
        Overrides a value of the deck in all cases, as key=value; can be repeated.
    workers
        Number of worker processes; default: cores / threads. With --slurm, the number to request.
    threads
        Number of threads per worker. The results do not depend on it.
    scheduler
        Address of a running dask scheduler, such as tcp://host:8786; its workers must see the same files.
    slurm
        TOML file with arguments of dask_jobqueue.SLURMCluster, such as cores, memory, queue; SLURM then starts the workers.
    only
        Runs the cases whose names match this pattern, such as "*ogive*"; can be repeated. The others wait for a later --resume.
    resume
        Continues the study in the directory: finished cases are kept, unfinished cases continue from their restart files.
    overwrite
        Restarts cases from the beginning: all cases, or with --resume only those whose deck has changed.
    check
        Resolves all decks and prints the cases with their cells and estimated times; runs nothing.
    status
        Prints the table of the study directory; runs nothing.
    quiet
        Prints errors only; sweep.log is still written.
    """
    check_fit(workers, scheduler, slurm)
    if status:
        return _status(study, out)
    from hydro2d.study import cases, cluster

    plan = cases.plan(study, set_, search=False, quiet=quiet)
    if check:
        from hydro2d.study import estimate
        from hydro2d.study.choice import Choice

        choice = Choice(plan, only or ())
        return estimate.show(replace(plan, cases=choice.selected), workers or cluster.default_workers(threads))
    return run_study(
        plan, out or plan.out, workers=workers, threads=threads, scheduler=scheduler, slurm=slurm, only=only or (),
        resume=resume, overwrite=overwrite, quiet=quiet,
    )


def run_study(plan, out: Path, *, workers: int | None, threads: int, scheduler: str | None = None, slurm: Path | None = None,
              only: Sequence[str] = (), resume: bool, overwrite: bool, quiet: bool) -> int:  # fmt: skip
    """Runs the cases of a plan and prints what the members of ensembles say together. Returns the exit status."""
    from hydro2d.study import sweep as sweeps
    from hydro2d.study.choice import Choice

    choice = Choice(plan, only)
    connect = _workers(len(choice.selected), workers, threads, scheduler, slurm)
    status = sweeps.sweep(choice, out, connect, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet)
    if plan.ensemble and not quiet:
        say("")
        _show_ensembles(out)
    return status


def transition(
    study: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Count | None = None,
    threads: Count = 1,
    scheduler: str | None = None,
    slurm: Path | None = None,
    resume: bool = False,
    overwrite: bool = False,
    check: bool = False,
    status: bool = False,
    quiet: bool = False,
) -> int:
    """Searches for the impact velocities at which a rod stops being rigid, erodes or perforates; v50 where chance decides.

    Example: hydro2d transition problems/cth_nose_shape/transition_hemi_5083.toml --workers 2 --out runs/transition

    The search is a bisection, or with a budget of runs in the study a sequence that gives v50, its 90 % interval and the width.
    The results are printed beside the criteria, the runs, the experiments and the predictions of the analytic models. The file
    transition.json in the study directory has the same results for programs, and `hydro2d report` shows them.

    Parameters
    ----------
    study
        Study file (TOML): a base deck, [transition] with the velocities to search, axes for several transitions. With
        --status, a study directory is accepted too.
    out
        Study directory; default: `out` of the study file, else runs/<name of the study file>.
    set_
        Overrides a value of the deck in all cases, as key=value; can be repeated.
    workers
        Number of worker processes; default: cores / threads. Workers beyond the number of combinations of the axes try several
        velocities of one combination at a time. With --slurm, the number to request.
    threads
        Number of threads per worker. The results do not depend on it.
    scheduler
        Address of a running dask scheduler, such as tcp://host:8786; its workers must see the same files.
    slurm
        TOML file with arguments of dask_jobqueue.SLURMCluster, such as cores, memory, queue; SLURM then starts the workers.
    resume
        Continues the search in the directory: finished cases are kept, unfinished cases continue where they are still needed.
    overwrite
        Restarts cases from the beginning: all cases, or with --resume only those whose deck has changed.
    check
        Resolves the decks of all velocities and prints the number of runs needed and their time; runs nothing.
    status
        Prints the cases of the study directory and the transitions found so far; runs nothing.
    quiet
        Prints errors only; sweep.log and transition.json are still written.
    """
    check_fit(workers, scheduler, slurm)
    if status:
        return _status(study, out)
    from hydro2d.study import cases, cluster

    plan = cases.plan(study, set_, search=True, quiet=quiet)
    if check:
        from hydro2d.study import estimate

        return estimate.show_search(plan, workers or cluster.default_workers(threads))
    from hydro2d.study import transition as transitions

    connect = _workers(len(plan.cases), workers, threads, scheduler, slurm)
    return transitions.find(
        plan, out or plan.out, connect, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet
    )


def _show_ensembles(directory: Path) -> None:
    """Prints what the members of each case of a study say together."""
    from hydro2d.study import contents, ensembles, layout, responses

    found = contents.collect(layout.read(directory))
    for line in ensembles.report(found.ensembles, responses.choose(found.study, found.records).y):
        say(line)


def _workers(most: int, workers: int | None, threads: int, scheduler: str | None, slurm: Path | None):
    """A dask client with the workers that the arguments request; on this machine at most `most`."""
    from hydro2d.study import cluster

    if scheduler is not None:
        return cluster.joined(scheduler)
    if slurm is not None:
        return cluster.slurm(slurm, workers or 1, threads)
    return cluster.local(cluster.needed(workers, threads, most), threads)


def check_fit(workers: int | None, scheduler: str | None, slurm: Path | None) -> None:
    """Raises UsageError for ways to get workers that exclude each other."""
    if scheduler is not None and slurm is not None:
        raise UsageError("--scheduler joins workers and --slurm starts them: give one of them")
    if scheduler is not None and workers is not None:
        raise UsageError("--workers starts workers and --scheduler joins running ones: give one of them")


def _status(study: Path, out: Path | None) -> int:
    from hydro2d.study import layout, monitor

    found = layout.read(out or (study if study.is_dir() else _directory(study)))
    told = monitor.status(found)
    if found.search is not None:
        from hydro2d.study import regimes

        told += ["", *regimes.lines(found, regimes.of_study(found))]
    for line in told:
        say(line)
    if found.ensembles:
        say("")
        _show_ensembles(found.directory)
    return 0


def _directory(study: Path) -> Path:
    """Where a study file's results are."""
    from hydro2d.study import definition

    found, *_ = definition.read(study, [])
    return Path(found.out or f"runs/{study.stem}")
