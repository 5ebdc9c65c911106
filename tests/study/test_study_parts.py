"""Studies of parts: their cost, their order, and which parts are up to date."""

import csv
import signal

import pytest

from hydro2d.study import study_parts
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.scaling import AS_IT_IS, Size
from hydro2d.study.records import study_directory
from tests.rules import source
from tests.study import tubes

PARTS = """
title = "Both"
out = "OUT"
[[part]]
study = "tubes.toml"
name = "first"
only = ["ke*"]
about = "one scheme"
[[part]]
study = "tubes.toml"
skip = ["ke*"]
"""


def write(folder, more=""):
    """A study of two parts, which keep their rows in one file."""
    tubes.write(folder, 'keep = "rows.csv"\n' + tubes.STUDY + more)
    file = folder / "both.toml"
    file.write_text(PARTS.replace("OUT", str(folder / "out")))
    return file


@pytest.mark.thorough
def test_parts_run_in_turn_and_once(tmp_path):
    file, out = write(tmp_path), tmp_path / "out"
    status, said = tubes.sweep(file, "--workers", 2)
    assert status == 0, said
    assert said.index("part 1 of 2: first") < said.index("ke_0.1: done") < said.index("part 2 of 2: tubes")
    assert {case.name: case.status for case in study_directory.read(out / "first").cases} == {
        "ke_0.1": "done", "ke_0.2": "done", "momentum_0.1": "waiting", "momentum_0.2": "waiting"}
    with open(tmp_path / "rows.csv", encoding="utf-8", newline="") as rows:
        assert [row["advection"] for row in csv.DictReader(rows)] == ["ke", "ke", "momentum", "momentum"]
    status, said = tubes.sweep(file, "--out", tmp_path / "elsewhere")
    assert status == 0, said
    assert said.count("nothing to run") == 2
    assert not list((tmp_path / "elsewhere").glob("*/cases"))
    status, said = tubes.sweep(file, "--status")
    assert (status, said) == (0, "first: 2 of 4 done, 2 waiting\ntubes: 2 of 4 done, 2 waiting\n")


def test_the_cost_of_a_study(tmp_path, capsys):
    file = write(tmp_path)
    plans = study_parts.plans(file, (), AS_IT_IS, quiet=True)
    assert [each.states for each in plans] == [(2, 0, 0), (2, 0, 0)]
    assert study_parts.show(plans, 2) == 0
    said = capsys.readouterr().out
    assert [line.split()[:5] for line in said.splitlines()[1:4]] == [
        ["first", "2", "0", "0", "2"], ["tubes", "2", "0", "0", "2"], ["all", "4", "0", "0", "4"]]
    assert "first: one scheme" in said
    assert "4 runs, about" in said


def test_members_of_all_parts(tmp_path):
    file = write(tmp_path, '[ensemble]\nrepeats = 2\nby = ["first step"]\n')
    numbers = {size: [each.states[0] for each in study_parts.plans(file, (), Size(members=size), quiet=True)]
               for size in (None, 1, 3)}
    assert numbers == {None: [4, 4], 1: [2, 2], 3: [6, 6]}


def test_parts_by_name(tmp_path):
    assert [each.name for each in study_parts.plans(write(tmp_path), (), AS_IT_IS, ["fir*"], quiet=True)] == ["first"]
    with pytest.raises(StudyError, match="matches no part; parts: first, tubes"):
        study_parts.plans(write(tmp_path), (), AS_IT_IS, ["last"], quiet=True)


def test_a_search_has_only_the_combinations_of_its_part(tmp_path):
    """Of the law of its rod, of which one part takes one and leaves another out; a pattern without a case is refused."""
    search = f'[[part]]\nstudy = "{source.PROBLEMS}/cth_nose_shape/transition.toml"\n'
    for pattern, law in (('only = ["hemi*90W_5083_*"]', "Johnson-Cook, 90W"), ('skip = ["*Johnson*"]', "Steinberg-Guinan")):
        (tmp_path / "part.toml").write_text(search + pattern)
        (part,) = study_parts.plans(tmp_path / "part.toml", (), AS_IT_IS, quiet=True)
        assert {case.values["law"] for case in part.plan.cases} == {law}
        assert len(part.choice.groups) == len({tuple(case.values[axis] for axis in ("nose", "law", "plate"))
                                               for case in part.plan.cases})
    (tmp_path / "part.toml").write_text(search + 'only = ["flat*"]')
    with pytest.raises(StudyError, match="flat\\*: matches no case"):
        study_parts.plans(tmp_path / "part.toml", (), AS_IT_IS, quiet=True)


def test_overrides_reach_all_parts(tmp_path):
    plans = study_parts.plans(write(tmp_path), ["stop.time=0.02"], AS_IT_IS, quiet=True)
    assert all("time = 0.02" in case.text for each in plans for case in each.plan.cases)


@pytest.mark.parametrize(("text", "message"), [
    ('deck = "tube.toml"\n[[part]]\nstudy = "tubes.toml"\n', "deck: belongs to the files of the parts"),
    ('[[part]]\nstudy = "tubes.toml"\nmembers = 0\n', r"part\[0\].members"),
    ('[[part]]\nstudy = "tubes.toml"\ncell = 3\n', 'unknown key "cell"'),
    ('[[part]]\nstudy = "none.toml"\n', "none.toml"),
    ('[[part]]\nstudy = "tubes.toml"\nonly = ["x*"]\n', r"only x\*: matches no case"),
])
def test_mistakes(tmp_path, text, message):
    tubes.write(tmp_path)
    file = tmp_path / "both.toml"
    file.write_text(text)
    with pytest.raises(StudyError, match=message):
        [each.states for each in study_parts.plans(file, (), AS_IT_IS, quiet=True)]


def test_a_study_of_parts_is_no_sweep(tmp_path):
    from hydro2d.study.plan import cases

    with pytest.raises(StudyError, match="the study is made of others; run it with `hydro2d sweep"):
        cases.plan(write(tmp_path))


@pytest.mark.thorough
def test_in_the_background(tmp_path):
    import os

    file, out = write(tmp_path), tmp_path / "out"
    status, said = tubes.sweep(file, "--workers", 1, "--background", *tubes.LONG)
    assert status == 0, said
    process = int(said.split()[1])
    assert os.getpriority(os.PRIO_PROCESS, process) == 10 + os.getpriority(os.PRIO_PROCESS, 0)
    tubes.wait_for(lambda: list(out.glob("first/cases/*/run.lock")))
    os.kill(process, signal.SIGTERM)
    tubes.wait_for(lambda: "--resume continues" in (out / "background.log").read_text())
    tubes.wait_for(lambda: not os.path.exists(f"/proc/{process}") or open(f"/proc/{process}/stat").read().split()[2] == "Z")
    status, said = tubes.sweep(file, "--workers", 2, "--resume", *tubes.LONG)
    assert status == 0, said
    assert {case.status for case in study_directory.read(out / "tubes").cases} == {"done", "waiting"}
