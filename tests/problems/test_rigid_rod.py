"""The tables on the end of rigid penetration, and the results kept next to the studies."""

import re
from dataclasses import replace

import pytest

from hydro2d.base.method_version import METHOD
from hydro2d.measure.regime import DEFORMING, ERODING, RIGID, regime
from hydro2d.study.plan import cases
from hydro2d.study.plan.scaling import Size
from hydro2d.study.records import keeping, study_directory
from hydro2d.study.run.choice import Choice
from problems import kept
from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.rigid_rod import Result, Shot
from tests.rules import source
from tests.study import fake

#: the studies whose rows `rigid_rod` reads
KEPT = sorted(source.PROBLEMS / name for name in (
    "cth_nose_shape/results/advection.csv", "cth_nose_shape/results/plate_laws.csv",
    "cth_nose_shape/results/rigid_rod_failure.csv", "cth_nose_shape/results/specific_heat.csv",
    "cth_nose_shape/results/twelve_shots.csv", "cth_nose_shape/results/yield_factor.csv", "validation/results/eroded_heads.csv",
    "validation/results/eroding_rods.csv", "validation/results/rigid_steel_rods.csv",
    "validation/results/steel_rods_fitted.csv"))
#: a result of a run on a page, as Result writes it
CELL = re.compile(r"(?:\d+\.\d cm|perforated at \d+ m/s), [\d.]+ %")
AXES = ("law", "shot", "nose", "plate", "velocity")


def row(labels, depth, length, status="done", reason="speed of rod below 5 m/s", member=0, method=METHOD):
    numbers = {"depth_m": depth, "length_ratio": length / 0.1, "residual_velocity_m_s": 123.4, "regime": "rigid",
               "hole_m3": 1.6e-5}
    about = {"cells_across": "8.5", "member": member, "status": status, "stop_reason": reason, "method": method}
    return dict.fromkeys(AXES, "") | labels | about | numbers


@pytest.fixture
def study(tmp_path):
    """A file of kept rows."""
    return write(tmp_path / "rows.csv", [
        row({"law": "A", "shot": "5083-1086"}, 0.4168, 0.0958),
        row({"law": "A", "shot": "ogive-7039-1291"}, 0.537, 0.0995, reason="perforation of plate"),
        row({"law": "B", "shot": "hemi 7039 1165"}, 0.156, 0.0384),
        row({"law": "B", "shot": "5083-1200"}, 0.1, 0.09, status="unphysical"),
        row({"law": "B", "shot": "something else"}, 0.1, 0.09),
        row({"law": "B", "plate": "5083", "velocity": "700 m/s"}, 0.2, 0.095),
    ])


def write(file, rows):
    kept.write(file, (*AXES, keeping.CELLS, keeping.MEMBER, *keeping.RESULTS, *keeping.ORIGIN), rows)
    return file


@pytest.mark.parametrize(("label", "shot"), [
    ("5083-1086", Shot("hemispherical", "5083", 1086.0)), ("hemi 7039 1165", Shot("hemispherical", "7039", 1165.0)),
    ("ogive-5083-923", Shot("ogival", "5083", 923.0)), ("6061-967", None), ("", None)])
def test_labels(label, shot):
    assert Shot.named(label) == shot


@pytest.mark.parametrize(("labels", "shot", "column"), [
    ({"law": "A", "shot": "5083-1086"}, Shot("hemispherical", "5083", 1086.0), "A"),
    ({"law": "A", "nose": "ogival", "plate": "7039", "velocity": "875 m/s", "cells_across": "5.5"},
     Shot("ogival", "7039", 875.0), "A"),
    ({"plate": "5083-H116", "shot": "5083-1086"}, Shot("hemispherical", "5083", 1086.0), "5083-H116"),
    ({"plate": "6061", "velocity": "875 m/s"}, None, "")])
def test_shots_of_studies_and_of_searches(labels, shot, column):
    result = Result(labels, 0, 1.0, 0.0, None, "rigid", None, METHOD)
    assert (result.shot, result.column) == (shot, column)


def test_all_twelve_shots_are_known():
    shots = rigid_rod.experiments()
    assert len(shots) == 12
    assert str(shots[Shot("hemispherical", "5083", 1086.0)]) == "44.8 cm"
    assert str(shots[Shot("ogival", "7039", 1291.0)]) == "perforated"
    assert str(shots[Shot("hemispherical", "7039", 1165.0)]) == "11.4 cm (estimated)"


def test_the_table(study, capsys):
    assert rigid_rod.main([str(study)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "| shot | experiment | A | B |", "|---|---|---|---|",
        "| hemispherical, 5083, 700 m/s |  |  | 20.0 cm, 5.0 % |",
        "| hemispherical, 5083, 1086 m/s | 44.8 cm | 41.7 cm, 4.2 % |  |",
        "| hemispherical, 7039, 1165 m/s | 11.4 cm (estimated) |  | 15.6 cm, 62 % |",
        "| ogival, 7039, 1291 m/s | perforated | perforated at 123 m/s, 0.5 % |  |", "",
        "| rod | transition | experiment | A | B |", "|---|---|---|---|---|",
        "| hemispherical, 5083 | a third of the length lost |  | above 1086 m/s | above 700 m/s |",
        "| | depth no longer above 25.6 cm | 1086 to 1200 m/s | above 1086 m/s | none deeper |",
        "| hemispherical, 7039 | a third of the length lost |  |  | below 1165 m/s |",
        "| | depth no longer above 25.0 cm | 1038 to 1165 m/s |  | none deeper |",
        "| ogival, 7039 | a third of the length lost |  | above 1291 m/s |  |",
        "| | depth no longer above 25.9 cm | above 1291 m/s | above 1291 m/s |  |", "",
        "| rods | runs in 5083 | energy over volume | runs in 7039 | energy over volume |", "|---|---|---|---|---|",
        "| hemispherical, up to a tenth of the length lost | 2 | 1.0 to 2.3 GPa | 0 | |",
        "| hemispherical, more | 0 | | 1 | 2.7 GPa |",
    ]


@pytest.mark.parametrize(("depths", "said"), [
    ({700.0: 20.0, 1000.0: 40.0, 1100.0: 30.0, 1200.0: 15.0}, "1100 to 1200 m/s"), ({700.0: 20.0}, "none deeper"),
    ({1000.0: 40.0, 1100.0: 15.0, 1200.0: 30.0}, "1000 to 1100 m/s"), ({1000.0: 40.0}, "above 1000 m/s"), ({}, "")])
def test_the_transition_by_depth(depths, said):
    assert rigid_rod._deeper(depths, 25.6) == said


def test_nothing_to_show(tmp_path, capsys):
    assert rigid_rod.main([str(write(tmp_path / "rows.csv", [row({"law": "A", "shot": "steel-2120"}, 0.1, 0.02)]))]) == 2
    assert capsys.readouterr().err == "there is no finished case of a shot\n"


def test_another_table_is_no_file_of_rows(capsys):
    assert rigid_rod.main([str(source.PROBLEMS / "cth_nose_shape" / "experiments.csv")]) == 2
    assert 'experiments.csv:1: has no column "cells_across"; correct it, or' in capsys.readouterr().err


def test_later_rows_replace_earlier_ones_and_old_ones_are_reported(study, tmp_path, capsys):
    newer = write(tmp_path / "newer.csv", [row({"law": "A", "shot": "5083-1086"}, 0.3, 0.05, method="2020-01-01")])
    assert rigid_rod.main([str(study), str(newer)]) == 0
    said = capsys.readouterr().out
    assert "| 30.0 cm, 50 % |" in said
    assert "41.7 cm" not in said
    assert said.endswith(": 1 of 2020-01-01.\n")


def test_runs_of_a_directory_read_as_their_rows_do(tmp_path):
    plan = cases.plan(source.PROBLEMS / "cth_nose_shape/twelve_shots.toml", quiet=True, size=Size(members=2))
    plan = replace(plan, cases=plan.cases[:4], keep=tmp_path / "rows.csv")
    for case in plan.cases:
        fake.write_run(tmp_path / "out/cases" / case.name, text=case.text)
    study_directory.make(tmp_path / "out")
    study_directory.write(plan, tmp_path / "out")
    Choice(plan).keep(study_directory.read(tmp_path / "out").cases)
    assert rigid_rod.read(tmp_path / "out") == rigid_rod.read(plan.keep)
    assert [run.member for run in rigid_rod.read(plan.keep)] == [0, 1, 0, 1]


@pytest.mark.thorough
@pytest.mark.parametrize("file", KEPT, ids=lambda file: file.stem)
def test_kept_rows_are_those_of_their_study(file):
    plan = cases.plan(file.parent.parent / f"{file.stem}.toml", quiet=True)
    assert plan.keep.resolve() == file.resolve()
    rows = keeping.read(file)
    assert len({(*keeping.labels(each).items(), each["member"]) for each in rows}) == len(rows) > 0
    planned = [case.values for case in plan.cases]
    assert [each for each in rows if {name: each[name] for name in planned[0]} not in planned] == []


def test_kept_results_are_judged_by_the_rule_of_today():
    """By the length that is left; a rod that kept it may have grown wider."""
    kept = [result for file in KEPT for result in rigid_rod.read(file)]
    words = {ERODING: 0, RIGID: 0, DEFORMING: 0}
    for result in kept:
        words[result.regime] += 1
        left = 1.0 - result.loss / 100.0
        by_length = regime(left, 1.0, 1.0)
        allowed = {RIGID: tuple(words), DEFORMING: (DEFORMING, ERODING), ERODING: (ERODING,)}[by_length]
        assert result.regime in allowed, result
    assert min(words.values()) > 0


def test_statements_of_the_readme_on_the_specific_heat():
    """As printed it leaves a rod that holds as it was, and lets rods that erode go deeper."""
    runs = rigid_rod.read(source.PROBLEMS / "cth_nose_shape/results/specific_heat.csv")
    depth = {(run.labels["shot"], run.labels["specific heat"]): run.depth for run in runs}
    assert {key: round(value, 1) for key, value in depth.items()} == {
        ("5083-1086", "corrected"): 44.9, ("5083-1086", "printed"): 45.3, ("5083-1296", "corrected"): 27.4,
        ("5083-1296", "printed"): 35.0, ("7039-1248", "corrected"): 14.0, ("7039-1248", "printed"): 25.2}


def test_statements_of_the_readme_on_the_yield_factor():
    """As printed it does as good as nothing; by radius the rod goes 2.4 to 2.7 times as deep."""
    runs = rigid_rod.read(source.PROBLEMS / "cth_nose_shape/results/yield_factor.csv")
    depth = {(run.labels["shot"], run.labels["factor"]): round(run.depth, 1) for run in runs}
    assert depth == {("5083-1086", "printed"): 10.7, ("5083-1086", "radius"): 29.4, ("5083-1086", "off"): 10.7,
                     ("5083-1200", "printed"): 14.9, ("5083-1200", "radius"): 35.7, ("5083-1200", "off"): 14.9}


@pytest.mark.parametrize(("page", "least"), [("rigid-rod", 24), ("nose-shape", -1)])
def test_results_on_a_page_are_kept_ones(page, least):
    shown = set(CELL.findall((source.ROOT / f"docs/explanation/{page}.md").read_text(encoding="utf-8")))
    assert len(shown) > least
    assert sorted(shown - {str(result) for file in KEPT for result in rigid_rod.read(file)}) == []
