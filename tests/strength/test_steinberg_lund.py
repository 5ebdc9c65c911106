"""Steinberg and Lund's law against its implicit equation and its limits."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from strength import steinberg_guinan, steinberg_lund

EV, BOLTZMANN = 1.602176634e-19, 1.380649e-23
TANTALUM = {"shear_modulus": 69e9, "yield_stress": 375e6, "max_yield_stress": 450e6, "hardening_coefficient": 22.0,
            "hardening_exponent": 0.283, "pressure_coefficient": 1.45e-11, "temperature_coefficient": 1.3e-4,
            "melt_temperature": 4340.0, "melt_exponent": 1.3, "grueneisen": 1.67, "reference_density": 16690.0}
ACTIVATION = {"peierls_stress": 820e6, "activation_energy": 0.31 * EV, "attempt_rate": 0.71e6, "drag": 0.012e6}
ROW = steinberg_lund.row(TANTALUM | ACTIVATION)


def rate_of(stress, T, peierls=820e6, energy=0.31 * EV, attempt=0.71e6, drag=0.012e6):
    """The strain rate at an activated stress: the equation of the paper."""
    barrier = 2.0 * energy / (BOLTZMANN * T) * (1.0 - stress / peierls) ** 2
    return 1.0 / (math.exp(min(barrier, 600.0)) / attempt + drag / stress)


def test_the_implicit_equation_is_solved():
    """Seed 1: 2000 materials and states, from 1e-11 to 1e8/s and from 2 to 4000 K, against Brent's method."""
    random, solved = np.random.default_rng(1), 0
    for _ in range(2000):
        rate, T = 10.0 ** random.uniform(-11.0, 8.0), 10.0 ** random.uniform(0.3, 3.6)
        drag, attempt = 820e6 * 10.0 ** random.uniform(-8.0, -3.0), 10.0 ** random.uniform(4.0, 9.0)
        row = steinberg_lund.row(TANTALUM | ACTIVATION | {"drag": drag, "attempt_rate": attempt})
        share = steinberg_lund.activated(rate, T, row)
        if rate >= rate_of(820e6, T, attempt=attempt, drag=drag):
            assert share == 1.0
            continue
        solved += 1
        exact = brentq(lambda u, T=T, attempt=attempt, drag=drag, rate=rate: math.log(
            rate_of(820e6 * math.exp(u), T, attempt=attempt, drag=drag) / rate), -60.0, 0.0, xtol=1e-14, rtol=1e-14)
        assert share == pytest.approx(math.exp(exact), rel=1e-9)
    assert solved > 1000


@pytest.mark.parametrize("MPa", [1.0, 50.0, 300.0, 600.0, 819.0])
def test_by_hand(MPa):
    """Rate from stress by the paper's equation, and the stress back from the rate."""
    rate = rate_of(1e6 * MPa, 300.0)
    Y = steinberg_lund.flow_stress(0.0, rate, 300.0, 0.0, 16690.0, ROW)
    assert pytest.approx(375e6 + 1e6 * MPa, rel=1e-10) == Y


def test_its_bounds():
    """Nothing activated at rate 0, the Peierls stress at 1e6/s, and athermal hardening up to its own bound."""
    slow, fast = (steinberg_lund.flow_stress(0.0, rate, 300.0, 0.0, 16690.0, ROW) for rate in (0.0, 1e6))
    assert (slow, fast) == (375e6, pytest.approx(1195e6, rel=1e-15))
    assert steinberg_lund.flow_stress(1e3, 1e6, 300.0, 0.0, 16690.0, ROW) == pytest.approx(1270e6, rel=1e-15)
    dragged = steinberg_lund.row(TANTALUM | ACTIVATION | {"drag": 1e6})
    assert steinberg_lund.flow_stress(0.1, 1e-13, 300.0, 0.0, 16690.0, dragged) == 450e6
    assert steinberg_lund.activated(1e-4, 0.0, ROW) == steinberg_lund.activated(1e-4, 1.0, ROW) > 0.94  # as cold as it counts
    assert steinberg_lund.flow_stress(0.1, 1e6, 4340.0, 0.0, 16690.0, ROW) == 0.0


def test_everything_scales_with_the_modulus():
    state = (2e10, 1.06 * 16690.0)
    relative = steinberg_guinan.relative_modulus(2e10, state[1], 700.0, ROW)
    share = steinberg_lund.activated(1e3, 700.0, ROW)
    Y = steinberg_lund.flow_stress(0.0, 1e3, 700.0, *state, ROW)
    assert pytest.approx((375e6 + 820e6 * share) * relative, rel=1e-14) == Y
    assert 0.0 < share < 1.0
    assert steinberg_lund.shear_modulus(*state, 700.0, ROW) == 69e9 * relative


def test_without_a_peierls_stress_it_is_steinberg_guinan():
    row, other = steinberg_lund.row(TANTALUM | ACTIVATION | {"peierls_stress": 0.0}), steinberg_guinan.row(TANTALUM)
    for rate in (0.0, 1e-3, 1e4, 1e7):
        state = (0.05, rate, 500.0, 1e9, 17000.0)
        assert steinberg_lund.flow_stress(*state, row) == steinberg_guinan.flow_stress(*state, other)


@pytest.mark.parametrize("state", [(0.1, math.nan, 300.0), (0.1, 1e3, math.nan), (math.nan, 1e3, 300.0)])
def test_a_nan_stays_one(state):
    assert math.isnan(steinberg_lund.flow_stress(*state, 0.0, 16690.0, ROW))


@pytest.mark.parametrize(("changed", "words"), [
    ({"drag": 0.0}, "drag = 0: must be positive"), ({"attempt_rate": -1.0}, "attempt_rate = -1: must be positive"),
    ({"max_yield_stress": 1e8}, "max_yield_stress is below yield_stress")])
def test_refused(changed, words):
    with pytest.raises(ValueError, match=words):
        steinberg_lund.row(TANTALUM | ACTIVATION | changed)
