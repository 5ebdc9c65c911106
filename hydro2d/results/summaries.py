"""Reads summary.json and progress.json, which may have been changed: values of the wrong kind are left out and reported."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from hydro2d.base.errors import DeckError, Error
from hydro2d.deck import deck as decks
from hydro2d.deck import targets
from hydro2d.files.whole import read_json
from hydro2d.measure import outcome
from hydro2d.measure.penetrator import Projectile
from hydro2d.measure.summary import Progress, Summary
from hydro2d.output.directory import DECK, PROGRESS, SUMMARY, deck_hash


def summary_of(directory: Path, deck: str, error: type[Error]) -> tuple[dict, list[str]]:
    """The summary of a run directory, empty if there is none, and the dotted keys of its values of the wrong kind.

    deck : the text of the directory's deck; a summary of another deck gets this as a fault

    Raises `error`.
    """
    summary, odd = Summary.sound(table_of(directory / SUMMARY, error))
    summary = _renewed(summary, deck)
    if deck and summary.get("deck_sha256", deck_hash(deck)) != deck_hash(deck):
        fault = f"{SUMMARY} is of another deck than {DECK}"
        summary = summary | {"trustworthy": False, "faults": [*(summary.get("faults") or ()), fault]}
    return summary, odd


def _renewed(summary: dict, text: str) -> dict:
    """A summary of version 0.3, which does not say what its shot came to, with its outcome; text : of its deck."""
    if "outcome" in summary or summary.get("penetration_depth_m") is None:
        return summary
    thickness, velocity, experiment = None, 0.0, None
    with suppress(DeckError):  # of a deck that is not accepted any more, the thickness of the target is not known
        deck = decks.loads(text)
        if deck.penetration is not None:
            thickness, velocity, experiment = targets.thickness(deck), decks.impact_velocity(deck), deck.experiment
    audit = summary.get("conservation") or {}
    taken = (audit.get("sinks") or {}).get("advection") or {}
    came = outcome.of(
        Projectile(**{name: summary.get(name) for name in Projectile.model_fields}), status=summary.get("status") or "",
        stop_reason=summary.get("stop_reason") or "", impact_velocity=velocity, thickness=thickness, experiment=experiment,
        dropped=outcome.ratio(taken.get("energy_J"), audit.get("start_energy_J")))
    return summary | {"outcome": came.model_dump()}


def progress_of(directory: Path, error: type[Error]) -> dict:
    """The progress of a run directory, without values of the wrong kind; empty if there is none. Raises `error`."""
    return Progress.sound(table_of(directory / PROGRESS, error))[0]


def table_of(file: Path, error: type[Error]) -> dict:
    """The table in a JSON file; empty if there is no such file. Raises `error`."""
    try:
        return read_json(file, error)
    except error:
        if not file.exists():
            return {}
        raise
