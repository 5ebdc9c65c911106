"""The velocity at which half of the rods lose a third of their length: how it is found, and the page's table."""

from collections import Counter

import pandas
import pytest

import hydro2d
from hydro2d.base.method_version import METHOD
from hydro2d.study.plan import cases
from problems.cth_nose_shape import transitions
from tests.rules import source


def rows(runs, nose="hemispherical", method=METHOD):
    """Runs of a search, of velocities and shares of the length."""
    return pandas.DataFrame([{"nose": nose, "law": "a", "plate": 5083, "cells_across": 5.5, "velocity": f"{velocity} m/s",
                              "status": "done", "length_ratio": left, "method": method} for velocity, left in runs])


def one(runs):
    """The only search of runs."""
    (search,) = transitions.searches(runs).values()
    return search


def test_the_velocity_lies_between_what_kept_and_what_lost():
    mixed = rows([(1300, 0.2), (1000, 0.99), (1050, 0.98), (1100, 0.97), (1150, 0.6), (1200, 0.9), (1250, 0.3), (1350, 0.1)])
    assert 1125.0 < transitions.fitted(one(mixed)).v50 < 1225.0
    line = transitions.table(mixed)[2]
    assert line.startswith("| hemispherical | 5.5 | a | 5083 | 1086 to 1200 m/s | 1175 m/s |")
    assert line.endswith("| 1200, 1150 m/s | 8 |")
    assert one(rows([(1000, 0.667), (1100, 0.666)]))["kept"].tolist() == [True, False]


@pytest.mark.parametrize(("low", "high", "said"), [
    (1000.4, 1100.0, "1000 to 1100 m/s"), (None, 1100.0, "below 1100 m/s"), (1000.0, None, "above 1000 m/s"),
    (None, None, "open")])
def test_intervals_may_be_open(low, high, said):
    assert transitions._interval(low, high) == said


def test_a_plate_with_another_law_is_a_search_of_its_own():
    """Its experiments are those of its alloy."""
    measured = rows([(1000, 0.99), (1100, 0.2)]).assign(plate="5083 as measured")
    lines = transitions.table(pandas.concat([rows([(1000, 0.99), (1100, 0.2)]).assign(plate="5083"), measured]))[2:]
    assert [line.split(" | ")[3:5] for line in lines] == [
        ["5083", "1086 to 1200 m/s"], ["5083 as measured", "1086 to 1200 m/s"]]


def test_a_search_of_a_newer_method_replaces_that_of_an_older_one():
    older, newer = rows([(1000, 0.99), (1100, 0.2)], method="2020-01-01"), rows([(1050, 0.99), (1200, 0.98)])
    assert transitions.table(pandas.concat([older, newer]))[2:] == transitions.table(newer)[2:]


def test_runs_that_do_not_tell():
    with pytest.raises(ValueError, match="do not tell"):
        transitions.fitted(one(rows([(1000, 0.99), (1100, 0.98)])))
    kept, lost = rows([(1000, 0.99), (1100, 0.98)]), rows([(1000, 0.2), (1100, 0.1)])
    assert "| above 1100 m/s |  |  | 2 |" in transitions.table(kept)[2]
    assert "| below 1000 m/s |  |  | 2 |" in transitions.table(lost)[2]


def test_runs_that_did_not_end_well_do_not_count():
    assert len(transitions.table(rows([(1000, 0.9)]).assign(status="unphysical"))) == 2


def test_a_table_says_that_its_runs_are_old():
    assert transitions.table(rows([(1000, 0.99)], method="2020-01-01"))[-1].endswith(": 1 of 2020-01-01.")


@pytest.mark.parametrize("file", transitions.FILES, ids=lambda file: file.stem)
def test_kept_runs_are_those_of_the_study(file):
    plan = cases.plan(source.PROBLEMS / f"cth_nose_shape/{file.stem}.toml", quiet=True)
    studied = {(case.values["nose"], case.values["law"], case.values["plate"]) for case in plan.cases}
    searches = transitions.searches(hydro2d.runs(file))
    assert {(nose, law, plate) for nose, _, law, plate in searches} <= studied
    numbers = Counter(len(runs) for runs in searches.values())
    assert max(numbers) <= plan.search.budget.runs


def test_a_file_of_something_else_is_refused(tmp_path, capsys):
    file = tmp_path / "other.csv"
    file.write_text("a,b\n1,2\n")
    assert transitions.main([str(file)]) == 2
    assert 'other.csv:1: has no column "cells_across"' in capsys.readouterr().err
