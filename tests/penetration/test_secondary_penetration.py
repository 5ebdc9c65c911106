"""Debris of an eroding rod: its velocity, and the impact velocity above which it penetrates."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hydro2d.penetration import secondary_penetration as secondary
from hydro2d.penetration import tate

#: tungsten alloy into 7020 aluminium, Anderson (2017), section 6.3; the rod's density is not printed there
INTO_7020 = {"rod_strength": 2.0e9, "target_density": 2800.0}
FAST = settings(max_examples=60)

density = st.floats(1500.0, 20000.0)
stress = st.floats(3e8, 8e9)


@pytest.mark.parametrize(("resistance", "printed"), [(2.15e9, 1250.0), (2.35e9, 1400.0)])
def test_onset_into_7020(resistance, printed):
    """1.25 to 1.40 km/s: within 1 % with 17.3 g/cm^3, the density of this class of alloys in the review."""
    assert secondary.onset_velocity(rod_density=17300.0, resistance=resistance, **INTO_7020) == pytest.approx(printed, rel=0.01)


def test_onset_into_7020_depends_on_the_density_of_the_rod():
    for rod_density, low, high in ((17000.0, 1269.9, 1410.1), (17300.0, 1249.5, 1388.5), (17600.0, 1229.9, 1367.7)):
        for resistance, expected in ((2.15e9, low), (2.35e9, high)):
            result = secondary.onset_velocity(rod_density=rod_density, resistance=resistance, **INTO_7020)
            assert result == pytest.approx(expected, abs=0.05)


@given(density, stress, density, stress)
@FAST
def test_debris_exceeds_the_resistance_above_the_onset(rho_p, Yp, rho_t, Rt):
    assume(rho_p > 1.05 * rho_t)
    pair = {"rod_density": rho_p, "rod_strength": Yp, "target_density": rho_t, "resistance": Rt}
    onset = secondary.onset_velocity(**pair)
    for factor in (1.0001, 1.1, 2.0, 10.0):
        assert secondary.debris_pressure(factor * onset, **pair) > Rt
    transition = tate.Pair(**pair).transition_velocity
    if onset > transition:
        assert secondary.debris_pressure(onset, **pair) == pytest.approx(Rt, rel=1e-6)
        assert secondary.debris_pressure(max(0.9999 * onset, 1.0000001 * transition), **pair) <= Rt * (1.0 + 1e-6)


def test_limits_of_the_debris():
    """A rigid rod sheds none; without penetration debris flies back; far above, (1 - mu)/(1 + mu) of the velocity goes in."""
    strong = {"rod_density": 18160.0, "rod_strength": 3.4e9, "target_density": 2660.0, "resistance": 1.6e9}
    assert secondary.debris_velocity(1000.0, **strong) == 0.0
    weak = {**strong, "rod_strength": 1.0e9}
    assert secondary.debris_velocity(200.0, **weak) == -200.0
    assert secondary.debris_pressure(200.0, **weak) == 0.0
    mu = math.sqrt(2660.0 / 18160.0)
    assert secondary.debris_velocity(1e5, **weak) == pytest.approx(1e5 * (1.0 - mu) / (1.0 + mu), rel=1e-4)


def test_the_model_says_whether():
    values = {"rod.density": 17300.0, "rod.strength": 2.0e9, "target.density": 2800.0, "target.resistance": 2.15e9}
    assert secondary.MODEL(1240.0, values)["regime"] == "none"
    result = secondary.MODEL(1260.0, values)
    assert result["regime"] == "secondary penetration"
    assert result["pressure_over_resistance"] > 1.0
