"""A fit of a strength model to measured flow stresses as text, file and figure."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from hydro2d.files.whole import replacing
from hydro2d.materials.fitting import Fit

#: most rows of a list of differences, and most columns of a table: beyond it values are taken together in bins
MOST_ROWS, MOST_COLUMNS = 12, 8


def lines(fit: Fit) -> list[str]:
    """Constants with standard errors, quality of the fit as a whole and by group, rate and temperature, and the law as a line
    of a deck."""
    points = fit.points
    said = [f"{fit.law.name}: {len(points)} points, differences from the measured stress: {_size(fit.residual)}"]
    for group in points.groups:
        mask = points.group == group
        if len(points.groups) > 1:
            said += ["", f"group {group:g}: {int(mask.sum())} points, {_size(fit.residual[mask])}"]
        for name, error in fit.errors[group].items():
            unit, value = fit.law.unit(name), fit.constants[group][name]
            scale, shown = (1e6, "MPa") if unit == "Pa" else (1.0, "" if unit == "1" else unit)
            about = ", at its lower bound" * (value == 0.0) + ", shared by all groups" * (name in fit.shared)
            said.append(f"  {name:<24}{value / scale:>11.5g} +- {error / scale:.2g} {shown}".rstrip() + about)
        said.append(f"  {deck_table(fit, group)}")
    for title, values in (("strain rate [1/s]", points.rate), ("temperature [K]", points.temperature),
                          ("plastic strain", points.strain)):
        said += ["", f"{title:<20}  points  mean difference   rms   largest"]
        for name, mask in _bins(values, MOST_ROWS):
            own = fit.residual[mask]
            said.append(f"{name:<20}  {own.size:>6}  {own.mean():>+15.1%}  {_rms(own):>4.1%}  {np.abs(own).max():>8.1%}")
    return said


def _bins(values: np.ndarray, most: int) -> list[tuple[str, np.ndarray]]:
    """(name, mask) of each value, or of at most ``most`` bins of equal width where there are more values; no bin is empty."""
    distinct = np.unique(values)
    if distinct.size <= most:
        return [(f"{value:g}", values == value) for value in distinct]
    power = 10.0 ** math.floor(math.log10(distinct[-1] / most))
    width = next(each for each in (power, 2.0 * power, 5.0 * power, 10.0 * power)
                 if distinct[-1] // each - distinct[0] // each < most)
    bins = values // width
    return [(f"{k * width:g} to {(k + 1) * width:g}", bins == k) for k in np.unique(bins)]


def table(fit: Fit, others: Mapping[str, np.ndarray]) -> list[str]:
    """Mean measured stress of every test by plastic strain, and the mean differences of the fit and of other laws from it.

    others : relative differences of every point, float64[n], by the name of a law
    """
    points, laws = fit.points, {fit.law.name: fit.residual, **others}
    columns = _bins(points.strain, MOST_COLUMNS)
    wide = max(len("measured [MPa]"), *map(len, laws)) + 4
    said = ["mean measured flow stress and mean differences of the laws, by test and plastic strain", "",
            " " * wide + "".join(f"{name:>14}" for name, _ in columns)]
    for test in points.tests():
        own = [test[mask[test]] for _, mask in columns]
        group = f"group {points.group[test[0]]:g}, " if len(points.groups) > 1 else ""
        said.append(f"{group}{points.rate[test[0]]:g} /s, {points.temperature[test[0]]:g} K")
        rows = {"measured [MPa]": [f"{points.stress[each].mean() / 1e6:.0f}" if each.size else "" for each in own]}
        for name, residual in laws.items():
            rows[name] = [f"{residual[each].mean():+.1%}" if each.size else "" for each in own]
        said += [f"  {name:<{wide - 2}}{''.join(f'{text:>14}' for text in row)}".rstrip() for name, row in rows.items()]
    return said


def deck_table(fit: Fit, group: float) -> str:
    """The law of a group as a table of a deck or of the library, without the defaults of the model."""
    defaults = {parameter.name: parameter.default for parameter in fit.law.model.PARAMETERS}
    values = {name: value for name, value in fit.constants[group].items() if value != defaults[name]}
    inner = "".join(f", {name} = {_text(value, fit.law.unit(name))}" for name, value in values.items())
    return f'strength = {{ model = "{fit.law.name}"{inner} }}'


def _text(value: float, unit: str) -> str:
    return f'"{value / 1e6:.5g} MPa"' if unit == "Pa" else f"{value:.4g}"


def _rms(residual: np.ndarray) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def _size(residual: np.ndarray) -> str:
    return f"rms {_rms(residual):.1%}, largest {np.abs(residual).max():.1%}"


def write_csv(fit: Fit, path: Path) -> None:
    """Writes one row for each point, with all digits."""
    points = fit.points
    with replacing(path) as temporary, open(temporary, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["group", "plastic strain", "strain rate [1/s]", "temperature [K]", "measured [Pa]", "fitted [Pa]",
                         "difference"])
        for n in range(len(points)):
            fitted = float(points.stress[n] * (1.0 + fit.residual[n]))
            measured = (points.group, points.strain, points.rate, points.temperature, points.stress)
            writer.writerow([*(float(column[n]) for column in measured), fitted, float(fit.residual[n])])


def draw(fit: Fit):
    """A matplotlib Figure: a panel for each group, a colour for each rate and temperature, measured dots and fitted lines."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    groups = fit.points.groups
    figure = Figure(figsize=(3.4 * len(groups) + 0.8, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(groups), sharey=True, squeeze=False)[0]
    for axes, group in zip(panels, groups, strict=True):
        _panel(axes, fit, group)
        axes.set_title(f"group {group:g}" if len(groups) > 1 else fit.law.name, fontsize=9)
    panels[0].set_ylabel("flow stress [MPa]")
    panels[0].set_ylim(bottom=0.0)
    return figure


def _panel(axes, fit: Fit, group: float) -> None:
    from matplotlib import colormaps

    points = fit.points.chosen(fit.points.group == group)
    residual = fit.residual[fit.points.group == group]
    hottest, tests = max(points.temperature), points.tests()
    colour: Callable[[float], tuple] = colormaps["plasma"]
    for test in tests:
        T, rate = points.temperature[test[0]], points.rate[test[0]]
        shade = colour(0.85 * (T - min(points.temperature)) / max(hottest - min(points.temperature), 1.0))
        axes.plot(points.strain[test], points.stress[test] / 1e6, "o" if rate < 100.0 else "^", color=shade, ms=4)
        axes.plot(points.strain[test], points.stress[test] * (1.0 + residual[test]) / 1e6, "-", color=shade, lw=1,
                  label=f"{rate:g} /s, {T:g} K")
    axes.set_xlabel("plastic strain")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=6, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)
