"""restart.h5: everything that a run needs to continue with bitwise identical results.

The file holds every array of the state, the scalars of the simulation and of the run as JSON, and the text of the deck. A
SHA-256 of all these and the attribute `complete` are written last; the checksum of the file itself follows its end. The
previous file is kept as restart.previous.h5.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hydro2d.base.errors import Error
from hydro2d.files import checksums
from hydro2d.files.locks import check_place
from hydro2d.files.strange import own
from hydro2d.files.whole import hdf5, replacing, sync
from hydro2d.output import foreign

FORMAT = "hydro2d restart 7"
NAME, PREVIOUS = "restart.h5", "restart.previous.h5"


class SnapshotError(Error):
    """A restart file that is missing, truncated, altered or not of hydro2d; the message is one line for the user."""


@dataclass(frozen=True)
class Snapshot:
    """The contents of a restart file.

    arrays : every array of the state by name;  scalars : of the simulation;  run : of the run directory (output
    schedule, rows written);  deck : resolved TOML;  provenance : see provenance.collect
    """

    arrays: dict[str, np.ndarray]
    scalars: dict
    run: dict
    deck: str
    provenance: dict

    def texts(self) -> dict[str, str]:
        return {
            "deck": self.deck,
            "provenance": json.dumps(self.provenance),
            "run": json.dumps(self.run),
            "scalars": json.dumps(self.scalars),
        }


def _checksum(arrays: dict[str, np.ndarray], texts: dict[str, str]) -> str:
    digest = hashlib.sha256()
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape}\n".encode())
        digest.update(array.tobytes())
    for name in sorted(texts):
        digest.update(f"{name}\n{texts[name]}\n".encode())
    return digest.hexdigest()


def write(path: Path, snapshot: Snapshot) -> None:
    """Writes a restart file. An existing one is kept as the previous one."""
    path = Path(path)
    texts = snapshot.texts()
    with replacing(path) as temporary:
        with hdf5(temporary) as file:
            file.attrs["format"] = FORMAT
            group = file.create_group("arrays")
            for name, array in snapshot.arrays.items():
                array = np.asarray(array)
                packing = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if array.size > 64 else {}
                group.create_dataset(name, data=array, **packing)
            for name, text in texts.items():
                file.create_dataset(name, data=text)
            file.attrs["sha256"] = _checksum(snapshot.arrays, texts)
            file.attrs["complete"] = True
        sync(temporary)
        check_place(path)
        if path.exists():
            os.replace(path, path.with_name(PREVIOUS))


def read(path: Path) -> Snapshot:
    """Reads and verifies a restart file. Raises SnapshotError with one line for any faulty file."""
    import h5py

    path = own(Path(path))
    if not path.is_file():
        raise SnapshotError(f"{path}: there is no such restart file")
    checksums.verify(path, SnapshotError)
    try:
        with h5py.File(path, "r") as file:
            foreign.check_hdf5(file)
            if (version := file.attrs.get("format")) != FORMAT:
                raise SnapshotError(f'{path}: a restart file of another version ("{version}"; this one reads "{FORMAT}")'
                                    if str(version).startswith(FORMAT[:-1]) else f"{path}: not a restart file of hydro2d")
            if not file.attrs.get("complete", False):
                raise SnapshotError(f"{path}: the restart file was never completed")
            arrays = {name: dataset[...] for name, dataset in file["arrays"].items()}
            texts = {name: file[name][()].decode() for name in ("deck", "provenance", "run", "scalars")}
            expected = file.attrs["sha256"]
    except (OSError, KeyError, ValueError, RuntimeError, AttributeError, TypeError) as error:
        raise SnapshotError(f"{path}: truncated or not a restart file ({error})") from None
    if _checksum(arrays, texts) != expected:
        raise SnapshotError(f"{path}: the checksum does not match; the file is damaged")
    try:
        values = {name: text if name == "deck" else json.loads(text) for name, text in texts.items()}
    except (ValueError, RecursionError) as error:
        raise SnapshotError(f"{path}: not a restart file of hydro2d: {error}") from None
    return Snapshot(arrays=arrays, **values)


@contextmanager
def fitting(directory: Path) -> Iterator[None]:
    """Raises SnapshotError if the contents of a restart file do not fit the run that this block loads them into."""
    try:
        yield
    except (KeyError, TypeError, ValueError) as error:
        what = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise SnapshotError(f"{directory}: the restart file does not fit: {what}") from None


def read_latest(directory: Path) -> tuple[Snapshot, list[str]]:
    """The newest readable restart file of a run directory, and the faults of a newer one.

    Raises SnapshotError if neither of the two files can be read.
    """
    problems = []
    for name in (NAME, PREVIOUS):
        try:
            return read(Path(directory) / name), problems
        except SnapshotError as error:
            problems.append(str(error))
    if not any((Path(directory) / name).exists() for name in (NAME, PREVIOUS)):
        raise SnapshotError(f"{directory}: there is no restart file ({NAME}) to continue from")
    raise SnapshotError("; ".join(problems))
