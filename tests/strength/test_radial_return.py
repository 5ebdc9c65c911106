"""Return to the yield surface: on the surface, for every model, step and trial stress."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from strength import STRENGTH_MODELS
from strength.dispatch import flow_stress, shear_modulus
from strength.radial_return import plastic_increment
from tests.strength.test_flow_stress import TUNGSTEN

ROWS = {
    "elastic-plastic": {
        "shear_modulus": 26e9,
        "yield_stress": 3e8,
        "hardening_modulus": 1e9,
        "max_yield_stress": 6e8,
        "melt_temperature": 900.0,
    },
    "johnson-cook": {
        "shear_modulus": 124e9,
        "yield_stress": 1506e6,
        "hardening": 177e6,
        "hardening_exponent": 0.12,
        "rate_coefficient": 0.016,
        "melt_temperature": 1723.0,
    },
    "steinberg-guinan": TUNGSTEN,
    "power-law": {"youngs_modulus": 70.3e9, "poisson_ratio": 1 / 3, "yield_stress": 276e6, "hardening_exponent": 0.084},
}
MODELS = {name: (STRENGTH_MODELS[name].ID, STRENGTH_MODELS[name].row(values)) for name, values in ROWS.items()}
RHO = 18500.0


@settings(max_examples=600)
@given(
    name=st.sampled_from(sorted(MODELS)),
    trial=st.floats(-10.0, 6.0),
    strain=st.one_of(st.just(-math.inf), st.floats(-20.0, 2.0)),
    step=st.floats(-12.0, -5.0),
    T=st.floats(0.0, 3000.0),
    p=st.floats(-3e9, 5e10),
    factor=st.sampled_from([1.0, 1.5625]),
)
def test_the_result_lies_on_the_yield_surface(name, trial, strain, step, T, p, factor):
    model, row = MODELS[name]
    ep, dt = 10.0**strain, 10.0**step
    G = shear_modulus(model, p, RHO, T, row)
    static = factor * flow_stress(model, ep, 0.0, T, p, RHO, row)
    seq = (static or 1e8) * (1.0 + 10.0**trial)
    dep, Y = plastic_increment(model, seq, ep, dt, T, p, RHO, G, factor, row, 0.0)
    if G == 0.0:
        assert (dep, Y) == (0.0, 0.0)
        return
    assert 0.0 <= dep <= seq / (3.0 * G) * (1 + 1e-15)
    assert 0.0 <= Y <= seq * (1.0 + 1.001e-10)  # the same tolerance of the stress as below
    assert Y == pytest.approx(seq - 3.0 * G * dep, abs=1.001e-10 * seq)
    # where hardening is steep at zero strain, the stress is right although the strain may be off by 1e-10 seq/(3 G)
    least = 1.001e-10 * seq / (3.0 * G)
    low, high = (
        seq - 3.0 * G * x - factor * flow_stress(model, ep + x, x / dt, T, p, RHO, row)
        for x in (max(dep - least, 0.0), dep + least)
    )
    assert low >= -1e-14 * seq
    assert high <= 1e-14 * seq


@pytest.mark.parametrize("name", MODELS)
def test_below_the_surface_nothing_happens(name):
    model, row = MODELS[name]
    static = flow_stress(model, 0.1, 0.0, 400.0, 1e9, RHO, row)
    for share in (0.0, 0.5, 1.0):
        assert plastic_increment(model, share * static, 0.1, 1e-8, 400.0, 1e9, RHO, 1e10, 1.0, row, 0.0) == (0.0, static)


def test_linear_hardening_in_closed_form():
    """(seq - Y)/(3 G + H)"""
    model, row = MODELS["elastic-plastic"]
    dep, Y = plastic_increment(model, 4e8, 0.01, 1e-8, 298.0, 0.0, 2700.0, 26e9, 1.0, row, 0.0)
    assert dep == pytest.approx((4e8 - 3.1e8) / (3 * 26e9 + 1e9), rel=1e-12)
    assert pytest.approx(3.1e8 + 1e9 * dep, rel=1e-12) == Y


def test_rate_is_that_of_the_step():
    """Johnson-Cook without hardening at a plastic rate of 1e5/s."""
    module = STRENGTH_MODELS["johnson-cook"]
    row = module.row({"shear_modulus": 27e9, "yield_stress": 3e8, "rate_coefficient": 0.02})
    stress = 3e8 * (1 + 0.02 * math.log(1e5))
    dep, Y = plastic_increment(module.ID, stress + 3 * 27e9 * 1e-3, 0.0, 1e-8, 298.0, 0.0, 2700.0, 27e9, 1.0, row, 0.0)
    assert dep == pytest.approx(1e-3, rel=1e-7)
    assert pytest.approx(stress, rel=1e-9) == Y


def test_molten_material_loses_its_stress():
    model, row = MODELS["johnson-cook"]
    dep, Y = plastic_increment(model, 5e8, 0.3, 1e-8, 2000.0, 0.0, RHO, 124e9, 1.0, row, 0.0)
    assert dep == pytest.approx(5e8 / (3 * 124e9), rel=1e-12)
    assert Y == 0.0


@pytest.mark.parametrize("seq", [0.0, 1e8, 1e20])
def test_without_a_modulus_there_is_nothing_to_return(seq):
    assert plastic_increment(0, seq, 0.0, 1e-8, 300.0, 0.0, 2700.0, 0.0, 1.0, MODELS["power-law"][1], 0.0) == (0.0, 0.0)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("seq", [1e13, 1e20, 1e100])
def test_an_absurd_trial_stress_is_returned_as_well(name, seq):
    model, row = MODELS[name]
    dep, Y = plastic_increment(model, seq, 0.0, 1e-8, 300.0, 0.0, RHO, 5e10, 1.0, row, 0.0)
    assert dep == pytest.approx(seq / 1.5e11, rel=1e-2)
    assert 0.0 <= Y < 1e-2 * seq


@pytest.mark.parametrize("name", MODELS)
def test_nan_is_not_hidden(name):
    model, row = MODELS[name]
    dep, Y = plastic_increment(model, math.nan, 0.1, 1e-8, 300.0, 0.0, RHO, 5e10, 1.0, row, 0.0)
    assert math.isnan(dep)
    assert math.isnan(Y)
