"""What crosses the faces of dual cells, and the three velocities that a sweep can leave."""

import math

import numpy as np
import pytest

from hydro2d.physics import momentum
from tests.physics.continuity import changes_in_proportion


def test_dual_masses_stay_corner_sums_of_cells():
    """A row of cells gives mass to its neighbours: corner sums of the fluxes change those of the masses as the cells change."""
    random = np.random.default_rng(1)
    inner, outer = 0.2, 0.3  # shares of a corner, twice their sum is 1
    mass, flux = random.uniform(1.0, 2.0, (2, 4)), random.uniform(-0.1, 0.1, (2, 5))
    after = mass + flux[:, :-1] - flux[:, 1:]

    def at(values, i):
        return momentum.corner_sum(inner, outer, values[0, i - 1], values[1, i - 1], values[0, i], values[1, i])

    for i in range(1, 4):  # the dual face in the column i - 1, between the vertices i - 1 and i, has the faces i - 1 and i
        crossing = [outer * flux[:, k].sum() + inner * flux[:, k + 1].sum() for k in (i - 1, i)]
        assert at(after, i) == pytest.approx(at(mass, i) + crossing[0] - crossing[1], rel=1e-14)


def test_cells_get_by_their_corner_means_what_the_vertices_of_a_periodic_row_give():
    """The sum over cells of mass times corner mean is the sum over vertices of dual mass times value."""
    random = np.random.default_rng(2)
    inner, outer = 0.2, 0.3
    mass, value = random.uniform(1.0, 2.0, (2, 5)), random.uniform(-1.0, 1.0, (2, 5))  # both rows and the columns are periodic
    got = sum(mass[j, i] * momentum.corner_mean(inner, outer, value[j, i], value[1 - j, i], value[j, (i + 1) % 5],
                                                value[1 - j, (i + 1) % 5]) for j in range(2) for i in range(5))
    given = sum(value[j, i] * momentum.corner_sum(inner, outer, mass[j, i - 1], mass[1 - j, i - 1], mass[j, i], mass[1 - j, i])
                for j in range(2) for i in range(5))
    assert got == pytest.approx(given, rel=1e-13)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_slope_weight_is_half_of_what_stays(sign):
    assert momentum.slope_weight(sign * 0.5, 2.0, 2.0, 2.0, 2.0) == pytest.approx(0.5 * (1.0 - 0.25))
    assert momentum.slope_weight(sign * 3.0, 2.0, 2.0, 2.0, 2.0) == 0.0
    assert momentum.slope_weight(0.5, 0.0, 2.0, 2.0, 2.0) == 0.0, "behind the donor there is nothing"
    assert momentum.slope_weight(-0.5, 0.0, 2.0, 2.0, 2.0) > 0.0, "that vertex lies ahead of the flow"
    changes_in_proportion(lambda behind: momentum.slope_weight(0.5, behind, 2.0, 2.0, 2.0), 2.0 * momentum.SLIGHT, 1e5)


def test_a_linear_velocity_is_carried_at_the_middle_of_what_leaves():
    """Of the donor's mass a half leaves: the middle of that half lies a quarter of a spacing from the face."""
    weight = momentum.slope_weight(1.0, 2.0, 2.0, 2.0, 2.0)
    assert momentum.carried(1.0, weight, 0.0, 1.0, 2.0, 3.0, 2.0) == pytest.approx(1.25)
    assert momentum.carried(-1.0, weight, 0.0, 1.0, 2.0, 3.0, 2.0) == pytest.approx(-1.75)


def test_the_three_velocities_of_two_parcels_that_merge():
    """Momentum is kept by one, kinetic energy by the other, and what the first misses is the energy of the collision."""
    m_1, m_2, u_1, u_2 = 1.0, 3.0, 2.0, -4.0
    mass, p, kinetic = m_1 + m_2, m_1 * u_1 + m_2 * u_2, 0.5 * (m_1 * u_1**2 + m_2 * u_2**2)
    mean = momentum.velocity_of_momentum(p, 1.0 / mass, u_1, u_2, u_2)
    assert mean * mass == pytest.approx(p)
    of_energy = momentum.velocity_of_energy(kinetic, 1.0 / mass, 10.0, mean)
    assert of_energy == pytest.approx(-math.sqrt(2.0 * kinetic / mass))
    missing = 0.5 * m_1 * m_2 / mass * (u_1 - u_2) ** 2
    assert momentum.energy_missing(kinetic, mass, mean) == pytest.approx(missing)
    assert momentum.energy_missing(kinetic, mass, of_energy) == pytest.approx(0.0, abs=1e-14)


def test_the_bounds_of_the_velocities():
    assert momentum.velocity_of_energy(8.0, 1.0, 1.5, 2.0) == 3.0, "no more than ke_bound times P/M"
    assert momentum.velocity_of_energy(8.0, 1.0, 1.5, 0.0) == 0.0
    assert momentum.velocity_of_momentum(5.0, 1.0, 1.0, 2.0, -3.0) == 2.0
    assert momentum.velocity_of_momentum(-5.0, 1.0, 1.0, 2.0, -3.0) == -3.0
