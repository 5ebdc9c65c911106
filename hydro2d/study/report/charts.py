"""The drawn figures of a report, by Plotly: responses against varied quantities, and histories.

Text, grid and experiments have stand-in colours, which the page's style replaces by those of the light or the dark scheme;
saved pictures keep the stand-ins, which are those of paper.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from hydro2d.analytic.catalogue import Motion
from hydro2d.base.formats import in_plotly
from hydro2d.study.records.experiments import AT_LEAST, Measurement
from hydro2d.study.records.record import Record, Setup
from hydro2d.study.records.responses import DEPTH, RESIDUAL, Response, Variable, readers, title
from hydro2d.study.report import residual, theory
from hydro2d.study.report.marks import SIZE, ensembles, points
from hydro2d.study.report.run_series import Series, style

#: stand-ins for text and experiments, for models and axes, for the grid, and for the paper
INK, MUTED, GRID, PAPER = "rgb(1, 2, 3)", "rgb(90, 91, 92)", "rgb(221, 222, 223)", "rgb(254, 254, 254)"
#: heights in pixels: of a panel, of the space below it, of a line of the legend; letters in such a line
PANEL, BELOW, LINE, LETTERS = 300, 74, 19, 40
#: pixels between the words of two rows of a strip
GAP = 14
#: largest extent of a strip for the line of a model, in largest depths of runs and experiments
FARTHEST = 1.5
#: largest number of entries in a legend; a pointer shows the rest
MOST_ENTRIES = 24
#: largest number of runs whose histories have a style each; beyond it, only series have
MOST_LINES = 12
#: words on an x axis beyond which they stand upright
MOST_ACROSS = 4
#: markers of measurements: qualifier -> marker and word
MEASURED = {"measured": ("diamond-tall", "experiment"), "estimated": ("diamond-tall-open", "experiment, estimated"),
            AT_LEAST: ("star-triangle-up", "experiment, at least (plate perforated)")}
#: columns of the history that a model of a rod also gives, and their names there
OF_MOTION = {DEPTH: "depth", "rod_tail_velocity_m_s": "velocity", "rod_length_m": "length"}
THEORY_DASHES = ("solid", "dash", "dashdot", "dot", "8px,2px,2px,2px,2px,2px")
#: opacity of the line of a model for the slowest of several impacts
FAINTEST = 0.45


def _figure(rows: int = 1):
    """An empty figure with stand-in colours."""
    from plotly.subplots import make_subplots

    figure = make_subplots(rows=rows, cols=1, shared_xaxes=True, vertical_spacing=0.06)
    figure.update_layout(
        template="none", font={"color": INK, "size": 13, "family": "system-ui, sans-serif"}, paper_bgcolor=PAPER,
        plot_bgcolor=PAPER, hovermode="closest", hoverlabel={"bgcolor": PAPER, "bordercolor": MUTED, "font": {"color": INK}},
        modebar={"color": MUTED, "activecolor": "#0072b2", "bgcolor": "rgba(0,0,0,0)"},
        separators=".",  # of decimals alone: 1499.5, not 1,499.5
    )
    lines = {"gridcolor": GRID, "linecolor": MUTED, "tickcolor": MUTED, "zeroline": False, "showline": True, "ticks": "outside",
             "minexponent": 6}  # 12000, not 12k
    figure.update_xaxes(**lines, title_standoff=6)
    figure.update_yaxes(**lines, automargin=True, title_standoff=8)
    return figure


def _finished(figure, rows: int = 1, labels: int = 0, panel: float = PANEL):
    """Room for the legend, one entry a line below the panels, so that no entry is cut off on a narrow screen.

    labels : pixels that the labels of the x axis take beyond one line;  panel : height of a single panel in pixels
    """
    shown = []
    for trace in figure.data:
        if trace.name and trace.showlegend is not False:
            if len(shown) >= MOST_ENTRIES:
                trace.showlegend = False
                continue
            trace.name = "<br>".join(map(in_plotly, textwrap.wrap(trace.name, LETTERS)))
            shown.append(trace)
    lines = sum(trace.name.count("<br>") + 1 for trace in shown)
    panel, below = rows * panel * (0.72 if rows > 1 else 1.0), LINE * lines + BELOW + labels
    legend = {"x": 0.0, "y": -(BELOW + labels - 12) / panel, "xanchor": "left", "yanchor": "top", "maxheight": 4000,
              "tracegroupgap": 0, "itemsizing": "constant", "groupclick": "togglegroup", "font": {"size": 12}}
    figure.update_layout(height=int(panel + below + 34), legend=legend, showlegend=bool(shown),
                         margin={"l": 62, "r": 14, "t": 34, "b": below})
    return figure


def response(setup: Setup | None, series: Sequence[Series], x: Variable, y: Response, measured: dict[str, Measurement],
             shots: Sequence[Measurement], curves: Sequence[theory.Curve],
             left: Sequence[residual.Curve]):
    """A response against a varied quantity: ended runs have filled marks, unfinished runs open ones, bounds triangles.

    setup : of a panel of one projectile and target, whose rear a line shows in a panel of depths
    measured : experiments by case, drawn if x is not the velocity;  shots : all experiments of the setup, drawn if it is
    curves, left : analytic models, of the depth and of the residual velocity
    """
    figure = _figure()
    if y.name == DEPTH:
        drawn = [(curve.title, "", curve.velocity, curve.depth * y.factor) for curve in curves if curve.drawable]
        if x.order is None:
            _models(figure, drawn, y)
        else:
            _levels(figure, drawn, x, y)
    _models(figure, [(curve.title, curve.colour, curve.velocity, curve.residual * y.factor) for curve in left], y)
    _runs(figure, series, x, y)
    if y.name == DEPTH:
        _bounds(figure, series, x, y)
        _depths(figure, series, x, y, measured, shots)
        if setup and setup.thickness and x.order is None:
            _rear(figure, setup, y)
    if y.name == RESIDUAL:
        _residuals(figure, series, x, y)
    there = {x.value(record) for each in series for record in each.records if y.value(record) is not None}
    labels = _words_below(figure, [word for word in x.order if word in there]) if x.order is not None else 0
    if len(places := {place for trace in figure.data for place in trace.x if place is not None}) == 1:
        figure.update_xaxes(tickmode="array", tickvals=list(places))  # else ticks would be at fractions around it
    figure.update_xaxes(title={"text": in_plotly(x.title)})
    figure.update_yaxes(title={"text": in_plotly(y.title)})
    if y.name in (DEPTH, RESIDUAL):
        figure.update_yaxes(range=[0.0, 1.1 * _highest(figure)])
    return _finished(figure, labels=labels)


def strip(series: Sequence[Series], rows: Variable, y: Response, measured: dict[str, Measurement],
          curves: Sequence[theory.Curve]):
    """Depths at one velocity across, a row of marks for each word of ``rows``; models and marks as in ``response``."""
    figure = _figure()
    drawn = [(f"{curve.title}: {curve.depth[0] * y.factor:.3g} {y.unit}", "", curve.velocity, curve.depth * y.factor)
             for curve in curves if curve.drawable]
    _levels(figure, drawn, rows, y)
    _runs(figure, series, rows, y)
    _bounds(figure, series, rows, y)
    _depths(figure, series, rows, y, measured, [])
    there = {rows.value(record) for each in series for record in each.records if y.value(record) is not None}
    order = [word for word in rows.order if word in there]
    highest = _highest(figure)
    shown = max([highest, *(values[0] for *_, values in drawn if values[0] < FARTHEST * highest)])
    for trace in figure.data:  # traces over the words are turned
        values, places = trace.y, [order.index(word) if word in order else None for word in trace.x]
        if trace.meta == "model":
            values, places = trace.y[:1] * 2, [-0.5, len(order) - 0.5]
        hover = trace.hovertemplate and trace.hovertemplate.replace("%{y", "%{x")
        trace.update(x=values, y=places, error_x=trace.error_y.to_plotly_json(), hovertemplate=hover)
        trace.error_y = {"array": None}
        if trace.meta == "bound":
            trace.marker.symbol = "triangle-right-open"
    wrapped = [textwrap.wrap(word, LETTERS // 2) or [""] for word in order]
    figure.update_yaxes(range=[len(order) - 0.5, -0.5], tickmode="array", tickvals=list(range(len(order))),
                        ticktext=["<br>".join(map(in_plotly, lines)) for lines in wrapped])
    figure.update_xaxes(title={"text": in_plotly(y.title)}, range=[0.0, 1.1 * shown])
    return _finished(figure, panel=sum(LINE * len(lines) + GAP for lines in wrapped))


def _words_below(figure, order: Sequence[str]) -> int:
    """Words on the x axis in their order, wrapped, upright if they are many; returns their pixels beyond one line."""
    upright = len(order) > MOST_ACROSS
    wrapped = [textwrap.wrap(word, LETTERS // (2 if upright else len(order) + 1)) or [""] for word in order]
    figure.update_xaxes(type="category", categoryorder="array", categoryarray=order, tickmode="array", tickvals=order,
                        ticktext=["<br>".join(map(in_plotly, lines)) for lines in wrapped], tickangle=-90 if upright else 0,
                        range=[-0.5, len(order) - 0.5])
    longest = max(len(line) for lines in wrapped for line in lines)
    return 8 * longest if upright else LINE * (max(map(len, wrapped)) - 1)


def _models(figure, lines: Sequence[tuple[str, str, np.ndarray, np.ndarray]], y: Response) -> None:
    """Lines by name, colour (default: grey), impact velocity and value."""
    for number, (name, colour, velocity, value) in enumerate(lines):
        values = [None if np.isnan(one) else float(f"{one:.5g}") for one in value]
        shape = {"color": colour or MUTED, "width": 1.5, "dash": THEORY_DASHES[number % len(THEORY_DASHES)]}
        said = f"{in_plotly(name)}<br>%{{x:.0f}} m/s: %{{y:.4g}} {y.unit}<extra></extra>"
        figure.add_scatter(x=velocity.tolist(), y=values, mode="lines", name=name, line=shape, meta="model", hovertemplate=said)


def _levels(figure, lines: Sequence[tuple[str, str, np.ndarray, np.ndarray]], x: Variable, y: Response) -> None:
    """Values at one velocity as lines across all words of x."""
    for number, (name, _, velocity, value) in enumerate(lines):
        shape = {"color": MUTED, "width": 1.5, "dash": THEORY_DASHES[number % len(THEORY_DASHES)]}
        said = f"{in_plotly(name)}<br>{velocity[0]:.0f} m/s: %{{y:.4g}} {y.unit}<extra></extra>"
        figure.add_scatter(x=list(x.order), y=[float(f"{value[0]:.5g}")] * len(x.order), mode="lines", name=name, line=shape,
                           meta="model", hovertemplate=said)


def _runs(figure, series: Sequence[Series], x: Variable, y: Response) -> None:
    """Ended runs, with a thin line if x distinguishes all of them; unfinished runs with open marks and no line.

    The members of ensembles are dots behind the mark of their median.
    """
    unfinished = False
    for each in series:
        if each.repeated:
            unfinished = ensembles(figure, each, x, y) or unfinished
            continue
        ended = [record for record in each.records if not record.unfinished]
        rest = [record for record in each.records if record.unfinished and y.value(record) is not None]
        places = [x.value(record) for record in ended]
        mode = "lines+markers" if x.order is None and len(set(places)) == len(places) else "markers"
        colour, marker = each.style.colour, each.style.marker
        how = {"symbol": marker, "size": SIZE, "color": colour}
        points(figure, ended, x, y, how, each.label, mode=mode, legendgroup=each.label,
                line={"color": colour, "width": 1.0, "dash": each.style.dash})
        unfinished = unfinished or bool(rest)
        points(figure, rest, x, y, how | {"symbol": f"{marker}-open", "line": {"width": 1.8, "color": colour}},
                "" if ended else each.label, mode="markers", legendgroup=each.label, meta="unfinished")
    if unfinished:
        figure.add_scatter(x=[None], y=[None], mode="markers", name="open: unfinished, as far as it went",
                           marker={"symbol": "circle-open", "size": SIZE, "color": INK})


def _bounds(figure, series: Sequence[Series], x: Variable, y: Response) -> None:
    through = [record for each in series if not each.repeated for record in each.records
               if record.outcome.depth_is == AT_LEAST]
    how = {"symbol": "triangle-up-open", "size": 2.2 * SIZE, "color": INK, "line": {"width": 1.5, "color": INK}}
    points(figure, through, x, y, how, "in a triangle: at least, perforated or left the mesh", mode="markers", meta="bound")


def _depths(figure, series: Sequence[Series], x: Variable, y: Response, measured: dict[str, Measurement],
            shots: Sequence[Measurement]) -> None:
    """Measured depths, at their velocities or at those of their runs."""
    if x.impact:
        places = [(entry.velocity, entry) for entry in shots]
    else:
        records = [record for each in series for record in each.records]
        places = [(x.value(each), measured[each.case.name]) for each in records if each.case.name in measured]
        places = list(dict.fromkeys(entry for entry in places if entry[0] is not None))
    for qualifier in MEASURED:
        entries = [(place, entry.velocity, entry.depth, entry.source) for place, entry in places
                   if entry.qualifier == qualifier]
        _experiments(figure, qualifier, y, entries)


def _residuals(figure, series: Sequence[Series], x: Variable, y: Response) -> None:
    """Measured residual velocities, at the places of the runs with these shots in their decks."""
    records = [record for each in series for record in each.records]
    entries = [(x.value(each), each.velocity, each.measured_residual, each.deck["experiment"]["source"])
               for each in records if each.measured_residual is not None]
    _experiments(figure, "measured", y, [entry for entry in dict.fromkeys(entries) if entry[0] is not None])


def _experiments(figure, qualifier: str, y: Response, entries: Sequence[tuple[float | str, float | None, float, str]]) -> None:
    """Marks of experiments by place on the x axis, impact velocity in m/s, value in SI and source."""
    if not entries:
        return
    marker, word = MEASURED[qualifier]
    labels = [f"<b>{word}</b><br>{in_plotly(source)}<br>" + (f"{speed:.0f} m/s: " if speed else "")
              + f"{value * y.factor:.4g} {y.unit}" for _, speed, value, source in entries]
    figure.add_scatter(x=[place for place, *_ in entries], y=[value * y.factor for _, _, value, _ in entries], mode="markers",
                       name=word, text=labels, hovertemplate="%{text}<extra></extra>", meta="experiment",
                       marker={"symbol": marker, "size": SIZE + 4, "color": INK})


def _rear(figure, setup: Setup, y: Response) -> None:
    """The rear of the target, across the whole panel."""
    ends = [place for trace in figure.data for place in trace.x if isinstance(place, (int, float))]
    figure.add_scatter(x=[min(ends, default=0.0), max(ends, default=1.0)], y=[setup.thickness * y.factor] * 2, mode="lines",
                       name="rear of the target", line={"color": INK, "width": 2.5}, hoverinfo="skip")


def _highest(figure) -> float:
    """The largest value of runs and experiments; models may exceed it."""
    shown = [value for trace in figure.data if trace.meta != "model" for value in trace.y if value is not None]
    return max(shown, default=0.0) or 1.0


def few_lines(drawn: Sequence[tuple[Series, Record]]) -> bool:
    """Whether each history has a line style of its own."""
    return len(drawn) <= MOST_LINES and not any(each.repeated for each, _ in drawn)


def _motions(figure, motions: Mapping[float, tuple[float, Mapping[str, Motion]]], names: Sequence[str]) -> None:
    """Columns by analytic models, from the first touch in s on, by impact velocity in m/s and name.

    A model has its dashes, and the fastest impact the strongest line.
    """
    dashes = dict(zip(dict.fromkeys(name for _, by in motions.values() for name in by), THEORY_DASHES, strict=False))
    strengths = np.linspace(1.0, FAINTEST, len(motions))
    for strength, (speed, (touch, by)) in zip(strengths, sorted(motions.items(), reverse=True), strict=True):
        for model, motion in by.items():
            label = model + (f", {speed:.0f} m/s" if len(motions) > 1 else "")
            given = [(row, name, getattr(motion, OF_MOTION[name])) for row, name in enumerate(names, 1) if name in OF_MOTION]
            for row, name, values in given:
                if values is None:
                    continue
                figure.add_scatter(
                    x=((motion.time + touch) * 1e6).astype(np.float32), y=(values * readers(name)[1]).astype(np.float32),
                    mode="lines", name=label, legendgroup=label, showlegend=name == DEPTH, row=row, col=1, meta="model",
                    opacity=strength, line={"color": MUTED, "width": 1.5, "dash": dashes[model]},
                    hovertemplate=f"{in_plotly(label)}<br>%{{x:.5g}} µs: %{{y:.5g}} {readers(name)[0]}<extra></extra>",
                )


def histories(series: Sequence[Series],
              motions: Mapping[float, tuple[float, Mapping[str, Motion]]] = MappingProxyType({})):
    """Columns of the history against time, one panel each. Few runs have a line style each; many have that of their series.

    Members of ensembles have that of their series too; all but the first are thin. motions : of models, by impact velocity in
    m/s: the time of the first touch in s, and the motions by name
    """
    drawn = [(each, record) for each in series for record in each.records if record.history]
    names = list(dict.fromkeys(name for _, record in drawn for name in record.history if name != "time"))
    few, in_legend = few_lines(drawn), set()
    figure = _figure(len(names))
    for number, (each, record) in enumerate(drawn):
        how = style(number) if few else each.style
        label = record.case.name + (f" ({record.unfinished})" if record.unfinished else "") if few else each.label
        for row, name in enumerate(names, 1):
            if name not in record.history:
                continue
            times, values = record.history["time"] * 1e6, record.history[name] * readers(name)[1]
            figure.add_scatter(
                x=times.astype(np.float32), y=values.astype(np.float32), mode="lines",
                opacity=0.4 if record.case.member else 1.0,
                line={"color": how.colour, "width": 0.9 if record.case.member else 1.4, "dash": how.dash},
                name=label, legendgroup=label,
                showlegend=label not in in_legend, row=row, col=1,
                hovertemplate=f"<b>{in_plotly(record.case.name)}</b><br>%{{x:.5g}} µs: %{{y:.5g}} {readers(name)[0]}"
                              "<extra></extra>",
            )
            in_legend.add(label)
    _motions(figure, motions, names)
    for row, name in enumerate(names, 1):
        figure.update_yaxes(title={"text": f"{in_plotly(title(name))}<br>[{readers(name)[0] or '1'}]"}, row=row, col=1)
    figure.update_xaxes(title={"text": "t [µs]"}, row=len(names), col=1)
    return _finished(figure, len(names))


def markup(figure, name: str) -> str:
    """A figure as markup with its own id, for a page that contains the library once."""
    config = {
        "responsive": True, "displaylogo": False, "plotlyServerURL": "",
        "toImageButtonOptions": {"filename": name, "scale": 2},
        "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d", "sendChartToCloud"],
    }
    return figure.to_html(full_html=False, include_plotlyjs=False, div_id=name, config=config)
