"""A dask client whose workers write made-up runs at once: for tests of the runs that a sweep or a search chooses."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import tomllib
from collections.abc import Callable
from pathlib import Path

from hydro2d.output.directory import deck_hash
from hydro2d.study.plan import cases
from hydro2d.study.run.case import Outcome
from hydro2d.study.search import transition
from tests.study import fake

REGIMES = {"rigid": 0.001, "deforming": 0.1, "eroding": 0.4, "left the mesh": 0.9}


def regime(velocity: float, deforming: float, eroding: float) -> str:
    """The regime of a rod that deforms from one velocity on and erodes from another."""
    return "eroding" if velocity >= eroding else "deforming" if velocity >= deforming else "rigid"


class Client:
    """The part of distributed.Client that sweeps need. Runs end in the order in which they were submitted.

    outcome : from the velocity in m/s and the resolved deck to entries of the summary, or to an Outcome other than done
    interrupt_at : number of the submission at which SIGINT comes; its run leaves a restart file
    submitted : names of the cases in their order
    ahead : how many had been submitted each time that the outcome of a case was requested
    """

    def __init__(self, outcome: Callable, workers: int = 1, interrupt_at: int | None = None):
        self.outcome, self.workers, self.interrupt_at = outcome, workers, interrupt_at
        self.submitted: list[str] = []
        self.ahead: list[int] = []

    def connect(self):
        """In place of cluster.local."""
        return contextlib.nullcontext(self)

    def scheduler_info(self, n_workers: int) -> dict:
        return {"workers": dict.fromkeys(range(self.workers))}

    def run(self, function, *arguments, on_error) -> None:
        """Stops workers; here they have ended."""

    def submit(self, work, sweep, directory, text, threads, overwrite, *, key, pure):
        place = Path(directory)
        self.submitted.append(place.name)
        if place.exists():
            shutil.rmtree(place)
        return _Future(key, self._run(place, text), lambda: self.ahead.append(len(self.submitted)))

    def _run(self, place: Path, text: str) -> Outcome:
        if len(self.submitted) == self.interrupt_at:
            place.mkdir()
            (place / "deck.toml").write_text(text)
            (place / "restart.h5").touch()
            os.kill(os.getpid(), signal.SIGINT)
            return Outcome("interrupted", "SIGINT", fresh=True)
        deck = tomllib.loads(text)
        outcome = self.outcome(deck["body"][0]["velocity"][1], deck)
        if isinstance(outcome, Outcome):
            return outcome
        try:
            write(place, text, **outcome)
        except OSError as error:
            return Outcome("failed", f"{place}: {error.strerror}", type(error).__name__, host="here")
        return Outcome("done", host="here", wall_s=1.0)


class _Future:
    """A task that has ended."""

    status = "finished"

    def __init__(self, key: str, outcome: Outcome, asked: Callable):
        self.key, self.outcome, self.asked = key, outcome, asked

    def add_done_callback(self, function) -> None:
        function(self)

    def result(self) -> dict:
        self.asked()
        return self.outcome.plain()

    def release(self) -> None:
        pass


def write(place: Path, text: str, regime: str = "rigid", depth: float = 0.3, **summary) -> None:
    """A finished run of this resolved deck."""
    velocity = tomllib.loads(text)["body"][0]["velocity"][1]
    fake.write_run(place, velocity, depth, REGIMES[regime], rows=3, text=text, **{
        "deck_sha256": deck_hash(text), "regime": regime, "rod_core_mass_kg": fake.MASS * (1.0 - REGIMES[regime]), **summary,
    })


def study_file(folder: Path, text: str) -> Path:
    """A study file with this text."""
    file = folder / "search.toml"
    file.write_text(text)
    return file


def search(folder: Path, client: Client, text: str, **options) -> tuple[int, dict]:
    """A search of `hydro2d transition` with a made-up client: exit status and transition.json."""
    status = transition.find(cases.plan(study_file(folder, text)), folder / "out", client.connect(), **options)
    return status, json.loads((folder / "out" / "transition.json").read_text())
