"""The command `hydro2d report`: runs and studies as one page."""

from __future__ import annotations

from pathlib import Path

from hydro2d.cli.base import Out, import_matplotlib


def report(
    directories: list[Path],
    *,
    out: Out | None = None,
    x: str | None = None,
    y: list[str] | None = None,
    by: list[str] | None = None,
    movie: str | None = None,
    view: bool = False,
    trust: bool = False,
) -> int:
    """Writes a report of a study or of runs: one HTML page with figures that zoom, a table as CSV and pictures as PNG.

    Example: hydro2d report runs/velocity_advection --y penetration_depth_m --y crater.volume_m3 --by advection

    Parameters
    ----------
    directories
        A study directory in any state, a folder of run directories, or several run directories.
    out
        Folder to write to; default: `report` in the first directory.
    x
        Horizontal axis of the figures: an axis of the study, velocity (of impact), a deck key or a number in summary.json;
        default: the impact velocity where it varies, else the first numeric axis of the study, else its first axis.
    y
        Vertical axis of a figure: a number in summary.json; can be repeated; default: depth, and the residual velocity where
        something perforates; without a projectile, velocity and extent of the first body.
    by
        What distinguishes the series of runs, named as for --x; can be repeated; default: everything else that is varied.
    movie
        Field to show in a small film of each run with dumps, as `hydro2d movie` makes; takes seconds to minutes per run.
    view
        Makes the page of `hydro2d view` for each run with dumps. The report always links to existing pages.
    trust
        Runs the code of outside models that the decks of the runs carry, for the analytic models. Use it only for runs whose
        origin you know.
    """
    import_matplotlib()
    from hydro2d.study.report.report import report as write

    write(directories, out, x=x, y=y or (), by=by or (), movie=movie, view=view, trust=trust)
    return 0
