"""Ensembles in tables, figures and scores: the combined result of the members."""

import csv
import json
import shutil

import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.study.ensemble import agreement, ensembles
from hydro2d.study.ensemble.chance import wilson
from hydro2d.study.ensemble.contents import collect
from hydro2d.study.records import responses, study_directory
from hydro2d.study.report import charts, panels, rods
from hydro2d.study.report.report import report
from tests.study import fake
from tests.study.html import Page


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Three velocities, of which two have an experiment, five members each: 35, 36, 37, 38 and 14 cm at the first."""
    folder = tmp_path_factory.mktemp("ensembles") / "study"
    return fake.write_study(folder, {"velocity": fake.velocities(1086, 1150, 1200)}, "Repeats", repeats=5)


@pytest.fixture(scope="module")
def contents(study):
    return collect(study_directory.load(study))


def drawn(contents, **options):
    """The traces of the figure of depths by kind."""
    choice = responses.choose(contents.study, contents.records, **options)
    panel = panels.panels(contents, choice)[0]
    figure = charts.response(panel.setup, panel.series, choice.x, choice.y[0], contents.belonging, panel.shots, (), ())
    return {(trace.meta or trace.name): trace for trace in figure.data}


def test_median_and_spread_of_a_case(contents):
    first = contents.ensembles[0]
    assert (first.name, len(first.members)) == ("1086m-s", 5)
    assert first.spread("penetration_depth_m") == pytest.approx((0.36, 0.224, 0.376, 5))
    assert {regime: share[:2] for regime, share in first.regimes.items()} == {"rigid": (4, 5), "eroding": (1, 5)}


def test_unfinished_members_do_not_count(study, tmp_path, contents):
    shutil.copytree(study, tmp_path / "copy")
    (tmp_path / "copy" / "cases" / "1086m-s_m4" / "summary.json").unlink()
    first = collect(study_directory.load(tmp_path / "copy")).ensembles[0]
    assert first.spread("penetration_depth_m") == pytest.approx((0.365, 0.353, 0.377, 4))
    assert first.regimes["rigid"] == wilson(4, 4)


def test_members_that_are_all_cut_are_compared_at_their_end_time(study, tmp_path):
    """One that has ended is not mixed with those still moving."""
    shutil.copytree(study, tmp_path / "copy")
    for member in ("", "_m1", "_m2", "_m3", "_m4"):
        file = tmp_path / "copy" / "cases" / f"1086m-s{member}" / "summary.json"
        fake.edit_json(file, stop_reason="end time", rod_core_velocity_m_s=500.0)
    first = collect(study_directory.load(tmp_path / "copy")).ensembles[0]
    assert (len(first.ended), first.cut) == (5, True)
    fake.edit_json(file, stop_reason="speed of rod below 5 m/s", rod_core_velocity_m_s=4.0)
    first = collect(study_directory.load(tmp_path / "copy")).ensembles[0]
    assert (len(first.ended), first.cut) == (1, False)


def test_the_table_has_a_row_for_each_case_or_for_each_member(study):
    opened = hydro2d.open_study(study)
    table, runs = opened.table(), opened.table(members=True)
    assert list(table.index) == ["1086m-s", "1150m-s", "1200m-s"]
    row = table.loc["1086m-s"]
    assert (row.depth_m, row.depth_low_m, row.depth_high_m) == pytest.approx((0.36, 0.224, 0.376))
    assert (row.rigid_fraction, row.eroding_fraction, row.status, row.regime) == (0.8, 0.2, "5 of 5 done", "rigid")
    assert row.rigid_fraction_low < 0.8 < row.rigid_fraction_high < 1.0
    assert len(runs) == 15
    assert runs.loc["1086m-s_m2", ["ensemble", "member", "seed", "first step"]].tolist() == ["1086m-s", 2, 0, 0.998]


def test_members_are_dots_behind_the_mark_of_their_median(contents):
    traces = drawn(contents)
    dots, mark = traces["member"], next(trace for name, trace in traces.items() if "median" in name)
    assert len(dots.y) == 15
    assert list(mark.x) == [1086, 1150, 1200]
    assert mark.y[0] == pytest.approx(36.0)
    assert (mark.error_y.array[0], mark.error_y.arrayminus[0]) == pytest.approx((1.6, 13.6))
    names = list(traces)
    assert names.index("member") < names.index(mark.name)
    assert "rigid: 4 of 5" in mark.text[0]


def test_members_make_no_series_of_their_own(tmp_path):
    """Decks of members differ; without an axis they are still one series."""
    place = fake.write_study(tmp_path / "study", {}, repeats=3)
    collected = collect(study_directory.load(place))
    choice = responses.choose(collected.study, collected.records)
    assert len(panels.panels(collected, choice)[0].series) == 1


def test_an_experiment_is_scored_by_how_probable_its_outcome_was(contents):
    """45 cm at 1086 m/s is deeper than the limit of 25 cm, as are four of five; 20 cm at 1200 m/s is not, as is one."""
    shares = {each.name: each.outcome and (each.outcome[0], each.outcome[1][:2]) for each in contents.ensembles}
    deeper, shallower = agreement.DEEPER, agreement.NOT_DEEPER
    assert shares == {"1086m-s": (deeper, (4, 5)), "1150m-s": None, "1200m-s": (shallower, (1, 5))}
    score = ensembles.score(contents.ensembles)
    assert score[:4] == (2, 5, 10, 1)
    assert score.probability == pytest.approx((4.5 / 6 * 1.5 / 6) ** 0.5)


def test_a_score_rewards_the_true_probability():
    """Eight of ten shots end one way: members that do so in 80 % score better than members that always or half do."""
    def of(agreeing):
        shares = [wilson(agreeing, 1000)] * 8 + [wilson(1000 - agreeing, 1000)] * 2
        return agreement.score(shares).probability

    assert of(800) > max(of(500), of(950), of(1000))
    assert agreement.score([]) is None


def test_the_page_and_the_files_have_the_ensembles(study, tmp_path):
    said = []
    page = Page(report([study], tmp_path / "out", said.append).read_text(encoding="utf-8"))
    assert page.faults == []
    assert "36, 22.4 to 37.6" in page.text
    assert "rigid 4 of 5" in page.text
    assert "5 of 10 members end as the experiment" in page.text
    with open(tmp_path / "out" / "ensembles.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["case"] for row in rows] == ["1086m-s", "1150m-s", "1200m-s"]
    assert float(rows[0]["depth_m"]) == pytest.approx(0.36)
    assert any(line.endswith("ensembles.csv") for line in said)


def test_histories_and_outlines_of_members_are_thin(contents):
    choice = responses.choose(contents.study, contents.records)
    lines = charts.histories(panels.panels(contents, choice)[0].series).data
    assert {(trace.line.width, trace.opacity) for trace in lines} == {(1.4, 1.0), (0.9, 0.4)}
    first = [group.members[0] for group in contents.ensembles]
    others = {group.members[0].case.name: group.members[1:] for group in contents.ensembles}
    with_others, alone = (rods.draw(first, {}, contents.records, each) for each in (others, {}))
    assert [len(axes.patches) for axes in alone.axes] == [2, 2, 2]
    assert [len(axes.patches) for axes in with_others.axes] == [6, 6, 6]


@pytest.mark.parametrize("entry", [{"ensemble": {"repeats": 5}}, {"ensemble": {"repeats": 5, "by": 1, "seed": 0}}])
def test_a_damaged_ensemble_is_one_message(study, tmp_path, entry):
    shutil.copytree(study, tmp_path / "copy")
    fake.edit_json(tmp_path / "copy" / "study.json", **entry)
    with pytest.raises(study_directory.StudyError, match="is not a valid study file"):
        study_directory.load(tmp_path / "copy")


def test_a_damaged_change_of_a_member_is_one_message(study, tmp_path):
    shutil.copytree(study, tmp_path / "copy")
    file = tmp_path / "copy" / "study.json"
    entries = json.loads(file.read_text())["cases"]
    fake.edit_json(file, cases=[{**entries[0], "changed": {"first step": "much"}}, *entries[1:]])
    with pytest.raises(study_directory.StudyError, match="is not a valid study file"):
        study_directory.load(tmp_path / "copy")


def test_the_status_has_the_ensembles(study, capsys):
    assert call(["sweep", str(study), "--status"]) == 0
    said = capsys.readouterr().out
    assert "36, 22.4 to 37.6" in said
    assert "5 of 10 members end as the experiment" in said


# ------------------------------------------------------------------------------------------------ several studies


@pytest.fixture(scope="module")
def several(tmp_path_factory):
    """Two studies with ensembles and another scheme of advection each, one without ensembles, and a run by itself."""
    folder = tmp_path_factory.mktemp("several")
    for name, repeats in (("ke", 5), ("momentum", 3), ("both", 1)):
        advection = {"advection": {name: (f"numerics.advection={name}",)}}
        fake.write_study(folder / name, {"velocity": fake.velocities(1086, 1200), **advection}, repeats=repeats)
    fake.write_run(folder / "alone", 1150.0, overrides=("numerics.advection=ke",))
    return [folder / name for name in ("ke", "momentum", "both", "alone")]


def test_the_ensembles_of_several_studies_are_kept(several):
    contents = collect(study_directory.gather(several))
    assert [(each.name, len(each.members)) for each in contents.ensembles] == [
        ("ke/cases/1086m-s_ke", 5), ("ke/cases/1200m-s_ke", 5),
        ("momentum/cases/1086m-s_momentum", 3), ("momentum/cases/1200m-s_momentum", 3),
        ("both/cases/1086m-s_both", 1), ("both/cases/1200m-s_both", 1), ("alone", 1),
    ]
    assert contents.ensembles[0].spread("penetration_depth_m") == pytest.approx((0.36, 0.224, 0.376, 5))


def test_members_of_several_studies_are_dots_of_the_series_of_their_case(several):
    """Series are distinguished by the differences between studies, not by those between members."""
    contents = collect(study_directory.gather(several))
    choice = responses.choose(contents.study, contents.records)
    panel = panels.panels(contents, choice)[0]
    assert [(each.label, len(each.records)) for each in panel.series] == [
        ("advection ke", 11), ("advection momentum", 6), ("advection both", 2)]
    figure = charts.response(panel.setup, panel.series, choice.x, choice.y[0], contents.belonging, panel.shots, (), ())
    assert [len(trace.y) for trace in figure.data if trace.meta == "member"] == [11, 6]
    first = next(trace for trace in figure.data if "median" in (trace.name or ""))
    assert list(first.x) == [1086, 1150, 1200]
    assert first.y[0] == pytest.approx(36.0)


def test_the_page_of_several_studies_has_their_ensembles(several, tmp_path):
    page = Page(report(several, tmp_path / "out", lambda line: None).read_text(encoding="utf-8"))
    assert page.faults == []
    assert "36, 22.4 to 37.6" in page.text
    assert "rigid 4 of 5" in page.text
    assert ("2 cases with 5 members each, by first step, seed 0; 2 cases with 3 members each, by first step, seed 0; "
            "3 cases with one run each.") in page.text
    for name, count in (("ensembles.csv", 7), ("cases.csv", 19)):
        with open(tmp_path / "out" / name, newline="", encoding="utf-8") as file:
            rows = {row["case"]: row for row in csv.DictReader(file)}
        assert len(rows) == count
    member, single = rows["momentum/cases/1086m-s_momentum_m2"], rows["alone"]
    assert (member["ensemble"], member["member"], member["first step"]) == ("momentum/cases/1086m-s_momentum", "2", "0.998")
    assert (single["ensemble"], single["member"]) == ("", "")


def test_ensembles_of_bodies_without_a_projectile_are_not_split_by_member(tmp_path):
    """If the velocity does not vary, each case has one place on the x axis."""
    for name in ("one", "other"):
        fake.write_study(tmp_path / name, {}, repeats=3)
    collected = collect(study_directory.gather([tmp_path / "one", tmp_path / "other"]))
    for record in collected.records:
        record.velocity = None
    cases = responses.choose(collected.study, collected.records).x
    assert cases.order == ("one/cases/one", "other/cases/other")
    assert {cases.value(each) for each in collected.records} == set(cases.order)
