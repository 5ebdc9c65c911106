"""What a cell contains: gases, groups, solids that meet, the sides of their surface and the stress across it."""

import numpy as np
import pytest

from hydro2d.mesh.fields import SRR, SRZ, SZZ
from hydro2d.physics import contents
from hydro2d.physics.traction import BESIDE_GAS, FREE_SURFACE, INTERFACE, JOINT, KIND, NORMAL_R, NORMAL_Z


def shares(*vof):
    return np.array(vof, dtype=float)[:, None, None]


def test_a_gas_counts_where_it_is():
    beside = contents.is_beside_gas.py_func
    assert not beside(0, 0, [False, False], shares(0.5, 0.5))
    assert beside(0, 0, [False, True], shares(0.5, 0.5))
    assert not beside(0, 0, [False, True], shares(0.5, 0.0))


def test_groups_in_a_cell():
    contains = contents.contains_group.py_func
    assert contains(0, 0, 0, [0, 1], shares(0.5, 0.5))
    assert contains(1, 0, 0, [0, 1], shares(0.5, 0.5))
    assert not contains(1, 0, 0, [0, 1], shares(1.0, 0.0))


def test_several_bodies_one_of_which_has_strength():
    joins = contents.joins_solids.py_func
    assert joins(0, 0, [True, False], shares(0.5, 0.5))
    assert not joins(0, 0, [False, False], shares(0.5, 0.5))
    assert not joins(0, 0, [True, True], shares(1.0, 0.0))
    assert not joins(0, 0, [True, False, False], shares(0.0, 0.5, 0.5))


def test_the_fullest_body():
    assert contents.fullest.py_func(0, 0, shares(0.6, 0.4)) == 0
    assert contents.fullest.py_func(0, 0, shares(0.4, 0.6)) == 1


def test_sides_of_a_joint():
    """Gases are on one side; without one, the body that fills most of the cell is; a body not in the cell is on neither."""
    side = contents.side_of_joint.py_func
    gases, vof = [False, True], shares(0.5, 0.5)
    assert [side(m, 0, 0, 1, True, gases, vof) for m in (0, 1)] == [1.0, -1.0]
    assert [side(m, 0, 0, 1, False, gases, vof) for m in (0, 1)] == [-1.0, 1.0]
    assert side(0, 0, 0, 1, False, gases, shares(0.0, 1.0)) == 0.0


def test_stress_across_a_surface_counts_by_its_weight():
    """A normal (.48, .64): a weight of .64."""
    skin, q = np.zeros((3, 1, 1)), np.zeros((8, 1, 1, 1))
    skin[NORMAL_R], skin[NORMAL_Z] = 0.48, 0.64
    q[SRR], q[SZZ], q[SRZ] = 0.004, -0.003, 0.002
    expected = 0.48**2 * 0.004 - 0.64**2 * 0.003 + 2.0 * 0.48 * 0.64 * 0.002
    assert contents.normal_deviator.py_func(0, 0, 0, skin, q) == pytest.approx(expected)
    assert contents.surface_weight.py_func(0, 0, skin) == pytest.approx(0.64)
    skin[NORMAL_R] = 0.9
    assert contents.surface_weight.py_func(0, 0, skin) == 1.0


@pytest.mark.parametrize(("kind", "pull"), [(INTERFACE, 0.0), (JOINT, 1.0), (BESIDE_GAS, 1.0), (FREE_SURFACE, 0.36)])
def test_tension_that_a_cut_cell_carries(kind, pull):
    """None between groups, all in a joint, and by the weight of its surface against void."""
    skin = np.zeros((3, 1, 1))
    skin[NORMAL_R], skin[NORMAL_Z], skin[KIND] = 0.48, 0.64, kind
    assert contents.pull_of.py_func(0, 0, 0.0, skin) == pytest.approx(pull)


def test_the_body_that_dominates_is_hard_and_fills_most():
    def dominant(*hard, threshold=0.3):
        return contents.dominant_body.py_func(0, 0, np.array(hard), threshold, shares(0.3, 0.5, 0.2))

    assert dominant(False, False, False) == -1
    assert dominant(False, True, False) == 1
    assert dominant(True, False, True) == 0
    assert dominant(True, True, True) == 1
    assert dominant(False, False, True) == -1
    assert dominant(True, True, True, threshold=0.6) == -1
