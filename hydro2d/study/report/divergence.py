"""`hydro2d diverge`: where and when two runs of nearly the same deck diverge, and how fast their difference grows.

The difference of a column of the history is its absolute value; that of a field is the largest over all cells that are at
least half filled. Each is divided by the largest magnitude that the quantity has in either run. Columns of the second run are
interpolated to the times of the first. Fields are compared cell by cell, in dumps of nearly the same time, while the meshes
lie within a tenth of a cell of each other. The effect of the small difference of the times alone is estimated from the change
since the dump before, and reported.

A difference that grows by chance grows like exp(t / T): T, the growth time, is the time in which it becomes e times as large.
It is fitted to the largest difference so far, from a thousandth of the stated size up to that size. Source of the measure:
Benettin, Galgani, Giorgilli and Strelcyn, Lyapunov characteristic exponents for smooth dynamical systems, Meccanica 15 (1980)
9.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hydro2d.analytic.model_text import columns
from hydro2d.base.errors import unknown
from hydro2d.base.formats import in_legend
from hydro2d.files.whole import write_text
from hydro2d.materials import quantities
from hydro2d.output import vtk
from hydro2d.results.reading import Results, ResultsError
from hydro2d.study.records import differences
from hydro2d.study.records.table import to_csv

if TYPE_CHECKING:
    import pandas

#: columns of the history that are compared: of a projectile; without one, those of every body
COLUMNS = ("penetration_depth_m", "rod_length_m", "rod_tail_velocity_m_s")
OF_BODY = ("velocity_m_s", "kinetic_energy_J")
#: fields that are compared if the dumps have them
FIELDS = ("velocity", "pressure", "density", "plastic_strain")
#: largest distance of two meshes, in cells; largest difference of the times of two dumps, relative to their interval
APART, SAME_TIME = 0.1, 0.05
#: part of the stated size from which a growth is fitted
FROM = 1e-3
#: fewest points of a fit, and the smallest growth, in powers of e, that counts as one
FEWEST, GROWTH = 4, 2.0
#: smallest share of the scatter of the logarithm that a straight line must explain
STRAIGHT = 0.9


class Place(NamedTuple):
    """A cell: row and column from 0, its centre in m in the first run, and the body that fills most of it."""

    row: int
    column: int
    z: float
    r: float
    body: str


@dataclass(frozen=True)
class Curve:
    """The difference of one quantity against time.

    name : of the column or field;  kind : "history" or "field";  scale : its largest magnitude, SI
    time : s, shape (n,);  difference : relative to the scale, shape (n,)
    places : for a field, the cell with the largest difference at each time
    by_time : largest effect of the difference of the times of the dumps alone, relative to the scale
    """

    name: str
    kind: str
    scale: float
    time: np.ndarray
    difference: np.ndarray
    places: tuple[Place, ...] = ()
    by_time: float = 0.0

    def first_beyond(self, size: float) -> int | None:
        """Number of the first time at which the difference exceeds a size; None if it never does."""
        (beyond,) = np.nonzero(self.difference > size)
        return int(beyond[0]) if len(beyond) else None

    def growth(self, size: float) -> Growth | None:
        """The growth from a thousandth of a size up to it; None if the difference does not grow so, or comes from the times."""
        largest = np.maximum.accumulate(self.difference)
        kept = (largest >= max(FROM * size, self.by_time)) & (largest <= size)
        if kept.sum() < FEWEST or math.log(largest[kept][-1] / largest[kept][0]) < GROWTH:
            return None
        time, log = self.time[kept], np.log(largest[kept])
        slope, offset = np.polyfit(time, log, 1)
        if np.corrcoef(time, log)[0, 1] ** 2 < STRAIGHT:
            return None
        spread = math.sqrt(np.sum((log - offset - slope * time) ** 2) / (len(time) - 2) / np.sum((time - time.mean()) ** 2))
        return Growth(float(1.0 / slope), float(spread / slope**2), float(time[0]), float(time[-1]), float(offset))


class Growth(NamedTuple):
    """A growth time and its standard error, the times between which it was fitted, all in s; log of the difference at t = 0."""

    time: float
    error: float
    begin: float
    end: float
    offset: float


@dataclass(frozen=True)
class Divergence:
    """Two runs, the keys in which their decks differ, and the curves of all quantities; notes : on quantities not compared."""

    runs: tuple[Results, Results]
    keys: dict[str, tuple[str, str]]
    curves: tuple[Curve, ...]
    notes: tuple[str, ...]

    def lines(self, size: float) -> list[str]:
        """The results as lines of text."""
        one, other = (run.label for run in self.runs)
        text = [f"{one} and {other}", ""]
        text += [f"  {key}: {values[0]} and {values[1]}" for key, values in self.keys.items()] or ["  their decks are the same"]
        rows = [("quantity", "difference at the end", f"beyond {size:g} of its largest", "growth time"),
                *(self._row(curve, size) for curve in self.curves)]
        text += ["", *columns(rows)]
        first = self.first(size)
        text += ["", f"  {first}" if first else f"  no field differs by more than {size:g} of its largest value"]
        by_time = [f"{curve.by_time:.2g} of {curve.name}" for curve in self.curves if curve.by_time > 0.1 * size]
        text += [f"  the times of the dumps differ, which alone makes up to {', '.join(by_time)}"] if by_time else []
        return [*text, *(f"  {note}" for note in self.notes)]

    def _row(self, curve: Curve, size: float) -> tuple[str, str, str, str]:
        number, grown = curve.first_beyond(size), curve.growth(size)
        when = "never" if number is None else f"at {curve.time[number] * 1e6:.4g} us"
        rate = "no exponential growth" if grown is None else f"{grown.time * 1e6:.3g} +- {grown.error * 1e6:.1g} us"
        return curve.name, f"{curve.difference[-1]:.2g}", when, rate

    def first(self, size: float) -> str:
        """The time and the cell at which a field first differs by more than a size, in words; empty if none does."""
        of_fields = [(curve, curve.first_beyond(size)) for curve in self.curves if curve.places]
        beyond = [(curve.time[number], curve, number) for curve, number in of_fields if number is not None]
        if not beyond:
            return ""
        time, curve, number = min(beyond, key=lambda entry: (entry[0], -entry[1].difference[entry[2]]))
        place = curve.places[number]
        before = f", not yet in the dump of {curve.time[number - 1] * 1e6:.4g} us" if number else ""
        return (
            f"the fields first differ by more than {size:g} in the dump of {time * 1e6:.4g} us{before}: {curve.name}, "
            f"in {place.body} at z = {place.z * 1e3:.4g} mm, r = {place.r * 1e3:.4g} mm (cell {place.row}, {place.column})"
        )

    def table(self) -> pandas.DataFrame:
        """A row for each quantity and time, for a CSV."""
        import pandas

        parts = [pandas.DataFrame({"quantity": each.name, "kind": each.kind, "time_s": each.time,
                                   "relative_difference": each.difference})
                 .join(pandas.DataFrame(each.places, columns=Place._fields).add_prefix("cell_").astype(object))
                 for each in self.curves]
        return pandas.concat(parts, ignore_index=True)


def write_csv(divergence: Divergence, path: Path) -> None:
    """Writes the table. Raises OSError."""
    write_text(path, to_csv(divergence.table()))


def compare(one: Results, other: Results, fields: Sequence[str] = ()) -> Divergence:
    """Compares two runs; fields : keys of the table of quantities, default FIELDS.

    Raises ResultsError for runs that cannot be compared, HistoryError, VtkError.
    """
    if one.directory.resolve() == other.directory.resolve():
        raise ResultsError(f"{one.directory}: give two runs; this one was given twice")
    for name in fields:
        if name not in quantities.BY_KEY:
            raise ResultsError(f"--field: {unknown('field', name, quantities.BY_KEY)}")
    compared = differences.compare({"one": one.tables, "other": other.tables}, exact=True)
    keys = {key: _both(users) for key, users in compared.varying.items()}
    if alone := [key for key, values in keys.items() if key.startswith("body.") and "not there" in values]:
        raise ResultsError(f"{one.directory} and {other.directory} are not of one shot: only one has {', '.join(alone)}")
    of_history = list(_histories(one, other))
    of_fields, notes = _fields(one, other, fields or FIELDS)
    if missing := _missing(one, fields):
        raise ResultsError(f"the dumps have no {', '.join(missing)}; {quantities.not_written(*missing)}")
    return Divergence((one, other), keys, (*of_history, *of_fields), tuple(notes))


def _missing(run: Results, fields: Sequence[str]) -> list[str]:
    """Those of these fields that the dumps of a run do not have."""
    if not fields or not run.dumps:
        return []
    dump = vtk.read_grid(run.dumps[-1][1])
    return [key for key in fields if not any(name in dump.fields for name in _names(key, dump))]


def _both(users: dict[str, tuple[str, ...]]) -> tuple[str, str]:
    """The values of a key in the two decks."""
    value = {name: value for value, names in users.items() for name in names}
    return value["one"], value["other"]


def _histories(one: Results, other: Results) -> Iterator[Curve]:
    """The curves of the histories."""
    first, second = one.history, other.history
    names = [name for name in COLUMNS if name in first] or [
        f"body_{body['name']}_{name}" for body in one.tables["body"] for name in OF_BODY]
    time = first["time"][first["time"] <= second["time"][-1]]
    if len(time) < 2:
        raise ResultsError(f"{one.directory} and {other.directory} have no common times in their histories")
    for name in names:
        if name not in second or name not in first:
            continue
        values = first[name][: len(time)].astype(float)
        difference = np.abs(values - np.interp(time, second["time"], second[name]))
        known = np.isfinite(difference)
        scale = float(max(np.nanmax(np.abs(first[name]), initial=0.0), np.nanmax(np.abs(second[name]), initial=0.0)))
        if scale > 0.0 and known.any():
            yield Curve(name, "history", scale, time[known], difference[known] / scale)


def _fields(one: Results, other: Results, fields: Sequence[str]) -> tuple[list[Curve], list[str]]:
    """The curves of the fields, and notes on what was not compared."""
    second = list(other.dumps)
    rows: dict[str, list[tuple[float, float, Place, float]]] = {}
    scales: dict[str, float] = {}
    before: vtk.Dump | None = None
    for time, file, near in _pairs(one.dumps, second):
        a, b = vtk.read_grid(file), vtk.read_grid(near)
        why = _meshes_apart(a, b)
        if why and not rows:
            return [], [f"the fields are not compared: {why}"]
        if why:
            return _curves(rows, scales), [f"the fields are compared before {time * 1e6:.4g} us: {why}"]
        for name in [name for key in fields for name in _names(key, a) if name in a.fields and name in b.fields]:
            largest, place = _largest_difference(a, b, name)
            rows.setdefault(name, []).append((time, largest, place, _by_time(a, b, before, name)))
            scales[name] = max(scales.get(name, 0.0), *(float(np.abs(each.fields[name]).max()) for each in (a, b)))
        before = a
    if not rows:
        why = "no dumps were written" if not one.dumps or not second else "no dumps of the same time have these fields"
        return [], [f"the fields are not compared: {why}"]
    return _curves(rows, scales), []


def _pairs(first: Sequence[tuple[float, Path]], second: Sequence[tuple[float, Path]]) -> Iterator[tuple[float, Path, Path]]:
    """Time and file of every dump of the first run with one of nearly the same time in the second, and that one's file."""
    interval = min((later - time for (time, _), (later, _) in pairwise(first)), default=0.0)
    for time, file in first:
        when, near = min(second, key=lambda entry: abs(entry[0] - time), default=(math.inf, file))
        if abs(when - time) <= SAME_TIME * interval:
            yield time, file, near


def _by_time(a: vtk.Dump, b: vtk.Dump, before: vtk.Dump | None, name: str) -> float:
    """The change of a field in the difference of two times, from its change since the dump before."""
    if before is None or before.shape != a.shape or name not in before.fields:
        return 0.0
    change = float(np.nanmax(np.abs(a.fields[name].astype(float) - before.fields[name].astype(float))))
    return change * abs(b.time - a.time) / (a.time - before.time)


def _names(key: str, dump: vtk.Dump) -> list[str]:
    quantity = quantities.BY_KEY[key]
    return [quantity.name(body) for body in dump.bodies] if quantity.per_body else [quantity.name()]


def _curves(rows: dict[str, list[tuple[float, float, Place, float]]], scales: dict[str, float]) -> list[Curve]:
    curves = []
    for name, entries in rows.items():
        if scales[name] > 0.0:
            time, difference, places, by_time = zip(*entries, strict=True)
            shown, scale = name.partition(" [")[0].lower(), scales[name]
            curves.append(Curve(shown, "field", scale, np.array(time), np.array(difference) / scale, places,
                                max(by_time) / scale))
    return curves


def _meshes_apart(a: vtk.Dump, b: vtk.Dump) -> str:
    """Why two dumps cannot be compared cell by cell; empty if they can."""
    if a.shape != b.shape:
        return f"one mesh has {a.shape[0]} x {a.shape[1]} cells, the other {b.shape[0]} x {b.shape[1]}"
    if a.bodies != b.bodies:
        return "the runs have other bodies"
    for mine, theirs in ((a.z_edges, b.z_edges), (a.r_edges, b.r_edges)):
        cells = np.abs(mine - theirs).max() / np.diff(mine).min()
        if cells > APART:
            return f"the meshes are {cells:.2g} cells apart"
    return ""


def _largest_difference(dump: vtk.Dump, other: vtk.Dump, name: str) -> tuple[float, Place]:
    """The largest difference of a field in cells that are half filled in both dumps, and its cell; a vector's magnitude."""
    difference = np.nan_to_num(np.abs(dump.fields[name].astype(float) - other.fields[name].astype(float)))
    if difference.ndim == 3:
        difference = np.sqrt((difference**2).sum(axis=-1))
    difference[(dump.filling().fraction < 0.5) | (other.filling().fraction < 0.5)] = 0.0
    j, i = (int(n) for n in np.unravel_index(np.argmax(difference), difference.shape))
    share = quantities.BY_KEY["volume_fraction"]
    body = max(dump.bodies, key=lambda name: dump.fields[share.name(name)][j, i])
    return float(difference[j, i]), Place(j, i, float(dump.z_centres[j]), float(dump.r_centres[i]), body)


def figure(divergence: Divergence, size: float):
    """The differences against time on a logarithmic scale: histories to the left, fields to the right, with fitted growth."""
    from hydro2d.results import figures

    drawn, (axes,) = figures.new_figure(10.5, 4.2, 1, 2)
    for place, kind in zip(axes, ("history", "field"), strict=True):
        for number, curve in enumerate(curve for curve in divergence.curves if curve.kind == kind):
            _draw(place, curve, size, f"C{number}", in_legend(curve.name))
        place.axhline(size, color="black", linestyle=":", linewidth=1.0, label=f"{size:g} of the largest value")
        place.set_yscale("log")
        place.set_xlabel("t [us]", fontsize=8)
        place.set_title({"history": "histories", "field": "fields, largest over the cells"}[kind], fontsize=8)
        place.tick_params(labelsize=7)
        place.grid(alpha=0.3)
        place.legend(fontsize=6, loc="best")
    axes[0].set_ylabel("difference / largest value", fontsize=8)
    return drawn


def _draw(axes, curve: Curve, size: float, colour: str, label: str) -> None:
    """One curve and, dashed, its fitted growth."""
    grown = curve.growth(size)
    said = label if grown is None else f"{label}: e times in {grown.time * 1e6:.3g} us"
    kept = curve.difference > 0.0
    axes.plot(curve.time[kept] * 1e6, curve.difference[kept], color=colour, linewidth=1.1, label=said,
              marker="." if curve.kind == "field" else "", markersize=4)
    if grown is not None:
        time = np.array([grown.begin, grown.end])
        axes.plot(time * 1e6, np.exp(grown.offset + time / grown.time), color=colour, linestyle="--", linewidth=0.9)
