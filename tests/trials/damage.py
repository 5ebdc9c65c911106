"""Damaged files of a finished run and study, read by every reader: ``python -m tests.trials.damage FOLDER FIRST LAST``.

A process of its own, because faults in HDF5 or VTK may end it. For each file and seed it prints a line: the file, the damage,
and `refused`, `same` (the data read are those written) or `other`.
"""

from __future__ import annotations

import pickle
import random
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from hydro2d.base.errors import Error
from hydro2d.output import history, snapshot, vtk
from hydro2d.results import export, reading
from hydro2d.study.records import record, study_directory

#: bytes of a block that is zeroed
BLOCKS = (64, 512, 4096)


def damaged(data: bytes, chance: random.Random) -> tuple[str, bytes]:
    """The kind of damage, and the bytes: mostly one flipped bit, anywhere or near an end."""
    spoiled, size = bytearray(data), len(data)
    how = chance.choice(("bit", "bit", "bit", "head", "tail", "bytes", "cut", "longer", "zeros"))
    if how in ("bit", "head", "tail"):
        at = {"bit": range(size), "head": range(min(size, 600)), "tail": range(max(size - 600, 0), size)}[how]
        spoiled[chance.choice(at)] ^= 1 << chance.randrange(8)
    elif how == "bytes":
        for _ in range(chance.choice((2, 10, 1000))):
            spoiled[chance.randrange(size)] = chance.randrange(256)
    elif how == "cut":
        del spoiled[chance.choice((chance.randrange(size), max(size - chance.randrange(1, 200), 0))) :]
    elif how == "longer":
        spoiled += chance.randbytes(chance.choice((1, 64, 72, 500)))
    else:
        block = chance.choice(BLOCKS)
        at = chance.choice((0, chance.randrange(size), max(size - block, 0)))
        spoiled[at : at + block] = bytes(len(spoiled[at : at + block]))
    return how, bytes(spoiled)


def _columns(file: Path):
    return history.read(file), history.read_craters(file)


def _restart(file: Path):
    contents = snapshot.read(file)
    return contents.arrays, contents.texts()


def _grid(file: Path):
    return vars(vtk.read_grid(file))


def _pyvista(file: Path):
    grid = vtk.pyvista_grid(file)
    return {name: np.asarray(grid[name]) for name in grid.array_names}, np.asarray(grid.points)


def _exported(file: Path):
    out = file.parent.parent / "exported"
    shutil.rmtree(out, ignore_errors=True)
    export.export(reading.Results(file.parent.parent), out, ["pressure"])
    return (out / "vtk" / file.name).read_bytes()


def _case(directory: Path) -> study_directory.Case:
    (case,) = study_directory.load(directory).cases
    if case.status == study_directory.FAILED_STATUS:
        raise Error(case.message)
    return case


def _record(file: Path):
    stored = record.read(_case(next(folder for folder in file.parents if folder.name == "run")))
    if stored.problems:
        raise Error("; ".join(stored.problems))
    return stored.deck, stored.first, stored.last, stored.start


#: readers by file
READERS: dict[str, tuple[Callable, ...]] = {
    "run/history.h5": (_columns, _record),
    "run/restart.h5": (_restart,),
    "run/deck.toml": (lambda file: reading.Results(file.parent).tables, lambda file: _case(file.parent).deck, _record),
    "run/summary.json": (lambda file: reading.Results(file.parent).summary, lambda file: _case(file.parent).summary),
    "run/series.pvd": (vtk.read_series,),
    "run/interfaces.pvd": (vtk.read_series, _record),
    "run/vtk/dump_000001.vtr": (_grid, _pyvista),
    "run/vtk/interfaces_000000.vtp": (vtk.read_lines, lambda file: _record(file.parent)),
    "run/vtk/tracers_000001.vtp": (_exported,),
    "study/study.json": (lambda file: study_directory.read(file.parent).entries,),
}


def outcome(reader: Callable, file: Path, expected: bytes) -> str:
    try:
        return "same" if pickle.dumps(reader(file)) == expected else "other"
    except Error:
        return "refused"


def main(folder: Path, first: int, last: int) -> None:
    for name, readers in READERS.items():
        file = folder / name
        data = file.read_bytes()
        expected = [pickle.dumps(reader(file)) for reader in readers]
        for seed in range(first, last):
            how, spoiled = damaged(data, random.Random(f"{name} {seed}"))
            file.write_bytes(spoiled)
            for number, reader in enumerate(readers):
                print(name, seed, number, how, "begun", flush=True)
                print(name, seed, number, how, outcome(reader, file, expected[number]), flush=True)
        file.write_bytes(data)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
