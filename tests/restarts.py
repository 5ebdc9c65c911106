"""A simulation that continues from another, and the end of a run, for the tests of restarts."""

import json

from hydro2d.output import snapshot
from hydro2d.solver.simulation import Simulation


def restarted(whole: Simulation) -> Simulation:
    """A second simulation that continues from the contents of a restart file of the first."""
    arrays = {name: array.copy() for name, array in whole.restart_arrays().items()}
    again = Simulation(whole.deck)
    again.load_restart_arrays(arrays)
    again.load_restart_scalars(json.loads(json.dumps(whole.restart_scalars())))
    return again


def final(directory) -> tuple[dict, dict]:
    """The arrays, as bytes, and the scalars of the restart file of a run."""
    saved = snapshot.read(directory / "restart.h5")
    return {name: array.tobytes() for name, array in saved.arrays.items()}, saved.scalars
