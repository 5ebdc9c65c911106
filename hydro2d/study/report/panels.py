"""The figures of a report with headings, captions, notes, and texts for readers who cannot see them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hydro2d.analytic.catalogue import Motion
from hydro2d.base.formats import distinct, html_id
from hydro2d.measure.regime import ERODING
from hydro2d.study.ensemble.contents import Contents
from hydro2d.study.ensemble.ensembles import grouped
from hydro2d.study.records import experiments, record, responses
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record, Setup
from hydro2d.study.records.responses import CASE, DEPTH, RESIDUAL, Choice, Response, Variable
from hydro2d.study.report import charts, residual, run_series, theory

#: fraction by which lines of models extend beyond the velocities of runs and experiments
BEYOND = 0.05
#: largest number of impact velocities whose histories are shown with those of a model
MOST_MOTIONS = 4
#: largest number of runs in the text for readers who cannot see a figure
MOST_WORDS = 12


@dataclass(frozen=True)
class Chart:
    """A Plotly figure: its id in the page, markup, heading, caption, text for readers who cannot see it, notes."""

    name: str
    markup: str
    heading: str
    caption: str
    alt: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Panel:
    """Runs in one figure.

    members : the runs;  series : the runs by series;  heading, words : their setup, in short and in full
    setup : projectile and target of the first run if all have the same geometry, else None;  shots : experiments of all setups
    """

    members: list[Record]
    series: list[run_series.Series]
    heading: str
    words: str
    setup: Setup | None
    shots: list[Measurement]


def draw(contents: Contents, choice: Choice) -> Iterator[Chart]:
    """All figures: for each panel its responses, then its histories."""
    ids: list[str] = []

    def new_id(what: str, panel: Panel) -> str:
        ids[:] = distinct([*ids, html_id(f"{what}-{panel.heading}")])
        return ids[-1]

    through = any(each.perforated for each in contents.records)
    for panel in panels(contents, choice):
        for y in choice.y:
            stopped = y.name == RESIDUAL and through and not any(each.perforated for each in panel.members)
            if not stopped and any(_drawn(each, choice, y) for each in panel.members):
                yield _response(contents, choice, y, panel, new_id(y.name, panel))
        rows = _rows(contents, choice, panel)
        if rows is not None:
            yield _strip(contents, rows, panel, new_id("strip", panel))
        if any(each.history for each in panel.members):
            yield _histories(contents, choice, panel, new_id("histories", panel))


def _drawn(each: Record, choice: Choice, y: Response) -> bool:
    return y.value(each) is not None and choice.x.value(each) is not None


def panels(contents: Contents, choice: Choice) -> list[Panel]:
    """The runs of each figure: of one projectile and target, or of several if their series distinguish them.

    All runs are in one figure if there is no projectile, or if x varies projectile or target.
    """
    groups, axes = contents.groups, contents.study.axes
    by_setup = choice.x.impact or any(len({choice.x.value(each) for each in members}) > 1 for members in groups.values())
    if not groups or not by_setup:
        title = contents.study.title
        common = next(iter(groups)) if len(groups) == 1 else None
        shots = contents.measurements[common] if common else []
        members = contents.records
        return [Panel(members, run_series.grouped(members, axes, choice), common.short if common else title,
                      common.words if common else title, common, shots)]
    alike: dict[tuple, list[Setup]] = {}
    for setup in groups:
        alike.setdefault((setup.target, setup.nose, setup.shape), []).append(setup)
    chosen = []
    for setups in alike.values():
        together = _panel(contents, choice, setups)
        separate = [_panel(contents, choice, [setup]) for setup in setups]
        chosen += [together] if _tells_setups_apart(together, setups) else separate
    return chosen


def _tells_setups_apart(panel: Panel, setups: Sequence[Setup]) -> bool:
    """Whether several setups can share a figure: each series has one setup, and the experiments have the same geometry."""
    single = all(len({each.setup for each in one.records}) == 1 for one in panel.series)
    return single and (not panel.shots or len({setup[3:] for setup in setups}) == 1)


def _panel(contents: Contents, choice: Choice, setups: Sequence[Setup]) -> Panel:
    members = [each for each in contents.records if each.setup in setups]
    grouped = run_series.grouped(members, contents.study.axes, choice)
    shots = list(dict.fromkeys(shot for setup in setups for shot in contents.measurements[setup]))
    first = setups[0]
    rods, sizes = len({setup.rod for setup in setups}), len({setup[3:] for setup in setups})
    words, heading = first.words, first.short
    if len(setups) > 1:
        of = f"{rods} materials" if rods > 1 else first.rod
        words = (f"{first.kind}s of {of} ({first.size}) into {first.plate}" if sizes == 1 else
                 f"{first.kind}s of {of} into {first.target}, {sizes} geometries")
        heading = f"{first.kind}s of {of} into {first.target}"
    return Panel(members, grouped, heading, words, first if sizes == 1 else None, shots)


def _response(contents: Contents, choice: Choice, y: Response, panel: Panel, name: str) -> Chart:
    x, members = choice.x, panel.members
    curves, left, notes = _models(x, y, panel)
    figure = charts.response(panel.setup, panel.series, x, y, contents.belonging, panel.shots, curves, left)
    about, against = y.title.split(" [")[0], x.title.split(" [")[0]
    shown = [each for each in members if _drawn(each, choice, y)]
    repeated = any(each.repeated for each in panel.series)
    ended = [each for each in shown if not each.unfinished]
    head = about[0].upper() + about[1:]
    caption = f"{head} against {against}: {panel.words}. {len(ended)} of {len(members)} runs have ended"
    caption += f"; open marks: {len(shown) - len(ended)} unfinished." if len(shown) > len(ended) else "."
    if repeated:
        caption += " A mark is the median of the members of an ensemble, its bar reaches from 10 to 90 %, dots are the members."
    grey = _grey_lines(curves, panel)
    caption += grey
    if left and not grey:
        caption += f" Lines without marks: {'; '.join(curve.title for curve in left)}."
    said = _ensembles(shown, y) if repeated else [f"{each.case.name} {_value(each, y)}" for each in shown]
    more = f" and {len(said) - MOST_WORDS} more" if len(said) > MOST_WORDS else ""
    alt = f"{about} against {against}, {panel.words}. {'Ensembles' if repeated else 'Runs'}: "
    alt += f"{'; '.join(said[:MOST_WORDS])}{more}."
    if y.name == DEPTH:
        measured = [f"{shot.velocity:.0f} m/s {'at least ' * (shot.qualifier == experiments.AT_LEAST)}{shot.depth * 100:.1f} cm"
                    for shot in panel.shots]
        alt += f" Experiments: {'; '.join(measured) or 'none known'}."
    if y.name == RESIDUAL and (residuals := {each.velocity: each.measured_residual for each in members
                                             if each.velocity is not None and each.measured_residual is not None}):
        alt += f" Experiments: {'; '.join(f'{speed:.0f} m/s {left:.0f} m/s' for speed, left in sorted(residuals.items()))}."
    return Chart(name, charts.markup(figure, name), f"{head}: {panel.heading}", caption, alt, tuple(notes))


def _rows(contents: Contents, choice: Choice, panel: Panel) -> Variable | None:
    """The rows of a strip of final depths: the combinations of the axes, if the runs have one velocity.

    None if a figure against the only axis, or against the cases, is such a strip already.
    """
    combinations = responses.combinations(contents.study, panel.members)
    depth = responses.response(DEPTH)
    if combinations is None or depth not in choice.y or panel.members[0].velocity is None or not _one_velocity(panel):
        return None
    if not any(depth.value(each) is not None for each in panel.members):
        return None
    already = choice.x.order is not None and len(choice.x.order) == len(combinations.order or ())
    return None if already else combinations


def _grey_lines(curves: Sequence[theory.Curve], panel: Panel) -> str:
    """The sentence of a caption on the lines of models; empty if none is drawn."""
    drawn = ", ".join(curve.title for curve in curves if curve.drawable)
    return f" Grey lines: {drawn}, with the deck of {_modelled(panel).case.name}." if drawn else ""


def _strip(contents: Contents, rows: Variable, panel: Panel, name: str) -> Chart:
    y, speed = responses.response(DEPTH), panel.members[0].velocity
    curves, _, notes = _models(rows, y, panel)
    figure = charts.strip(panel.series, rows, y, contents.belonging, curves)
    shown = [each for each in panel.members if y.value(each) is not None]
    caption = f"Final depths at {speed:.0f} m/s, a row for each combination of {rows.title}: {panel.words}."
    caption += " Marks as in the figure of the depth."
    caption += _grey_lines(curves, panel)
    said = [f"{rows.value(each)} {_value(each, y)}" for each in shown]
    more = f" and {len(said) - MOST_WORDS} more" if len(said) > MOST_WORDS else ""
    alt = f"Final depths at {speed:.0f} m/s by {rows.title}, {panel.words}: {'; '.join(said[:MOST_WORDS])}{more}."
    return Chart(name, charts.markup(figure, name), f"Final depths: {panel.heading}", caption, alt, tuple(notes))


def _ensembles(shown: Sequence[Record], y: Response) -> list[str]:
    """A response of ensembles in words."""
    spreads = [(each, values) for each in grouped(shown) if (values := each.spread(y.name))]
    return [f"{each.name} {values.median * y.factor:.4g} {y.unit} ({values.low * y.factor:.4g} to {values.high * y.factor:.4g})"
            for each, values in spreads]


def _value(each: Record, y: Response) -> str:
    """A response of a run in words."""
    if y.name == DEPTH and each.perforated:
        return "perforated"
    bound = "at least " * (y.name == DEPTH and each.left)
    return f"{bound}{y.value(each):.4g} {y.unit}".rstrip() + (" (unfinished)" if each.unfinished else "")


def _modelled(panel: Panel) -> Record | None:
    """The run whose deck is the input of the models of the depth."""
    return next((each for each in panel.members if each.shot), None)


def _one_velocity(panel: Panel) -> bool:
    return len({each.velocity for each in panel.members}) == 1


def _models(x: Variable, y: Response, panel: Panel):
    """Depths and residual velocities by analytic models, if x is the impact velocity, and notes on them.

    In a strip of cases at one velocity, depths at that velocity.
    """
    if x.name == CASE and y.name == DEPTH and (first := _modelled(panel)) and panel.setup and _one_velocity(panel):
        curves = theory.curves(first.shot, first.velocity, first.velocity)
        return curves, [], [f"{curve.title}: {curve.note}." for curve in curves if curve.note]
    if not x.impact or y.name not in (DEPTH, RESIDUAL):
        return [], [], []
    speeds = [each.velocity for each in panel.members if each.velocity is not None] + [shot.velocity for shot in panel.shots]
    beyond = BEYOND * ((max(speeds) - min(speeds)) or max(speeds))
    low, high = max(min(speeds) - beyond, 1.0), max(speeds) + beyond
    if y.name == DEPTH:
        first = _modelled(panel)
        if first is None:
            return [], [], [f"Analytic models of the depth are not drawn: {panel.members[0].without_models}."]
        if panel.setup is None:
            return [], [], ["Analytic models of the depth are not drawn: the runs are of several geometries."]
        curves = theory.curves(first.shot, low, high)
        return curves, [], [f"{curve.title}: {curve.note}." for curve in curves if curve.note]
    left, notes = [], []
    for each in panel.series:
        fitted, said = residual.curves(each.records, low, high)
        several = f"{each.label}: " if len(panel.series) > 1 else ""
        colour = each.style.colour if several else ""
        left += [residual.Curve(several + curve.title, curve.velocity, curve.residual, colour) for curve in fitted]
        notes += [f"{several}{note}." for note in said]
    return [], left, notes


def _motions(panel: Panel, drawn: Sequence[Record]) -> dict[float, tuple[float, dict[str, Motion]]]:
    """Time in s at which the rod touches the target, and its motion by each model, by impact velocity; empty if many."""
    first, by_speed = _modelled(panel), {}
    speeds = {each.velocity: each for each in reversed(drawn) if each.velocity is not None and responses.DEPTH in each.history}
    if first is None or panel.setup is None or len(speeds) > MOST_MOTIONS:
        return {}
    for speed, each in sorted(speeds.items()):
        eroding = any(run.velocity == speed and run.value("regime") == ERODING for run in drawn)
        motions = theory.motions(first.shot, speed, eroding=eroding, thickness=panel.setup.thickness)
        if motions:
            deep = each.history[responses.DEPTH] > 0.0
            row = int(deep.argmax())
            touch = each.history["time"][row] - each.history[responses.DEPTH][row] / speed if deep.any() else 0.0
            by_speed[speed] = max(float(touch), 0.0), motions
    return by_speed


def _histories(contents: Contents, choice: Choice, panel: Panel, name: str) -> Chart:
    drawn = [each for each in panel.members if each.history]
    lines = run_series.grouped(drawn, contents.study.axes, choice)
    motions = _motions(panel, drawn)
    figure = charts.histories(lines, motions)
    ends = [each.history["time"][-1] * 1e6 for each in drawn]
    few = charts.few_lines([(each, record) for each in lines for record in each.records])
    styles = "one line style a run" if few else "one line style a series of runs"
    styles += "; thin: members of ensembles but the first" if any(each.repeated for each in lines) else ""
    columns = ", ".join(axis.title.text.split("<br>")[0] for axis in figure.select_yaxes())
    runs = f"{len(drawn)} run{'s' * (len(drawn) > 1)}, {panel.words}"
    caption = f"Histories of {columns}: {runs}; {styles}, at most {record.POINTS} points of each history."
    if motions:
        named = ", ".join(dict.fromkeys(name for _, by in motions.values() for name in by))
        fainter = "; the slower the impact, the fainter" if len(motions) > 1 else ""
        caption += f" Grey: {named}, from the first touch on, with the deck of {_modelled(panel).case.name}{fainter}."
    alt = f"{columns} against time, {runs}. The runs end between {min(ends):.0f} and {max(ends):.0f} µs."
    return Chart(name, charts.markup(figure, name), f"Histories: {panel.heading}", caption, alt)
