"""Flow stresses against their published equations and hand-made numbers."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from strength import elastic_plastic, johnson_cook, melting, power_law, steinberg_guinan, zerilli_armstrong
from strength.layout import YIELD

AL7039 = johnson_cook.row(
    {
        "shear_modulus": 27.6e9,
        "yield_stress": 337e6,
        "hardening": 343e6,
        "hardening_exponent": 0.41,
        "rate_coefficient": 0.01,
        "melt_temperature": 877.0,
    }
)
COPPER = johnson_cook.row(
    {
        "shear_modulus": 46e9,
        "yield_stress": 90e6,
        "hardening": 292e6,
        "hardening_exponent": 0.31,
        "rate_coefficient": 0.025,
        "thermal_exponent": 1.09,
        "melt_temperature": 1356.0,
    }
)
#: strain, isothermal and adiabatic flow stress (MPa), temperature reached (K): the equation integrated with 90 % of the
#: plastic work as heat, from 298 K
CURVES = {
    "7039 at 1e3/s": (
        AL7039,
        1e3,
        2770.0 * 875.0,
        [
            (0.05, 467.64866050301833, 461.1497169268697, 306.04640031801347),
            (0.1, 502.93950030675944, 488.2734780970268, 314.8839927153383),
            (0.5, 636.261310095171, 532.3590948882812, 392.5513763767761),
            (1.0, 726.9727358970786, 488.3575203574828, 488.04593016399684),
            (1.5, 793.2919479250917, 417.45748828555605, 572.3102998845001),
        ],
    ),
    "7039 at 1e5/s": (
        AL7039,
        1e5,
        2770.0 * 875.0,
        [
            (0.1, 524.6041773559068, 508.6575476215984, 315.60012408345847),
            (1.0, 758.2878931617976, 500.7387231141563, 494.65482042157043),
        ],
    ),
    "OFHC copper at 1e3/s": (
        COPPER,
        1e3,
        8960.0 * 383.0,
        [
            (0.05, 240.82700274987198, 240.46266190995212, 300.7362052501707),
            (0.5, 381.7580553253235, 370.7418817820393, 338.9132672197613),
            (2.0, 530.0513588430267, 440.713846584513, 504.5621359990783),
        ],
    ),
}


@pytest.mark.parametrize("name", CURVES)
def test_johnson_cook_curves(name):
    row, rate, heat_capacity, points = CURVES[name]

    def heating(ep, T):
        return 0.9 * johnson_cook.flow_stress(ep, rate, T[0], 0.0, 0.0, row) / heat_capacity

    strains = [point[0] for point in points]
    path = solve_ivp(heating, (0.0, strains[-1]), [298.0], t_eval=strains, rtol=1e-9, atol=1e-6)
    for (ep, isothermal, adiabatic, warm), T in zip(points, path.y[0], strict=True):
        assert johnson_cook.flow_stress(ep, rate, 298.0, 0.0, 0.0, row) == pytest.approx(1e6 * isothermal, rel=1e-12)
        assert pytest.approx(warm, abs=1e-3) == T
        assert johnson_cook.flow_stress(ep, rate, T, 0.0, 0.0, row) == pytest.approx(1e6 * adiabatic, rel=1e-5)


def test_johnson_cook_factors_multiply_the_whole_bracket():
    virgin = johnson_cook.flow_stress(0.0, 1e4, 587.5, 0.0, 0.0, AL7039)
    assert virgin == pytest.approx(337e6 * (1 + 0.01 * math.log(1e4)) * 0.5, rel=1e-14)


@pytest.mark.parametrize("rate", [0.0, 1e-9, 0.5, 1.0])
def test_johnson_cook_does_not_soften_below_the_reference_rate(rate):
    assert johnson_cook.flow_stress(0.0, rate, 298.0, 0.0, 0.0, AL7039) == 337e6


@pytest.mark.parametrize("T", [0.0, 100.0, 298.0])
def test_johnson_cook_does_not_harden_below_the_reference_temperature(T):
    assert johnson_cook.flow_stress(0.0, 0.0, T, 0.0, 0.0, AL7039) == 337e6


def test_melt_must_lie_above_the_reference():
    with pytest.raises(ValueError, match="melt_temperature must be above"):
        johnson_cook.row({"shear_modulus": 1e9, "yield_stress": 1e8, "melt_temperature": 200.0})


def test_elastic_plastic():
    row = elastic_plastic.row(
        {
            "shear_modulus": 27e9,
            "yield_stress": 3e8,
            "hardening_modulus": 1e9,
            "max_yield_stress": 4e8,
            "melt_temperature": 898.0,
        }
    )
    assert elastic_plastic.flow_stress(0.05, 1e9, 298.0, 0.0, 0.0, row) == pytest.approx(3.5e8, rel=1e-15)
    assert elastic_plastic.flow_stress(1.0, 0.0, 298.0, 0.0, 0.0, row) == 4e8
    assert elastic_plastic.flow_stress(1.0, 0.0, 448.0, 0.0, 0.0, row) == pytest.approx(3e8, rel=1e-15)
    with pytest.raises(ValueError, match="max_yield_stress is below"):
        elastic_plastic.row({"shear_modulus": 1e9, "yield_stress": 2e8, "max_yield_stress": 1e8})


# power law

AL5083 = {"youngs_modulus": 70.3e9, "poisson_ratio": 1 / 3, "yield_stress": 276e6, "hardening_exponent": 0.084}


@pytest.mark.parametrize(
    ("strain", "stress"), [(0.01, 298.54992503888235), (0.1, 362.25715034933455), (1.0, 439.5587872350975)]
)
def test_power_law_at_a_total_strain(strain, stress):
    """Y0 (E eps/Y0)^n of 5083-H131 at the total strain eps = ep + Y/E, MPa."""
    row = power_law.row(AL5083)
    ep = strain - 1e6 * stress / 70.3e9
    assert power_law.flow_stress(ep, 0.0, 0.0, 0.0, 0.0, row) == pytest.approx(1e6 * stress, rel=1e-12)


def test_power_law_starts_at_yield():
    row = power_law.row(AL5083)
    assert power_law.flow_stress(0.0, 0.0, 0.0, 0.0, 0.0, row) == 276e6
    assert power_law.shear_modulus(0.0, 0.0, 0.0, row) == pytest.approx(70.3e9 * 3 / 8, rel=1e-15)


@settings(max_examples=500)
@given(exponent=st.floats(0.0, 0.95), magnitude=st.floats(-15.0, 6.0))
def test_power_law_is_solved(exponent, magnitude):
    a = 10.0**magnitude
    x = power_law.hardening(a, exponent)
    assert x >= 1.0
    assert x == pytest.approx((a + x) ** exponent, rel=1e-12)


@pytest.mark.parametrize(("name", "value"), [("hardening_exponent", 1.0), ("poisson_ratio", 0.6)])
def test_power_law_limits(name, value):
    with pytest.raises(ValueError, match=name):
        power_law.row({**AL5083, name: value})


# Steinberg-Guinan

TUNGSTEN = {
    "shear_modulus": 145e9,
    "yield_stress": 1.87e9,
    "max_yield_stress": 4.0e9,
    "hardening_coefficient": 7.7,
    "hardening_exponent": 0.13,
    "pressure_coefficient": 1.03e-11,
    "temperature_coefficient": 1.52e-4,
    "melt_temperature": 2263.0,
    "melt_exponent": 1.3,
    "grueneisen": 1.67,
    "reference_density": 18167.0,
}


def test_steinberg_guinan_by_hand():
    row = steinberg_guinan.row(TUNGSTEN)
    p, T, eta, ep = 2e10, 700.0, 1.06, 0.5
    relative = 1 + 1.03e-11 * p / eta ** (1 / 3) - 1.52e-4 * 400.0
    G = steinberg_guinan.shear_modulus(p, eta * 18167.0, T, row)
    assert pytest.approx(145e9 * relative, rel=1e-14) == G
    Y = steinberg_guinan.flow_stress(ep, 1e5, T, p, eta * 18167.0, row)
    assert pytest.approx(1.87e9 * (1 + 7.7 * ep) ** 0.13 * relative, rel=1e-14) == Y


def test_steinberg_guinan_hardening_ends_at_its_bound():
    row = steinberg_guinan.row(TUNGSTEN)
    assert steinberg_guinan.flow_stress(1e4, 0.0, 300.0, 0.0, 18167.0, row) == pytest.approx(4.0e9, rel=1e-15)


def test_steinberg_guinan_initial_strain():
    row = steinberg_guinan.row({**TUNGSTEN, "initial_strain": 0.2})
    assert steinberg_guinan.flow_stress(0.0, 0.0, 300.0, 0.0, 18167.0, row) == pytest.approx(
        1.87e9 * (1 + 7.7 * 0.2) ** 0.13, rel=1e-14
    )


def test_steinberg_guinan_modulus_does_not_turn_negative():
    row = steinberg_guinan.row({**TUNGSTEN, "melt_temperature": math.inf})
    assert steinberg_guinan.shear_modulus(0.0, 18167.0, 1e5, row) == 0.0
    assert steinberg_guinan.flow_stress(0.1, 0.0, 1e5, 0.0, 18167.0, row) == 0.0


@settings(max_examples=400)
@given(eta=st.floats(0.3, 4.0), ratio=st.floats(0.2, 3.0), gamma=st.floats(0.5, 3.0), a=st.floats(0.0, 2.5))
def test_melting_curve(eta, ratio, gamma, a):
    """Equation 8, and no strength from that temperature on."""
    row = steinberg_guinan.row({**TUNGSTEN, "grueneisen": gamma, "melt_exponent": a, "temperature_coefficient": 0.0})
    melt = 2263.0 * math.exp(2 * a * (1 - 1 / eta)) * eta ** (2 * (gamma - a - 1 / 3))
    line = (row[slot] for slot in (steinberg_guinan.MELT, steinberg_guinan.TWO_A, steinberg_guinan.K))
    assert melting.melting_temperature(eta, *line) == pytest.approx(melt, rel=1e-12)
    T = ratio * melt
    if abs(ratio - 1.0) > 1e-9:
        assert (steinberg_guinan.shear_modulus(0.0, eta * 18167.0, T, row) > 0.0) == (ratio < 1.0)


def test_melting_at_rest_is_exact():
    row = steinberg_guinan.row(TUNGSTEN)
    assert steinberg_guinan.shear_modulus(0.0, 18167.0, math.nextafter(2263.0, 0.0), row) > 0.0
    assert steinberg_guinan.shear_modulus(0.0, 18167.0, 2263.0, row) == 0.0


def test_compression_hardens_and_stretching_softens():
    row = steinberg_guinan.row(TUNGSTEN)
    rest, pressed, pulled = (steinberg_guinan.shear_modulus(p, 18167.0, 300.0, row) for p in (0.0, 1e10, -3e9))
    assert pulled < rest < pressed


#: Armco iron of Zerilli and Armstrong (1987), constants recalled
IRON = zerilli_armstrong.row(
    {
        "shear_modulus": 80e9, "athermal_stress": 65e6, "thermal_stress": 1033e6, "thermal_softening": 6.98e-3,
        "rate_hardening": 4.15e-4, "hardening": 266e6, "hardening_exponent": 0.289, "melt_temperature": 1809.0,
    }
)


@pytest.mark.parametrize(("ep", "rate", "T", "MPa"), [
    (0.0, 1e3, 300.0, 65 + 1033 * math.exp(-2.094 + 0.1245 * math.log(1e3))),
    (0.5, 1e3, 300.0, 65 + 1033 * math.exp(-2.094 + 0.1245 * math.log(1e3)) + 266 * 0.5**0.289),
    (0.0, 0.0, 300.0, 65 + 1033 * math.exp(-2.094 + 0.1245 * math.log(1e-3))), (0.0, 1e9, 300.0, 65 + 1033),
    (0.3, 1e3, 1809.0, 0.0)])
def test_zerilli_armstrong_by_hand(ep, rate, T, MPa):
    assert zerilli_armstrong.flow_stress(ep, rate, T, 0.0, 0.0, IRON) == pytest.approx(1e6 * MPa, rel=1e-12)


def test_zerilli_armstrong_numbers():
    """The purpose of the constants: iron at 300 K yields at 0.37 GPa at 1e3/s, and a tenfold rate adds some 0.1 GPa."""
    slow, fast = (zerilli_armstrong.flow_stress(0.0, rate, 300.0, 0.0, 0.0, IRON) for rate in (1e3, 1e4))
    assert slow == pytest.approx(0.366e9, rel=3e-3)
    assert fast - slow == pytest.approx(0.1e9, rel=0.05)
    assert IRON[YIELD] == zerilli_armstrong.flow_stress(0.0, 0.0, 298.0, 0.0, 0.0, IRON)
