"""The law of Preston, Tonks and Wallace against an independent open code, its own equations, and its limits."""

import math

import numpy as np
import pytest
from scipy.special import erf

from strength import preston_tonks_wallace as ptw
from strength.layout import SHEAR, YIELD

#: Preston, Tonks & Wallace (2003): tantalum by way of Uintah's PTWPlasticTa.xml, copper by way of the tests of lanl/impala
TANTALUM = {"shear_modulus": 72.2e9, "modulus_softening": 0.23, "theta": 0.02, "p": 0.0, "s0": 0.012, "s_inf": 0.00325,
            "kappa": 0.6, "gamma": 4e-5, "y0": 0.01, "y_inf": 0.00125, "y1": 0.012, "y2": 0.4, "beta": 0.23,
            "molar_mass": 0.180948, "melt_temperature": 3290.0, "melt_exponent": 1.3, "grueneisen": 1.67,
            "reference_density": 16690.0}
COPPER = {"shear_modulus": 51.8e9, "modulus_softening": 0.2, "theta": 0.025, "p": 2.0, "s0": 0.0085, "s_inf": 0.00055,
          "kappa": 0.11, "gamma": 1e-5, "y0": 0.0001, "y_inf": 0.0001, "y1": 0.094, "y2": 0.575, "beta": 0.25,
          "molar_mass": 0.063546, "melt_temperature": 1357.0, "melt_exponent": 1.5, "grueneisen": 2.02,
          "reference_density": 8930.0}
METALS = {"Ta": TANTALUM, "Cu": COPPER, "Cu, nearly Voce": COPPER | {"p": 0.01}}


def flow(values, ep, rate, T, p=0.0):
    return ptw.flow_stress(ep, rate, T, p, values["reference_density"], ptw.row(values))


@pytest.mark.parametrize(("metal", "ep", "rate", "T", "MPa"), [
    ("Ta", 0.0, 1e-3, 300.0, 228.907126), ("Ta", 0.1, 1e3, 300.0, 770.726242), ("Ta", 0.3, 4e3, 300.0, 930.694836),
    ("Ta", 0.3, 1e5, 600.0, 709.282747), ("Ta", 1.0, 1e6, 1000.0, 619.117927), ("Ta", 0.2, 1e8, 300.0, 1587.324461),
    ("Ta", 0.2, 1e10, 300.0, 3951.538491), ("Cu", 0.0, 1e-3, 300.0, 9.901931), ("Cu", 0.1, 1e3, 300.0, 193.780181),
    ("Cu", 0.3, 4e3, 300.0, 388.216792), ("Cu", 0.3, 1e5, 600.0, 435.341805), ("Cu", 1.0, 1e6, 1000.0, 481.255531),
    ("Cu", 0.2, 1e8, 300.0, 880.948367), ("Cu", 0.2, 1e10, 300.0, 2785.803340)])
def test_an_independent_code_gives_the_same(metal, ep, rate, T, MPa):
    """Numbers of `PTW_Yield_Stress` of lanl/impala with these constants; its Avogadro number has four digits."""
    assert flow(METALS[metal], ep, rate, T) == pytest.approx(1e6 * MPa, rel=3e-6)


def written_out(v, ep, rate, T):
    """The equations of the page, one by one, with library functions and an atom instead of a mole."""
    hot, rho, atom = T / v["melt_temperature"], v["reference_density"], v["molar_mass"] / 6.02214076e23
    G = v["shear_modulus"] * (1 - v["modulus_softening"] * hot)
    x = max(rate, 1e-3) / (v["gamma"] * 0.5 * (4 * math.pi * rho / (3 * atom)) ** (1 / 3) * (G / rho) ** 0.5)
    activation = erf(max(0.0, -v["kappa"] * hot * math.log(x)))
    drag = v["s0"] * x ** v["beta"]
    ts = max(v["s0"] - (v["s0"] - v["s_inf"]) * activation, drag)
    ty = max(v["y0"] - (v["y0"] - v["y_inf"]) * activation, min(v["y1"] * x ** v["y2"], drag))
    if ts - ty < 1e-14:
        return 2 * G * ts
    if v["p"] == 0.0:
        return 2 * G * (ts - (ts - ty) * math.exp(-v["theta"] * ep / (ts - ty)))
    q, span = v["p"] * (ts - ty) / (v["s0"] - ty), v["s0"] - ty
    rest = -math.expm1(-q) * math.exp(-v["p"] * v["theta"] * ep / (span * math.expm1(q)))
    return 2 * G * (ts + span / v["p"] * math.log1p(-rest))


@pytest.mark.parametrize("metal", METALS)
def test_the_equations_written_out(metal):
    values, random = METALS[metal], np.random.default_rng(2)
    for _ in range(2000):
        ep, rate = 10.0 ** random.uniform(-6.0, 1.0), 10.0 ** random.uniform(-4.0, 12.0)
        T = random.uniform(1.0, 0.999 * values["melt_temperature"])
        assert flow(values, ep, rate, T) == pytest.approx(written_out(values, ep, rate, T), rel=1e-11)


def test_hardening_obeys_its_differential_equation():
    """d t/d ep = theta (exp(q (1 - f)) - 1)/(exp(q) - 1), f = (t - ty)/(ts - ty): the paper's equation 6 before integration."""
    ts, ty, par = 0.007, 0.002, ptw.row(COPPER)
    q = 2.0 * (ts - ty) / (0.0085 - ty)
    for ep in (0.01, 0.1, 0.5):
        low, t, high = (ptw.hardened(each, ts, ty, par) for each in (ep - 1e-5, ep, ep + 1e-5))
        left = 1.0 - (t - ty) / (ts - ty)
        assert (high - low) / 2e-5 == pytest.approx(0.025 * math.expm1(q * left) / math.expm1(q), rel=1e-5)


def test_a_small_p_is_voce():
    values = {**TANTALUM, "p": 1e-4}
    for ep in (0.0, 0.1, 1.0):
        assert flow(values, ep, 1e3, 300.0) == pytest.approx(flow(TANTALUM, ep, 1e3, 300.0), rel=2e-5)


@pytest.mark.parametrize("metal", METALS)
@pytest.mark.parametrize("T", [0.0, 77.0, 300.0, 1000.0])
def test_limits(metal, T):
    values = METALS[metal]
    slowest, slow, fast = (flow(values, 0.2, rate, T) for rate in (0.0, 1e-3, 1e13))
    assert slowest == slow > 0.0
    assert fast == flow(values, 30.0, 1e13, T) < math.inf  # drag alone: no hardening
    assert flow(values, 0.0, 1e3, T) == flow(values, -1e-9, 1e3, T) < flow(values, 1e300, 1e3, T) < fast


def test_pressure_and_density_raise_modulus_and_melting_temperature():
    row = ptw.row({**COPPER, "pressure_coefficient": 2.83e-11})
    free, pressed = ptw.shear_modulus(0.0, 8930.0, 600.0, row), ptw.shear_modulus(3e10, 1.2 * 8930.0, 600.0, row)
    melt = 1357.0 * math.exp(3.0 * (1 - 1 / 1.2)) * 1.2 ** (2 * (2.02 - 1.5 - 1 / 3))
    exact = 51.8e9 * (1 + 2.83e-11 * 3e10 / 1.2 ** (1 / 3)) * (1 - 0.2 * 600 / melt)
    assert pressed == pytest.approx(exact, rel=1e-12)
    assert free == pytest.approx(51.8e9 * (1 - 0.2 * 600 / 1357), rel=1e-12)
    for T in (1357.0, 5e4):
        assert ptw.shear_modulus(0.0, 8930.0, T, row) == ptw.flow_stress(0.1, 1e3, T, 0.0, 8930.0, row) == 0.0
    assert ptw.flow_stress(0.1, 1e3, 1400.0, 3e10, 1.2 * 8930.0, row) > 0.0


def test_a_nan_stays_one():
    row = ptw.row(COPPER)
    for state in ((math.nan, 1e3, 300.0, 0.0), (0.1, math.nan, 300.0, 0.0), (0.1, 1e3, math.nan, 0.0)):
        assert math.isnan(ptw.flow_stress(*state, 8930.0, row))
    assert math.isnan(ptw.shear_modulus(math.nan, 8930.0, 300.0, ptw.row({**COPPER, "pressure_coefficient": 2.83e-11})))


def test_the_row_at_rest():
    row = ptw.row(TANTALUM)
    assert row[SHEAR] == pytest.approx(72.2e9 * (1 - 0.23 * 298 / 3290), rel=1e-14)
    assert row[YIELD] == flow(TANTALUM, 0.0, 0.0, 298.0)


@pytest.mark.parametrize(("changed", "words"), [
    ({"s_inf": 0.02}, "s_inf = 0.02 is above s0 = 0.0085: must not be"), ({"y0": 0.01}, "y0 = 0.01 is above s0"),
    ({"y1": 0.001}, "s0 = 0.0085 is above y1 = 0.001"), ({"beta": 0.6}, "beta = 0.6 is above y2"),
    ({"gamma": 0.0}, "gamma = 0: must be positive"), ({"modulus_softening": 1.0}, "at least 0 and below 1")])
def test_refused(changed, words):
    with pytest.raises(ValueError, match=words):
        ptw.row({**COPPER, **changed})
