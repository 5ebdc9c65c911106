"""Quantities that the bodies of a mixed cell share."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.mesh.fields import INTERNAL, RHO
from hydro2d.physics import closure

stiff_density = closure.stiff_density.py_func
softness = closure.softness.py_func
own_work, stiffness = closure.own_work.py_func, closure.stiffness.py_func
relaxation_strain = closure.relaxation_strain.py_func
relaxation_bound = closure.relaxation_bound.py_func

#: share of the cell, pressure, bulk modulus
BODY = st.tuples(st.floats(0.01, 1.0), st.floats(-1e9, 1e11), st.floats(1e9, 5e11))


# ------------------------------------------------------------------------------------------- density by compressibility


def dense(bodies) -> float:
    """`stiff_density` of cell (1, 2) with these bodies (share, density, modulus), nothing around it."""
    vof, km = np.full((2, len(bodies), 2, 3), np.nan)
    q = np.full((INTERNAL, len(bodies), 2, 3), np.nan)
    vof[:, 1, 2], q[RHO, :, 1, 2], km[:, 1, 2] = np.transpose(bodies)
    return stiff_density(1, 2, vof, q, km)


@given(st.lists(st.tuples(st.floats(0.01, 1.0), st.floats(1.0, 2e4), st.floats(1e5, 5e11)), min_size=1, max_size=4))
def test_the_density_lies_between_those_of_the_bodies(bodies):
    densities = [density for _, density, _ in bodies]
    assert min(densities) * (1.0 - 1e-12) <= dense(bodies) <= max(densities) * (1.0 + 1e-12)


# ------------------------------------------------------------------------------------- who takes a change of volume


@given(st.lists(BODY, min_size=2, max_size=4))
def test_uniformly_all_bodies_are_strained_alike(bodies):
    strains = [softness(f, modulus, False) / f for f, _, modulus in bodies]
    assert strains == pytest.approx([1.0] * len(strains))


@given(st.floats(0.0, 1.0), st.floats(-1e9, 1e11), st.floats(-1e9, 1e11), st.floats(1e9, 5e11))
def test_relaxation_takes_its_share_of_the_way_to_the_target(relaxation, p, target, modulus):
    """A relative change of volume x changes the pressure by -K x; a body above the target grows."""
    relaxed = p - modulus * relaxation_strain(relaxation, p, target, modulus)
    assert relaxed == pytest.approx((1.0 - relaxation) * p + relaxation * target, rel=1e-9, abs=1.0)


@pytest.mark.parametrize("strain", [0.0, 1e-9, 0.0999, -0.0999])
def test_a_small_relaxation_is_not_bounded(strain):
    assert relaxation_bound(strain) == 1.0


@given(st.floats(1e5, 1e10), st.floats(-0.02, 0.02))
def test_the_work_of_a_body_is_that_along_its_isentrope(p, strain):
    """A gas of p V^1.4: right to the third order in the change of its volume."""
    exact = p * (1.0 - (1.0 + strain) ** -0.4) / 0.4
    assert own_work(p, 1.4 * p, strain) == pytest.approx(exact, rel=2.0 * strain**2, abs=1e-12 * p)


@pytest.mark.parametrize(("modulus", "pressure", "found"), [(1.4e5, 1e5, 1.4e5), (1.4e5, 1e9, 1e9), (7e10, -1e9, 7e10)])
def test_a_thin_gas_is_as_stiff_as_its_cell_presses(modulus, pressure, found):
    assert stiffness(modulus, pressure) == found
