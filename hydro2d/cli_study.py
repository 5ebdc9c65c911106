"""The commands of studies: many runs from one file."""

from __future__ import annotations

import os
from pathlib import Path

from .cli_base import Overrides, UsageError


def sweep(
    study: Path,
    *,
    out: Path | None = None,
    set_: Overrides = None,
    workers: int | None = None,
    threads: int = 1,
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
    _fits(workers, threads, scheduler, slurm)
    if status:
        return _status(study, out)
    from .study import cases

    plan = cases.plan(study, set_)
    if check:
        from .study import estimate

        return estimate.show(plan, workers or default_workers(threads))
    from .study import cluster
    from .study import sweep as sweeps

    if scheduler is not None:
        connect = cluster.joined(scheduler)
    elif slurm is not None:
        connect = cluster.slurm(slurm, workers or 1, threads)
    else:
        connect = cluster.local(min(workers or default_workers(threads), len(plan.cases)), threads)
    return sweeps.sweep(
        plan, out or plan.out, connect, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet
    )


def default_workers(threads: int) -> int:
    """As many as the cores of this machine carry."""
    return max((os.cpu_count() or 1) // threads, 1)


def _fits(workers: int | None, threads: int, scheduler: str | None, slurm: Path | None) -> None:
    for name, value in (("--workers", workers), ("--threads", threads)):
        if value is not None and value < 1:
            raise UsageError(f"{name} {value}: at least 1 is needed")
    if scheduler is not None and slurm is not None:
        raise UsageError("--scheduler joins workers and --slurm starts them: give one of them")
    if scheduler is not None and workers is not None:
        raise UsageError("--workers starts workers and --scheduler joins those that run: give one of them")


def _status(study: Path, out: Path | None) -> int:
    from .study import layout, monitor

    directory = out or (study if study.is_dir() else _directory(study))
    for line in monitor.status(layout.read(directory)):
        print(line)
    return 0


def _directory(study: Path) -> Path:
    """Where a study file's results are."""
    from .study import definition

    found, *_ = definition.read(study, [])
    return Path(found.out or f"runs/{study.stem}")
