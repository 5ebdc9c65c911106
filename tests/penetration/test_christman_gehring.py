"""Christman-Gehring: a rod less one diameter, and the crater of that diameter."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.penetration import christman_gehring as cg
from hydro2d.penetration.model import InputError

ROD = {"rod_density": 7830.0, "rod_diameter": 0.005, "target_density": 2785.0}


@given(st.floats(1.0, 25.0), st.floats(1e-4, 0.05))
def test_depth_is_that_of_the_primary_phase_and_the_crater(aspect, crater):
    result = cg.depth(rod_length=0.005 * aspect, crater=crater, **ROD)
    assert result == pytest.approx((0.005 * aspect - 0.005) * math.sqrt(7830.0 / 2785.0) + crater, rel=1e-12)
    assert cg.depth(rod_length=0.005, crater=crater, **ROD) == crater


@given(st.floats(2000.0, 6700.0), st.floats(1e8, 1e10), st.floats(1e-3, 0.1))
def test_the_crater_scales_with_the_rod_and_with_energy_over_hardness(velocity, hardness, diameter):
    values = {**ROD, "rod_diameter": diameter}
    crater = cg.crater_depth(velocity, hardness=hardness, **values)
    wider = {**values, "rod_diameter": 2.0 * diameter}
    assert cg.crater_depth(velocity, hardness=hardness, **wider) == pytest.approx(2.0 * crater)
    assert cg.crater_depth(velocity, hardness=8.0 * hardness, **values) == pytest.approx(0.5 * crater)
    assert cg.crater_depth(math.sqrt(8.0) * velocity, hardness=hardness, **values) == pytest.approx(2.0 * crater)


def test_the_printed_coefficient_in_consistent_units_makes_craters_too_small():
    """A hemisphere as deep as eq. (16) says would take 217 B_max per unit of its volume, for equal densities."""
    values = {"rod_density": 2700.0, "rod_diameter": 0.01, "target_density": 2700.0}
    depth = cg.crater_depth(5000.0, hardness=0.5e9, **values)
    energy = 0.5 * 0.25 * math.pi * 2700.0 * 0.01**3 * 5000.0**2
    assert energy / (2.0 / 3.0 * math.pi * depth**3) / 0.5e9 == pytest.approx(217.3, rel=1e-3)
    assert depth < 0.01


def test_the_model_prefers_a_measured_crater():
    values = {"rod.density": 7830.0, "rod.length": 0.05, "rod.diameter": 0.005, "target.density": 2785.0}
    result = cg.MODEL(4000.0, {**values, "crater.depth_one": 0.012})
    assert result["crater_depth"] == 0.012
    assert result["depth"] == pytest.approx(result["primary_depth"] + 0.012)
    assert result["primary_depth"] == pytest.approx(0.045 * math.sqrt(7830.0 / 2785.0))
    assert cg.MODEL(4000.0, {**values, "target.hardness": 1.5e9})["crater_depth"] == pytest.approx(
        cg.crater_depth(4000.0, hardness=1.5e9, **ROD))
    with pytest.raises(InputError, match="needs target.hardness"):
        cg.MODEL(4000.0, values)


def test_a_rod_shorter_than_wide_is_refused():
    with pytest.raises(InputError, match="must not be less than rod.diameter"):
        cg.depth(rod_length=0.004, crater=0.01, **ROD)
    with pytest.raises(InputError, match="velocity"):
        cg.crater_depth(0.0, hardness=1e9, **ROD)
