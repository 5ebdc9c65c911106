"""Tate-Poncelet: the rigid regime, resistances of shots, and the transition velocities of the review's Figure 11."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.penetration import poncelet, tate, tate_poncelet
from hydro2d.penetration.model import InputError

#: 95W alloy of Scheffler's shots into 5083 and 7039: densities in kg/m^3
INTO_5083 = {"rod_density": 18160.0, "target_density": 2660.0}
INTO_7039 = {"rod_density": 18160.0, "target_density": 2770.0}

speed = st.floats(10.0, 3000.0)
resistance = st.floats(2e8, 1e10)


@given(speed, resistance, st.floats(1000.0, 20000.0), st.floats(1000.0, 20000.0))
def test_depth_rises_with_velocity_and_gives_back_its_resistance(velocity, Rt, rho_p, rho_t):
    values = {"rod_density": rho_p, "target_density": rho_t}
    depth = tate_poncelet.depth_over_length(velocity, resistance=Rt, **values)
    assert tate_poncelet.depth_over_length(1.01 * velocity, resistance=Rt, **values) > depth
    assert tate_poncelet.depth_over_length(velocity, resistance=1.01 * Rt, **values) < depth
    assert tate_poncelet.resistance_from_depth(depth, velocity, **values) == pytest.approx(Rt, rel=1e-9)


def test_resistances_of_two_rigid_shots():
    """Shots 4344 (1086 m/s, 44.8 cm) and 4339 (1038 m/s, 28.3 cm) of a rod of 9.779 cm: 1.64 and 2.69 GPa."""
    resistance = tate_poncelet.resistance_from_depth(44.8 / 9.779, 1086.0, **INTO_5083)
    assert resistance == pytest.approx(1.6403e9, rel=1e-4)
    resistance = tate_poncelet.resistance_from_depth(28.3 / 9.779, 1038.0, **INTO_7039)
    assert resistance == pytest.approx(2.6891e9, rel=1e-4)


@pytest.mark.parametrize(("Yp", "printed"), [(3.0e9, 0.95), (4.0e9, 1.28)])
def test_the_transition_velocities_of_figure_11_need_another_resistance(Yp, printed):
    """1.78 GPa gives the printed value; the printed 1.62 GPa does not."""
    values = {"rod_strength": Yp, "target_density": 2700.0}
    assert round(tate.transition_velocity(resistance=1.78e9, **values) / 1000.0, 2) == printed
    assert round(tate.transition_velocity(resistance=1.62e9, **values) / 1000.0, 2) == {0.95: 1.01, 1.28: 1.33}[printed]


def test_fit_finds_the_resistance_of_exact_shots():
    velocities = [400.0, 700.0, 1000.0]
    depths = [tate_poncelet.depth_over_length(v, resistance=1.62e9, **INTO_5083) for v in velocities]
    fitted = tate_poncelet.fit(velocities, depths, **INTO_5083)
    assert fitted.a == pytest.approx(1.62e9, rel=1e-9)
    assert fitted.b == 1330.0


@given(speed, resistance)
def test_it_is_poncelet_with_the_inertia_of_the_target(velocity, Rt):
    depth = tate_poncelet.depth_over_length(velocity, resistance=Rt, **INTO_7039)
    assert depth == poncelet.depth_over_length(velocity, rod_density=18160.0, a=Rt, b=1385.0)
    assert depth == pytest.approx(18160.0 / 2770.0 * math.log(1.0 + 2770.0 * velocity**2 / (2.0 * Rt)), rel=1e-9)


def test_impossible_depths_are_refused():
    with pytest.raises(InputError, match="too deep"):
        tate_poncelet.resistance_from_depth(1e5, 1000.0, **INTO_5083)
    with pytest.raises(InputError, match="velocity"):
        tate_poncelet.resistance_from_depth(1.0, 0.0, **INTO_5083)
