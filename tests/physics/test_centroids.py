"""Positions in a cell of a body that its neighbours do not place: boxes, continuation across cells, mutual pushing."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hydro2d.physics import centroids, interfaces
from hydro2d.physics.centroids import FILLED, GROWING

within = centroids.within.py_func
box_piece = centroids.box_piece.py_func
goes_on = centroids.goes_on.py_func
beside = centroids.beside.py_func
most_around = centroids.most_around.py_func
rest_of = centroids.rest_of.py_func
placed = centroids.placed.py_func
forms = centroids.forms.py_func
piece_by_form = centroids.piece.py_func
side_of = centroids.side.py_func
most_beside = centroids.most_beside.py_func
youngs_normal = interfaces.youngs_normal.py_func
piece_of_surface = interfaces.piece_of_surface.py_func

FRACTION = st.floats(0.01, 0.99)
OFFSET = st.floats(-0.5, 0.5)
UNIT = st.floats(0.0, 1.0)
STRIP = st.floats(0.01, 0.99)
#: rows and columns, of 5 by 5, of the 17 cells of `add_body`
CELLS = [*((row, column) for row in (1, 2, 3) for column in (1, 2, 3)), (2, 0), (2, 4), (0, 2), (4, 2), (0, 0), (0, 4), (4, 0),
         (4, 4)]
MIDDLE = 4
#: fractions of these cells
AROUND = st.tuples(*[UNIT] * 17)


def piece(f, along_z, along, across, no_gap, bound, strip, high):
    """The piece of a single body, whose box is the only one."""
    box = box_piece(f[MIDDLE], along, across, goes_on(f[MIDDLE], *beside(f, along_z)), strip, high)
    return piece_by_form(f, along_z, along, across, forms(f, float(no_gap)), bound, box, strip, high)


def pushed(own, other, fraction, fraction_other, change):
    """Change of an offset as something else in the cell grows by `change`."""
    return 0.5 * change * side_of(own, other, fraction, fraction_other)


def with_middle(f, fraction):
    return f[:MIDDLE] + (fraction,) + f[MIDDLE + 1:]


def seen(f, where):
    """The fractions of the cells at where(row, column)."""
    return tuple(f[CELLS.index(where(*cell))] for cell in CELLS)


def about_the_middle(piece, strip, high):
    """(share, moments about the middle of the cell) from `line_piece` and similar functions."""
    share, along, across = piece
    return np.array([share, along * strip + share * (0.5 - 0.5 * strip) * (1.0 if high else -1.0), across])


# ------------------------------------------------------------------------------------------------------------ boxes


@given(FRACTION, OFFSET, STRIP, st.booleans())
def test_a_slab_upright_in_its_cell_is_cut_as_it_lies(fraction, offset, strip, high):
    """It fills the cell across, and ends in it along."""
    offset = within(offset, fraction)
    first, last = offset - 0.5 * fraction, offset + 0.5 * fraction
    ends = (0.5 - strip, 0.5) if high else (-0.5, strip - 0.5)
    low, up = max(first, ends[0]), min(last, ends[1])
    share = max(up - low, 0.0)
    moment = share * (0.5 * (low + up) - 0.5 * sum(ends)) / strip
    assert box_piece(fraction, offset, 0.0, 0.0, strip, high) == pytest.approx((share, moment, 0.0), abs=1e-13)


@given(FRACTION, OFFSET, OFFSET, UNIT, UNIT)
def test_a_box_lies_about_its_centroid_and_outside_its_ends_there_is_nothing(fraction, along, across, before, after):
    along, across = within(along, fraction), within(across, fraction)
    low, high = centroids.box_ends(fraction, along, across, before, after)
    continues = centroids.goes_on(fraction, before, after)
    assert 0.5 * (low + high) == pytest.approx(along, abs=1e-14)
    assert -0.5 - 1e-14 <= low <= high <= 0.5 + 1e-14
    for strip, at_high, holds in ((0.5 - high, True, 0.0), (0.5 - low, True, fraction), (low + 0.5, False, 0.0)):
        if strip > 1e-9:
            assert box_piece(fraction, along, across, continues, strip, at_high)[0] == pytest.approx(holds, abs=1e-9)


@given(FRACTION, OFFSET, OFFSET, UNIT, st.floats(0.01, 0.49), st.floats(0.01, 0.49))
def test_strips_of_a_box_add_up(fraction, along, across, continues, w_low, w_high):
    """The two sides and the middle, where the larger strips at the sides contain the smaller ones."""
    def strip(width, high):
        return about_the_middle(box_piece(fraction, along, across, continues, width, high), width, high)

    whole = strip(1.0, True)
    np.testing.assert_allclose(strip(w_low, False) + strip(1.0 - w_low, True), whole, atol=1e-14)
    between = strip(1.0 - w_low, True) - strip(w_high, True)
    np.testing.assert_allclose(strip(w_low, False) + between + strip(w_high, True), whole, atol=1e-14)
    assert -1e-15 <= between[0] <= 1.0 - w_low - w_high + 1e-15
    assert 0.0 <= strip(w_low, False)[0] <= w_low + 1e-15


# ----------------------------------------------------------------------------------------- how neighbours place a piece


def test_the_most_around_is_that_of_a_neighbour_or_of_one_behind_a_fuller_one():
    """On the axes and on the diagonals; the middle cell does not count itself."""
    def most(**others):
        return most_around(tuple(others.get(f"c{row}{column}", 0.2) for row, column in CELLS))

    assert most(c22=0.7) == 0.2
    for row, column in CELLS:
        far, near = (row, column), ((row + 2) // 2, (column + 2) // 2)
        if max(abs(row - 2), abs(column - 2)) == 1:
            assert most(**{f"c{row}{column}": 0.7}) == 0.7
        elif far != (2, 2):
            other = 4 - near[0], 4 - near[1]
            assert most(**{f"c{row}{column}": 0.7}) == 0.2
            assert most(**{f"c{row}{column}": 0.7, f"c{near[0]}{near[1]}": 0.21 + GROWING}) == 0.7
            # what grows to the other side does not lead there
            assert most(**{f"c{row}{column}": 0.7, f"c{other[0]}{other[1]}": 0.21 + GROWING}) == 0.21 + GROWING


def test_the_unfilled_share_is_the_rest_of_each_cell():
    f = tuple(0.05 * k for k in range(17))
    assert rest_of(f) == tuple(1.0 - each for each in f)


@given(AROUND)
def test_the_most_of_the_cells_around_decides_without_those_behind_where_one_is_full(f):
    assert most_beside(f) == max(f[:MIDDLE] + f[MIDDLE + 1:9])
    by_all = centroids.smoothstep.py_func((most_around(f) - FILLED) / (1.0 - FILLED))
    assert placed(f) == by_all


@given(AROUND)
def test_mirrored_bodies_are_placed_alike_to_the_bit(f):
    assert placed(seen(f, lambda row, column: (row, 4 - column))) == placed(f)
    assert placed(seen(f, lambda row, column: (4 - row, column))) == placed(f)
    assert placed(seen(f, lambda row, column: (column, row))) == placed(f)


def surround(f, fraction, along_z):
    """Fractions around one of the fraction, those of 3 x 3 cells going on beyond, and the line that they give it."""
    f = np.array(f, dtype=float)
    f[1, 1] = fraction
    f = np.pad(f, 1, mode="edge")
    f = tuple(float(f[cell]) for cell in CELLS)
    n_r, n_z = youngs_normal(1, 1, f, np.ones(3), np.ones(3))
    return f, (n_z, n_r, 0.0, 0.0, 0.0) if along_z else (n_r, n_z, 0.0, 0.0, 0.0)


#: full below left, empty above right
SLOPE = [[1.0, 0.9, 0.4], [0.8, 0.5, 0.1], [0.3, 0.2, 0.0]]
#: nothing of it fills a cell, and around a plate of it, and a gap through it
SPECK = [[0.1, 0.3, 0.05], [0.2, 0.5, 0.1], [0.0, 0.15, 0.0]]
GAP = 1.0 - np.array(SPECK)


@pytest.mark.parametrize("along_z", [False, True])
@pytest.mark.parametrize("high", [False, True])
def test_the_cells_around_say_whether_line_box_or_gap_give_the_piece(high, along_z):
    """A body on a slope is cut off by its line, one that fills no cell has a box, one that no cell is without one of void."""
    along, across, strip = 0.05, -0.1, 0.35
    f, bound = surround(SLOPE, 0.5, along_z)
    assert piece(f, along_z, along, across, False, bound, strip, high) == piece_of_surface(*bound, 0.5, strip, high)
    f, bound = surround(SPECK, 0.4, along_z)
    expected = box_piece(0.4, along, across, goes_on(0.4, *beside(f, along_z)), strip, high)
    assert piece(f, along_z, along, across, False, bound, strip, high) == expected
    f, bound = surround(GAP, 0.6, along_z)
    empty = goes_on(0.4, *(1.0 - each for each in beside(f, along_z)))
    share, a, c = box_piece(0.4, -1.5 * along, -1.5 * across, empty, strip, high)
    result = piece(f, along_z, along, across, False, bound, strip, high)
    assert result == pytest.approx((strip - share, -a, -c), abs=1e-15)


@given(FRACTION, OFFSET, OFFSET, STRIP, st.booleans(), AROUND, st.floats(-1.0, 1.0))
def test_the_piece_of_a_mirrored_body_is_mirrored_to_the_bit(fraction, along, across, strip, high, f, n_x):
    assume(0.0 < abs(n_x) < 1.0)
    f = with_middle(f, fraction)
    share, a, c = piece(f, False, along, across, False, (n_x, 1.0 - abs(n_x), 0.0, 0.0, 0.0), strip, high)
    left = seen(f, lambda row, column: (row, 4 - column))
    assert piece(left, False, -along, across, False, (-n_x, 1.0 - abs(n_x), 0.0, 0.0, 0.0), strip, not high) == (share, -a, c)
    down = seen(f, lambda row, column: (4 - row, column))
    assert piece(down, False, along, -across, False, (n_x, abs(n_x) - 1.0, 0.0, 0.0, 0.0), strip, high) == (share, a, -c)


@given(FRACTION, OFFSET, OFFSET, STRIP, st.booleans(), AROUND, st.floats(-1.0, 1.0))
def test_the_piece_along_z_is_that_along_r_of_cells_with_their_axes_exchanged(fraction, along, across, strip, high, f, n_x):
    f = with_middle(f, fraction)
    bound = n_x, 1.0 - abs(n_x), 0.0, 0.0, 0.0
    turned = seen(f, lambda row, column: (column, row))
    rest = along, across, False, bound, strip, high
    assert piece(f, True, *rest) == piece(turned, False, *rest)


# ------------------------------------------------------------------------------------------------- mutual pushing


@given(FRACTION, UNIT, st.floats(-0.1, 0.1))
def test_slabs_side_by_side_push_each_other_by_half_of_their_growth(fraction, share, change):
    """Centroids that are half of both widths apart, or more."""
    other = share * (1.0 - fraction)
    apart = 0.5 * (fraction + other)
    for gap in (0.0, 0.05):
        upper, lower = 0.1 + apart + gap, 0.1
        assert pushed(upper, lower, fraction, other, change) == pytest.approx(0.5 * change, abs=1e-15)
        assert pushed(lower, upper, fraction, other, change) == pytest.approx(-0.5 * change, abs=1e-15)
