"""The page of one or two runs: the files of `assets` and the contents of the runs, combined into one HTML file."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path

from hydro2d.base.formats import in_html, in_script
from hydro2d.base.version import __version__
from hydro2d.files.whole import write_text
from hydro2d.results.figures import BODY_COLOURS
from hydro2d.results.viewer.field_arrays import CLIPS, ViewError
from hydro2d.results.viewer.packing import BITS, DEFAULT_BITS
from hydro2d.results.viewer.page_contents import contents

PAGE = "view.html"
#: the parts of the program, in order
SCRIPTS = (
    "data.js", "colours.js", "axes.js", "outlines.js", "section.js", "gestures.js", "panels.js", "controls.js", "main.js",
)
#: colour maps that the page offers, by their names in matplotlib; the last is for fields with negative values
MAPS = ("viridis", "cividis", "inferno", "gray", "RdBu_r")
COLOURS = 256
#: height of the page in a notebook, pixels
HEIGHT = 820


class View:
    """The page of one or two runs; a notebook shows it. `save` writes it to a file.

    Attributes
    ----------
    html : str
        The page, which needs no other file and no network.
    """

    def __init__(self, html: str):
        self.html = html

    def save(self, path: Path | str) -> Path:
        """Writes the page to a file and returns its path."""
        write_text(Path(path), self.html)
        return Path(path)

    def __repr__(self) -> str:
        return f"<View: a page of {len(self.html) / 1e6:.1f} MB; save(FILE) writes it>"

    def _repr_html_(self) -> str:
        style = f"width: 100%; height: {HEIGHT}px; border: 0"
        return f'<iframe title="hydro2d view" style="{style}" srcdoc="{html.escape(self.html)}"></iframe>'


def view(runs: Sequence, words: Iterable[str] = ("all",), bits: int = DEFAULT_BITS) -> View:
    """The page of one run, or of two side by side (results.Results).

    words : fields as `hydro2d info` names them, or groups of them, stored in addition to material and volume fractions
    bits : bits of each value, one of packing.BITS

    Raises ViewError, FieldError, VtkError, HistoryError.
    """
    if not 1 <= len(runs) <= 2:
        raise ViewError(f"a page shows one run, or two side by side: {len(runs)} are given")
    if bits not in BITS:
        raise ViewError(f"{bits} bits for a value: must be {', '.join(map(str, BITS))}")
    words = list(words)
    packed = [contents(run, words, bits) for run in runs]
    about = {
        "made": f"hydro2d {__version__}, {datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        "clips": CLIPS,
        "body_colours": [[int(colour[place : place + 2], 16) for place in (1, 3, 5)] for colour in BODY_COLOURS],
        "maps": {name: _colours(name) for name in MAPS},
        "runs": [table for table, _ in packed],
    }
    parts = {
        "title": in_html(" and ".join(run.label for run in runs)),
        "style": _asset("page.css"),
        "contents": _json(about),
        "numbers": "\n".join(f'<script type="text/plain" class="numbers">{text}</script>' for _, text in packed),
        "program": "\n".join(map(_asset, SCRIPTS)),
    }
    return View(re.sub(r"\{\{(\w+)\}\}", lambda place: parts[place[1]], _asset("page.html")))


def _asset(name: str) -> str:
    return resources.files(__package__).joinpath("assets", name).read_text(encoding="utf-8")


def _json(value) -> str:
    """JSON that cannot end the element of the page that holds it. Raises ViewError for what is not finite."""
    try:
        return in_script(value)
    except ValueError:
        raise ViewError("a run has times, edges of its mesh or a deck that are not finite numbers") from None


def _colours(name: str) -> str:
    """The colours of a map as a string of six-digit hexadecimal numbers."""
    from matplotlib import colormaps

    table = colormaps[name].resampled(COLOURS)
    return "".join(f"{round(255 * part):02x}" for number in range(COLOURS) for part in table(number)[:3])
