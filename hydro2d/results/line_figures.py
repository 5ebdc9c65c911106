"""Figures of fields along a line through the mesh, at some times or over place and time, and of debris behind plates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hydro2d.base.formats import in_legend
from hydro2d.output.vtk import Dump
from hydro2d.results import figures
from hydro2d.results.scales import LINEAR, FigureError, Scale

#: number of points on a line in a diagram of place and time
POINTS = 800
#: share of the debris in a bin, or of a fragment in the debris, below which nothing is drawn
LEAST = 1e-9


class Line(NamedTuple):
    """A straight line from (r0, z0) to (r1, z1), m, in the laboratory frame."""

    r0: float
    z0: float
    r1: float
    z1: float

    @property
    def label(self) -> str:
        """The coordinate along the line: z or r if it is parallel to one, else the distance from its first point."""
        return "z" if self.r0 == self.r1 else "r" if self.z0 == self.z1 else "distance"

    def at(self, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """r, z and the coordinate along the line, m, at shares of its length."""
        r, z = self.r0 + shares * (self.r1 - self.r0), self.z0 + shares * (self.z1 - self.z0)
        along = {"z": z, "r": r}.get(self.label, shares * float(np.hypot(self.r1 - self.r0, self.z1 - self.z0)))
        return r, z, along


def axis_of(run) -> Line:
    """The line along the inner edge of the mesh, over the whole range of the dumps."""
    if not run.dumps:
        return Line(0.0, 0.0, 0.0, 1.0)
    ends = [run.dump(time) for time, _ in (run.dumps[0], run.dumps[-1])]
    inner = 0.5 * float(ends[0].r_edges[0] + ends[0].r_edges[1])
    return Line(inner, min(float(dump.z_edges[0]) for dump in ends), inner, max(float(dump.z_edges[-1]) for dump in ends))


class Curve(NamedTuple):
    """A field along a line in one dump: r, z and coordinate along the line in m, values in the reader's unit, shapes (n,)."""

    run: object
    time: float
    line: Line
    shown: figures.Shown
    r: np.ndarray
    z: np.ndarray
    along: np.ndarray
    values: np.ndarray


def _cells(dump: Dump, r: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Row and column of the cells at points, and which points are in the mesh."""
    j, i = np.searchsorted(dump.z_edges, z, "right") - 1, np.searchsorted(dump.r_edges, r, "right") - 1
    inside = (j >= 0) & (j < len(dump.z_edges) - 1) & (i >= 0) & (i < len(dump.r_edges) - 1)
    return np.where(inside, j, 0), np.where(inside, i, 0), inside


def _middles(dump: Dump, line: Line) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """r, z and coordinate along a line, m, in the middle of its part in each cell that it crosses."""
    crossings = [np.zeros(1), np.ones(1)]
    for edges, first, last in ((dump.r_edges, line.r0, line.r1), (dump.z_edges, line.z0, line.z1)):
        if first != last:
            crossings.append((edges - first) / (last - first))
    shares = np.unique(np.clip(np.concatenate(crossings), 0.0, 1.0))
    return line.at(0.5 * (shares[1:] + shares[:-1]))


def curve(run, dump: Dump, field: str, line: Line) -> Curve:
    """A field along a line, one point for each cell that the line crosses; NaN in void and beyond the mesh.

    Raises FigureError for a line that misses the mesh.
    """
    r, z, along = _middles(dump, line)
    j, i, inside = _cells(dump, r, z)
    if not inside.any():
        raise FigureError(f"the line from r = {line.r0:g} m, z = {line.z0:g} m to r = {line.r1:g} m, z = {line.z1:g} m misses "
                          "the mesh")
    shown = figures.chosen(dump, field)
    return Curve(run, dump.time, line, shown, r, z, along, np.where(inside, shown.values[j, i], np.nan))


def curves(runs: list, field: str, line: Line | None, times: Sequence[float | None]) -> Iterator[Curve]:
    """A curve for each run (results.Results) and time in s (None: the last dump); line : default: the axis of the run."""
    for run in runs:
        chosen = line or axis_of(run)
        for time in times:
            yield curve(run, run.dump(time), field, chosen)


def line_outs(runs: list, field: str, line: Line | None = None, times: Sequence[float | None] = (None,), *,
              limits: tuple[float, float] | None = None, scale: Scale = LINEAR):
    """A field along a line, a curve for each run (results.Results) and time in s (None: the last dump).

    line : default: the axis;  limits : of the values, in the reader's unit;  scale : `log` makes that axis logarithmic
    """
    figure, ((axes,),) = figures.new_figure(7.0, 4.0, 1, 1)
    for each in curves(runs, field, line, times):
        name = f"{in_legend(each.run.label)}, " if len(runs) > 1 else ""
        axes.plot(each.along * 1e3, each.values, linewidth=1.2, label=f"{name}{each.time * 1e6:.2f} µs")
        _labels(axes, f"{each.line.label} [mm]", each.shown.label)
    if scale.log:
        axes.set_yscale("log")
    if limits is not None:
        axes.set_ylim(*limits)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    return figure


def space_time(runs: list, field: str, line: Line | None = None, *, limits: tuple[float, float] | None = None,
               scale: Scale = LINEAR):
    """A field along a line at all times, in colours over place and time, one panel for each run (results.Results).

    The outlines of the bodies are lines. Raises FigureError if a run has fewer than two dumps.
    """
    panels = [_panel(run, field, line or axis_of(run)) for run in runs]
    limits = limits or scale.limits([values for _, _, values, _, _ in panels])
    figure, axes = figures.new_figure(7.0, 4.6 * len(runs), len(runs), 1)
    for (place,), run, (along, times, values, bodies, label) in zip(axes, runs, panels, strict=True):
        drawn = place.pcolormesh(along * 1e3, times * 1e6, np.ma.masked_invalid(values), shading="nearest", rasterized=True,
                                 **scale.drawn(limits))
        for fraction in bodies:
            if fraction.min() < 0.5 < fraction.max():
                place.contour(along * 1e3, times * 1e6, fraction, [0.5], colors="black", linewidths=0.6)
        place.set_title(figures.verbatim(run.label), fontsize=9)
        _labels(place, f"{(line or axis_of(run)).label} [mm]", "t [µs]")
        bar = figure.colorbar(drawn, ax=place, fraction=0.04, pad=0.01)
        bar.set_label(label, fontsize=8)
        bar.ax.tick_params(labelsize=7)
    return figure


def _panel(run, field: str, line: Line):
    """Coordinates (n,), times (k,), values (k, n) and the volume fractions of the bodies, each (k, n); and the label."""
    files = run.dumps
    if len(files) < 2:
        raise FigureError(f"{run.directory} has {len(files)} dumps; a diagram of place and time needs at least two")
    r, z, along = line.at((np.arange(POINTS) + 0.5) / POINTS)
    rows, shares, label = [], [], ""
    for time, _ in files:
        dump = run.dump(time)
        j, i, inside = _cells(dump, r, z)
        shown = figures.chosen(dump, field)
        rows.append(np.where(inside, shown.values[j, i], np.nan))
        shares.append([np.where(inside, dump.fields[f"Volume Fraction for {body}"][j, i], 0.0) for body in dump.bodies])
        label = shown.label
    if not np.isfinite(rows).any():
        raise FigureError(f"{run.directory}: no values of {field} lie on the line")
    return along, np.array([time for time, _ in files]), np.array(rows), np.array(shares).swapaxes(0, 1), label


def debris(runs: list):
    """Debris behind each target at the end: mass by axial speed, mass by angle, and number of fragments by mass.

    A row for each run (results.Results) and target. Raises ResultsError, and FigureError if there is no debris.
    """
    clouds = [(run, name, each) for run in runs for name, each in run.debris.items() if len(each["body"])]
    if not clouds:
        raise FigureError("nothing flies behind a target at the end of these runs")
    figure, axes = figures.new_figure(13.0, 3.4 * len(clouds), len(clouds), 3)
    for row, (run, name, each) in zip(axes, clouds, strict=True):
        row[1].set_title(figures.verbatim(f"{run.label}: behind {name}"), fontsize=9)
        for place, what, edges, label in ((row[0], "speed", each["speed_edges_m_s"], "axial velocity [m/s]"),
                                          (row[1], "angle", np.degrees(each["angle_edges_rad"]), "angle to the axis [°]")):
            for number, (body, mass) in enumerate(zip(each["body"], each[f"mass_by_{what}_kg"].T, strict=True)):
                place.stairs(mass * 1e3, edges, fill=True, alpha=0.7, label=in_legend(body),
                             color=figures.BODY_COLOURS[number % len(figures.BODY_COLOURS)])
            place.set_yscale("log")
            _labels(place, label, "mass in a bin [g]")
        row[1].set_xlim(0.0, _last(each["mass_by_angle_kg"], np.degrees(each["angle_edges_rad"])))
        row[0].legend(fontsize=7)
        masses = np.sort(each["fragment_mass_kg"])[::-1] * 1e3
        row[2].plot(masses, np.arange(1, len(masses) + 1), "o-", markersize=3, linewidth=1.0, color="black")
        row[2].set_xscale("log")
        _labels(row[2], "mass of a fragment [g]", "number of fragments at least as heavy")
        row[2].grid(alpha=0.3)
    return figure


def _last(mass: np.ndarray, edges: np.ndarray) -> float:
    """The upper edge of the last bin that has mass."""
    filled = np.nonzero(mass.sum(axis=1) > LEAST * mass.sum())[0]
    return float(edges[filled[-1] + 1]) if len(filled) else float(edges[-1])


def _labels(axes, x: str, y: str | None) -> None:
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.tick_params(labelsize=7)
