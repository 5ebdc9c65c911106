"""Sedov's blast against printed energies, the conservation of energy and mass, and the equations that it solves."""

import numpy as np
import pytest

from problems.verification.exact.sedov import SURFACE, Sedov

#: the energy that takes the shock to R = 1 at t = 1, and the pressure at the centre over that behind the shock, by an
#: independent integration that agrees with ExactPack to six digits
PRINTED = [(3, 1.4, 0.851072, 0.36546), (2, 1.4, 0.984074, 0.37292), (1, 1.4, 1.077486, 0.39002), (3, 5 / 3, 0.493590, 0.30620),
           (2, 5 / 3, 0.564283, 0.32150), (1, 5 / 3, 0.602935, 0.35320)]


@pytest.mark.parametrize(("j", "gamma", "alpha", "centre"), PRINTED)
def test_printed_energies(j, gamma, alpha, centre):
    blast = Sedov(j, gamma, alpha)
    assert blast.alpha == pytest.approx(alpha, abs=1e-6)
    assert blast.radius(1.0) == pytest.approx(1.0, abs=1e-6)
    assert blast.central_pressure(1.0) / blast.behind(1.0)[2] == pytest.approx(centre, abs=1e-5)


def test_kamm_and_timmes_end_times():
    """The problems of LA-UR-07-2849 have the shock at 0.5, 0.75 and 1.0 after 1 s; the planar energy is that of one side.

    Their energies come from an earlier quadrature and are good to four digits.
    """
    for j, energy, radius in ((1, 2.0 * 0.0673185, 0.5), (2, 0.311357, 0.75), (3, 0.851072, 1.0)):
        assert Sedov(j, 1.4, energy).radius(1.0) == pytest.approx(radius, rel=2e-4)


@pytest.mark.parametrize("j", [1, 2, 3])
def test_mass_energy_and_the_jump(j):
    blast = Sedov(j, 1.4, 2.0, 3.0)
    time, radius = 0.7, blast.radius(0.7)
    r = radius * np.linspace(0.0, 1.0, 200001)[1:-1]
    rho, u, p = blast.sample(r, time)
    shell = SURFACE[j] * r ** (j - 1)
    assert np.trapezoid(shell * rho, r) == pytest.approx(3.0 * SURFACE[j] * radius**j / j, rel=1e-4)
    assert np.trapezoid(shell * (0.5 * rho * u * u + p / 0.4), r) == pytest.approx(2.0, rel=1e-4)
    assert (rho[-1], u[-1], p[-1]) == pytest.approx(blast.behind(time), rel=1e-3)
    assert blast.time(radius) == pytest.approx(time, rel=1e-12)


@pytest.mark.thorough
def test_particles_keep_their_entropy():
    """Along a path dr/dt = u the ratio p/rho^gamma is constant."""
    blast, r, time, step = Sedov(), 0.6, 1.0, 1e-4
    ratios = []
    for _ in range(2000):
        rho, u, p = (float(each[0]) for each in blast.sample(np.array([r]), time))
        ratios.append(p / rho**1.4)
        half = float(blast.sample(np.array([r + 0.5 * step * u]), time + 0.5 * step)[1][0])
        r, time = r + step * half, time + step
    assert ratios[-1] == pytest.approx(ratios[0], rel=2e-4)


def test_a_gas_without_a_standard_solution_is_refused():
    with pytest.raises(ValueError, match="no standard solution"):
        Sedov(3, 8.0).alpha  # noqa: B018
