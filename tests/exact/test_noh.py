"""Noh's solution against its known plateaus and against conservation of mass and energy."""

import numpy as np
import pytest

from problems.verification.exact.noh import Noh


@pytest.mark.parametrize(("j", "rho", "p"), [(1, 4, 4 / 3), (2, 16, 16 / 3), (3, 64, 64 / 3)])
def test_plateau(j, rho, p):
    noh = Noh(j)
    assert (noh.rho, noh.p, noh.e) == pytest.approx((rho, p, 0.5), rel=1e-14)
    assert noh.shock_speed == pytest.approx(1 / 3, rel=1e-14)


@pytest.mark.parametrize("j", [1, 2, 3])
def test_conservation(j):
    """Mass and energy inside r = 1 at t = 0.6 equal those inside r = 1.6 at t = 0."""
    noh, time, n = Noh(j), 0.6, 300_000
    r = (np.arange(n) + 0.5) / n
    rho, u, p = noh.sample(r, time)
    shell = r ** (j - 1) / n
    mass = (rho * shell).sum()
    energy = ((p / (noh.gamma - 1) + rho * u**2 / 2) * shell).sum()
    assert mass == pytest.approx(1.6**j / j, rel=1e-5)
    assert energy == pytest.approx(0.5 * 1.6**j / j, rel=1e-5)
