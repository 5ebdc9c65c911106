"""A restart continues from an intact state whatever else is damaged, and never from a file that does not match."""

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.deck import deck
from hydro2d.output import history, snapshot, vtk
from hydro2d.output.snapshot import Snapshot, SnapshotError
from hydro2d.running.run import run
from tests.measure.test_sanity import TEXT

FIRST = ["stop.cycles=40", "stop.time=1 s", 'output.history_interval="50 ns"', 'output.vtk_interval="100 ns"']
FURTHER = ["stop.cycles=60", *FIRST[1:]]


@pytest.fixture
def begun(tmp_path):
    run(deck.loads(TEXT, FIRST), tmp_path / "run", quiet=True)
    return tmp_path / "run"


def go_on(directory, **options):
    return run(deck.loads(TEXT, FURTHER), directory, restart=True, **options)


def spoiled(directory, change):
    """Rewrites the restart file, with a correct checksum, after a change of its contents."""
    contents = snapshot.read(directory / snapshot.NAME)
    arrays, scalars, saved = dict(contents.arrays), dict(contents.scalars), dict(contents.run)
    change(arrays, scalars, saved)
    (directory / snapshot.NAME).unlink()
    snapshot.write(directory / snapshot.NAME, Snapshot(arrays, scalars, saved, contents.deck, contents.provenance))


@pytest.mark.parametrize(("change", "said"), [
    (lambda a, s, r: a.pop("vof"), r"vof is nothing in the restart file and float64\[2, 44, 8\] in the deck"),
    (lambda a, s, r: a.update(q=a["q"].astype(np.float32)), r"q is float32\[.*\] in the restart file and float64\["),
    (lambda a, s, r: a.update(u=a["u"][:, 1:]), r"u is float64\[1, 44, 9\] in the restart file and float64\[1, 45, 9\]"),
    (lambda a, s, r: s.pop("audit"), "'audit' is missing"),
    (lambda a, s, r: s.update(box=7), "the restart file does not fit: "),
    (lambda a, s, r: r.pop("due"), "'due' is missing")])
def test_a_restart_file_that_does_not_fit_gives_one_message(begun, change, said):
    spoiled(begun, change)
    with pytest.raises(SnapshotError, match=said):
        go_on(begun, quiet=True)


def test_a_file_of_another_version_is_named(begun, monkeypatch, capsys):
    monkeypatch.setattr(snapshot, "FORMAT", "hydro2d restart 9")
    spoiled_file = snapshot.Snapshot({}, {}, {}, "", {})
    snapshot.write(begun / snapshot.NAME, spoiled_file)
    monkeypatch.undo()
    with pytest.raises(SnapshotError, match=rf'another version \("hydro2d restart 9"; this one reads "{snapshot.FORMAT}"\)'):
        snapshot.read(begun / snapshot.NAME)


@pytest.mark.parametrize("damage", [b"", b"nonsense", None])
def test_a_damaged_history_is_put_aside(begun, capsys, damage):
    file = begun / "history.h5"
    file.unlink() if damage is None else file.write_bytes(damage)
    assert go_on(begun)["cycles"] == 60
    assert "a new history is started" in capsys.readouterr().out
    assert (begun / "damaged-history.h5").exists() == (damage is not None)
    assert len(history.read(file)["time"]) > 1


@pytest.mark.parametrize("damage", [b"", b"<VTKFile>", None])
def test_a_damaged_series_is_read_from_its_dumps(begun, capsys, damage):
    file = begun / "series.pvd"
    before = vtk.read_series(file)[:-1]  # the last was written after the end
    file.unlink() if damage is None else file.write_bytes(damage)
    assert go_on(begun)["cycles"] == 60
    assert "its times are read from the dumps" in capsys.readouterr().out
    assert vtk.read_series(file)[:len(before)] == before


@pytest.mark.parametrize("option", ["restart", "overwrite"])
def test_files_of_the_user_among_the_dumps_stay(begun, option):
    names = ("dump_best.vtr", "dump_1.vtr", "dump_000001_copy.vtr", "interfaces_new.vtp", "dump_.vtr", "my_000001.vtr")
    for name in names:
        (begun / "vtk" / name).write_text("mine")
    summary = run(deck.loads(TEXT, FURTHER), begun, quiet=True, **{option: True})
    assert summary["status"] == "done"
    assert all((begun / "vtk" / name).read_text() == "mine" for name in names)
    assert len(vtk.read_series(begun / "series.pvd")) > 1


def test_leftovers_of_a_killed_process_are_removed(begun):
    for left in (begun / ".restart.h5.77.tmp", begun / "vtk" / ".dump_000003.vtr.77.tmp"):
        left.write_bytes(b"half")
    go_on(begun, quiet=True)
    assert not list(begun.glob("**/.*"))


def test_the_command_says_it_in_a_line(begun, tmp_path, capsys):
    spoiled(begun, lambda a, s, r: a.pop("q"))
    (tmp_path / "shot.toml").write_text(TEXT)
    arguments = ["run", str(tmp_path / "shot.toml"), "--out", str(begun), "--restart", "--quiet"]
    assert call([*arguments, *(word for entry in [*FURTHER, "name=deck"] for word in ("--set", entry))]) == 2
    error = capsys.readouterr().err
    assert "q is nothing in the restart file" in error
    assert error.count("\n") == 1
