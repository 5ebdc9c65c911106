"""Vibrations of spheres and cylinders against printed frequencies, and the condition that the surface is free."""

import numpy as np
import pytest

from problems.verification.exact.vibration import Elastic, Spheroidal, cylinder, period, shape, sphere

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


def test_lambs_spheroidal_vibration():
    """For Poisson's ratio 1/4, Lamb (1882) gives k a = 0.840 pi."""
    assert Spheroidal(Elastic(1.0, (5.0 / 3.0) ** 0.5, 1.0)).x / np.pi == pytest.approx(0.840, abs=5e-4)


def test_the_spheroidal_vibration_leaves_its_surface_free():
    """By differences of the displacements: no traction on the pole, on the equator and half-way between."""
    solid = Elastic(2.0, 3.0, 1.5)
    mode, step, mu = Spheroidal(solid), 1e-4, 1.5
    lame = solid.rho * solid.longitudinal**2 - 2.0 * mu

    def at(r, z):
        return np.array(mode.displacement(np.float64(r), np.float64(z), 1.0))

    for angle in (0.0, 0.25 * np.pi, 0.5 * np.pi):
        r, z = np.sin(angle), np.cos(angle)
        along_r, along_z = ((at(r + a, z + b) - at(r - a, z - b)) / (2.0 * step) for a, b in ((step, 0.0), (0.0, step)))
        hoop = at(r, z)[0] / r if r > 0.0 else along_r[0]
        pressure = lame * (along_r[0] + along_z[1] + hoop)
        rr, zz, rz = pressure + 2.0 * mu * along_r[0], pressure + 2.0 * mu * along_z[1], mu * (along_r[1] + along_z[0])
        scale = mu * np.abs([along_r, along_z]).max()
        assert rr * r + rz * z == pytest.approx(0.0, abs=1e-6 * scale)
        assert rz * r + zz * z == pytest.approx(0.0, abs=1e-6 * scale)
