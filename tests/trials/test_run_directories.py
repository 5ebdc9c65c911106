"""Spoiled run and study directories: every command that reads them says in words what it cannot use."""

import random
import shutil

import pytest

from tests.trials import spoil
from tests.trials.conftest import FEW

FURTHER = ["--set", "stop.cycles=40"]


def commands(run, study, folder, chance):
    """A command that reads the spoiled directory, and the statuses with which it may end."""
    picture = str(folder / "picture.png")
    return chance.choice((
        (["plot", run, "--out", picture], (0, 2, 4)),
        (["plot", run, "--out", picture, "--kind", "history", "--quantity", "penetration_depth_m"], (0, 2, 4)),
        (["export", run, "--out", str(folder / "export")], (0, 2, 4)),
        (["report", run, "--out", str(folder / "report")], (0, 2, 4)),
        (["report", study, "--out", str(folder / "report")], (0, 2, 4)),
        (["sweep", study, "--status"], (0, 2, 4)),
        (["model", "transition", "--rod", "W_alloy", "--target", "Al5083", "--runs", run], (0, 2, 4)),
        (["run", str(folder / "shot.toml"), *FEW, *FURTHER, "--restart", "--quiet", "--out", run], (0, 2, 3, 4)),
    ))


def spoiled_directories(seeds, finished, folder):
    """Spoils one or two files of a copy, and runs a command on it; returns how many reported that they could not use it."""
    reports = 0
    for seed in seeds:
        chance, place = random.Random(seed), folder / "place"
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(finished, place)
        files = sorted(file for file in (place / "run").rglob("*") if file.is_file())
        files += sorted(file for file in (place / "study").rglob("*") if file.suffix in (".json", ".toml", ".csv"))
        for file in {chance.choice(files), *chance.choices(files, k=chance.choice((0, 1)))}:
            spoil.file(file, chance, files)
        arguments, allowed = commands(str(place / "run"), str(place / "study"), place, chance)
        reports += spoil.judge(arguments, allowed)[0] != 0
    return reports


def test_unspoiled_directories_are_read(finished, tmp_path):
    for n in range(8):
        place = tmp_path / str(n)
        shutil.copytree(finished, place)
        arguments, _ = commands(str(place / "run"), str(place / "study"), place, random.Random(n))
        assert spoil.judge(arguments)[0] == 0


@pytest.mark.thorough
def test_spoiled_directories(finished, tmp_path):
    assert spoiled_directories(range(40), finished, tmp_path) > 3


@pytest.mark.slow
def test_a_thousand_spoiled_directories(finished, tmp_path, tell):
    reports = spoiled_directories(range(1000), finished, tmp_path)
    tell(f"1000 spoiled directories, {reports} refused in words, 0 failures")
    assert reports > 100
