"""The figures of a sample (results.Samples): a result against each input, and the effects of the inputs as bars (tornado)."""

from __future__ import annotations

import numpy as np

from hydro2d.results import figures
from hydro2d.results.figures import verbatim
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE
from hydro2d.study.records.responses import readers, title
from hydro2d.study.samples import surrogates

#: panels in a row; width and height of one in inches; points of a curve; places of the marks of a level beside one another
COLUMNS, SIZE, POINTS, APART = 3, (3.6, 2.9), 60, 0.25
#: most characters of a value of an input, which may be a whole table
LONGEST = 24
#: numbers along an axis; points between a bar and its label, and between the label and the frame
NUMBERS, GAP = 5, 3
#: rounds in which the room for the labels is found; each brings its error to 0.8 of it or less
ROUNDS = 60


def _axis(samples, result: str) -> tuple[str, float]:
    """The label of an axis of a result and the factor to the reader's unit; an outcome is a fraction."""
    if samples.is_outcome(result):
        return f"fraction: {result}", 1.0
    unit, factor = readers(result)
    return title(result) + (f" [{unit}]" if unit else ""), factor


def _brief(value: str) -> str:
    """A value of an input in a picture; of a table the beginning, from its model on."""
    value = value.removeprefix("{ model = ")
    return value if len(value) <= LONGEST else value[: LONGEST - 1] + "\u2026"


def scatter(samples, result: str):
    """A figure with a panel for each input: the rows as dots, and the surrogate as a line, with its Q2, if there is one."""
    rows, values = samples.by_row(result)
    label, factor = _axis(samples, result)
    cube = samples.cube(rows)
    try:
        made = samples.surrogate(result)
    except StudyError:
        made = None  # the dots are drawn without a line
    columns = min(len(samples.inputs), COLUMNS)
    lines = -(-len(samples.inputs) // columns)
    figure, axes = figures.new_figure(SIZE[0] * columns, SIZE[1] * lines, lines, columns, sharey=True)
    for number, (place, each) in enumerate(zip(axes.flat, samples.inputs, strict=False)):
        place.set_xlabel(verbatim(each.head), fontsize=8)
        place.tick_params(labelsize=7)
        place.grid(alpha=0.3)
        if each.kind == CHOICE:
            _levels(place, each, cube[:, number], values * factor)
            continue
        place.locator_params(axis="x", nbins=NUMBERS)
        place.plot(each.quantiles(cube[:, number]), values * factor, "o", markersize=3, alpha=0.6, color="C0")
        if made is not None:
            points = np.linspace(0.01, 0.99, POINTS)
            curve = made(surrogates.along(samples.inputs, number, points))
            place.plot(each.quantiles(points), curve * factor, color="C1", linewidth=1.4)
    if made is not None and any(each.kind != CHOICE for each in samples.inputs):
        figure.suptitle(f"lines: the surrogate, Q2 {made.q2:.2f}", fontsize=8)
    for place in axes[:, 0]:
        place.set_ylabel(verbatim(label), fontsize=8)
    for place in axes.flat[len(samples.inputs) :]:
        place.set_visible(False)
    return figure


def _levels(place, each, points: np.ndarray, values: np.ndarray) -> None:
    """Dots above each level of a choice, side by side in their order."""
    level = each.level_of(points)
    for number in range(len(each.levels)):
        own = values[level == number]
        place.plot(number + APART * np.linspace(-1.0, 1.0, max(own.size, 1))[: own.size], own, "o", markersize=3, alpha=0.6,
                   color="C0")
    place.set_xticks(range(len(each.levels)), [verbatim(_brief(level)) for level in each.levels], rotation=20)


def tornado(samples, result: str):
    """A figure with a bar for each input, the largest effect on top, about the result at the medians of all inputs."""
    effects, made = samples.effects(result), samples.surrogate(result)
    label, factor = _axis(samples, result)
    middle = float(made(surrogates.middle(samples.inputs)[None])[0]) * factor
    figure, ((place,),) = figures.new_figure(6.4, 1.3 + 0.45 * len(effects))
    labels = []
    for number, each in enumerate(effects):
        ends = each.low * factor, each.high * factor
        for end, colour in sorted(zip(ends, ("C0", "C1"), strict=True), key=lambda bar: -abs(bar[0] - middle)):
            place.barh(number, end - middle, left=middle, color=colour, height=0.6)
        (low, at_low), (high, at_high) = sorted(zip(ends, (each.at_low, each.at_high), strict=True))
        sides = (at_low, min(low, middle), -GAP, "right"), (at_high, max(high, middle), GAP, "left")  # both may lie on one side
        labels += [place.annotate(verbatim(_brief(at)), (end, number), (offset, 0), textcoords="offset points", ha=side,
                                  va="center", fontsize=7) for at, end, offset, side in sides]
    place.set_yticks(range(len(effects)), [verbatim(each.input) for each in effects], fontsize=8)
    place.invert_yaxis()
    place.axvline(middle, color="black", linewidth=0.8)
    place.set_xlabel(verbatim(f"{label}; Q2 of the surrogate {made.q2:.2f}"), fontsize=8)
    place.tick_params(axis="x", labelsize=7)
    place.locator_params(axis="x", nbins=NUMBERS)
    _make_room(figure, place, labels)
    return figure


def _make_room(figure, place, labels: list) -> None:
    """Widens the axis so that the labels, which lie left and right of bars in turn, stay within the frame."""
    figure.draw_without_rendering()
    width, gap = place.get_window_extent().width, 2.0 * GAP * figure.dpi / 72.0
    ends = np.array([label.xy[0] for label in labels])
    sizes = np.minimum([label.get_window_extent().width + gap for label in labels], 0.4 * width)
    scale, low, high = 0.0, 0.0, 0.0
    for _ in range(ROUNDS):  # data per pixel, from which the room for the labels follows
        low, high = np.min(ends[::2] - scale * sizes[::2]), np.max(ends[1::2] + scale * sizes[1::2])
        scale = (high - low) / width
    place.set_xlim(low, high)
