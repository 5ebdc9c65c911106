"""Environment variables that stop a package that hydro2d stands on: one line that names the variable."""

import os
import subprocess
import sys

import pytest

CHECK = ["run", "problems/verification/sod_z.toml", "--out", "nowhere"]
DRAW = ["curve", "Al5083", "--figure", "never.png"]


@pytest.mark.parametrize(("name", "value", "command", "said"), [
    ("NUMBA_DISABLE_JIT", "1", CHECK, "NUMBA_DISABLE_JIT is set"),
    ("MPLBACKEND", "nonsense", DRAW, 'MPLBACKEND = "nonsense" is not a backend of matplotlib'),
    ("SOURCE_DATE_EPOCH", "x", CHECK, 'SOURCE_DATE_EPOCH = "x" is no number of seconds'),
])  # fmt: skip
def test_a_variable_that_stops_a_package_is_named(name, value, command, said):
    done = subprocess.run([sys.executable, "-m", "hydro2d", *command], env=os.environ | {name: value}, capture_output=True,
                          text=True, timeout=300)  # fmt: skip
    assert done.returncode == 2
    assert done.stderr.startswith("hydro2d: " + said)
    assert done.stderr.count("\n") == 1
