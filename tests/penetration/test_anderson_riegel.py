"""Anderson-Riegel: the effective flow stress of the review's steels, and the curve as fitted to walker_anderson."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.penetration.anderson_riegel import (
    COLLAPSED,
    MODEL,
    Curve,
    depth_over_length,
    effective_flow_stress,
    fit,
    nondimensional_velocity,
)
from hydro2d.penetration.centreline import Rod, Target
from hydro2d.penetration.model import InputError
from hydro2d.penetration.walker_anderson import penetrate

STEEL_4340 = {
    "yield_stress": 792e6, "hardening": 510e6, "exponent": 0.26, "rate_coefficient": 0.014, "thermal_exponent": 1.03,
    "melt_temperature": 1793.0, "density": 7830.0, "specific_heat": 477.0,
}
STEEL_A36 = {
    "yield_stress": 286.1e6, "hardening": 500.1e6, "exponent": 0.2282, "rate_coefficient": 0.022, "thermal_exponent": 0.917,
    "melt_temperature": 1811.0, "density": 7850.0, "specific_heat": 486.0,
}
VALUES = {"rod.density": 17600.0, "rod.length": 0.1, "target.density": 7850.0, "target.effective_flow_stress": 1.2e9}


def test_mean_stress_of_4340():
    """1.18 GPa; the review has 1.2 for Rc 30 at 1000/s."""
    assert effective_flow_stress(**STEEL_4340) == pytest.approx(1.1774e9, rel=1e-4)
    assert effective_flow_stress(**STEEL_4340) == pytest.approx(1.2e9, rel=0.02)


def test_mean_stress_of_a36():
    """0.734 GPa; the review has 8 % less than the 0.797 GPa of Steel 37, 0.733."""
    assert effective_flow_stress(**STEEL_A36) == pytest.approx(0.7342e9, rel=1e-4)
    assert effective_flow_stress(**STEEL_A36) == pytest.approx(0.92 * 0.797e9, rel=0.01)


def test_mean_stress_against_the_curve_itself():
    """The stress-strain curve marched with its heat, and averaged."""
    n = 20000
    strain, step = (np.arange(n) + 0.5) / n, 1.0 / n
    cold = (792e6 + 510e6 * strain**0.26) * (1.0 + 0.014 * math.log(1e3))
    hot, stresses = 0.0, []
    for stress in cold:
        stresses.append(stress * (1.0 - hot**1.03))
        hot += stresses[-1] * step / (7830.0 * 477.0 * (1793.0 - 298.0))
    assert effective_flow_stress(**STEEL_4340) == pytest.approx(np.mean(stresses), rel=1e-4)


@given(st.floats(300.0, 4000.0), st.floats(2000.0, 20000.0), st.floats(2000.0, 10000.0), st.floats(0.2e9, 3e9))
def test_nondimensional_velocity(velocity, rod, target, stress):
    value = nondimensional_velocity(velocity, rod, target, stress)
    assert value == pytest.approx((rod / target) ** -0.07 * (rod * velocity**2 / stress) ** 0.2, rel=1e-12)
    assert nondimensional_velocity(2.0 * velocity, rod, target, 4.0 * stress) == pytest.approx(value, rel=1e-12)


@given(st.floats(100.0, 5000.0), st.floats(1.01, 2.0))
@settings(max_examples=50)
def test_depth_rises_with_velocity_and_falls_with_stress(velocity, factor):
    def depth(v, stress):
        return depth_over_length(v, rod_density=17600.0, target_density=7850.0, stress=stress)

    assert depth(factor * velocity, 1e9) >= depth(velocity, 1e9) >= depth(velocity, factor * 1e9) >= 0.0


def pairs():
    """The four pairs of the review's Figure 28 whose effective flow stress is printed."""
    tungsten = Rod(17600.0, 2.0e9, 323e9, 4030.0, 1.237, 0.010, 0.100)
    steel = Rod(7850.0, 1.2e9, 207e9, 4500.0, 1.49, 0.010, 0.100)
    return [(tungsten, 1.41e9), (tungsten, 0.858e9), (steel, 0.797e9), (steel, 1.41e9)]


def collapsed(velocities):
    """Nondimensional velocities and (P/L)/lambda of walker_anderson for the four pairs."""
    x, y = [], []
    for rod, stress in pairs():
        for velocity in velocities:
            ratio = penetrate(velocity, rod, Target(7850.0, stress, 77.5e9, 4500.0, 1.49)).depth / rod.length
            x.append(nondimensional_velocity(velocity, rod.density, 7850.0, stress))
            y.append(ratio / math.sqrt(rod.density / 7850.0))
    return np.array(x), np.array(y)


def test_coefficients_are_the_fit_to_walker_anderson():
    x, y = collapsed(np.linspace(700.0, 3000.0, 24))
    fitted = fit(x, y)
    assert vars(fitted) == pytest.approx(vars(COLLAPSED), abs=2e-4)
    miss = y - np.array([COLLAPSED.at(each) for each in x])
    assert math.sqrt(np.mean(miss**2)) < 0.0145
    assert np.abs(miss).max() < 0.037


def test_fit_finds_a_curve_again():
    truth = Curve(0.1, 1.4, 2.5, 1.3)
    x = np.linspace(0.5, 2.5, 15)
    fitted = fit(x, [truth.at(each) for each in x])
    assert vars(fitted) == pytest.approx(vars(truth), rel=1e-6)
    with pytest.raises(InputError, match="four different points"):
        fit([1.0, 2.0], [1.0, 2.0])


def test_model_with_the_stress_and_from_johnson_and_cook():
    given_stress = MODEL(1500.0, VALUES)
    assert given_stress["effective_flow_stress"] == 1.2e9
    assert given_stress["depth"] == pytest.approx(0.1 * given_stress["depth_over_length"])
    names = {"yield_stress": "johnson_cook_a", "hardening": "johnson_cook_b", "exponent": "johnson_cook_n",
             "rate_coefficient": "johnson_cook_c", "thermal_exponent": "johnson_cook_m"}
    parameters = {f"target.{names.get(name, name)}": value for name, value in STEEL_4340.items()}
    result = MODEL(1500.0, {"rod.density": 17600.0, "rod.length": 0.1, **parameters})
    assert result["effective_flow_stress"] == pytest.approx(effective_flow_stress(**STEEL_4340), rel=1e-12)
    assert result["depth"] > given_stress["depth"]


def test_wrong_input():
    with pytest.raises(InputError, match=r"needs target\.johnson_cook_a"):
        MODEL(1500.0, {name: value for name, value in VALUES.items() if name != "target.effective_flow_stress"})
    with pytest.raises(InputError, match="melting temperature"):
        effective_flow_stress(**{**STEEL_4340, "melt_temperature": 200.0})
    with pytest.raises(InputError, match="yield_stress"):
        effective_flow_stress(**{**STEEL_4340, "yield_stress": -1.0})
    with pytest.raises(InputError, match="velocity"):
        MODEL(0.0, VALUES)
    with pytest.raises(InputError, match=r"rod\.density"):
        MODEL(1500.0, {**VALUES, "rod.density": -1.0})
