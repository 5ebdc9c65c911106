"""Positions in a cell of a body that its neighbours do not place: boxes, continuation across cells, mutual pushing."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hydro2d.physics import centroids, interfaces
from hydro2d.physics.centroids import FILLED, GROWING
from tests.physics.continuity import changes_in_proportion, largest_jump

within = centroids.within.py_func
box_length = centroids.box_length.py_func
box_piece = centroids.box_piece.py_func
goes_on = centroids.goes_on.py_func
beside = centroids.beside.py_func
reached = centroids.reached.py_func
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


@given(st.floats(-2.0, 2.0), UNIT)
def test_a_centroid_leaves_room_for_its_piece(offset, fraction):
    """A piece as wide as its fraction, with this centroid, ends in the cell; an offset that allows this is kept."""
    kept = within(offset, fraction)
    assert abs(kept) + 0.5 * fraction <= 0.5 + 1e-15
    assert within(kept, fraction) == kept
    assert kept == offset or abs(offset) + 0.5 * fraction > 0.5 - 1e-15
    assert within(-offset, fraction) == -kept


def test_a_centroid_goes_no_further_than_to_the_face():
    assert within(0.1, 0.3) == 0.1


@pytest.mark.parametrize("offset", [-0.1, 0.0, 0.1])
def test_a_fraction_above_one_leaves_no_room_on_either_side(offset):
    assert within(offset, 1.0 + 2e-16) == 0.0
    assert within(0.5, 0.3) == pytest.approx(0.35)
    assert within(-0.5, 0.3) == pytest.approx(-0.35)
    assert within(0.2, 1.0) == 0.0


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


@given(FRACTION, OFFSET, OFFSET, UNIT, st.booleans())
def test_the_whole_cell_has_the_fraction_and_the_centroid(fraction, along, across, continues, high):
    along, across = within(along, fraction), within(across, fraction)
    whole = box_piece(fraction, along, across, continues, 1.0, high)
    assert whole == pytest.approx((fraction, fraction * along, fraction * across), abs=1e-14)


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


@given(FRACTION, OFFSET, OFFSET, UNIT, STRIP, st.booleans())
def test_mirrored_boxes_have_mirrored_pieces_to_the_bit(fraction, along, across, continues, strip, high):
    share, a, c = box_piece(fraction, along, across, continues, strip, high)
    assert box_piece(fraction, -along, across, continues, strip, not high) == (share, -a, c)
    assert box_piece(fraction, along, -across, continues, strip, high) == (share, a, -c)


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


def test_a_box_is_as_short_as_can_be_where_it_ends_and_as_long_where_it_goes_on():
    """A fifth of the cell in its middle: across the whole of it, or along the whole of it."""
    assert box_piece(0.2, 0.0, 0.0, 0.0, 0.39, False) == (0.0, 0.0, 0.0)
    assert box_piece(0.2, 0.0, 0.0, 1.0, 0.4, False) == pytest.approx((0.08, 0.0, 0.0))
    # half of the way between: from -0.3 to 0.3, of which 0.2 lies in the strip, its middle 0.1 off that of the strip
    assert box_piece(0.2, 0.0, 0.0, 0.5, 0.4, False) == pytest.approx((0.2 / 3.0, 0.2 / 3.0 * 0.25, 0.0))
    # at the upper face it is as tall as that leaves, 0.4, and 0.5 long
    share, along, across = box_piece(0.2, 0.0, 0.3, 0.0, 0.5, True)
    assert (share, along, across) == pytest.approx((0.1, 0.1 * -0.25, 0.1 * 0.3))


# ----------------------------------------------------------------------------------------- how neighbours place a piece


def test_a_body_that_continues_in_either_neighbour_continues():
    assert goes_on(0.2, 0.0, 0.0) == 0.0
    assert goes_on(0.2, 0.05, 0.1) == 0.5
    assert goes_on(0.2, 0.1, 0.05) == 0.5
    assert goes_on(0.2, 0.0, 0.7) == 1.0


def test_the_cells_before_and_after_lie_along_the_sweep():
    """Of cells counted row by row upwards: left and right, below and above."""
    assert beside(tuple(range(9)), False) == (3, 5)
    assert beside(tuple(range(9)), True) == (1, 7)


def test_a_cell_two_away_is_reached_as_far_as_the_one_between_is_fuller_than_the_middle_one():
    assert reached(0.3, 0.3, 0.9) == reached(0.3, 0.1, 0.9) == 0.0
    assert reached(0.3, 0.3 + 0.5 * GROWING, 0.9) == pytest.approx(0.45)
    assert reached(0.3, 0.31 + GROWING, 0.9) == 0.9
    for near in (0.3, 0.3 + GROWING):
        changes_in_proportion(lambda near: reached(0.3, near, 0.9), near, 1.5 / GROWING)


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


def test_one_full_cell_around_places_a_body_and_one_empty_cell_the_rest():
    middle = 0.5 * (1.0 + FILLED)
    for n in (0, 1, 2, 3, 5, 6, 7, 8):
        for most, by in ((1.0, 1.0), (FILLED, 0.0), (middle, 0.5), (0.5, 0.0)):
            f = tuple(most if k == n else 0.4 for k in range(17))
            assert placed(f) == pytest.approx(by)
            empty = tuple(1.0 - most if k == n else 0.4 for k in range(17))
            assert placed(rest_of(empty)) == pytest.approx(by)
            assert placed(empty) == 0.0


@given(AROUND)
def test_the_most_of_the_cells_around_decides_without_those_behind_where_one_is_full(f):
    assert most_beside(f) == max(f[:MIDDLE] + f[MIDDLE + 1:9])
    by_all = centroids.smoothstep.py_func((most_around(f) - FILLED) / (1.0 - FILLED))
    assert placed(f) == by_all


@given(FRACTION, OFFSET, OFFSET, UNIT)
def test_a_box_fits_in_its_cell_and_holds_its_fraction(fraction, along, across, continues):
    along, across = within(along, fraction), within(across, fraction)
    length = box_length(fraction, along, across, continues)
    room = (1.0 - 2.0 * abs(along)) * (1.0 - 2.0 * abs(across))
    assert fraction <= length <= 1.0 - 2.0 * abs(along) + 1e-15
    assert room < fraction or fraction / length <= 1.0 - 2.0 * abs(across) + 1e-15
    assert length >= box_length(fraction, along, across, 0.5 * continues)


@given(AROUND, UNIT)
def test_the_forms_of_a_piece_share_it(f, no_gap):
    line, box, gap = forms(f, no_gap)
    assert line + box + gap == pytest.approx(1.0, abs=1e-15)
    assert min(line, box, gap) >= 0.0
    assert line == placed(f) * max(no_gap, placed(rest_of(f)))
    assert no_gap < 1.0 or gap == pytest.approx(0.0, abs=1e-15)


def test_boxes_of_several_bodies_are_put_in_the_place_of_one():
    f, bound = surround(SPECK, 0.4, False)
    boxes = 0.3, -0.01, 0.02
    assert piece_by_form(f, False, 0.05, -0.1, forms(f, 0.0), bound, boxes, 0.35, True) == boxes


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


def test_a_cell_that_a_body_fills_has_all_of_the_strip():
    f = with_middle((0.5,) * 17, 1.0)
    assert piece(f, False, 0.1, 0.1, False, (1.0, 0.0, 0.0, 0.0, 0.0), 0.3, True) == (0.3, 0.0, 0.0)


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


@pytest.mark.parametrize("high", [False, True])
def test_next_to_a_gas_void_has_no_box(high):
    """A body that fills a cell around is cut off by its line, though none is empty; one that fills none keeps its box."""
    f, bound = surround(GAP, 0.6, False)
    line = piece_of_surface(*bound, 0.6, 0.35, high)
    assert piece(f, False, 0.05, -0.1, True, bound, 0.35, high) == line
    assert piece(f, False, 0.05, -0.1, False, bound, 0.35, high) != pytest.approx(line, abs=1e-3)
    for pattern in (SLOPE, SPECK):
        f, bound = surround(pattern, 0.4, False)
        assert piece(f, False, 0.05, -0.1, True, bound, 0.35, high) == piece(f, False, 0.05, -0.1, False, bound, 0.35, high)


@given(FRACTION, OFFSET, OFFSET, STRIP, st.booleans(), st.booleans(), AROUND,
       st.floats(-1.0, 1.0), st.sampled_from([(0.0, 0.0, 0.0), (0.4, 0.5, 0.7), (-0.4, -0.5, 0.3)]))
def test_the_piece_of_a_body_and_that_of_all_else_are_the_strip(fraction, along, across, strip, high, along_z, f, n_x, corner):
    f = with_middle(f, fraction)
    rest = 1.0 - fraction
    along, across = (within(each, fraction) * min(1.0, rest / fraction) for each in (along, across))  # those of both fit in
    bound = (n_x, 1.0 - abs(n_x), *corner)
    other_bound = (-bound[0], -bound[1], -corner[0], -corner[1], corner[2])
    assume(bound[0] != 0.0 and bound[1] != 0.0)
    mine = np.array(piece(f, along_z, along, across, False, bound, strip, high))
    other = tuple(1.0 - each for each in f)
    place = -along * fraction / rest, -across * fraction / rest
    rests = np.array(piece(other, along_z, *place, False, other_bound, strip, high))
    np.testing.assert_allclose(mine + rests, [strip, 0.0, 0.0], atol=1e-6 if min(abs(n_x), 1.0 - abs(n_x)) < 1e-6 else 1e-10)


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


def walked(first, last, fraction, strip, along_z, high, gas):
    """The piece of a body as the fractions around it, and their line, walk from one pattern to another, share 0 to 1."""
    def pieces(share):
        f, bound = surround((1.0 - share) * np.array(first) + share * np.array(last), fraction, along_z)
        return piece(f, along_z, -0.1, 0.15, gas, bound, strip, high)

    return pieces


@pytest.mark.parametrize("along_z", [False, True])
@pytest.mark.parametrize(("high", "gas"), [(False, False), (True, False), (True, True)])
@pytest.mark.parametrize(("first", "last"), [(SLOPE, SPECK), (SLOPE, GAP), (SPECK, GAP)], ids=["box", "gap", "both"])
def test_a_piece_does_not_jump_as_its_neighbours_cease_to_place_it(first, last, high, gas, along_z):
    pieces = walked(first, last, 0.5, 0.3, along_z, high, gas)
    assert np.abs(np.subtract(pieces(1.0), pieces(0.0))).max() > 0.01
    assert largest_jump(pieces, 0.0, 1.0) < 1e-11


@pytest.mark.parametrize("filled", [1.0, FILLED])
def test_a_piece_changes_in_proportion_as_a_full_neighbour_ceases_to_be_full(filled):
    """The body lies on a full cell at the left, void is at the right: then it has no cell that it fills."""
    def pieces(share):
        f, bound = surround([[0.1, 0.0, 0.0], [share, 0.0, 0.0], [0.2, 0.0, 0.0]], 0.4, False)
        return piece(f, False, 0.0, 0.1, False, bound, 0.5, True)

    assert np.abs(np.subtract(pieces(1.0), pieces(FILLED))).max() > 0.05
    changes_in_proportion(pieces, filled, 1.5 / (1.0 - FILLED))
    assert largest_jump(pieces, 0.0, 1.0) < 1e-11


@pytest.mark.parametrize("filled", [0.0, 1.0 - FILLED])
def test_a_piece_changes_in_proportion_as_an_empty_neighbour_ceases_to_be_empty(filled):
    def pieces(share):
        f, bound = surround([[1.0, 1.0, 0.9], [1.0, 1.0, share], [1.0, 1.0, 0.8]], 0.6, False)
        return piece(f, False, 0.0, 0.1, False, bound, 0.3, True)

    assert np.abs(np.subtract(pieces(0.0), pieces(1.0 - FILLED))).max() > 0.05
    changes_in_proportion(pieces, filled, 1.5 / (1.0 - FILLED), sides=(1.0,) if filled == 0.0 else (-1.0, 1.0))
    assert largest_jump(pieces, 0.0, 1.0) < 1e-11


@pytest.mark.parametrize("pattern", [SLOPE, SPECK, GAP], ids=["line", "box", "gap"])
def test_a_piece_becomes_the_strip_as_the_body_fills_the_cell(pattern):
    f, bound = surround(pattern, 1.0 - 1e-10, False)
    assert piece(f, False, 0.3, -0.2, False, bound, 0.3, True) == pytest.approx((0.3, 0.0, 0.0), abs=1e-9)


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


def test_a_slab_amidst_another_one_stays_and_off_its_middle_it_is_pushed_in_proportion():
    assert pushed(0.1, 0.1, 0.2, 0.8, 0.05) == 0.0
    assert pushed(0.2, 0.1, 0.2, 0.8, 0.05) == pytest.approx(0.5 * 0.05 * 0.1 / 0.5)
    assert pushed(0.1, 0.2, 0.2, 0.8, 0.05) == -pushed(0.2, 0.1, 0.2, 0.8, 0.05)


@given(st.floats(0.05, 0.8), UNIT, st.floats(0.0, 1.0))
def test_a_slab_inside_void_keeps_the_proportion_of_its_gaps(fraction, share, growth):
    """As it grows into the void, which is all the rest and loses its gain."""
    void = 1.0 - fraction
    growth *= void
    low, up = share * void, (1.0 - share) * void
    own = low + 0.5 * fraction - 0.5
    after = own + pushed(own, -own * fraction / void, fraction, void, -growth)
    assert after - 0.5 * (fraction + growth) + 0.5 == pytest.approx(low * (1.0 - growth / void), abs=1e-14)
    assert 0.5 - (after + 0.5 * (fraction + growth)) == pytest.approx(up * (1.0 - growth / void), abs=1e-14)


def test_a_push_does_not_jump_where_slabs_come_to_lie_side_by_side():
    for side in (-1.0, 1.0):
        changes_in_proportion(lambda own: pushed(own, 0.0, 0.2, 0.3, 0.1), side * 0.25, 0.21)
