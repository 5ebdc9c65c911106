"""The source of the workers: this machine, a running cluster, or SLURM; all of them through dask."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from pydantic import Field, ValidationError

from hydro2d.base import children
from hydro2d.base.errors import DeckError
from hydro2d.base.formats import in_shell
from hydro2d.base.keys import Section
from hydro2d.base.version import __version__
from hydro2d.files import toml
from hydro2d.files.key_lines import Sources
from hydro2d.study.plan.definition import StudyError, explained

#: address at which a sweep on this machine listens
HERE = "127.0.0.1"
#: attempts to start the workers of this machine
STARTS = 3
#: open files that dask needs at a time on this machine, and for each worker
FILES, FILES_OF_A_WORKER = 48, 16
#: settings of dask for a scheduler and workers whose web server, until it is closed, has no pages
NO_PAGES: dict[str, list[str]] = {"distributed.scheduler.http.routes": [], "distributed.worker.http.routes": []}
#: seconds to wait for the scheduler of --scheduler
ANSWER = 15


class Slurm(Section):
    """Keyword arguments of dask_jobqueue.SLURMCluster for one job. Threads and environment follow from --threads."""

    cores: int = Field(ge=1, description="cores of a job; it has cores // threads workers")
    memory: str = Field(description='memory of a job, such as "16 GB"')
    queue: str | None = Field(None, description="partition")
    account: str | None = None
    walltime: str | None = Field(None, description='such as "12:00:00"')
    interface: str | None = Field(None, description='network interface, such as "ib0"')
    python: str | None = Field(None, description="the interpreter of the workers; default: this one")
    shebang: str | None = None
    local_directory: str | None = Field(None, description="dask's scratch folder on the nodes")
    log_directory: str | None = Field(None, description="folder for the output of the jobs")
    death_timeout: float | None = Field(None, gt=0, description="seconds after which a worker without a scheduler ends")
    job_extra_directives: tuple[str, ...] = Field((), description="further lines for #SBATCH")
    job_directives_skip: tuple[str, ...] = Field((), description="#SBATCH lines to leave out")
    job_script_prologue: tuple[str, ...] = Field((), description="commands before the worker, such as module load")
    worker_extra_args: tuple[str, ...] = Field((), description="arguments of `dask worker`")

    def arguments(self, threads: int) -> dict[str, Any]:
        """The arguments for SLURMCluster: dask sees one core per worker, SLURM sees all cores."""
        given = {name: value for name, value in self.model_dump().items() if value not in (None, ())}
        given = {name: list(value) if isinstance(value, tuple) else value for name, value in given.items()}
        workers = max(self.cores // threads, 1)
        exports = [f"export {name}={in_shell(value)}" for name, value in environment(threads).items()]
        return given | {
            "cores": workers, "processes": workers, "job_cpu": self.cores,
            "job_script_prologue": [*exports, *given.get("job_script_prologue", [])],
        }


def read_slurm(path: Path) -> Slurm:
    """The file of --slurm. Raises StudyError."""
    sources = Sources()
    try:
        data = toml.read(path, sources)
        return Slurm.model_validate(data)
    except DeckError as error:
        raise StudyError(str(error)) from None
    except ValidationError as error:
        raise StudyError(explained(error, data, sources, {(): Slurm})) from None


def default_workers(threads: int) -> int:
    """Number of workers that use all cores of this machine."""
    return max((os.cpu_count() or 1) // threads, 1)


def needed(workers: int | None, threads: int, cases: int) -> int:
    """Number of workers on this machine: as requested, or as many as use all cores, but at most one per case."""
    return min(workers or default_workers(threads), cases)


def environment(threads: int) -> dict[str, str]:
    """Variables of a worker process."""
    variables = {"NUMBA_NUM_THREADS": str(threads), "OMP_NUM_THREADS": str(threads), children.SAFE: "1"}
    return {**variables, **{name: os.environ[name] for name in ("HYDRO2D_CACHE_DIR", "HYDRO2D_TARGET") if name in os.environ}}


@contextmanager
def local(workers: int, threads: int) -> Iterator:
    """A client with spawned worker processes on this machine, which nobody else can reach.

    All of them listen on the loopback interface only and communicate by TLS with a certificate made for this sweep, because
    anyone who could connect could run code in the workers. None of them serves dask's web pages, which need no certificate.

    Raises StudyError, OSError (too few open files are allowed).
    """
    _allow_files(FILES + FILES_OF_A_WORKER * workers)
    with children.safe(), ExitStack() as stack:
        yield _begun(stack, workers, threads)


def _allow_files(number: int) -> None:
    """Lets this process have so many open files at a time. Raises OSError if the system does not allow it.

    Windows has no such limit.
    """
    try:
        import resource
    except ImportError:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != resource.RLIM_INFINITY and soft < number:
        if hard != resource.RLIM_INFINITY and hard < number:
            raise OSError(errno.EMFILE, f"the workers need {number} open files at a time and the system allows {hard}")
        resource.setrlimit(resource.RLIMIT_NOFILE, (number, hard))


def _begun(stack: ExitStack, workers: int, threads: int):
    """The client of `local`, which ends with the stack. If a worker dies before all have started, all are started anew.

    Raises StudyError.
    """
    import dask
    import distributed  # has its settings before they are changed
    from distributed.security import Security

    stack.enter_context(dask.config.set(NO_PAGES))
    for number in range(STARTS):
        with ExitStack() as attempt:
            try:
                cluster = attempt.enter_context(distributed.LocalCluster(
                    n_workers=workers, threads_per_worker=1, processes=True, memory_limit=0, host=HERE, protocol="tls://",
                    security=Security.temporary(), dashboard_address=None, worker_dashboard_address=None,
                    scheduler_kwargs={"dashboard_address": f"{HERE}:0"},  # another sweep may have the usual port
                    env=environment(threads),
                ))
                cluster.loop.add_callback(cluster.scheduler.http_server.stop)
                client = _with_checkpoints(attempt.enter_context(distributed.Client(cluster)), private=True)
            except (RuntimeError, OSError) as error:
                if number == STARTS - 1:
                    raise StudyError(f"the workers do not start: {' '.join(str(error).split())}") from None
            else:
                stack.push(attempt.pop_all())
                return client


def _with_checkpoints(client, *, private: bool):
    """The client, with workers that write restart files before they end."""
    from hydro2d.materials import outside
    from hydro2d.study.run import worker

    client.register_plugin(worker.Checkpoint(private, outside.offered()))
    return client


@contextmanager
def joined(address: str) -> Iterator:
    """A client of a cluster that someone else has started. Raises StudyError if its workers are unsuitable."""
    import distributed

    try:
        client = distributed.Client(address, timeout=ANSWER)
    except (OSError, ValueError, TypeError) as error:
        raise StudyError(f"--scheduler {address}: no scheduler answers there ({' '.join(str(error).split())})") from None
    with client:
        _check_workers(client, address)
        yield _with_checkpoints(client, private=False)


def _check_workers(client, address: str) -> None:
    """Checks that each worker has one thread and this version of hydro2d."""
    from hydro2d.study.run import worker

    try:
        workers = client.run(worker.introduce)
    except Exception as error:
        raise StudyError(f"--scheduler {address}: its workers cannot import hydro2d {__version__} ({error})") from None
    for place, about in workers.items():
        has = f"--scheduler {address}: {place} has"
        if about["version"] != __version__:
            raise StudyError(f"{has} hydro2d {about['version']}, not {__version__}")
        if about["threads"] != 1:
            raise StudyError(f"{has} {about['threads']} threads; start `dask worker` with --nthreads 1")


@contextmanager
def slurm(path: Path, workers: int, threads: int) -> Iterator:
    """A client with workers that SLURM starts. Raises StudyError."""
    arguments = read_slurm(path).arguments(threads)
    import distributed

    try:
        import dask_jobqueue
    except ImportError:
        raise StudyError("--slurm needs dask-jobqueue, which is not installed: pip install 'hydro2d[slurm]'") from None
    with (
        dask_jobqueue.SLURMCluster(**arguments) as cluster,
        distributed.Client(cluster) as client,
    ):
        cluster.scale(n=workers)
        yield _with_checkpoints(client, private=False)
