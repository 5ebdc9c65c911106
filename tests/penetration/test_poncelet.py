"""Poncelet's equation: closed forms against its differential equation, limits, and the fit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.penetration import poncelet
from hydro2d.penetration.model import InputError

#: Anderson (2017), Fig. 12: ogival steel rods into 6061-T6 while rigid; density of the steel as for Fig. 10
STEEL = {"rod_density": 7900.0, "a": 1.956e9, "b": 51.8}
#: seven shots of Forrestal & Piekutowski, Int. J. Impact Engng 24 (2000) 57: m/s and mm, 23 g and 7.11 mm of 7810 kg/m^3
VELOCITIES = (496.0, 572.0, 781.0, 821.0, 841.0, 932.0, 967.0)
DEPTHS = np.array((37.6, 48.1, 72.7, 84.3, 91.4, 96.5, 94.4)) / 74.173

speed = st.floats(1.0, 3000.0)
stress = st.floats(1e8, 1e10)
drag = st.floats(0.0, 1e4)


def integrated(velocity, *, rod_density, a, b):
    """P/L and duration over L from rho_p L dv/dt = -(a + b v^2), solved over the velocity."""
    from scipy.integrate import quad

    depth, _ = quad(lambda v: rod_density * v / (a + b * v * v), 0.0, velocity, epsrel=1e-12)
    time, _ = quad(lambda v: rod_density / (a + b * v * v), 0.0, velocity, epsrel=1e-12)
    return depth, time


@pytest.mark.parametrize("b", [0.0, 1e-9, 51.8, 1350.0, 1e5])
@pytest.mark.parametrize("velocity", [10.0, 800.0, 3000.0])
def test_closed_forms_solve_the_equation_of_motion(velocity, b):
    values = {"rod_density": 7900.0, "a": 1.956e9, "b": b}
    depth, time = integrated(velocity, **values)
    assert poncelet.depth_over_length(velocity, **values) == pytest.approx(depth, rel=1e-10)
    assert poncelet.duration(velocity, rod_length=2.0, **values) == pytest.approx(2.0 * time, rel=1e-10)


def test_the_fit_of_the_review_and_its_small_velocity_limit():
    """Constants of Fig. 12; drag so small that eq. (5) is within 5 % up to 1959 m/s."""
    assert poncelet.depth_over_length(1000.0, **STEEL) == pytest.approx(1.99315, rel=1e-5)
    limit = poncelet.small_velocity_limit(a=STEEL["a"], b=STEEL["b"])
    assert limit == pytest.approx(1959.07, rel=1e-5)
    exact = poncelet.depth_over_length(limit, **STEEL)
    assert poncelet.depth_at_small_velocity(limit, rod_density=7900.0, a=STEEL["a"]) == pytest.approx(1.05 * exact, rel=1e-9)
    assert poncelet.small_velocity_limit(a=1e9, b=0.0) == math.inf


@given(speed, stress, drag)
def test_energy_never_grows_and_ends_at_the_final_depth(velocity, a, b):
    values = {"rod_density": 7850.0, "a": a, "b": b}
    final = poncelet.depth_over_length(velocity, **values)
    left = [poncelet.velocity_at(share * final, velocity, rod_length=1.0, **values) for share in np.linspace(0.0, 1.0, 21)]
    assert left[0] == pytest.approx(velocity, rel=1e-9)
    assert all(later <= earlier * (1.0 + 1e-12) for earlier, later in zip(left, left[1:], strict=False))
    assert left[-1] <= 1e-5 * velocity
    assert poncelet.velocity_at(2.0 * final, velocity, rod_length=1.0, **values) == 0.0


def test_fit_finds_the_constants_of_exact_shots():
    velocities = [300.0, 600.0, 900.0, 1200.0, 1500.0]
    depths = [poncelet.depth_over_length(velocity, **STEEL) for velocity in velocities]
    both = poncelet.fit(velocities, depths, rod_density=7900.0)
    assert (both.a, both.b) == pytest.approx((1.956e9, 51.8), rel=1e-5)
    assert both.standard_error < 1e-8
    assert both.shots == 5
    one = poncelet.fit(velocities, depths, rod_density=7900.0, b=51.8)
    assert (one.a, one.b) == pytest.approx((1.956e9, 51.8), rel=1e-8)


def test_fit_of_measured_shots_is_a_minimum():
    fitted = poncelet.fit(VELOCITIES, DEPTHS, rod_density=7810.0)
    assert (fitted.a, fitted.b) == pytest.approx((1.4299e9, 3393.0), rel=1e-3)

    def squares(a, b):
        return sum((poncelet.depth_over_length(v, rod_density=7810.0, a=a, b=b) - d) ** 2
                   for v, d in zip(VELOCITIES, DEPTHS, strict=True))

    best = squares(fitted.a, fitted.b)
    assert fitted.standard_error == pytest.approx(math.sqrt(best / 5.0), rel=1e-9)
    for factor in (0.98, 1.02):
        assert squares(factor * fitted.a, fitted.b) > best
        assert squares(fitted.a, factor * fitted.b) > best


def test_fit_keeps_drag_from_being_negative():
    fitted = poncelet.fit([300.0, 600.0, 900.0], [0.1, 0.5, 1.4], rod_density=7850.0)
    assert fitted.b >= 0.0
    assert fitted.a > 0.0


@pytest.mark.parametrize(
    ("velocities", "depths"),
    [([500.0], [1.0]), ([500.0, 500.0], [1.0, 1.1]), ([500.0, 600.0], [1.0]), ([500.0, 600.0], [1.0, 0.0]),
     ([500.0, math.nan], [1.0, 2.0])],
)
def test_shots_that_no_fit_can_take_are_refused(velocities, depths):
    with pytest.raises(InputError, match="a fit needs"):
        poncelet.fit(velocities, depths, rod_density=7850.0)


@pytest.mark.parametrize("bad", [{"a": 0.0}, {"b": -1.0}, {"rod_density": -1.0}])
def test_impossible_values_are_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        poncelet.depth_over_length(500.0, **{**STEEL, **bad})
