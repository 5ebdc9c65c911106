"""No space at any write of a run or a case: one message, then the results of an undisturbed run, including its history."""

import json

import pytest

from hydro2d.output import history, snapshot, vtk
from hydro2d.running import run as runs
from hydro2d.running.run import COSTS, run
from hydro2d.study.records.study_directory import state
from hydro2d.study.run.case import run_case
from tests import fake
from tests.disk import Disk

STEPS = 3e-7


@pytest.fixture
def deck(monkeypatch, simulation):
    """A short run that writes everything after every cycle."""
    for name in ("FLUSH_SECONDS", "PROGRESS_SECONDS"):
        monkeypatch.setattr(runs, name, 0.0)
    monkeypatch.setattr(runs, "FLUSH_SHARE", 1e9)
    monkeypatch.setattr(runs, "GOOD_EVERY", 3)
    made = fake.FakeDeck(history_interval=1e-7, vtk_interval=2e-7, restart_interval=0.0)
    made.stop.time = STEPS
    return made


def outcome(place):
    """The results of a run: state, history, dumps, and the numbers of its summary except wall-clock times."""
    columns = history.read(place / "history.h5")
    series = [entry for name in vtk.SERIES.values() if (place / name).exists() for entry in vtk.read_series(place / name)]
    summary = json.loads((place / "summary.json").read_text())
    own = ("wall_s", *COSTS, "ns_per_cell_cycle", "provenance", "sha256")
    kept = {key: value for key, value in summary.items() if key not in own}
    dumps = {file.name: file.read_bytes() for file in (place / "vtk").iterdir()}
    saved, rows = snapshot.read(place / "restart.h5"), {name: each.tobytes() for name, each in columns.items()}
    return rows, series, kept, dumps, saved.arrays["e"].tobytes(), saved.scalars


def again(deck, place):
    """Continues as a user would: with --restart if there is a restart file, otherwise from the beginning."""
    restart = any((place / name).exists() for name in (snapshot.NAME, snapshot.PREVIOUS))
    return run(deck, place, quiet=True, restart=restart, overwrite=not restart)


@pytest.mark.thorough
@pytest.mark.parametrize("once", [False, True], ids=["full from then on", "full for one file"])
def test_no_space_at_any_write_of_a_run(deck, tmp_path, monkeypatch, once):
    disk = Disk(monkeypatch)
    run(deck, tmp_path / "whole", quiet=True)
    number, whole = disk.count, outcome(tmp_path / "whole")
    assert number > 30
    for full in range(1, number + 1):
        place = tmp_path / str(full)
        disk.begin(full, once)
        with pytest.raises(OSError, match=r"No space left on device") as refused:
            run(deck, place, quiet=True)
        disk.begin()
        said = f"{refused.value.filename or ''} {refused.value}"
        assert str(place) in said
        assert ".tmp" not in said
        if state(place, None)["status"] == "done":  # only the last flush of the folder failed
            assert full == number
            assert outcome(place) == whole
        assert not list(place.rglob("*.tmp"))
        summary = again(deck, place)
        assert summary["trustworthy"]
        assert outcome(place) == whole, f"no space at write {full} of {number}"


@pytest.mark.thorough
def test_no_space_at_any_write_of_a_case(deck, tmp_path, monkeypatch):
    monkeypatch.setattr("hydro2d.jit.compilation.once", lambda key, compile: None)
    monkeypatch.setattr("hydro2d.study.run.case.kernels", lambda deck: "")
    monkeypatch.setattr("hydro2d.study.run.case.decks.loads", lambda text: deck)
    text, disk = deck.to_toml(), Disk(monkeypatch)
    assert run_case(tmp_path / "whole", text).status == "done"
    number, whole = disk.count, outcome(tmp_path / "whole")
    for full in range(1, number + 1):
        place = tmp_path / str(full)
        disk.begin(full)
        outcome_of = run_case(place, text)
        disk.begin()
        assert outcome_of.status == "failed"
        assert outcome_of.message.startswith("the disk is full: "), outcome_of.message
        assert "\n" not in outcome_of.message + outcome_of.trace
        assert run_case(place, text).status == "done"
        assert outcome(place) == whole, f"no space at write {full} of {number}"
