"""Reads summary.json, which may have been changed: values of the right kind are used, and the others reported.

progress.json, which has some of the same keys, is checked in the same way.
"""

from __future__ import annotations

import sys
from pathlib import Path

from hydro2d.base.errors import Error
from hydro2d.files.whole import read_json
from hydro2d.output.directory import DECK, PROGRESS, SUMMARY, deck_hash

#: keys with words, lists of words, tables, and yes or no
WORDS = ("deck", "title", "deck_sha256", "version", "method", "status", "stop_reason", "regime", "qualifier",
         "source", "body", "host", "damage_class")
TABLES = ("conservation", "experiment", "provenance", "packages", "crater", "mass", "sinks", "contact_transfers",
          "bodies", "stations", "targets", "projectile", "debris", "ejecta", "derived", "off_course_cells")
YES_OR_NO = ("trustworthy", "git_dirty")
#: keys with numbers, and endings of the names of other keys with numbers
NUMBERS = ("cycles", "cells", "ns_per_cell_cycle", "axial_momentum", "total_energy", "rod_max_plastic_strain",
           "max_plastic_strain", "penetration_over_length", "efficiency", "momentum_multiplication", "fragments", "fraction",
           "process")
UNITS = ("_m", "_m_s", "_s", "_kg", "_J", "_N_s", "_m2", "_m3", "_K", "_Pa", "_rad")
#: tables with only numbers, or only tables, under any keys
OF_NUMBERS, OF_TABLES = ("mass", "derived", "off_course_cells"), ("sinks", "contact_transfers", "bodies", "stations", "targets")


def summary_of(directory: Path, deck: str, error: type[Error]) -> tuple[dict, list[str]]:
    """The summary of a run directory, empty if there is none, and the dotted keys of its values of the wrong kind.

    deck : the text of the directory's deck; a summary of another deck gets this as a fault

    Raises `error`.
    """
    summary, odd = plausible(table_of(directory / SUMMARY, error))
    if deck and summary.get("deck_sha256", deck_hash(deck)) != deck_hash(deck):
        fault = f"{SUMMARY} is of another deck than {DECK}"
        summary = summary | {"trustworthy": False, "faults": [*(summary.get("faults") or ()), fault]}
    return summary, odd


def progress_of(directory: Path, error: type[Error]) -> dict:
    """The progress of a run directory, without values of the wrong kind; empty if there is none. Raises `error`."""
    return plausible(table_of(directory / PROGRESS, error))[0]


def table_of(file: Path, error: type[Error]) -> dict:
    """The table in a JSON file; empty if there is no such file. Raises `error`."""
    try:
        return read_json(file, error)
    except error:
        if not file.exists():
            return {}
        raise


def plausible(summary: dict) -> tuple[dict, list[str]]:
    """The summary without values of the wrong kind, and their dotted keys. Non-finite numbers count as wrong."""
    odd: list[str] = []
    return _checked(summary, (), odd), odd


def _checked(table: dict, path: tuple[str, ...], odd: list[str]) -> dict:
    kept = {}
    for key, value in table.items():
        place = (*path, str(key))
        within = path[-1] if path else ""
        if (value is None and within not in OF_TABLES) or _fits(str(key), value, within):
            kept[key] = _checked(value, place, odd) if isinstance(value, dict) else value
        else:
            odd.append(".".join(place))
    return kept


def _fits(key: str, value, table: str) -> bool:
    """Whether a value is of the kind that its key, or its table, requires."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max
    if table in OF_NUMBERS:
        return is_number
    if key in TABLES or table in OF_TABLES:
        return isinstance(value, dict)
    if key in NUMBERS or key.endswith(UNITS):
        return is_number
    if key in WORDS:
        return isinstance(value, str)
    if key in ("faults", "notes"):
        return isinstance(value, list) and all(isinstance(each, str) for each in value)
    return key not in YES_OR_NO or isinstance(value, bool)
