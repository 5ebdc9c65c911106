"""Forces of cells on their corners do the work of the stress, to round-off, and their sums by vertex are those by cell."""

import numpy as np
import pytest

from hydro2d.mesh.grid import Grid
from hydro2d.physics import corner as corners
from hydro2d.physics.kinematics import velocity_gradient

R, Z = [0.0, 0.3, 0.5, 0.9, 1.0], [-0.2, 0.1, 0.5, 0.6]
#: corners of a cell by (outer, upper), in the order of the vertices 0 to 3
CORNERS = ((False, False), (True, False), (True, True), (False, True))
GEOMETRIES = pytest.mark.parametrize("geometry", ["cylindrical", "planar"])


def scene(geometry, seed):
    """A mesh with random velocities u, v [j, i], stresses rr, zz, tt, rz [k, j, i] and filters kappa [j, i]."""
    grid, random = Grid(R, Z, geometry), np.random.default_rng(seed)
    nodes, cells = (len(grid.z), len(grid.r)), grid.volume.shape
    u, v = random.normal(size=(2, *nodes))
    return grid, u, v, random.normal(size=(4, *cells)), random.uniform(1.0, 2.0, cells)


@GEOMETRIES
@pytest.mark.parametrize("seed", range(3))
def test_the_work_of_the_forces_is_minus_that_of_the_stress(geometry, seed):
    grid, u, v, (rr, zz, tt, rz), _ = scene(geometry, seed)
    for j in range(2, 5):
        for i in range(2, 6):
            h, given = grid.dz[j], (rr[j, i], zz[j, i], tt[j, i], rz[j, i])
            rates = velocity_gradient(i, u[j], u[j + 1], v[j], v[j + 1], grid.metrics, h)
            power = given[0] * rates[0] + given[2] * rates[1] + given[1] * rates[2] + given[3] * (rates[3] + rates[4])
            done, size = 0.0, 0.0
            for outer, upper in CORNERS:
                f_r, f_z = corners.corner_force(*given, *corners.corner(i, outer, upper, grid.metrics, h))
                at = j + upper, i + outer
                done += f_r * u[at] + f_z * v[at]
                size += abs(f_r * u[at]) + abs(f_z * v[at])
            assert done == pytest.approx(-power, abs=1e-14 * size)
            assert corners.stress_power(*(given[k] for k in (0, 2, 1, 3)), rates, rates) == pytest.approx(
                2.0 * power, abs=1e-13 * size)


@GEOMETRIES
@pytest.mark.parametrize("seed", range(3))
def test_sums_over_the_cells_around_a_vertex_are_those_of_their_corners(geometry, seed):
    grid, u, v, (rr, zz, tt, rz), kappa = scene(geometry, seed)
    for j in range(3, 5):
        for i in range(3, 6):
            radial = corners.radial_force(j, i, rr, tt, rz, grid.metrics, grid.dz)
            axial = corners.axial_force(j, i, zz, rz, grid.metrics, grid.dz)
            filtered = corners.hourglass_force(j, i, kappa)
            force, hourglass = np.zeros(2), 0.0
            for row, column in ((j - 1, i - 1), (j - 1, i), (j, i - 1), (j, i)):
                outer, upper = column < i, row < j
                vectors = corners.corner(column, outer, upper, grid.metrics, grid.dz[row])
                at = row, column
                force += corners.corner_force(rr[at], zz[at], tt[at], rz[at], *vectors)
                sign = 1.0 if outer == upper else -1.0
                hourglass -= sign * kappa[at]
            assert (radial, axial) == pytest.approx(tuple(force), rel=1e-13)
            assert filtered == pytest.approx(hourglass, rel=1e-13)


@pytest.mark.parametrize("seed", range(3))
def test_a_mirror_image_has_the_same_forces_to_the_last_bit(seed):
    grid, u, v, (rr, zz, tt, rz), kappa = scene("cylindrical", seed)
    rr, zz, tt, rz, kappa, back = rr[3:5], zz[3:5], tt[3:5], rz[3:5], kappa[3:5], slice(None, None, -1)
    dz = np.array([0.3, 0.4])
    for i in range(3, 6):
        there = corners.radial_force(1, i, rr, tt, rz, grid.metrics, dz)
        assert there == corners.radial_force(1, i, rr[back], tt[back], -rz[back], grid.metrics, dz[back])
        there = corners.axial_force(1, i, zz, rz, grid.metrics, dz)
        assert there == -corners.axial_force(1, i, zz[back], -rz[back], grid.metrics, dz[back])
        assert corners.hourglass_force(1, i, kappa) == corners.hourglass_force(1, i, -kappa[back])


@pytest.mark.parametrize("seed", range(3))
def test_the_filter_takes_its_push_times_the_mode(seed):
    """Its forces on the four corners of a cell, over its mean velocities."""
    grid, u, v, _, kappa = scene("cylindrical", seed)
    after_u, after_v, *_ = scene("cylindrical", seed + 10)[1:]
    j, i = 3, 4
    push_r, push_z = kappa[j, i], -0.3 * kappa[j, i]
    taken = 0.0
    for (outer, upper), sign in zip(CORNERS, (1.0, -1.0, 1.0, -1.0), strict=True):
        at = j + upper, i + outer
        taken += sign * (push_r * 0.5 * (u[at] + after_u[at]) + push_z * 0.5 * (v[at] + after_v[at]))
    power = corners.filter_power(i, push_r, push_z, u[j], u[j + 1], v[j], v[j + 1], after_u[j], after_u[j + 1], after_v[j],
                                 after_v[j + 1])
    assert 0.5 * power == pytest.approx(taken, rel=1e-13)
