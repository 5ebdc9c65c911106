"""Cavities in an elastic medium against printed displacements, the equation of motion and the load on the wall."""

import numpy as np
import pytest

from problems.verification.exact.blake import Cavity, cylindrical

CAVITY = Cavity()
#: radius, m, and displacement after 160 us, m, by ExactPack's Blake with its own constants, which are those of `Cavity`
PRINTED = [(0.1, 1.0017698e-06), (0.2, 2.4931792e-07), (0.3, 1.0524476e-07), (0.5, 3.1830905e-08), (0.8, 7.9765787e-08)]


@pytest.mark.parametrize(("r", "displacement"), PRINTED)
def test_printed_displacements(r, displacement):
    assert CAVITY.displacement(r, 160e-6) == pytest.approx(displacement, rel=1e-7)


def test_the_front_and_the_end():
    assert CAVITY.longitudinal == 5000.0
    assert CAVITY.displacement(0.9001, 160e-6) == 0.0 < CAVITY.displacement(0.899, 160e-6)
    static = CAVITY.pressure * CAVITY.radius**3 / (4.0 * CAVITY.shear)
    assert CAVITY.displacement(0.2, 1.0) == pytest.approx(static / 0.2**2, rel=1e-9)


def test_the_equation_of_motion_and_the_load():
    """rho u'' = (lame + 2 G) d/dr(du/dr + 2 u/r), and -p on the wall."""
    r, time, h, tau = np.array([0.13, 0.25, 0.4]), 90e-6, 5e-5, 2e-8
    u = {(i, k): CAVITY.displacement(r + i * h, time + k * tau) for i in (-1, 0, 1) for k in (-1, 0, 1)}
    stiffness = CAVITY.lame + 2.0 * CAVITY.shear
    bend = (u[1, 0] - 2.0 * u[0, 0] + u[-1, 0]) / h**2 + 2.0 / r * (u[1, 0] - u[-1, 0]) / (2 * h) - 2.0 * u[0, 0] / r**2
    second = (u[0, 1] - 2.0 * u[0, 0] + u[0, -1]) / tau**2
    np.testing.assert_allclose(CAVITY.rho * second, stiffness * bend, rtol=1e-3)
    np.testing.assert_allclose((u[0, 1] - u[0, -1]) / (2 * tau), CAVITY.velocity(r, time), rtol=1e-6)
    divergence = (u[1, 0] - u[-1, 0]) / (2 * h) + 2.0 * u[0, 0] / r
    np.testing.assert_allclose(CAVITY.mean_pressure(r, time), -(CAVITY.lame + CAVITY.shear * 2 / 3) * divergence, rtol=1e-4)
    a = CAVITY.radius
    slope = (CAVITY.displacement(a + 1e-7, time) - CAVITY.displacement(a, time)) / 1e-7
    load = stiffness * slope + 2.0 * CAVITY.lame * CAVITY.displacement(a, time) / a
    assert load == pytest.approx(-CAVITY.pressure, rel=1e-3)


def test_the_cylinder():
    """Printed by an independent program, and the static solution p a^2/(2 G r)."""
    printed = np.array([1570.3, 1175.8, 879.5])
    np.testing.assert_allclose(1e9 * cylindrical(CAVITY, [0.15, 0.2, 0.25], 60e-6), printed, rtol=1.5e-4)
    assert cylindrical(CAVITY, [0.2], 0.02)[0] == pytest.approx(1e6 * 0.1**2 / (2.0 * 25e9 * 0.2), rel=1e-4)
    assert cylindrical(CAVITY, [0.42], 60e-6)[0] == 0.0
