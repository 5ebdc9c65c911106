"""The command `hydro2d status`: how far a run has got."""

from __future__ import annotations

import shutil
import sys
import time
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from hydro2d.base.terminal import say
from hydro2d.cli.base import import_matplotlib

#: seconds between two looks at a run in progress
SECONDS = 2.0


def status(
    run: Path,
    *,
    quantity: list[str] | None = None,
    plot: Annotated[bool | None, Parameter(negative="--no-plot")] = None,
    watch: Annotated[bool | None, Parameter(negative="--no-watch")] = None,
) -> int:
    """Shows how far a run has got, when and why it will stop, depth and dumps. For a study: `hydro2d sweep STUDY --status`.

    On a terminal it also draws histories, and looks again every two seconds until the run has ended.

    Example: hydro2d status runs/a --quantity penetration_depth_m --quantity interface_velocity_m_s

    Parameters
    ----------
    run
        Directory of a run that has ended or is in progress.
    quantity
        Column of the history to draw; can be repeated; default: depth and tail velocity of the projectile, or velocity and
        extent of the first body.
    plot
        Draws histories as lines of bars; default: on a terminal, or with a quantity.
    watch
        Looks again every two seconds until the run has ended; default: on a terminal.
    """
    import_matplotlib()
    from hydro2d.study.records.study_directory import RUNNING

    terminal = sys.stdout.isatty()
    drawn = bool(quantity) or terminal if plot is None else plot
    output, state = _look(run, quantity, drawn)
    if state != RUNNING or not (terminal if watch is None else watch):
        _show(output)
    elif terminal:
        _live(run, quantity, drawn)
    else:
        while state == RUNNING:
            _show(output)
            time.sleep(SECONDS)
            output, state = _look(run, quantity, drawn)
        _show(output)
    return 0


def _look(run: Path, quantity: list[str] | None, drawn: bool) -> tuple[tuple[list[str], list[str]], str]:
    """The lines and the charts of a run, and its state."""
    from hydro2d.output.directory import HISTORY
    from hydro2d.results import standing, terminal_charts
    from hydro2d.results.reading import Results
    from hydro2d.study.records import study_directory

    opened = Results(run)
    (case,) = study_directory.gather([run]).cases
    lines = standing.lines(opened, case.status, case.message, case.progress)
    charts: list[str] = []
    if drawn and (opened.directory / HISTORY).exists():
        charts = terminal_charts.charts(opened, quantity or terminal_charts.chosen(opened), shutil.get_terminal_size().columns)
    return (lines, charts), case.status


def _show(output: tuple[list[str], list[str]]) -> None:
    """Prints lines and charts."""
    for line in (*output[0], *output[1]):
        say(line, flush=True)


def _live(run: Path, quantity: list[str] | None, drawn: bool) -> None:
    """Shows a run in place until it has ended."""
    from rich.console import Group
    from rich.live import Live
    from rich.text import Text

    from hydro2d.base.formats import one_line
    from hydro2d.study.records.study_directory import RUNNING

    state = RUNNING
    with Live(auto_refresh=False, vertical_overflow="visible") as live:
        while True:
            (lines, charts), state = _look(run, quantity, drawn)
            live.update(Group(*(Text(one_line(line)) for line in (*lines, *charts))), refresh=True)
            if state != RUNNING:
                return
            time.sleep(SECONDS)
