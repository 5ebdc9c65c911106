"""Chooses the progress report of a run: for a terminal, for a notebook, or for neither."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from hydro2d.base.moving import is_notebook
from hydro2d.files.strange import opened
from hydro2d.running.notebook import Notebook
from hydro2d.running.progress import Live, Report


def _kind() -> type[Report]:
    """The kind of report for the output of this process."""
    if is_notebook():
        return Notebook
    return Live if sys.stdout.isatty() else Report


@contextmanager
def reporter(log: Path, quiet: bool, gone: Callable[[], None] = lambda: None) -> Iterator[Report]:
    """The report for this kind of output; it appends to the log. ``gone`` is called when the reader of the output has gone."""
    file = opened(log, "a")
    report = (Report if quiet else _kind())(file, quiet, gone)
    try:
        yield report
    except Exception as error:
        report.close()
        with suppress(OSError):  # the error that stopped the run is reported anyway
            report.note(f"stopped by {type(error).__name__}: {error}")
        raise
    finally:
        report.close()
        with suppress(OSError):  # lines that could not be written have been reported
            file.close()
