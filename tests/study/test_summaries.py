"""A report survives any contents of a summary, and names what it could not use."""

import copy
import csv
import io
import json

import pandas
import pytest

from hydro2d.measure.summary import Summary
from hydro2d.results import reading
from hydro2d.study.ensemble.contents import collect
from hydro2d.study.records import responses, study_directory, table
from hydro2d.study.report import panels
from hydro2d.study.report.page import page
from tests.study import fake

WRONG = ["text", 7, -1.5, True, [], [1, "x"], {}, {"a": {"b": []}}, None, float("nan"), float("inf")]
#: those with which the figures are drawn as well
DRAWN = ("text", -1.5)


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    return fake.write_run(tmp_path_factory.mktemp("study") / "shot")


def paths(value, path=()):
    """Every key of a summary, and those within its tables."""
    for key, inner in value.items():
        yield (*path, key)
        if isinstance(inner, dict):
            yield from paths(inner, (*path, key))


SUMMARY = json.loads(json.dumps(fake._summary(0.31, 0.02, fake.deck_text()))) | {
    "trustworthy": True, "faults": [], "experiment": {"penetration_m": 0.4, "qualifier": "measured", "source": "x"},
    "crater": {"depth_m": 0.3, "volume_m3": 1e-5}, "title": "a", "deck": "shot",
    "targets": {"plate": {"exit_time_s": 1e-4, "crater": {"depth_m": 0.3}}}}


@pytest.mark.parametrize("path", [pytest.param(path, id=".".join(path), marks=[pytest.mark.thorough] * (number % 8 > 0))
                                  for number, path in enumerate(paths(SUMMARY))])
def test_a_report_of_any_summary(place, path):
    text = (place / "summary.json").read_text()
    try:
        for wrong in WRONG:
            summary = copy.deepcopy(SUMMARY)
            inner = summary
            for key in path[:-1]:
                inner = inner[key]
            inner[path[-1]] = wrong
            (place / "summary.json").write_text(json.dumps(summary))
            study = study_directory.gather([place])
            contents = collect(study)
            choice = responses.choose(study, contents.records)
            drawn = list(panels.draw(contents, choice)) if wrong in DRAWN else []  # they take a fifth of a second each
            assert "<html" in page(contents, choice, drawn, [])
            assert table.to_csv(contents.table).count("\n") == 2
            assert reading.Results(place)._repr_html_()
    finally:
        (place / "summary.json").write_text(text)


def test_values_of_the_wrong_kind_are_left_out_and_reported(place):
    text = (place / "summary.json").read_text()
    fake.edit_json(place / "summary.json", rod_length_m="long", cycles=[3], wall_s=None)
    (case,) = study_directory.gather([place]).cases
    (place / "summary.json").write_text(text)
    assert case.message == "summary.json has values of the wrong kind in cycles, rod_length_m"
    assert case.summary.rod_length_m is None
    assert case.summary["penetration_depth_m"] == 0.31


def test_a_sound_summary_stays_as_it_is():
    assert Summary.sound(SUMMARY) == (SUMMARY, [])


def test_no_word_becomes_a_formula():
    """A spreadsheet runs text that begins with one of these."""
    words = ["=cmd|' /C calc'!A0", "+1", "-1+1", "@SUM(A1)", "\t=1", "plain", None, -3.5]
    text = table.to_csv(pandas.DataFrame({"case": words}, dtype=object))
    cells = [row["case"] for row in csv.DictReader(io.StringIO(text))]
    assert cells == ["'=cmd|' /C calc'!A0", "'+1", "'-1+1", "'@SUM(A1)", "'\t=1", "plain", "", "-3.5"]
