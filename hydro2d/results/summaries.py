"""Reads summary.json and progress.json, which may have been changed: values of the wrong kind are left out and reported."""

from __future__ import annotations

from pathlib import Path

from hydro2d.base.errors import Error
from hydro2d.files.whole import read_json
from hydro2d.measure.summary import Progress, Summary
from hydro2d.output.directory import DECK, PROGRESS, SUMMARY, deck_hash


def summary_of(directory: Path, deck: str, error: type[Error]) -> tuple[dict, list[str]]:
    """The summary of a run directory, empty if there is none, and the dotted keys of its values of the wrong kind.

    deck : the text of the directory's deck; a summary of another deck gets this as a fault

    Raises `error`.
    """
    summary, odd = Summary.sound(table_of(directory / SUMMARY, error))
    if deck and summary.get("deck_sha256", deck_hash(deck)) != deck_hash(deck):
        fault = f"{SUMMARY} is of another deck than {DECK}"
        summary = summary | {"trustworthy": False, "faults": [*(summary.get("faults") or ()), fault]}
    return summary, odd


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
