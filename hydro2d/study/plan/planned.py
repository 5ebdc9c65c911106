"""A study before it runs: its cases with their decks, and the names of cases."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hydro2d.base.formats import file_name
from hydro2d.files import toml
from hydro2d.output.directory import deck_hash
from hydro2d.study.plan import sampling, velocities
from hydro2d.study.plan.definition import Ensemble


@dataclass(frozen=True)
class Option:
    """One value or variant of an axis: its label, its part of the name of a case, and the keys that it sets.

    A key whose value is None is removed.
    """

    label: str
    short: str
    settings: dict[str, Any]


@dataclass(frozen=True)
class Planned:
    """A case before it runs. `text` is its resolved deck, or empty if the deck is wrong, and `message` then says why.

    of, member, changed : in an ensemble the case that it repeats, its number, and the changes, by name
    """

    name: str
    values: dict[str, str]
    deck: str
    overrides: list[str]
    text: str
    message: str
    of: str = ""
    member: int = 0
    changed: dict[str, float] = field(default_factory=dict)

    @property
    def sha256(self) -> str | None:
        return deck_hash(self.text) if self.text else None


@dataclass(frozen=True)
class Plan:
    """A study before it runs, with the decks of all cases resolved. ``again`` is the option that continues it.

    sample : the points of a sample, whose rows are the last axis
    """

    name: str
    title: str
    out: Path
    text: str
    axes: list[dict]
    cases: list[Planned]
    search: velocities.Velocities | None = None
    ensemble: Ensemble | None = None
    again: str = "--resume"
    keep: Path | None = None
    sample: sampling.Points | None = None

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks for the user, before the runs."""
        return self.sample.notes if self.sample else ()


def label(value: Any) -> str:
    """A value as a study file has it, with the quotation marks of a text that has line feeds or other invisible characters."""
    return value if isinstance(value, str) and value.isprintable() else toml.inline(value)


def short(label: str) -> str:
    """A label as part of a directory name: "1086 m/s" is 1086m-s."""
    return file_name(label.replace(" ", "").replace("_", "-"))
