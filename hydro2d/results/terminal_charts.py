"""Histories drawn with characters, for `hydro2d status` in a terminal. They need plotext, not installed with hydro2d."""

from __future__ import annotations

from importlib import metadata

import numpy as np

from hydro2d.base.errors import Error, unknown
from hydro2d.base.formats import shown
from hydro2d.output import history
from hydro2d.results.figures import reader_unit

#: columns drawn for a run with a projectile and a target, and for the first body of any other run
OF_PROJECTILE, OF_BODY = ("penetration_depth_m", "rod_tail_velocity_m_s"), ("velocity_m_s", "z_max_m")
#: height of a chart in lines, and its smallest and largest width in characters
LINES, LEAST, MOST = 12, 40, 100
MISSING = "a history in the terminal needs plotext 5, which is not installed: pip install 'hydro2d[terminal]'"


class ChartError(Error):
    """A history that cannot be drawn in a terminal; the message is for the user."""


def available() -> bool:
    """Whether plotext is installed, in the version whose functions are used here."""
    try:
        return metadata.version("plotext").startswith("5.")
    except metadata.PackageNotFoundError:
        return False


def chosen(run) -> list[str]:
    """The columns of a run (results.Results) that are drawn by default."""
    columns = [name for name in OF_PROJECTILE if np.isfinite(run.history.get(name, np.nan)).any()]
    bodies = [body["name"] for body in run.bodies if "join" not in body]
    return columns or [f"body_{bodies[0]}_{key}" for key in OF_BODY if bodies and f"body_{bodies[0]}_{key}" in run.history]


def charts(run, names: list[str], width: int) -> list[str]:
    """Lines of text with charts of history columns of a run over time, one below the other.

    width : of the terminal, characters

    Raises ChartError without plotext, and for an unknown column.
    """
    if not available():
        raise ChartError(MISSING)
    lines: list[str] = []
    for name in names:
        if name not in run.history:
            raise ChartError(f"{run.directory}: {unknown('quantity', name, run.history)}")
        lines += _chart(name, run.history["time"], run.history[name].astype(float), width)
    return lines


def _chart(name: str, time: np.ndarray, values: np.ndarray, width: int) -> list[str]:
    import plotext

    unit, scale = reader_unit(history.unit(name))
    known = np.isfinite(values)
    if known.sum() < 2:
        return [f"{shown(history.spoken(name))}: nothing to draw yet"]
    plotext.clear_figure()
    plotext.theme("clear")
    plotext.plotsize(min(max(width, LEAST), MOST), LINES)
    plotext.plot((1e6 * time[known]).tolist(), (scale * values[known]).tolist(), marker="braille")
    plotext.title(shown(history.spoken(name)) + (f" [{unit}]" if unit != "1" else "") + " over time [us]")
    return plotext.uncolorize(plotext.build()).splitlines()
