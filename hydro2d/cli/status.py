"""The command `hydro2d status`: where a run stands."""

from __future__ import annotations

from pathlib import Path

from hydro2d.terminal import say


def status(run: Path) -> int:
    """Says where a run stands: time, what will end it and when, depth, dumps. A study has `hydro2d sweep STUDY --status`.

    Example: hydro2d status runs/a

    Parameters
    ----------
    run
        Run directory, of a run that has ended or is under way.
    """
    from hydro2d.results import standing
    from hydro2d.results.reading import Results
    from hydro2d.study import layout

    opened = Results(run)
    (case,) = layout.gather([run]).cases
    for line in standing.lines(opened, case.status, case.message, case.progress):
        say(line)
    return 0
