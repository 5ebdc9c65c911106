"""A finished or interrupted run, read back: summary, history, fields. `hydro2d.load(directory)` gives one."""

from __future__ import annotations

import functools
import json
import tomllib
from pathlib import Path

import numpy as np

from . import history, snapshot, vtk
from .run import DECK, HISTORY, SUMMARY


class ResultsError(Exception):
    """A directory that holds no run, or not what is asked for; the message is for the user."""


class Results:
    """A run directory.

    Attributes
    ----------
    directory : Path
    deck : dict
        The resolved deck, SI units.
    summary : dict
        What summary.json holds; empty while the run has not ended.
    """

    def __init__(self, directory: Path | str):
        self.directory = Path(directory)
        try:
            self.deck = tomllib.loads((self.directory / DECK).read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise ResultsError(f"{self.directory} is not a run directory: it has no {DECK}") from None
        except (OSError, ValueError) as error:
            raise ResultsError(f"{self.directory / DECK} cannot be read: {error}") from None
        file = self.directory / SUMMARY
        try:
            self.summary = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        except (OSError, ValueError) as error:
            raise ResultsError(f"{file} cannot be read: {error}") from None

    @property
    def label(self) -> str:
        """What the run is called in figures: the name of its directory."""
        return self.directory.resolve().name

    @functools.cached_property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of the history by name, shapes (rows,). Raises HistoryError."""
        return history.read(self.directory / HISTORY)

    def to_pandas(self):
        """The history as a pandas.DataFrame with the time as index."""
        import pandas

        return pandas.DataFrame(self.history).set_index("time")

    def to_xarray(self):
        """The history as an xarray.Dataset with units."""
        import xarray

        variables = {name: ("time", column, {"units": history.unit(name)}) for name, column in self.history.items()}
        return xarray.Dataset({name: entry for name, entry in variables.items() if name != "time"},
                              coords={"time": variables["time"]})  # fmt: skip

    @property
    def dumps(self) -> list[tuple[float, Path]]:
        """Times and files of the dumps; empty where none was written."""
        series = self.directory / vtk.SERIES["dump"]
        if not series.exists():
            return []
        return [(time, self.directory / file) for time, file in vtk.read_series(series)]

    def dump_file(self, time: float | None = None) -> Path:
        """The dump nearest to a time in s; the last one where no time is given. Raises ResultsError."""
        dumps = self.dumps
        if not dumps:
            raise ResultsError(f"{self.directory} has no fields: no dump was written yet")
        return dumps[-1][1] if time is None else min(dumps, key=lambda entry: abs(entry[0] - time))[1]

    def dump(self, time: float | None = None) -> vtk.Dump:
        """The fields at the dump nearest to a time in s, or at the last."""
        return vtk.read_grid(self.dump_file(time))

    def state(self) -> vtk.Dump:
        """The fields in full precision at the restart file, whatever was dumped. Raises SnapshotError."""
        return vtk.Dump.of(self.simulation())

    def simulation(self):
        """The simulation as the restart file holds it. Raises SnapshotError."""
        from . import deck as decks
        from .simulation import Simulation

        saved, _ = snapshot.read_latest(self.directory)
        sim = Simulation(decks.loads(saved.deck))
        sim.load_restart_arrays(saved.arrays)
        sim.load_restart_scalars(saved.scalars)
        return sim

    def grid(self, time: float | None = None):
        """The same as a pyvista.RectilinearGrid, x = r, y = z."""
        return vtk.pyvista_grid(self.dump_file(time))

    def section(self, field: str = "pressure", mirror: str | None = None, time: float | None = None):
        """A matplotlib Figure of the section; see figures.sections."""
        from . import figures

        return figures.sections([self], field, mirror=mirror, times=[time])

    @property
    def surface(self) -> float | None:
        """Axial position of the target's original surface, m."""
        return self.deck.get("penetration", {}).get("surface")

    @property
    def direction(self) -> int:
        """+1 where the rod flies along +z, -1 otherwise."""
        rod = self.deck.get("penetration", {}).get("rod")
        return next((body.get("direction", 1) for body in self.deck["body"] if body["name"] == rod), 1)

    @property
    def measured_depth(self) -> float | None:
        """The experiment's penetration, m."""
        return self.deck.get("experiment", {}).get("penetration")


def load(directory: Path | str) -> Results:
    """Opens a run directory. Raises ResultsError."""
    return Results(directory)
