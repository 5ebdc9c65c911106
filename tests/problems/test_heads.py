"""Failure of an eroding head: the page shows the kept results."""

import csv

import pytest

from hydro2d.base.method_version import METHOD
from problems.cth_nose_shape import heads
from problems.cth_nose_shape.rigid_rod import Result
from tests.rules import source

PAGE = source.ROOT / "docs/explanation/eroding-heads.md"


def made(shot, depth, failure=None, law=None):
    labels = {key: text for key, text in (("shot", shot), ("failure", failure), ("law", law)) if text}
    return Result(labels, 0, depth, 50.0, None, "eroding", None, METHOD)


def test_runs_are_gathered_by_shot_law_and_way_to_fail():
    results = [made("steel-2120", 7.8, "none"), made("steel-2120", 11.0, "strain 150 %"), made("5083-1296", 21.0, law="A"),
               made("5083-1296", 15.0, law="A"), made("5083-1296", 25.0, "strain 150 %", "A"),
               made("7039-1248", 13.0, law="A"), made("5083-1086", 46.0, law="A")]
    gathered = heads.cases(results)
    assert list(gathered) == [("5083-1296", "A"), ("steel-2120", "")]  # one failure only: nothing to compare
    assert gathered["5083-1296", "A"] == {"fracture pressure": [21.0, 15.0], "strain 150 %": [25.0]}
    assert heads.cell([21.0, 15.0, 22.0]) == "21.0 (15.0 to 22.0)"
    assert heads.table(gathered)[2] == "| tungsten into 5083, 1296 m/s | A | 21.6 |  | 18.0 (15.0 to 21.0) |  |  | 25.0 |"
    first = heads.draw(gathered).axes[0].lines[1]
    assert list(first.get_ydata()) == pytest.approx([21.0 / 21.6, 15.0 / 21.6])


def test_the_page_has_the_table_of_what_is_kept():
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    rows = heads.table(heads.cases(heads.kept()))
    assert len(rows) == 10
    assert [row for row in rows if row not in lines] == []


def test_the_page_has_the_runs_without_a_tube():
    text = PAGE.read_text(encoding="utf-8")
    with open(source.PROBLEMS / "cth_nose_shape/results/heads/tube.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["tube"] for row in rows] == ["kept", "taken"] * 2
    for kept, without in zip(rows[::2], rows[1::2], strict=True):
        assert kept["taken_g"] == "0.0"
        depths = [f"{float(row['depth_cm']):.1f}" for row in (without, kept)]
        assert f"{depths[0]} instead of {depths[1]} cm" in " ".join(text.split())
        assert f"{float(without['taken_g']):.0f}" in text
