"""The commands of studies: many runs from one file."""

from __future__ import annotations

from pathlib import Path

from hydro2d.cli.base import Count, Overrides, UsageError


def sweep(
    study: Path,
    *,
    out: Path | None = None,
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
    """Runs all cases of a study, on this machine or on many.

    Example: hydro2d sweep problems/cth_nose_shape/velocity_advection.toml --workers 4 --out runs/study

    Parameters
    ----------
    study
        The study file, TOML: a base deck, axes to vary, exclusions. With --status a study directory will do.
    out
        Directory of the study; default: what the study says, else runs/<name of the study file>.
    set_
        Replaces a value of the deck in all cases, key=value; may be given several times.
    workers
        Number of worker processes; default: cores / threads. With --slurm, the number to ask for.
    threads
        Number of threads of a worker. The results do not depend on it.
    scheduler
        Address of a running dask scheduler, such as tcp://host:8786, whose workers see the same files.
    slurm
        Starts workers with SLURM: a TOML file of arguments of dask_jobqueue.SLURMCluster, such as cores, memory, queue.
    resume
        Continues the study of the directory: finished cases stay, begun ones continue from their restart files.
    overwrite
        Begins cases anew: all of them, or with --resume those whose deck has changed.
    check
        Resolves all decks and prints cases, cells and estimated time; runs nothing.
    status
        Prints the table of the study directory; runs nothing.
    quiet
        Prints nothing but errors; sweep.log is written.
    """
    _fits(workers, scheduler, slurm)
    if status:
        return _status(study, out)
    from hydro2d.study import cases, cluster

    plan = cases.plan(study, set_, search=False, quiet=quiet)
    if check:
        from hydro2d.study import estimate

        return estimate.show(plan, workers or cluster.default_workers(threads))
    from hydro2d.study import sweep as sweeps
    from hydro2d.study.choice import Choice

    connect = _workers(len(plan.cases), workers, threads, scheduler, slurm)
    return sweeps.sweep(
        Choice(plan), out or plan.out, connect, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet
    )


def transition(
    study: Path,
    *,
    out: Path | None = None,
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
    """Searches the impact velocities at which a rod is no longer rigid and at which it erodes, by bisection.

    Example: hydro2d transition problems/cth_nose_shape/transition_hemi_5083.toml --workers 2 --out runs/transition

    The criteria, the runs, experiments and the predictions of the analytic models are printed beside the brackets;
    transition.json in the directory has the same for programs, and `hydro2d report` shows it.

    Parameters
    ----------
    study
        The study file, TOML: a base deck, [transition] with the velocities to search, axes for several transitions. With
        --status a study directory will do.
    out
        Directory of the study; default: what the study says, else runs/<name of the study file>.
    set_
        Replaces a value of the deck in all cases, key=value; may be given several times.
    workers
        Number of worker processes; default: cores / threads. More than there are combinations of the axes try several
        velocities of one at a time. With --slurm, the number to ask for.
    threads
        Number of threads of a worker. The results do not depend on it.
    scheduler
        Address of a running dask scheduler, such as tcp://host:8786, whose workers see the same files.
    slurm
        Starts workers with SLURM: a TOML file of arguments of dask_jobqueue.SLURMCluster, such as cores, memory, queue.
    resume
        Continues the search of the directory: finished cases stay, begun ones continue where they are still needed.
    overwrite
        Begins cases anew: all of them, or with --resume those whose deck has changed.
    check
        Resolves the decks of all velocities and prints how many runs are needed and their time; runs nothing.
    status
        Prints the cases of the study directory and the transitions as far as they are known; runs nothing.
    quiet
        Prints nothing but errors; sweep.log and transition.json are written.
    """
    _fits(workers, scheduler, slurm)
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


def _workers(most: int, workers: int | None, threads: int, scheduler: str | None, slurm: Path | None):
    """Gives a dask client of the workers that the arguments ask for, at most so many on this machine."""
    from hydro2d.study import cluster

    if scheduler is not None:
        return cluster.joined(scheduler)
    if slurm is not None:
        return cluster.slurm(slurm, workers or 1, threads)
    return cluster.local(min(workers or cluster.default_workers(threads), most), threads)


def _fits(workers: int | None, scheduler: str | None, slurm: Path | None) -> None:
    if scheduler is not None and slurm is not None:
        raise UsageError("--scheduler joins workers and --slurm starts them: give one of them")
    if scheduler is not None and workers is not None:
        raise UsageError("--workers starts workers and --scheduler joins those that run: give one of them")


def _status(study: Path, out: Path | None) -> int:
    from hydro2d.study import layout, monitor

    found = layout.read(out or (study if study.is_dir() else _directory(study)))
    told = monitor.status(found)
    if found.search is not None:
        from hydro2d.study import regimes

        told += ["", *regimes.lines(found, regimes.of_study(found))]
    for line in told:
        print(line)
    return 0


def _directory(study: Path) -> Path:
    """Where a study file's results are."""
    from hydro2d.study import definition

    found, *_ = definition.read(study, [])
    return Path(found.out or f"runs/{study.stem}")
