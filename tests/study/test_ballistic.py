"""The ballistic limit from residual velocities: its estimate, the choice of velocities, and what a search says of it."""

import csv
import json

import numpy as np
import pandas
import pytest

from hydro2d.cli.main import call
from hydro2d.penetration import lambert_jonas
from hydro2d.study.search import ballistic, logit, sequence
from tests.study import coverage, made_up, test_chance
from tests.study.coverage import PLATES, Plate, within
from tests.study.html import Page

#: a steel plate of 40 mm: stopped at 316 m/s, through at 340 m/s with 78 m/s left
SPEEDS = [277.0, 290.0, 300.0, 308.0, 316.0, 340.0, 345.0, 352.0, 360.0, 370.0, 380.0, 391.0]
LEFT = [0.0, 0.0, 0.0, 0.0, 0.0, 78.0, 98.0, 119.0, 141.0, 165.0, 187.0, 208.0]
STUDY = test_chance.STUDY.replace("erosion", "perforation").replace("16", "12")


def of_shots(speeds, left):
    return ballistic.of_shots(pandas.Series(speeds), pandas.Series(left))


def plate(velocity, deck, limit=1180.0):
    """A made-up plate; the draw of the deck decides on the limit of the shot."""
    own = limit + 6.0 * np.random.default_rng(int(deck["numerics"]["initial_dt_factor"] * 1e15)).normal()
    left = lambert_jonas.residual_velocity(velocity, limit_velocity=own, a=0.9, p=2.3)
    if left == 0.0:
        return {"regime": "rigid", "depth": 0.3}
    return {"regime": "rigid", "depth": 0.54, "exit_time_s": 4e-4, "rod_residual_velocity_m_s": left,
            "stop_reason": "perforation of plate"}


# ------------------------------------------------------------------------------------------------ the estimate


def test_residual_velocities_know_a_limit_that_outcomes_do_not():
    limit, _ = of_shots(SPEEDS, LEFT)
    assert limit.limit_velocity == pytest.approx(331.1, abs=1.0)
    assert limit.low < 331.1 < limit.high
    assert limit.high - limit.low < 8.0
    by_outcome = logit.fit_transition(SPEEDS, [left > 0.0 for left in LEFT])
    assert (by_outcome.v50_high or np.inf) - (by_outcome.v50_low or 0.0) > 24.0


@pytest.mark.parametrize(("a", "p", "limit"), [(0.93, 2.7, 900.0), (1.0, 2.0, 1250.0), (0.7, 2.0, 331.0)])
def test_shots_on_a_curve_give_its_limit(a, p, limit):
    speeds = limit * np.array([0.9, 0.98, 1.01, 1.03, 1.06, 1.1, 1.2, 1.4])
    left = [lambert_jonas.residual_velocity(v, limit_velocity=limit, a=a, p=p) for v in speeds]
    found, _ = of_shots(speeds, left)
    assert found.limit_velocity == pytest.approx(limit, rel=2e-3)
    assert (found.a, found.p) == pytest.approx((a, p), rel=0.05)
    assert found.residual(speeds) == pytest.approx(left, abs=0.02 * limit)


def test_a_stopped_shot_above_the_others_raises_the_limit():
    without, _ = of_shots(SPEEDS, LEFT)
    with_it, _ = of_shots([*SPEEDS, 345.0], [*LEFT, 0.0])
    assert with_it.limit_velocity > without.limit_velocity + 1.0
    assert with_it.scatter > without.scatter


def test_units_do_not_matter():
    one, other = of_shots(SPEEDS, LEFT)[0], of_shots([3.0 * v for v in SPEEDS], [3.0 * v for v in LEFT])[0]
    assert other.limit_velocity == pytest.approx(3.0 * one.limit_velocity, rel=1e-3)
    assert (other.low, other.high) == pytest.approx((3.0 * one.low, 3.0 * one.high), rel=2e-3)


@pytest.mark.parametrize(("number", "why"), [(7, "perforations at 3 velocities, and there are 2"), (5, "there are 0")])
def test_too_few_perforations_give_none(number, why):
    limit, reason = of_shots(SPEEDS[:number], LEFT[:number])
    assert limit is None
    assert why in reason


def test_without_a_stopped_shot_there_is_none():
    assert of_shots(SPEEDS[5:], LEFT[5:]) == (None, "no shot was stopped")


@pytest.mark.parametrize("speeds", [[20.0, 60.0, 300.0, 900.0], [1.0, 2.0, 400.0, 401.0], [277.0, 316.0, 340.0, 391.0]])
def test_no_end_of_an_interval_is_negative(speeds):
    by_outcome = logit.fit_transition(speeds, [False, False, True, True])
    assert by_outcome.v50_low is None or by_outcome.v50_low >= 0.0
    assert by_outcome.region[:, 0].min() >= 0.0
    limit = ballistic.fit(speeds, [0.0, 0.0, 0.4 * speeds[2], 0.9 * speeds[3]])
    assert 0.0 <= limit.low < limit.high


# ------------------------------------------------------------------------------------------------ the choice of velocities


@pytest.mark.parametrize("true", [PLATES[0], PLATES[3], Plate(301.0, 1.0, 0.0, 0.9, 2.0, (300.0, 700.0))])
def test_no_velocity_is_used_twice(true):
    for seed in (0, 1):
        speeds, _ = coverage.perforated(true, seed, runs=16)
        assert len({f"{speed:.6g}" for speed in speeds}) == len(speeds)
        assert min(speeds) >= true.ends[0]
        assert max(speeds) <= true.ends[1]


def test_a_velocity_that_was_used_gives_way_to_one_beside_it():
    ends, used = (300.0, 700.0), [300.0, 500.0, 700.0]
    beside = [sequence._unused(speed, used, ends) for speed in (200.0, 500.0, 800.0, 450.0)]
    assert beside[3] == 450.0
    assert all(0.1 < np.abs(np.array(used) - speed).min() < 1.0 for speed in beside[:3])


def test_shots_are_near_the_limit():
    speeds, _ = coverage.perforated(PLATES[0], 2)
    assert np.abs(np.array(speeds[8:]) - 331.0).max() < 15.0


def test_a_round_does_not_wait_for_its_own_residual_velocities():
    speeds, left = coverage.perforated(PLATES[0], 3, runs=10)
    outcomes = [each > 0.0 for each in left]
    next_one = sequence.next_speed(speeds, outcomes, PLATES[0].ends, 4, 0, left)
    assert next_one == sequence.next_speed(speeds, outcomes, PLATES[0].ends, 4, 0, [*left[:8], None, None])
    assert next_one != sequence.next_speed(speeds, outcomes, PLATES[0].ends, 4, 0, [*left[:7], left[7] + 5.0, *left[8:]])


@pytest.mark.thorough
def test_known_limits_are_within_their_intervals():
    found = [of_shots(*coverage.perforated(PLATES[0], seed))[0] for seed in range(10)]
    assert sum(within(331.0, each.low, each.high) for each in found) >= 7
    assert np.median([each.high - each.low for each in found]) < 10.0


@pytest.mark.slow
def test_the_intervals_hold_their_limits_as_often_as_the_page_says():
    told, held = coverage.measure_limits(30, 12)
    assert held >= 0.84 * told


# ------------------------------------------------------------------------------------------------ what a search says


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A search with 12 runs: folder, the combination of transition.json."""
    folder = tmp_path_factory.mktemp("ballistic")
    status, result = test_chance.search(folder, made_up.Client(plate), STUDY)
    assert status == 0
    return folder, result


def test_the_limit_comes_first(whole):
    estimate, (first, second) = whole[1]["estimate"], whole[1]["transitions"]
    assert next(iter(estimate)) == "ballistic_limit_m_s"
    assert estimate["ballistic_limit_low_m_s"] < 1180.0 < estimate["ballistic_limit_high_m_s"]
    assert estimate["ballistic_limit_m_s"] == pytest.approx(1180.0, abs=15.0)
    assert (first["name"], second["name"]) == ("ballistic limit", "v50")
    assert first["low_m_s"] == pytest.approx(estimate["ballistic_limit_low_m_s"], abs=0.1)
    assert whole[1]["notes"][0].startswith(f"ballistic limit = {estimate['ballistic_limit_m_s']:.1f} m/s, 90 % interval ")
    assert [note.split(" =")[0] for note in whole[1]["notes"]].index("v50") > 0


def test_no_case_repeats_a_velocity(whole):
    speeds = [run["velocity_m_s"] for run in whole[1]["runs"]]
    assert len(set(speeds)) == len(speeds) == 12


def test_the_table_has_the_residual_velocities(whole):
    with open(whole[0] / "out" / "transition.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    through = [row for row in rows if row["outcome"] == "perforated"]
    left = {float(row["velocity_m_s"]): float(row["rod_residual_velocity_m_s"]) for row in through}
    fitted = {float(row["velocity_m_s"]): float(row["fitted_residual_velocity_m_s"]) for row in rows}
    for speed, value in left.items():
        if speed > 1250.0:
            assert fitted[speed] == pytest.approx(value, abs=30.0)
    assert [fitted[speed] for speed in fitted if speed < 1150.0] == [0.0] * sum(speed < 1150.0 for speed in fitted)


def test_the_report_says_one_limit(whole):
    out = whole[0] / "out"
    assert call(["report", str(out)]) == 0
    page = Page((out / "report" / "report.html").read_text(encoding="utf-8"))
    assert page.faults == []
    limit = json.loads((out / "transition.json").read_text())["combinations"][0]["estimate"]["ballistic_limit_m_s"]
    assert page.text.lower().count(f"ballistic limit = {limit:.1f} m/s") == 1
    assert f"Lambert-Jonas, fitted to these runs: ballistic limit {limit:.1f} m/s" in page.text


def test_a_search_with_too_few_perforations_says_so(tmp_path):
    text = STUDY.replace("budget = 12", "budget = 4")
    _, result = test_chance.search(tmp_path, made_up.Client(plate), text)
    (bracket,) = result["transitions"]
    assert bracket["name"] == "ballistic limit"
    assert bracket["in_words"].startswith("90 % interval of v50")
    assert any("no ballistic limit from residual velocities: a fit needs" in note for note in result["notes"])
