"""A study read back from its directory: its axes and cases, each with its state; also plain folders of runs."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..deck_errors import nearest
from ..files import holder
from ..run import DECK, LOCK, SUMMARY

STUDY, FAILED = "study.json", "failed.json"
DONE = "done"
STATUSES = ("waiting", "running", DONE, "interrupted", "unphysical", "failed", "invalid")


class StudyError(Exception):
    """A directory that holds no study and no run; the message is for the user."""


@dataclass(frozen=True)
class Axis:
    """What a study varies: its name, the key of the deck (None for named variants), its labels in order."""

    name: str
    key: str | None
    values: tuple[str, ...]


@dataclass(frozen=True)
class Case:
    """One run of a study; ``values`` are its labels by axis, ``summary`` is empty until it has ended.

    ``status`` is one of ``STATUSES``, and ``message`` says why where it is not "done".
    """

    name: str
    directory: Path
    values: dict[str, str] = field(default_factory=dict)
    status: str = "waiting"
    message: str = ""
    summary: dict = field(default_factory=dict)


@dataclass(frozen=True)
class Study:
    """A study, or runs that were put together; without axes the decks say what varies."""

    title: str
    directory: Path
    axes: tuple[Axis, ...]
    cases: tuple[Case, ...]


def load(directory: Path | str) -> Study:
    """Reads a study directory, a run directory or a folder of run directories. Raises StudyError."""
    directory = Path(directory)
    if (directory / STUDY).is_file():
        return _study(directory)
    return gather([directory])


def gather(directories: Sequence[Path | str]) -> Study:
    """Puts the runs of several directories together, without axes, named by what their paths differ in.

    Raises StudyError where one of them holds no run.
    """
    found: list[Path] = []
    for directory in map(Path, directories):
        found += [path for path in _runs(directory) if path.resolve() not in {each.resolve() for each in found}]
    first = Path(directories[0])
    base = os.path.commonpath([path.resolve().parent for path in found])
    cases = [_case(os.path.relpath(path.resolve(), base), path) for path in found]
    title = first.resolve().name if len(directories) == 1 else f"{len(cases)} runs"
    return Study(title, first, (), tuple(cases))


def _runs(directory: Path) -> list[Path]:
    """The run directories that a directory is, lists as a study, or holds."""
    if (directory / STUDY).is_file():
        return [case.directory for case in _study(directory).cases]
    if (directory / DECK).is_file():
        return [directory]
    if directory.is_file():
        raise StudyError(f"{directory} is a file, not a directory of a study or a run")
    if not directory.is_dir():
        near = nearest(directory.name, (path.name for path in directory.parent.glob("*/")))
        raise StudyError(f"{directory}: there is no such directory" + (f'; did you mean "{near}"?' if near else ""))
    found = sorted(path.parent for name in (DECK, SUMMARY) for path in directory.glob(f"*/{name}"))
    if not found:
        raise StudyError(f"{directory} holds no runs: it has no {STUDY}, no {DECK}, and no directory with one")
    return list(dict.fromkeys(found))


def _study(directory: Path) -> Study:
    data = _json(directory / STUDY)
    try:
        axes = tuple(Axis(entry["name"], entry["key"], tuple(map(str, entry["values"]))) for entry in data["axes"])
        cases = tuple(
            _case(entry["name"], directory / entry["directory"], entry["values"], entry.get("status0"), entry.get("message"))
            for entry in data["cases"]
        )
        if not cases:
            raise StudyError(f"{directory / STUDY}: the study has no cases")
        return Study(data.get("title") or data["name"], directory, axes, cases)
    except (KeyError, TypeError, AttributeError) as error:
        raise StudyError(f"{directory / STUDY} is not that of a study: {error!r}") from None


def _json(path: Path) -> dict:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise StudyError(f"{path} cannot be read: {error}") from None
    if not isinstance(found, dict):
        raise StudyError(f"{path} cannot be read: it holds no table")
    return found


def _case(name: str, directory: Path, values=None, status=None, message=None) -> Case:
    """A case with its state; what cannot be read is its message."""
    values, summary = dict(values or {}), {}
    if status is not None:
        return Case(name, directory, values, status, message or "")
    try:
        if (directory / SUMMARY).is_file():
            summary = _json(directory / SUMMARY)
        status, message = _state(directory, summary)
    except StudyError as error:
        status, message = "failed", str(error)
    return Case(name, directory, values, status, message, summary)


def _state(directory: Path, summary: dict) -> tuple[str, str]:
    """Status and the reason for it; no reason where it is done. Raises StudyError."""
    process = holder(directory / LOCK)
    if process is not None:
        return "running", process
    if (directory / FAILED).is_file():
        return "failed", str(_json(directory / FAILED).get("reason", "no reason is given"))
    if summary:
        status = str(summary.get("status", "interrupted"))
        return status, "" if status == DONE else str(summary.get("stop_reason", ""))
    if (directory / DECK).is_file():
        return "interrupted", f"there is no {SUMMARY}: it was killed, or is not continued yet"
    return "waiting", ""
