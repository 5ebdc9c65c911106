"""Forrestal's rigid rod: factors of every nose, printed and expected depths, limits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.penetration import forrestal
from hydro2d.penetration.forrestal import Nose, Target, deep, entering, force
from hydro2d.penetration.model import InputError
from hydro2d.penetration.surface import nose_surface
from tests.penetration.noses import SHAPES, a_nose

STEEL, ALUMINIUM = 0.023, Target(5.0394 * 276e6, 0.9830 * 2710.0)
BALL = Nose(a_nose("hemispherical", 7.11e-3))


@pytest.mark.parametrize(
    ("velocity", "closed", "entry"),
    [(496.0, 46.00408, 47.09970), (572.0, 59.27111, 60.34398), (781.0, 100.03803, 101.04908), (821.0, 108.30286, 109.30274),
     (841.0, 112.46944, 113.46383), (932.0, 131.63135, 132.60185), (967.0, 139.05897, 140.02076)],
)
def test_the_seven_shots(velocity, closed, entry):
    """mm, computed independently from the two-term closed form, without and with the entry of the nose."""
    assert deep(velocity, STEEL, BALL, ALUMINIUM)[0] * 1e3 == pytest.approx(closed, abs=1e-5)
    assert entering(velocity, STEEL, BALL, ALUMINIUM)[0] * 1e3 == pytest.approx(entry, abs=1e-5)


@pytest.mark.parametrize(
    ("shape", "alloy", "mass", "velocity", "expected"),
    [
        ("hemispherical", 5083, 0.0628, 1086.0, (49.9, 46.8, 44.1)), ("ogival", 5083, 0.0629, 923.0, (50.6, 42.3, 36.3)),
        ("ogival", 5083, 0.0631, 1070.0, (65.9, 55.2, 47.5)), ("ogival", 5083, 0.0628, 1227.0, (83.0, 69.7, 60.1)),
        ("hemispherical", 7039, 0.0631, 1038.0, (37.9, 35.5, 33.4)), ("ogival", 7039, 0.0631, 1075.0, (51.3, 42.9, 36.9)),
        ("ogival", 7039, 0.0634, 1156.0, (58.6, 49.1, 42.2)), ("ogival", 7039, 0.0634, 1291.0, (71.0, 59.6, 51.3)),
    ],
)
def test_tungsten_alloy_into_aluminium_with_friction(shape, alloy, mass, velocity, expected):
    """cm at mu = 0, 0.05 and 0.10, expectations rounded to a millimetre; B = 1.1, an ogive of length 1.5 d."""
    static, density = {5083: (1.326e9, 2660.0), 7039: (1.769e9, 2770.0)}[alloy]
    for friction, depth in zip((0.0, 0.05, 0.10), expected, strict=True):
        nose = Nose(a_nose(shape, 6.7568e-3, crh=2.5), friction)
        assert deep(velocity, mass, nose, Target(static, 1.1 * density))[0] * 100.0 == pytest.approx(depth, abs=0.06)


def test_factors_of_a_hemisphere_are_andersons():
    """Equation (43): N1 = 1 + pi f/2, N2 = (1 + pi f/4)/2."""
    n1, n2 = Nose(a_nose("hemispherical", 0.02), 0.1).factors()
    assert n1 == pytest.approx(1.0 + 0.05 * math.pi, rel=1e-14)
    assert n2 == pytest.approx(0.5 * (1.0 + 0.025 * math.pi), rel=1e-14)


@pytest.mark.parametrize("crh", [0.5, 1.0, 3.0, 6.0])
def test_factors_of_an_ogive_without_friction(crh):
    """N1 = 1 and the nose factor of the literature, N2 = (8 psi - 1)/(24 psi^2)."""
    n1, n2 = Nose(a_nose("ogival", 0.02, crh=crh)).factors()
    assert n1 == pytest.approx(1.0, rel=1e-12)
    assert n2 == pytest.approx((8.0 * crh - 1.0) / (24.0 * crh**2), rel=1e-12)


@pytest.mark.parametrize("edge", [0.1, 0.5, 0.999])
def test_factors_of_a_rounded_edge_lie_between_those_of_a_face_and_of_a_hemisphere(edge):
    """Without friction N1 = 1, and N2 by quadrature of cos^2 over the arc; edge: its radius over that of the shank."""
    n1, n2 = Nose(a_nose("flat-rounded", 0.02, edge=edge)).factors()
    theta = np.linspace(0.0, 0.5 * math.pi, 20001)
    r = 1.0 - edge + edge * np.cos(theta)
    assert n1 == pytest.approx(1.0, rel=1e-12)
    assert n2 == pytest.approx((1.0 - edge) ** 2 + 2.0 * np.trapezoid(r * edge * np.sin(theta) ** 3, theta), rel=1e-7)
    assert 0.5 < n2 < 1.0


@settings(max_examples=40)
@given(
    st.sampled_from(SHAPES), st.floats(0.5, 8.0), st.floats(0.1, 1.4), st.floats(0.0, 0.3), st.floats(10.0, 2000.0)
)
def test_closed_force_is_that_of_the_rings(shape, crh, half_angle, friction, velocity):
    nose = Nose(a_nose(shape, 0.02, crh, half_angle), friction)
    rings = nose_surface(a_nose(shape, 0.02, crh, half_angle), 2000)
    pressure = ALUMINIUM.static + ALUMINIUM.dynamic * (velocity * rings.normal_z) ** 2
    summed = np.sum(pressure * (rings.normal_z + friction * rings.normal_r) * rings.area)
    assert force(velocity, nose, ALUMINIUM) == pytest.approx(summed, rel=1e-4)


@pytest.mark.parametrize("shape", ["hemispherical", "ogival", "conical"])
@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_force_of_the_rings_converges_with_the_second_order(shape, friction):
    exact = force(900.0, Nose(a_nose(shape, 0.02, 3.0, 0.4), friction), Target(1e6, 2710.0))
    off = []
    for rings in (10, 20, 40):
        nose = nose_surface(a_nose(shape, 0.02, 3.0, 0.4), rings)
        pressure = 1e6 + 2710.0 * (900.0 * nose.normal_z) ** 2
        off.append(abs(np.sum(pressure * (nose.normal_z + friction * nose.normal_r) * nose.area) / exact - 1.0))
    if shape == "conical":
        assert max(off) < 1e-13
    else:
        orders = [math.log2(coarse / fine) for coarse, fine in zip(off, off[1:], strict=False)]
        assert all(1.9 < order < 2.1 for order in orders)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("solve", [deep, entering])
def test_loss_of_kinetic_energy_is_the_work_of_the_force(shape, solve):
    """Work by quadrature of force over depth; the velocity at a depth from the depth that a slower rod still reaches."""
    nose, velocities = Nose(a_nose(shape, 7.11e-3), 0.05), np.linspace(0.0, 781.0, 4001)
    total = solve(781.0, STEEL, nose, ALUMINIUM)[0]
    if solve is entering:
        late = np.array([deep(v, STEEL, nose, ALUMINIUM)[0] for v in velocities])
        depths = total - late
        inside = depths >= nose.length
        work = -np.trapezoid([force(v, nose, ALUMINIUM) for v in velocities[inside]], depths[inside])
        buried = velocities[inside][-1]
        assert work == pytest.approx(0.5 * STEEL * buried**2, rel=1e-5)
        assert 0.5 * STEEL * (781.0**2 - buried**2) <= force(781.0, nose, ALUMINIUM) * (nose.length + 0.2e-3)
    else:
        depths = total - np.array([deep(v, STEEL, nose, ALUMINIUM)[0] for v in velocities])
        work = -np.trapezoid([force(v, nose, ALUMINIUM) for v in velocities], depths)
        assert work == pytest.approx(0.5 * STEEL * 781.0**2, rel=1e-5)


def test_a_slow_rod_stops_within_its_nose():
    """With the static pressure alone on a cone the work is A Y pi a^2 x^3/(3 b^2)."""
    nose = Nose(a_nose("conical", 7.11e-3, half_angle=0.4))
    depth, duration = entering(30.0, STEEL, nose, Target(1.4e9, 0.0))
    by_hand = (0.5 * STEEL * 30.0**2 * 3.0 * nose.length**2 / (1.4e9 * math.pi * 3.555e-3**2)) ** (1.0 / 3.0)
    assert by_hand < nose.length
    assert depth == pytest.approx(by_hand, rel=1e-7)
    assert depth / 30.0 < duration < 3.0 * depth / 30.0


SHOT = dict(
    rod_mass=STEEL, rod_diameter=7.11e-3, nose_shape="hemispherical", nose_crh=3.0, nose_half_angle=0.5, nose_edge_radius=None,
    friction=0.0,
    target_density=2710.0, target_strength=276e6, cavity_a=5.0394, cavity_b=0.9830, target_youngs_modulus=None,
    target_poisson_ratio=None, target_hardening_exponent=0.0, cavity_velocity=1200.0,
)


@pytest.mark.parametrize(
    ("change", "word"),
    [({"rod_mass": 0.0}, "mass"), ({"friction": -0.1}, "friction"), ({"nose_crh": 0.3, "nose_shape": "ogival"}, "crh"),
     ({"cavity_b": None}, r"cavity\.b"), ({"rod_diameter": -1.0}, "diameter"), ({"nose_shape": "pointed"}, "unknown nose")],
)
def test_impossible_shots_are_refused(change, word):
    with pytest.raises(InputError, match=word):
        forrestal.evaluate(781.0, nose_entry="resisted", **(SHOT | change))
