"""v50 and width by logistic regression, the sequential choice of velocities, and V50 of MIL-STD-662F; without any run."""

import numpy as np
import pytest

from hydro2d.study.ensemble import chance
from hydro2d.study.search import logit, sequence, v50
from tests.study import coverage
from tests.study.coverage import within

ENDS = (900.0, 1500.0)


def searched(v50, width, seed, runs=40):
    """A search for a made-up outcome that is logistic in velocity: velocities and outcomes."""
    return coverage.searched(coverage.Transition(v50, width, ENDS), seed, runs)


@pytest.mark.thorough
@pytest.mark.parametrize(("v50", "width"), [(1210.0, 60.0), (1065.0, 15.0)])
def test_a_known_transition_is_within_its_interval_in_nine_of_ten_searches(v50, width):
    fitted = [logit.fit_transition(*searched(v50, width, seed)) for seed in range(10)]
    assert sum(within(v50, each.v50_low, each.v50_high) for each in fitted) >= 9
    assert sum(within(width, each.width_low, each.width_high) for each in fitted) >= 8
    assert np.median([each.v50_high - each.v50_low for each in fitted]) < 0.6 * width
    assert np.median([each.v50 for each in fitted]) == pytest.approx(v50, abs=0.15 * width)


@pytest.mark.slow
def test_the_intervals_hold_their_values_as_often_as_the_page_says():
    counts = coverage.measure(40, 40)
    estimated = sum(each.told for each in counts)
    for number in (sum(each.v50 for each in counts), sum(each.width for each in counts)):
        assert chance.wilson(number, estimated).high >= 0.9
        assert number >= 0.86 * estimated


def test_shots_are_near_the_transition():
    """Half of 40 shots lie where the outcome is not nearly certain; evenly spread, 4 of them would."""
    speeds, _ = searched(1210.0, 60.0, 1)
    assert sum(abs(speed - 1210.0) < 45.0 for speed in speeds) >= 20


def test_the_estimate_is_the_maximum_and_the_interval_its_profile():
    speeds, outcomes = searched(1210.0, 60.0, 3)
    fitted = logit.fit_transition(speeds, outcomes)
    v, y = np.array(speeds), np.array(outcomes)
    top = logit.penalised(fitted.v50, fitted.scale, v, y)
    around = logit.penalised(fitted.v50 + np.array([-1, 0, 1])[:, None], fitted.scale * np.array([0.9, 1.0, 1.1]), v, y)
    assert top == pytest.approx(around.max(), abs=1e-9)
    for end in (fitted.v50_low, fitted.v50_high):
        profile = logit.penalised(end, np.exp(np.linspace(-1, 6, 4001)), v, y).max()
        assert 2.0 * (top - profile) == pytest.approx(logit.CHI2, rel=0.05)
    for end in (fitted.width_low, fitted.width_high):
        profile = logit.penalised(np.linspace(1000, 1400, 4001), end / logit.WIDTHS, v, y).max()
        assert 2.0 * (top - profile) == pytest.approx(logit.CHI2_WIDTH, rel=0.08)


def test_four_shots_by_hand():
    """Symmetric shots at -3, -1, 1, 3 without overlap: v50 is 0, and s maximises (2), found here by a fine search."""
    fitted = logit.fit_transition([-3.0, -1.0, 1.0, 3.0], [False, False, True, True])
    scale = np.exp(np.linspace(-2, 3, 50001))
    a, b = 1 / (1 + np.exp(-1 / scale)), 1 / (1 + np.exp(-3 / scale))
    wa, wb = a * (1 - a), b * (1 - b)
    value = 2 * np.log(a) + 2 * np.log(b) + 0.5 * np.log((2 * wa + 2 * wb) * (2 * wa + 18 * wb))
    assert fitted.v50 == pytest.approx(0.0, abs=1e-3)
    assert fitted.scale == pytest.approx(scale[np.argmax(value)], rel=1e-3)
    assert not fitted.overlap
    assert fitted.width_low == 0.0


def test_a_sudden_change_has_an_interval_about_its_gap():
    speeds = [*range(900, 1201, 25), *range(1210, 1501, 25)]
    fitted = logit.fit_transition(speeds, [speed > 1205 for speed in speeds])
    assert fitted.v50_low < 1200
    assert fitted.v50_high > 1210
    assert fitted.v50_high - fitted.v50_low < 120
    assert (fitted.overlap, fitted.width_low) == (False, 0.0)


def test_units_do_not_matter():
    speeds, outcomes = searched(1210.0, 60.0, 4)
    one, other = logit.fit_transition(speeds, outcomes), logit.fit_transition([speed / 1e3 for speed in speeds], outcomes)
    assert other.v50 == pytest.approx(one.v50 / 1e3, rel=1e-5)
    assert other.v50_high == pytest.approx(one.v50_high / 1e3, rel=1e-3)


@pytest.mark.parametrize("outcomes", [[True] * 4, [False] * 4, [True, True, False, False]])
def test_shots_that_do_not_tell_give_no_estimate(outcomes):
    assert logit.fit_transition([900.0, 1000.0, 1100.0, 1200.0], outcomes) is None


def test_one_velocity_gives_no_estimate():
    assert logit.fit_transition([900.0, 900.0], [True, False]) is None


def test_outcomes_of_pure_chance_leave_the_interval_open():
    chance_alone = [True, False, False, True, False, True, False, True, False, True, False, True]
    fitted = logit.fit_transition([900.0, 1100.0, 1300.0, 1500.0] * 3, chance_alone)
    assert (fitted.v50_low, fitted.v50_high) == (None, None)


def test_the_band_holds_the_curve_and_is_narrowest_near_v50():
    fitted = logit.fit_transition(*searched(1210.0, 60.0, 5))
    speeds = np.linspace(*ENDS, 50)
    low, high = fitted.band(speeds)
    probability = fitted.probability(speeds)
    assert ((low <= probability + 1e-9) & (probability <= high + 1e-9)).all()
    assert (np.diff(probability) >= 0).all()


# ------------------------------------------------------------------------------------------------ the choice of velocities


def test_the_first_round_is_spread_from_end_to_end():
    speeds = []
    for _ in range(4):
        speeds.append(sequence.next_speed(speeds, [None] * len(speeds), ENDS, 4))
    assert speeds == [900, 1100, 1300, 1500]


@pytest.mark.parametrize("change", [905.0, 1495.0])
def test_no_shot_lies_outside_the_interval(change):
    speeds, outcomes = [], []
    while len(speeds) < 24:
        speeds.append(sequence.next_speed(speeds, outcomes, ENDS, 4))
        outcomes.append(speeds[-1] > change)
    assert min(speeds) == 900.0
    assert max(speeds) == 1500.0


def test_a_round_does_not_wait_for_its_own_outcomes():
    speeds, outcomes = searched(1210.0, 60.0, 6, runs=18)
    unknown = [*outcomes[:16], None, None]
    assert sequence.next_speed(speeds, outcomes, ENDS, 4) == sequence.next_speed(speeds, unknown, ENDS, 4)
    turned = [*outcomes[:15], not outcomes[15], *outcomes[16:]]
    assert sequence.next_speed(speeds, outcomes, ENDS, 4) != sequence.next_speed(speeds, turned, ENDS, 4)


def test_one_strange_shot_is_found_out():
    """A shot at 1300 m/s that holds by chance, although the transition is at 1000 m/s, does not mislead the search for ever."""
    speeds, outcomes = [], []
    for number in range(32):
        speeds.append(sequence.next_speed(speeds, outcomes, ENDS, 4))
        outcomes.append(speeds[-1] > 1000.0 and number != 2)
    assert logit.fit_transition(speeds, outcomes).v50 == pytest.approx(1000.0, abs=100.0)


def test_outcomes_that_are_all_alike_end_a_search():
    assert not sequence.alike([False] * 7, 4)
    assert sequence.alike([False] * 8, 4)
    assert sequence.alike([False] * 7 + [None], 4)
    assert not sequence.alike([False] * 7 + [True], 4)


# ------------------------------------------------------------------------------------------------ MIL-STD-662F


def test_v50_of_the_military_standard():
    """Two of each within 18 m/s: 804 and 806 were stopped, 801 and 810 were not."""
    assert v50.military([790, 804, 806, 801, 810, 850], [False, False, False, True, True, True]) == (805.25, 4)


def test_the_largest_group_that_is_close_enough_counts():
    stopped, through = [800, 802, 804, 806, 808], [803, 805, 807, 809, 811]
    speeds, outcomes = stopped + through, [False] * 5 + [True] * 5
    assert v50.military(speeds, outcomes) == (np.mean(speeds), 10)
    speeds[0] = 770
    assert v50.military(speeds, outcomes) == (np.mean([804, 806, 808, 803, 805, 807]), 6)


@pytest.mark.parametrize("outcomes", [[False, False, True, True], [False] * 4])
def test_shots_far_apart_or_of_one_outcome_have_no_v50_of_the_standard(outcomes):
    assert v50.military([700, 780, 800, 900], outcomes) is None
