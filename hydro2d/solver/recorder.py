"""The history of a simulation: a row of numbers at intervals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hydro2d.base.errors import Error
from hydro2d.materials.outside import ModelError
from hydro2d.measure.penetrator import Projectile
from hydro2d.measure.station_columns import PEAKS
from hydro2d.output.history import CRATER, DEBRIS, Columns
from hydro2d.output.station_arrays import RESERVED
from hydro2d.solver.due import Due

#: prefix of the names of the ejecta of the first target in a formula
EJECTA = "ejecta"


class ColumnError(Error):
    """A column of the user's that has no name for a file, or fails."""


def row(sim: Any) -> dict[str, float | str | None]:
    """One row of the history: the measurements of a simulation by name; see `running/columns.py` for all names.

    Raises ColumnError for a column or a result of the user's that fails.
    """
    conserved = sim.conservation()
    values = {"time": sim.time, "cycle": sim.cycle, "dt": sim.dt, **sim.diagnostics()}
    values |= {f"mass_change_{body}": change for body, change in conserved["mass"].items()}
    values |= {f"{name}_change": conserved[name] for name in ("axial_momentum", "total_energy")}
    values |= {name: conserved[name] for name in ("internal_energy_J", "kinetic_energy_J")}
    for name, measured in sim.of_bodies().items():
        values |= {f"body_{name}_{key}": value for key, value in dict(measured).items()}
    for name, point in sim.stations.measure().items():
        values |= {f"{name}_{key}": value for key, value in point.items() if key not in PEAKS}
    for sink, amounts in conserved["sinks"].items():
        values |= {f"sink_{sink}_{name}": amount for name, amount in amounts.items()}
    values |= own_results(sim)
    values |= derived(sim, values)
    check(sim.columns)
    for name, of in sim.columns.items():
        if name in values or name in RESERVED:
            raise ColumnError(f"the history has a column {name} of its own; give yours another name")
        try:
            values[name] = float(of(sim))
        except Exception as error:
            raise ColumnError(f"the column {name} fails: {type(error).__name__}: {error}") from error
    return values


def own_results(sim: Any) -> dict[str, float | None]:
    """The results that the files of [result] of the deck measure, by name. Raises ColumnError."""
    try:
        return {name: value for own in sim.own_results.values() for name, value in own.measure(sim).items()}
    except ModelError as error:
        raise ColumnError(str(error)) from error


def derived(sim: Any, values: Mapping[str, Any]) -> dict[str, float | None]:
    """The quantities that [derived] of the deck defines, by name; values : all other columns of the row."""
    formulas = sim.formulas
    if not formulas:
        return {}
    wanted = {name for formula in formulas.values() for name in formula.names}
    numbers = {short: values.get(column) for short, column in Projectile.short().items()} | dict(values)
    if sim.craters and any(name.startswith(CRATER) for name in wanted):
        numbers |= {f"{CRATER}_{key}": value for key, value in sim.craters[0].measure()}
    if (ejecta := sim.ejecta() if any(name.startswith(EJECTA) for name in wanted) else None) is not None:
        numbers |= {f"{EJECTA}_{key}": value for key, value in ejecta}
    return {name: formula.evaluate(numbers) for name, formula in formulas.items()}


def check(columns: Mapping[str, object]) -> None:
    """Raises ColumnError for a name that no file can have, or a column that is not a function."""
    for name, of in columns.items():
        if not isinstance(name, str) or not name.isidentifier() or name.startswith((CRATER, DEBRIS)):
            raise ColumnError(f"a column cannot be called {name!r}: its name is a word of letters, digits and underscores that "
                              f"does not begin with {CRATER} or {DEBRIS}")
        if not callable(of):
            raise ColumnError(f"the column {name} is a function of the simulation, not {of!r}")


class Recorder:
    """The history of a simulation that writes no files: a row when one is due.

    interval : s
    """

    def __init__(self, interval: float):
        self.columns, self.due = Columns(), Due(interval)

    def __call__(self, sim: Any) -> None:
        """Adds a row if one is due."""
        if self.due(sim.time):
            self.columns.append(row(sim))

    def last(self, sim: Any) -> None:
        """Adds the row of the end unless it is already there."""
        if self.columns.last_time != sim.time:
            self.columns.append(row(sim))
