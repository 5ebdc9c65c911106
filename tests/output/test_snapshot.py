"""A restart file is whole or gives one clear error."""

import os

import h5py
import numpy as np
import pytest

from hydro2d.output import snapshot
from hydro2d.output.snapshot import Snapshot, SnapshotError


def sample(value=1.0):
    rng = np.random.default_rng(1)
    arrays = {"vof": rng.random((3, 40, 30)), "zone": np.arange(300, dtype=np.int8), "u": np.full((1, 4, 4), value)}
    return Snapshot(arrays, {"dt": 0.1 / 3, "cycle": 7, "limit": float("inf")}, {"rows": 4}, 'title = "µ"', {"a": None})


def test_round_trip_is_exact(tmp_path):
    snapshot.write(tmp_path / "restart.h5", sample())
    back = snapshot.read(tmp_path / "restart.h5")
    for name, array in sample().arrays.items():
        assert back.arrays[name].tobytes() == array.tobytes()
        assert back.arrays[name].dtype == array.dtype
    assert (back.scalars, back.run, back.deck, back.provenance) == (
        sample().scalars, sample().run, sample().deck, sample().provenance
    )


def test_two_are_kept(tmp_path):
    for value in (1.0, 2.0, 3.0):
        snapshot.write(tmp_path / "restart.h5", sample(value))
    assert snapshot.read(tmp_path / "restart.h5").arrays["u"][0, 0, 0] == 3.0
    assert snapshot.read(tmp_path / "restart.previous.h5").arrays["u"][0, 0, 0] == 2.0
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.9, 0.999])
def test_truncated(tmp_path, share):
    path = tmp_path / "restart.h5"
    snapshot.write(path, sample())
    os.truncate(path, int(share * path.stat().st_size))
    with pytest.raises(SnapshotError, match="restart.h5"):
        snapshot.read(path)


def test_one_flipped_byte_anywhere_is_noticed(tmp_path):
    path = tmp_path / "restart.h5"
    snapshot.write(path, sample())
    good = path.read_bytes()
    reference = snapshot.read(path)
    rng = np.random.default_rng(2)
    for place in rng.integers(0, len(good), 150):
        damaged = bytearray(good)
        damaged[place] ^= 0x55
        path.write_bytes(damaged)
        try:
            back = snapshot.read(path)
        except SnapshotError:
            continue
        # a byte that carries no information
        assert back.scalars == reference.scalars
        assert all(back.arrays[name].tobytes() == array.tobytes() for name, array in reference.arrays.items())


@pytest.mark.parametrize("content", [b"", b"hello", b"\x89HDF\r\n\x1a\n" + bytes(500)])
def test_foreign_file(tmp_path, content):
    (tmp_path / "restart.h5").write_bytes(content)
    with pytest.raises(SnapshotError):
        snapshot.read(tmp_path / "restart.h5")


def test_foreign_hdf5(tmp_path):
    with h5py.File(tmp_path / "restart.h5", "w") as file:
        file["x"] = 1
    with pytest.raises(SnapshotError, match="not a restart file"):
        snapshot.read(tmp_path / "restart.h5")


def test_texts_that_are_not_json(tmp_path):
    texts = {name: "{" for name in ("deck", "provenance", "run", "scalars")}
    with h5py.File(tmp_path / "restart.h5", "w") as file:
        file.attrs.update(format=snapshot.FORMAT, complete=True, sha256=snapshot._checksum({}, texts))
        file.create_group("arrays")
        for name, text in texts.items():
            file[name] = text
    with pytest.raises(SnapshotError, match="not a restart file of hydro2d: Expecting"):
        snapshot.read(tmp_path / "restart.h5")


def test_never_completed(tmp_path):
    snapshot.write(tmp_path / "restart.h5", sample())
    with h5py.File(tmp_path / "restart.h5", "a") as file:
        del file.attrs["complete"]
    with pytest.raises(SnapshotError, match="never completed"):
        snapshot.read(tmp_path / "restart.h5")


def test_changed_number(tmp_path):
    snapshot.write(tmp_path / "restart.h5", sample())
    with h5py.File(tmp_path / "restart.h5", "a") as file:
        file["arrays/u"][0, 0, 0] = 1.0 + 2**-52
    with pytest.raises(SnapshotError, match="checksum"):
        snapshot.read(tmp_path / "restart.h5")


def test_latest_falls_back(tmp_path):
    snapshot.write(tmp_path / "restart.h5", sample(1.0))
    snapshot.write(tmp_path / "restart.h5", sample(2.0))
    os.truncate(tmp_path / "restart.h5", 1000)
    latest, problems = snapshot.read_latest(tmp_path)
    assert latest.arrays["u"][0, 0, 0] == 1.0
    assert len(problems) == 1


def test_a_failed_write_leaves_what_was_there(tmp_path, monkeypatch):
    snapshot.write(tmp_path / "restart.h5", sample(1.0))
    monkeypatch.setattr(snapshot, "sync", lambda path: (_ for _ in ()).throw(OSError("disk full")))
    with pytest.raises(OSError, match="disk full"):
        snapshot.write(tmp_path / "restart.h5", sample(2.0))
    assert snapshot.read(tmp_path / "restart.h5").arrays["u"][0, 0, 0] == 1.0
    assert len(list(tmp_path.iterdir())) == 1
