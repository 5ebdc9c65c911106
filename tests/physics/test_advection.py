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


@given(DIFFERENCE, DIFFERENCE)
def test_the_difference_is_within_twice_either_and_of_their_sign(a, b):
    limited = limited_difference(a, b)
    assert abs(limited) <= 2.0 * min(abs(a), abs(b))
    assert limited * a >= 0.0
    assert limited * b >= 0.0


# ---------------------------------------------------------------------------------------------------------- donor


@given(VALUE, VALUE, VALUE, VALUE)
def test_the_mirror_image_of_a_flow_carries_the_same(ll, l, r, rr):
    assert upwind(True, ll, l, r, rr) == upwind(False, rr, r, l, ll)


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
