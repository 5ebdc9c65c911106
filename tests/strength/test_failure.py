"""Damage and fracture at a tensile pressure."""

import math

import pytest

from strength import johnson_cook_damage as damage
from strength import johnson_holmquist_damage as crushing
from strength import tensile_pressure
from strength.layout import JOHNSON_COOK, PLASTIC_STRAIN

GLASS = {"D1": 0.053, "D2": 0.85, "T": 0.15e9, "P_HEL": 2.92e9}
STEEL_4340 = {"D1": 0.05, "D2": 3.44, "D3": -2.12, "D4": 0.002, "D5": 0.61, "melt_temperature": 1793.0}


def test_fracture_strain_by_hand():
    """4340 steel of Johnson & Cook (1985): tension of a third of the von Mises stress, 500/s, T* = 0.2."""
    row = damage.row(STEEL_4340)
    expected = (0.05 + 3.44 * math.exp(-2.12 / 3)) * (1 + 0.002 * math.log(500.0)) * (1 + 0.61 * 0.2)
    assert damage.fracture_strain(500.0, 597.0, -3e8, 9e8, row) == pytest.approx(expected, rel=1e-14)
    assert damage.damage_increment(0.01, 500.0, 597.0, -3e8, 9e8, row) == pytest.approx(0.01 / expected, rel=1e-14)


def test_pressure_delays_and_tension_hastens():
    row = damage.row(STEEL_4340)
    pressed, sheared, pulled = (damage.damage_increment(0.01, 0.0, 298.0, p, 1e9, row) for p in (1e9, 0.0, -1e9))
    assert pressed < sheared < pulled


def test_constant_fracture_strain():
    """All but D1 off: damage is plastic strain over D1, in every state."""
    row = damage.row({"D1": 1.5})
    for p, seq, T, rate in ((-1e9, 1e9, 298.0, 1e5), (1e11, 0.0, 5e3, 0.0), (-1e11, 0.0, 0.0, 1e9)):
        assert damage.damage_increment(0.3, rate, T, p, seq, row) == pytest.approx(0.2, rel=1e-15)


def test_fracture_strain_has_a_lower_bound():
    """Armco iron of Johnson & Cook (1985) has D1 = -2.2: at high triaxiality the fit is negative."""
    values = {"D1": -2.2, "D2": 5.43, "D3": -0.47, "D4": 0.016, "D5": 0.63}
    assert damage.fracture_strain(1.0, 298.0, -3e9, 1e9, damage.row(values)) == 1e-6
    row = damage.row({**values, "minimum_fracture_strain": 0.02})
    assert damage.damage_increment(0.01, 1.0, 298.0, -3e9, 1e9, row) == 0.5


def test_slow_rates_do_not_matter():
    row = damage.row({"D1": 0.5, "D4": 0.1, "reference_rate": 10.0})
    assert damage.fracture_strain(9.0, 298.0, 0.0, 1e9, row) == 0.5
    assert damage.fracture_strain(10.0 * math.e, 298.0, 0.0, 1e9, row) == pytest.approx(0.55, rel=1e-14)


def test_power_of_the_rate():
    """5083-H116 of Clausen & others (2004): 1 + rate/rate0 to a power instead of the logarithm; both together are refused."""
    values = {"D1": 0.0261, "D2": 0.263, "D3": -0.349, "rate_exponent": 0.147}
    expected = (0.0261 + 0.263 * math.exp(-0.349 / 3)) * 1001.0**0.147
    assert damage.fracture_strain(1000.0, 298.0, -3e8, 9e8, damage.row(values)) == pytest.approx(expected, rel=1e-14)
    with pytest.raises(ValueError, match="D4 and rate_exponent"):
        damage.row({**values, "D4": 0.1})


@pytest.mark.parametrize("p", [-1e10, 0.0, 1e10])
def test_unstressed_material_has_a_finite_answer(p):
    assert math.isfinite(damage.damage_increment(0.1, 1e5, 2000.0, p, 0.0, damage.row(STEEL_4340)))


def test_tensile_pressure():
    assert tensile_pressure.fails(-4.6e8, 4.5e8)
    assert not tensile_pressure.fails(-4.5e8, 4.5e8)
    assert not tensile_pressure.fails(1e12, 4.5e8)
    assert not tensile_pressure.fails(-1e300, math.inf)


@pytest.mark.parametrize(("size", "exponent", "longer"), [(0.25e-3, 0.5, 1.0), (0.125e-3, 0.5, 2.0**0.5), (1e-3, 1.0, 0.25)])
def test_the_fracture_strain_depends_on_the_cell(size, exponent, longer):
    """ef ~ (h/h0)^-m, h0 = 0.25 mm; the cell's own increment is the common one times the factor."""
    row = damage.row({"D1": 1.5, "reference_cell": 0.25e-3, "cell_exponent": exponent})
    assert damage.size_factor(size**2, row) == pytest.approx(1.0 / longer, rel=1e-14)
    assert crushing.size_factor(size**2, crushing.row({**GLASS, "reference_cell": 0.25e-3, "cell_exponent": exponent})) \
        == damage.size_factor(size**2, row)


@pytest.mark.parametrize("given", [{}, {"reference_cell": 1e-3}, {"cell_exponent": 0.0}])
def test_without_an_exponent_the_cell_does_not_matter(given):
    """To the last bit: the factor is one."""
    for size in (1e-6, 1e-4, 1.0):
        assert damage.size_factor(size**2, damage.row({"D1": 1.5, **given})) == 1.0


@pytest.mark.parametrize(("given", "said"), [
    ({"cell_exponent": 0.5}, 'cell_exponent needs reference_cell.*such as reference_cell = "0.25 mm"'),
    ({"reference_cell": 1e-3, "cell_exponent": 1.5}, "cell_exponent = 1.5: must be at most 1"),
    ({"reference_cell": 1e-3, "cell_exponent": -0.5}, "cell_exponent = -0.5: must be non-negative"),
    ({"reference_cell": 0.0, "cell_exponent": 0.5}, "reference_cell = 0: must be positive"),
])
def test_sizes_of_cells_that_make_no_sense_are_refused(given, said):
    for model, values in ((damage, {"D1": 1.5}), (crushing, GLASS)):
        with pytest.raises(ValueError, match=said):
            model.row({**values, **given})


@pytest.mark.parametrize(("given", "cause"), [
    ({"D1": 1.5, "reference_rate": 5.0}, PLASTIC_STRAIN), ({"D1": 1.5, "D2": 0.1, "D3": -1.0}, JOHNSON_COOK),
    ({"D1": 1.5, "rate_exponent": 0.02}, JOHNSON_COOK), ({"D1": 1.5, "D5": 0.3, "melt_temperature": 1800.0}, JOHNSON_COOK),
])
def test_a_constant_fracture_strain_is_a_criterion_of_its_own(given, cause):
    assert damage.criterion(damage.row(given)) == cause
