"""Environment variables that stop a package that hydro2d stands on: one line that names the variable."""

import os
import subprocess
import sys

import pytest

from tests.cli.test_main import DECK

CHECK = ["run", "problems/verification/sod_z.toml", "--out", "nowhere"]
DRAW = ["curve", "Al5083", "--figure", "never.png"]


@pytest.mark.parametrize(("name", "value", "command", "said"), [
    ("NUMBA_DISABLE_JIT", "1", CHECK, "NUMBA_DISABLE_JIT is set"),
    ("MPLBACKEND", "nonsense", DRAW, 'MPLBACKEND = "nonsense" is not a backend of matplotlib'),
    ("SOURCE_DATE_EPOCH", "x", CHECK, 'SOURCE_DATE_EPOCH = "x" is no number of seconds'),
])
def test_a_variable_that_stops_a_package_is_named(name, value, command, said):
    done = subprocess.run([sys.executable, "-m", "hydro2d", *command], env=os.environ | {name: value}, capture_output=True,
                          text=True, timeout=300)
    assert done.returncode == 2
    assert done.stderr.startswith("hydro2d: " + said)
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("command", [["check", "shot.toml"], ["check", "shot.toml", "--picture", "start.png"]])
def test_a_home_that_cannot_be_written_ends_no_command(tmp_path, command):
    """Nor can the folders for caches and settings."""
    (tmp_path / "shot.toml").write_text(DECK)
    (tmp_path / "file").write_text("")
    names = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "NUMBA_CACHE_DIR", "MPLCONFIGDIR", "HYDRO2D_CACHE_DIR")
    nowhere = dict.fromkeys(names, str(tmp_path / "file" / "below"))
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    done = subprocess.run([sys.executable, "-m", "hydro2d", *command], cwd=tmp_path, capture_output=True, text=True,
                          timeout=300, env={**os.environ, **nowhere, "PYTHONPATH": root})
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
