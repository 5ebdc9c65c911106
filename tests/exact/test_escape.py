"""Products that escape: Mader's printed state, and conservation of mass, momentum and energy over the whole flow."""

import numpy as np
import pytest

from problems.verification.exact.detonation import mader
from problems.verification.exact.escape import Escape

CHARGE = Escape(1875.0, 8000.0, 0.05)


def test_the_state_of_maders_problem():
    """30 GPa (Mader, Numerical Modeling of Detonations, 1979), and his wave before the other end is felt."""
    assert CHARGE.cj_pressure == pytest.approx(30e9)
    time = 8e-6
    x = np.linspace(0.55 * 8000.0 * time, CHARGE.length - 0.5 * 8000.0 * (time - 6.25e-6), 20)
    assert CHARGE.length - 0.5 * 8000.0 * (time - 6.25e-6) > 0.55 * 8000.0 * time
    np.testing.assert_allclose(CHARGE.sample(x, time), mader(x, time), rtol=1e-12)


@pytest.mark.parametrize("time", [6.5e-6, 10e-6, 40e-6])
def test_conservation(time):
    low, high = CHARGE.ends(time)
    edge = np.linspace(low, high, 400_001)
    x, width = 0.5 * (edge[1:] + edge[:-1]), edge[1] - edge[0]
    rho, u, p = CHARGE.sample(x, time)
    assert rho.sum() * width == pytest.approx(1875.0 * 0.05, rel=1e-5)
    assert (rho * u).sum() * width == pytest.approx(0.0, abs=1e-5 * 1875.0 * 0.05 * 8000.0)
    assert (0.5 * p + 0.5 * rho * u**2).sum() * width == pytest.approx(CHARGE.energy * 0.05, rel=1e-4)
