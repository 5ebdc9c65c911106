"""A preload of dask workers for tests: HYDRO2D_SABOTAGE holds the fate of cases, {"case": fate}."""

import json
import os
import signal
from pathlib import Path

from hydro2d.running import run
from hydro2d.solver import simulation

PLANNED = json.loads(os.environ["HYDRO2D_SABOTAGE"])


def _befall(what):
    if what == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if what == "raise":
        raise ZeroDivisionError("a fault that nobody foresaw")
    if what == "full":
        with open("/dev/full", "w") as file:  # every write fails as on a full disk
            file.write("x")


def _unphysical(_sim):
    raise simulation.UnphysicalState("a state that cannot be")


def dask_setup(worker):
    """Called by dask as the worker starts."""
    honest, step = run.run, simulation.Simulation.step

    def dishonest(deck, directory=None, **options):
        what = PLANNED.get(Path(directory).name)
        _befall(what)
        simulation.Simulation.step = _unphysical if what == "unphysical" else step
        return honest(deck, directory, **options)

    run.run = dishonest
