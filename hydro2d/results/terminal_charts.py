"""Histories drawn with characters, for `hydro2d status` in a terminal: a line of bars over time for each."""

from __future__ import annotations

import numpy as np

from hydro2d.base.errors import Error, unknown
from hydro2d.base.formats import shown
from hydro2d.base.units import reader_unit
from hydro2d.output import history

#: columns drawn for a run with a projectile and a target, and for the first body of any other run
OF_PROJECTILE, OF_BODY = ("penetration_depth_m", "rod_tail_velocity_m_s"), ("velocity_m_s", "z_max_m")
#: bars from the smallest to the largest value, and their smallest and largest number
BARS, LEAST, MOST = "▁▂▃▄▅▆▇█", 20, 80
#: characters of a line beside the bars
BESIDE = 60


class ChartError(Error):
    """A history that cannot be drawn in a terminal; the message is for the user."""


def chosen(run) -> list[str]:
    """The columns of a run (results.Results) that are drawn by default."""
    columns = [name for name in OF_PROJECTILE if np.isfinite(run.history.get(name, np.nan)).any()]
    bodies = [body["name"] for body in run.bodies if "join" not in body]
    return columns or [f"body_{bodies[0]}_{key}" for key in OF_BODY if bodies and f"body_{bodies[0]}_{key}" in run.history]


def charts(run, names: list[str], width: int) -> list[str]:
    """A line for each of these history columns of a run: its name, bars over time, and its range.

    width : of the terminal, characters

    Raises ChartError for an unknown column.
    """
    for name in names:
        if name not in run.history:
            raise ChartError(f"{run.directory}: {unknown('quantity', name, run.history)}")
    return [_chart(name, run.history["time"], run.history[name].astype(float), width) for name in names]


def _chart(name: str, time: np.ndarray, values: np.ndarray, width: int) -> str:
    unit, factor = reader_unit(history.unit(name))
    known, said = np.isfinite(values), shown(history.spoken(name))
    if known.sum() < 2:
        return f"{said}: nothing to draw yet"
    time, values = time[known], factor * values[known]
    count = min(max(width - BESIDE, LEAST), MOST)
    at = np.interp(np.linspace(time[0], time[-1], count), time, values)
    low, high = float(values.min()), float(values.max())
    heights = np.rint((at - low) / (high - low) * (len(BARS) - 1)) if high > low else np.zeros(count)
    bars = "".join(BARS[int(height)] for height in heights)
    of = "" if unit == "1" else f" {unit}"
    return f"{said} {bars} {low:.4g} to {high:.4g}{of}, {1e6 * time[0]:.4g} to {1e6 * time[-1]:.4g} µs"
