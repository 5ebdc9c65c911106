"""The data of one run for a report: its deck and shot, its history, and the outline of the rod at the end."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hydro2d.analytic import experience, model_deck
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.deck import formulas, key_messages, targets
from hydro2d.files import checksums
from hydro2d.files.strange import within
from hydro2d.files.toml import dumps
from hydro2d.measure import outcome
from hydro2d.measure.outcome import Outcome
from hydro2d.measure.penetrator import Projectile
from hydro2d.measure.regime import LEFT, REGIMES
from hydro2d.measure.result import is_number
from hydro2d.output import history, vtk
from hydro2d.output.directory import DECK, HISTORY, check_own
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records.differences import numbers
from hydro2d.study.records.study_directory import DONE, Case

#: columns of the history to draw: of a projectile, and of the first body in other decks; largest number of points of a line
DRAWN = ("penetration_depth_m", "rod_tail_velocity_m_s", "rod_length_m")
DRAWN_OF_BODY = ("velocity_m_s", "kinetic_energy_J", "z_max_m")
POINTS = 300


class Setup(NamedTuple):
    """The setup of an experiment or an analytic model: materials, nose of a rod or shape, and the geometry in m."""

    rod: str
    target: str
    nose: str
    diameter: float
    length: float
    thickness: float | None
    shape: str = "rod"

    @property
    def is_rod(self) -> bool:
        """Whether the projectile has a nose."""
        return bool(self.nose)

    @property
    def size(self) -> str:
        """Length and diameter of the projectile."""
        across = f"{self.diameter * 1000:.4g} mm"
        return f"{self.length * 100:.4g} cm x {across}" if self.is_rod else across

    @property
    def plate(self) -> str:
        """The target in words."""
        return f"{self.thickness * 100:.4g} cm of {self.target}" if self.thickness else self.target

    @property
    def kind(self) -> str:
        """The projectile in words, without its material."""
        return f"{self.nose} rod" if self.is_rod else self.shape

    @property
    def words(self) -> str:
        """Projectile and target."""
        what = f"{self.nose} {self.rod} rod" if self.is_rod else f"{self.rod} {self.shape}"
        return f"{what} ({self.size}) into {self.plate}"

    @property
    def short(self) -> str:
        """For a heading."""
        return f"{self.rod} into {self.target}, {f'{self.nose} nose' if self.is_rod else self.shape}"


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
    """One case as read; ``problems`` lists unreadable parts. Outlines are radius and depth below the surface, (n, 2) in m.

    text, deck : the resolved deck as its file has it, and as tables, SI
    setup, velocity : setup and impact velocity in m/s; None without a projectile and a target
    target_density : initial density of a single target, kg/m^3
    impact : what strikes what, None if the deck is none of the kinds of shots that are known
    shot : input of the analytic models; None if they do not apply to the deck, and ``without_models`` says why
    history : thinned columns, SI;  first, last : first and last row of all columns
    start, rod : outlines of the projectile at the start and at the end
    unread : models of the deck that were not run, in words
    own : names of the results that the files of [result] measure
    """

    case: Case
    text: str = ""
    deck: dict = field(default_factory=dict)
    velocity: float | None = None
    shot: model_deck.Shot | None = None
    without_models: str = ""
    setup: Setup | None = None
    target_density: float | None = None
    impact: experience.Impact | None = None
    history: dict[str, np.ndarray] = field(default_factory=dict)
    first: dict[str, float] = field(default_factory=dict)
    last: dict[str, float] = field(default_factory=dict)
    start: list[np.ndarray] = field(default_factory=list)
    rod: list[np.ndarray] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)
    own: list[str] = field(default_factory=list)

    @property
    def done(self) -> bool:
        return self.case.status == DONE

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies of the deck."""
        tables = self.deck.get("body")
        entries = [entry for entry in tables if isinstance(entry, dict)] if isinstance(tables, list) else []
        return [str(entry["name"]) for entry in entries if "name" in entry]

    @property
    def body(self) -> str | None:
        """Name of the first body of the deck."""
        return next(iter(self.bodies), None)

    @cached_property
    def outcome(self) -> Outcome:
        """What the shot came to: by its summary, or before its end by the last row of the history; empty without a shot."""
        summary = self.case.summary
        if summary.outcome is not None:
            return summary.outcome
        if self.setup is None or self.velocity is None:
            return Outcome()
        measured = {**self.last, **{name: value for name, value in summary if value is not None}}
        return outcome.of(Projectile(**{name: measured.get(name) for name in Projectile.model_fields}), status=self.case.status,
                          stop_reason=summary.stop_reason or "", impact_velocity=self.velocity,
                          thickness=self.setup.thickness, dropped=None)

    @property
    def unfinished(self) -> str:
        """Why the results are not final: the run has not ended, or was cut short with the projectile moving; else empty."""
        if not self.done:
            return self.case.status
        if not self.case.summary:
            return "no summary"
        if self.outcome.final is not False:
            return ""
        return f"reached its {outcome.cut(self.case.summary.stop_reason, self.case.summary.rod_core_velocity_m_s)}"

    @property
    def cut(self) -> bool:
        """Whether the run ended by its end time or number of cycles with the core of the projectile still moving."""
        return self.done and self.outcome.final is False

    @cached_property
    def numbers(self) -> dict[str, float]:
        """Every number of the summary by dotted name, SI, or of the last row of the history without a summary; and ratios."""
        values = {self._as_in_summary(name): value for name, value in self.last.items()}
        values |= self.case.summary.model_dump(exclude={"provenance"}, exclude_unset=True)
        return numbers(values | {f"rod_{name}": self.outcome[name] for name in ("length_ratio", "radius_ratio")})

    @property
    def derived(self) -> list[str]:
        """Names of the quantities that [derived] of the deck defines, and of the results that files of [result] measure."""
        defined = self.deck.get("derived")
        return [*self.own, *(str(name) for name in (defined if isinstance(defined, dict) else ()))]

    def _as_in_summary(self, name: str) -> str:
        """The name in summary.json of a column of the history."""
        if name in self.derived:
            return f"derived.{name}"
        for body in self.bodies:
            if name.startswith(f"body_{body}_"):
                return f"bodies.{body}.{name.removeprefix(f'body_{body}_')}"
        return name

    @cached_property
    def experiment(self) -> dict:
        """The experiment in the deck, if it has a depth."""
        table = self.deck.get("experiment") or {}
        return table if table.get("penetration") else {}

    @property
    def measured_residual(self) -> float | None:
        """Residual velocity of the experiment in the deck, m/s; 0 if the projectile did not perforate."""
        velocity = (self.deck.get("experiment") or {}).get("residual_velocity")
        return float(velocity) if is_number(velocity) else None

    @property
    def perforated(self) -> bool:
        """Whether the projectile is through its targets, even if it has since left the mesh."""
        return bool(self.outcome.perforated)

    @property
    def left(self) -> bool:
        """Whether the rod left the mesh."""
        return self.value("regime") == LEFT

    @property
    def experience(self) -> list[str]:
        """How far results of such runs were from measurements, or that nobody knows; empty for a run that has not ended."""
        return [] if self.unfinished else experience.of_run(self.impact, self.value("regime"), self.perforated, self.velocity)

    def value(self, name: str):
        """A result from the summary or, without a summary, from the last row of the history; None if there is neither."""
        result = self.case.summary[name]
        return result if result is not None else self.last.get(name)


def read(case: Case, trust: bool = False) -> Record:
    """Reads a case; unreadable parts are left out and listed in its problems. Raises StrangeFile.

    trust : whether the code of models from outside that its deck carries may be run
    """
    record = Record(case)
    check_own(case.directory)
    if not (case.directory / DECK).is_file():
        return record
    place = _read_deck(record, trust)
    _read_history(record)
    if place is not None:
        _read_rod(record, place)
    return record


def _read_deck(record: Record, trust: bool) -> Place | None:
    """Fills in deck, velocity, shot and setup. Returns the place of the projectile, or None if there is none."""
    file = record.case.directory / DECK
    try:
        record.text = checksums.verified_text(file, StudyError)
        record.deck = key_messages.renewed(tomllib.loads(record.text))
        deck = decks.loads(dumps(record.deck), name=record.case.name.replace("/", "_"), trust=trust)
    except StudyError as error:
        record.problems.append(str(error))
        return None
    except (ValueError, RecursionError) as error:
        record.problems.append(f"{file} cannot be read: {error}")
        return None
    except DeckError as error:
        record.problems.append(f"{file.name} is not a deck of this version: {str(error).splitlines()[0]}")
        return None
    record.impact = experience.impact_of(deck)
    record.own = [name for own in formulas.own_results(deck).values() for name in own.lines]
    record.unread = [said for material in deck.materials.values() for said in material.unread()]
    if deck.penetration is None:
        return None
    try:
        record.shot = model_deck.shot(deck)
    except DeckError as error:
        record.without_models = str(error).removeprefix(f"{deck.name}: ")
    body = decks.body(deck, deck.penetration.rod)
    direction = int(targets.direction(deck))
    record.velocity = decks.impact_velocity(deck)
    record.setup = _setup(deck, body, record.shot)
    if len(deck.penetration.targets) == 1:
        target = decks.body(deck, deck.penetration.target)
        record.target_density = target.density or deck.materials[target.material].reference_density
    return Place(decks.slots(deck).index(body.join or body.name) + 1, decks.surface(deck), direction)


def _setup(deck: decks.Deck, body, shot: model_deck.Shot | None) -> Setup:
    """The setup of a projectile and its targets; the thickness includes all targets and the gaps between them."""
    through = targets.targets(deck)
    bodies = [decks.body(deck, target.name) for target in through]
    names = dict.fromkeys(deck.materials[each.material].name for each in bodies)
    (low, high), (_, radius) = (decks.extent(body, deck, axis) for axis in ("z", "r"))
    diameter, length = body.size or (2.0 * radius, high - low)
    return Setup(
        rod=deck.materials[body.material].name, target=" + ".join(names), nose=shot.nose if shot else getattr(body, "nose", ""),
        diameter=diameter, length=length,
        thickness=targets.thickness(deck), shape=body.shape,
    )


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
    drawn = DRAWN if record.setup else tuple(f"body_{record.body}_{name}" for name in DRAWN_OF_BODY)
    if any(name in columns for name in drawn):
        record.history = {name: columns[name][chosen] for name in ("time", *drawn) if name in columns}
    for row, values in ((0, record.first), (-1, record.last)):
        values.update((name, float(column[row])) for name, column in columns.items() if np.isfinite(column[row]))
    if "regime" in record.last:
        number = int(record.last.pop("regime"))
        if 0 <= number < len(REGIMES):
            record.last["regime"] = REGIMES[number]


def _read_rod(record: Record, place: Place) -> None:
    """Fills in the rod's outlines at the start and at the end, from the series of interfaces."""
    directory = record.case.directory
    series = directory / vtk.SERIES["interfaces"]
    if not series.is_file():
        if record.done:
            record.problems.append(f"there is no {series.name}, so the shape of the projectile is not shown")
        return
    try:
        files = [within(directory, file) for _, file in vtk.read_series(series)]
        if files:
            record.start, record.rod = (place.outlines(file) for file in (files[0], files[-1]))
    except vtk.VtkError as error:
        record.problems.append(str(error))
