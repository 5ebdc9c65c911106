"""Deviators: their power, their return to the yield surface, and where there are none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.mesh.fields import INTERNAL
from hydro2d.physics import plasticity
from hydro2d.physics.stress import von_mises
from strength import STRENGTH_MODELS

deviator_power = plasticity.deviator_power.py_func
carries_no_stress = plasticity.carries_no_stress.py_func
take_internal = plasticity.take_internal.py_func
keep_internal = plasticity.keep_internal.py_func
forget = plasticity.forget.py_func
from_centre = plasticity.from_centre.py_func
returned = plasticity.returned.py_func

HARDENS, PLAIN = STRENGTH_MODELS["kinematic-hardening"], STRENGTH_MODELS["elastic-plastic"]
ROW = HARDENS.row({"shear_modulus": 26e9, "yield_stress": 3e8, "hardening_modulus": 5e9, "isotropic_share": 0.2})

VALUE = st.floats(-1e3, 1e3)


@given(*[VALUE] * 8)
def test_the_power_is_the_product_of_the_tensors(rr, zz, rz, d_rr, d_zz, d_tt, r_by_z, z_by_r):
    """Stress and velocity gradient in r, theta, z."""
    stress = np.array([[rr, 0.0, rz], [0.0, -(rr + zz), 0.0], [rz, 0.0, zz]])
    gradient = np.array([[d_rr, 0.0, r_by_z], [0.0, d_tt, 0.0], [z_by_r, 0.0, d_zz]])
    power = deviator_power(rr, zz, rz, d_rr, d_zz, d_tt, r_by_z + z_by_r)
    assert power == pytest.approx(np.sum(stress * gradient), rel=1e-12, abs=1e-8)


@pytest.mark.parametrize("damage", [1.0, 1.0000001])
def test_failed_material_carries_none(damage):
    assert carries_no_stress(damage, 2700.0, 2540.0)


def test_internal_variables_go_out_and_back():
    q = np.arange(2.0 * (INTERNAL + 3) * 6).reshape(INTERNAL + 3, 2, 2, 3)
    before, internal = q.copy(), np.zeros(3)
    take_internal(1, 0, 2, HARDENS.ID, q, internal)
    np.testing.assert_array_equal(internal, before[INTERNAL:, 1, 0, 2])
    internal += 0.5
    keep_internal(1, 0, 2, HARDENS.ID, internal, q)
    before[INTERNAL:, 1, 0, 2] += 0.5
    np.testing.assert_array_equal(q, before)


def test_a_melt_forgets_its_back_stress_and_no_other_cell_does():
    q = np.arange(1.0, 1.0 + 2.0 * (INTERNAL + 3) * 6).reshape(INTERNAL + 3, 2, 2, 3)
    before = q.copy()
    forget(1, 0, 2, HARDENS.ID, q, np.zeros(3))
    before[INTERNAL:, 1, 0, 2] = 0.0
    np.testing.assert_array_equal(q, before)


def test_a_model_without_internal_variables_touches_none():
    q, internal = np.ones((INTERNAL + 3, 1, 1, 1)), np.full(3, 7.0)
    take_internal(0, 0, 0, PLAIN.ID, q, internal)
    keep_internal(0, 0, 0, PLAIN.ID, internal, q)
    assert (q == 1.0).all()
    assert (internal == 7.0).all()


def test_most_yield_surfaces_lie_around_the_origin():
    internal = np.array([1.0, 2.0, 3.0])
    assert from_centre(5.0, 7.0, 9.0, PLAIN.ID, internal) == (5.0, 7.0, 9.0)
    assert from_centre(5.0, 7.0, 9.0, HARDENS.ID, internal) == (4.0, 5.0, 6.0)


@given(*[st.floats(-2e9, 2e9)] * 3, st.floats(1e-6, 0.01))
def test_a_return_ends_on_the_surface_that_has_moved(rr, zz, rz, dep):
    """The plastic strain is 3/2 dep times the direction; the stress falls by 2 G of it, the centre follows by 2/3 C of it."""
    internal = np.array([1e8, -2e8, 5e7])
    trial = von_mises.py_func(rr, zz, rz)
    if trial < 3.0 * 26e9 * dep + 4e9 * dep + 1e6:
        return
    final = trial - (3.0 * 26e9 + 4e9) * dep
    direction, old = 1.5 * dep * np.array([rr, zz, rz]) / trial, internal.copy()
    after = returned(rr, zz, rz, trial, dep, final, HARDENS.ID, ROW, internal)
    np.testing.assert_allclose(internal, old + 2 / 3 * 4e9 * direction, rtol=1e-12, atol=1.0)
    np.testing.assert_allclose(after, old + np.array([rr, zz, rz]) - 2 * 26e9 * direction, rtol=1e-9, atol=10.0)
    assert von_mises.py_func(*(np.array(after) - internal)) == pytest.approx(final, rel=1e-9)
