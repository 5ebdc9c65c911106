"""Damaged files: every reader reads what was written or refuses it in words, and no library gets data that crash it."""

import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def trials(finished, folder, first, last):
    """Damages each file once for each seed; returns how often its readers refused it, and how often the data were the same."""
    shutil.copytree(finished, folder / "place")
    command = [sys.executable, "-m", "tests.trials.damage", str(folder / "place"), str(first), str(last)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    lines = [line.split() for line in done.stdout.splitlines()]
    assert done.returncode == 0, (lines[-1], done.stderr[-2000:])
    assert done.stderr == ""
    assert [line for line in lines if line[-1] == "other"] == []
    return Counter(line[-1] for line in lines if line[-1] != "begun")


@pytest.mark.thorough
def test_damaged_files(finished, tmp_path):
    assert trials(finished, tmp_path, 0, 25)["refused"] > 300


@pytest.mark.slow
def test_thousands_of_damaged_files(finished, tmp_path, tell):
    counts = trials(finished, tmp_path, 1000, 1400)
    tell(f"4000 damaged files, {counts.total()} readings: {counts['refused']} refused, {counts['same']} as written, 0 crashes")
    assert counts["refused"] > 5000
