"""Quantities derived from an equation of state: sound speed, and the density at zero pressure."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eos import mie_grueneisen
from eos.dispatch import evaluate, sound_speed_squared, zero_pressure_density

NO_MEMORY = np.zeros(0)
RHO0, C0, GAMMA = 2770.0, 5200.0, 2.2
ALUMINIUM = mie_grueneisen.row(
    {
        "reference_density": RHO0,
        "sound_speed": C0,
        "hugoniot_slope": 1.36,
        "grueneisen": GAMMA,
        "specific_heat": 875.0,
    }
)


def test_sound_speed_has_a_floor_and_shows_a_nan():
    assert sound_speed_squared(2.0, 8.0, 5.0, 3.0, 1.0) == 5.0 + 8.0 * 3.0 / 4.0
    assert sound_speed_squared(2.0, -80.0, 5.0, 3.0, 1.0) == 1.0
    assert math.isnan(sound_speed_squared(math.nan, 8.0, 5.0, 3.0, 1.0))


@pytest.mark.parametrize(("ratio", "e"), [(0.99, 0.0), (0.95, 1e5), (0.8, 1e6), (0.4, 1e4)])
def test_density_without_pressure_of_a_stretched_solid(ratio, e):
    """In expansion p = 0 at rho0/(1 + Gamma0 e/c0^2)."""
    expected = RHO0 / (1 + GAMMA * e / C0**2)
    assert zero_pressure_density(mie_grueneisen.ID, ratio * RHO0, e, NO_MEMORY, ALUMINIUM) == pytest.approx(expected, rel=1e-12)


@settings(max_examples=300)
@given(ratio=st.floats(0.2, 2.0), e=st.floats(-2e6, 8e6))
def test_density_without_pressure(ratio, e):
    """In tension it is above the density, in compression below, and close to it the pressure changes sign."""
    rho = ratio * RHO0
    p = evaluate(mie_grueneisen.ID, rho, e, NO_MEMORY, ALUMINIUM)[0]
    at_rest = zero_pressure_density(mie_grueneisen.ID, rho, e, NO_MEMORY, ALUMINIUM)
    assert at_rest >= rho if p < 0.0 else at_rest <= rho
    assert evaluate(mie_grueneisen.ID, at_rest * (1 - 1e-11), e, NO_MEMORY, ALUMINIUM)[0] <= 0.0
    assert evaluate(mie_grueneisen.ID, at_rest * (1 + 1e-11), e, NO_MEMORY, ALUMINIUM)[0] >= 0.0


def test_unloaded_material_stays():
    assert zero_pressure_density(mie_grueneisen.ID, RHO0, 0.0, NO_MEMORY, ALUMINIUM) == RHO0
