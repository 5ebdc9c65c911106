"""Small studies for tests: Sod's shock tube, which takes a second."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

from hydro2d.output import history, snapshot

ROOT = Path(__file__).resolve().parents[2]
TUBE = (ROOT / "problems" / "verification" / "sod_z.toml").read_text()
STUDY = """
title = "Shock tubes"
deck = "tube.toml"
[set]
stop.time = 0.01
[[axis]]
name = "advection"
key = "numerics.advection"
values = ["ke", "momentum"]
[[axis]]
name = "pressure"
key = "body.low.pressure"
values = [0.1, 0.2]
"""
#: thousands of cycles: seconds in which to be hit, with a restart file after each
LONG = ["--set", "stop.time=3", "--set", "output.restart_interval=0.3"]


def write(folder: Path, text: str = STUDY) -> Path:
    """A study file with its deck next to it."""
    (folder / "tube.toml").write_text(TUBE)
    file = folder / "tubes.toml"
    file.write_text(text)
    return file


def start(*arguments, command: str = "sweep", **options) -> subprocess.Popen:
    """`hydro2d sweep`, or another command, as a process of its own."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
    words = [sys.executable, "-m", "hydro2d", command, *map(str, arguments)]
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, **options)


def sweep(*arguments, **options) -> tuple[int, str]:
    """`start`, run to its end: exit status and output."""
    process = start(*arguments, **options)
    said, _ = process.communicate(timeout=900)
    return process.returncode, said


def wait_for(condition, seconds: float = 300):
    """The first true value of a function; fails where it takes too long."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"nothing within {seconds} s")


def bits(directory: Path) -> tuple:
    """Everything computed by a run: arrays and scalars of the restart file, and the history."""
    saved = snapshot.read(directory / "restart.h5")
    arrays = {name: array.tobytes() for name, array in saved.arrays.items()}
    columns = {name: column.tobytes() for name, column in history.read(directory / "history.h5").items()}
    return arrays, saved.scalars, columns
