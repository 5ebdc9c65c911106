"""The program of the page on EasyVVUQ, run in an environment of its own: it needs an older numpy than hydro2d."""

import os
import re
import subprocess
import sys

import pytest

from tests.rules import source

PAGE = (source.ROOT / "docs/how-to/easyvvuq.md").read_text(encoding="utf-8")
#: names the Python of an environment with EasyVVUQ
VARIABLE = "HYDRO2D_EASYVVUQ_PYTHON"


@pytest.mark.slow
@pytest.mark.skipif(VARIABLE not in os.environ, reason=f"{VARIABLE} does not name the Python of an environment with EasyVVUQ")
def test_the_program_of_the_page(tmp_path):
    (program,) = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    (tmp_path / "bar.py").write_text(program)
    command = tmp_path / "hydro2d"
    command.write_text(f'#!/bin/sh\nPYTHONPATH={source.ROOT} exec {sys.executable} -m hydro2d "$@"\n')
    command.chmod(0o755)
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    environment.pop("PYTHONPATH", None)
    done = subprocess.run([os.environ[VARIABLE], "bar.py"], cwd=tmp_path, env=environment, capture_output=True, text=True,
                          timeout=900)
    assert done.returncode == 0, done.stderr
    mean, velocity, factor = map(float, re.findall(r"[\d.]+(?=\])", done.stdout))
    assert mean == pytest.approx(0.0173, abs=2e-4)
    assert velocity + factor == pytest.approx(1.0, abs=0.02)
    assert velocity < factor
