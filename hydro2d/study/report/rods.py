"""Pages of rods at the end of their runs, side by side at one scale, as in Figure 4 of the CTH nose-shape study."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from hydro2d.results import reading
from hydro2d.results.figures import new_figure, verbatim
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record

#: width in inches, narrow enough for a phone, and size of letters in points
WIDTH, FONT = 5.0, 10.0
#: heights in inches: of a label above a rod, and least height of a row
LABEL, LOWEST = 1.1, 2.2
COLUMNS, ROWS = 6, 3
PER_PAGE = COLUMNS * ROWS
#: rods are drawn at their depths if these span less than this many rod lengths, else tip beside tip
MOST_LENGTHS = 2.5
#: least half width of a panel over its height
SLOT = 0.1
#: letters in a line of a label, and lines
LETTERS, LINES = 12, 4
FILLED, START, OTHER = "#5b6770", "#8a8a8a", "#d55e00"


def extent(record: Record) -> tuple[float, float]:
    """Depths of the tail and the tip, m, without anything more than one rod length behind the tip."""
    points = np.concatenate(record.rod)
    tip = float(points[:, 1].max())
    return max(float(points[:, 1].min()), tip - 1.05 * record.setup.length), tip


def span(records: Sequence[Record], measurements: Mapping[str, Measurement]) -> tuple[float, float]:
    """Range of depths of all rods and their experiments, m."""
    ends = [end for record in records for end in extent(record)]
    ends += [measurements[record.case.name].depth for record in records if record.case.name in measurements]
    return min(ends), max(ends)


def at_their_depths(records: Sequence[Record], measurements: Mapping[str, Measurement]) -> bool:
    """Whether all rods can be drawn at their depths in one picture and still be visible."""
    low, high = span(records, measurements)
    return high - low <= MOST_LENGTHS * max(record.setup.length for record in records)


def pages(records: Sequence[Record]) -> list[Sequence[Record]]:
    """The records that have an outline, by the page."""
    return [records[first : first + PER_PAGE] for first in range(0, len(records), PER_PAGE)]


def draw(records: Sequence[Record], measurements: Mapping[str, Measurement], scale: Sequence[Record],
         others: Mapping[str, Sequence[Record]] = MappingProxyType({})):
    """One page of rods, each mirrored about its axis if its mesh has one; z points down, as the rods fly.

    measurements : by case; a dashed line at the depth, if rods are drawn at their depths
    scale : everything that is drawn on all pages, which share limits and scale
    others : by case, further members of its ensemble, drawn as thin outlines
    """
    rows = -(-len(records) // COLUMNS)
    columns = -(-len(records) // rows)
    at_depth = at_their_depths(scale, measurements)
    low, high = span(scale, measurements) if at_depth else (min(np.subtract(*extent(record)) for record in scale), 0.0)
    margin = 0.03 * (high - low)
    radius = max(1.1 * max(_radius(record) for record in scale), SLOT * (high - low))
    needed = WIDTH / columns * (high - low) / (2.0 * radius) + LABEL
    figure, places = new_figure(WIDTH, rows * max(min(5.0, 9.5 / rows, needed), LOWEST), rows, columns)
    for axes, record in zip(places.flat, records, strict=False):
        _rod(axes, record, 0.0 if at_depth else extent(record)[1])
        for other in others.get(record.case.name, ()):
            _outline(axes, other, 0.0 if at_depth else extent(other)[1])
        if at_depth and record.case.name in measurements:
            axes.axhline(measurements[record.case.name].depth * 100, color="black", linestyle="--", linewidth=1.2)
        axes.set_title(_label(record), fontsize=FONT - 2)
        axes.set_xlim(-radius * 100, radius * 100)
        axes.set_ylim((high + margin) * 100, (low - margin) * 100)
        _tidy(axes, first=axes in places[:, 0])
    for axes in places.flat[len(records) :]:
        axes.set_visible(False)
    figure.supylabel("depth [cm]" if at_depth else "depth relative to the tip [cm]", fontsize=FONT)
    return figure


def _tidy(axes, *, first: bool) -> None:
    """Equal scales, a light grid, numbers in the first column only."""
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.grid(axis="y", alpha=0.3)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=FONT - 1, labelleft=first, left=first)
    for side in ("top", "right", "bottom", *(() if first else ("left",))):
        axes.spines[side].set_visible(False)


def _radius(record: Record) -> float:
    """Largest distance from r = 0 of the drawn part of the rod, m."""
    points = np.concatenate(record.rod)
    return float(np.abs(points[points[:, 1] >= extent(record)[0], 0]).max())


def _label(record: Record) -> str:
    """The axes' values or the name, the depth, and whether the run is unfinished."""
    words = list(record.case.values.values()) or [record.case.name]
    lines = [line for word in words for line in textwrap.wrap(word.replace("_", " "), LETTERS)]
    if len(lines) > LINES:
        lines = [*lines[: LINES - 1], "…"]
    if record.perforated:
        lines.append("perforated")
    elif record.outcome.depth_m is not None:
        lines.append(f"{'≥ ' * record.left}{record.outcome.depth_m * 100:.1f} cm")
    return "\n".join([*map(verbatim, lines)] + (["(unfinished)"] if record.unfinished else []))


def _rod(axes, record: Record, shift: float) -> None:
    """The rod at the end, and the initial rod as a thin line with its tip at the same place."""
    from matplotlib.patches import PathPatch

    mirrored = reading.mirrored(record.deck)
    if record.start:
        tip = max(line[:, 1].max() for line in record.start)
        moved = [line - [0.0, tip - extent(record)[1]] for line in record.start]
        axes.add_patch(PathPatch(_path(moved, shift, mirrored), fill=False, edgecolor=START, linewidth=0.7, linestyle=":"))
    axes.add_patch(PathPatch(_path(record.rod, shift, mirrored), facecolor=FILLED, edgecolor="black", linewidth=0.5))


def _outline(axes, record: Record, shift: float) -> None:
    """Another member of an ensemble at the end, as a thin line."""
    from matplotlib.patches import PathPatch

    path = _path(record.rod, shift, reading.mirrored(record.deck))
    axes.add_patch(PathPatch(path, fill=False, edgecolor=OTHER, linewidth=0.6, alpha=0.7))


def _path(lines: Sequence[np.ndarray], shift: float, mirrored: bool = True):
    """Outlines, and if wanted their mirror images, as one path in cm: lines that end on the axis are joined to their images."""
    from matplotlib.path import Path

    parts = []
    for line in lines:
        points = (line - [0.0, shift]) * 100.0
        image = points[::-1] * [-1.0, 1.0]
        if np.array_equal(line[0], line[-1]):
            parts += [points, image] if mirrored else [points]
        else:
            parts.append(np.concatenate([points, image, points[:1]] if mirrored else [points, points[:1]]))
    return Path.make_compound_path(*(Path(part, closed=True) for part in parts))
