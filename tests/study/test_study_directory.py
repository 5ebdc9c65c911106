"""Studies and folders of runs are read back in any state."""

import json
import os
import shutil
import socket

import pytest

from hydro2d.study.records import study_directory
from hydro2d.study.records.study_directory import StudyError
from tests.locks import held
from tests.study import fake

AXES = {"velocity": fake.velocities(1086, 1200), "advection": {"ke": ("numerics.advection=ke",)}}


@pytest.fixture
def study(tmp_path):
    return fake.write_study(tmp_path / "figure", AXES)


def statuses(directory):
    return {case.name: (case.status, case.message) for case in study_directory.load(directory).cases}


def test_a_study(study):
    read = study_directory.load(study)
    assert read.title == "A study"
    assert [(axis.name, axis.key, axis.values) for axis in read.axes] == [
        ("velocity", "body.rod.velocity", ("1086 m/s", "1200 m/s")), ("advection", None, ("ke",))]
    first = read.cases[0]
    assert (first.name, first.values) == ("1086m-s_ke", {"velocity": "1086 m/s", "advection": "ke"})
    assert (first.status, first.message, first.summary["cycles"]) == ("done", "", 1000)


def test_every_state_of_a_case(study):
    case = study / "cases" / "1086m-s_ke"
    fake.edit_json(case / "summary.json", status="unphysical", stop_reason="cell (3, 4): density -1 kg/m3")
    assert statuses(study)[case.name] == ("unphysical", "cell (3, 4): density -1 kg/m3")
    (case / "summary.json").unlink()
    assert statuses(study)[case.name][0] == "waiting"
    (case / "restart.h5").touch()
    assert statuses(study)[case.name][0] == "interrupted"
    with held(case / "run.lock", os.getpid()):
        assert statuses(study)[case.name] == ("running", f"process {os.getpid()} on {socket.gethostname()}")
    (case / "failed.json").write_text('{"reason": "the disk is full", "kind": "OSError"}')
    assert statuses(study)[case.name] == ("failed", "the disk is full")
    shutil.rmtree(case)
    assert statuses(study)[case.name] == ("waiting", "")
    cases = json.loads((study / "study.json").read_text())["cases"]
    cases[0] |= {"status0": "invalid", "message": "mesh.r: is missing"}
    fake.edit_json(study / "study.json", cases=cases)
    assert statuses(study)[case.name] == ("invalid", "mesh.r: is missing")
    assert statuses(study)["1200m-s_ke"] == ("done", "")


@pytest.mark.parametrize("file", ["summary.json", "failed.json"])
def test_a_broken_file_is_the_message_of_its_case(study, file):
    (study / "cases" / "1086m-s_ke" / file).write_text('{"status": "do')
    status, message = statuses(study)["1086m-s_ke"]
    assert status == "failed"
    assert f"{file} cannot be read" in message


def test_a_folder_and_several_runs(study, tmp_path):
    cases = study / "cases"
    folder, one = study_directory.load(cases), study_directory.load(cases / "1200m-s_ke")
    assert (folder.title, folder.axes) == ("cases", ())
    assert [case.name for case in folder.cases] == ["1086m-s_ke", "1200m-s_ke"]
    assert [case.name for case in one.cases] == ["1200m-s_ke"]
    shutil.copytree(cases, tmp_path / "other")
    both = study_directory.gather([cases, tmp_path / "other" / "1086m-s_ke", cases / "1086m-s_ke"])
    assert [case.name for case in both.cases] == ["figure/cases/1086m-s_ke", "figure/cases/1200m-s_ke", "other/1086m-s_ke"]
    assert len(study_directory.gather([study, tmp_path / "other"]).cases) == 4


def test_a_folder_that_is_no_study(study, tmp_path):
    with pytest.raises(StudyError, match='no such directory; did you mean "figure"'):
        study_directory.load(tmp_path / "figur")
    (tmp_path / "empty").mkdir()
    with pytest.raises(StudyError, match="holds no runs"):
        study_directory.load(tmp_path / "empty")
    with pytest.raises(StudyError, match="is a file"):
        study_directory.load(study / "study.json")
    (study / "study.json").write_text('{"title": "A study"}')
    with pytest.raises(StudyError, match="is not a valid study file"):
        study_directory.load(study)
    (study / "study.json").write_text('{"name": "x", "axes": [], "cases": []}')
    with pytest.raises(StudyError, match="no cases"):
        study_directory.load(study)
