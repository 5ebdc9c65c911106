"""Oblique shocks against printed tables, and the reflection of a shock against its limits."""

import math

import pytest

from problems.verification.exact.oblique import reflection, weak


def test_a_wedge():
    """15 degrees at Mach 3: 32.24 degrees, p2/p1 = 2.822, T2/T1 = 1.388, Mach 2.255 (NACA Report 1135)."""
    shock = weak(3.0, math.radians(15.0))
    assert math.degrees(shock.beta) == pytest.approx(32.24, abs=5e-3)
    assert shock.pressure == pytest.approx(2.8216, abs=1e-4)
    assert shock.pressure / shock.density == pytest.approx(1.388, abs=5e-4)
    assert shock.mach == pytest.approx(2.255, abs=1e-3)


def test_the_largest_angle_of_a_wedge():
    """34.07 degrees at Mach 3 (NACA Report 1135)."""
    assert weak(3.0, math.radians(34.06)).mach < 1.05
    with pytest.raises(ValueError, match="so far"):
        weak(3.0, math.radians(34.08))


def test_the_limit_of_regular_reflection():
    """39.97 degrees for very strong shocks with gamma = 1.4 (Ben-Dor, Shock Wave Reflection Phenomena)."""
    reflection(1e4, math.radians(39.9))
    with pytest.raises(ValueError, match="so far"):
        reflection(1e4, math.radians(40.1))


def test_a_small_angle_is_a_reflection_head_on():
    """p3/p2 = ((3 gamma - 1) p2/p1 - (gamma - 1))/((gamma - 1) p2/p1 + gamma + 1): 3.3333 for Mach 2."""
    assert reflection(2.0, math.radians(0.05)).second.pressure == pytest.approx((3.2 * 4.5 - 0.4) / (0.4 * 4.5 + 2.4), rel=1e-5)
