"""Study files: each error is reported in one line with file, line, key and the nearest name; the resulting cases."""

import re
import tomllib

import pytest

from hydro2d.cli.main import call
from hydro2d.study.plan import cases, ranges
from hydro2d.study.plan.definition import Range, StudyError
from tests.rules import source
from tests.study import tubes


def names(folder, text, overrides=()):
    return [case.name for case in cases.plan(tubes.write(folder, text), list(overrides)).cases]


def test_product_in_the_order_of_the_file(tmp_path):
    assert names(tmp_path, tubes.STUDY) == ["ke_0.1", "ke_0.2", "momentum_0.1", "momentum_0.2"]


def test_exclusions(tmp_path):
    text = tubes.STUDY + '[[exclude]]\nadvection = "ke"\npressure = 0.2\n'
    assert names(tmp_path, text) == ["ke_0.1", "momentum_0.1", "momentum_0.2"]


def test_exclusions_with_several_values(tmp_path):
    text = tubes.STUDY + '[[exclude]]\nadvection = ["ke", "momentum"]\npressure = [0.2]\n'
    assert names(tmp_path, text) == ["ke_0.1", "momentum_0.1"]


def test_variants_set_several_keys_and_other_decks(tmp_path):
    (tmp_path / "other.toml").write_text(tubes.TUBE.replace("cells = 200", "cells = 100"))
    text = """
        deck = "tube.toml"
        [[axis]]
        name = "method"
        [axis.variants.first]
        numerics.advection = "ke"
        "numerics.courant" = 0.4
        [axis.variants.other_one]
        deck = "other.toml"
        numerics.advection = "both"
    """
    first, other = cases.plan(tubes.write(tmp_path, text)).cases
    assert (first.name, other.name) == ("first", "other-one")
    assert first.overrides == ['numerics.advection="ke"', "numerics.courant=0.4"]
    assert "courant = 0.4" in first.text
    assert other.deck == "other.toml"
    assert "cells = 100" in other.text
    assert other.values == {"method": "other_one"}


NOSES = ["ogival", "hemispherical", "conical"]


def noses(folder, more="", overrides=(), change=("", "")):
    """The cases of the guide's axis over noses, for a deck with an ogive."""
    page = (source.ROOT / "docs/how-to/run-a-study.md").read_text(encoding="utf-8")
    axis = next(block for block in re.findall(r"```toml\n(.*?)```", page, flags=re.S) if 'name = "nose"' in block)
    text = 'deck = "problems/cth_nose_shape/ogive_7039_1291.toml"\n' + more + re.sub("^deck = .*", "", axis).replace(*change)
    return cases.plan(tubes.write(folder, text), overrides)


def test_an_axis_over_noses_removes_the_keys_of_the_others(tmp_path):
    """The example of the guide: all of its decks are valid, and only the ogive has a crh."""
    planned = noses(tmp_path).cases
    assert [case.message for case in planned] == ["", "", ""]
    rods = [tomllib.loads(case.text)["body"][0] for case in planned]
    assert [rod["nose"] for rod in rods] == NOSES
    assert [rod.get("crh") for rod in rods] == [3.0, None, None]
    assert "body.rod.crh=" in planned[1].overrides


def test_keys_are_removed_for_every_case(tmp_path):
    """By [set] and by --set, which is written into the file of the study."""
    whole = noses(tmp_path, change=("body.rod.crh = 3.0", 'body.rod.crh = 3.0\nremove = ["title"]'))
    by_set = noses(tmp_path, '[set]\nremove = ["title"]\n')
    given = noses(tmp_path, "[set]\ntitle = 'another'\n", ["title="])
    titles = [[tomllib.loads(case.text).get("title", "") for case in plan.cases] for plan in (whole, by_set, given)]
    assert titles[1] == titles[2] == ["", "", ""]
    assert titles[0][0] == ""
    assert titles[0][1] == titles[0][2] != ""
    assert cases.plan(tubes.write(tmp_path, given.text)).cases == given.cases


@pytest.mark.parametrize(("change", "said"), [
    (('["body.rod.crh"]', '["body.rod.chr"]'), 'no deck has the key body.rod.chr: body[0]: unknown key "chr"'),
    (('["body.rod.crh"]', '"body.rod.crh"'), "remove: expected a list of deck keys"),
    (('["body.rod.crh"]', '["body.rod.nose"]'), "remove: body.rod.nose is given a value as well"),
])
def test_keys_that_cannot_be_removed(tmp_path, change, said):
    with pytest.raises(StudyError) as raised:
        noses(tmp_path, change=change)
    assert said in str(raised.value)


def test_overrides_of_the_command_line_reach_every_case_and_the_file(tmp_path):
    plan = cases.plan(tubes.write(tmp_path), ["numerics.courant=0.3", "stop.time=20 ms"])
    assert all("courant = 0.3" in case.text and "time = 0.02" in case.text for case in plan.cases)
    assert cases.plan(tubes.write(tmp_path, plan.text)).cases == plan.cases


def test_an_axis_lays_over_set(tmp_path):
    text = tubes.STUDY.replace("stop.time = 0.01", 'stop.time = 0.01\nnumerics.advection = "both"')
    assert 'advection = "ke"' in cases.plan(tubes.write(tmp_path, text)).cases[0].text


def test_one_wrong_case_does_not_sink_the_others(tmp_path):
    plan = cases.plan(tubes.write(tmp_path, tubes.STUDY.replace("0.1, 0.2", '0.1, "2 mm"')))
    assert [bool(case.text) for case in plan.cases] == [True, False, True, False]
    assert "body[1].pressure" in plan.cases[1].message
    assert plan.cases[1].sha256 is None


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"from": "900 m/s", "to": "1000 m/s", "step": "50 m/s"}, ["900 m/s", "950 m/s", "1000 m/s"]),
        ({"from": 0.1, "to": 0.3, "step": 0.1}, [0.1, 0.2, 0.3]),
        ({"from": 3, "to": 1, "step": -1}, [3, 2, 1]),
        ({"from": 10, "to": 20, "count": 3}, [10, 15, 20]),
        ({"from": 0, "to": 1, "count": 3}, [0.0, 0.5, 1.0]),
        ({"from": "1 km/s", "to": "2 km/s", "count": 3}, ["1 km/s", "1.5 km/s", "2 km/s"]),
    ],
)
def test_ranges(given, expected):
    values = ranges.values(Range.model_validate(given))
    assert values == expected
    assert [type(value) for value in values] == [type(value) for value in expected]


def test_names_are_short_safe_and_unique():
    assert cases.short("1086 m/s") == "1086m-s"
    assert cases.short("../a b_c") == "ab-c"
    assert cases.distinct(["a", "b", "a", "a"]) == ["a", "b", "a-2", "a-3"]


WRONG = [
    ("axis", "axes", 'did you mean "axis"'),
    ('key = "numerics.advection"', 'keys = "numerics.advection"', 'toml:8: axis[0].keys: unknown key "keys"; did you'),
    ("numerics.advection", "numerics.advecton", 'no deck has the key numerics.advecton: numerics: unknown key'),
    ("body.low", "body.lwo", 'unknown entry "lwo"; did you mean "low"'),
    ("stop.time", "stop.tim", 'tubes.toml:5: no deck has the key stop.tim: stop: unknown key "tim"; did you mean "time"'),
    ("[0.1, 0.2]", "[]", "is empty"),
    ("[0.1, 0.2]", "[0.1, 0.1]", "contains the value 0.1 twice"),
    ("values = [0.1, 0.2]", "", "given: none"),
    ('key = "body.low.pressure"', "", "key is missing"),
    ('name = "pressure"', 'name = "advection"', 'there is already an axis "advection"'),
    ('"body.low.pressure"', '"numerics.advection"', "both set numerics.advection"),
    ('"body.low.pressure"', '"numerics"', "both set numerics"),
    ("values = [0.1, 0.2]", "range = {from = 1, to = 2, step = -1}", "never ends"),
    ("values = [0.1, 0.2]", "range = {from = 1, to = 2, step = 0}", "never ends"),
    ("values = [0.1, 0.2]", "range = {from = 0, to = 1e9, step = 1}", "at most 10000"),
    ("values = [0.1, 0.2]", 'range = {from = "1 m", to = "2 mm", count = 2}', "same unit"),
    ("values = [0.1, 0.2]", 'range = {from = "one", to = 2, count = 2}', "expected a number"),
    ("values = [0.1, 0.2]", "range = {from = 1, to = 2}", "either step or count"),
    ("values = [0.1, 0.2]", "range = {form = 1, to = 2, count = 2}", 'did you mean "from"'),
    ("values = [0.1, 0.2]", 'values = [0.1]\n[[exclude]]\nadvection = "MV"', 'matches nothing; unknown value "MV"'),
    ("values = [0.1, 0.2]", 'values = [0.1]\n[[exclude]]\nadvecton = "ke"', 'did you mean "advection"'),
    ("values = [0.1, 0.2]", 'values = [0.1]\n[[exclude]]\nadvection = ["ke", "MV"]', 'matches nothing; unknown value "MV"'),
    ("values = [0.1, 0.2]", "values = [0.1]\n[[exclude]]", "exclude every case"),
    ("values = [0.1, 0.2]", "values = [0.1]\n[[exclude]]\npressure = 0.1", "leave no case"),
    ("values = [0.1, 0.2]", "values = [0.1\n", "not valid TOML"),
    ('deck = "tube.toml"', "", "deck: is missing"),
    ('deck = "tube.toml"', 'deck = "tub.toml"', "no such file"),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG, ids=[new or f"no {old}" for old, new, _ in WRONG])
def test_a_wrong_study_is_one_message_and_status_2(tmp_path, capsys, old, new, said):
    assert old in tubes.STUDY
    file = tubes.write(tmp_path, tubes.STUDY.replace(old, new))
    assert call(["sweep", str(file), "--check"]) == 2
    message = capsys.readouterr().err
    assert said in message
    assert str(tmp_path) in message
    assert "Traceback" not in message


def test_overrides_are_checked_too(tmp_path):
    with pytest.raises(StudyError, match='unknown key "curant"; did you mean "courant"'):
        cases.plan(tubes.write(tmp_path), ["numerics.curant=0.5"])
    with pytest.raises(StudyError, match="expected key=value"):
        cases.plan(tubes.write(tmp_path), ["numerics.courant"])


def test_check_prints_cases_cells_and_time(tmp_path, capsys):
    assert call(["sweep", str(tubes.write(tmp_path)), "--check", "--workers", "2"]) == 0
    shown = capsys.readouterr().out
    assert "deck: tube.toml" in shown
    assert "momentum_0.2  800" in shown
    assert "4 cases, about" in shown
    assert call(["sweep", str(tubes.write(tmp_path, tubes.STUDY.replace("0.2]", "'2 mm']"))), "--check"]) == 2
    assert "ke_2mm: " in capsys.readouterr().out
