"""Commands in forks of a process that has loaded hydro2d: with a fault at one of their writes, or several of them at once."""

from __future__ import annotations

import contextlib
import errno
import json
import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from hydro2d.cli.main import call
from hydro2d.files import strange
from tests.cli.test_main import DECK
from tests.study import made_up

SHOT = DECK.replace('"20 us"', '"0.3 us"') + """
[output]
vtk_interval = "1 us"
history_interval = "0.1 us"
"""
STUDY = """
title = "two velocities"
deck = "shot.toml"
keep = "rows/kept.csv"
[[axis]]
name = "velocity"
key = "body.rod.velocity"
values = ["900 m/s", "1100 m/s"]
"""
SAMPLE = """
deck = "shot.toml"
[sample]
method = "latin-hypercube"
n = 2
[sample.input."body.rod.velocity"]
uniform = ["1000 m/s", "1200 m/s"]
"""
SEARCH = """
deck = "shot.toml"
[transition]
from = "900 m/s"
to = "1300 m/s"
tolerance = "300 m/s"
"""
#: what happens at a write, by its name: an error from then on, an error once, the end of the process
FULL, ONCE, KILLED = "full from then on", "faulty once", "killed"
FAULTS = {FULL: errno.ENOSPC, ONCE: errno.EIO, KILLED: 0}


#: a command of each kind that writes; later ones read what earlier ones have written
COMMANDS = {
    "run": ["run", "shot.toml", "--out", "run", "--threads", "1"],
    "sweep": ["sweep", "study.toml", "--out", "study", "--workers", "1"],
    "sample": ["sweep", "sample.toml", "--out", "sample", "--workers", "1"],
    "search": ["transition", "search.toml", "--out", "search", "--workers", "1"],
    "report": ["report", "study"],
    "report of a sample": ["report", "sample"],
    "view": ["view", "run", "--no-open"],
    "export": ["export", "run"],
    "compile": ["compile", "shot.toml"],
    "status": ["sweep", "study", "--status"],
}


def write(folder: Path) -> None:
    """The deck and the studies into a folder."""
    for name, text in (("shot", SHOT), ("study", STUDY), ("sample", SAMPLE), ("search", SEARCH)):
        (folder / f"{name}.toml").write_text(text)


class Fault(NamedTuple):
    """What happens at which write, counted from 1; 0 : at none."""

    at: int = 0
    what: str = FULL


class Ended(NamedTuple):
    """A command that has ended: its status, what it has said, and its writes, which are not known if it was killed."""

    status: int
    said: str
    writes: list[str]


class _Writes:
    """Counts what a process does to the files of a folder: opening for writing, flushes, renamings and new folders."""

    def __init__(self, folder: Path, fault: Fault):
        self.folder, self.fault, self.seen = os.path.realpath(folder), fault, []
        self.active, self.open, self.fsync, self.write = True, open, os.fsync, os.write

    def listen(self) -> None:
        """From here on, for the rest of the process."""
        sys.addaudithook(self._heard)
        os.fsync, os.write, strange.open = self._flushed, self._written, self._opened

    def _heard(self, event: str, arguments: tuple) -> None:
        if event == "open" and isinstance(arguments[0], str) and arguments[2] & (os.O_WRONLY | os.O_RDWR):
            self._reached("open", arguments[0], arguments[0])
        elif event == "os.rename":
            self._reached("rename", arguments[1], arguments[0], arguments[1])
        elif event == "os.mkdir":
            self._reached("mkdir", arguments[0], arguments[0])

    def _flushed(self, number: int) -> None:
        self._reached("fsync", os.readlink(f"/proc/self/fd/{number}"))
        self.fsync(number)

    def _written(self, number: int, data: bytes) -> int:
        self._reached("write", os.readlink(f"/proc/self/fd/{number}"))
        return self.write(number, data)

    def _opened(self, path, mode, **options):
        """A log, each line of which is a write. A line that could not be written is written again as the file is closed."""
        file, waiting = self.open(path, mode, **options), []
        if "a" in mode:
            write, flush = file.write, file.flush

            def flushed() -> None:
                if waiting:
                    self._reached("flush", path)
                flush()
                waiting.clear()

            file.flush, file.write = flushed, lambda text: waiting.append(text) or write(text)
        return file

    def _reached(self, how: str, path: str | Path, *names: str | Path) -> None:
        """A write; names : that the operating system would put into the error"""
        path = os.path.abspath(path)
        if not self.active or not path.startswith(self.folder):
            return
        self.seen.append(f"{how} {os.path.relpath(path, self.folder)}")
        at, what = self.fault
        if not at or len(self.seen) < at or (len(self.seen) > at and what != FULL):
            return
        if what == KILLED:
            os.kill(os.getpid(), signal.SIGKILL)
        first, *second = names or (None,)
        raise OSError(FAULTS[what], os.strerror(FAULTS[what]), first, None, *second)


class Here(made_up.Client):
    """In place of the workers of this machine: cases run in this process as soon as they are submitted."""

    def __init__(self):
        super().__init__(lambda velocity, deck: {})

    def submit(self, work, *arguments, key, pure):
        return made_up._Future(key, made_up.Outcome(**work(*arguments)), lambda: None)


def _command(arguments: Sequence[str], folder: Path, said: Path, fault: Fault, gate, delay: float) -> None:
    """A command in this process, which ends with it."""
    with open(said, "w") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    os.chdir(folder)
    writes = _Writes(folder, fault)
    writes.listen()
    if gate is not None:
        gate.wait()
        time.sleep(delay)
    status = call(list(arguments))
    writes.active = False
    said.with_suffix(".json").write_text(json.dumps(writes.seen))
    sys.exit(status)


class Server:
    """Forks; each command has a process of its own, without the time to load hydro2d."""

    def __init__(self, scratch: Path):
        self.scratch, self.count = scratch, 0
        self.context = multiprocessing.get_context("forkserver")
        self.context.set_forkserver_preload(["pytest", "tests.trials.loaded"])

    def run(self, folder: Path, *arguments: str, fault: Fault = Fault()) -> Ended:  # noqa: B008
        """One command in a folder."""
        return self._ended(self._begun(folder, arguments, fault))

    def together(self, folder: Path, *commands: Sequence[str], delays: Sequence[float]) -> list[Ended]:
        """Several commands at once in a folder, which begin with these delays (s) when all of them have been started."""
        gate = self.context.Barrier(len(commands))
        begun = [self._begun(folder, command, Fault(), gate, delay) for command, delay in zip(commands, delays, strict=True)]
        return [self._ended(each) for each in begun]

    def _begun(self, folder: Path, arguments: Sequence[str], fault: Fault, gate=None, delay: float = 0.0):
        self.count += 1
        said = self.scratch / f"{self.count}.txt"
        process = self.context.Process(target=_command, args=(arguments, folder, said, fault, gate, delay))
        process.start()
        return process, said

    def _ended(self, begun, limit: float = 120.0) -> Ended:
        process, said = begun
        process.join(limit)
        assert process.exitcode is not None, f"still running after {limit} s: {said.read_text()}"
        writes = said.with_suffix(".json")
        return Ended(process.exitcode, said.read_text(), json.loads(writes.read_text()) if writes.exists() else [])


@contextlib.contextmanager
def server(scratch: Path) -> Iterator[Server]:
    """A server whose processes compute on one thread and draw without a display."""
    alone = {"OPENBLAS_NUM_THREADS": "1", "MPLBACKEND": "Agg"}
    before = dict(os.environ)
    os.environ.update(alone)
    try:
        yield Server(scratch)
    finally:
        os.environ.clear()
        os.environ.update(before)
