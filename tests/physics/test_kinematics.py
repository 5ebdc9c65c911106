"""Velocity gradient, hourglass mode and rate of volume of a cell."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import kinematics
from tests.physics.cells import COLUMNS, GEOMETRIES, ROWS, rate_of_volume, small

velocity_gradient = kinematics.velocity_gradient.py_func
hourglass_mode = kinematics.hourglass_mode.py_func
divergence = kinematics.divergence.py_func

RATE = st.floats(-1e3, 1e3)
CELLS = [(j, i) for j in ROWS for i in COLUMNS]


def gradient_of(g, j, i, u, v):
    return velocity_gradient(i, u[j], u[j + 1], v[j], v[j + 1], g.metrics, g.dz[j])


def scalar_of(function, g, j, i, u, v):
    return function(i, u[j], u[j + 1], v[j], v[j + 1], g.metrics, g.dz[j])


def random_velocity(g, seed):
    return np.random.default_rng(seed).normal(size=(2, *g.vertex_shape))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@given(a=RATE, b=RATE, c=RATE, d=RATE)
def test_a_linear_velocity_has_its_gradient_times_the_volume(geometry, a, b, c, d):
    """u = a r + b z, v = c r + d z; the hoop rate is the integral of u over the section of the cell."""
    g = small(geometry)
    r, z = np.meshgrid(g.r, g.z)
    u, v = a * r + b * z, c * r + d * z
    for j, i in CELLS:
        volume, section = g.volume[j, i], g.dr[i] * g.dz[j]
        hoop = section * (a * g.rc[i] + b * g.zc[j]) if g.cylindrical else 0.0
        expected = (a * volume, hoop, d * volume, b * volume, c * volume)
        np.testing.assert_allclose(gradient_of(g, j, i, u, v), expected, rtol=1e-12, atol=1e-13)


def quadrature(grid, j, i, u, v):
    """Integrals of the gradient of the bilinear velocity over a cell, per radian: D_rr, D_tt, D_zz, du/dz, dv/dr."""
    points, weights = np.polynomial.legendre.leggauss(4)
    r1, dr, dz = grid.r[i], grid.dr[i], grid.dz[j]
    total = np.zeros(5)
    for x, wx in zip(0.5 + 0.5 * points, 0.5 * weights, strict=True):
        for y, wy in zip(0.5 + 0.5 * points, 0.5 * weights, strict=True):
            r = r1 + x * dr
            a, b = ((w[j:j + 2, i:i + 2]) for w in (u, v))
            at = a[0, 0] * (1 - x) * (1 - y) + a[0, 1] * x * (1 - y) + a[1, 0] * (1 - x) * y + a[1, 1] * x * y
            by_r = [((w[0, 1] - w[0, 0]) * (1 - y) + (w[1, 1] - w[1, 0]) * y) / dr for w in (a, b)]
            by_z = [((w[1, 0] - w[0, 0]) * (1 - x) + (w[1, 1] - w[0, 1]) * x) / dz for w in (a, b)]
            weight = wx * wy * dr * dz * (r if grid.cylindrical else 1.0)
            total += weight * np.array([by_r[0], at / r if grid.cylindrical else 0.0, by_z[1], by_z[0], by_r[1]])
    return total


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_gradient_is_the_integral_of_that_of_the_bilinear_velocity(geometry):
    g = small(geometry)
    u, v = random_velocity(g, 1)
    if geometry == "cylindrical":
        u[:, g.g] = 0.0
    for j, i in CELLS:
        np.testing.assert_allclose(gradient_of(g, j, i, u, v), quadrature(g, j, i, u, v), rtol=1e-12, atol=1e-15)


def test_a_rigid_rotation_in_the_plane_strains_nothing():
    g = small("planar")
    r, z = np.meshgrid(g.r, g.z)
    for j, i in CELLS:
        rr, tt, zz, r_by_z, z_by_r = gradient_of(g, j, i, 7.0 * z, -7.0 * r)
        assert (rr, tt, zz) == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)
        assert r_by_z == pytest.approx(7.0 * g.volume[j, i])
        assert r_by_z + z_by_r == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_motion_along_the_axis_as_a_whole_strains_nothing(geometry):
    g = small(geometry)
    still, moving = np.zeros(g.vertex_shape), np.full(g.vertex_shape, 1000.0)
    for j, i in CELLS:
        assert gradient_of(g, j, i, still, moving) == (0.0, 0.0, 0.0, 0.0, 0.0)


def test_a_radial_velocity_that_is_uniform_has_hoop_strain_alone():
    """du/dr = 0, and u/r has the mean u dr h/V."""
    g = small("cylindrical")
    for j, i in CELLS:
        rr, tt, zz, r_by_z, z_by_r = gradient_of(g, j, i, np.ones(g.vertex_shape), np.zeros(g.vertex_shape))
        assert (rr, zz, r_by_z, z_by_r) == pytest.approx((0.0, 0.0, 0.0, 0.0), abs=1e-16)
        assert tt / g.volume[j, i] == pytest.approx(1.0 / g.rc[i])


def test_a_planar_gradient_does_not_see_the_hourglass():
    g = small("planar")
    pattern = (-1.0) ** np.add.outer(np.arange(g.vertex_shape[0]), np.arange(g.vertex_shape[1]))
    for j, i in CELLS:
        np.testing.assert_allclose(gradient_of(g, j, i, pattern, pattern), 0.0, atol=1e-16)


@given(a=RATE, b=RATE, c=RATE)
def test_a_linear_field_has_no_hourglass_mode(a, b, c):
    g = small("cylindrical")
    r, z = np.meshgrid(g.r, g.z)
    w = a + b * r + c * z
    for j, i in CELLS:
        assert hourglass_mode(i, w[j], w[j + 1]) == pytest.approx(0.0, abs=1e-12)


def test_the_hourglass_pattern_is_four_amplitudes():
    """+ - + - from the inner bottom vertex around the cell."""
    below, above = np.array([np.nan, 1.5, -1.5]), np.array([np.nan, -1.5, 1.5])
    assert hourglass_mode(1, below, above) == 6.0
    assert hourglass_mode(1, above, below) == -6.0


def test_the_hourglass_of_a_bilinear_field_is_its_coefficient_times_the_section():
    g = small("planar")
    w = np.multiply.outer(g.z - 0.3, g.r + 0.4)
    for j, i in CELLS:
        assert hourglass_mode(i, w[j], w[j + 1]) == pytest.approx(g.dr[i] * g.dz[j], rel=1e-12)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_divergence_is_how_fast_the_cell_grows(geometry):
    g = small(geometry)
    u, v = random_velocity(g, 2)
    for j, i in CELLS:
        growth = rate_of_volume(g, j, i, u, v) / g.volume[j, i]
        assert scalar_of(divergence, g, j, i, u, v) == pytest.approx(growth, rel=1e-6)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_divergence_is_the_sum_of_the_normal_rates(geometry):
    g = small(geometry)
    u, v = random_velocity(g, 3)
    for j, i in CELLS:
        normal = sum(gradient_of(g, j, i, u, v)[:3])
        assert g.volume[j, i] * scalar_of(divergence, g, j, i, u, v) == pytest.approx(normal, rel=1e-12)


@pytest.mark.parametrize(("geometry", "directions"), [("cylindrical", 3), ("planar", 2)])
def test_contraction_towards_the_origin_takes_volume_in_every_direction(geometry, directions):
    g = small(geometry)
    r, z = np.meshgrid(g.r, g.z)
    for j, i in CELLS:
        assert scalar_of(divergence, g, j, i, -5.0 * r, -5.0 * z) == pytest.approx(-5.0 * directions)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_divergence_is_the_rate_at_which_the_polygon_of_the_vertices_grows(geometry):
    g = small(geometry)
    u, v = random_velocity(g, 4)
    for j, i in CELLS:
        growth = rate_of_volume(g, j, i, u, v) / g.volume[j, i]
        assert scalar_of(divergence, g, j, i, u, v) == pytest.approx(growth, rel=1e-6)


@pytest.mark.parametrize(("geometry", "sideways"), [("cylindrical", 0.5), ("planar", 1.0)])
def test_radial_growth_that_balances_axial_shortening_keeps_the_volume(geometry, sideways):
    g = small(geometry)
    r, z = np.meshgrid(g.r, g.z)
    for j, i in CELLS:
        assert scalar_of(divergence, g, j, i, sideways * r, -z) == pytest.approx(0.0, abs=1e-14)


alternating_mode = kinematics.alternating_mode.py_func


def velocities(modes) -> np.ndarray:
    """Velocities of vertices whose cells have these hourglass modes, m/s."""
    rows, columns = np.shape(modes)
    w = np.zeros((rows + 1, columns + 1))
    w[1:, 1:] = np.cumsum(np.cumsum(modes, axis=0), axis=1)
    return w


def test_what_alternates_is_half_the_excess_over_the_neighbours():
    modes, mass = np.zeros((3, 3)), np.ones((3, 3))
    modes[1] = 2.0, 6.0, 4.0
    modes[[0, 2], 1] = 1.0, -3.0
    assert alternating_mode(1, 1, velocities(modes), mass) == 0.5 * (6.0 - 1.0)
    modes[1, 1] = -6.0
    assert alternating_mode(1, 1, velocities(modes), mass) == 0.5 * (-6.0 - 1.0)
    modes[1, 1] = 0.5  # below its neighbours, but with their sign
    assert alternating_mode(1, 1, velocities(modes), mass) == 0.0


def test_what_alternates_is_never_more_than_the_mode():
    modes = np.full((3, 3), -30.0)
    modes[1, 1] = 6.0
    assert alternating_mode(1, 1, velocities(modes), np.ones((3, 3))) == 6.0


def test_a_neighbour_counts_by_its_mass_up_to_that_of_the_cell():
    modes, mass = np.full((3, 3), 6.0), np.ones((3, 3))
    modes[1, 2], mass[1, 2] = -18.0, 100.0
    assert alternating_mode(1, 1, velocities(modes), mass) == 0.5 * (6.0 - 0.0)
    mass[1, 2] = 0.5
    assert alternating_mode(1, 1, velocities(modes), mass) == pytest.approx(0.5 * (6.0 - 9.0 / 3.5))
    mass[1, 2] = 0.0
    assert alternating_mode(1, 1, velocities(modes), mass) == 0.0
    mass[...] = 0.0
    mass[1, 1] = 1.0  # a cell by itself has the whole filter
    assert alternating_mode(1, 1, velocities(modes), mass) == 6.0
