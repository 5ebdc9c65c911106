"""One body in a cell that a surface cuts: its strain across the surface, and void that closes or pulls."""

from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import traction
from hydro2d.physics.traction import FILM, LEAST_LEFT, MOST_GROWTH, SURE, WIDE
from tests.physics.continuity import changes_in_proportion, largest_jump

pull_left = traction.pull_left.py_func
half_pressure = traction.half_pressure.py_func
strain_across = traction.strain_across.py_func
film_heat = traction.film_heat.py_func
gas_growth = traction.gas_growth.py_func
gas_work = traction.gas_work.py_func


# ------------------------------------------------------------------------------------------- pressure at half the step


def test_a_tension_is_what_is_left_of_it():
    assert half_pressure(0.0, 1.0, 0.02, 0.0, 1.0) == -0.02
    assert half_pressure(0.0, 1.0, 0.02, 0.0, 0.25) == -0.005
    assert half_pressure(-0.01, 1.0, 0.02, 0.5, 0.5) == pytest.approx(-0.015)


@pytest.mark.parametrize("p", [-0.01, 0.0, 1e-12, SURE, 0.03, WIDE])
def test_the_pressure_at_half_the_step_does_not_jump_with_void(p):
    """Through p = K void, SURE and WIDE, with the pull that a crack of this width has."""
    for void in {0.0, SURE, WIDE, max(p, 0.0)}:
        changes_in_proportion(lambda void: half_pressure(p, 1.0, 0.0, void, 0.3), void, 1.0)
        changes_in_proportion(lambda void: half_pressure(p, 1.0, 0.0, void, pull_left(void, 0.2)), void, 3.0)
    assert largest_jump(lambda void: half_pressure(p, 1.0, 0.0, void, 0.3), 0.0, 0.1) < 1e-11


def test_wide_void_lets_go_of_a_pressure_without_a_jump():
    """Bodies under more pressure than void takes: the rest stays up to WIDE, half of it half way on, none at twice WIDE."""
    def left(void):
        return half_pressure(4.0 * WIDE, 1.0, 0.0, void, 0.0)

    assert left(WIDE) == pytest.approx(3.0 * WIDE)
    assert left(1.5 * WIDE) == pytest.approx(0.5 * 2.5 * WIDE)
    assert left(2.0 * WIDE) == left(0.9) == 0.0
    for void in (WIDE, 1.5 * WIDE, 2.0 * WIDE):
        changes_in_proportion(left, void, 6.0)
    assert largest_jump(left, 0.0, 3.0 * WIDE) < 1e-11


# -------------------------------------------------------------------------------------------- strain across the surface

#: bulk and shear modulus, yield stress (Pa), like steel's
K, G, Y = 160e9, 80e9, 1e9
RIGID = 1e15  # no flow


def stressed(e: float, flow: float, size: float, along: float) -> float:
    """n . s . n of a deviator after the strain e across the surface, returned to the yield surface."""
    x = 2.0 * G * e
    norm = sqrt(max(1.5 * (size + 2.0 * x * along + 2.0 / 3.0 * x * x), 0.0))
    return (along + 2.0 / 3.0 * x) * (flow / norm if norm > flow else 1.0)


@pytest.mark.parametrize("target", [0.0, 2e8, -3e8])
@pytest.mark.parametrize("beside", [0.0, 1e-3, -2e-3])
def test_an_elastic_body_strains_until_its_normal_stress_is_there(beside, target):
    p, along, size = 4e8, -1e8, 5e16
    e, grown, _ = strain_across(p, target, K, G, RIGID, size, along, beside, 1.0)
    assert e == pytest.approx((p - along - target - K * beside) / (K + 4.0 / 3.0 * G), rel=1e-12)
    assert grown == pytest.approx(beside + e)
    assert p - K * grown - (along + 4.0 / 3.0 * G * e) == pytest.approx(target, abs=1e-3)


@given(st.floats(-1e-2, 1e-2), st.floats(-1.0, 1.0), st.floats(1.0, 3.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_a_plastic_body_meets_the_traction(beside, share, beyond, p, target):
    """Any deviator on the yield surface or strained beyond it, with any part of it along the normal."""
    size = 2.0 / 3.0 * (beyond * Y) ** 2
    along = share * sqrt(2.0 / 3.0 * size)
    e, grown, _ = strain_across(p * Y, target * Y, K, G, Y, size, along, beside, 1.0)
    assert grown == pytest.approx(beside + e)
    assert p * Y - K * (beside + e) - stressed(e, Y, size, along) == pytest.approx(target * Y, abs=1e-6 * Y)


@pytest.mark.parametrize("weight", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("flow", [0.0, 0.05, 0.1, RIGID])
@pytest.mark.parametrize(("size", "along"), [(0.0, 0.0), (0.06, -0.1), (0.02, 0.08)])
def test_growth_falls_with_the_pressure_as_stated(size, along, flow, weight):
    """Against differences, in units of the bulk modulus: elastic, flowing and fluid bodies."""
    def grown(target):
        return strain_across(0.03, target, 1.0, 0.5, flow, size, along, 0.01, weight)

    step = 1e-5
    for target in (0.0, 0.02):
        falls = (grown(target - step)[1] - grown(target + step)[1]) / (2.0 * step)
        assert grown(target)[2] == pytest.approx(falls, rel=1e-6)


# ---------------------------------------------------------------------------------------------------------------- a gas


def test_a_gas_keeps_the_heat_of_its_compression_and_a_film_none():
    assert film_heat(0.0) == film_heat(FILM) == 0.0
    assert (film_heat(1.5 * FILM), film_heat(2.0 * FILM), film_heat(1.0)) == (pytest.approx(0.5), 1.0, 1.0)


@pytest.mark.parametrize("exponent", [1.0, 1.4, 3.0])
def test_a_gas_follows_its_isentrope_and_does_the_work_under_it(exponent):
    for size in (0.05, 0.5, 1.0, 1.05):
        growth, slope = gas_growth(2e5, 2e5 * size**-exponent, exponent)
        assert growth == pytest.approx(size - 1.0, abs=1e-14)
        step = 1e-3
        less, _ = gas_growth(2e5, 2e5 * size**-exponent + step, exponent)
        assert slope == pytest.approx((growth - less) / step, rel=1e-4)
        v = np.linspace(1.0, size, 100001)
        assert gas_work(2e5, growth, exponent) == pytest.approx(np.trapezoid(2e5 * v**-exponent, v), rel=1e-7, abs=1e-8)


def test_a_step_leaves_some_of_a_gas_and_lets_it_grow_by_no_more_than_a_solid():
    assert gas_growth(1e5, 0.0, 1.4)[0] == gas_growth(1e5, -1e9, 1.4)[0] == MOST_GROWTH
    assert gas_growth(1e-10, 1e9, 1.4)[0] == LEAST_LEFT - 1.0


def test_ties_do_work_against_differences_along_r_and_along_z():
    """Rows of two vertices, b below and t above: differences of 1 and 2 along r, 3 and 4 along z, before and after alike."""
    b, t = np.array([0.0, 1.0]), np.array([3.0, 5.0])
    work = traction.tied_work.py_func
    assert work(0, 0.5, 0.0, b, t, b, t) == 0.5 * 0.5 * 2.0 * (1.0 + 4.0)
    assert work(0, 0.0, 0.25, b, t, b, t) == 0.5 * 0.25 * 2.0 * (9.0 + 16.0)
    assert work(0, 0.5, 0.25, b, t, -b, -t) == 0.0  # the middle of the step is at rest
