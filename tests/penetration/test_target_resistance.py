"""Resistance of a target: the five forms, their limits, and the table of the review."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.penetration import target_resistance as forms
from hydro2d.penetration.model import InputError

#: the armour-like steel of Anderson (2017), Table 2
STEEL = {"strength": 1.0e9, "youngs_modulus": 200.0e9}

yield_stress = st.floats(1e7, 5e9)
stiffness = st.floats(20.0, 1000.0)


def rounded(pressure: float) -> float:
    """GPa with the two decimals of the printed table."""
    return round(pressure / 1e9, 2)


def test_incompressible_forms_give_the_table():
    assert rounded(forms.spherical_incompressible(**STEEL)) == 3.93
    assert rounded(forms.cylindrical_incompressible(**STEEL)) == 3.32


def test_compressible_forms_give_the_table_with_a_third_where_it_prints_0_3():
    assert rounded(forms.spherical_compressible(**STEEL, poisson_ratio=1.0 / 3.0)) == 3.74
    assert rounded(forms.cylindrical_compressible(**STEEL, poisson_ratio=1.0 / 3.0)) == 3.15
    assert rounded(forms.spherical_compressible(**STEEL, poisson_ratio=0.3)) == 3.70
    assert rounded(forms.cylindrical_compressible(**STEEL, poisson_ratio=0.3)) == 3.12


def test_the_solenoidal_form_does_not_give_the_table():
    """5.40 GPa where 5.44 is printed, with either way of writing the argument of the logarithm."""
    assert forms.solenoidal(**STEEL) == pytest.approx(5.404393e9, rel=1e-6)
    with_rounded_factor = 1.0e9 * (2.0 / 3.0 + math.log(0.57 * 200.0))
    assert with_rounded_factor == pytest.approx(5.402865e9, rel=1e-6)
    assert 2.0 / (4.0 - math.exp(-0.7)) == pytest.approx(0.57, abs=0.005)


@given(yield_stress, stiffness)
def test_a_poisson_ratio_of_one_half_is_the_incompressible_solid(strength, ratio):
    values = {"strength": strength, "youngs_modulus": ratio * strength}
    spherical, cylindrical = forms.spherical_incompressible(**values), forms.cylindrical_incompressible(**values)
    assert forms.spherical_compressible(**values, poisson_ratio=0.5) == pytest.approx(spherical, rel=1e-12)
    assert forms.cylindrical_compressible(**values, poisson_ratio=0.5) == pytest.approx(cylindrical, rel=1e-12)


@pytest.mark.parametrize("name", forms.FORMS)
def test_a_chosen_form_is_used(name):
    values = {"target_strength": 1e9, "target_youngs_modulus": 2e11, "target_poisson_ratio": 0.3, "target_dynamic_factor": 0.7}
    resistance = forms.resistance_of(target_resistance=None, target_resistance_form=name, **values)
    assert resistance == forms.evaluate(0.0, **values)[name.replace("-", "_")]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "solenoidal needs target.strength, target.youngs_modulus"),
        ({"target_strength": 1e9, "target_youngs_modulus": 2e11, "target_resistance_form": "spherical-compressible"},
         "spherical-compressible needs target.poisson_ratio"),
        ({"target_strength": 1e9, "target_youngs_modulus": 1e8}, "is not small"),
    ],
)
def test_missing_inputs_of_a_form_are_named(values, message):
    with pytest.raises(InputError, match=message):
        forms.resistance_of(target_resistance=None, **values)


@pytest.mark.parametrize("bad", [{"strength": -1.0}, {"youngs_modulus": 0.0}, {"strength": math.nan}])
def test_impossible_values_are_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        forms.solenoidal(**{**STEEL, **bad})
