"""Chen-Li's two numbers: the same depth as Forrestal's force, and the end of the rigid regime."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.penetration import chen_li, forrestal
from hydro2d.penetration.chen_li import numbers, transition_velocity
from hydro2d.penetration.forrestal import Nose, Target
from hydro2d.penetration.model import InputError
from tests.penetration.noses import SHAPES, a_nose

SHOT = dict(
    rod_diameter=7.11e-3, nose_shape="hemispherical", nose_crh=3.0, nose_half_angle=0.5, nose_edge_radius=None, friction=0.0,
    target_density=2710.0, target_strength=276e6, cavity_a=4.407, cavity_b=1.133, target_youngs_modulus=None,
    target_poisson_ratio=None, target_hardening_exponent=0.0, cavity_velocity=1200.0,
)


@pytest.mark.parametrize(
    ("velocity", "depth"),
    [(496.0, 51.019567646), (572.0, 65.220377545), (781.0, 107.712365225), (821.0, 116.142950512), (841.0, 120.372095914),
     (932.0, 139.651973349), (967.0, 147.054805378)],
)
def test_depth_with_chen_and_lis_coefficients(velocity, depth):
    """mm, computed independently from the closed form with A = 4.407, B = 1.133."""
    result = chen_li.evaluate(velocity, rod_mass=0.023, rod_strength=5e9, **SHOT)
    assert result["depth"] * 1e3 == pytest.approx(depth, rel=1e-9)


@settings(max_examples=40)
@given(
    st.sampled_from(SHAPES), st.floats(1.0, 2000.0), st.floats(0.001, 1.0),
    st.floats(0.0, 0.2),
)
def test_one_curve_is_forrestals_depth(shape, velocity, mass, friction):
    nose, target = Nose(a_nose(shape, 0.02), friction), Target(1.2e9, 3000.0)
    assert numbers(velocity, mass, nose, target).depth * 0.02 == pytest.approx(
        forrestal.deep(velocity, mass, nose, target)[0], rel=1e-11
    )


def test_the_pressure_at_the_transition_is_the_strength():
    nose, target = Nose(a_nose("ogival", 0.01, 3.0), 0.02), Target(1.2e9, 3000.0)
    limit = transition_velocity(2.5e9, nose, target)
    assert forrestal.force(limit, nose, target) / (0.25 * math.pi * 0.01**2) == pytest.approx(2.5e9, rel=1e-13)


def test_a_soft_rod_is_never_rigid_and_one_without_inertia_always():
    assert transition_velocity(1.0e9, Nose(a_nose("flat", 0.01)), Target(1.2e9, 3000.0)) == 0.0
    assert transition_velocity(1.3e9, Nose(a_nose("flat", 0.01)), Target(1.2e9, 0.0)) is None
    assert chen_li.evaluate(100.0, rod_mass=0.02, rod_strength=0.5e9, **SHOT)["regime"] == "semi-hydrodynamic"


@pytest.mark.parametrize(
    ("change", "word"), [({"rod_mass": 0.0}, "mass"), ({"rod_strength": -1.0}, "strength"), ({"cavity_b": 0.0}, r"cavity\.b")]
)
def test_impossible_shots_are_refused(change, word):
    with pytest.raises(InputError, match=word):
        chen_li.evaluate(500.0, **({"rod_mass": 0.023, "rod_strength": 2e9} | SHOT | change))
