"""Recht-Ipson: momentum and energy of a perforation, with and without a plug."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.penetration import recht_ipson as ri
from hydro2d.penetration.model import InputError

speed, limit, ratio = st.floats(1.0, 2000.0), st.floats(50.0, 1500.0), st.floats(0.0, 3.0)
CYLINDER = {"rod_density": 7830.0, "rod_length": 0.02, "rod_diameter": 0.02, "target_density": 7890.0}


@given(speed, limit, ratio)
def test_energy_is_accounted_for(velocity, V50, plug):
    parts = ri.energy_budget(velocity, mass=0.05, limit_velocity=V50, plug_mass_ratio=plug)
    assert min(parts.residual, parts.deformation, parts.shear) >= 0.0
    assert parts.residual + parts.deformation + parts.shear == pytest.approx(0.5 * 0.05 * velocity**2, rel=1e-12)


@given(speed, limit, ratio)
def test_shear_work_is_that_of_the_limit_and_the_collision_is_inelastic(velocity, V50, plug):
    """Above V50 the plug takes the same work at all velocities, and the collision follows from momentum alone."""
    parts = ri.energy_budget(V50 + velocity, mass=1.0, limit_velocity=V50, plug_mass_ratio=plug)
    assert parts.shear == pytest.approx(0.5 * V50**2 / (1.0 + plug), rel=1e-12)
    together = (V50 + velocity) / (1.0 + plug)
    assert parts.deformation == pytest.approx(
        0.5 * (V50 + velocity) ** 2 - 0.5 * (1.0 + plug) * together**2, rel=1e-9, abs=1e-9 * (V50 + velocity) ** 2)


def test_plug_of_a_cylinder_is_eq_22():
    """(1 + (rho_t/rho_p)(d/D)^2 (T/L))^-1 sqrt(V^2 - V50^2), for T/L = 0.29 and d/D of 1 and 1.4."""
    for widening in (1.0, 1.4):
        plug = ri.plug_mass_ratio(**CYLINDER, target_thickness=0.29 * 0.02, plug_diameter=widening * 0.02)
        result = ri.residual_velocity(950.0, limit_velocity=250.0, plug_mass_ratio=plug)
        expected = math.sqrt(950.0**2 - 250.0**2) / (1.0 + 7890.0 / 7830.0 * widening**2 * 0.29)
        assert result == pytest.approx(expected, rel=1e-12)
    assert ri.plug_mass_ratio(**CYLINDER, target_thickness=0.0058) == pytest.approx(7890.0 / 7830.0 * 0.29, rel=1e-12)


def test_piercing_is_a_hyperbola():
    result = ri.PIERCING(1000.0, {"plate.limit_velocity": 600.0})
    assert result["residual_velocity"] == pytest.approx(800.0)
    assert result["residual_over_limit"] == pytest.approx(math.sqrt((1000.0 / 600.0) ** 2 - 1.0))
    assert ri.PIERCING(600.0, {"plate.limit_velocity": 600.0})["regime"] == "stopped"


def test_impossible_values_are_refused():
    with pytest.raises(InputError, match="limit_velocity"):
        ri.residual_velocity(500.0, limit_velocity=0.0)
    with pytest.raises(InputError, match="target_thickness"):
        ri.plug_mass_ratio(**CYLINDER, target_thickness=-0.01)
