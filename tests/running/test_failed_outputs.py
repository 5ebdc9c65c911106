"""An output that cannot be written is named, and does not affect the others."""

import errno
import json
import os

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.output import history, snapshot, vtk
from hydro2d.output.series import Series
from hydro2d.running import run as runs
from hydro2d.running.run import run
from hydro2d.solver.recorder import ColumnError
from tests import fake
from tests.cli.test_main import DECK

RAISED = (RuntimeError("header too large"), ValueError("no"), KeyError("x"), TypeError("y"), MemoryError("8 EiB"),
          OSError("Unable to create attribute"), OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))


def raising(error):
    def refuse(*_, **__):
        raise type(error)(*error.args)

    return refuse


@pytest.fixture
def deck(tmp_path):
    file = tmp_path / "shot.toml"
    file.write_text(DECK)
    return str(file)


@pytest.mark.thorough
@pytest.mark.parametrize("error", RAISED, ids=lambda error: type(error).__name__)
def test_a_history_that_cannot_be_written_at_the_end(simulation, deck, tmp_path, monkeypatch, capsys, error):
    """The run is not done before everything is written, and then continues to the results of an undisturbed one."""
    write, out = history.History.write, tmp_path / "out"
    monkeypatch.setattr(history.History, "write", raising(error))
    assert call(["run", deck, "--out", str(out), "--quiet"]) == 4
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "history.h5" in said
    assert "Traceback" not in said
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "interrupted"
    assert "history.h5" in summary["stop_reason"]
    assert snapshot.read(out / "restart.h5").scalars["cycle"] == summary["cycles"]
    assert len(vtk.read_series(out / "series.pvd")) > 3
    assert not (out / "progress.json").exists()
    assert not (out / "history.h5").exists()
    monkeypatch.setattr(history.History, "write", write)
    assert call(["run", deck, "--out", str(out), "--quiet", "--restart"]) == 0
    assert call(["run", deck, "--out", str(tmp_path / "whole"), "--quiet"]) == 0
    assert outcome(out) == outcome(tmp_path / "whole")
    assert json.loads((out / "summary.json").read_text())["trustworthy"]


@pytest.mark.parametrize("error", RAISED, ids=lambda error: type(error).__name__)
@pytest.mark.parametrize(("place", "name", "file"), [(history.History, "write", "history.h5"), (Series, "dump", "vtk")])
def test_an_output_that_cannot_be_written_on_the_way(simulation, deck, tmp_path, monkeypatch, capsys, error, place, name, file):
    monkeypatch.setattr(runs, "FLUSH_SECONDS", 0.0)
    monkeypatch.setattr(runs, "FLUSH_SHARE", 1e9)
    monkeypatch.setattr(place, name, after(10, getattr(place, name), error))
    out = tmp_path / "out"
    assert call(["run", deck, "--out", str(out), "--quiet", "--set", "output.vtk_interval='0.2 us'"]) == 4
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert file in said
    assert snapshot.read(out / "restart.h5").scalars["cycle"] > 0


def outcome(out):
    """The last state and the whole history, to the last bit."""
    columns = history.read(out / "history.h5")
    return snapshot.read(out / "restart.h5").arrays["e"].tobytes(), {name: each.tobytes() for name, each in columns.items()}


def after(number, method, error):
    """A method that fails from the given call on."""
    calls = []

    def fails(*arguments):
        calls.append(arguments)
        if len(calls) > number:
            raise type(error)(*error.args)
        return method(*arguments)

    return fails


def test_all_that_cannot_be_written_is_named(simulation, deck, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(history.History, "write", raising(RuntimeError("too large")))
    monkeypatch.setattr(snapshot, "write", raising(OSError(errno.EACCES, "Permission denied")))
    monkeypatch.setattr(vtk, "write_lines", after(4, vtk.write_lines, ValueError("no lines")))
    out = tmp_path / "out"
    assert call(["run", deck, "--out", str(out), "--quiet", "--set", "output.vtk_interval='6 us'"]) == 4
    said = capsys.readouterr().err
    assert "history.h5 could not be written: RuntimeError: too large" in said
    assert "restart.h5: Permission denied" in said
    assert "vtk could not be written: ValueError: no lines" in said
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "interrupted"
    assert f"hydro2d: {summary['stop_reason']}\n" == said


def test_a_column_that_fails_in_the_last_row_leaves_the_summary(simulation, tmp_path):
    """Here the only row of the history at the end time is the last one."""
    columns = {"mine": lambda sim: 1 if sim.time < fake.STOP else None}
    with pytest.raises(ColumnError, match="mine fails"):
        run(fake.FakeDeck(history_interval=1.7 * fake.STOP), tmp_path, quiet=True, columns=columns)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["status"] == "interrupted"
    assert "mine fails" in summary["stop_reason"]


def test_a_restart_file_has_the_rows_that_the_history_lacks(simulation, tmp_path, monkeypatch):
    deck, whole, tmp_path = fake.FakeDeck(), tmp_path / "whole", tmp_path / "part"
    run(deck, whole, quiet=True)
    monkeypatch.setattr(runs, "FLUSH_SECONDS", 0.0)
    monkeypatch.setattr(runs, "FLUSH_SHARE", 1e9)
    write = history.History.write
    monkeypatch.setattr(history.History, "write", after(20, write, RuntimeError("no")))
    with pytest.raises(OSError, match=r"history\.h5 could not be written: RuntimeError: no"):
        run(deck, tmp_path, quiet=True)
    monkeypatch.setattr(history.History, "write", write)
    written, saved = history.read(tmp_path / "history.h5"), snapshot.read(tmp_path / "restart.h5")
    assert len(written["time"]) < saved.run["rows"]
    summary = run(deck, tmp_path, restart=True, quiet=True)
    assert (summary["status"], summary["trustworthy"]) == ("done", True)
    assert outcome(tmp_path) == outcome(whole)


@pytest.mark.parametrize(("spoil", "lacks"), [
    (lambda file: file.unlink(), "lacks 20 of 20 rows"),
    (lambda file: file.write_bytes(b"nothing"), "lacks 20 of 20 rows"),
    (lambda file: shorten(file, 15), "lacks 5 of 20 rows"),
])
def test_a_history_that_lost_rows_is_not_trusted(simulation, tmp_path, spoil, lacks):
    """Not even after another restart."""
    deck = fake.FakeDeck()
    deck.stop.time = 19.5e-6
    run(deck, tmp_path, quiet=True)
    spoil(tmp_path / "history.h5")
    for time in (20e-6, 21e-6):
        deck.stop.time = time
        summary = run(deck, tmp_path, restart=True, quiet=True)
        assert summary["status"] == "done"
        assert summary["faults"] == [f"history.h5 {lacks} before a restart"]


def shorten(file, rows):
    kept = history.History(file, rows)
    kept.write()


def test_a_history_that_takes_long_is_written_less_often(simulation, tmp_path, monkeypatch):
    started = runs.Run(fake.FakeDeck(), tmp_path, restart=False, report=None)
    monkeypatch.setattr(runs.clock, "perf_counter", iter(np.arange(0.0, 1e3, 7.0)).__next__)
    started._write_history()
    assert started.flush_every == pytest.approx(70.0)
