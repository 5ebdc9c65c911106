"""Hydrodynamic theory and its modifications by strength."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hydro2d.penetration import hydrodynamic as hydro
from hydro2d.penetration.model import InputError

density = st.floats(1000.0, 20000.0)
speed = st.floats(500.0, 10000.0)
PAIR = {"rod_density": 8930.0, "target_density": 7830.0}


@given(speed, density, density, st.floats(-3e9, 5e9))
def test_the_stagnation_pressures_balance(velocity, rho_p, rho_t, sigma):
    assume(velocity**2 > 1.01 * max(2.0 * sigma / rho_p, -2.0 * sigma / rho_t))
    u = hydro.penetration_velocity(velocity, rod_density=rho_p, target_density=rho_t, strength_difference=sigma)
    assert 0.0 < u < velocity
    jet, target = 0.5 * rho_p * (velocity - u) ** 2, 0.5 * rho_t * u**2 + sigma
    assert jet == pytest.approx(target, rel=1e-9, abs=1e-9 * rho_p * velocity**2)


def test_a_jet_of_one_velocity_is_a_rod():
    whole = 0.3 * hydro.depth_over_length(5000.0, **PAIR, strength_difference=1e9)
    assert hydro.jet_depth([5000.0] * 3, [0.1] * 3, **PAIR, strength_difference=1e9) == pytest.approx(whole)
    speeds = np.linspace(2000.0, 8000.0, 7)
    mixed = hydro.jet_depth(speeds, [0.1] * 7, **PAIR, strength_difference=1e9)
    assert mixed < hydro.jet_depth(speeds, [0.1] * 7, **PAIR)
    with pytest.raises(InputError, match="as many lengths"):
        hydro.jet_depth([5000.0], [0.1, 0.2], **PAIR)


def test_allen_rogers_strength_of_7075():
    """1.89 GPa is 3.9 times the yield stress of 7075-T6, 0.48 GPa."""
    assert round(1.89 / 0.48, 1) == hydro.ALLEN_ROGERS_FACTOR
    values = {"rod.density": 8930.0, "rod.length": 0.1, "target.density": 2800.0, "target.strength": 0.48e9}
    assert hydro.ALLEN_ROGERS(3000.0, values)["strength_difference"] == pytest.approx(1.872e9)
    given_one = hydro.ALLEN_ROGERS(3000.0, {**values, "target.dynamic_strength": 1.89e9})
    assert given_one["strength_difference"] == 1.89e9
    assert given_one["depth_over_length"] == pytest.approx(
        hydro.depth_over_length(3000.0, rod_density=8930.0, target_density=2800.0, strength_difference=1.89e9))


def test_eichelberger_takes_the_difference():
    values = {"rod.density": 8930.0, "rod.length": 0.1, "target.density": 7830.0, "target.strength": 0.8e9,
              "rod.strength": 0.1e9, "target.strength_factor": 3.0}
    assert hydro.EICHELBERGER(5000.0, values)["strength_difference"] == pytest.approx(2.3e9)
    slow = hydro.EICHELBERGER(700.0, values)
    assert (slow["regime"], slow["depth"], slow["duration"]) == ("no penetration", 0.0, 0.0)
    assert slow["limit_velocity"] == pytest.approx(math.sqrt(2.0 * 2.3e9 / 8930.0))


def test_a_rod_too_strong_to_be_consumed_is_refused():
    with pytest.raises(InputError, match="too strong to be consumed"):
        hydro.penetration_velocity(500.0, rod_density=18160.0, target_density=2660.0, strength_difference=-1.6e9)
    with pytest.raises(InputError, match="velocity"):
        hydro.HYDRODYNAMIC(0.0, {"rod.density": 8930.0, "rod.length": 0.1, "target.density": 7830.0})
