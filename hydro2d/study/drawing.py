"""The figures of a report, narrow enough to be read on a phone: depths, histories, shapes of rods."""

from __future__ import annotations

from collections.abc import Sequence

from hydro2d.output.history import unit
from hydro2d.results.figures import new_figure, reader_unit
from hydro2d.study.experiments import AT_LEAST, Measurement
from hydro2d.study.record import DRAWN, Record, Setup
from hydro2d.study.series import Series, style
from hydro2d.study.theory import Curve

WIDTH, FONT = 5.0, 10.0
#: entries of a legend beyond which the rest is counted
MOST_ENTRIES = 24
#: runs beyond which histories are told apart by series only
MOST_LINES = 12
#: markers of measurements, filled: qualifier -> marker and word
MEASURED = {"measured": ("o", "experiment"), "estimated": ("d", "experiment, estimated"),
            AT_LEAST: ("^", "experiment, at least (plate perforated)")}  # fmt: skip
THEORY_DASHES = ("-", "--", "-.", ":", (0, (4, 1, 1, 1, 1, 1)))


def _tidy(axes, label_x: str, label_y: str) -> None:
    axes.set_xlabel(label_x, fontsize=FONT)
    axes.set_ylabel(label_y, fontsize=FONT)
    axes.tick_params(labelsize=FONT)
    axes.grid(alpha=0.3)


def _legend(figure, handles: list, labels: list[str]) -> None:
    """A legend below the axes, which takes no room from them."""
    rest = len(labels) - MOST_ENTRIES
    if rest > 0:
        from matplotlib.lines import Line2D

        handles = [*handles[:MOST_ENTRIES], Line2D([], [], linestyle="none")]
        labels = [*labels[:MOST_ENTRIES], f"and {rest} more: see the table"]
    columns = 2 if max(map(len, labels), default=0) <= 34 else 1
    if labels:
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, fontsize=FONT - 1, frameon=False)


def depths(setup: Setup, series: Sequence[Series], measurements: Sequence[Measurement], curves: Sequence[Curve]):
    """Depth against impact velocity: runs hollow, experiments filled, the target's rear, models as lines."""
    figure, places = new_figure(WIDTH, 4.6 + 0.09 * (len(series) + len(curves)), 1, 1)
    axes = places[0, 0]
    for number, curve in enumerate(curve for curve in curves if curve.drawable):
        axes.plot(curve.velocity, curve.depth * 100, color="#8a8a8a", linestyle=THEORY_DASHES[number % len(THEORY_DASHES)],
                  linewidth=1.3, label=curve.title, zorder=1)  # fmt: skip
    if setup.thickness:
        axes.axhline(setup.thickness * 100, color="black", linewidth=2.2, label="rear of the target", zorder=2)
    for each in series:
        points = sorted((record.velocity, record.depth * 100) for record in each.records)
        axes.plot(*zip(*points, strict=True), marker=each.style.marker, markersize=7, markerfacecolor="white",
                  markeredgecolor=each.style.colour, markeredgewidth=1.5, color=each.style.colour, linewidth=0.5,
                  linestyle=each.style.dash, label=each.label, zorder=3)  # fmt: skip
    through = [(record.velocity, record.depth * 100) for each in series for record in each.records if record.perforated]
    if through:
        axes.plot(*zip(*through, strict=True), linestyle="none", marker=6, markersize=9, color="black", zorder=4,
                  label="run, perforated")  # fmt: skip
    for qualifier, (marker, word) in MEASURED.items():
        shots = [(entry.velocity, entry.depth * 100) for entry in measurements if entry.qualifier == qualifier]
        if shots:
            axes.plot(*zip(*shots, strict=True), linestyle="none", marker=marker, color="black", markersize=8, label=word,
                      zorder=4)  # fmt: skip
    _tidy(axes, "impact velocity [m/s]", "depth [cm]")
    shown = [record.depth for each in series for record in each.records]
    shown += [entry.depth for entry in measurements] + ([setup.thickness] if setup.thickness else [])
    axes.set_ylim(0.0, 110 * max(shown, default=0.01))
    _legend(figure, *axes.get_legend_handles_labels())
    return figure


def histories(series: Sequence[Series]):
    """Depth, tail velocity and length of the rod against time, one panel each.

    Few runs have a line style each; many have that of their series.
    """
    drawn = [(each, record) for each in series for record in each.records if record.history]
    few = len(drawn) <= MOST_LINES
    figure, places = new_figure(WIDTH, 7.5 + 0.09 * min(len(drawn) if few else len(series), MOST_ENTRIES), len(DRAWN), 1)
    for axes, name in zip(places[:, 0], DRAWN, strict=True):
        factor, word = _readers(unit(name))
        for number, (each, record) in enumerate(drawn):
            how, label = (style(number), _label(record)) if few else (each.style, each.label)
            if name in record.history:
                axes.plot(record.history["time"] * 1e6, record.history[name] * factor, linewidth=1.2 if few else 0.8,
                          color=how.colour, linestyle=how.dash, label=label)  # fmt: skip
        _tidy(axes, "t [µs]", f"{_TITLES[name]} [{word}]")
    handles, labels = places[0, 0].get_legend_handles_labels()
    once = dict(zip(reversed(labels), reversed(handles), strict=True))
    _legend(figure, [once[label] for label in dict.fromkeys(labels)], list(dict.fromkeys(labels)))
    return figure


def _label(record: Record) -> str:
    return record.case.name + ("" if record.done else f" ({record.case.status})")


_TITLES = {"penetration_depth_m": "depth", "rod_tail_velocity_m_s": "tail velocity", "rod_length_m": "rod length"}


def _readers(si: str) -> tuple[float, str]:
    """Factor and unit: lengths in cm, as depths are printed; else as in other figures."""
    if si == "m":
        return 100.0, "cm"
    word, factor = reader_unit(si)
    return factor, word
