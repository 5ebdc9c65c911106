"""Velocity gradient, hourglass mode and rate of volume of a cell."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import kinematics
from tests.physics.cells import COLUMNS, GEOMETRIES, ROWS, rate_of_volume, small

velocity_gradient = kinematics.velocity_gradient.py_func
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


def test_a_rigid_rotation_in_the_plane_strains_nothing():
    g = small("planar")
    r, z = np.meshgrid(g.r, g.z)
    for j, i in CELLS:
        rr, tt, zz, r_by_z, z_by_r = gradient_of(g, j, i, 7.0 * z, -7.0 * r)
        assert (rr, tt, zz) == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)
        assert r_by_z == pytest.approx(7.0 * g.volume[j, i])
        assert r_by_z + z_by_r == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_divergence_is_the_rate_at_which_the_polygon_of_the_vertices_grows(geometry):
    g = small(geometry)
    u, v = random_velocity(g, 4)
    for j, i in CELLS:
        growth = rate_of_volume(g, j, i, u, v) / g.volume[j, i]
        assert scalar_of(divergence, g, j, i, u, v) == pytest.approx(growth, rel=1e-6)


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
