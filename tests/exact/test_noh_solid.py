"""Noh's problem for a solid: the plane impact, conservation, and an ideal gas with the same machinery."""

from dataclasses import dataclass

import numpy as np
import pytest

from problems.verification.exact.impact import AL_5083, shock
from problems.verification.exact.noh import Noh
from problems.verification.exact.noh_solid import NohSolid


@dataclass(frozen=True)
class Gas:
    """An ideal gas, as a solid is: it begins with the sound speed c0, which is small."""

    rho0: float = 1.0
    c0: float = 1e-3
    gamma: float = 5.0 / 3.0

    def pressure(self, rho: float, e: float) -> float:
        return (self.gamma - 1.0) * rho * (e + self.c0**2 / (self.gamma * (self.gamma - 1.0)))

    def sound_speed_squared(self, rho: float, e: float) -> float:
        return self.gamma * self.pressure(rho, e) / rho


@pytest.mark.parametrize("j", [1, 2, 3])
def test_a_cold_gas_has_nohs_solution(j):
    found, exact = NohSolid(j, Gas(), 1.0), Noh(j)
    assert found.shock_speed == pytest.approx(exact.shock_speed, rel=1e-4)
    assert found.behind[0] == pytest.approx(exact.rho, rel=1e-4)
    assert found.behind[1] == pytest.approx(exact.p, rel=1e-4)


def test_a_plate_has_its_hugoniot():
    """Aluminium at 2 km/s: 43.305 GPa behind a shock of 8140 m/s into the plate."""
    found, exact = NohSolid(1, AL_5083, 2000.0), shock(AL_5083, 2000.0)
    assert found.shock_speed == pytest.approx(exact.speed - 2000.0, rel=1e-9)
    assert found.behind == pytest.approx((exact.rho, exact.p, exact.e), rel=1e-9)
    assert exact.p == pytest.approx(43.3048e9, rel=1e-6)


@pytest.mark.parametrize("j", [2, 3])
def test_conservation(j):
    """Mass within a radius far from the shock is that at the start and what came in since."""
    flow, time, outer = NohSolid(j, AL_5083, 1000.0), 1.0, 60e3
    edge = np.linspace(0.0, outer, 200_001)
    edge = np.unique(np.append(edge, flow.shock_speed * time))
    r, size = 0.5 * (edge[1:] + edge[:-1]), np.diff(edge**j) / j
    rho, u, _ = flow.sample(r, time)
    start = 2660.0 * outer**j / j
    # what passes the outer radius over time, by the self-similar flow there: x = outer/t from far away to outer/time
    t = time * (np.arange(4000) + 0.5) / 4000.0
    state = [flow.sample(np.array([outer]), each) for each in t]
    came = -np.mean([float(each[0][0] * each[1][0]) for each in state]) * time * outer ** (j - 1)
    assert np.sum(rho * size) == pytest.approx(start + came, rel=2e-6)
