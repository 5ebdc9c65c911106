"""The command `hydro2d report`: runs and studies as one page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter


def report(
    directories: Annotated[list[Path], Parameter(negative="")],
    *,
    out: Path | None = None,
    x: str | None = None,
    y: Annotated[list[str] | None, Parameter(negative="")] = None,
    by: Annotated[list[str] | None, Parameter(negative="")] = None,
    movie: str | None = None,
) -> int:
    """Reports a study or runs: one HTML page with figures to zoom into, a table as CSV and pictures as PNG.

    Example: hydro2d report runs/rigid_rod_laws --y penetration_depth_m --y crater.volume_m3 --by law

    Parameters
    ----------
    directories
        A study directory in any state, a folder of run directories, or several run directories.
    out
        Folder that is written into; default: `report` in the first directory.
    x
        What the figures have below: an axis of the study, velocity (of impact), a key of the decks or a number of
        summary.json; default: the impact velocity where it varies, else the first axis of numbers, else the first axis.
    y
        Number of summary.json that is drawn, may be given several times; default: depth, and the residual velocity where
        something perforates; without a projectile, velocity and extent of the first body.
    by
        What tells the series of runs apart, named as x; may be given several times; default: whatever else is varied.
    movie
        Field of which each run with dumps gets a small film in the page, as of `hydro2d movie`; takes seconds to minutes a run.
    """
    from hydro2d.study.report import report as write

    write(directories, out, x=x, y=y or (), by=by or (), movie=movie)
    return 0
