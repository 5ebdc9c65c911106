"""The files of a search with a budget: its shots as CSV, and a picture of them with the fitted curves."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hydro2d.files.strange import own
from hydro2d.files.whole import write_text
from hydro2d.results import figures
from hydro2d.results.figures import verbatim
from hydro2d.study.plan import draws
from hydro2d.study.records import table
from hydro2d.study.records.study_directory import Study
from hydro2d.study.search import ballistic, v50
from hydro2d.study.search.regimes import Transitions

CSV, PICTURE = "transition.csv", "transition.png"
#: panels in a row; width and height of one, inches; points of a curve; distance of dots of the same velocity, in probability
COLUMNS, SIZE, POINTS, APART = 3, (5.2, 3.6), 300, 0.035


def write(study: Study, results: Sequence[Transitions]) -> list[Path]:
    """Writes both files into the directory of a study and returns them. Raises OSError, FigureError."""
    files = [own(study.directory / name) for name in (CSV, PICTURE)]
    import pandas

    tables = [_table(study, each) for each in results]
    write_text(files[0], table.to_csv(pandas.concat(tables)))
    figures.save_figure(draw(results), files[1])
    return files


def _table(study: Study, result: Transitions):
    """The shots of a combination with its labels, their changes and the fitted probability: the rows of the CSV.

    A change is None for a shot that has not begun.
    """
    estimate, cases = result.estimate, {case.name: case for case in study.cases}
    decks = [cases[name].deck or {} for name in estimate.shots["case"]]
    shots = estimate.shots[["case", "velocity_m_s", "regime"]].rename(columns={"regime": "outcome"})
    for name, value in reversed((result.values | {"transition": estimate.name, "shot": range(1, len(shots) + 1)}).items()):
        shots.insert(0, name, value)
    for column, (section, name) in ((column, key.split(".")) for column, key in draws.KEYS.items()):
        shots[column] = [deck.get(section, {}).get(name) for deck in decks]
    speeds = shots["velocity_m_s"].to_numpy(float)
    if estimate.ballistic:
        shots["residual_velocity_m_s"] = estimate.shots["residual_velocity_m_s"]
        shots["fitted_residual_velocity_m_s"] = estimate.limit.residual(speeds) if estimate.limit else None
    return shots.assign(fitted_probability=estimate.fit.probability(speeds) if estimate.fit else None)


def draw(results: Sequence[Transitions]):
    """A figure with a panel for each combination: shots as dots, probability of the outcome of fast shots, its 90 % band.

    A ballistic limit that is known has a panel of its own before it, with the residual velocities.
    """
    panels = [(part, each) for each in results for part in ([_residuals] if each.estimate.limit else []) + [_panel]]
    columns = min(len(panels), COLUMNS)
    rows = -(-len(panels) // columns)
    figure, axes = figures.new_figure(SIZE[0] * columns, SIZE[1] * rows, rows, columns)
    for place, (part, each) in zip(axes.flat, panels, strict=False):
        part(place, each)
    for place in axes.flat[len(panels) :]:
        place.set_visible(False)
    return figure


def _residuals(axes, result: Transitions) -> None:
    """Residual velocities of the shots, the fitted curve, and the ballistic limit with its interval."""
    each, limit = result.estimate, result.estimate.limit
    left = ballistic.residuals(each.known)
    speeds = each.known.loc[left.index, "velocity_m_s"].to_numpy(float)
    for colour, of in (("C1", left == 0.0), ("C2", left > 0.0)):
        axes.plot(speeds[of], left[of], "o", markersize=3.5, color=colour, alpha=0.8)
    low, high = axes.get_xlim()
    curve = np.union1d(np.linspace(low, high, POINTS), limit.limit_velocity)
    axes.plot(curve, limit.residual(curve), color="C0", linewidth=1.4, label="Lambert-Jonas")
    axes.axvspan(limit.low, limit.high, color="C0", alpha=0.2, linewidth=0, label="90 % interval")
    axes.axvline(limit.limit_velocity, color="C0", linestyle="--", linewidth=1.0, label=f"limit {limit.limit_velocity:.1f} m/s")
    axes.set_xlim(low, high)
    axes.set_ylabel("residual velocity [m/s]", fontsize=8)
    _finish(axes, f"{result.title}: {each.name}", "upper left")


def _finish(axes, title: str, place: str) -> None:
    """Title, abscissa, grid and legend of a panel."""
    axes.set_xlabel("impact velocity [m/s]", fontsize=8)
    axes.set_title(verbatim(title), fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.3)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, loc=place)


def _panel(axes, result: Transitions) -> None:
    each = result.estimate
    slow, fast = each.outcomes
    _dots(axes, each)
    if each.fit is not None:
        low, high = axes.get_xlim()
        speeds = np.linspace(low, high, POINTS)
        axes.fill_between(speeds, *each.fit.band(speeds), color="C0", alpha=0.2, linewidth=0, label="90 % band")
        axes.plot(speeds, each.fit.probability(speeds), color="C0", linewidth=1.4, label=f"v50 = {each.fit.v50:.1f} m/s")
        ends = [end for end in (each.fit.v50_low, each.fit.v50_high) if end is not None]
        axes.plot(ends, [0.5] * len(ends), color="black", linewidth=1.2, marker="|")
        axes.set_xlim(low, high)
    if each.military is not None:
        label = f"MIL-STD-662F {each.military[0]:.1f} m/s"
        axes.axvline(each.military[0], color="C3", linestyle="--", linewidth=1.0, label=label)
    axes.set_ylim(-0.22, 1.22)
    axes.set_yticks([0.0, 0.5, 1.0], [verbatim(f"{slow}  0"), "0.5", verbatim(f"{fast}  1")], fontsize=7)
    _finish(axes, f"{result.title}: {v50.V50 if each.limit else each.name}", "center right")


def _dots(axes, each: v50.Estimate) -> None:
    """The shots; those of nearly one velocity are stacked away from the curve."""
    known = each.known.sort_values("velocity_m_s", kind="stable")
    near = np.ptp(known["velocity_m_s"].to_numpy(float)) / 120.0 if len(known) else 1.0
    counts: Counter = Counter()
    for speed, outcome in zip(known["velocity_m_s"], known["regime"], strict=True):
        up = outcome == each.outcomes[1]
        bin_of = (up, round(speed / near) if near else 0)
        height = (1.0 if up else 0.0) + (APART if up else -APART) * (1 + counts[bin_of])
        counts[bin_of] += 1
        axes.plot(speed, np.clip(height, -0.19, 1.19), "o", markersize=3.5, color="C2" if up else "C1", alpha=0.8)
