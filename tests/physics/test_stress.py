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
STRAIN = st.floats(-0.1, 0.1)
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


@given(STRESS, STRESS, STRESS, SPIN)
def test_rotation_keeps_the_hoop_stress(rr, zz, rz, spin):
    new_rr, new_zz, _ = turned(rr, zz, rz, spin)
    assert new_rr + new_zz == pytest.approx(rr + zz, rel=1e-12, abs=1e-3)


@given(STRESS, STRESS, STRESS, SPIN)
def test_a_rotation_back_undoes_a_rotation(rr, zz, rz, spin):
    assert turned(*turned(rr, zz, rz, spin), -spin) == pytest.approx((rr, zz, rz), rel=1e-12, abs=1e-3)


def test_a_quarter_turn_exchanges_the_axes():
    """The half angle of the rotation has the tangent spin/2."""
    assert turned(5.0, -2.0, 3.0, 2.0) == pytest.approx((-2.0, 5.0, -3.0), rel=1e-15)


def test_a_small_spin_turns_by_its_angle_from_z_towards_r():
    """u = W z, v = -W r takes the z axis to r: tension along z then pulls r and z together."""
    angle = 1e-4
    _, _, rz = turned(-1.0, 1.0, 0.0, angle)
    assert rz == pytest.approx(math.sin(2.0 * angle), rel=1e-8)


def test_the_principal_axis_of_a_tension_turns_by_twice_the_arc_tangent_of_half_the_spin():
    rr, zz, rz = turned(-1.0, 1.0, 0.0, 0.6)
    vector = np.linalg.eigh([[rr, rz], [rz, zz]])[1][:, 1]
    assert math.atan2(vector[0], vector[1]) % math.pi == pytest.approx(2.0 * math.atan(0.3), rel=1e-12)


# --------------------------------------------------------------------------------------------------------- strain


def test_uniaxial_strain_along_z_makes_four_thirds_g_and_minus_two_thirds():
    rr, zz, rz = strained(0.0, 1e-3, 0.0, 0.0)
    assert (rr, zz, rz) == pytest.approx((-2.0 / 3.0 * G * 1e-3, 4.0 / 3.0 * G * 1e-3, 0.0))


def test_uniaxial_strain_along_r_makes_four_thirds_g_and_minus_two_thirds():
    rr, zz, rz = strained(1e-3, 0.0, 0.0, 0.0)
    assert (rr, zz, rz) == pytest.approx((4.0 / 3.0 * G * 1e-3, -2.0 / 3.0 * G * 1e-3, 0.0))


def test_hoop_strain_alone_pulls_both_other_stresses_down():
    rr, zz, rz = strained(0.0, 0.0, 1e-3, 0.0)
    assert (rr, zz, rz) == pytest.approx((-2.0 / 3.0 * G * 1e-3, -2.0 / 3.0 * G * 1e-3, 0.0))


def test_change_of_size_alone_makes_no_deviator():
    assert strained(2e-3, 2e-3, 2e-3, 0.0) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_shear_is_g_times_the_angle():
    """An angle of 1e-3 is a tensor strain of half of it."""
    assert strained(0.0, 0.0, 0.0, 0.5e-3) == pytest.approx((0.0, 0.0, G * 1e-3))


@given(STRAIN, STRAIN, STRAIN, STRAIN)
def test_a_strain_without_change_of_volume_makes_two_g_times_itself(drr, dzz, drz, spin):
    """Without stress the rotation does nothing: the strain is added after it and is not turned."""
    new = turn_and_strain(0.0, 0.0, 0.0, spin, 2.0 * G, drr, dzz, -(drr + dzz), drz)
    assert new == pytest.approx((2.0 * G * drr, 2.0 * G * dzz, 2.0 * G * drz), rel=1e-12, abs=1e-4)


def test_without_spin_strain_adds_to_what_is_there():
    once = strained(1e-3, -3e-4, 2e-4, 5e-4)
    twice = turn_and_strain(*once, 0.0, 2.0 * G, 1e-3, -3e-4, 2e-4, 5e-4)
    assert twice == pytest.approx(tuple(2.0 * s for s in once))


# ------------------------------------------------------------------------------------------------------ measures


def test_von_mises_of_a_tension_is_the_tension():
    """The deviator of a stress of 3 along one axis is 2 along it and -1 along both others."""
    assert von_mises(2.0, -1.0, 0.0) == pytest.approx(3.0)
    assert von_mises(-1.0, 2.0, 0.0) == pytest.approx(3.0)
    assert von_mises(-1.0, -1.0, 0.0) == pytest.approx(3.0)


def test_von_mises_of_a_shear_is_its_root_three_fold():
    assert von_mises(0.0, 0.0, -2.0) == pytest.approx(2.0 * math.sqrt(3.0))


@given(STRESS, STRESS, STRESS)
def test_von_mises_by_principal_stresses(rr, zz, rz):
    a, b = np.linalg.eigvalsh([[rr, rz], [rz, zz]])
    c = -(rr + zz)
    by_differences = math.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2))
    assert von_mises(rr, zz, rz) == pytest.approx(by_differences, rel=1e-9, abs=1e-3)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2, 2.5])
def test_pressure_is_the_same_on_every_plane(angle):
    stresses = np.full((3, 2, 2), np.nan)
    stresses[:, 1, 0] = -5e9, -5e9, 0.0
    assert normal_pressure(1, 0, math.cos(angle), math.sin(angle), *stresses) == pytest.approx(5e9)


def test_a_tension_is_a_negative_pressure_on_its_own_plane_alone():
    rr, zz, rz = np.array([[3.0]]), np.array([[7.0]]), np.array([[0.0]])
    assert normal_pressure(0, 0, 1.0, 0.0, rr, zz, rz) == -3.0
    assert normal_pressure(0, 0, 0.0, 1.0, rr, zz, rz) == -7.0


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


def test_the_least_pressure_of_a_pressure_is_that_pressure():
    assert least(-5e9, -5e9, -5e9, 0.0) == 5e9


def test_a_ring_that_is_stretched_presses_on_nothing():
    assert least(-5.0, -4.0, 2.0, 0.0) == -2.0


def test_a_cell_that_is_loaded_along_its_free_surface_presses_on_nothing():
    assert least(0.0, -9.0, -3.0, 0.0) == 0.0
    assert least(-4.5, -4.5, -3.0, 4.5) == pytest.approx(0.0)  # the same, turned by an eighth


@pytest.mark.parametrize("solids", [1e-6, 0.3, 1.0])
def test_a_deviator_counts_by_volume_where_void_counts(solids):
    assert stress_scale(False, solids) == 1.0


def test_in_mode_solid_half_a_cell_of_solids_is_as_stiff_as_a_full_one():
    assert [solids * stress_scale(True, solids) for solids in (0.5, 0.8, 1.0)] == pytest.approx([1.0, 1.0, 1.0])


def test_in_mode_solid_a_sliver_is_not_made_stiffer_than_twice():
    assert stress_scale(True, 1e-9) == stress_scale(True, 0.49) == 2.0


@given(STRESS, STRESS, STRESS)
def test_the_largest_principal_value_is_the_largest_eigenvalue(rr, zz, rz):
    tensor = np.array([[rr, 0.0, rz], [0.0, -(rr + zz), 0.0], [rz, 0.0, zz]])
    assert largest_principal(rr, zz, rz) == pytest.approx(np.linalg.eigvalsh(tensor)[-1], rel=1e-12, abs=1e-6)


def test_released_material_has_no_deviator():
    q = np.ones((INTERNAL, 2, 1, 1))
    stress.release.py_func(1, 0, 0, q)
    assert [k for k in range(INTERNAL) if q[k, 1, 0, 0] == 0.0] == sorted((SRR, SZZ, SRZ))
    assert (q[:, 0] == 1.0).all()
