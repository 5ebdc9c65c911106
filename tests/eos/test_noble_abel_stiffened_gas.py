"""Noble-Abel stiffened gas, against the relations of Le Metayer & Saurel (2016) in their own form."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from eos import noble_abel_stiffened_gas as noble_abel
from eos import stiffened_gas
from eos.dispatch import sound_speed_squared

#: their constants for water: exponent, p_inf (Pa), b (m^3/kg), cv (J/kg/K); and the state at 298.15 K and no pressure
GAMMA, STIFFNESS, COVOLUME, HEAT, T0 = 1.19, 621.78e6, 6.7212e-4, 3610.0, 298.15
V0 = (GAMMA - 1.0) * HEAT * T0 / STIFFNESS + COVOLUME
C0 = np.sqrt(GAMMA * STIFFNESS * V0**2 / (V0 - COVOLUME))
WATER = {"reference_density": 1.0 / V0, "sound_speed": C0, "adiabatic_index": GAMMA, "covolume": COVOLUME,
         "specific_heat": HEAT, "reference_temperature": T0}
ROW = noble_abel.row(WATER)
#: the energy of their form at which p(V0) = 0
Q = -GAMMA * STIFFNESS * (V0 - COVOLUME) / (GAMMA - 1.0)

STATES = [(x / V0, e) for x in (0.9, 1.0, 1.05, 1.3) for e in (0.0, 2e5, 1e6)]


def square(rho: float, e: float) -> float:
    p, dpdrho, dpde, _ = noble_abel.evaluate(rho, e, ROW)
    return sound_speed_squared(rho, p, dpdrho, dpde, 0.0)


def test_water_has_its_density_and_sound_speed():
    assert 1.0 / V0 == pytest.approx(999.0, abs=0.5)
    assert pytest.approx(1501.0, abs=1.0) == C0


@pytest.mark.parametrize(("rho", "e"), STATES)
def test_pressure_temperature_and_sound_speed_are_theirs(rho, e):
    v = 1.0 / rho
    usual = (GAMMA - 1.0) * (e - Q) / (v - COVOLUME) - GAMMA * STIFFNESS
    p, _, _, T = noble_abel.evaluate(rho, e, ROW)
    assert p == pytest.approx(usual, rel=1e-11, abs=1e-5)
    assert pytest.approx((usual + STIFFNESS) * (v - COVOLUME) / ((GAMMA - 1.0) * HEAT), rel=1e-11) == T
    assert square(rho, e) == pytest.approx(GAMMA * (usual + STIFFNESS) * v**2 / (v - COVOLUME), rel=1e-11)


def test_isentrope():
    """(p + p_inf)(v - b)^gamma and T (v - b)^(gamma - 1) are constant on it."""
    start = 1.0 / V0, 1e5
    path = solve_ivp(lambda rho, e: noble_abel.evaluate(rho, e[0], ROW)[0] / rho**2, (start[0], 1.2 / V0), [start[1]],
                     rtol=1e-11, atol=1e-6)
    ends = [(*start, *noble_abel.evaluate(*start, ROW)[::3]),
            (1.2 / V0, path.y[0, -1], *noble_abel.evaluate(1.2 / V0, path.y[0, -1], ROW)[::3])]
    first, last = (((p + STIFFNESS) * (1.0 / rho - COVOLUME) ** GAMMA, T * (1.0 / rho - COVOLUME) ** (GAMMA - 1.0))
                   for rho, _, p, T in ends)
    assert last == pytest.approx(first, rel=1e-8)


@pytest.mark.parametrize("share", [0.99, 0.9, 0.8])
def test_hugoniot(share):
    """From rest: p = gamma p_inf (v0 - v)/[(v - b) - (gamma - 1)(v0 - v)/2], at the energy p (v0 - v)/2."""
    v = share * V0
    p = GAMMA * STIFFNESS * (V0 - v) / ((v - COVOLUME) - 0.5 * (GAMMA - 1.0) * (V0 - v))
    assert noble_abel.evaluate(1.0 / v, 0.5 * p * (V0 - v), ROW)[0] == pytest.approx(p, rel=1e-11)


def test_without_a_covolume_it_is_a_stiffened_gas():
    values = {"reference_density": 1000.0, "sound_speed": 1480.0, "adiabatic_index": 4.4, "specific_heat": 4180.0}
    row, other = noble_abel.row({**values, "covolume": 0.0}), stiffened_gas.row(values)
    for rho, e in ((1000.0, 0.0), (1300.0, 2e5), (950.0, 1e4)):
        assert noble_abel.evaluate(rho, e, row) == pytest.approx(stiffened_gas.evaluate(rho, e, other), rel=1e-13)


@pytest.mark.parametrize(("change", "said"), [({"adiabatic_index": 1.0}, "must be above 1"),
                                              ({"covolume": 1.0 / 999.0}, "the molecules must take less than 0.95")])
def test_impossible_values(change, said):
    with pytest.raises(ValueError, match=said):
        noble_abel.row({**WATER, **change})
