"""Artificial viscosity and the limiter that switches it off."""

from math import cos, hypot, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import viscosity
from hydro2d.physics.viscosity import OPEN
from tests.physics.continuity import changes_in_proportion, largest_jump

smoothness = viscosity.smoothness.py_func
directional_viscosity = viscosity.directional_viscosity.py_func
shut = viscosity.shut.py_func
strongest_compression = viscosity.strongest_compression.py_func
length_along = viscosity.length_along.py_func
linear_in_step = viscosity.linear_in_step.py_func

DIFFERENCE = st.floats(-1e3, 1e3)
#: nothing so small that its inverse overflows
SLOPE = st.floats(1e-6, 1e3) | st.floats(-1e3, -1e-6)
#: nothing so small that its square is zero
RATE = st.just(0.0) | SLOPE


# -------------------------------------------------------------------------------------------------------- limiter


@pytest.mark.parametrize("slopes", [(-3.0, -3.0, -3.0), (1.0, 2.0, 3.0), (3.0, 2.0, 1.0), (5.0, 4.0, 6.0)])
def test_a_smooth_slope_is_smooth(slopes):
    """Linear and parabolic velocities, and those steeper on both sides."""
    assert smoothness(*slopes) == 1.0


@pytest.mark.parametrize("slopes", [(-1.0, 2.0, 2.0), (2.0, 2.0, -1.0), (-1.0, 2.0, -1.0), (1.0, -2.0, 1.0)])
def test_a_slope_that_turns_is_not_smooth(slopes):
    assert smoothness(*slopes) == 0.0


@pytest.mark.parametrize("slopes", [(0.0, 2.0, 2.0), (2.0, 2.0, 0.0), (0.0, 2.0, 0.0), (2.0, 0.0, 2.0), (-2.0, 0.0, -2.0)])
def test_next_to_a_zero_slope_nothing_is_smooth(slopes):
    """The foot of a shock and its head: one side is level."""
    assert smoothness(*slopes) == 0.0


def test_between_the_limits_the_mean_of_both_ratios_counts():
    assert smoothness(6.0, 10.0, 8.0) == pytest.approx(0.7)


def test_a_foot_counts_by_twice_its_ratio():
    """Ratios 0.2 and 0.9: their mean would be 0.55."""
    assert smoothness(2.0, 10.0, 9.0) == pytest.approx(0.4)
    assert smoothness(9.0, 10.0, 2.0) == pytest.approx(0.4)


@given(DIFFERENCE, SLOPE, DIFFERENCE)
def test_smoothness_is_between_none_and_all(left, centre, right):
    assert 0.0 <= smoothness(left, centre, right) <= 1.0


@given(DIFFERENCE, SLOPE, DIFFERENCE)
def test_smoothness_is_the_same_seen_from_either_side(left, centre, right):
    assert smoothness(left, centre, right) == smoothness(right, centre, left)


@given(DIFFERENCE, SLOPE, DIFFERENCE, SLOPE)
def test_smoothness_does_not_know_the_unit_or_the_sign_of_the_velocity(left, centre, right, scale):
    psi = smoothness(scale * left, scale * centre, scale * right)
    assert psi == pytest.approx(smoothness(left, centre, right), abs=1e-12)


@given(DIFFERENCE, SLOPE, DIFFERENCE, st.floats(0.0, 1e3))
def test_a_steeper_neighbour_does_not_make_a_slope_less_smooth(left, centre, right, more):
    steeper = right + more if centre > 0.0 else right - more
    assert smoothness(left, centre, steeper) >= smoothness(left, centre, right)


# ------------------------------------------------------------------------------------------------------ viscosity


@pytest.mark.parametrize("du", [0.0, 1e-9, 300.0])
def test_expansion_has_no_viscosity(du):
    assert directional_viscosity(8000.0, 5000.0, du, 0.0, 0.5, 1.3) == 0.0


@given(st.floats(1.0, 2e4), st.floats(0.0, 1e4), st.floats(-5e3, 5e3), st.floats(0.0, 1.0))
def test_viscosity_never_pulls(rho, c, du, psi):
    assert directional_viscosity(rho, c, du, psi, 0.5, 1.3) >= 0.0


def test_the_quadratic_part_can_be_the_pressure_of_a_strong_shock():
    """A strong shock in a gas runs at (gamma + 1)/2 times the velocity behind it: p = rho u_s u_p."""
    gamma, rho, u_p = 5.0 / 3.0, 1.2, 3000.0
    u_s = 0.5 * (gamma + 1.0) * u_p
    assert directional_viscosity(rho, 340.0, -u_p, 0.0, 0.0, u_s / u_p) == pytest.approx(rho * u_s * u_p)


@pytest.mark.parametrize(("courant", "expected"), [(0.0, 0.5), (0.3, 0.5), (0.5, 0.5), (0.6, 0.325), (0.7, 0.26 / 1.4),
                                                   (0.9, 0.0)])
def test_a_step_carries_so_much_linear_viscosity(courant, expected):
    """courant^2 + 2 linear courant is no more than it is with 0.5 and 0.5; a deck with less keeps that."""
    assert linear_in_step(0.5, courant) == pytest.approx(expected)
    assert linear_in_step(0.1, courant) == pytest.approx(min(0.1, expected))


def test_the_linear_part_can_be_the_pressure_of_a_weak_wave():
    assert directional_viscosity(1000.0, 1500.0, -0.01, 0.0, 1.0, 0.0) == pytest.approx(15e3)


def test_four_times_the_jump_is_sixteen_times_the_quadratic_part_and_four_times_the_linear_one():
    quadratic, linear = (0.0, 1.3), (0.5, 0.0)
    for parts, factor in ((quadratic, 16.0), (linear, 4.0)):
        small, large = (directional_viscosity(8000.0, 5000.0, du, 0.0, *parts) for du in (-25.0, -100.0))
        assert large == pytest.approx(factor * small)


def test_both_parts_add_up():
    both = directional_viscosity(8000.0, 5000.0, -100.0, 0.0, 0.5, 1.3)
    assert both == pytest.approx(2.0e9 + 1.04e8)


def test_smoothness_takes_its_share_of_the_viscosity():
    full, most, none = (directional_viscosity(8000.0, 5000.0, -100.0, psi, 0.5, 1.3) for psi in (0.0, 0.25, 1.0))
    assert most == pytest.approx(0.75 * full)
    assert none == 0.0


# ------------------------------------------------------------------------------------------------------ with void


def test_a_cell_has_the_more_viscosity_the_less_void_it_has():
    assert shut(1.0) == 1.0
    assert shut(0.5 * (1.0 + OPEN)) == pytest.approx(0.5)
    assert shut(OPEN) == shut(0.5) == shut(0.0) == 0.0
    assert shut(1.0 + 1e-15) == 1.0  # round-off in a sum of fractions


def test_viscosity_does_not_jump_as_void_shuts():
    for solids in (OPEN, 1.0):
        changes_in_proportion(shut, solids, 1.5 / (1.0 - OPEN))
    assert largest_jump(shut, 0.5, 1.0) < 1e-11


# -------------------------------------------------------------------------------- the direction of the strongest compression


@pytest.mark.parametrize("turn", [0.0, 0.3, pi / 4, 1.2, pi / 2, 2.0, 3.0])
def test_a_plane_compression_is_found_in_its_own_direction(turn):
    """A rate of -2/s along n and 1/s across: D = -2 n n + 1 t t."""
    r, z = sin(turn), cos(turn)
    rate, n_r, n_z = strongest_compression(-2.0 * r * r + z * z, -2.0 * z * z + r * r, -3.0 * r * z)
    sign = 1.0 if r * n_r + z * n_z > 0.0 else -1.0
    assert rate == pytest.approx(-2.0)
    assert (n_r, n_z) == pytest.approx((sign * r, sign * z), abs=1e-7)


@pytest.mark.parametrize(("rr", "zz", "expected"), [
    (0.0, -3.0, (-3.0, 0.0, 1.0)), (-3.0, 0.0, (-3.0, 1.0, 0.0)), (2.0, -1.0, (-1.0, 0.0, 1.0)), (-5.0, -1.0, (-5.0, 1.0, 0.0)),
])
def test_without_shear_it_is_a_direction_of_the_mesh_to_the_last_bit(rr, zz, expected):
    assert strongest_compression(rr, zz, 0.0) == expected


def test_uniform_compression_has_a_direction():
    rate, n_r, n_z = strongest_compression(-1.0, -1.0, 0.0)
    assert rate == -1.0
    assert hypot(n_r, n_z) == pytest.approx(1.0)


@given(RATE, RATE, RATE)
def test_the_mirror_image_has_the_mirrored_direction(rr, zz, rz):
    rate, n_r, n_z = strongest_compression(rr, zz, rz)
    other, m_r, m_z = strongest_compression(rr, zz, -rz)
    assert (other, m_r, abs(m_z)) == (rate, n_r, abs(n_z))
    assert rz == 0.0 or n_z == 0.0 or m_z == -n_z


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
