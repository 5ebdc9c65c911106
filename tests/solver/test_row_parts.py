"""The parts into which the rows of the active box are divided: their bounds, and when they are divided anew."""

from types import SimpleNamespace

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.solver.row_parts import EMPTY, FEWEST, FULL, MIXED, RECUT, Parts, cut


def shares(costs: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Sum of the costs in every part."""
    return np.add.reduceat(costs, bounds[:-1])


@pytest.mark.parametrize("rows", [1, 3, FEWEST, 2 * FEWEST - 1, 2 * FEWEST, 37, 400])
@pytest.mark.parametrize("number", [1, 2, 3, 8, 64])
@pytest.mark.parametrize("spread", [0.0, 3.0, 30.0])
def test_parts_cover_the_rows_and_none_is_too_low(rows, number, spread):
    costs = np.exp(spread * np.random.default_rng(rows + number).standard_normal(rows))
    bounds = cut(costs, number, 5)
    assert (bounds[0], bounds[-1]) == (5, 5 + rows)
    assert len(bounds) - 1 == max(min(number, rows // FEWEST), 1)
    assert np.diff(bounds).min() >= min(FEWEST, rows)
    assert bounds.dtype == np.int64
    assert bounds.flags.c_contiguous  # the one type that phases are compiled for


@pytest.mark.parametrize("number", [2, 3, 7, 16])
def test_parts_cost_the_same_within_a_row(number):
    costs = np.random.default_rng(number).uniform(0.5, 1.5, 300)
    costs[100:120] *= 3.0
    parts = shares(costs, cut(costs, number))
    assert len(parts) == number
    assert np.abs(parts - costs.sum() / number).max() <= costs.max()


def test_expensive_rows_are_shared():
    """Where half of the rows cost ten times as much, their part has a tenth of the rows that it would otherwise have."""
    costs = np.ones(440)
    costs[400:] = 10.0
    assert cut(costs, 2, 2).tolist() == [2, 2 + 400, 2 + 440]


@pytest.mark.parametrize(("dear", "expected"), [(0, [0, 4, 8, 12, 40]), (20, [0, 20, 24, 28, 40]), (39, [0, 28, 32, 36, 40])])
def test_all_costs_in_one_row(dear, expected):
    """The other parts have the smallest number of rows allowed, or the rows next to that row."""
    costs = np.full(40, 1e-12)
    costs[dear] = 1.0
    assert FEWEST == 4
    assert cut(costs, 4).tolist() == expected


@pytest.fixture
def active(monkeypatch):
    """A simple state of 60 rows of 50 columns and two of ghosts around, with two threads."""
    monkeypatch.setattr(jit, "parts_at_once", lambda: 2)
    ranges = np.tile([2, 52], (64, 1))
    return SimpleNamespace(active_range=ranges, mixed_count=np.zeros(64, dtype=np.int64))


def test_rows_cost_what_their_cells_do(active):
    parts = Parts(active)
    assert parts.of([2, 62, 2, 52]).tolist() == [2, 32, 62]
    active.active_range[2:22] = 1 << 30, 0  # empty rows
    parts = Parts(active).of([2, 62, 2, 52])
    costs = np.full(60, 50.0 * (FULL + EMPTY))
    costs[:20] = 50.0 * EMPTY
    assert np.abs(np.diff(shares(costs, parts - 2))) <= 2 * costs.max()
    assert parts[1] > 38
    active.mixed_count[60:62] = 50
    parts, costs = Parts(active).of([2, 62, 2, 52]), costs + [*[0.0] * 58, 50 * MIXED, 50 * MIXED]
    assert np.abs(np.diff(shares(costs, parts - 2))) <= 2 * costs.max()
    assert parts[1] > 50


def test_parts_are_kept_for_some_cycles(active):
    parts = Parts(active)
    first = parts.of([2, 62, 2, 52])
    active.mixed_count[2:12] = 50
    for _ in range(RECUT - 1):
        assert parts.of([2, 62, 2, 52]) is first
    second = parts.of([2, 62, 2, 52])
    assert second[1] < first[1] == 32
    for _ in range(RECUT - 1):
        assert parts.of([2, 62, 2, 52]) is second


@pytest.mark.parametrize(("box", "expected"), [([2, 42, 2, 52], [2, 22, 42]), ([12, 62, 2, 52], [12, 37, 62]),
                                               ([2, 62, 12, 52], [2, 32, 62]), ([2, 9, 2, 52], [2, 9])])
def test_parts_are_cut_anew_for_another_box(active, box, expected):
    """And for another range of columns with the same rows."""
    parts = Parts(active)
    first = parts.of([2, 62, 2, 52])
    cut = parts.of(box)
    assert cut is not first
    assert cut.tolist() == expected
    assert parts.of(box) is cut


def test_parts_are_cut_anew_for_another_number_of_threads(active, monkeypatch):
    parts = Parts(active)
    assert parts.of([2, 62, 2, 52]).tolist() == [2, 32, 62]
    for number, expected in ((3, [2, 22, 42, 62]), (1, [2, 62]), (2, [2, 32, 62])):
        monkeypatch.setattr(jit, "parts_at_once", lambda number=number: number)
        assert parts.of([2, 62, 2, 52]).tolist() == expected
