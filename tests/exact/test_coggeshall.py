"""Coggeshall's flows against the equations of motion by differences, and against his printed powers of time."""

import numpy as np
import pytest

from problems.verification.exact.coggeshall import Free, Slowed, shell_mean
from problems.verification.exact.collapse import Collapse

FLOWS = [Free(2, 1.0, 5.0 / 3.0, 1.0, 33e3, 1e-3), Free(1, -0.5, 1.4, 2.0, 1e5, 1e-3), Slowed(1, 1.0, 1.4, 1.0, 1e-3),
         Slowed(2, 0.0, 5.0 / 3.0, 1.0, 1e-3)]


@pytest.mark.parametrize("flow", FLOWS, ids=str)
def test_the_equations_of_motion(flow):
    r, time, h = np.linspace(0.2, 0.9, 30), 0.3e-3, 1e-5
    rho, u, p = flow.sample(r, time)
    later, earlier = flow.sample(r, time + h * 1e-3), flow.sample(r, time - h * 1e-3)
    out, inward = flow.sample(r + h, time), flow.sample(r - h, time)
    rate = [(a - b) / (2e-3 * h) for a, b in zip(later, earlier, strict=True)]
    slope = [(a - b) / (2.0 * h) for a, b in zip(out, inward, strict=True)]
    divergence = slope[1] + flow.k * u / r
    np.testing.assert_allclose(rate[0] + u * slope[0], -rho * divergence, rtol=1e-6)
    largest = np.abs(rho * u * u).max()
    np.testing.assert_allclose(rho * (rate[1] + u * slope[1]) / largest, -slope[2] / largest, atol=1e-6)
    np.testing.assert_allclose(rate[2] + u * slope[2], -flow.gamma * p * divergence, rtol=1e-6)


def test_the_powers_of_time():
    """Density of flow 2 at a radius falls as t^(-2 (b + k + 1)/((gamma - 1) k + gamma + 1)); here as t^(-6/2.8)."""
    flow = Slowed(1, 1.0, 1.4, 1.0, 1e-3)
    first, second = (float(flow.sample(0.5, time)[0]) for time in (0.0, 1e-3))
    assert second / first == pytest.approx(2.0 ** (-6.0 / 2.8), rel=1e-12)


def test_without_a_gradient_it_is_the_uniform_collapse():
    flow, known = Free(2, 0.0, 5.0 / 3.0, 1.0, 2.0 / 3.0 * 5e4, 1e-3), Collapse(e0=5e4, end=1e-3)
    rho, u, p = flow.sample(0.3, 0.5e-3)
    assert (float(rho), float(p)) == pytest.approx(known.at(0.5e-3)[:2], rel=1e-12)
    assert flow.untouched(1.0, 0.5e-3) == pytest.approx(known.untouched(1.0, 0.5e-3), rel=1e-3)


def test_the_mean_of_a_shell():
    r = np.linspace(0.3, 0.5, 100_001)
    assert shell_mean(1.0, 0.3, 0.5, 2) == pytest.approx(np.trapezoid(r**3, r) / np.trapezoid(r**2, r), rel=1e-9)
