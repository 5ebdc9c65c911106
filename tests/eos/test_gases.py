"""Ideal and stiffened gas."""

import pytest
from scipy.integrate import solve_ivp

import eos
from eos import ideal_gas, stiffened_gas
from eos.dispatch import sound_speed_squared

AIR = {"reference_density": 1.2, "adiabatic_index": 1.4, "specific_heat": 717.5, "reference_energy": 2.1e5}
WATER = {"reference_density": 1000.0, "sound_speed": 1480.0, "adiabatic_index": 4.4, "specific_heat": 4180.0}


def test_ideal_gas():
    row = ideal_gas.row(AIR)
    p, dpdrho, dpde, T = ideal_gas.evaluate(1.2, 2.1e5, row)
    assert p == pytest.approx(0.4 * 1.2 * 2.1e5, rel=1e-15)
    assert pytest.approx(2.1e5 / 717.5, rel=1e-15) == T
    assert sound_speed_squared(1.2, p, dpdrho, dpde, 0.0) == pytest.approx(1.4 * p / 1.2, rel=1e-14)
    assert (row[eos.RHO0], row[eos.E0]) == (1.2, 2.1e5)


def test_stiffened_gas_in_its_usual_form():
    """p = (gamma - 1) rho (e - q) - gamma p_inf and c^2 = gamma (p + p_inf)/rho."""
    row = stiffened_gas.row(WATER)
    gamma, stiffness = 4.4, 1000.0 * 1480.0**2 / 4.4
    for rho, e in ((1000.0, 0.0), (1300.0, 2e5), (950.0, 1e4)):
        p, dpdrho, dpde, T = stiffened_gas.evaluate(rho, e, row)
        usual = (gamma - 1) * rho * (e + 1480.0**2 / (gamma - 1)) - gamma * stiffness
        assert p == pytest.approx(usual, rel=1e-12, abs=1e-5)
        assert sound_speed_squared(rho, p, dpdrho, dpde, 0.0) == pytest.approx(gamma * (p + stiffness) / rho, rel=1e-12)
    assert stiffened_gas.evaluate(1000.0, 0.0, row)[3] == pytest.approx(298.0, rel=1e-14)


def test_stiffened_gas_heats_along_the_isentrope():
    row = stiffened_gas.row(WATER)

    def slope(rho, e):
        return stiffened_gas.evaluate(rho, e[0], row)[0] / rho**2

    path = solve_ivp(slope, (1000.0, 1200.0), [5e4], rtol=1e-11, atol=1e-6)
    start = stiffened_gas.evaluate(1000.0, 5e4, row)[3]
    end = stiffened_gas.evaluate(1200.0, path.y[0, -1], row)[3]
    assert end / start == pytest.approx(1.2**3.4, rel=1e-8)


@pytest.mark.parametrize(("module", "values"), [(ideal_gas, AIR), (stiffened_gas, WATER)])
def test_adiabatic_index_is_above_one(module, values):
    with pytest.raises(ValueError, match="adiabatic_index = 1.0: must be above 1"):
        module.row({**values, "adiabatic_index": 1.0})
