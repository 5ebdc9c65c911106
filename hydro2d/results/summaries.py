"""Reads summary.json and progress.json, which may have been changed: values of the wrong kind are left out and reported."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from hydro2d.base.errors import DeckError, Error
from hydro2d.deck import deck as decks
from hydro2d.deck import targets
from hydro2d.files.whole import read_json
from hydro2d.measure import outcome
from hydro2d.measure.summary import Conservation, Progress, Sink, Summary
from hydro2d.output.directory import DECK, PROGRESS, SUMMARY, deck_hash


def summary_of(directory: Path, deck: str, error: type[Error]) -> tuple[Summary, list[str]]:
    """The summary of a run directory, an empty one if there is none, and the dotted keys of its values of the wrong kind.

    deck : the text of the directory's deck; a summary of another deck gets this as a fault

    Raises `error`.
    """
    values, odd = Summary.sound(table_of(directory / SUMMARY, error))
    summary = _renewed(Summary(**values), deck)
    if deck and summary.deck_sha256 not in (None, deck_hash(deck)):
        fault = f"{SUMMARY} is of another deck than {DECK}"
        summary = summary.model_copy(update={"trustworthy": False, "faults": [*summary.faults, fault]})
    return summary, odd


def _renewed(summary: Summary, text: str) -> Summary:
    """A summary of version 0.3 with what it does not have: its set-up, and what its shot came to; text : of its deck."""
    if not summary or {"setup", "outcome"} <= summary.model_fields_set:
        return summary
    update: dict[str, object] = {}
    thickness, velocity, experiment = None, 0.0, None
    with suppress(DeckError):  # of a deck that is not accepted any more, neither is known
        deck = decks.loads(text, trust=False)
        update |= {"setup": deck.setup, "cells_across": deck.cells_across} if summary.setup is None else {}
        if deck.penetration is not None:
            thickness, velocity, experiment = targets.thickness(deck), decks.impact_velocity(deck), deck.experiment
    if summary.outcome is None and summary.penetration_depth_m is not None:
        audit = summary.conservation or Conservation()
        taken = audit.sinks.get("advection") or Sink()
        update["outcome"] = outcome.of(
            summary, status=summary.status or "", stop_reason=summary.stop_reason or "", impact_velocity=velocity,
            thickness=thickness, experiment=experiment, dropped=outcome.ratio(taken.energy_J, audit.start_energy_J))
    return summary.model_copy(update=update)


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
