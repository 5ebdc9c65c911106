"""What a report takes from one run: its deck and shot, its history, the rod's outline at the end."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hydro2d.analytic import model_deck
from hydro2d.deck import deck as decks
from hydro2d.errors import DeckError
from hydro2d.output import history, vtk
from hydro2d.running.run import DECK, HISTORY
from hydro2d.solver import penetrator
from hydro2d.study.layout import DONE, Case

#: columns of the history that are drawn, and the most points of a line
DRAWN = ("penetration_depth_m", "rod_tail_velocity_m_s", "rod_length_m")
POINTS = 300


class Setup(NamedTuple):
    """What an experiment and an analytic model are about: materials, nose and the geometry in m."""

    rod: str
    target: str
    nose: str
    diameter: float
    length: float
    thickness: float | None

    @property
    def words(self) -> str:
        plate = f"{self.thickness * 100:.4g} cm of {self.target}" if self.thickness else self.target
        return f"{self.nose} {self.rod} rod ({self.length * 100:.4g} cm x {self.diameter * 1000:.4g} mm) into {plate}"


class Place(NamedTuple):
    """The rod's number in files of outlines, the target's original surface in m, and the direction of flight."""

    slot: int
    surface: float
    direction: int

    def outlines(self, file: Path) -> list[np.ndarray]:
        """The rod's lines as radius and depth below the surface, (n, 2) in m. Raises VtkError."""
        lines = [line for body, line in vtk.read_lines(file) if body == self.slot]
        return [np.column_stack([line[:, 0], self.direction * (line[:, 1] - self.surface)]) for line in lines]


@dataclass
class Record:
    """One case, read; ``problems`` says what could not be. Outlines are radius and depth below the surface, (n, 2) in m."""

    case: Case
    deck: dict = field(default_factory=dict)
    shot: model_deck.Shot | None = None
    setup: Setup | None = None
    history: dict[str, np.ndarray] = field(default_factory=dict)
    first: dict[str, float] = field(default_factory=dict)
    last: dict[str, float] = field(default_factory=dict)
    start: list[np.ndarray] = field(default_factory=list)
    rod: list[np.ndarray] = field(default_factory=list)
    deepest: float = 0.0
    problems: list[str] = field(default_factory=list)

    @property
    def velocity(self) -> float | None:
        """Impact velocity, m/s."""
        return self.shot.velocity if self.shot else None

    @property
    def done(self) -> bool:
        return self.case.status == DONE

    @cached_property
    def experiment(self) -> dict:
        """The experiment that the deck names, where it has a depth."""
        found = self.deck.get("experiment") or {}
        return found if found.get("penetration") else {}

    @property
    def perforated(self) -> bool:
        """Whether the rod went through the target at any time, even if it has left the mesh since.

        Not where it came to rest, or turned round, with its nose beyond the rear: in a bulge, or stuck in its hole.
        """
        if "exit_time_s" in self.case.summary:
            rested = (self.case.summary.get("stop_reason") or "").startswith(("speed of", "rebound of"))
            return self.case.summary["exit_time_s"] is not None and not rested
        thickness = self.setup.thickness if self.setup else None
        return thickness is not None and max(self.deepest, self.value("penetration_depth_m") or 0.0) >= thickness

    @property
    def left(self) -> bool:
        """Whether the rod left the mesh."""
        return self.value("regime") == penetrator.LEFT

    @property
    def at_least(self) -> bool:
        """Whether the rod would have gone deeper than `depth`: it went through the target, or left the mesh."""
        return self.perforated or self.left

    @property
    def depth(self) -> float | None:
        """Penetration depth, m; the target's thickness where that was perforated."""
        return self.setup.thickness if self.perforated else self.value("penetration_depth_m")

    def value(self, name: str):
        """A result of the summary; of a run without one, the last of its history. None where there is neither."""
        found = self.case.summary.get(name)
        return found if found is not None else self.last.get(name)


def read(case: Case) -> Record:
    """Reads a case; what cannot be read is told in its problems and left out."""
    record = Record(case)
    if not (case.directory / DECK).is_file():
        return record
    place = _read_deck(record)
    _read_history(record)
    if place is not None:
        _read_rod(record, place)
    return record


def _read_deck(record: Record) -> Place | None:
    """Fills in deck, shot and setup. Returns where the rod is found, None where there is no rod."""
    file = record.case.directory / DECK
    try:
        text = file.read_text(encoding="utf-8")
        record.deck = tomllib.loads(text)
        deck = decks.loads(text, name=record.case.name.replace("/", "_"))
        if deck.penetration is None:
            return None
        record.shot, rod = model_deck.shot(deck), decks.body(deck, deck.penetration.rod)
    except (OSError, ValueError) as error:
        record.problems.append(f"{file} cannot be read: {error}")
        return None
    except DeckError as error:
        record.problems.append(f"the deck is not one of a rod and a target: {str(error).splitlines()[0]}")
        return None
    thickness = record.shot.values.get("target.thickness")
    record.setup = Setup(record.shot.rod.name, record.shot.target.name, record.shot.nose, 2.0 * rod.rod_radius, rod.length,
                         thickness.value if thickness else None)  # fmt: skip
    return Place(decks.slots(deck).index(rod.join or rod.name) + 1, decks.surface(deck), rod.direction)


def _read_history(record: Record) -> None:
    """Fills in the drawn columns, thinned, and the first and last row."""
    file = record.case.directory / HISTORY
    if not file.is_file():
        if record.done:
            record.problems.append(f"there is no {HISTORY}")
        return
    try:
        columns = history.read(file)
    except history.HistoryError as error:
        record.problems.append(str(error))
        return
    rows = len(columns.get("time", ()))
    if rows == 0 or any(len(column) != rows for column in columns.values()):
        record.problems.append(f"{file} has no rows" if rows == 0 else f"{file}: its columns differ in length")
        return
    chosen = np.unique(np.linspace(0, rows - 1, min(rows, POINTS)).astype(int))
    record.history = {name: columns[name][chosen] for name in ("time", *DRAWN) if name in columns}
    record.deepest = float(np.nanmax(columns.get("penetration_depth_m", 0.0), initial=0.0))
    for row, found in ((0, record.first), (-1, record.last)):
        found.update((name, float(column[row])) for name, column in columns.items() if np.isfinite(column[row]))
    if "regime" in record.last:
        number = int(record.last.pop("regime"))
        if 0 <= number < len(history.REGIMES):
            record.last["regime"] = history.REGIMES[number]


def _read_rod(record: Record, place: Place) -> None:
    """Fills in the rod's outlines at the start and at the end, from the series of interfaces."""
    directory = record.case.directory
    series = directory / vtk.SERIES["interfaces"]
    if not series.is_file():
        if record.done:
            record.problems.append(f"there is no {series.name}: the rod's shape is not shown")
        return
    try:
        files = [directory / file for _, file in vtk.read_series(series)]
        if files:
            record.start, record.rod = (place.outlines(file) for file in (files[0], files[-1]))
    except vtk.VtkError as error:
        record.problems.append(str(error))

