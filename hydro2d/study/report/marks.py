"""The marks of runs in a figure of a report: single runs, and ensembles with their members as dots behind the median."""

from __future__ import annotations

from collections.abc import Sequence

from hydro2d.base.formats import in_plotly
from hydro2d.measure.outcome import AT_LEAST
from hydro2d.study.ensemble.ensembles import Ensemble, grouped
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import DEPTH, Response, Variable
from hydro2d.study.report.run_series import Series

#: sizes of marks and of dots in pixels; opacity of the dots
SIZE, DOT, FAINT = 9, 7, 0.4


def _hover(record: Record, x: Variable, y: Response) -> str:
    """The text that a pointer shows for a run."""
    there, value = x.value(record), y.value(record)
    lines = [f"<b>{in_plotly(record.case.name)}</b>",
             f"{in_plotly(x.title)}: {in_plotly(there) if isinstance(there, str) else f'{there:.5g}'}",
             f"{in_plotly(y.title)}: {'≥ ' * (y.name == DEPTH and record.outcome.depth_is == AT_LEAST)}{value:.5g}"]
    if record.value("regime"):
        lines.append(in_plotly(record.value("regime")))
    if record.unfinished:
        lines.append(in_plotly(record.unfinished))
    return "<br>".join(lines)


def points(figure, records: Sequence[Record], x: Variable, y: Response, how, name: str = "", **options) -> None:
    """A trace of runs, in the order of x."""
    known = [record for record in records if x.value(record) is not None and y.value(record) is not None]
    if x.order is None:
        known.sort(key=x.value)
    if known:
        figure.add_scatter(
            x=[x.value(record) for record in known], y=[y.value(record) for record in known], name=name, marker=how,
            text=[_hover(record, x, y) for record in known], hovertemplate="%{text}<extra></extra>",
            showlegend=bool(name), **options,
        )


def ensembles(figure, series: Series, x: Variable, y: Response) -> bool:
    """The ensembles of a series: members as dots, and in front of them the median with a bar from 10 to 90 %.

    Returns whether there are unfinished members, which are open dots.
    """
    colour = series.style.colour
    ended = [record for record in series.records if not record.unfinished]
    rest = [record for record in series.records if record.unfinished and y.value(record) is not None]
    dot = {"symbol": "circle", "size": DOT, "color": colour, "opacity": FAINT}
    options = {"mode": "markers", "legendgroup": series.label}
    points(figure, ended, x, y, dot, meta="member", **options)
    points(figure, rest, x, y, dot | {"symbol": "circle-open", "opacity": 1.0}, meta="unfinished", **options)
    drawn = [(place, each, values) for each in grouped(series.records)
             if (place := _place(each, x)) is not None and (values := each.spread(y.name)) is not None]
    if x.order is None:
        drawn.sort(key=lambda entry: entry[0])
    if drawn:
        middle, above, below = ([part * y.factor for part in parts] for parts in zip(*(
            (values.median, values.high - values.median, values.median - values.low) for _, _, values in drawn), strict=True))
        figure.add_scatter(
            x=[place for place, _, _ in drawn], y=middle, name=f"{series.label}: median, 10 to 90 %, members",
            mode="markers" if x.order is not None else "lines+markers", legendgroup=series.label,
            marker={"symbol": series.style.marker, "size": SIZE, "color": colour},
            line={"color": colour, "width": 1.0, "dash": series.style.dash},
            error_y={"type": "data", "symmetric": False, "array": above, "arrayminus": below, "color": colour, "thickness": 1.2,
                     "width": 5},
            text=[_hover_of_ensemble(place, each, x, y) for place, each, _ in drawn], hovertemplate="%{text}<extra></extra>",
        )
    return bool(rest)


def _place(each: Ensemble, x: Variable) -> float | str | None:
    """Place of an ensemble on the x axis: that of its members, or their middle if they differ."""
    places = [place for record in each.members if (place := x.value(record)) is not None]
    if not places or isinstance(places[0], str):
        return places[0] if places else None
    return sorted(places)[len(places) // 2]


def _hover_of_ensemble(place: float | str, each: Ensemble, x: Variable, y: Response) -> str:
    """The text that a pointer shows for an ensemble."""
    values = each.spread(y.name)
    low, median, high = (part * y.factor for part in (values.low, values.median, values.high))
    at_least = "≥ " * (y.name == DEPTH and each.bound is not None and values.median >= each.bound)
    lines = [f"<b>{in_plotly(each.name)}</b>: {values.count} of {len(each.members)} members",
             f"{in_plotly(x.title)}: {in_plotly(place) if isinstance(place, str) else f'{place:.5g}'}",
             f"{in_plotly(y.title)}: {at_least}{median:.5g}, 10 to 90 %: {low:.5g} to {high:.5g}"]
    return "<br>".join([*lines, *(f"{in_plotly(regime)}: {share.words}" for regime, share in each.regimes.items())])
