"""The limited difference, and the donor of a face."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import advection

STEEP = 2.0


def limited_difference(a, b, steepness=STEEP):
    return advection.limited_difference.py_func(a, b, steepness)


def upwind(up, ll, l, r, rr, steepness=STEEP):
    return advection.upwind.py_func(up, ll, l, r, rr, steepness)


VALUE = st.floats(-1e6, 1e6)
#: nothing so small that a product of two is zero
DIFFERENCE = st.just(0.0) | st.floats(1e-100, 1e6) | st.floats(-1e6, -1e-100)


# -------------------------------------------------------------------------------------------------------- limiter


@pytest.mark.parametrize(("a", "b"), [(3.0, 5.0), (5.0, 3.0), (1.0, 3.0)])
def test_where_it_is_smooth_the_difference_is_central(a, b):
    assert limited_difference(a, b) == (a + b) / 2
    assert limited_difference(-a, -b) == -(a + b) / 2


@pytest.mark.parametrize(("a", "b"), [(1.0, 10.0), (10.0, 1.0), (2.0, 3.0), (1.0, 1.0)])
def test_with_a_steepness_of_one_the_difference_is_the_smaller(a, b):
    assert limited_difference(a, b, 1.0) == min(a, b)
    assert limited_difference(-a, -b, 1.0) == -min(a, b)
    assert upwind(True, 1.0, 1.0 + a, 1.0 + a + b, 0.0, 1.0) == (1.0 + a, min(a, b))


@pytest.mark.parametrize(("a", "b"), [(1.0, 10.0), (10.0, 1.0)])
def test_next_to_a_jump_the_difference_is_twice_the_smaller(a, b):
    assert limited_difference(a, b) == 2.0
    assert limited_difference(-a, -b) == -2.0


@pytest.mark.parametrize(("a", "b"), [(1.0, -1.0), (-2.0, 5.0), (0.0, 3.0), (3.0, 0.0), (0.0, -3.0), (-3.0, 0.0), (0.0, 0.0)])
def test_at_an_extremum_there_is_no_difference(a, b):
    assert limited_difference(a, b) == 0.0


@given(DIFFERENCE, DIFFERENCE)
def test_the_difference_is_within_twice_either_and_of_their_sign(a, b):
    limited = limited_difference(a, b)
    assert abs(limited) <= 2.0 * min(abs(a), abs(b))
    assert limited * a >= 0.0
    assert limited * b >= 0.0


@given(DIFFERENCE, DIFFERENCE)
def test_the_difference_does_not_know_left_from_right_or_up_from_down(a, b):
    assert limited_difference(a, b) == limited_difference(b, a) == -limited_difference(-a, -b)


@given(DIFFERENCE, DIFFERENCE, st.floats(0.0, 1e6))
def test_the_difference_does_not_fall_where_a_neighbour_rises(a, b, more):
    assert limited_difference(a, b + more) >= limited_difference(a, b)


@given(st.floats(1e-3, 1e3))
def test_a_straight_line_keeps_its_difference(a):
    assert limited_difference(a, a) == a
    assert limited_difference(-a, -a) == -a


# ---------------------------------------------------------------------------------------------------------- donor


def test_the_left_cell_feeds_a_flow_upwards():
    """On a straight line of 2 per cell; values beyond the receiver do not matter."""
    assert upwind(True, 1.0, 3.0, 5.0, 99.0) == (3.0, 2.0)


def test_the_right_cell_feeds_a_flow_downwards():
    """The difference is that towards the face, against the axis."""
    assert upwind(False, 99.0, 3.0, 5.0, 7.0) == (5.0, -2.0)


def test_a_peak_is_carried_as_it_is():
    assert upwind(True, 1.0, 4.0, 2.0, 0.0) == (4.0, 0.0)
    assert upwind(False, 0.0, 2.0, 4.0, 1.0) == (4.0, 0.0)


@given(VALUE, VALUE, VALUE, VALUE)
def test_the_mirror_image_of_a_flow_carries_the_same(ll, l, r, rr):
    assert upwind(True, ll, l, r, rr) == upwind(False, rr, r, l, ll)


@given(st.booleans(), VALUE, VALUE, VALUE, VALUE, st.floats(0.0, 1.0))
def test_the_value_at_a_face_lies_between_its_cells(up, ll, l, r, rr, part):
    """For any part of the donor that leaves: no new extremum."""
    donor, difference = upwind(up, ll, l, r, rr)
    carried = donor + 0.5 * (1.0 - part) * difference
    assert min(l, r) - 1e-9 <= carried <= max(l, r) + 1e-9


@given(st.booleans(), st.floats(-10.0, 10.0), st.floats(-10.0, 10.0), st.floats(0.0, 1.0))
def test_a_straight_line_is_carried_at_the_middle_of_the_outflow(up, first, slope, part):
    """Cells at -1.5, -0.5, 0.5, 1.5 around the face at 0; the part that leaves extends from it back into the donor."""
    donor, difference = upwind(up, *(first + slope * x for x in (-1.5, -0.5, 0.5, 1.5)))
    middle = -0.5 * part if up else 0.5 * part
    assert donor + 0.5 * (1.0 - part) * difference == pytest.approx(first + slope * middle, abs=1e-12)


# ------------------------------------------------------------------------------------------------- steepness of a front


def steepness_at(up, *densities, steepness=STEEP):
    return advection.steepness_at.py_func(up, *densities, steepness)


@pytest.mark.parametrize(("change", "expected"), [(0.0, 2.0), (0.05, 2.0), (0.175, 1.5), (0.3, 1.0), (4.0, 1.0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_slopes_fall_to_the_smaller_difference_where_a_front_is_not_resolved(change, expected, sign):
    """By the larger of the two changes next to the donor, as a share of its density, wherever it lies."""
    step = sign * 5.0 * change
    for up, densities in ((True, (9e9, 5.0, 5.0 + step, 9e9)), (True, (5.0 + step, 5.0, 5.0, 9e9)),
                          (False, (9e9, 5.0 + step, 5.0, 5.0)), (False, (9e9, 5.0, 5.0, 5.0 + step))):
        known = [5.0 if each == 9e9 else each for each in densities]
        assert steepness_at(up, *known) == pytest.approx(expected)
    assert steepness_at(True, 5.0, 5.0, 5.0 + step, 0.0) == steepness_at(True, 5.0, 5.0, 5.0 + step, 9e9)


def test_a_steepness_of_one_stays():
    assert steepness_at(True, 1.0, 2.0, 2.0, 2.0, steepness=1.0) == steepness_at(True, 2.0, 2.0, 2.0, 2.0, steepness=1.0) == 1.0


def test_nothing_has_a_steepness():
    assert steepness_at(True, 0.0, 0.0, 0.0, 0.0) == 2.0
