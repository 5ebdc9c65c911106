"""The work of a dask worker: one case at a time, and a restart file before the worker ends."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import threading
import time
import uuid
from collections.abc import Iterable

import distributed

from hydro2d.base.interrupt import Interrupt
from hydro2d.base.version import __version__
from hydro2d.materials import outside
from hydro2d.study.records.study_directory import FAILED_STATUS, WAITING
from hydro2d.study.run.case import Outcome, run_case

#: seconds that an ending worker waits for its case to write a restart file
PATIENCE = 60.0
#: exit status of a worker that was ended by SIGTERM
GONE = 128 + signal.SIGTERM


class _Process:
    """The case that this process runs, and the sweeps that must stop."""

    def __init__(self):
        self.busy = threading.Lock()
        self.interrupt: Interrupt | None = None
        self.stopped: dict[str, str] = {}
        self.leaving = False


_process = _Process()


def work(sweep: str, directory: str, deck_text: str, threads: int, overwrite: bool) -> dict:
    """The task of dask: runs a case and returns its Outcome as a plain table.

    sweep : name of the sweep, which `stop` may have stopped
    """
    if not _process.busy.acquire(blocking=False):
        return Outcome(FAILED_STATUS, "its worker is running another case; workers must have one thread (--nthreads 1)").plain()
    try:
        _process.interrupt = Interrupt()
        if sweep in _process.stopped:  # after the line above: a stop that comes now finds the interrupt
            return Outcome(WAITING, fresh=False).plain()
        outcome = run_case(directory, deck_text, threads=threads, overwrite=overwrite, interrupt=_process.interrupt)
    finally:
        _process.interrupt = None
        _process.busy.release()
    if _process.leaving:
        os._exit(GONE)  # the scheduler gives the case to another worker
    return outcome.plain()


def stop(sweep: str, reason: str) -> None:
    """Ends the running case after its cycle, with a restart file. Later cases of this sweep do not begin."""
    _process.stopped[sweep] = reason
    interrupt = _process.interrupt
    if interrupt is not None:
        interrupt(reason)


def introduce(dask_worker) -> dict:
    """Data for a sweep about a worker that someone else has started."""
    return {"version": __version__, "threads": dask_worker.state.nthreads}


def _on_sigterm(_number, _frame) -> None:
    """Lets the running case, if there is one, write its restart file first."""
    _process.leaving = True
    interrupt = _process.interrupt
    if interrupt is None:
        os._exit(GONE)
    interrupt("SIGTERM")


class Checkpoint(distributed.WorkerPlugin):
    """Lets the case of an ending worker write a restart file. The sweep handles Ctrl-C, not its workers."""

    def __init__(self, private: bool, models: Iterable[tuple[str, str, str]] = ()):
        #: own name: dask tears down a plugin of the same name, which would end the running cases of its sweep
        self.name = f"hydro2d-{uuid.uuid4().hex[:12]}"
        self.models = list(models)  # of the whole study: kernels are loaded with the first case
        self.private = private  # the worker belongs to this sweep alone

    def setup(self, worker) -> None:
        """Called by dask as the worker starts."""
        if self.models:
            outside.take_over(self.models)
        if self.private:
            logging.getLogger("distributed").setLevel(logging.CRITICAL)  # nobody needs to know of lost connections at the end
            worker.http_server.stop()
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            signal.signal(signal.SIGTERM, _on_sigterm)

    async def teardown(self, worker) -> None:
        """Called by dask as the worker closes."""
        until = time.monotonic() + PATIENCE
        while (interrupt := _process.interrupt) is not None and time.monotonic() < until:
            interrupt("the worker closes")
            await asyncio.sleep(0.05)
