"""The history of a simulation: a row of numbers at intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hydro2d.output.history import Columns
from hydro2d.solver.callbacks import Due

if TYPE_CHECKING:
    from hydro2d.solver.simulation import Simulation


def row(sim: Simulation) -> dict[str, float | str | None]:
    """One row of the history: what a simulation measures, by name; see `running/columns.py` for all names.

    Raises ValueError where a column of the user has the name of another.
    """
    from hydro2d.solver.tracers import PEAKS  # it loads kernels, after which no model can join them

    conserved = sim.conservation()
    values = {"time": sim.time, "cycle": sim.cycle, "dt": sim.dt, **sim.diagnostics()}
    values |= {f"mass_change_{body}": change for body, change in conserved["mass"].items()}
    values |= {f"{name}_change": conserved[name] for name in ("axial_momentum", "total_energy")}
    values |= {name: conserved[name] for name in ("internal_energy_J", "kinetic_energy_J")}
    for name, found in sim.of_bodies().items():
        values |= {f"body_{name}_{key}": value for key, value in found.items()}
    for name, found in sim.stations.measure().items():
        values |= {f"{name}_{key}": value for key, value in found.items() if key not in PEAKS}
    for sink, amounts in conserved["sinks"].items():
        values |= {f"sink_{sink}_{name}": amount for name, amount in amounts.items()}
    for name, of in sim.columns.items():
        if name in values:
            raise ValueError(f"the history has a column {name} of its own; give yours another name")
        values[name] = float(of(sim))
    return values


class Recorder:
    """The history of a simulation that writes no files: a row when one is due.

    interval : s
    """

    def __init__(self, interval: float):
        self.columns, self._due = Columns(), Due(interval)

    def __call__(self, sim: Simulation) -> None:
        """Adds a row where one is due."""
        if self._due(sim.time):
            self.columns.append(row(sim))

    def last(self, sim: Simulation) -> None:
        """Adds the row of the end where it is not there yet."""
        if self.columns.last_time != sim.time:
            self.columns.append(row(sim))
