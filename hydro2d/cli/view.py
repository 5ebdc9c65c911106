"""The command `hydro2d view`: a page that shows one or two runs."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from hydro2d.base.terminal import say
from hydro2d.cli.base import Out, import_matplotlib

#: environment variables of which a browser with windows needs one
DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY")


def view(
    runs: list[Path],
    *,
    out: Out | None = None,
    fields: Annotated[list[str] | None, Parameter(consume_multiple=True)] = None,
    bits: Literal[8, 10, 12, 14, 16] = 14,
    open_: Annotated[bool, Parameter(name="--open", negative="--no-open")] = True,
) -> int:
    """Shows a run, or two side by side, in the browser: one HTML page with all dumps, which needs no server and no network.

    A run that has not ended is shown as far as it has got; repeat the command to update the page.

    Example: hydro2d view runs/a runs/b -o both.html --fields pressure von_mises

    Parameters
    ----------
    runs
        Run directory, or two of them.
    out
        The page; default: `view.html` in the first run directory.
    fields
        Fields in the page, in addition to material and volume fractions, as `hydro2d info` names them; default: all.
    bits
        Bits of each value. With 8 the page is smallest, and numbers may be off by 0.2 % of the range of their field at a time;
        with 14, by 0.003 %. The page states this.
    open_
        Opens the page in the browser, if there is a display. `--no-open` only writes it.
    """
    import_matplotlib()
    from hydro2d.files.strange import own
    from hydro2d.results.reading import Results
    from hydro2d.results.viewer import page

    opened = [Results(path) for path in runs]
    file = out or own(runs[0] / page.PAGE)
    page.view(opened, fields or ("all",), bits).save(file)
    say(f"wrote {file}, {file.stat().st_size / 1e6:.1f} MB")
    if open_ and not _open(file):
        say("no browser was opened: open the file in one, here or on another machine")
    return 0


def _open(file: Path) -> bool:
    """Opens a page in a browser with windows; False if there is none. A browser in the terminal could not show it."""
    import webbrowser

    shows = sys.platform in ("win32", "darwin") or any(os.environ.get(name) for name in DISPLAYS)
    return shows and webbrowser.open(file.absolute().as_uri())
