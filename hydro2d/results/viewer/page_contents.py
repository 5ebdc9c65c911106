"""The contents of a page: mesh, dumps, field ranges, history and stations of a run, as a table for JSON and packed numbers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict

import numpy as np

from hydro2d.base.formats import shown
from hydro2d.base.units import reader_unit
from hydro2d.measure import outcome
from hydro2d.measure.regime import REGIMES
from hydro2d.output import history, station_arrays
from hydro2d.output.directory import HISTORY
from hydro2d.output.outlines import Filling
from hydro2d.output.vtk import Dump, read_grid
from hydro2d.results.viewer import packing
from hydro2d.results.viewer.field_arrays import Ranges, Stored, ViewError, arrays, asked, short

#: fields that every page has, to show the bodies
SHARES = ("volume_fraction", "material")
#: largest number of rows of the history in a page
ROWS = 4000
#: largest distance of the edges of a dump's mesh from those of the first dump, moved along, as a share of the mesh
ROUNDING = 1e-9


def contents(run, words: Iterable[str], bits: int) -> tuple[dict, str]:
    """The table of a run (results.Results) and its packed numbers in base64.

    words : fields, as `field_arrays.asked` takes them
    bits : bits of a value, one of packing.BITS

    Raises ViewError, FieldError, VtkError, HistoryError.
    """
    files = run.dumps
    if not files:
        raise ViewError(f"{run.directory} has no dumps to show; output.vtk_interval of the deck sets when they are written")
    ends = [read_grid(path) for _, path in (files[0], files[-1])]
    stored = arrays(asked([*words, *SHARES], ends, run), ends)
    store, frames = packing.Store(), _Frames(stored, bits, run.projectile)
    for time, path in files:
        frames.add(time, read_grid(path), store)
    state = run.dump(files[-1][0])
    table = {
        "label": shown(run.label),
        "title": shown(run.tables.get("title", "")),
        "ended": shown(outcome.ended_by(run.summary) or "") if run.summary else None,
        "mirrored": state.mirrored,
        "bodies": [shown(body) for body in state.bodies],
        "measured": {"z": run.measured_position, "depth": run.measured_depth},
        **frames.table(),
        **_history(run, store),
    }
    return table, store.text


class _Frames:
    """The dumps of a run, packed one after the other."""

    def __init__(self, stored: list[Stored], bits: int, projectile: str):
        self.stored, self.bits, self.projectile = stored, bits, projectile
        self.ranges = {each.word: Ranges() for each in _shown(stored)}
        self.times: list[float] = []
        self.shifts: list[float] = []
        self.pieces: list[list] = []
        self.thin: list[list] = []
        self.boxes: list[list[float] | None] = []
        self.first: Dump | None = None

    def add(self, time: float, dump: Dump, store: packing.Store) -> None:
        """Packs the fields of a dump. Raises ViewError if it has another mesh than the first."""
        self.first = self.first or dump
        shift = dump.z_edges[0] - self.first.z_edges[0]
        if not (_same(dump.r_edges, self.first.r_edges) and _same(dump.z_edges - shift, self.first.z_edges)):
            raise ViewError("the dumps have different meshes: the run was started anew while it was read; read it again")
        self.times.append(time)
        self.shifts.append(shift)
        values = {each.word: each.values(dump) for each in self.stored}
        self.pieces.append([_piece(values[each.word], each, self.bits, store) for each in self.stored])
        fillings = {body: dump.filling(body) for body in (None, *dump.bodies)}
        self.thin.append([_thin(fillings[body], shift) for body in dump.bodies])
        self.boxes.append(_box(fillings[self.projectile], dump, shift) if self.projectile in fillings else None)
        for each in _shown(self.stored):
            field = _magnitude(values, each) if each.is_magnitude else values[each.word]
            if field is not None:
                self.ranges[each.word].add(field, fillings[each.body or None].shown | each.is_share)

    def table(self) -> dict:
        """Times in s, displacements of the mesh and its first edges in m, fields, and the pieces of each dump."""
        assert self.first is not None
        return {
            "times": self.times, "shifts": self.shifts, "r_edges": self.first.r_edges.tolist(),
            "z_edges": self.first.z_edges.tolist(), "bits": self.bits,
            "stored": [shown(each.word) for each in self.stored], "pieces": self.pieces, "thin": self.thin, "boxes": self.boxes,
            "fields": [_described(each, self.ranges[each.word]) for each in _shown(self.stored)],
        }


def _same(edges: np.ndarray, others: np.ndarray) -> bool:
    return edges.shape == others.shape and np.allclose(edges, others, rtol=0.0, atol=ROUNDING * np.ptp(others))


def _shown(stored: list[Stored]) -> list[Stored]:
    """The fields that can be drawn: the stored ones, with the magnitude of a vector before its components."""
    drawn = []
    for each in stored:
        if each.component == 0:
            drawn.append(each.magnitude())
        drawn.append(each)
    return drawn


def _magnitude(values: dict, each: Stored) -> np.ndarray | None:
    """Magnitude of a vector whose components were packed."""
    parts = [values[word] for word in each.parts]
    return None if parts[0] is None else np.hypot(*parts)


def _box(filling: Filling, dump: Dump, shift: float) -> list[float] | None:
    """Lowest and highest z and r of the cells in which a body is shown, m; z for the mesh in its place at the first dump."""
    rows, columns = filling.shown.any(axis=1).nonzero()[0], filling.shown.any(axis=0).nonzero()[0]
    if not len(rows):
        return None
    ends = [*(dump.z_edges[[rows[0], rows[-1] + 1]] - shift), *dump.r_edges[[columns[0], columns[-1] + 1]]]
    return [short(float(end)) for end in ends]


def _thin(filling: Filling, shift: float) -> list[list]:
    """Cells, counted row by row, in which a body is narrower than a cell, and the ends r, z, r, z of the lines around it, m.

    shift : displacement of the mesh, m; z is for the mesh in its place at the first dump
    """
    lines = [line - (0.0, shift) for line in filling.around_thin]
    ends = [number for line in lines for pair in zip(line[:-1], line[1:], strict=True) for number in np.ravel(pair).tolist()]
    return [np.flatnonzero(filling.thin).tolist(), [short(number) for number in ends]]


def _piece(values: np.ndarray | None, each: Stored, bits: int, store: packing.Store) -> list | None:
    """[low, high], and the place of the levels in the store if the values differ; None for a field that a dump lacks."""
    if values is None:
        return None
    finite = values[np.isfinite(values)]
    low, high = (short(float(end)) for end in ((finite.min(), finite.max()) if finite.size else (0.0, 0.0)))
    if each.is_share:
        low, high = 0.0, 1.0
    if each.word == "material":
        low, high = 0.0, float(packing.last_level(bits))  # each number is a level
    if low == high and finite.size == values.size:
        return [low, high]
    high = high if high > low else low + 1.0
    return [low, high, *store.add(packing.packed(packing.levels_of(values, low, high, bits)))]


def _described(each: Stored, ranges: Ranges) -> dict:
    """The description of a field in the page, and its colour ranges for each of fields.CLIPS."""
    known = asdict(each)
    said = {key: shown(known[key]) for key in ("word", "title", "unit", "body")}
    return said | {"ranges": ranges.clipped(), "parts": each.parts}


def _history(run, store: packing.Store) -> dict:
    """Columns of the history, each as numbers of 32 bits, and its times as numbers of 64; stations by kind and name."""
    columns = run.history if (run.directory / HISTORY).exists() else {}
    if not len(columns.get("time", ())):
        return {"history": None, "stations": []}
    step = -(-len(columns["time"]) // ROWS)
    rows = np.unique(np.append(np.arange(0, len(columns["time"]), step), len(columns["time"]) - 1))
    stations = [{"kind": kind, "name": shown(name), "r": f"{kind}_{name}_r_m", "z": f"{kind}_{name}_z_m"}
                for kind in station_arrays.KINDS for name in station_arrays.stations(columns, kind)]
    kept = [_column(name, column[rows], store) for name, column in columns.items() if name != "time"]
    table = {"rows": len(rows), "step": step, "time": store.add(packing.packed_column(columns["time"][rows], "<f8")),
             "columns": kept, "regimes": list(REGIMES)}
    return {"history": table, "stations": stations}


def _column(name: str, values: np.ndarray, store: packing.Store) -> dict:
    unit, scale = reader_unit(history.unit(name))
    return {"name": name, "label": shown(history.spoken(name)), "unit": "" if unit == "1" else unit,
            "piece": store.add(packing.packed_column(values * scale, "<f4"))}
