"""Voce's law and the factor of the rate, with its cap."""

import math

import pytest

from strength import johnson_cook, voce

ALLOY = {"shear_modulus": 26.9e9, "yield_stress": 270e6, "saturation": 250e6, "hardening_rate": 7.0, "rate_coefficient": 0.02,
         "reference_rate": 10.0, "thermal_exponent": 1.3, "melt_temperature": 893.0}
JC = {"shear_modulus": 26.9e9, "yield_stress": 270e6, "rate_coefficient": 0.02, "reference_rate": 10.0,
      "thermal_exponent": 1.3, "melt_temperature": 893.0}


def test_by_hand():
    row = voce.row(ALLOY)
    Y = voce.flow_stress(0.2, 1e4, 500.0, 0.0, 2700.0, row)
    exact = (270e6 + 250e6 * (1 - math.exp(-1.4))) * (1 + 0.02 * math.log(1e3)) * (1 - ((500 - 298) / (893 - 298)) ** 1.3)
    assert pytest.approx(exact, rel=1e-14) == Y


def test_hardening_saturates_and_starts_with_its_slope():
    """Voce (1948): dY/d(ep) = b (Y0 + Q - Y)."""
    row = voce.row({**ALLOY, "rate_coefficient": 0.0})
    at = [voce.flow_stress(ep, 0.0, 298.0, 0.0, 2700.0, row) for ep in (0.1 - 1e-6, 0.1, 0.1 + 1e-6)]
    assert (at[2] - at[0]) / 2e-6 == pytest.approx(7.0 * (520e6 - at[1]), rel=1e-6)
    assert voce.flow_stress(1e3, 0.0, 298.0, 0.0, 2700.0, row) == 520e6
    assert voce.flow_stress(-1e-9, 0.0, 298.0, 0.0, 2700.0, row) == 270e6


@pytest.mark.parametrize(("model", "values"), [(voce, ALLOY), (johnson_cook, JC)])
def test_the_cap_ends_the_rise_with_the_rate(model, values):
    free, capped = model.row(values), model.row({**values, "max_rate_factor": 1.1})
    for rate in (0.0, 5.0, 10.0, 1e3):  # up to 1 + 0.02 ln 100 = 1.092: the same bits
        state = (0.1, rate, 400.0, 0.0, 2700.0)
        assert model.flow_stress(*state, capped) == model.flow_stress(*state, free)
    slow, fast, fastest = (model.flow_stress(0.1, rate, 400.0, 0.0, 2700.0, capped) for rate in (0.0, 1e4, 1e12))
    assert fast == fastest == pytest.approx(1.1 * slow, rel=1e-14)
    assert model.flow_stress(0.1, 1e4, 400.0, 0.0, 2700.0, free) > fast
    assert math.isnan(model.flow_stress(0.1, math.nan, 400.0, 0.0, 2700.0, capped))


@pytest.mark.parametrize(("model", "values"), [(voce, ALLOY), (johnson_cook, JC)])
def test_a_cap_below_one_is_refused(model, values):
    with pytest.raises(ValueError, match=r"max_rate_factor = 0\.9: must be at least 1"):
        model.row({**values, "max_rate_factor": 0.9})


@pytest.mark.parametrize("name", ["saturation", "hardening_rate", "rate_coefficient"])
def test_negative_constants_are_refused(name):
    with pytest.raises(ValueError, match=f"{name} = -1: must be non-negative"):
        voce.row({**ALLOY, name: -1.0})
