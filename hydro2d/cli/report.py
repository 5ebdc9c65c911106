"""The command `hydro2d report`: runs and studies as one page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter


def report(directories: Annotated[list[Path], Parameter(negative="")], *, out: Path | None = None) -> int:
    """Reports a study or runs: one HTML page, a table as CSV and the figures as PNG.

    Example: hydro2d report runs/rigid_rod_laws --out rigid_rod_laws_report

    Parameters
    ----------
    directories
        A study directory in any state, a folder of run directories, or several run directories.
    out
        Folder that is written into; default: `report` in the first directory.
    """
    from hydro2d.study.report import report as write

    write(directories, out)
    return 0
