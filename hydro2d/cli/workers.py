"""Options of all commands that run many cases: the workers, and what happens to existing runs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from cyclopts import Parameter

from hydro2d.cli.base import Count, UsageError


@Parameter(name="*")
@dataclass(frozen=True)
class Workers:
    """The options as given, in the order of --help.

    Parameters
    ----------
    workers
        Number of worker processes; default: cores / threads. With --slurm, the number to request.
    threads
        Number of threads per worker. The results do not depend on it.
    scheduler
        Address of a running dask scheduler, such as tcp://host:8786; its workers must see the same files.
    slurm
        TOML file with arguments of dask_jobqueue.SLURMCluster, such as cores, memory, queue; SLURM then starts the workers.
    resume
        Continues in the directory: finished cases are kept, unfinished cases continue from their restart files.
    overwrite
        Restarts cases from the beginning: all cases, or with --resume only those whose deck has changed.
    """

    workers: Count | None = None
    threads: Count = 1
    scheduler: str | None = None
    slurm: Path | None = None
    resume: bool = False
    overwrite: bool = False

    def check(self) -> None:
        """Raises UsageError for options that exclude each other."""
        if self.scheduler is not None and self.slurm is not None:
            raise UsageError("--scheduler joins workers and --slurm starts them: give one of them")
        if self.scheduler is not None and self.workers is not None:
            raise UsageError("--workers starts workers and --scheduler joins running ones: give one of them")

    @property
    def anew(self) -> bool:
        """Whether all cases start again, even those whose rows are kept."""
        return self.overwrite and not self.resume

    @property
    def number(self) -> int:
        """The number of workers on this machine."""
        from hydro2d.study.run import cluster

        return self.workers or cluster.default_workers(self.threads)

    def connect(self, most: int):
        """A dask client with these workers; on this machine, at most `most` of them."""
        from hydro2d.study.run import cluster

        if self.scheduler is not None:
            return cluster.joined(self.scheduler)
        if self.slurm is not None:
            return cluster.slurm(self.slurm, self.workers or 1, self.threads)
        return cluster.local(cluster.needed(self.workers, self.threads, most), self.threads)


#: the options if none are given
DEFAULT = Workers()
