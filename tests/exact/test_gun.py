"""The gun against an integration of the motion of its projectile, and its gas against the conservation laws."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from problems.verification.exact.gun import Gun

GUN = Gun(70.0, 50e6, 1.4, 139.25)


def test_by_integration():
    """m du/dt = p, with the pressure of a simple wave."""
    end = solve_ivp(lambda t, y: [y[1], GUN.pressure(y[1]) / GUN.mass], (0.0, 2e-3), [0.0, 0.0], rtol=1e-11, atol=1e-11)
    assert GUN.velocity(2e-3) == pytest.approx(end.y[1, -1], rel=1e-8)
    assert GUN.position(2e-3) == pytest.approx(end.y[0, -1], rel=1e-8)


def test_beginning_and_end():
    assert GUN.velocity(1e-9) == pytest.approx(50e6 / 139.25 * 1e-9, rel=1e-5)
    assert GUN.velocity(1e9) == pytest.approx(5.0 * GUN.c0, rel=0.02)  # of the escape into vacuum


def test_mass_momentum_and_energy_of_the_gas():
    """Of the gas between x = -1.5 m and the projectile; what it has given is what the projectile has."""
    time = 1.4e-3
    edge = np.linspace(-1.5, float(GUN.position(time)), 200_001)
    x, width = 0.5 * (edge[1:] + edge[:-1]), edge[1] - edge[0]
    rho, u, p = GUN.sample(x, time)
    projectile = GUN.mass * float(GUN.velocity(time))
    assert rho.sum() * width == pytest.approx(1.5 * 70.0, rel=1e-6)
    assert (rho * u).sum() * width + projectile == pytest.approx(50e6 * time, rel=1e-6)
    energy = (p / 0.4 + 0.5 * rho * u**2).sum() * width + 0.5 * projectile**2 / GUN.mass
    assert energy == pytest.approx(1.5 * 50e6 / 0.4, rel=1e-6)
