"""One table of runs: every number that two ways can give is the same."""

import csv
import math

import pandas
import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.deck import identity
from hydro2d.measure.outcome import Outcome
from hydro2d.study.records import keeping, study_directory
from tests.decks import mesh, plate, rod, stop, table
from tests.study import fake

#: a rod that perforates a thin plate, or carries a thick one along, and an experiment with the thin one
SHOT = (
    mesh(("8 mm", 8), ("-24 mm", "40 mm", 64))
    + rod("4 mm", "20 mm", tip="-0.1 mm", velocity="230 m/s")
    + plate("3 mm")
    + table("penetration", rod="rod", target="plate")
    + table("experiment", penetration="2 mm", qualifier="at least", source="made up")
    + '[derived]\n"L/L0" = "length / length0"\n'
    + stop(time="300 us", perforation=True, body="rod", speed_below="20 m/s")
    + table("output", history_interval="1 us", vtk_interval="1 ms")
)
STUDY = """
title = "Two plates"
deck = "shot.toml"
keep = "kept.csv"
[sample]
method = "sobol"
n = 2
seed = 1
results = ["crater.mean_diameter_m"]
[sample.input]
"body.rod.length" = { uniform = ["19.9 mm", "20.1 mm"] }
[[axis]]
name = "thickness"
key = "body.plate.thickness"
values = ["3 mm", "30 mm"]
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study of two plates with a sample of two shots each, of which every form of a result exists."""
    folder = tmp_path_factory.mktemp("runs")
    (folder / "shot.toml").write_text(SHOT)
    (folder / "plates.toml").write_text(STUDY)
    assert call(["sweep", str(folder / "plates.toml"), "--workers", "1", "--threads", "1", "--out", str(folder / "out")]) == 0
    return folder


def same(one, other, digits: float = 1e-12) -> bool:
    """Whether two entries are the same; a missing number is the same as none."""
    missing = [value is None or value == "" or (isinstance(value, float) and math.isnan(value)) for value in (one, other)]
    if any(missing):
        return all(missing)
    if isinstance(one, (bool, str)) or isinstance(other, (bool, str)):
        return str(one) == str(other)
    return math.isclose(float(one), float(other), rel_tol=digits, abs_tol=1e-12)


@pytest.mark.thorough
def test_every_way_to_a_number_gives_the_same(study):
    out = study / "out"
    summaries = {case.name: case.summary for case in study_directory.read(out).cases}
    one = hydro2d.runs(out, results=["crater.mean_diameter_m"])
    alone = hydro2d.runs(*(out / "cases" / name for name in summaries))
    kept = hydro2d.runs(study / "kept.csv")
    opened = hydro2d.open_study(out)
    by_study, samples = opened.table(), [opened.samples({"thickness": each}) for each in ("3 mm", "30 mm")]
    of = {name: each for each in samples for name in each.table.index}
    assert call(["report", str(out)]) == 0
    with (out / "report" / "cases.csv").open() as file:
        report = {row["case"]: row for row in csv.DictReader(file)}
    for name, summary in summaries.items():
        outcome, last = summary["outcome"], hydro2d.open_run(out / "cases" / name).history
        assert same(outcome["depth_m"], 0.003 if outcome["perforated"] else summary["penetration_depth_m"])
        assert same(summary["penetration_depth_m"], last["penetration_depth_m"][-1])
        assert same(summary["derived"]["L/L0"], last["L/L0"][-1])
        for key in Outcome.model_fields:
            where = (name, key)
            assert same(one.loc[(name, 0), key], outcome[key]), where
            assert same(alone.loc[(name, 0), key], outcome[key]), where
            assert same(kept.loc[(name, 0), key], outcome[key], 1e-5), where
            if key in by_study:
                assert same(by_study.loc[name, key], outcome[key]), where
                assert same(report[name][key], outcome[key]), where
            if key in of[name].table:
                value = of[name].table.loc[name, key]
                assert same({"yes": True, "no": False}.get(str(value), value), outcome[key]), where
        assert same(by_study.loc[name, "rod_residual_velocity_m_s"], outcome["residual_velocity_m_s"])
        assert same(by_study.loc[name, "rod_length_ratio"], outcome["length_ratio"])
        assert same(one.loc[(name, 0), "crater.mean_diameter_m"], summary["crater"]["mean_diameter_m"])
    for name in ("thickness", "row", "body.rod.length [mm]", "cells_across"):
        assert one[name].tolist() == kept[name].tolist(), name
    assert {bool(summary["outcome"]["perforated"]) for summary in summaries.values()} == {True, False}
    assert [*one.columns[-len(keeping.ORIGIN) :]] == [*kept.columns[-len(keeping.ORIGIN) :]]
    assert set(kept.columns) == set(one.columns)


@pytest.mark.thorough
def test_a_plate_that_is_perforated_has_its_thickness_as_depth_everywhere(study, capsys):
    samples = hydro2d.open_study(study / "out").samples({"thickness": "3 mm"})
    assert set(samples.table["depth_m"]) == {0.003}
    assert samples.fractions("depth_m > 0.005")["no"].share.fraction == 1.0
    call(["sweep", str(study / "out"), "--status"])
    assert "0.30 cm" in capsys.readouterr().out
    log = (study / "out" / "cases" / "3mm_row1" / "log.txt").read_text()
    assert "experiment          at least 0.20 cm  made up" in log
    assert "error" not in log.split("experiment")[1].splitlines()[0]


def test_the_table_has_units_and_missing_results(tmp_path):
    fake.write_run(tmp_path / "runs" / "one", 1086.0, 0.31)
    waiting = tmp_path / "runs" / "two"
    waiting.mkdir()
    (waiting / "deck.toml").write_text(fake.deck_text())
    table = hydro2d.runs(tmp_path / "runs")
    assert isinstance(table, pandas.DataFrame)
    assert table.index.names == ["case", "member"]
    assert table.loc[("one", 0), "depth_m"] == 0.31
    assert table.loc[("two", 0), "status"] == "waiting"
    assert table.loc["two"]["depth_m"].isna().all()
    units = table.attrs["units"]
    assert (units["depth_m"], units["residual_velocity_m_s"], units["length_ratio"]) == ("m", "m/s", "1")
    assert "status" not in units


def test_labels_are_numbers_wherever_they_come_from_unless_one_is_a_word(tmp_path):
    fake.write_study(tmp_path / "study", {"friction": {"0.0": (), "0.1": ()}, "law": {"a": (), "2": ()}})
    heads = ["friction", "law", "cells_across", "member", *keeping.RESULTS, *keeping.ORIGIN]
    rows = [[friction, law, "5", "0", "done"] + [""] * (len(heads) - 5) for friction in ("0.0", "0.1") for law in ("a", "2")]
    (tmp_path / "kept.csv").write_text("\n".join(map(",".join, [heads, *rows])) + "\n")
    for place in ("study", "kept.csv"):
        table = hydro2d.runs(tmp_path / place)
        assert table["friction"].tolist() == [0.0, 0.0, 0.1, 0.1]
        assert table["law"].tolist() == ["a", "2"] * 2
        assert table.groupby("friction")["status"].count().tolist() == [2, 2]


def test_the_set_up_of_a_run_is_that_of_its_deck():
    deck = decks.loads(SHOT)
    again = decks.loads(deck.to_toml())
    assert identity.setup(deck) == identity.setup(again)
    assert identity.cells_across(deck) == identity.cells_across(again) == 4.0


def test_rows_of_an_earlier_version_have_what_their_shots_came_to(tmp_path):
    file = tmp_path / "kept.csv"
    old = [name for name in (*keeping.RESULTS, *keeping.ORIGIN) if name not in keeping.LATER]
    shots = {"through": ("perforation of plate", "0.0147", "310", "deforming"),
             "stopped": ("speed of rod below 5 m/s", "0.02", "", "rigid"), "cut": ("end time", "0.02", "", "rigid")}
    lines = [",".join(["velocity", "cells_across", "member", *old])]
    for velocity, (reason, depth, left, regime) in shots.items():
        row = dict.fromkeys(old, "") | {"status": "done", "stop_reason": reason, "depth_m": depth,
                                        "residual_velocity_m_s": left, "regime": regime}
        lines.append(",".join([velocity, "5", "0", *row.values()]))
    file.write_text("\n".join(lines) + "\n")
    table = hydro2d.runs(file).reset_index(level="member")
    assert table["perforated"].to_dict() == {"through": True, "stopped": False, "cut": False}
    assert table["final"].to_dict() == {"through": True, "stopped": True, "cut": False}
    assert math.isnan(table.loc["through", "depth_m"])  # the nose was there; the thickness is not known
    assert table.loc["stopped", "residual_velocity_m_s"] == 0.0
    assert math.isnan(table.loc["cut", "residual_velocity_m_s"])
