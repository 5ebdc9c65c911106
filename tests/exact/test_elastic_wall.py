"""The elastic wall against Blake's sphere and against Lamé's tube at rest."""

import numpy as np
import pytest

from problems.verification.exact.elastic_wall import displacements

#: density, bulk and shear modulus of the rock of ExactPack's Blake problem: 3000 kg/m^3, Young's modulus 62.5 GPa, Poisson 0.25
ROCK = 3000.0, 125e9 / 3, 25e9


def test_blakes_sphere():
    """Radius 0.1 m, 1 MPa, after 160 us: displacements of ExactPack's solution."""
    places, course = displacements(0.1, 1.2, 1e6, *ROCK, 2, 160e-6, cells=2200)
    at = np.array([0.1, 0.12, 0.15, 0.3])
    assert np.interp(at, places, course[-1]) == pytest.approx([1.00177e-06, 6.959356e-07, 4.453343e-07, 1.052448e-07], rel=5e-4)


def test_a_thin_tube_swings_to_twice_its_displacement_at_rest():
    """Lamé: u = p a^2/(b^2 - a^2) [r/(2 (lambda + G)) + b^2/(2 G r)]; a thin tube swings to twice that, once and again."""
    inner, outer, (density, bulk, shear) = 0.1, 0.101, ROCK
    rest = 1e6 * inner**2 / (outer**2 - inner**2) * (inner / (2 * (bulk + shear / 3)) + outer**2 / (2 * shear * inner))
    _, course = displacements(inner, outer, 1e6, density, bulk, shear, 1, 140e-6, cells=20)
    assert course[:, 0].max() == pytest.approx(2.0 * rest, rel=0.02)
