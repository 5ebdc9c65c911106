"""The parts into which the rows of the active box are cut: their bounds, and when they are cut anew."""

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.kernels import between_phases
from hydro2d.kernels.between import active_box
from hydro2d.kernels.between.active_box import EMPTY, FEWEST, FULL, MIXED, RECUT


def cut(costs, number: int, first: int = 0) -> np.ndarray:
    bounds = np.zeros(max(min(number, len(costs) // FEWEST), 1) + 1, dtype=np.int64)
    active_box.cut(np.concatenate([np.zeros(first, dtype=np.int64), costs]), first, first + len(costs), bounds)
    return bounds


def shares(costs: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Sum of the costs in every part."""
    return np.add.reduceat(costs, bounds[:-1])


@pytest.mark.parametrize("rows", [1, 3, FEWEST, 2 * FEWEST - 1, 2 * FEWEST, 37, 400])
@pytest.mark.parametrize("number", [1, 2, 3, 8, 64])
@pytest.mark.parametrize("spread", [0.0, 3.0, 10.0])
def test_parts_cover_the_rows_and_none_is_too_low(rows, number, spread):
    costs = np.ceil(np.exp(spread * np.random.default_rng(rows + number).standard_normal(rows))).astype(np.int64)
    bounds = cut(costs, number, 5)
    assert (bounds[0], bounds[-1]) == (5, 5 + rows)
    assert np.diff(bounds).min() >= min(FEWEST, rows)


@pytest.mark.parametrize("number", [2, 3, 7, 16])
def test_parts_cost_the_same_within_a_row(number):
    costs = np.random.default_rng(number).integers(500, 1500, 300)
    costs[100:120] *= 3
    parts = shares(costs, cut(costs, number))
    assert len(parts) == number
    assert np.abs(parts - costs.sum() / number).max() <= costs.max()


@pytest.mark.parametrize(("dear", "expected"), [(0, [0, 4, 8, 12, 40]), (20, [0, 20, 24, 28, 40]), (39, [0, 28, 32, 36, 40])])
def test_all_costs_in_one_row(dear, expected):
    """The other parts have the smallest number of rows allowed, or the rows next to that row."""
    costs = np.ones(40, dtype=np.int64)
    costs[dear] = 10**9
    assert cut(costs, 4).tolist() == expected


@pytest.fixture
def handle():
    """A simple state of 60 rows of 50 columns and two of ghosts around, for two parts."""
    handle, mesh = jit.Handle(), np.array([2, 62, 2, 52])
    handle.update(
        box=mesh.copy(), mesh_box=mesh, moving=np.zeros(4, dtype=np.int64), grows=False, anew=True, i0=2, i1=52, most_parts=2,
        age=0, asks=0, parts=np.array([2, 2, 62]), row_costs=np.zeros(64, dtype=np.int64),
        mixed_count=np.zeros(64, dtype=np.int64), active_range=np.tile([2, 52], (64, 1)))
    return handle


def test_rows_cost_what_their_cells_do(handle):
    between_phases.cut_parts(handle)
    assert handle.parts.tolist() == [2, 32, 62]
    handle.active_range[2:22] = 1 << 30, 0  # empty rows
    between_phases.cut_parts(handle)
    costs = np.full(60, 50 * (FULL + EMPTY))
    costs[:20] = 50 * EMPTY
    assert np.abs(np.diff(shares(costs, handle.parts - 2))) <= 2 * costs.max()
    assert handle.parts[1] > 38
    handle.mixed_count[60:62] = 50
    between_phases.cut_parts(handle)
    costs[58:] += 50 * MIXED
    assert np.abs(np.diff(shares(costs, handle.parts - 2))) <= 2 * costs.max()
    assert handle.parts[1] > 50


def test_parts_are_kept_for_some_cycles(handle):
    between_phases.cut_parts(handle)
    handle.mixed_count[2:12] = 50
    handle.update(anew=False)
    for _ in range(RECUT - 1):
        between_phases.cut_parts(handle)
        assert handle.parts[1] == 32
    between_phases.cut_parts(handle)
    assert handle.parts[1] < 32


@pytest.mark.parametrize(("number", "rows", "asks"), [
    (2, 60, 0), (3, 60, 1), (1, 60, 1), (2, 2 * FEWEST, 0), (2, 2 * FEWEST - 1, 1)])
def test_python_is_asked_for_another_number_of_parts(handle, number, rows, asks):
    handle.update(most_parts=number)
    handle.box[1] = handle.box[0] + rows
    between_phases.cut_parts(handle)
    assert handle.asks == asks


@pytest.mark.parametrize(("box", "moving", "grown"), [
    ([20, 30, 10, 20], [25, 26, 15, 16], [18, 32, 8, 22]), ([20, 30, 10, 20], [20, 21, 15, 16], [13, 30, 8, 22]),
    ([20, 30, 10, 20], [25, 25, 0, 0], [20, 30, 10, 20]), ([2, 30, 2, 20], [3, 24, 3, 14], [2, 30, 2, 20]),
    ([20, 60, 10, 50], [55, 60, 40, 49], [20, 62, 10, 52]),
])
def test_the_box_leads_what_moves_by_a_margin(handle, box, moving, grown):
    """Vertices from 25 to 25 move: the cells from 24 to 25 have work, and six beyond lead them."""
    handle.box[:], handle.moving[:] = box, moving
    handle.update(grows=True, anew=False)
    between_phases.grow_box(handle)
    assert handle.box.tolist() == grown
    assert handle.anew is (box != grown)
    assert (handle.i0, handle.i1) == tuple(grown[2:])
    assert handle.grows is True


def test_a_box_that_fills_the_mesh_grows_no_more(handle):
    handle.moving[:] = 2, 63, 2, 53
    handle.box[:] = 10, 20, 10, 20
    handle.update(grows=True)
    between_phases.grow_box(handle)
    assert handle.box.tolist() == [2, 62, 2, 52]
    assert handle.grows is False
