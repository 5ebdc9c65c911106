"""Commands where hydro2d lacks what Windows lacks: modules, and attributes of modules."""

import json
import os
import subprocess
import sys

import pytest

from tests.rules import source

#: the start of every Python process of the test
WITHOUT = """
import builtins, os, signal, types
real = builtins.__import__
lacking = {os: {"O_NOFOLLOW", "O_NONBLOCK", "fchdir", "getuid", "sched_getaffinity", "sysconf"},
           signal: {"ITIMER_REAL", "SIGALRM", "SIGHUP", "SIGPIPE", "setitimer"}}
copies = {}
for module, names in lacking.items():
    copy = copies[module.__name__] = types.ModuleType(module.__name__)
    copy.__dict__.update({name: value for name, value in vars(module).items() if name not in names})

def imported(name, globals=None, locals=None, fromlist=(), level=0):
    if (globals or {}).get("__name__", "").split(".")[0] == "hydro2d":
        if name in ("fcntl", "resource", "pwd", "grp", "termios"):
            raise ImportError(name)
        if name in copies:
            return copies[name]
    return real(name, globals, locals, fromlist, level)

builtins.__import__ = imported
"""
STUDY = """
title = "two shock tubes"
deck = "problems/verification/sod_z.toml"
[[axis]]
name = "n"
key = "stop.cycles"
values = [10, 12]
"""


@pytest.mark.thorough
def test_a_deck_a_restart_a_page_a_picture_and_a_sweep_with_two_workers(tmp_path):
    (tmp_path / "without").mkdir()
    (tmp_path / "without" / "sitecustomize.py").write_text(WITHOUT)
    (tmp_path / "study.toml").write_text(STUDY)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (tmp_path / "without", source.ROOT)))}

    def hydro2d(*words):
        done = subprocess.run([sys.executable, "-m", "hydro2d", *words], cwd=tmp_path, env=environment, capture_output=True,
                              encoding="utf-8")
        assert done.returncode == 0, done.stderr
        return done.stdout

    def state(run):
        return json.loads((tmp_path / run / "summary.json").read_text())["bodies"]

    look = "from hydro2d.base import interrupt; from hydro2d.files import locks; print(locks.fcntl, interrupt.ALARM)"
    seen = subprocess.run([sys.executable, "-c", look], env=environment, capture_output=True, encoding="utf-8")
    assert seen.stdout == "None None\n"
    tube = ("run", "problems/verification/sod_z.toml", "--threads", "1", "--out")
    hydro2d(*tube, "whole", "--set", "stop.cycles=20")
    hydro2d(*tube, "parts", "--set", "stop.cycles=10")
    assert "continuing at cycle 10" in hydro2d(*tube, "parts", "--set", "stop.cycles=20", "--restart")
    assert state("parts") == state("whole")
    hydro2d("view", "whole", "--no-open")
    hydro2d("plot", "whole", "-o", "tube.png")
    assert (tmp_path / "tube.png").stat().st_size > 1000
    hydro2d("sweep", "study.toml", "--workers", "2", "--out", "study", "--quiet")
    assert [json.loads(file.read_text())["cycles"] for file in sorted(tmp_path.glob("study/cases/*/summary.json"))] == [10, 12]
