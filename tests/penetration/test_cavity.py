"""Dynamic spherical cavity expansion: printed A and B, an independent solution, limits, wrong input."""

import math

import numpy as np
import pytest

from hydro2d.penetration import cavity
from hydro2d.penetration.cavity import Solid, coefficients, expansion, expansion_at_front, quasi_static
from hydro2d.penetration.model import InputError

LUK_6061 = Solid(2710.0, 68.95e9, 0.33, 0.345e9, 0.054)
LUK_4340 = Solid(7850.0, 206.8e9, 0.32, 1.207e9, 0.051)
CHEN_LI_6061 = Solid(2710.0, 68.9e9, 1.0 / 3.0, 0.276e9, 0.051)
CHEN_LI_7075 = Solid(2710.0, 73.1e9, 0.33, 0.448e9, 0.089)
PERFECT = Solid(2710.0, 68.9e9, 1.0 / 3.0, 0.276e9)


@pytest.mark.parametrize(
    ("solid", "printed", "tolerance"),
    [
        (LUK_6061, 4.2448, 2e-4),
        (LUK_6061, 4.2450, 1e-4),  # an independent solution of the same problem
        (LUK_4340, 4.0720, 1e-3),
        (LUK_4340, 4.0749, 1e-4),
        (Solid(7850.0, 206.8e9, 0.30, 1.207e9, 0.051), 4.0569, 1e-4),
        (CHEN_LI_6061, 4.407, 5e-4),
        (CHEN_LI_6061, 4.408, 1e-4),
        (CHEN_LI_7075, 4.418, 1e-3),
    ],
)
def test_quasi_static_coefficients(solid, printed, tolerance):
    assert quasi_static(solid) == pytest.approx(printed, rel=tolerance)


@pytest.mark.parametrize(
    ("solid", "velocity", "printed"),
    [(LUK_6061, 2400.0, 1.0336), (LUK_6061, 2400.0, 1.0338), (LUK_4340, 2400.0, 1.0124), (LUK_4340, 2400.0, 1.0210),
     (CHEN_LI_6061, 1200.0, 1.133), (CHEN_LI_6061, 1200.0, 1.136)],
)
def test_dynamic_coefficients_within_a_percent(solid, velocity, printed):
    """The spread of the points of the fit moves B by more than this; our fit is even in velocity."""
    assert coefficients(solid, velocity).b == pytest.approx(printed, rel=0.01)


@pytest.mark.parametrize(
    ("solid", "velocity", "a", "b"),
    [(LUK_6061, 2400.0, 4.2452, 1.0242), (LUK_4340, 2400.0, 4.0751, 1.0128), (CHEN_LI_6061, 1200.0, 4.4082, 1.1255),
     (CHEN_LI_7075, 1200.0, 4.4218, 1.0947), (LUK_6061, 500.0, 4.2452, 1.1791)],
)
def test_the_numbers_of_the_page(solid, velocity, a, b):
    fitted = coefficients(solid, velocity)
    assert (round(fitted.a, 4), round(fitted.b, 4)) == (a, b)


@pytest.mark.parametrize(
    ("velocity", "similarity", "lagrangian", "front"),
    [(100.0, 1.10877, 1.10863, 500.52), (300.0, 1.37265, 1.37312, 1465.64), (600.0, 2.22655, 2.22833, 2712.07),
     (1000.0, 4.14219, 4.14849, 3852.21)],
)
def test_perfect_plasticity_against_two_independent_solutions(velocity, similarity, lagrangian, front):
    """Stress in GPa from a similarity solution (read off by interpolation) and from a one-dimensional Lagrangian code."""
    solution = expansion(velocity, PERFECT)
    assert solution.stress == pytest.approx(similarity * 1e9, rel=2e-4)
    assert solution.stress == pytest.approx(lagrangian * 1e9, rel=2e-3)
    assert solution.front == pytest.approx(front, rel=2e-4)


@pytest.mark.parametrize(
    ("velocity", "stress"), [(1.2299669260178387, 1.0747121143548412e9), (407.2923925175057, 1.616985763392763e9),
                             (992.0769596563617, 4.095585445706903e9), (1820.2574474770772, 10.525241502469540e9)],
)
def test_the_whole_curve_of_the_independent_solution(velocity, stress):
    """At the velocities for which it was computed the two agree to seven digits."""
    assert expansion(velocity, PERFECT).stress == pytest.approx(stress, rel=2e-7)


def test_the_incompressible_limit():
    """As nu tends to 1/2, A tends to the closed form and B to 3/2."""
    closed = cavity.incompressible_power_law(0.0, 2710.0, 68.9e9, 0.276e9, 0.05) / 0.276e9
    off = [abs(quasi_static(Solid(2710.0, 68.9e9, nu, 0.276e9, 0.05)) / closed - 1.0) for nu in (0.49, 0.499, 0.4999)]
    assert off[0] > off[1] > off[2]
    assert off[2] < 1e-4
    assert coefficients(Solid(2710.0, 68.9e9, 0.4999, 0.276e9), 800.0).b == pytest.approx(1.5, rel=0.01)


@pytest.mark.parametrize("n", [0.0, 0.051, 0.3])
def test_the_power_law_against_plain_quadrature(n):
    """The integral of equation 2 over the strain field, by the trapezoidal rule in the logarithm of 1 - x."""
    ratio = 2.0 * 68.9e9 / (3.0 * 0.276e9)
    s = np.linspace(1e-9, math.log(ratio), 400_001)
    flow = 0.276e9 * (ratio * -np.log1p(-np.exp(-s))) ** n
    by_hand = 2.0 / 3.0 * (0.276e9 + np.trapezoid(flow, s))
    assert cavity.incompressible_power_law(0.0, 2710.0, 68.9e9, 0.276e9, n) == pytest.approx(by_hand, rel=1e-6)


def test_linear_hardening_against_plain_quadrature():
    """Exact in the small-yield limit: 2 pi^2/27 E_t is the integral of the strain over the logarithm of the radius."""
    x = np.linspace(0.0, 1.0, 2_000_001)[1:-1]
    integral = 4.0 / 9.0 * np.sum(-np.log1p(-x) / x) * (x[1] - x[0])
    added = cavity.incompressible_linear(0.0, 1.0, 1e12, 1e6, 1e9) - cavity.incompressible_linear(0.0, 1.0, 1e12, 1e6)
    assert added / 1e9 == pytest.approx(integral, rel=1e-5)


def test_evaluate_at_rest_is_the_quasi_static_stress():
    values = dict(
        target_density=2710.0, target_strength=0.345e9, target_youngs_modulus=68.95e9, target_poisson_ratio=0.33,
        target_hardening_exponent=0.054, target_tangent_modulus=0.0, cavity_velocity=1200.0,
    )
    at_rest = cavity.evaluate(0.0, cavity_solid="compressible", **values)
    assert at_rest["cavity_stress"] == pytest.approx(4.2452 * 0.345e9, rel=2e-5)
    assert at_rest["front_velocity"] == 0.0
    assert cavity.evaluate(0.0, cavity_solid="incompressible", **values)["b"] == 1.5


@pytest.mark.parametrize(
    ("change", "word"),
    [({"strength": 0.0}, "strength"), ({"strength": 30e9}, "strength"), ({"poisson_ratio": 0.5}, "poisson"),
     ({"density": -1.0}, "density"), ({"hardening_exponent": 1.0}, "hardening"), ({"youngs_modulus": math.nan}, "youngs")],
)
def test_impossible_solids_are_refused(change, word):
    with pytest.raises(InputError, match=word):
        Solid(**{"density": 2710.0, "youngs_modulus": 69e9, "poisson_ratio": 0.33, "strength": 0.3e9} | change)


def test_beyond_the_plastic_shock_is_refused():
    with pytest.raises(InputError, match="velocity"):
        expansion(4000.0, LUK_6061)
    with pytest.raises(InputError, match="front"):
        expansion_at_front(1.01 * LUK_6061.bulk_speed, LUK_6061)
    with pytest.raises(InputError, match=r"cavity\.velocity"):
        coefficients(LUK_6061, 4000.0)


def test_no_coefficients_and_no_elastic_constants_are_refused():
    values = dict(target_density=2710.0, target_strength=0.3e9, target_hardening_exponent=0.0, cavity_velocity=1000.0)
    with pytest.raises(InputError, match=r"cavity\.a"):
        cavity.given_or_fitted(4.0, None, target_youngs_modulus=None, target_poisson_ratio=0.3, **values)
    assert cavity.given_or_fitted(4.0, 1.1, target_youngs_modulus=None, target_poisson_ratio=None, **values) == (4.0, 1.1)
