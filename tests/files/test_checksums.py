"""The checksum in a file matches at any moment, is in nobody's way, and yields to a user's deliberate change."""

import json
import os
import tomllib
import tracemalloc
from pathlib import Path

import h5py
import numpy as np
import pytest

from hydro2d.base.errors import Error
from hydro2d.files import checksums, whole
from hydro2d.files.checksums import sealed, verified, verified_text
from hydro2d.files.strange import StrangeFile
from hydro2d.files.whole import read_json, read_text
from hydro2d.output import history, snapshot, vtk
from hydro2d.output.series import Series
from hydro2d.results import export
from hydro2d.results.reading import Results, ResultsError
from hydro2d.running import run as runs
from tests import fake

CHECKED = {"deck.toml", "summary.json", "history.h5", "restart.h5", "series.pvd", "interfaces.pvd", "tracers.pvd"}


@pytest.fixture
def done(simulation, tmp_path):
    runs.run(fake.FakeDeck(), tmp_path / "run", quiet=True)
    return tmp_path / "run"


def is_sealed(file: Path) -> bool:
    """Whether one changed bit in the middle is refused."""
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    other = file.with_name(f"other{file.suffix}")
    other.write_bytes(data)
    try:
        verified(other, Error)
    except Error as error:
        return f"{other} does not fit its checksum" in str(error)
    finally:
        other.unlink()
    return False


def test_every_file_of_a_run_has_one(done):
    kept = [file for file in done.rglob("*") if file.is_file() and file.name != "log.txt"]
    assert {file.name for file in kept} > CHECKED
    assert [file.name for file in kept if not is_sealed(file)] == []


def test_every_file_fits_whenever_it_is_replaced(simulation, tmp_path, monkeypatch):
    """So that a reader, or a killed process, finds no file without its checksum."""
    seen = []

    def replace(source, target):
        os.rename(source, target)
        verified(target, Error)
        seen.append(is_sealed(Path(target)))

    monkeypatch.setattr(whole.os, "replace", replace)
    monkeypatch.setattr(runs, "FLUSH_SECONDS", 0.0)
    monkeypatch.setattr(runs, "FLUSH_SHARE", 1e9)
    monkeypatch.setattr(runs, "PROGRESS_SECONDS", 0.0)
    runs.run(fake.FakeDeck(vtk_interval=1e-6), tmp_path, quiet=True)
    assert len(seen) > 100
    assert all(seen)


def test_exported_files_have_them(done, tmp_path):
    export.export(Results(done), tmp_path / "out", ["pressure"])
    kept = [file for file in (tmp_path / "out").rglob("*") if file.is_file() and file.suffix != ".csv"]
    assert len(kept) > 10
    assert all(is_sealed(file) for file in kept)


def test_other_programs_read_the_files(done):
    assert json.loads((done / "summary.json").read_text())["status"] == "done"
    assert tomllib.loads((done / "deck.toml").read_text())["numerics"]["courant"] == 0.5
    with h5py.File(done / "history.h5", "r") as file:
        assert len(file["time"]) > 10
    pyvista = pytest.importorskip("pyvista")
    reader = pyvista.get_reader(done / "series.pvd")
    assert len(reader.time_values) > 3
    assert reader.read()[0].n_cells == 12 * 55
    assert pyvista.read(done / "vtk" / "interfaces_000000.vtp").n_cells == 2


@pytest.mark.parametrize(("name", "change", "remedy"), [
    ("summary.json", lambda text: text.replace('"done"', '"fine"'), 'put it back, or remove its key "sha256" if the change'),
    ("deck.toml", lambda text: text.replace("0.5", "0.4"), "put it back, or remove its first line if the change is intended")])
def test_a_change_is_refused_until_it_is_meant(done, name, change, remedy):
    file = done / name
    changed = change(file.read_text())
    file.write_text(changed)
    with pytest.raises(ResultsError, match=f"{name} does not fit its checksum: it was damaged or changed .*; {remedy}"):
        Results(done)
    file.write_text("\n".join(line for line in changed.split("\n") if "sha256 " not in line and '"sha256"' not in line))
    results = Results(done)
    assert "fine" in results.summary["status"] or results.tables["numerics"]["courant"] == 0.4


def test_files_of_earlier_versions_are_read(tmp_path):
    texts = {"deck.toml": 'name = "a"\n', "summary.json": '{\n  "deck": "a"\n}\n', "short.json": "{}\n",
             "series.pvd": '<?xml version="1.0"?>\n<VTKFile type="Collection">\n</VTKFile>\n'}
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
        assert verified_text(tmp_path / name, Error) == text
    for libver in ("earliest", "v108", "latest"):
        with h5py.File(tmp_path / "history.h5", "w", libver=libver) as file:
            file["time"] = np.arange(3.0)
        assert list(history.read(tmp_path / "history.h5")) == ["time"]


def test_a_file_that_another_program_added_to_is_read(done):
    """h5py ignores data behind the end."""
    with h5py.File(done / "history.h5", "a") as file:
        file["mine"] = np.zeros(len(file["time"]))
    assert "mine" in history.read(done / "history.h5")


def test_restart_files_without_a_checksum_behind_them(done):
    data = (done / "restart.h5").read_bytes()
    (done / "restart.h5").write_bytes(data[: -len(" sha256 ") - checksums.DIGITS])
    assert snapshot.read(done / "restart.h5").scalars["time"] > 0.0


def test_nothing_but_files_is_read(tmp_path):
    os.mkfifo(tmp_path / "history.h5")
    (tmp_path / "deck.toml").mkdir()
    (tmp_path / "series.pvd").touch()
    with pytest.raises(StrangeFile, match=r"history\.h5 is a pipe"):
        verified(tmp_path / "history.h5", Error)
    for name, said in (("deck.toml", "it is not a file"), ("series.pvd", "it is empty"),
                       ("none.vtr", "No such file")):
        with pytest.raises(Error, match=f"{name} cannot be read: {said}"):
            verified(tmp_path / name, Error)


@pytest.mark.parametrize("name", ["deck.toml", "summary.json", "progress.json", "study.json", "series.pvd", "history.h5",
                                  "restart.h5", "dump_000000.vtr"])
def test_the_size_of_a_file_is_looked_at_before_it_is_read(tmp_path, name):
    """A file of a terabyte takes no memory."""
    file = tmp_path / name
    with open(file, "wb") as sparse:
        sparse.truncate(1 << 40)
    readers = {".toml": verified_text, ".json": read_json, ".pvd": lambda path, _: vtk.read_series(path),
               ".h5": lambda path, _: history.read(path), ".vtr": lambda path, _: vtk.read_grid(path)}
    with pytest.raises(Error, match=f"{name} cannot be read: it has 1099511627776 bytes; at most "):
        readers[file.suffix](file, Error)
    with pytest.raises(Error, match=f"{name}: cannot be read: it has 1099511627776 bytes; at most "):
        read_text(file, Error)


def test_a_large_file_is_checked_piece_by_piece(tmp_path):
    file = tmp_path / "history.h5"
    with open(file, "wb") as sparse:
        sparse.truncate(200_000_000)
    tracemalloc.start()
    checksums.verify(file, Error)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 60_000_000


def test_a_series_that_is_damaged_is_read_from_the_dumps(done):
    file = done / "series.pvd"
    times = [time for time, _ in vtk.read_series(file)]
    file.write_bytes(file.read_bytes().replace(b"timestep", b"timestop", 1))
    again = Series(done, dumps=len(times))
    assert "series.pvd does not fit its checksum" in again.repaired
    assert again.last_time == times[-1]


@pytest.mark.parametrize("suffix", [*checksums.FORMS, ".h5"])
def test_sealed_data_contain_their_original(suffix):
    begin = checksums.FORMS[suffix].begin if suffix in checksums.FORMS else b"\x89HDF\r\n\x1a\n"
    data = sealed(begin + b"the rest", suffix)
    assert data.startswith(begin)
    assert b"the rest" in data
    assert data.count(b"sha256") == 1
