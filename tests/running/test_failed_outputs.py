"""An output that cannot be written is named, and costs no other."""

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
from hydro2d.solver.record import ColumnError
from tests import fake
from tests.cli.test_main import DECK

RAISED = (RuntimeError("header too large"), ValueError("no"), KeyError("x"), TypeError("y"), MemoryError("8 EiB"),
          OSError("Unable to create attribute"), OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))  # fmt: skip


def raising(error):
    def refuse(*_, **__):
        raise type(error)(*error.args)

    return refuse


@pytest.fixture
def deck(tmp_path):
    file = tmp_path / "shot.toml"
    file.write_text(DECK)
    return str(file)


@pytest.mark.parametrize("error", RAISED, ids=lambda error: type(error).__name__)
def test_a_history_that_cannot_be_written_at_the_end(simulation, deck, tmp_path, monkeypatch, capsys, error):
    monkeypatch.setattr(history.History, "write", raising(error))
    out = tmp_path / "out"
    assert call(["run", deck, "--out", str(out), "--quiet"]) == 4
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "history.h5" in said
    assert "Traceback" not in said
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "done"
    assert snapshot.read(out / "restart.h5").scalars["cycle"] == summary["cycles"]
    assert len(vtk.read_series(out / "series.pvd")) > 3
    assert not (out / "progress.json").exists()


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
    assert json.loads((out / "summary.json").read_text())["status"] == "done"


def test_a_column_that_fails_in_the_last_row_leaves_the_summary(simulation, tmp_path):
    """Here the history has no row at the end time but that of the end."""
    columns = {"mine": lambda sim: 1 if sim.time < fake.STOP else None}
    with pytest.raises(ColumnError, match="mine fails"):
        run(fake.FakeDeck(history_interval=1.7 * fake.STOP), tmp_path, quiet=True, columns=columns)
    assert json.loads((tmp_path / "summary.json").read_text())["status"] == "done"


def test_a_restart_without_the_last_rows_goes_on_and_says_so(simulation, tmp_path, monkeypatch):
    deck = fake.FakeDeck()
    monkeypatch.setattr(runs, "FLUSH_SECONDS", 0.0)
    monkeypatch.setattr(runs, "FLUSH_SHARE", 1e9)
    write = history.History.write
    monkeypatch.setattr(history.History, "write", after(20, write, RuntimeError("no")))
    with pytest.raises(OSError, match=r"history\.h5 could not be written: RuntimeError: no"):
        run(deck, tmp_path, quiet=True)
    monkeypatch.setattr(history.History, "write", write)
    written, saved = history.read(tmp_path / "history.h5"), snapshot.read(tmp_path / "restart.h5")
    assert len(written["time"]) < saved.run["rows"]
    assert run(deck, tmp_path, restart=True, quiet=True)["status"] == "done"
    assert "history.h5 lacks the last 1 of " in (tmp_path / "log.txt").read_text()


def test_a_history_that_takes_long_is_written_less_often(simulation, tmp_path, monkeypatch):
    found = runs.Run(fake.FakeDeck(), tmp_path, restart=False, report=None)
    monkeypatch.setattr(runs.clock, "perf_counter", iter(np.arange(0.0, 1e3, 7.0)).__next__)
    found._write_history()
    assert found.flush_every == pytest.approx(70.0)
