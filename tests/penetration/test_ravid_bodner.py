"""Ravid-Bodner's first stage: the velocity field, its least power, and the energy balance."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from hydro2d.penetration import ravid_bodner
from hydro2d.penetration.model import InputError
from hydro2d.penetration.ravid_bodner import MODEL, SHEAR, first_stage, flow, inertia, pressure

VALUES = {
    "rod.density": 7750.0, "rod.diameter": 0.010, "rod.length": 0.050,
    "target.density": 2660.0, "target.strength": 0.4e9, "target.thickness": 0.030,
}
SHOT = {name.replace(".", "_"): value for name, value in VALUES.items()}


def radial(alpha, eta, r):
    """v_r at the face of zone II, per speed of the rod; r and extents in radii."""
    return (alpha**2 / r - r) / (2.0 * eta * (alpha**2 - 1.0))


def power(alpha, eta, depth):
    """Plastic power over pi R^2 Y v, every term by quadrature of its strain rate or of its jump in velocity."""
    def rate(r):
        c = 1.0 / (2.0 * eta * (alpha**2 - 1.0))
        strains = np.array([-c * (alpha**2 / r**2 + 1.0), c * (alpha**2 / r**2 - 1.0), 2.0 * c])
        assert abs(strains.sum()) < 1e-12
        return math.sqrt(2.0 / 3.0 * (strains**2).sum())

    body = quad(lambda r: 2.0 * r * eta * rate(r), 1.0, alpha)[0]
    bottom = quad(lambda r: 2.0 * r * r / (2.0 * eta), 0.0, 1.0)[0]
    ends = 2.0 * quad(lambda r: 2.0 * r * radial(alpha, eta, r), 1.0, alpha)[0]
    inner = 2.0 * quad(lambda z: (1.0 - z / eta) * (1.0 + 1.0 / (alpha**2 - 1.0)), 0.0, eta)[0]
    outer = 2.0 * alpha * quad(lambda z: (1.0 - z / eta) / (alpha**2 - 1.0), 0.0, eta)[0]
    rim = 2.0 * alpha * depth / (alpha**2 - 1.0)
    return 1.0 + body + SHEAR * (bottom + ends + inner + outer + rim)


@given(st.floats(1.05, 8.0), st.floats(0.0, 6.0))
@settings(max_examples=30)
def test_power_is_that_of_the_field(alpha, depth):
    assert pressure(alpha, depth) == pytest.approx(power(alpha, ravid_bodner.axial_extent(alpha), depth), rel=1e-9)


@given(st.floats(1.05, 8.0), st.floats(0.1, 6.0))
@settings(max_examples=30)
def test_inertia_is_that_of_the_field(alpha, depth):
    eta = ravid_bodner.axial_extent(alpha)
    along = quad(lambda z: (1.0 - z / eta) ** 2, 0.0, eta)[0]
    first = along + eta * quad(lambda r: 2.0 * r * (r / (2.0 * eta)) ** 2, 0.0, 1.0)[0]
    axial = along / (alpha**2 - 1.0)
    across = eta * quad(lambda r: 2.0 * r * radial(alpha, eta, r) ** 2, 1.0, alpha)[0]
    expected = math.pi * (first + axial + across + depth / (alpha**2 - 1.0))
    assert inertia(alpha, eta, depth) == pytest.approx(expected, rel=1e-8)


@given(st.floats(0.0, 8.0), st.floats(0.6, 1.6), st.floats(0.6, 1.6))
@settings(max_examples=40)
def test_the_flow_has_the_least_power(depth, wider, deeper):
    best = flow(depth)
    alpha, eta = 1.0 + (best.radial - 1.0) * wider, best.axial * deeper
    assert power(alpha, eta, depth) >= best.pressure * (1.0 - 1e-9)


def test_pressure_at_the_surface_is_above_the_exact_indentation():
    """An upper bound: 4.160 Y, above the 2.8 to 3 Y of slip-line and numerical solutions for a smooth flat punch."""
    assert flow(0.0).pressure == pytest.approx(4.1597, abs=1e-4)
    assert flow(0.0).radial == pytest.approx(1.3917, abs=1e-4)
    assert flow(0.0).axial == pytest.approx(0.4583, abs=1e-4)


@given(st.floats(1.0, 3000.0))
@settings(max_examples=20)
def test_energy_is_accounted_for(velocity):
    """Kinetic energy of rod and flow at the end plus the plastic work by quadrature equals the impact's energy."""
    stage = first_stage(velocity, **SHOT)
    mass = math.pi * 0.005**2 * 0.050 * 7750.0
    work = math.pi * 0.005**3 * 0.4e9 * quad(lambda x: flow(x).pressure, 0.0, stage.depth / 0.005, epsrel=1e-7)[0]
    left = 0.5 * (mass + 2660.0 * 0.005**3 * stage.flow.inertia) * stage.velocity**2
    assert work + left == pytest.approx(0.5 * mass * velocity**2, rel=1e-6)


@given(st.floats(1.0, 2000.0), st.floats(1.01, 1.3))
@settings(max_examples=20)
def test_depth_and_velocity_rise_with_the_impact(velocity, factor):
    slow, fast = (first_stage(each, **SHOT) for each in (velocity, factor * velocity))
    assert fast.depth >= slow.depth
    assert fast.velocity >= slow.velocity
    assert (fast.depth, fast.velocity) != (slow.depth, slow.velocity)


def test_slow_impact_is_uniformly_decelerated():
    """x = M V^2/(2 pi R^2 p0 Y) and t = 2 x/V while the resistance has not changed yet."""
    stage = first_stage(0.1, **SHOT)
    expected = 7750.0 * 0.050 * 0.1**2 / (2.0 * flow(0.0).pressure * 0.4e9)
    assert stage.depth == pytest.approx(expected, rel=1e-4)
    assert stage.duration == pytest.approx(2.0 * expected / 0.1, rel=0.02)


def test_a_thin_plate_bulges_at_once():
    result = MODEL(500.0, {**VALUES, "target.thickness": 0.001})
    assert result["regime"] == "reaches stage two"
    assert result["depth"] == 0.0
    assert result["stage_velocity"] < 500.0


@pytest.mark.parametrize("name", sorted(VALUES))
def test_wrong_input(name):
    with pytest.raises(InputError, match=name):
        MODEL(500.0, {**VALUES, name: -1.0})
    with pytest.raises(InputError, match=name):
        first_stage(500.0, **{**SHOT, name.replace(".", "_"): 0.0})
    with pytest.raises(InputError, match="velocity"):
        MODEL(0.0, VALUES)
