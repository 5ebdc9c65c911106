"""The progress of a run in a notebook: a bar and a table below the cell, renewed in place, and at the end the closing lines."""

from __future__ import annotations

import html
import sys
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hydro2d.running.progress import TABLE_SECONDS, Report, values
from hydro2d.terminal import shown


def is_notebook() -> bool:
    """Whether this process is the kernel of a notebook, which shows HTML."""
    found = sys.modules.get("IPython")
    shell = found.get_ipython() if found is not None else None
    return shell is not None and hasattr(shell, "kernel")


class Page:
    """What stands below the cell, as HTML for notebooks and as text for what shows no HTML."""

    def __init__(self, lines: list[str], done: float | None = None, table: dict[str, str] | None = None):
        self._lines, self._done, self._table = lines, done, table or {}

    def __repr__(self) -> str:
        return "\n".join([*map(shown, self._lines), *(f"{name}  {value}" for name, value in self._table.items())])

    def _repr_html_(self) -> str:
        text = html.escape("\n".join(map(shown, self._lines)))
        parts = [f"<pre>{text}</pre>"] if text else []
        if self._table:
            share = "" if self._done is None else f' value="{self._done:.4f}"'
            rows = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(shown(value))}</td></tr>"
                           for name, value in self._table.items())  # fmt: skip
            parts.append(f'<progress max="1"{share} style="width: 30em" aria-label="share of the run that is done"></progress>'
                         f"<table>{rows}</table>")  # fmt: skip
        return "".join(parts)


class Notebook(Report):
    """Writes the log and, unless quiet, shows what a terminal shows: warnings, a bar and a table, and the closing lines."""

    def __init__(self, log, quiet: bool, gone: Callable[[], None] = lambda: None):
        from IPython.display import display

        super().__init__(log, quiet, gone)
        self._lines: list[str] = []
        self._drawn = 0.0
        self._place = None if quiet else display(Page(["starting"]), display_id=True)

    def show(self, text: str) -> None:
        self._lines.append(text)
        self._draw(Page(self._lines))

    def begin(self, run) -> None:
        with self._only_log():
            super().begin(run)
        for text in (run.deck.title or run.deck.name, *(f"warning: {text}" for text in run.warnings)):
            self.show(text)

    def status(self, shown: dict[str, str]) -> None:
        with self._only_log():  # the table shows it
            super().status(shown)

    def update(self, run) -> None:
        super().update(run)
        now = clock.perf_counter()
        if self._place is not None and now - self._drawn >= TABLE_SECONDS:
            self._drawn = now
            outlook = run.clock.look(run.sim)
            self._draw(Page(self._lines, outlook.share, values(run, outlook)))

    @contextmanager
    def _only_log(self) -> Iterator[None]:
        """Within the block nothing is shown."""
        lines, place = self._lines, self._place
        self._lines, self._place = [], None
        yield
        self._lines, self._place = lines, place

    def _draw(self, page: Page) -> None:
        if self._place is not None:
            self._place.update(page)
