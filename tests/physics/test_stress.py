"""Deviators: turned, strained and measured."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.mesh.fields import INTERNAL, SRR, SRZ, SZZ
from hydro2d.physics import stress

turn_and_strain = stress.turn_and_strain.py_func
von_mises = stress.von_mises.py_func
stress_scale = stress.stress_scale.py_func
largest_principal = stress.largest_principal.py_func
normal_pressure = stress.normal_pressure.py_func
least_pressure = stress.least_pressure.py_func

STRESS = st.floats(-1e9, 1e9)
SPIN = st.floats(-3.0, 3.0)
G = 26e9


def turned(rr, zz, rz, spin):
    return turn_and_strain(rr, zz, rz, spin, 2.0 * G, 0.0, 0.0, 0.0, 0.0)


def strained(drr, dzz, dtt, drz):
    """The deviator that strain makes from zero."""
    return turn_and_strain(0.0, 0.0, 0.0, 0.0, 2.0 * G, drr, dzz, dtt, drz)


# ------------------------------------------------------------------------------------------------------- rotation


@given(STRESS, STRESS, STRESS, SPIN)
def test_rotation_keeps_the_stress_by_von_mises(rr, zz, rz, spin):
    assert von_mises(*turned(rr, zz, rz, spin)) == pytest.approx(von_mises(rr, zz, rz), rel=1e-12, abs=1e-3)


# --------------------------------------------------------------------------------------------------------- strain


def test_change_of_size_alone_makes_no_deviator():
    assert strained(2e-3, 2e-3, 2e-3, 0.0) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


# ------------------------------------------------------------------------------------------------------ measures


@given(STRESS, STRESS, STRESS)
def test_von_mises_by_principal_stresses(rr, zz, rz):
    a, b = np.linalg.eigvalsh([[rr, rz], [rz, zz]])
    c = -(rr + zz)
    by_differences = math.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2))
    assert von_mises(rr, zz, rz) == pytest.approx(by_differences, rel=1e-9, abs=1e-3)


def test_shear_pulls_along_one_diagonal_and_pushes_along_the_other():
    none, shear, half = np.array([[0.0]]), np.array([[4.0]]), math.sqrt(0.5)
    assert normal_pressure(0, 0, half, half, none, none, shear) == pytest.approx(-4.0)
    assert normal_pressure(0, 0, half, -half, none, none, shear) == pytest.approx(4.0)


def least(rr, zz, tt, rz):
    """`least_pressure` of cell (1, 0), the only one that is known."""
    stresses = np.full((4, 2, 2), np.nan)
    stresses[:, 1, 0] = rr, zz, tt, rz
    return least_pressure(1, 0, *stresses)


@given(STRESS, STRESS, STRESS, STRESS)
def test_the_least_pressure_is_minus_the_largest_eigenvalue_of_the_stress(rr, zz, tt, rz):
    tensor = np.array([[rr, 0.0, rz], [0.0, tt, 0.0], [rz, 0.0, zz]])
    assert least(rr, zz, tt, rz) == pytest.approx(-np.linalg.eigvalsh(tensor)[-1], rel=1e-12, abs=1e-6)


def test_in_mode_solid_half_a_cell_of_solids_is_as_stiff_as_a_full_one():
    assert [solids * stress_scale(True, solids) for solids in (0.5, 0.8, 1.0)] == pytest.approx([1.0, 1.0, 1.0])


@given(STRESS, STRESS, STRESS)
def test_the_largest_principal_value_is_the_largest_eigenvalue(rr, zz, rz):
    tensor = np.array([[rr, 0.0, rz], [0.0, -(rr + zz), 0.0], [rz, 0.0, zz]])
    assert largest_principal(rr, zz, rz) == pytest.approx(np.linalg.eigvalsh(tensor)[-1], rel=1e-12, abs=1e-6)


def test_released_material_has_no_deviator():
    q = np.ones((INTERNAL, 2, 1, 1))
    stress.release.py_func(1, 0, 0, q)
    assert [k for k in range(INTERNAL) if q[k, 1, 0, 0] == 0.0] == sorted((SRR, SZZ, SRZ))
    assert (q[:, 0] == 1.0).all()
