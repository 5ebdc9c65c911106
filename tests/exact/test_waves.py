"""Waves of liquids against an integration of their potentials, and the numbers of the problems."""

import math

import pytest
from scipy.integrate import solve_ivp

from problems.verification.exact.waves import Interface

SLOSHING = Interface(1e4, math.pi / 0.1, 1000.0, 0.1)
HEAVY_ABOVE = Interface(1e4, math.pi / 0.1, 1000.0, 0.1, 3000.0, 0.1)


def test_the_numbers_of_the_problems():
    assert SLOSHING.period == pytest.approx(11.231e-3, abs=1e-6)
    assert Interface(1e4, math.pi / 0.1, 1000.0, 0.1, 10.0, 0.1).period == pytest.approx(11.344e-3, abs=1e-6)
    assert HEAVY_ABOVE.growth == pytest.approx(395.6, abs=0.05)
    assert HEAVY_ABOVE.amplitude(2.0 / HEAVY_ABOVE.growth) == pytest.approx(3.7622, abs=1e-4)


def test_limits():
    """Long waves run at sqrt(g H); short waves know no floor, and n^2 = A g k."""
    long = Interface(9.81, 1e-4, 1000.0, 2.0)
    assert long.omega_squared == pytest.approx(9.81 * 2.0 * 1e-8, rel=1e-7)
    deep = Interface(9.81, 50.0, 1000.0, 2.0, 3000.0, 2.0)
    assert deep.growth**2 == pytest.approx(0.5 * 9.81 * 50.0, rel=1e-12)


def integrated(wave: Interface) -> float:
    """omega^2 by the potentials of both liquids, phi'' = k^2 phi, integrated from floor and lid to the interface.

    There both move at the same speed, and rho (d phi/dt + g a) is continuous.
    """
    k = wave.wave_number

    def inertia(depth: float) -> float:
        """phi over its derivative at the interface."""
        end = solve_ivp(lambda z, y: [y[1], k**2 * y[0]], (0.0, depth), [1.0, 0.0], rtol=1e-11, atol=1e-13).y[:, -1]
        return end[0] / end[1]

    total = wave.lower * inertia(wave.depth) + wave.upper * inertia(wave.height)
    return wave.gravity * (wave.lower - wave.upper) / total


@pytest.mark.parametrize("wave", [HEAVY_ABOVE, Interface(9.81, 3.0, 1000.0, 0.3, 700.0, 0.1)])
def test_by_the_potentials(wave):
    assert wave.omega_squared == pytest.approx(integrated(wave), rel=1e-8)
