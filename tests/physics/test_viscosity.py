"""Artificial viscosity and the limiter that switches it off."""


import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import viscosity
from hydro2d.physics.viscosity import OPEN

smoothness = viscosity.smoothness.py_func
directional_viscosity = viscosity.directional_viscosity.py_func
shut = viscosity.shut.py_func
strongest_compression = viscosity.strongest_compression.py_func
length_along = viscosity.length_along.py_func
linear_in_step = viscosity.linear_in_step.py_func

#: nothing so small that its inverse overflows
SLOPE = st.floats(1e-6, 1e3) | st.floats(-1e3, -1e-6)
#: nothing so small that its square is zero
RATE = st.just(0.0) | SLOPE


# -------------------------------------------------------------------------------------------------------- limiter


def test_between_the_limits_the_mean_of_both_ratios_counts():
    assert smoothness(6.0, 10.0, 8.0) == pytest.approx(0.7)


# ------------------------------------------------------------------------------------------------------ viscosity


@pytest.mark.parametrize(("courant", "expected"), [(0.0, 0.5), (0.3, 0.5), (0.5, 0.5), (0.6, 0.325), (0.7, 0.26 / 1.4),
                                                   (0.9, 0.0)])
def test_a_step_carries_so_much_linear_viscosity(courant, expected):
    """courant^2 + 2 linear courant is no more than it is with 0.5 and 0.5; a deck with less keeps that."""
    assert linear_in_step(0.5, courant) == pytest.approx(expected)
    assert linear_in_step(0.1, courant) == pytest.approx(min(0.1, expected))


def test_the_linear_part_can_be_the_pressure_of_a_weak_wave():
    assert directional_viscosity(1000.0, 1500.0, -0.01, 0.0, 1.0, 0.0) == pytest.approx(15e3)


# ------------------------------------------------------------------------------------------------------ with void


def test_a_cell_has_the_more_viscosity_the_less_void_it_has():
    assert shut(1.0) == 1.0
    assert shut(0.5 * (1.0 + OPEN)) == pytest.approx(0.5)
    assert shut(OPEN) == shut(0.5) == shut(0.0) == 0.0
    assert shut(1.0 + 1e-15) == 1.0  # round-off in a sum of fractions


# -------------------------------------------------------------------------------- the direction of the strongest compression


@given(RATE, RATE, RATE)
def test_no_direction_is_compressed_more(rr, zz, rz):
    rate, n_r, n_z = strongest_compression(rr, zz, rz)
    size = abs(rr) + abs(zz) + abs(rz)
    assert rate <= min(rr, zz) + 1e-12 * size
    assert n_r * n_r * rr + n_z * n_z * zz + 2.0 * n_r * n_z * rz == pytest.approx(rate, abs=1e-7 * size + 1e-12)


def test_the_length_along_a_side_does_not_see_the_other_side():
    assert length_along(0.0, 1.0, 7.0, 0.5) == pytest.approx(0.5, rel=1e-15)
    assert length_along(1.0, 0.0, 7.0, 0.5) == pytest.approx(7.0, rel=1e-15)
    assert length_along(0.6, -0.8, 2.0, 2.0) == pytest.approx(2.0)
