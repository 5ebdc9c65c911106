"""Vibrations of spheres and cylinders against printed frequencies, and the condition that the surface is free."""

import numpy as np
import pytest

from problems.verification.exact.vibration import Elastic, cylinder, period, shape, sphere

ALUMINIUM = Elastic(2785.0, 5328.0, 27.6e9)


def test_aluminium():
    assert ALUMINIUM.longitudinal == pytest.approx(6449.90, abs=0.01)
    assert ALUMINIUM.transverse == pytest.approx(3148.05, abs=0.01)
    assert (sphere(ALUMINIUM), cylinder(ALUMINIUM)) == pytest.approx((2.76683, 2.17873), abs=5e-6)
    assert 1e6 * period(ALUMINIUM, 0.01, sphere(ALUMINIUM)) == pytest.approx(3.5208, abs=5e-5)
    assert 1e6 * period(ALUMINIUM, 0.01, cylinder(ALUMINIUM)) == pytest.approx(4.4712, abs=5e-5)


def test_lambs_sphere():
    """Lamb's table for Poisson's ratio 1/4, c_l = sqrt(3) c_s: x = 0.8160 pi."""
    speed = np.sqrt(3.0 - 4.0 / 3.0)
    assert sphere(Elastic(1.0, float(speed), 1.0)) / np.pi == pytest.approx(0.8160, abs=1e-4)


def test_the_surface_is_free():
    """(lame + 2 G) du/dr + 2 lame u/r is zero at the surface."""
    x, h = sphere(ALUMINIUM), 1e-6
    slope = (shape(x, 1.0 + h) - shape(x, 1.0 - h)) / (2.0 * h)
    ratio = 1.0 - 2.0 * (ALUMINIUM.transverse / ALUMINIUM.longitudinal) ** 2
    assert slope + 2.0 * ratio * shape(x, 1.0) == pytest.approx(0.0, abs=1e-8)
