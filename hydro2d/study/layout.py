"""The study directory: written whole, read back in any state of completion.

    study.toml          the study file, with the overrides of the command line
    study.json          axes and cases
    cases/<name>/       a run directory for each case, as `hydro2d run` makes it
    cases/<name>/failed.json   why the last try failed, where it did
    sweep.log           what happened
"""

from __future__ import annotations

import functools
import hashlib
import json
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from hydro2d import __version__, run, snapshot
from hydro2d.files import holder, write_json, write_text
from hydro2d.study.definition import StudyError

STUDY, TEXT, CASES, LOG, LOCK = "study.json", "study.toml", "cases", "sweep.log", "study.lock"
FAILED = "failed.json"

WAITING, RUNNING, DONE, INTERRUPTED = "waiting", "running", "done", "interrupted"
UNPHYSICAL, FAILED_STATUS, INVALID = "unphysical", "failed", "invalid"
STATUSES = (WAITING, RUNNING, DONE, INTERRUPTED, UNPHYSICAL, FAILED_STATUS, INVALID)


@dataclass(frozen=True)
class Case:
    """A case as its directory shows it.

    Attributes
    ----------
    name, values : its name, and its label on every axis
    directory : its run directory, which need not exist
    base, overrides, deck_sha256 : base deck, what is laid over, and the hash of the resolved deck (None where invalid)
    status : one of STATUSES
    message : why it failed, is invalid, unphysical or interrupted
    summary : what summary.json holds; empty until the run has ended
    progress : what progress.json holds; empty while it does not run
    """

    name: str
    values: dict[str, str]
    directory: Path
    base: str
    overrides: list[str]
    deck_sha256: str | None
    status: str
    message: str = ""
    summary: dict = field(default_factory=dict)
    progress: dict = field(default_factory=dict)

    @functools.cached_property
    def deck(self) -> dict | None:
        """The resolved deck in SI units; None before the case has begun."""
        text = _text(self.directory / run.DECK)
        return tomllib.loads(text) if text else None


@dataclass(frozen=True)
class Study:
    """A study directory.

    title, name : of the study;  axes : tables of name, key (or None) and labels;  cases : in the order of the axes
    """

    directory: Path
    title: str
    name: str
    axes: list[dict]
    cases: list[Case]
    entries: list[dict]

    def case(self, number: int) -> Case:
        """One case, read again."""
        return _case(self.directory, self.entries[number])


def make(directory: Path) -> None:
    """Makes the folders of a study where they are missing. Raises StudyError."""
    try:
        (Path(directory) / CASES).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StudyError(f"{directory}: the study cannot be written: {error.strerror or error}") from None


def write(plan, directory: Path) -> None:
    """Writes a study into its directory, which `make` has made. Raises StudyError."""
    directory = Path(directory)
    try:
        write_text(directory / TEXT, plan.text)
        write_json(directory / STUDY, {
            "title": plan.title,
            "name": plan.name,
            "version": __version__,
            "study_sha256": hashlib.sha256(plan.text.encode()).hexdigest(),
            "axes": plan.axes,
            "cases": [_entry(case) for case in plan.cases],
        })  # fmt: skip
    except OSError as error:
        raise StudyError(f"{directory}: the study cannot be written: {error.strerror or error}") from None


def _entry(case) -> dict:
    return {
        "name": case.name,
        "directory": f"{CASES}/{case.name}",
        "values": case.values,
        "deck": case.deck,
        "overrides": case.overrides,
        "deck_sha256": case.sha256,
        "status0": None if case.text else INVALID,
        "message": case.message,
    }


def load(directory: Path | str) -> Study:
    """Reads a study directory. Raises StudyError."""
    directory = Path(directory)
    try:
        data = json.loads((directory / STUDY).read_text(encoding="utf-8"))
        entries = data["cases"]
        cases = [_case(directory, entry) for entry in entries]
        return Study(directory, data["title"], data["name"], data["axes"], cases, entries)
    except (FileNotFoundError, NotADirectoryError):
        raise StudyError(f"{directory} is not a study directory: it has no {STUDY}") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise StudyError(f"{directory / STUDY} cannot be read: {type(error).__name__}: {error}") from None


def _text(file: Path) -> str:
    """The text of a file; empty where there is none, or where a file stands in the place of its folder."""
    try:
        return file.read_text(encoding="utf-8")
    except (FileNotFoundError, NotADirectoryError):
        return ""


def read_json(file: Path) -> dict:
    """A table of a JSON file; empty where there is no such file."""
    text = _text(file)
    return json.loads(text) if text else {}


def _case(directory: Path, entry: dict) -> Case:
    place = directory / entry["directory"]
    common = {
        "name": entry["name"], "values": entry["values"], "directory": place, "base": entry["deck"],
        "overrides": entry["overrides"], "deck_sha256": entry["deck_sha256"],
    }  # fmt: skip
    if entry["status0"] == INVALID:
        return Case(**common, status=INVALID, message=entry["message"])
    return Case(**common, **_state(place, entry["deck_sha256"]))


def _state(place: Path, deck_sha256: str) -> dict:
    """Status, message, summary and progress of a run directory."""
    if place.is_file():
        return {"status": FAILED_STATUS, "message": f"{place} is a file, not a directory"}
    summary, failed = read_json(place / run.SUMMARY), read_json(place / FAILED)
    if holder(place / run.LOCK) is not None:
        return {"status": RUNNING, "progress": read_json(place / run.PROGRESS)}
    if failed:
        return {"status": FAILED_STATUS, "message": failed["reason"], "summary": summary}
    text = _text(place / run.DECK)
    if text and run.deck_hash(text) != deck_sha256:
        return {"status": WAITING, "message": "its directory holds a run of another deck"}
    if summary:
        message = "" if summary["status"] == DONE else summary["stop_reason"]
        return {"status": summary["status"], "message": message, "summary": summary}
    if any((place / name).is_file() for name in (snapshot.NAME, snapshot.PREVIOUS)):
        return {"status": INTERRUPTED, "message": "its process ended; the restart file is there"}
    return {"status": WAITING}
