"""The piston against printed solutions of Wilkins' flyer and of ExactPack's elastic-plastic piston."""

import math

import pytest

from problems.verification.exact.elastic_plastic import ALUMINIUM, ALUMINIUM_EXACTPACK, COPPER, elastic, piston


def test_wilkins_flyer_at_800():
    """Symmetric impact at 800 m/s is a piston at 400 m/s."""
    solution = piston(*ALUMINIUM, 400.0)
    assert solution.elastic.rho == pytest.approx(2800.177, abs=1e-3)
    assert solution.elastic.sigma == pytest.approx(0.63588e9, rel=1e-5)
    assert solution.elastic.u == pytest.approx(35.178, abs=1e-3)
    assert solution.elastic.speed == pytest.approx(6490.43, abs=0.01)
    assert solution.plastic.speed == pytest.approx(5908.52, abs=0.01)
    assert solution.plastic.sigma == pytest.approx(6.63588e9, rel=1e-6)
    assert solution.plastic.p == pytest.approx(6.43588e9, rel=1e-6)
    assert solution.plastic.rho == pytest.approx(2985.63, abs=0.005)
    assert solution.plastic.e == pytest.approx(81272, abs=1)
    assert solution.c_elastic_release == pytest.approx(6903.5, abs=0.1)
    assert solution.c_bulk_release == pytest.approx(5944.1, abs=0.1)


def test_wilkins_flyer_at_2000_is_overdriven():
    """The plastic shock of the 1 km/s piston, 6705.4 m/s, is faster than the precursor."""
    with pytest.raises(ValueError, match="overruns"):
        piston(*ALUMINIUM, 1000.0)


@pytest.mark.parametrize(
    ("material", "u", "hel", "precursor", "shock", "sigma", "p"),
    [
        (ALUMINIUM_EXACTPACK, 100.0, 0.53799e9, 6520.64, 5505.3, 1.618843e9, 1.4455e9),
        (COPPER, 20.0, 0.19903e9, 4722.18, 3976.95, 0.74159e9, 0.68159e9),
    ],
    ids=["ExactPack", "copper"],
)
def test_weak_pistons(material, u, hel, precursor, shock, sigma, p):
    solution = piston(*material, u)
    assert solution.elastic.sigma == pytest.approx(hel, rel=1e-5)
    assert solution.elastic.speed == pytest.approx(precursor, abs=0.01)
    assert solution.plastic.speed == pytest.approx(shock, abs=0.05)
    assert solution.plastic.sigma == pytest.approx(sigma, rel=1e-5)
    assert solution.plastic.p == pytest.approx(p, rel=4e-5)


def test_linear_limit():
    """With a tiny yield stress the precursor runs at the longitudinal sound speed."""
    solid, shear_modulus, _ = ALUMINIUM
    solution = piston(solid, shear_modulus, 1e5, 1.0)
    assert solution.elastic.speed == pytest.approx(math.sqrt(solid.c0**2 + 4 * shear_modulus / 3 / solid.rho0), rel=1e-5)


def test_elastic_piston_is_refused():
    with pytest.raises(ValueError, match="stays elastic"):
        piston(*ALUMINIUM, 30.0)


def test_an_elastic_piston():
    """At the elastic limit it is the precursor; for a slow piston, in the limit, the longitudinal sound wave."""
    solid, shear_modulus, yield_stress = ALUMINIUM
    limit = piston(solid, shear_modulus, yield_stress, 400.0).elastic
    solution = elastic(solid, shear_modulus, limit.u)
    assert (solution.sigma, solution.speed, solution.rho) == pytest.approx((limit.sigma, limit.speed, limit.rho), rel=1e-9)
    slow, sound = elastic(solid, shear_modulus, 1e-3), math.sqrt(solid.c0**2 + 4 * shear_modulus / 3 / solid.rho0)
    assert (slow.speed, slow.sigma) == pytest.approx((sound, solid.rho0 * sound * 1e-3), rel=1e-6)
