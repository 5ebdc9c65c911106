"""Fixtures for several suites of trials."""

import shutil

import pytest

from tests.cli.test_main import DECK
from tests.trials import spoil
from tests.trials.test_texts import STUDY

FEW = ["--set", "stop.cycles=30", "--set", "output.vtk_interval='0.3 us'", "--set", "output.history_interval='0.1 us'"]


@pytest.fixture
def tell(capsys):
    """Prints a line past pytest's capture: the count of a long suite."""

    def tell(line):
        with capsys.disabled():
            print(f"\n{line}")

    return tell


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A run and a study of two such runs, done."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "shot.toml").write_text(DECK)
    assert spoil.judge(["run", str(folder / "shot.toml"), *FEW, "--quiet", "--out", str(folder / "run")])[0] == 0
    (folder / "study.toml").write_text(STUDY)
    from hydro2d.study.plan import cases
    from hydro2d.study.records import study_directory

    plan = cases.plan(folder / "study.toml")
    study_directory.make(folder / "study")
    study_directory.write(plan, folder / "study")
    for case in plan.cases[:2]:
        shutil.copytree(folder / "run", folder / "study" / study_directory.CASES / case.name)
    return folder
