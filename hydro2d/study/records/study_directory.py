"""The study directory, which can be read in any state of completion, and folders of runs, which are read in the same way.

    study.toml          the study file, with the overrides of the command line
    study.json          axes and cases
    cases/<name>/       a run directory for each case, as `hydro2d run` makes it
    cases/<name>/failed.json   why the last attempt failed, if it did
    sweep.log           the log
    transition.json     the results of a search for a transition
    transition.csv, transition.png   the shots of a search with a budget, and the fitted curve
    convergence.json    the results of `hydro2d converge`
    samples.csv         the inputs and results of a sample
"""

from __future__ import annotations

import functools
import hashlib
import math
import os
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path, PurePosixPath

from hydro2d.base.errors import nearest
from hydro2d.base.formats import one_line
from hydro2d.base.version import __version__
from hydro2d.files import checksums
from hydro2d.files.locks import holder
from hydro2d.files.strange import own, own_folder, within
from hydro2d.files.whole import write_json, write_text
from hydro2d.measure.summary import Summary
from hydro2d.output import snapshot
from hydro2d.output.directory import DECK, STUDY, SUMMARY, deck_hash
from hydro2d.output.directory import LOCK as RUN_LOCK
from hydro2d.results.summaries import progress_of, summary_of, table_of
from hydro2d.study.outcomes.registry import BY_NAME
from hydro2d.study.plan import velocities
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.sampling import Points

TEXT, CASES, LOG, LOCK = "study.toml", "cases", "sweep.log", "study.lock"
FAILED = "failed.json"

WAITING, RUNNING, DONE, INTERRUPTED = "waiting", "running", "done", "interrupted"
UNPHYSICAL, FAILED_STATUS, INVALID = "unphysical", "failed", "invalid"
#: statuses of cases that are not run again
ENDED = (INVALID, DONE, UNPHYSICAL)
STATUSES = (WAITING, RUNNING, DONE, INTERRUPTED, UNPHYSICAL, FAILED_STATUS, INVALID)


@dataclass(frozen=True)
class Axis:
    """An axis of a study: its name, the deck key (None for named variants), and its labels in order.

    is_of_points : whether it has the rows of a sample
    """

    name: str
    key: str | None
    values: tuple[str, ...]
    is_of_points: bool = False

    def said(self, label: str) -> str:
        """A label that can be read alone: with the name of the axis if one of its labels begins like a number."""
        return f"{self.name} {label}" if any(value[:1] in set("+-.0123456789") for value in self.values) else label


@dataclass(frozen=True)
class Ensemble:
    """How the members of every case of a study are made: their number, their changes, and the seed."""

    repeats: int
    by: tuple[str, ...]
    seed: int


@dataclass(frozen=True)
class Case:
    """A case, as read from its directory.

    Attributes
    ----------
    name, values : its name, and its label on every axis
    directory : its run directory, which need not exist
    base, overrides, deck_sha256 : base deck, its overrides, and the hash of the resolved deck (None if there is none)
    status : "waiting", "running", "done", "interrupted", "unphysical", "failed" or "invalid"
    message : why it failed, is invalid, unphysical or interrupted, or which process runs it
    summary : contents of summary.json; false, and without results, until the run has ended
    progress : contents of progress.json; empty while the case does not run
    of, member, changed, ensemble : in an ensemble the case that it repeats, its number, the changes by name, and how its
        members are made
    """

    name: str
    directory: Path
    values: dict[str, str] = field(default_factory=dict)
    base: str = ""
    overrides: tuple[str, ...] = field(default=(), repr=False)
    deck_sha256: str | None = field(default=None, repr=False)
    status: str = WAITING
    message: str = ""
    summary: Summary = field(default_factory=Summary, repr=False)
    progress: dict = field(default_factory=dict, repr=False)
    of: str = ""
    member: int = 0
    changed: dict[str, float] = field(default_factory=dict)
    ensemble: Ensemble | None = None

    @property
    def group(self) -> str:
        """The name of the case that it repeats, else its own."""
        return self.of or self.name

    @functools.cached_property
    def deck(self) -> dict | None:
        """The resolved deck in SI units; None before the case has begun. Raises StudyError."""
        text = _text(self.directory / DECK)
        try:
            return tomllib.loads(text) if text else None
        except ValueError as error:
            raise StudyError(f"{self.directory / DECK} cannot be read: {error}") from None


@dataclass(frozen=True)
class Interval:
    """The velocities of a search for a transition: deck key, velocities and largest width of a bracket in m/s, and outcome.

    depth : threshold of a depth, m;  budget : of a search for an outcome that is partly chance, else None
    """

    key: str
    speeds: tuple[float, ...]
    tolerance: float
    of: str = "regime"
    depth: float | None = None
    budget: velocities.Budget | None = None


@dataclass(frozen=True)
class Study:
    """A study directory, or several runs treated as a study; without axes, the decks show what varies.

    title, name : of the study;  axes, cases : in the order of the file;  entries : the cases in study.json
    search : for a search for a transition, whose last axis is the velocity and whose cases are those that were run
    sample : the points of a sample, whose rows are the last axis
    """

    directory: Path
    title: str
    name: str
    axes: tuple[Axis, ...]
    cases: tuple[Case, ...]
    entries: tuple[dict, ...] = ()
    search: Interval | None = None
    sample: Points | None = None

    def __repr__(self) -> str:
        ended = sum(bool(case.summary) for case in self.cases)
        return f"<{type(self).__name__} {self.name}: {len(self.cases)} case{'s' * (len(self.cases) != 1)}, {ended} ended>"

    @property
    def ensembles(self) -> tuple[Ensemble, ...]:
        """How the members of ensembles are made, each way once; more than one only if several studies are combined."""
        return tuple(dict.fromkeys(case.ensemble for case in self.cases if case.ensemble))

    def case(self, number: int) -> Case:
        """One case of a study directory, read again."""
        return _case(self.directory, self.entries[number], self.cases[number].ensemble)


def make(directory: Path) -> None:
    """Makes the missing folders of a study. Raises OSError, StrangeFile if a file of the study is not a regular file."""
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    own_folder(directory / CASES)
    for name in (TEXT, STUDY, LOG, LOCK):
        own(directory / name)


def write(plan, directory: Path) -> None:
    """Writes a study into its directory, which `make` has made. Raises OSError."""
    directory = Path(directory)
    write_text(directory / TEXT, plan.text)
    write_json(directory / STUDY, _data(plan))


def of_plan(plan, directory: Path) -> Study:
    """A plan with the state of its cases in a directory, whether or not it has been written there."""
    return _study(Path(directory), _data(plan))


def _data(plan) -> dict:
    """The contents of study.json for a plan."""
    interval = plan.search
    search = interval and {
        "key": interval.key, "speeds_m_s": [velocities.speed(label) for label in interval.labels],
        "tolerance_m_s": interval.tolerance, "of": interval.of, "depth_m": interval.depth,
        "budget": interval.budget and asdict(interval.budget),
    }
    return {
        "title": plan.title,
        "name": plan.name,
        "version": __version__,
        "study_sha256": hashlib.sha256(plan.text.encode()).hexdigest(),
        "axes": plan.axes,
        "cases": [_entry(case) for case in plan.cases],
        "search": search,
        "ensemble": plan.ensemble and plan.ensemble.model_dump(mode="json"),
        **({"sample": plan.sample.data()} if plan.sample else {}),
    }


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
        **({"of": case.of, "member": case.member, "changed": case.changed} if case.of else {}),
    }


def load(directory: Path | str) -> Study:
    """Reads a study directory, a run directory or a folder of run directories. Raises StudyError."""
    directory = Path(directory)
    return read(directory) if (directory / STUDY).is_file() else gather([directory])


def read(directory: Path | str) -> Study:
    """Reads a study directory. Raises StudyError."""
    directory = Path(directory)
    if not own(directory / STUDY).is_file():
        raise StudyError(f"{directory} is not a study directory: it has no {STUDY}")
    data = table_of(directory / STUDY, StudyError)
    try:
        study = _study(directory, data)
        _check(study)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise StudyError(f"{directory / STUDY} is not a valid study file: {one_line(repr(error))}") from None
    if not study.cases:
        raise StudyError(f"{directory / STUDY}: the study has no cases")
    return study


def _study(directory: Path, data: dict) -> Study:
    """The study in study.json, with the state of every case."""
    axes = tuple(Axis(entry["name"], entry["key"], tuple(map(str, entry["values"]))) for entry in data["axes"])
    if data.get("sample"):
        axes = (*axes[:-1], replace(axes[-1], is_of_points=True))
    entries = tuple(data["cases"])
    repeated = data.get("ensemble")
    ensemble = Ensemble(repeated["repeats"], tuple(repeated["by"]), repeated["seed"]) if repeated else None
    cases = tuple(_case(directory, entry, ensemble) for entry in entries)
    stored = data.get("search")
    search = _interval(stored) if stored else None
    sample = Points.of_data(data["sample"]) if data.get("sample") else None
    return Study(directory, data.get("title") or data["name"], data["name"], axes, cases, entries, search, sample)


def _check(study: Study) -> None:
    """Raises ValueError or KeyError if entries of study.json contradict one another, as a sweep does not write them."""
    names = (study.title, study.name, *(name for axis in study.axes for name in (axis.name, axis.key or "")))
    if not all(isinstance(name, str) for name in names):
        raise ValueError("a title, a name or a key is not text")
    for case in study.cases:
        for axis in study.axes:
            if case.values[axis.name] not in axis.values:
                raise ValueError(f"{case.name} has {case.values[axis.name]!r} on the axis {axis.name}")
        if study.sample and not 1 <= int(case.values[study.axes[-1].name]) <= len(study.sample.rows):
            raise ValueError(f"{case.name} is of no row of the sample")
    if len({case.name for case in study.cases}) < len(study.cases):
        raise ValueError("two cases have one name")


def _interval(stored: dict) -> Interval:
    """The search in study.json; one of an earlier version has neither depth nor budget. Raises ValueError."""
    budget = stored.get("budget") or {}
    search = Interval(stored["key"], tuple(stored["speeds_m_s"]), stored["tolerance_m_s"], stored.get("of", "regime"),
                      stored.get("depth_m"), velocities.Budget(**budget) if budget else None)
    numbers = (*search.speeds, search.tolerance, search.depth or 0.0, *budget.values())
    if not all(isinstance(number, (int, float)) and math.isfinite(number) for number in numbers) or search.tolerance <= 0.0:
        raise ValueError("the search has something else than numbers")
    if search.of not in BY_NAME or not isinstance(search.key, str):
        raise ValueError(f"the search is for {search.of!r} over {search.key!r}")
    return search


def gather(directories: Sequence[Path | str]) -> Study:
    """Combines the runs of several directories, without axes, with the differing parts of their paths as names.

    The members of the ensembles of a study directory stay members. Raises StudyError if one of them contains no run.
    """
    by_place: dict[Path, Case] = {}
    for directory in map(Path, directories):
        for case in _runs(directory):
            by_place.setdefault(case.directory.resolve(), case)
    first = Path(directories[0])
    base = os.path.commonpath([place.parent for place in by_place])
    cases = tuple(_combined(case, place, base) for place, case in by_place.items())
    name = first.resolve().name if len(directories) == 1 else f"{len(cases)} runs"
    return Study(first, name, name, (), cases)


def _combined(case: Case, place: Path, base: str) -> Case:
    """A case among those of other directories: named by its place relative to their common folder, without its axes."""
    of = os.path.relpath(place.parent / case.of, base) if case.ensemble else ""
    return replace(case, name=os.path.relpath(place, base), of=of, values={})


def _runs(directory: Path) -> list[Case]:
    """The runs of a directory: itself, the cases of a study, or the directories in it."""
    for name in (STUDY, DECK):
        own(directory / name)
    if (directory / STUDY).is_file():
        return list(read(directory).cases)
    if (directory / DECK).is_file():
        return [_alone(directory)]
    if directory.is_file():
        raise StudyError(f"{directory} is a file, not a directory of a study or a run")
    if not directory.is_dir():
        near = nearest(directory.name, (path.name for path in directory.parent.glob("*/")))
        raise StudyError(f"{directory}: there is no such directory" + (f'; did you mean "{near}"?' if near else ""))
    places = sorted(path.parent for name in (DECK, SUMMARY) for path in directory.glob(f"*/{name}"))
    if not places:
        raise StudyError(f"{directory} holds no runs: it has no {STUDY}, no {DECK}, and no directory with one")
    return [_alone(place) for place in dict.fromkeys(places)]


def _alone(place: Path) -> Case:
    """A run directory that no study names."""
    return Case(place.name, place, **state(place, None))


def _text(file: Path) -> str:
    """The text of a deck; empty if it does not exist, or if its folder is a file. Raises StudyError, StrangeFile."""
    try:
        return checksums.verified_text(file, StudyError)
    except StudyError:
        if not file.exists():
            return ""
        raise


def _case(directory: Path, entry: dict, ensemble: Ensemble | None) -> Case:
    place = _place(directory, entry["directory"])
    sha256 = entry.get("deck_sha256")
    common = {
        "name": str(entry["name"]), "directory": place, "base": entry.get("deck", ""),
        "values": {name: str(value) for name, value in entry["values"].items()},
        "overrides": tuple(entry.get("overrides", ())), "deck_sha256": sha256,
        "of": str(entry.get("of", entry["name"])), "member": int(entry.get("member", 0)),
        "changed": {name: float(amount) for name, amount in entry.get("changed", {}).items()}, "ensemble": ensemble,
    }
    if entry.get("status0") == INVALID:
        return Case(**common, status=INVALID, message=entry.get("message") or "")
    return Case(**common, **state(place, sha256))


def _place(directory: Path, name: str) -> Path:
    """The directory of a case, which is one in the folder of cases. Raises StudyError, StrangeFile."""
    if PurePosixPath(name).parts[:-1] != (CASES,):
        raise StudyError(f"{directory / STUDY} names {name!r} as the directory of a case; it must be in {CASES}/")
    return within(directory, name)


def state(place: Path, deck_sha256: str | None) -> dict:
    """Status, message, summary and progress of a run directory; the message says what cannot be read.

    deck_sha256 : hash of the resolved deck that it should have; None: any

    Nothing else decides the state of a case: a run that has ended counts, even after failures or the death of its worker.
    """
    try:
        return _read_state(place, deck_sha256)
    except StudyError as error:
        return {"status": FAILED_STATUS, "message": str(error)}


def _read_state(place: Path, deck_sha256: str | None) -> dict:
    if place.is_file():
        return {"status": FAILED_STATUS, "message": f"{place} is a file, not a directory"}
    failed, text = table_of(place / FAILED, StudyError), _text(place / DECK)
    summary, odd = summary_of(place, text, StudyError)
    status = summary.status or INTERRUPTED
    process = holder(place / RUN_LOCK)
    if process is not None:
        return {"status": RUNNING, "message": str(process), "progress": progress_of(place, StudyError)}
    other = text and deck_sha256 is not None and deck_hash(text) != deck_sha256
    if failed and (other or status not in ENDED):
        return {"status": FAILED_STATUS, "message": str(failed.get("reason", "no reason is given")), "summary": summary}
    if other:
        return {"status": WAITING, "message": "its directory holds a run of another deck"}
    if summary:
        why = summary.stop_reason or ""
        if status == DONE:
            why = f"not trustworthy: {'; '.join(summary.faults)}" if summary.trustworthy is False else ""
        if odd:
            why = "; ".join([*([why] if why else []), f"{SUMMARY} has values of the wrong kind in {', '.join(odd)}"])
        return {"status": status, "message": why, "summary": summary}
    if any((place / name).is_file() for name in (snapshot.NAME, snapshot.PREVIOUS)):
        return {"status": INTERRUPTED, "message": "its process has ended; there is a restart file"}
    if text:
        return {"status": WAITING, "message": f"there is no {SUMMARY}; its process ended before the first restart file"}
    return {"status": WAITING}
