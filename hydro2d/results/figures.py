"""Figures of runs: mirrored sections, histories and craters with matplotlib.

Sections show z to the right and r upwards, mirrored at the axis or plane of symmetry; the lower half may show another field.
A planar mesh without a plane of symmetry at r = 0 is drawn as it is. Runs are arranged in rows and times in columns, with one
colour scale.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hydro2d.base.errors import unknown
from hydro2d.base.formats import in_figure, in_legend
from hydro2d.base.units import reader_unit
from hydro2d.files.whole import replacing
from hydro2d.materials import quantities
from hydro2d.output import history
from hydro2d.output.outlines import Filling
from hydro2d.output.vtk import Dump
from hydro2d.results.scales import LINEAR, FigureError, Scale

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BODY_COLOURS = ("#5b6770", "#c9a66b", "#7aa6c2", "#a3b18a", "#b57ba6", "#d08c60", "#8d99ae", "#c05a5a")
#: colour of void within the mesh, which no colour map of a field has; the viewer has the same on white
VOID = "#d9dde3"
HISTORIES = ("penetration_depth_m", "rod_tail_velocity_m_s", "rod_length_m", "rod_max_plastic_strain")
COMPONENTS = {"r": 0, "z": 1}
VECTORS = ("velocity", "velocity_hard", "velocity_soft")
#: file endings of films
FILMS = ("gif", "mp4", "avi", "mov", "webm")
#: largest height and smallest width of a panel, inches
TALLEST, NARROWEST = 9.0, 2.5


@dataclass(frozen=True)
class Shown:
    """A field ready to draw: values (nz, nr) in the reader's unit (NaN in void), title, that unit, and colour map."""

    values: np.ndarray
    title: str
    unit: str
    colours: str

    @property
    def label(self) -> str:
        """Title and unit as matplotlib draws them."""
        return verbatim(self.title) + (f" [{self.unit}]" if self.unit else "")


def chosen(dump: Dump, field: str) -> Shown:
    """The field that a word names: a key of quantities.TABLE, followed by ":r" or ":z" for a component or ":body" for a body.

    Raises FigureError.
    """
    key, _, part = field.partition(":")
    if key not in quantities.BY_KEY:
        raise FigureError(unknown("field", key, quantities.BY_KEY))
    quantity = quantities.BY_KEY[key]
    if quantity.per_body and part not in dump.bodies:
        raise FigureError(f'field "{key}" belongs to each body: write {key}:NAME; {unknown("body", part, dump.bodies)}')
    if not quantity.per_body and part and (key not in VECTORS or part not in COMPONENTS):
        raise FigureError(f'field "{field}": only {", ".join(VECTORS)} have components, such as velocity:r and velocity:z')
    stored = dump.values(key, part)
    if stored is None:
        raise FigureError(f'the file has no "{quantity.name(part)}"; {quantities.not_written(key)}')
    values = stored.astype(float)
    if values.ndim == 3:
        values = values[..., COMPONENTS[part]] if part else np.linalg.norm(values, axis=-1)
    unit, scale = reader_unit(quantity.unit)
    title = quantity.title.format(body=part) if quantity.per_body else quantity.title + (f" {part}" if part else "")
    solid = dump.filling(part if quantity.per_body else None).shown
    values = np.where(solid | (key == "volume_fraction"), values * scale, np.nan)
    diverging = np.min(values, where=np.isfinite(values), initial=0.0) < 0
    return Shown(values, title, unit, "RdBu_r" if diverging else "viridis")


#: a name from a file as matplotlib draws it
verbatim = in_figure


def body_colours(count: int):
    """The colours of the bodies as a colour map."""
    from matplotlib.colors import ListedColormap

    return ListedColormap([BODY_COLOURS[m % len(BODY_COLOURS)] for m in range(count)])


def _draw_half(axes, dump: Dump, field: str, sign: int, limits: tuple[float, float], scale: Scale):
    """Draws the colours of one half, in mm, up to the outlines; sign is +1 above the axis, -1 below. Returns the mappable
    for a colour bar."""
    z, r = dump.z_edges * 1e3, sign * dump.r_edges * 1e3
    if field == "material":
        values, drawn = dump.fields["Material"].astype(float), {"cmap": body_colours(len(dump.bodies))}
        values[values == 0.0] = np.nan
        drawn |= {"vmin": 0.5, "vmax": len(dump.bodies) + 0.5}
    else:
        values, drawn = chosen(dump, field).values, scale.drawn(limits)
    within = _solid(dump, field)
    if within is None:
        return axes.pcolormesh(z, r, np.ma.masked_invalid(values).T, rasterized=True, **drawn)
    image = axes.pcolormesh(z, r, np.ma.masked_invalid(_widened(values)).T, rasterized=True, **drawn)
    image.set_clip_path(_path(within, sign), axes.transData)
    if field != "material":
        return image
    for m, body in enumerate(dump.bodies):
        _fill(axes, _path(dump.filling(body), sign), BODY_COLOURS[m % len(BODY_COLOURS)])
    return None


def _solid(dump: Dump, field: str) -> Filling | None:
    """The filling whose outline bounds a drawn field: that of its body, or of all; None for a volume fraction."""
    key, _, part = field.partition(":")
    if key == "volume_fraction":
        return None
    return dump.filling(part if part in dump.bodies else None)


def _widened(values: np.ndarray) -> np.ndarray:
    """Values (nz, nr) extended by one row of cells around those that are not NaN, each the mean of its neighbours."""
    around = np.pad(values, 1, constant_values=np.nan)
    shifted = np.stack([around[1 + dj : around.shape[0] - 1 + dj, 1 + di : around.shape[1] - 1 + di]
                        for dj in (-1, 0, 1) for di in (-1, 0, 1)])
    known = np.isfinite(shifted)
    mean = np.sum(shifted, axis=0, where=known) / np.maximum(known.sum(axis=0), 1)
    return np.where(np.isfinite(values), values, np.where(known.any(axis=0), mean, np.nan))


def _path(filling: Filling, sign: int):
    """The areas of `Filling.regions` as a path in mm of z and r."""
    from matplotlib.path import Path as Outline

    regions = filling.regions()
    if not regions:
        return Outline(np.zeros((1, 2)))
    points = np.concatenate([np.column_stack([each[:, 1], sign * each[:, 0]]) for each, _ in regions]) * 1e3
    return Outline(points, np.concatenate([codes for _, codes in regions]))


def _fill(axes, path, colour: str) -> None:
    from matplotlib.patches import PathPatch

    axes.add_patch(PathPatch(path, facecolor=colour, linewidth=0.0))


def _draw_void(axes, dump: Dump) -> None:
    """Fills the mesh with the colour of void, below all else."""
    from matplotlib.patches import Rectangle

    z, r = (1e3 * edges for edges in (dump.z_edges, dump.r_edges))
    low = -r[-1] if dump.mirrored else r[0]
    axes.add_patch(Rectangle((z[0], low), z[-1] - z[0], r[-1] - low, facecolor=VOID, linewidth=0.0, zorder=0))


def _draw_outlines(axes, dump: Dump) -> None:
    from matplotlib.collections import LineCollection

    lines = [
        np.column_stack([line[:, 1], sign * line[:, 0]]) * 1e3
        for body in dump.bodies
        for line in dump.outlines(body)
        for sign in ((1, -1) if dump.mirrored else (1,))
    ]
    axes.add_collection(LineCollection(lines, colors="black", linewidths=0.6))


def _legend(axes, dump: Dump, half: str) -> None:
    """Adds the names of the bodies; half : the half of the section that shows them ("upper" or "lower"), "" for all of it."""
    from matplotlib.patches import Patch

    patches = [Patch(color=BODY_COLOURS[m % len(BODY_COLOURS)], label=in_legend(body)) for m, body in enumerate(dump.bodies)]
    axes.legend(handles=patches, fontsize=7, loc=f"{half or 'upper'} right", framealpha=0.7,
                title=_of_half(half), title_fontsize=7)


def section(axes, dump: Dump, field: str = "pressure", mirror: str | None = None, limits=None, *, title: str = "",
            depth_line: float | None = None, window: tuple[float, float, float] | None = None,
            scale: Scale = LINEAR) -> list:
    """Draws one section into matplotlib axes, mirrored at the axis or plane of symmetry if there is one.

    field, mirror : words for the upper and the lower half, see `chosen` (mirror None: the same field)
    limits : (low, high) per word in the reader's unit; by default from the data
    depth_line : axial position of the experiment's depth, m
    window : (z0, z1, r1) in m, the part that is shown and sets the limits; by default the whole mesh
    scale : of the colours

    Returns [(word, mappable)] for `colour_bars`. Raises FigureError.
    """
    if mirror is not None and not dump.mirrored:
        raise FigureError(f'mirror = "{mirror}": a planar mesh without a plane of symmetry at r = 0 has no second half to show')
    limits, drawn, seen = limits or {}, [], cropped(dump, window)
    _draw_void(axes, dump)
    for word, sign in ((field, 1), (mirror or field, -1)) if dump.mirrored else ((field, 1),):
        if word != "material" and word not in limits:
            limits = {**limits, word: scale.limits([chosen(seen, word).values])}
        drawn.append((word, _draw_half(axes, dump, word, sign, limits.get(word), scale)))
    _draw_outlines(axes, dump)
    halves = _halves(drawn)
    if "material" in halves:
        _legend(axes, dump, halves["material"])
    if depth_line is not None:
        below = "material" in halves and halves["material"] != "lower"  # the half that no legend covers
        axes.axvline(depth_line * 1e3, color="crimson", linestyle="--", linewidth=1.0)
        word = axes.text(depth_line * 1e3, 0.02 if below else 0.98, "experiment", transform=axes.get_xaxis_transform(),
                         color="crimson", fontsize=7, rotation=90, ha="right", va="bottom" if below else "top",
                         clip_on=True, bbox={"facecolor": "white", "alpha": 0.8, "linewidth": 0.0, "pad": 1.0})
        word.set_in_layout(False)  # a line outside the window must not stretch the figure
    if dump.mirrored:
        axes.axhline(0, color="black", linewidth=0.3, linestyle="-.")
    axes.set_aspect("equal")
    z0, z1, low, high = (1e3 * end for end in _ends(dump, window))
    axes.set_xlim(z0, z1)
    axes.set_ylim(low, high)
    axes.tick_params(labelsize=7)
    axes.set_xlabel("z [mm]", fontsize=8)
    axes.set_ylabel("r [mm]", fontsize=8)
    axes.set_title(f"{verbatim(title)}  t = {dump.time * 1e6:.2f} µs".strip(), fontsize=9)
    return drawn


def _halves(drawn: list) -> dict[str, str]:
    """The half of a section that shows each field, "upper" or "lower"; "" for a field that is shown everywhere."""
    words = [word for word, _ in drawn]
    return dict(zip(words, ("upper", "lower"), strict=True)) if len(set(words)) == 2 else dict.fromkeys(words, "")


def _of_half(half: str) -> str:
    return f"{half.capitalize()} half" if half else ""


def colour_bars(axes, dump: Dump, drawn: list) -> None:
    """Adds a colour bar for each field that `section` has drawn; ``axes`` is one, or an array that shares the bars.

    If the halves show different fields, a bar names its half.
    """
    figure, halves = np.ravel(axes)[0].figure, _halves(drawn)
    for word, mappable in dict(drawn).items():
        if mappable is not None:
            bar = figure.colorbar(mappable, ax=axes, fraction=0.03, pad=0.01)
            half = _of_half(halves[word])
            bar.set_label((f"{half}: " if half else "") + chosen(dump, word).label, fontsize=8)
            bar.ax.tick_params(labelsize=7)


def _ends(dump: Dump, window: tuple[float, float, float] | None) -> tuple[float, float, float, float]:
    """Lowest and highest z and r that a panel shows, m; without a window those of the whole mesh."""
    inner, outer = dump.r_edges[0], dump.r_edges[-1]
    z0, z1, r1 = window or (dump.z_edges[0], dump.z_edges[-1], max(-inner, outer))
    return (z0, z1, -r1, r1) if dump.mirrored else (z0, z1, max(-r1, inner), min(r1, outer))


def _panel_size(width: float, dump: Dump, window: tuple[float, float, float] | None) -> tuple[float, float]:
    """Width and height in inches of a panel with a title that shows a window at equal scales; ``width`` is the largest."""
    z0, z1, low, high = _ends(dump, window)
    height = width * (high - low) / (z1 - z0)
    if height > TALLEST:
        width, height = max(width * TALLEST / height, NARROWEST), TALLEST
    return width, max(height, 0.8) + 0.6


def own_axes(dump: Dump, window: tuple[float, float, float] | None = None, width: float = 8.0):
    """Axes of a new pyplot figure in the shape of a section, which a notebook shows automatically; width in inches."""
    from matplotlib import pyplot

    width, height = _panel_size(width, dump, window)
    return pyplot.subplots(figsize=(width + 1.2, height + 0.4), layout="constrained")[1]


def new_figure(width: float, height: float, rows: int = 1, columns: int = 1, **options: Any) -> tuple[Figure, np.ndarray]:
    """A matplotlib Figure that belongs to no window, and its axes, shape (rows, columns).

    width, height : inches
    options : of `Figure.subplots`, such as ``sharey=True``
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False, **options)


def draw_sections(panels: list[list[tuple[Dump, str, float | None]]], field: str, mirror: str | None = None,
                  window=None, limits: dict[str, tuple[float, float]] | None = None, figure=None,
                  scale: Scale = LINEAR):
    """Sections with one colour scale. `panels` holds rows of (dump, title, depth line).

    window : (z0, z1, r1) in m, or a function that returns it for a dump; by default each panel shows the whole mesh at its
        place at that time
    limits : colour ranges by field, in the reader's unit; by default from what is shown
    scale : of the colours
    figure : a figure that this function returned earlier, to be redrawn; by default a new one
    """
    seen = window if callable(window) else lambda _: window
    dumps = [dump for row in panels for dump, _, _ in row]
    words = dict.fromkeys(word for word in (field, mirror or field) if word != "material")
    limits = {word: scale.limits([chosen(cropped(dump, seen(dump)), word).values for dump in dumps])
              for word in words if word not in (limits or {})} | (limits or {})
    rows, columns = len(panels), max(len(row) for row in panels)
    panel_width, panel_height = _panel_size(min(11.0, max(4.0, 16.0 / columns)), dumps[0], seen(dumps[0]))
    if figure is None:
        figure, axes = new_figure(panel_width * columns + 1.2, panel_height * rows + 0.4, rows, columns)
    else:
        figure.clear()
        axes = figure.subplots(rows, columns, squeeze=False)
    drawn = []
    for j, row in enumerate(panels):
        for i in range(columns):
            if i >= len(row):
                axes[j, i].set_visible(False)
                continue
            dump, title, line = row[i]
            drawn = section(axes[j, i], dump, field, mirror, limits, title=title, depth_line=line, window=seen(dump),
                            scale=scale)
    for place in axes[:-1].flat:
        place.set_xlabel("")
    colour_bars(axes, dumps[0], drawn)
    return figure


def cropped(dump: Dump, window) -> Dump:
    """The part of a dump inside a window, for its colour range."""
    if window is None:
        return dump
    z0, z1, r1 = window
    low = max(int(np.searchsorted(dump.z_edges, z0, "right")) - 1, 0)
    high = min(int(np.searchsorted(dump.z_edges, z1, "left")), len(dump.z_edges) - 1)
    inner = max(int(np.searchsorted(dump.r_edges, -r1, "right")) - 1, 0)
    outer = min(int(np.searchsorted(dump.r_edges, r1, "left")), len(dump.r_edges) - 1)
    if low >= high or inner >= outer:
        raise FigureError(f"the window z {z0:g} to {z1:g} m, r to {r1:g} m shows no part of the mesh")
    fields = {name: values[low:high, inner:outer] for name, values in dump.fields.items()}
    return replace(dump, r_edges=dump.r_edges[inner : outer + 1], z_edges=dump.z_edges[low : high + 1], fields=fields)


def sections(runs: list, field: str = "pressure", *, mirror: str | None = None, times=(None,), window=None,
             limits: tuple[float, float] | None = None, scale: Scale = LINEAR):
    """Sections of runs (results.Results): one row for each run, one column for each time in s (None: the last).

    limits : colour range of ``field`` in the reader's unit; by default from what is shown
    """
    panels = [[(run.dump(time), run.label, run.measured_position) for time in times] for run in runs]
    return draw_sections(panels, field, mirror, window, {field: limits} if limits else None, scale=scale)


def histories(runs: list, quantities=HISTORIES):
    """Quantities against time, one panel for each with all runs in it; the experiment's depth is a line."""
    columns = 2 if len(quantities) > 1 else 1
    rows = -(-len(quantities) // columns)
    figure, axes = new_figure(5.0 * columns, 3.0 * rows, rows, columns)
    for place, name in zip(axes.flat, quantities, strict=False):
        unit, scale = reader_unit(history.unit(name))
        for run in runs:
            if name not in run.history:
                raise FigureError(f"{run.directory}: {unknown('quantity', name, run.history)}")
            place.plot(run.history["time"] * 1e6, run.history[name] * scale, label=in_legend(run.label), linewidth=1.2)
        if name == "penetration_depth_m":
            for depth in dict.fromkeys(run.measured_depth for run in runs):
                if depth is not None:
                    place.axhline(depth * scale, color="crimson", linestyle="--", linewidth=1.0, label="experiment")
        place.set_xlabel("t [µs]", fontsize=8)
        said = verbatim(history.spoken(name))
        place.set_ylabel(said if unit == "1" else f"{said} [{unit}]", fontsize=8)
        place.tick_params(labelsize=7)
        place.grid(alpha=0.3)
    for place in axes.flat[len(quantities) :]:
        place.set_visible(False)
    axes[0, 0].legend(fontsize=7)
    return figure


def holes(run) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """The holes of a run that are not empty: the target's name, depth below the first target's surface and radius, mm, (n,)."""
    surface = run.surface_at(run.summary.time_s or 0.0) if run.summary else run.surface
    for target, (z, radius) in run.craters.items():
        if len(z):
            yield target, run.direction * (z - surface) * 1e3, radius * 1e3


def craters(runs: list):
    """The holes in all targets of runs, mirrored at the axis: radius against depth below the first target's surface, in mm.

    Holes are long and thin, so radii have a separate scale. The experiment's depth is a line. Raises FigureError if no run
    has a hole.
    """
    figure, ((axes,),) = new_figure(9.0, 4.0, 1, 1)
    for run in runs:
        style = {"label": in_legend(run.label)}
        for _, depth, radius in holes(run):
            upper, lower = np.column_stack([depth, radius]), np.column_stack([depth, -radius])[::-1]
            (line,) = axes.plot(*np.concatenate([upper, lower]).T, linewidth=1.2, **style)
            style = {"color": line.get_color()}
    if not axes.lines:
        raise FigureError("no run has a hole to draw")
    for depth in dict.fromkeys(run.measured_depth for run in runs):
        if depth is not None:
            axes.axvline(depth * 1e3, color="crimson", linestyle="--", linewidth=1.0, label="experiment")
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.axhline(0.0, color="black", linewidth=0.3, linestyle="-.")
    axes.tick_params(labelsize=7)
    axes.set_xlabel("depth below the original surface [mm]", fontsize=8)
    axes.set_ylabel("radius of the hole [mm]", fontsize=8)
    axes.margins(y=0.25)
    axes.legend(fontsize=7, loc="upper right")
    return figure


def save_figure(figure: Figure, path: str | Path) -> None:
    """Writes a matplotlib Figure, trimmed and at 160 dots per inch; a file is replaced by a whole one.

    path : of the picture; its ending sets the format, such as ``.png``, ``.pdf`` or ``.svg``

    Raises FigureError for another ending, or a folder that does not exist, and OSError.
    """
    path = Path(path)
    allowed = figure.canvas.get_supported_filetypes()
    ending = path.suffix.lower().lstrip(".")
    if ending in FILMS:
        raise FigureError(f"{path} is a film; make it with `hydro2d movie RUN -o {path.name}`")
    if ending not in allowed:
        raise FigureError(f'{path}: unknown picture format "{path.suffix}" (allowed: {", ".join(sorted(allowed))})')
    if not path.parent.is_dir():
        raise FigureError(f"{path.parent}: there is no such directory")
    with replacing(path) as temporary:
        figure.savefig(temporary, format=ending, dpi=160, bbox_inches="tight", pad_inches=0.08)
