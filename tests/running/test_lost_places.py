"""A process that lost its directory, which was removed, renamed or given to another one, writes nothing there any more."""

import json
import shutil
import signal
import subprocess
import sys
import time

import pytest

from hydro2d.files.locks import LostPlaceError, check_place, locked, remove
from hydro2d.files.whole import replacing, write_text
from hydro2d.results.reading import Results
from hydro2d.running.run import run
from hydro2d.study.records import study_directory
from tests import fake
from tests.cli.test_main import DECK


def lose(place, how):
    """Takes a directory from the process that works in it."""
    if how == "removed":
        shutil.rmtree(place)
    else:
        place.rename(place.with_name("elsewhere"))
    if how == "taken":
        place.mkdir()
        (place / "run.lock").write_text("another one")
        (place / "deck.toml").write_text("its deck")


HOWS = ("removed", "renamed", "taken")


@pytest.mark.parametrize("how", HOWS)
def test_a_file_no_longer_under_its_lock_is_not_written(tmp_path, how):
    place = tmp_path / "place"
    place.mkdir()
    with locked(place / "run.lock"):
        write_text(place / "one.txt", "one")
        (place / "below").mkdir()
        lose(place, how)
        before = sorted(tmp_path.rglob("*"))
        for file in (place / "one.txt", place / "below" / "two.txt"):
            with pytest.raises(LostPlaceError, match="place was removed, renamed or taken by another process"):
                write_text(file, "two")
            with pytest.raises(LostPlaceError):
                remove(file)
        write_text(tmp_path / "beside.txt", "others are not concerned")
        assert sorted(tmp_path.rglob("*")) == sorted([*before, tmp_path / "beside.txt"])
    check_place(place / "one.txt")  # not locked any more
    assert (place / "run.lock").exists() == (how == "taken"), "the lock of another process was removed"


def test_a_file_lost_while_it_is_written_is_not_put_in_place(tmp_path):
    place = tmp_path / "place"
    place.mkdir()
    with locked(place / "run.lock"), pytest.raises(LostPlaceError), replacing(place / "one.txt") as temporary:  # noqa: PT012
        lose(place, "taken")
        temporary.write_text("too late")
    assert sorted(file.name for file in place.iterdir()) == ["deck.toml", "run.lock"]


@pytest.mark.parametrize("how", HOWS)
@pytest.mark.parametrize("cycle", [1, 50, 150])
def test_a_run_ends_where_its_directory_is_lost(simulation, tmp_path, monkeypatch, how, cycle):
    place, step = tmp_path / "place", simulation.step

    def stepped(self):
        step(self)
        if self.cycle == cycle:
            lose(place, how)

    monkeypatch.setattr(simulation, "step", stepped)
    with pytest.raises(LostPlaceError):
        run(fake.FakeDeck(), place, quiet=True)
    if how == "taken":
        assert sorted(file.name for file in place.iterdir()) == ["deck.toml", "run.lock"]
        assert (place / "deck.toml").read_text() == "its deck"
    else:
        assert not place.exists()


@pytest.mark.thorough
def test_a_stopped_run_does_not_write_into_its_successor(tmp_path):
    """As on a laptop that sleeps: a run is suspended, its directory removed, and another one runs there to its end."""
    (tmp_path / "shot.toml").write_text(DECK)
    command = [sys.executable, "-m", "hydro2d", "run", str(tmp_path / "shot.toml"), "--out", str(tmp_path / "out"), "--quiet",
               "--threads", "1", "--set", "output.vtk_interval='0.2 us'"]
    first = subprocess.Popen([*command, "--set", "stop.time='1 ms'"], stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 300
    while not (tmp_path / "out" / "vtk" / "dump_000003.vtr").exists():  # by then it holds no lock of the cache
        assert first.poll() is None
        assert time.monotonic() < until
        time.sleep(0.05)
    first.send_signal(signal.SIGSTOP)
    shutil.rmtree(tmp_path / "out")
    subprocess.run([*command, "--set", "stop.cycles=40"], check=True)
    written = {file: file.read_bytes() for file in (tmp_path / "out").rglob("*") if file.is_file()}
    first.send_signal(signal.SIGCONT)
    said = first.communicate(timeout=120)[1]
    assert first.returncode == 4
    assert said.count("\n") == 1
    assert "was removed, renamed or taken by another process" in said
    assert {file: file.read_bytes() for file in (tmp_path / "out").rglob("*") if file.is_file()} == written


def test_a_summary_of_another_deck_is_reported(finished):
    """As left by two runs that wrote into one directory."""
    assert Results(finished).summary["trustworthy"]
    assert study_directory.state(finished, None)["message"] == ""
    text = (finished / "deck.toml").read_text()
    (finished / "deck.toml").write_text(text[text.index("\n") + 1 :].replace("courant = 0.5", "courant = 0.4"))
    assert Results(finished).summary["trustworthy"] is False
    fault = "summary.json is of another deck than deck.toml"
    assert fault in Results(finished).summary["faults"]
    assert study_directory.state(finished, None)["message"] == f"not trustworthy: {fault}"
    assert json.loads((finished / "summary.json").read_text())["trustworthy"]
