"""Jets of liquid sheets: mass, momentum, and Birkhoff's speeds."""

import math

import pytest

from problems.verification.exact.jets import back, forward, jet_speed


@pytest.mark.parametrize("beta", [0.3, 1.0, math.pi / 2.0, 2.5])
def test_mass_and_momentum(beta):
    assert forward(beta) + back(beta) == pytest.approx(1.0, rel=1e-14)
    assert forward(beta) - back(beta) == pytest.approx(math.cos(beta), abs=1e-14)
    assert jet_speed(beta) == pytest.approx(1.0 / math.tan(beta) + 1.0 / math.sin(beta), rel=1e-12)


def test_numbers():
    """Head on a sheet splits in two halves; at 60 degrees a quarter goes back, and a liner's jet has 1.732 times its speed."""
    assert back(math.pi / 2.0) == pytest.approx(0.5)
    assert back(math.radians(60.0)) == pytest.approx(0.25)
    assert jet_speed(math.radians(60.0)) == pytest.approx(math.sqrt(3.0))
