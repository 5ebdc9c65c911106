"""Which report of its progress a run makes: for a terminal, for a notebook, or for neither."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hydro2d.running.notebook import Notebook, is_notebook
from hydro2d.running.progress import Live, Report
from hydro2d.strange import opened
from hydro2d.terminal import one_line


def _kind() -> type[Report]:
    """The kind of report for the output of this process."""
    if is_notebook():
        return Notebook
    return Live if sys.stdout.isatty() else Report


@contextmanager
def reporter(log: Path, quiet: bool, gone: Callable[[], None] = lambda: None) -> Iterator[Report]:
    """The report for this kind of output; it appends to the log. ``gone`` is called when the reader of the output has gone."""
    with opened(log, "a") as file:
        kind = _kind() if not quiet else Report
        report = kind(file, quiet, gone)
        try:
            yield report
        except Exception as error:
            report.close()
            file.write(one_line(f"stopped by {type(error).__name__}: {error}") + "\n")
            raise
        finally:
            report.close()
