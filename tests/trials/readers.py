"""Everything that reads a file of a user, a run, a study or the cache, and what can have become of such a file."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import NamedTuple

from hydro2d.deck import deck
from hydro2d.deck.shapes.registry import KINDS
from hydro2d.files import csv_tables, locks
from hydro2d.files.csv_tables import Column, number, whole
from hydro2d.jit import compilation
from hydro2d.materials import fitting, outside
from hydro2d.output import history, snapshot, vtk
from hydro2d.results import reading, summaries
from hydro2d.results.reading import ResultsError
from hydro2d.study.plan import definition, sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records import keeping, study_directory
from tests.cli.test_main import DECK
from tests.materials import test_sesame
from tests.materials.made_models import VOCE
from tests.measure.test_own_results import RIM
from tests.trials.damage import damaged
from tests.trials.test_texts import STUDY

assert KINDS  # shapes are known before a deck is read


class Reader(NamedTuple):
    """How a file is read.

    file : its path in the folder of the trial;  read : takes that path
    texts : files that are written there first; without them, the folder has a finished run and study
    sealed : whether the file has a checksum, so that only what was written is accepted
    kept : whether the file of a run or study must be no link;  may : damages that this file may have, and still be read
    """

    file: str
    read: Callable[[Path], object]
    texts: dict[str, str] | None = None
    sealed: bool = False
    kept: bool = False
    may: tuple[str, ...] = ()


def _sesame(file: Path):
    return deck.load(file.parent / "shot.toml").materials["al"].eos.table


def _state(file: Path) -> str:
    compilation._state, kept = (lambda key: file), compilation._state
    try:
        return compilation.progress_of("")
    finally:
        compilation._state = kept


def _results(file: Path):
    results = reading.Results(file.parent)
    return results.tables, results.summary


def _history(file: Path):
    return history.read(file), history.read_craters(file), history.read_debris(file)


def _restart(file: Path):
    contents = snapshot.read(file)
    return contents.arrays, contents.texts()


ROW = {**dict.fromkeys((*keeping.ORIGIN, *keeping.RESULTS, keeping.CELLS), ""), "status": "done", keeping.MEMBER: "0"}
ROWS = f"{','.join(ROW)}\n{','.join(ROW.values())}\n"
SAMPLES = (Column(sampling.AXIS, whole, empty=False), Column("a", number))
READERS = {
    "deck": Reader("shot.toml", lambda file: deck.load(file).to_toml(), {"shot.toml": DECK}),
    "included file": Reader("part.toml", lambda file: deck.load(file.parent / "shot.toml").to_toml(),
                            {"shot.toml": f'include = "part.toml"\n{DECK}', "part.toml": 'title = "x"\n'}),
    "study": Reader("study.toml", lambda file: definition.read(file, ())[0], {"study.toml": STUDY}),
    "points of a sample": Reader("x.csv", sampling.read, {"x.csv": "body.rod.velocity [m/s]\n1086\n1090\n"}),
    "model": Reader("voce.py", lambda file: outside.read(file).text, {"voce.py": VOCE}),
    "results of one's own": Reader("rim.py", lambda file: deck.load(file.parent / "shot.toml").result["rim"].code,
                                   {"shot.toml": f'{DECK}\n[result.rim]\nfile = "rim.py"\n', "rim.py": RIM}),
    "table of an equation of state": Reader("al.301", _sesame, {"shot.toml": test_sesame.DECK, "al.301": test_sesame.PLAIN}),
    "measured flow stresses": Reader("steel.txt", fitting.read_points, {"steel.txt": "0.1 1.0 300 5e8\n0.2 1.0 300 6e8\n"}),
    "kept rows": Reader("kept.csv", keeping.read, {"kept.csv": ROWS}),
    "samples": Reader("samples.csv", lambda file: csv_tables.read(file, SAMPLES, StudyError, "write it anew"),
                      {"samples.csv": f"{sampling.AXIS},a\n1,2\n"}),
    "compilation": Reader("key.state", _state, {"key.state": "compiles\n"}),
    "lock": Reader("run.lock", locks.holder, {"run.lock": "elsewhere 12\n"}, kept=True),
    "progress": Reader("progress.json", lambda file: summaries.progress_of(file.parent, ResultsError),
                       {"progress.json": '{"time_s": 1.0}'}, kept=True),
    "history": Reader("run/history.h5", _history, sealed=True, kept=True),
    "restart": Reader("run/restart.h5", _restart, sealed=True, kept=True),
    "deck of a run": Reader("run/deck.toml", _results, sealed=True, kept=True),
    "summary": Reader("run/summary.json", lambda file: _results(file)[1], sealed=True, kept=True, may=("gone", "table")),
    "series": Reader("run/series.pvd", vtk.read_series, sealed=True, kept=True),
    "dump": Reader("run/vtk/dump_000001.vtr", lambda file: vars(vtk.read_grid(file)), sealed=True, kept=True),
    "outlines": Reader("run/vtk/interfaces_000000.vtp", vtk.read_lines, sealed=True, kept=True),
    "record of a study": Reader("study/study.json", lambda file: study_directory.read(file.parent).entries, sealed=True,
                                kept=True),
}

#: largest sizes that are read, and one byte more, by the ending of a file; a hole takes no room on the disk
HUGE = {".h5": (1 << 36) + 1, ".vtr": (1 << 36) + 1, ".vtp": (1 << 36) + 1}


def _bytes(change: Callable[[bytes], bytes]) -> Callable[[Path, Random], None]:
    return lambda file, chance: file.write_bytes(change(file.read_bytes()))  # type: ignore[func-returns-value]


def _instead(make: Callable[[Path], object]) -> Callable[[Path, Random], None]:
    def change(file: Path, chance: Random) -> None:
        file.unlink()
        make(file)

    return change


def _link(file: Path) -> None:
    other = file.with_name("elsewhere")
    other.symlink_to(file.name)
    file.symlink_to(other.name)


def _another(file: Path, chance: Random) -> None:
    shutil.move(file, file.with_name("moved"))
    file.symlink_to("moved")


#: what can have become of a file
DAMAGES: dict[str, Callable[[Path, Random], None]] = {
    "gone": lambda file, chance: file.unlink(),
    "empty": _bytes(lambda data: b""),
    "cut": _bytes(lambda data: data[: len(data) // 2]),
    **{f"damaged {n}": lambda file, chance: file.write_bytes(damaged(file.read_bytes(), chance)[1]) for n in range(6)},
    "list": _bytes(lambda data: b"[]"), "number": _bytes(lambda data: b"7"), "null": _bytes(lambda data: b"null"),
    "deep": _bytes(lambda data: 100_000 * b"["), "table": _bytes(lambda data: b'{"a": 1}'),
    "binary": lambda file, chance: file.write_bytes(chance.randbytes(5000)),
    "nulls": _bytes(lambda data: data[:100] + 10 * b"\0" + data[100:]),
    "utf-16": _bytes(lambda data: data.decode("latin-1").encode("utf-16")),
    "latin-1": _bytes(lambda data: "Größe = ß,ä\n".encode("latin-1") + data),
    "separators": _bytes(lambda data: data[:20] + "a\u2028b\x85c\x0bd".encode() + data[20:]),
    "long line": _bytes(lambda data: 1_000_000 * b"x"), "long cell": _bytes(lambda data: data + b'"' + 200_000 * b"x" + b'"\n'),
    "open quote": _bytes(lambda data: data + b'"a'), "quote": _bytes(lambda data: data + b'"a"b\n'),
    "huge": lambda file, chance: os.truncate(file, HUGE.get(file.suffix, (1 << 28) + 1)),
    "folder": _instead(Path.mkdir), "pipe": _instead(os.mkfifo), "device": _instead(lambda file: file.symlink_to("/dev/zero")),
    "loop of links": _instead(_link), "link to nothing": _instead(lambda file: file.symlink_to("nothing")), "link": _another,
}
