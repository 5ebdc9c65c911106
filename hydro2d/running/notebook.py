"""The progress of a run in a notebook: a bar and a table below the cell, updated in place, and finally the closing lines."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hydro2d.base.moving import Page
from hydro2d.running.progress import TABLE_SECONDS, Report, values


class Notebook(Report):
    """Writes the log and, unless quiet, shows warnings, a bar and a table, and the closing lines, as a terminal does."""

    def __init__(self, log, quiet: bool, gone: Callable[[], None] = lambda: None):
        from IPython.display import display

        super().__init__(log, quiet, gone)
        self._lines: list[str] = []
        self._drawn = 0.0
        self._place = None if quiet else display(Page(["starting"]), display_id=True)

    def show(self, text: str) -> None:
        self._lines.append(text)
        self._draw(Page(self._lines))

    def move(self, text: str, share: float | None) -> None:
        self._draw(Page([*self._lines, text], share, bar=True))

    def rest(self, text: str) -> None:
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
        """Shows nothing within the block."""
        lines, place = self._lines, self._place
        self._lines, self._place = [], None
        yield
        self._lines, self._place = lines, place

    def _draw(self, page: Page) -> None:
        if self._place is not None:
            self._place.update(page)
