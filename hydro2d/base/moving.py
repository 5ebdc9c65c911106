"""A progress line for slow work: redrawn on a terminal or below the cell of a notebook, elsewhere printed now and then.

It is shown when a program calls the solver. A run has its own report (`running/progress.py`) with the same two methods.
"""

from __future__ import annotations

import shutil
import sys
import time
from typing import Protocol

from hydro2d.base.formats import in_html, one_line, shown
from hydro2d.base.terminal import say

#: seconds between lines where they cannot be redrawn
LINE_SECONDS = 5.0
#: width of a bar on a terminal, characters
BAR = 30


class Place(Protocol):
    """A place where the line is shown."""

    def move(self, text: str, share: float | None) -> None:
        """Shows the state; share : of the work that is done, 0 to 1, None if not known."""

    def rest(self, text: str) -> None:
        """Ends the line, for now or for good; ``text`` says what was done."""


class Lines:
    """A line on the error output every few seconds."""

    def __init__(self) -> None:
        self._last = float("-inf")

    def move(self, text: str, share: float | None) -> None:
        now = time.monotonic()
        if now - self._last >= LINE_SECONDS:
            self._last = now
            say(text, file=sys.stderr, flush=True)

    def rest(self, text: str) -> None:
        pass


class Terminal:
    """One line of the error output with a bar, redrawn in place and erased when it rests."""

    def move(self, text: str, share: float | None) -> None:
        width = shutil.get_terminal_size().columns - 1
        bar = "" if share is None else f"  [{'#' * round(share * BAR):-<{BAR}}]"
        self._write(f"{one_line(text)}{bar}"[:width])

    def rest(self, text: str) -> None:
        self._write("")

    def _write(self, text: str) -> None:
        sys.stderr.write(f"\r{text}\x1b[K")
        sys.stderr.flush()


class Page:
    """The output below a cell: HTML for notebooks, text for programs that show no HTML.

    lines : of text;  done : share for a bar, 0 to 1, None: not known;  table : values by name;  bar : whether there is a bar
    """

    def __init__(self, lines: list[str], done: float | None = None, table: dict[str, str] | None = None, bar: bool = False):
        self._lines, self._done, self._table, self._bar = lines, done, table or {}, bar

    def __repr__(self) -> str:
        return "\n".join([*map(shown, self._lines), *(f"{name}  {value}" for name, value in self._table.items())])

    def _repr_html_(self) -> str:
        text = in_html("\n".join(self._lines))
        parts = [f"<pre>{text}</pre>"] if text else []
        if self._table or self._bar:
            share = "" if self._done is None else f' value="{self._done:.4f}"'
            parts.append(f'<progress max="1"{share} style="width: 30em" aria-label="share that is done"></progress>')
        if self._table:
            rows = "".join(f"<tr><th>{in_html(name)}</th><td>{in_html(value)}</td></tr>"
                           for name, value in self._table.items())
            parts.append(f"<table>{rows}</table>")
        return "".join(parts)


class Notebook:
    """A line and a bar below the cell that is running when they first appear."""

    def __init__(self) -> None:
        self._place = None

    def move(self, text: str, share: float | None) -> None:
        self._draw(Page([text], share, bar=True))

    def rest(self, text: str) -> None:
        self._draw(Page([text]))
        self._place = None

    def _draw(self, page: Page) -> None:
        from IPython.display import display

        if self._place is None:
            self._place = display(page, display_id=True)
        else:
            self._place.update(page)


def is_notebook() -> bool:
    """Whether this process is the kernel of a notebook, which can show HTML."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def place() -> Place:
    """The place for a program that uses hydro2d as a library."""
    if is_notebook():
        return Notebook()
    return Terminal() if sys.stderr is not None and sys.stderr.isatty() else Lines()
