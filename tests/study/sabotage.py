"""A preload of dask workers for tests: HYDRO2D_SABOTAGE holds the fate of cases, {"case": fate}.

A fate that is a number is the memory that a case may take, in MiB.
"""

import json
import os
import resource
import signal
from pathlib import Path

from hydro2d.running import run
from hydro2d.solver import simulation

PLANNED = json.loads(os.environ["HYDRO2D_SABOTAGE"])


def _limited(megabytes):
    """Lets this process take only as much more memory; None: as much as there is."""
    limit = most = resource.getrlimit(resource.RLIMIT_AS)[1]
    if megabytes is not None:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        limit = pages * resource.getpagesize() + (megabytes << 20)
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))


def _befall(what):
    if isinstance(what, int):
        _limited(what)
    if what == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if what == "raise":
        raise ZeroDivisionError("a fault that nobody foresaw")
    if what == "full":
        with open("/dev/full", "w") as file:  # every write fails as on a full disk
            file.write("x")


def _unphysical(_sim, *_until, **_cycles):
    raise simulation.UnphysicalState("a state that cannot be")


def dask_setup(worker):
    """Called by dask as the worker starts."""
    honest, advance = run.run, simulation.Simulation.advance

    def dishonest(deck, directory=None, **options):
        what = PLANNED.get(Path(directory).name)
        _befall(what)
        simulation.Simulation.advance = _unphysical if what == "unphysical" else advance
        try:
            return honest(deck, directory, **options)
        finally:
            _limited(None)

    run.run = dishonest
