"""The search alone, on made-up regimes: brackets contain the transition and are one step wide; every search ends."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.measure.regime import GROWING
from hydro2d.study.search.bisection import MOST_FAILED, Search, bracket, disordered

RIGID, DEFORMING, ERODING = GROWING


def ordered(count, deforming, eroding):
    """Regimes in order: the positions of the first deforming and the first eroding rod."""
    return [GROWING[(n >= deforming) + (n >= eroding)] for n in range(count)]


def play(regimes, workers=1, failing=(), finishes=lambda busy: busy[0]):
    """Runs a search with so many runs at a time; `finishes` says which of them ends next. Returns it and the runs made."""
    search, busy, made = Search(len(regimes)), [], []
    while True:
        while len(busy) < workers and (position := search.next(busy)) is not None:
            assert position not in made
            busy.append(position)
            made.append(position)
        if not busy:
            assert search.further() == 0
            return search, made
        position = finishes(busy)
        busy.remove(position)
        if position in failing:
            search.failed.add(position)
        else:
            search.found[position] = regimes[position]


@st.composite
def thresholds(draw):
    count = draw(st.integers(2, 300))
    deforming = draw(st.integers(0, count))
    return count, deforming, draw(st.integers(deforming, count))


def expected(count, first):
    """The bracket of a regime that begins at a position."""
    return (first - 1 if first > 0 else None), (first if first < count else None)


@given(thresholds(), st.integers(1, 6), st.data())
def test_brackets_hold_the_transitions_and_are_one_step_wide(case, workers, data):
    count, deforming, eroding = case
    search, made = play(ordered(*case), workers, finishes=lambda busy: data.draw(st.sampled_from(busy)))
    assert bracket(search.found, DEFORMING) == expected(count, deforming)
    assert bracket(search.found, ERODING) == expected(count, eroding)
    steps = math.ceil(math.log2(count - 1)) if count > 2 else 0
    assert len(made) <= min(count, 2 + 2 * steps * workers)
    assert disordered(search.found) == []


@given(st.integers(2, 300), st.data())
def test_three_runs_at_a_time_quarter_a_bracket(count, data):
    """All three of a round end before the next round."""
    first = data.draw(st.integers(1, count - 1))
    regimes, search, rounds = ordered(count, first, first), Search(count), 0
    search.found = {0: RIGID, count - 1: ERODING}
    while (position := search.next()) is not None:
        busy = [position]
        while len(busy) < 3 and (position := search.next(busy)) is not None:
            busy.append(position)
        search.found |= {position: regimes[position] for position in busy}
        rounds += 1
    assert bracket(search.found, ERODING) == (first - 1, first)
    assert rounds <= math.ceil(math.log2(count) / 2) + 1


@given(st.lists(st.sampled_from(GROWING), min_size=2, max_size=60), st.integers(1, 4))
def test_regimes_out_of_order_end_too_and_are_seen(regimes, workers):
    search, made = play(regimes, workers)
    for regime in (DEFORMING, ERODING):
        low, high = bracket(search.found, regime)
        if low is not None and high is not None:
            assert high - low == 1
            assert GROWING.index(regimes[low]) < GROWING.index(regime) <= GROWING.index(regimes[high])
    seen = [GROWING.index(regimes[n]) for n in sorted(made)]
    assert bool(disordered(search.found)) == (seen != sorted(seen))


@given(thresholds(), st.sets(st.integers(0, 299), max_size=8), st.integers(1, 3))
def test_runs_that_fail_leave_a_bracket_that_holds_the_transition(case, failing, workers):
    count, deforming, eroding = case
    search, made = play(ordered(*case), workers, failing)
    assert len(search.failed) <= MOST_FAILED - 1 + workers
    for first, regime in ((deforming, DEFORMING), (eroding, ERODING)):
        low, high = bracket(search.found, regime)
        low, high = -1 if low is None else low, count if high is None else high
        assert low < first <= high
        if len(search.failed) < MOST_FAILED:
            assert set(range(low + 1, high)) <= search.failed


def test_all_runs_fail():
    search, made = play(ordered(25, 8, 12), failing=range(25))
    assert len(made) == MOST_FAILED
    assert bracket(search.found, DEFORMING) == (None, None)


def test_a_begun_run_inside_a_bracket_goes_first():
    search = Search(25, found={0: RIGID, 24: ERODING}, begun={7})
    assert search.next() == 7
    assert search.next([7]) == 15  # the middle of the wider gap
    search.found[12] = RIGID
    assert search.next() == 18  # 7 is no longer needed


@pytest.mark.parametrize(("regime", "ends"), [(RIGID, (24, None)), (ERODING, (None, 0))])
def test_an_interval_without_transition_takes_two_runs(regime, ends):
    search, made = play([regime] * 25)
    assert (len(made), bracket(search.found, DEFORMING), bracket(search.found, ERODING)) == (2, ends, ends)
