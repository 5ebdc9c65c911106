"""A fit of a strength model to measured flow stresses as text, file and figure."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np

from hydro2d.files.whole import replacing
from hydro2d.materials.fitting import Fit


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
    for title, values, form in (("strain rate [1/s]", points.rate, "g"), ("temperature [K]", points.temperature, "g"),
                                ("plastic strain", points.strain, "g")):
        said += ["", f"{title:<20}  points  mean difference   rms   largest"]
        for value in np.unique(values):
            own = fit.residual[values == value]
            said.append(f"{value:<20{form}}  {own.size:>6}  {own.mean():>+15.1%}  {_rms(own):>4.1%}  {np.abs(own).max():>8.1%}")
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
