"""A case can be run any number of times, after any outcome."""

import json
import os
import shutil
import subprocess
import sys
import threading
import time
from contextlib import ExitStack, contextmanager, nullcontext

import pytest

from hydro2d.base.errors import Error
from hydro2d.base.interrupt import Interrupt
from hydro2d.deck import deck as decks
from hydro2d.files.checksums import verified_text
from hydro2d.jit import compilation
from hydro2d.measure.summary import Summary
from hydro2d.output import history, snapshot
from hydro2d.output.directory import deck_hash
from hydro2d.study.records import study_directory
from hydro2d.study.run.case import kernels, run_case
from tests.cli.test_main import DECK
from tests.locks import held


@pytest.fixture
def text(simulation, monkeypatch):
    monkeypatch.setattr(compilation, "once", lambda key, compile: None)  # a fake compiles nothing
    return decks.loads(DECK).to_toml()


@pytest.fixture
def place(tmp_path):
    return tmp_path / "case"


def interrupted(simulation, monkeypatch, text, place, cycles):
    """Runs a case for some cycles."""
    interrupt, step = Interrupt(), simulation.step

    def counted(self):
        step(self)
        if self.cycle == cycles:
            interrupt("SIGTERM")

    with monkeypatch.context() as patch:
        patch.setattr(simulation, "step", counted)
        return run_case(place, text, interrupt=interrupt)


def bits(place):
    saved = snapshot.read(place / "restart.h5")
    columns = history.read(place / "history.h5")
    return saved.arrays["e"].tobytes(), saved.scalars, {name: column.tobytes() for name, column in columns.items()}


def test_a_finished_case_is_not_run_again(text, place):
    assert run_case(place, text).status == "done"
    before = (place / "summary.json").stat().st_mtime_ns
    again = run_case(place, text)
    assert (again.status, again.fresh) == ("done", False)
    assert (place / "summary.json").stat().st_mtime_ns == before


def test_a_failure_that_is_written_down_stays_until_a_run_has_ended(monkeypatch, text, place):
    """A sweep writes it; dask may then repeat the case, if its worker died before dask knew that its result was received."""
    place.mkdir()
    (place / "failed.json").write_text('{"reason": "a fault"}')

    def fault(*_given, **_options):
        raise ZeroDivisionError("a fault")

    with monkeypatch.context() as patch:
        patch.setattr("hydro2d.running.run.run", fault)
        assert run_case(place, text).status == "failed"
    assert (place / "failed.json").is_file()
    assert run_case(place, text).status == "done"
    assert not (place / "failed.json").is_file()


def test_an_interrupted_case_continues_to_the_same_bits(simulation, monkeypatch, text, place, tmp_path):
    first = interrupted(simulation, monkeypatch, text, place, 50)
    assert first.status == "interrupted"
    assert "SIGTERM" in first.message
    assert run_case(place, text).status == "done"
    assert "continuing at cycle 50" in (place / "log.txt").read_text()
    assert run_case(tmp_path / "whole", text).status == "done"
    assert bits(place) == bits(tmp_path / "whole")


def test_a_case_that_died_before_its_first_restart_file_begins_anew(text, place):
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    place.mkdir()
    (place / "deck.toml").write_text(text)
    (place / "run.lock").write_text(f"{os.uname().nodename} {child.pid}")
    assert run_case(place, text).status == "done"


def test_another_deck_is_a_failure_without_overwrite(text, place):
    run_case(place, text)
    kept = (place / "summary.json").read_text()
    other = decks.loads(DECK, ["numerics.courant=0.3"]).to_toml()
    outcome = run_case(place, other)
    assert outcome.status == "failed"
    assert "holds a run of another deck; --overwrite removes it" in outcome.message
    assert (place / "summary.json").read_text() == kept
    assert run_case(place, other, overwrite=True).status == "done"
    assert verified_text(place / "deck.toml", Error) == other


def test_unphysical_is_a_result(simulation, text, place):
    simulation.fail_at = 7
    outcome = run_case(place, text)
    assert (outcome.status, outcome.fresh) == ("unphysical", True)
    assert "density -1" in outcome.message
    assert run_case(place, text).fresh is False


def test_a_fault_is_a_result_with_its_trace(simulation, text, place):
    simulation.step = lambda self: 1 / 0
    outcome = run_case(place, text)
    assert (outcome.status, outcome.kind) == ("failed", "ZeroDivisionError")
    assert "test_case.py" in outcome.trace
    assert outcome.first == outcome.message


def test_a_chance_failure_is_tried_once_more(simulation, monkeypatch, text, place, tmp_path):
    """For example two threads of Python that parse at once."""
    step, failed = simulation.step, []

    def once(self):
        if self.cycle == 50 and not failed:
            failed.append(self)
            raise SystemError("AST constructor recursion depth mismatch (before=129, after=75)")
        step(self)

    monkeypatch.setattr(simulation, "step", once)
    outcome = run_case(place, text)
    assert outcome.status == "done"
    assert outcome.first.startswith("SystemError: AST constructor")
    assert "in once" in outcome.trace
    run_case(tmp_path / "whole", text)
    assert bits(place) == bits(tmp_path / "whole")


@pytest.mark.parametrize("reason", ["the disk is full", "its worker died 4 times"])
def test_a_case_that_is_done_is_done(text, place, reason):
    """Whatever was written before its user finished it by hand, or while its worker died at its end."""
    assert run_case(place, text).status == "done"
    (place / "failed.json").write_text(json.dumps({"reason": reason}))
    sha256 = deck_hash(text)
    assert study_directory.state(place, sha256)["status"] == "done"
    assert (run_case(place, text).status, run_case(place, text).fresh) == ("done", False)
    assert study_directory.state(place, deck_hash("another deck"))["status"] == "failed"
    (place / "summary.json").unlink()
    assert study_directory.state(place, sha256) == {"status": "failed", "message": reason, "summary": Summary()}


def test_a_worker_that_is_still_ending_is_waited_for(text, place):
    """As right after a sweep that was killed: its worker is still writing a restart file."""
    place.mkdir()
    with ExitStack() as stack:
        stack.enter_context(held(place / "run.lock"))
        threading.Timer(1.0, stack.pop_all().close).start()
        assert run_case(place, text).status == "done"


@contextmanager
def _in_use(place):
    place.mkdir()
    with held(place / "run.lock"):
        yield


def _locked(place, text, age):
    """A lock with a last sign of life so many seconds ago."""
    place.mkdir()
    (place / "run.lock").write_text(text)
    os.utime(place / "run.lock", (time.time() - age,) * 2)


@pytest.mark.parametrize("skew", [1e4, 0.0, -1e4])
def test_the_lock_of_another_machine_that_shows_no_sign_is_taken_over(text, place, monkeypatch, skew):
    monkeypatch.setattr("hydro2d.study.run.case.LONGEST_SILENCE", 0.5)
    _locked(place, "elsewhere 1", skew)
    began = time.monotonic()
    assert run_case(place, text).status == "done"
    assert time.monotonic() - began > 0.5


@contextmanager
def _alive(place, skew):
    """A run on another machine, whose clock is ahead of or behind this one's, writes its progress."""
    _locked(place, "elsewhere 1", skew)
    ended = threading.Event()

    def live():
        while not ended.wait(0.05):
            (place / "progress.json").write_text("{}")
            os.utime(place / "progress.json", (time.time() - skew,) * 2)

    thread = threading.Thread(target=live)
    thread.start()
    yield
    ended.set()
    thread.join()


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda place: place.touch(), "is a file, not a directory"),
        (lambda place: shutil.rmtree(place.parent), "workers need the study's file system"),
        (_in_use, f"in use by process {os.getppid()}"),
        (lambda place: _alive(place, 1e4), "in use by process 1 on elsewhere"),
        (lambda place: _alive(place, 0.0), "in use by process 1 on elsewhere"),
        (lambda place: _alive(place, -1e4), "in use by process 1 on elsewhere"),
    ],
)
def test_a_fault_that_the_user_can_mend_is_one_line(text, tmp_path, monkeypatch, spoil, said):
    monkeypatch.setattr("hydro2d.study.run.case.LONGEST_SILENCE", 0.5)
    monkeypatch.setattr("hydro2d.study.run.case.ENDING", 0.1)
    place = tmp_path / "cases" / "case"
    place.parent.mkdir()
    with spoil(place) or nullcontext():
        outcome = run_case(place, text)
    assert outcome.status == "failed"
    assert said in outcome.message
    assert "\n" not in outcome.message
    assert outcome.trace == ""


def test_a_full_disk(simulation, monkeypatch, text, place):
    interrupted(simulation, monkeypatch, text, place, 50)
    with monkeypatch.context() as full:
        full.setattr("hydro2d.running.reporting.opened", lambda path, mode: open("/dev/full", mode))  # as on a full disk
        outcome = run_case(place, text)
    assert outcome.status == "failed"
    assert outcome.message.startswith("the disk is full: ")
    assert run_case(place, text).status == "done"


def test_progress_is_published_while_it_runs(simulation, monkeypatch, text, place):
    monkeypatch.setattr("hydro2d.running.run.PROGRESS_SECONDS", 0.0)
    interrupt, step, seen = Interrupt(), simulation.step, []

    def watched(self):
        step(self)
        if (place / "progress.json").exists():
            seen.append(json.loads((place / "progress.json").read_text()))

    simulation.step = watched
    assert run_case(place, text, interrupt=interrupt).status == "done"
    assert [entry["cycles"] for entry in seen] == list(range(len(seen)))
    assert 0.9 < seen[-1]["fraction"] < 1
    assert seen[-1]["process"] == os.getpid()
    assert seen[-1]["penetration_depth_m"] > 0.018
    assert not (place / "progress.json").exists()


def test_kernels_go_by_the_words_of_the_methods():
    base = kernels(decks.loads(DECK))
    assert kernels(decks.loads(DECK, ["numerics.courant=0.3", "body.rod.velocity=900 m/s"])) == base
    assert kernels(decks.loads(DECK, ["numerics.advection=ke"])) != base
    assert kernels(decks.loads(DECK, ['sliding.method="contact"', 'sliding.hard=["rod"]'])) != base
