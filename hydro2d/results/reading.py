"""The results of a run, read from its directory: summary, history, fields. `hydro2d.open_run(directory)` gives them."""

from __future__ import annotations

import copy
import re
import tomllib
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base.errors import Error
from hydro2d.base.formats import in_html
from hydro2d.deck import key_messages
from hydro2d.files import checksums, toml
from hydro2d.files.strange import within
from hydro2d.measure import outcome
from hydro2d.mesh.edges.registry import halved
from hydro2d.output import history, snapshot, vtk
from hydro2d.output.directory import DECK, HISTORY, STUDY, check_own
from hydro2d.results.summaries import summary_of
from hydro2d.results.viewer.packing import DEFAULT_BITS

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas
    import pyvista
    import xarray
    from matplotlib.axes import Axes

    from hydro2d.deck.deck import Deck
    from hydro2d.results.viewer.page import View
    from hydro2d.solver.simulation import Simulation

#: largest number of a deck that is accepted
LARGEST = 1e12
#: a velocity in the name of a directory, which cannot have a slash
VELOCITY = re.compile(r"(?<=\d) ?(km|m|cm|mm|in|ft)-(s|ms|us|µs)(?![A-Za-z0-9])")


class ResultsError(Error):
    """A directory without a run or without the requested data; the message is for the user."""


class Results:
    """A run directory.

    Attributes
    ----------
    directory : Path
    tables : dict
        The resolved deck as nested dicts and lists, in SI units, as in the directory.
    summary : Summary
        The contents of summary.json, ``run.summary.outcome.depth_m``; false, and without results, until the run has ended.
    trust : bool
        Whether the code of outside models in the deck may be executed, which only `simulation` and `state` need.
    """

    def __init__(self, directory: Path | str, *, trust: bool = False):
        self.directory, self.trust = Path(directory).absolute(), trust
        check_own(self.directory)
        if not (self.directory / DECK).exists():
            raise ResultsError(_no_run(self.directory))
        try:
            text = checksums.verified_text(self.directory / DECK, ResultsError)
            self.tables = tomllib.loads(text)
        except (ValueError, RecursionError) as error:
            raise ResultsError(f"{self.directory / DECK} cannot be read: {error}") from None
        self.summary, _ = summary_of(self.directory, text, ResultsError)
        self._history: tuple[int, dict[str, np.ndarray]] | None = None

    @cached_property
    def deck(self) -> Deck:
        """The resolved deck, as `Deck.from_file` gives it: ``deck.body[0].velocity``. ``deck.to_toml()`` writes it.

        Raises DeckError if this version does not accept the deck, and ModelError without trust in a model that it carries.
        """
        from hydro2d.deck import deck as decks

        return decks.loads(toml.dumps(key_messages.renewed(copy.deepcopy(self.tables))), name=self.label, trust=self.trust)

    @property
    def label(self) -> str:
        """The name of the run in figures: that of its directory, with 1086m-s written as 1086 m/s."""
        return VELOCITY.sub(r" \1/\2", self.directory.resolve().name)

    @property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of the history by name, shapes (rows,); read again if a run in progress has written more.

        Raises HistoryError.
        """
        file = self.directory / HISTORY
        try:
            written = file.stat().st_mtime_ns
        except OSError:
            raise history.HistoryError(f"{self.directory} has no history: none was written yet") from None
        if self._history is None or self._history[0] != written:
            self._history = written, history.read(file)
        return self._history[1]

    @property
    def crater(self) -> tuple[np.ndarray, np.ndarray]:
        """Axial positions and radii of the hole in the first target at the end, m, shapes (n,), from entrance to bottom.

        Raises HistoryError, and ResultsError if the run has not ended or has no projectile and target.
        """
        return next(iter(self.craters.values()))

    @property
    def craters(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """The holes in all targets by name, in the order in which the projectile reaches them. Raises what `crater` does."""
        craters = history.read_craters(self.directory / HISTORY)
        if not craters:
            raise ResultsError(f"{self.directory} has no crater: the run has not ended, or has no projectile and target")
        return craters

    @property
    def debris(self) -> dict[str, dict[str, np.ndarray]]:
        """Debris behind each target at the end, by its name: mass by speed and by angle, fragments; see `history.read_debris`.

        Raises HistoryError, and ResultsError if the run has not ended or has no projectile and target.
        """
        debris = history.read_debris(self.directory / HISTORY)
        if not debris:
            raise ResultsError(f"{self.directory} has no debris: the run has not ended, or has no projectile and target")
        return debris

    def to_pandas(self) -> pandas.DataFrame:
        """The history as a pandas.DataFrame with the time in s as index and the regime in words.

        `attrs["units"]` of the frame gives the unit of every column by name. Raises HistoryError.
        """
        return history.frame(self.history)

    def to_xarray(self) -> xarray.Dataset:
        """The history as an xarray.Dataset over the time in s, every variable with its unit. Raises HistoryError."""
        return history.dataset(self.history)

    @property
    def fields(self) -> xarray.Dataset:
        """The fields of all dumps as one dataset over time, z and r, read from the files when their values are used.

        On a mesh that follows a body, the dimension along the axis is `mesh_z`, the z of a cell in the first dump, and the
        coordinate z in the laboratory frame has the shape (time, mesh_z). See `output/datasets.py`.

        Raises ResultsError if no dump was written, VtkError if one is damaged.
        """
        from hydro2d.output import datasets

        if not self.dumps:
            raise ResultsError(f"{self.directory} has no fields: no dump was written yet")
        return datasets.of_dumps(self.dumps, self.follows)

    @property
    def dumps(self) -> list[tuple[float, Path]]:
        """Times and files of the dumps; empty if none was written."""
        series = self.directory / vtk.SERIES["dump"]
        if not series.exists():
            return []
        return [(time, within(self.directory, file)) for time, file in vtk.read_series(series)]

    def dump_file(self, time: float | None = None) -> Path:
        """The file of the dump nearest to a time in s, or of the last dump without a time. Raises ResultsError."""
        dumps = self.dumps
        if not dumps:
            raise ResultsError(f"{self.directory} has no fields: no dump was written yet")
        return dumps[-1][1] if time is None else min(dumps, key=lambda entry: abs(entry[0] - time))[1]

    def dump(self, time: float | None = None) -> vtk.Dump:
        """The fields of the dump nearest to a time in s, or of the last dump, as arrays by their names in the file."""
        return replace(vtk.read_grid(self.dump_file(time)), mirrored=mirrored(self.tables))

    def state(self) -> vtk.Dump:
        """All fields of the restart file, in full precision. Raises SnapshotError, and ModelError without trust in a model."""
        return vtk.Dump.of(self.simulation())

    def simulation(self) -> Simulation:
        """The simulation in the state of the restart file. Raises SnapshotError, and ModelError without trust in a model."""
        from hydro2d.deck import deck as decks

        saved, _ = snapshot.read_latest(self.directory)
        text = toml.dumps(key_messages.renewed(tomllib.loads(saved.deck)))
        deck = decks.loads(text, trust=self.trust)  # before the kernels are loaded: it may have outside models
        for material in deck.materials.values():
            material.from_outside()  # refuses models that are not trusted
        from hydro2d.solver.simulation import Simulation

        sim = Simulation(deck)
        with snapshot.fitting(self.directory):
            sim.load_restart_arrays(saved.arrays)
            sim.load_restart_scalars(saved.scalars)
        return sim

    def to_pyvista(self, time: float | None = None) -> pyvista.RectilinearGrid:
        """The dump nearest to a time in s, or the last dump, as a pyvista.RectilinearGrid with x = r, y = z."""
        return vtk.pyvista_grid(self.dump_file(time))

    def section(self, field: str = "pressure", mirror: str | None = None, time: float | None = None, *,
                axes: Axes | None = None, limits: dict[str, tuple[float, float]] | None = None,
                window: tuple[float, float, float] | None = None, colour_bar: bool = True) -> Axes:
        """Draws a section of the dump nearest to a time in s, or of the last dump, in matplotlib axes and returns them.

        field, mirror : fields of the upper and the lower half, such as "pressure", "velocity:z", "body_temperature:plate"
            or "material"; mirror None: the same field, the only choice for a section without a mirror image
        axes : the axes to draw in; None: a new figure
        limits : colour range (low, high) by field, in the unit of the colour bar; None: the range of the data
        window : (z0, z1, r1) in m, the part to show; None: the whole mesh
        colour_bar : whether a bar is added for each field

        Raises ResultsError if no dump was written, and FigureError.
        """
        from hydro2d.results import figures

        dump = self.dump(time)
        if axes is None:
            axes = figures.own_axes(dump, window)
        drawn = figures.section(axes, dump, field, mirror, limits, title=self.label, depth_line=self.measured_position,
                                window=window)
        if colour_bar:
            figures.colour_bars(axes, dump, drawn)
        return axes

    def view(self, beside: Results | None = None, *, fields: Sequence[str] = ("all",), bits: int = DEFAULT_BITS) -> View:
        """The page of `hydro2d view`, which a notebook shows at the end of a cell and `save` writes to a file.

        beside : another run, shown side by side with this one
        fields : the fields in the page, in addition to material and volume fractions, as `hydro2d info` names them
        bits : of each value in the page, 8, 10, 12, 14 or 16

        Raises ViewError if there are no dumps, or none has a field, FieldError, VtkError and HistoryError.
        """
        from hydro2d.results.viewer import page

        return page.view([self] if beside is None else [self, beside], fields, bits)

    @property
    def planar(self) -> bool:
        """Whether the mesh has no axis."""
        return _table(self.tables, "mesh").get("geometry") == "planar"

    @property
    def follows(self) -> bool:
        """Whether the mesh travels with a body."""
        return _table(self.tables, "mesh").get("follow", "none") != "none"

    @property
    def surface(self) -> float | None:
        """Axial position of the target's original surface, m."""
        return _number(_table(self.tables, "penetration"), "surface")

    def surface_at(self, time: float) -> float | None:
        """Axial position that this surface would have at a time if the target moved on undisturbed, m."""
        target = _table(self.tables, "penetration").get("target")
        velocity = next((body.get("velocity") for body in self.bodies if body["name"] == target), None)
        axial = velocity[-1] if isinstance(velocity, list) and velocity else velocity
        if self.surface is None or isinstance(axial, bool) or not isinstance(axial, (int, float)):
            return self.surface
        return self.surface + axial * time

    @property
    def direction(self) -> int:
        """+1 where the projectile flies along +z, -1 otherwise."""
        rod = _table(self.tables, "penetration").get("rod")
        return next((-1 for body in self.bodies if body["name"] == rod and body.get("direction") == -1), 1)

    @property
    def bodies(self) -> list[dict]:
        """The tables of all bodies of the deck that have a name."""
        entries = self.tables.get("body")
        bodies = [body for body in entries if isinstance(body, dict)] if isinstance(entries, list) else []
        return [body for body in bodies if isinstance(body.get("name"), str)]

    @property
    def stop(self) -> dict:
        """The stop conditions of the deck, without values of the wrong kind."""
        table = _table(self.tables, "stop")
        numbers = {key: _number(table, key) for key in ("time", "cycles", "speed_below")}
        others = {key: table[key] for key, kind in (("body", str), ("rebound", bool), ("perforation", bool))
                  if isinstance(table.get(key), kind)}
        return {key: number for key, number in numbers.items() if number is not None} | others

    @property
    def projectile(self) -> str:
        """Name of the body that is the projectile; "projectile" if there is none."""
        return str(_table(self.tables, "penetration").get("rod") or "projectile")

    @property
    def measured_depth(self) -> float | None:
        """Penetration depth of the experiment, m."""
        return _number(_table(self.tables, "experiment"), "penetration")

    @property
    def measured_position(self) -> float | None:
        """Axial position of the penetration depth of the experiment, m."""
        if self.measured_depth is None or self.surface is None:
            return None
        return self.surface + self.direction * self.measured_depth

    def _facts(self) -> dict[str, str]:
        """The main facts of a run, in words."""
        summary, dumps = self.summary, self.dumps
        facts = {"shot": self.tables.get("title", "")}
        facts["run"] = "has not ended"
        if summary:
            time = summary.time_s
            facts["run"] = (outcome.ended_by(summary) or "ended") + ("" if time is None else f" at {time * 1e6:.2f} µs")
            if summary.trustworthy is False:
                facts["not trustworthy"] = "; ".join(summary.faults)
        if summary.outcome and summary.outcome.perforated:
            left = summary.outcome.residual_velocity_m_s
            facts["through"] = ", ".join(summary.targets) + ("" if left is None else f", {left:.1f} m/s left")
        elif summary.penetration_depth_m is not None:
            facts["depth"] = _millimetres(summary.penetration_depth_m) + " so far" * outcome.so_far(summary)
        if summary.penetration_depth_m is not None:
            facts[self.projectile] = f"{_millimetres(summary.rod_length_m)} long, {summary.regime}"
        if self.measured_depth is not None:
            facts["experiment's depth"] = _millimetres(self.measured_depth)
        facts["dumps"] = f"{len(dumps)}, the last at {dumps[-1][0] * 1e6:.2f} µs" if dumps else "none"
        return facts

    def __repr__(self) -> str:
        facts = self._facts()
        said = [facts["run"], *(["not trustworthy"] if "not trustworthy" in facts else [])]
        said += [f"{name} {facts[name]}" for name in ("depth", "through") if name in facts]
        return f"<Results {self.label}: {', '.join(said)}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{in_html(name)}</th><td>{in_html(said)}</td></tr>"
                       for name, said in self._facts().items())
        return f"<table><caption>{in_html(self.label)}</caption>{rows}</table>"


def mirrored(deck: dict) -> bool:
    """Whether pictures of a run add the mirror image of the meshed half; deck: resolved."""
    mesh, edges = _table(deck, "mesh"), _table(deck, "boundaries")
    return halved(mesh.get("geometry", "cylindrical"), mesh.get("r_start", 0.0), str(edges.get("r_min", "wall")))


def _table(tables: dict, name: str) -> dict:
    table = tables.get(name)
    return table if isinstance(table, dict) else {}


def _number(table: dict, key: str) -> float | None:
    """A number of an unchecked table; None if it is missing, of another kind, or too large."""
    number = table.get(key)
    if not isinstance(number, (int, float)) or isinstance(number, bool):
        return None
    return number if abs(number) <= LARGEST else None


def _millimetres(length: float | None) -> str:
    return "none" if length is None else f"{length * 1e3:.1f} mm"


def _no_run(directory: Path) -> str:
    """The message for a directory without a deck: not a run, and how to read it if it is a study or holds runs."""
    said = f"{directory} is not a run directory: it has no {DECK}"
    if (directory / STUDY).is_file():
        return f"{said}; it is a study, whose runs are in {directory / 'cases'}; in Python, hydro2d.open_study reads it"
    inside = sorted(file.parent.name for file in directory.glob(f"*/{DECK}"))
    return f"{said}; it holds runs: {', '.join(inside[:5])}{', ...' if len(inside) > 5 else ''}" if inside else said
