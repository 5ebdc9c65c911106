"""What deviators do, and when there are none."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.physics import plasticity

deviator_power = plasticity.deviator_power.py_func
carries_no_stress = plasticity.carries_no_stress.py_func

VALUE = st.floats(-1e3, 1e3)


@settings(deadline=None)
@given(*[VALUE] * 8)
def test_the_power_is_the_product_of_the_tensors(rr, zz, rz, d_rr, d_zz, d_tt, r_by_z, z_by_r):
    """Stress and velocity gradient in r, theta, z."""
    stress = np.array([[rr, 0.0, rz], [0.0, -(rr + zz), 0.0], [rz, 0.0, zz]])
    gradient = np.array([[d_rr, 0.0, r_by_z], [0.0, d_tt, 0.0], [z_by_r, 0.0, d_zz]])
    power = deviator_power(rr, zz, rz, d_rr, d_zz, d_tt, r_by_z + z_by_r)
    assert power == pytest.approx(np.sum(stress * gradient), rel=1e-12, abs=1e-8)


def test_a_change_of_size_alone_takes_no_work_of_the_deviator():
    assert deviator_power(3.0, -5.0, 7.0, 0.5, 0.5, 0.5, 0.0) == 0.0


def test_a_tension_pulled_along_its_axis_gives_way_sideways():
    """Uniaxial 3 along z, strained by 2 along z and -1 across without change of volume: 3 times 2."""
    assert deviator_power(-1.0, 2.0, 0.0, -1.0, 2.0, -1.0, 0.0) == 6.0


def test_shear_does_work_on_the_angle():
    assert deviator_power(0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.5) == 2.0


@pytest.mark.parametrize("damage", [0.0, 0.5, 0.999999])
def test_dense_material_that_has_not_failed_carries_stress(damage):
    assert not carries_no_stress(damage, 2700.0, 2540.0)


@pytest.mark.parametrize("rho", [2540.0, 2000.0, 1.0])
def test_what_is_as_thin_as_the_bound_carries_none(rho):
    assert carries_no_stress(0.0, rho, 2540.0)


@pytest.mark.parametrize("damage", [1.0, 1.0000001])
def test_what_has_failed_carries_none(damage):
    assert carries_no_stress(damage, 2700.0, 2540.0)


def test_with_a_bound_of_zero_nothing_is_too_thin():
    assert not carries_no_stress(0.0, 1e-9, 0.0)
