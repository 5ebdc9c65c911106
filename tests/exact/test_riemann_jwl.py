"""Products of explosives: Shyue's printed Riemann problem, and the laws on both sides of a contact with metal."""

import numpy as np
import pytest

from problems.verification.exact.impact import AL_5083
from problems.verification.exact.riemann_jwl import PBX9404, burnt, drive, shyue


def test_shyues_problem():
    """As in ExactPack's tests, in Mbar, cm/us and g/cm^3."""
    solution = shyue()
    assert 1e-11 * solution.p == pytest.approx(4.4071017, rel=2e-7)
    assert 1e-4 * solution.u == pytest.approx(1.6952363, rel=2e-7)
    assert [1e-3 * rho for rho in solution.densities] == pytest.approx([0.8880766, 3.7812802], rel=2e-7)
    assert [1e-4 * each for each in solution.wave(solution.left, -1)] == pytest.approx([-2.7363916, -0.8009046], rel=1e-6)
    assert 1e-4 * solution.wave(solution.right, +1)[0] == pytest.approx(2.3047532, rel=1e-6)


def test_the_fan_is_a_simple_wave():
    """Along the rarefaction u + c = x/t on the left of it, with the pressure of the isentrope."""
    solution = shyue()
    xi = np.linspace(-27000.0, -8100.0, 50)
    rho, u, p = solution.sample(xi)
    pressure, c = solution.left.isentrope(rho)
    np.testing.assert_allclose(p, pressure, rtol=1e-6)
    np.testing.assert_allclose(u - c, xi, atol=0.1)


def test_products_drive_aluminium():
    """Pressure and velocity are equal on both sides; mass, momentum and energy are conserved over the whole tube."""
    products = burnt(*PBX9404)
    solution = drive(products, AL_5083)
    assert -products.behind(solution.p)[1] == pytest.approx(solution.u, rel=1e-10)
    x = np.linspace(-8000.0, 8000.0, 800001)
    rho, u, p = solution.sample(x)
    gas = x < solution.u
    e = np.zeros(x.shape)
    e[gas] = [products.products.energy(a, b) for a, b in zip(rho[gas][::1], p[gas], strict=True)]
    heat = AL_5083.gamma0 * AL_5083.rho0
    e[~gas] = [(b - AL_5083.cold(a)) / heat for a, b in zip(rho[~gas], p[~gas], strict=True)]
    start = products.products.energy(products.rho, products.p)
    assert np.trapezoid(rho, x) == pytest.approx(8000.0 * (products.rho + AL_5083.rho0), rel=1e-5)
    assert np.trapezoid(rho * u, x) == pytest.approx(products.p, rel=1e-4)
    assert np.trapezoid(rho * (e + 0.5 * u * u), x) == pytest.approx(8000.0 * products.rho * start, rel=1e-5)
