"""Checkerboards of a field of cells, by patterns with known ones."""

import numpy as np
import pytest

from hydro2d.physics import checkerboard
from hydro2d.physics.checkerboard import COUNTS, OF_P

J, I = np.indices((6, 6))
SIGN = (-1.0) ** (J + I)


def test_the_least_of_four_numbers_is_of_those_that_count():
    least_of = checkerboard.least_of.py_func
    assert least_of(3.0, 2.0, 4.0, 5.0, 1.0, 1.0, 1.0, 1.0) == 2.0
    assert least_of(3.0, 2.0, 4.0, 5.0, 1.0, 0.0, 1.0, 1.0) == 3.0
    assert least_of(3.0, 2.0, 4.0, 5.0, 0.0, 0.0, 0.0, 1.0) == 5.0
    assert least_of(3.0, 0.0, 4.0, 5.0, 1.0, 1e-9, 1.0, 1.0) == 3.0
    assert least_of(3.0, 0.0, 4.0, 5.0, 1.0, 0.5, 1.0, 1.0) == 2.5


def test_a_checkerboard_is_found_in_any_linear_field():
    """a = 3 sign + 2 + 5 i - 7 j."""
    of = checkerboard.checkerboard_of.py_func
    assert of(2, 3, 3.0 * SIGN + 2.0 + 5.0 * I - 7.0 * J) == pytest.approx(3.0 * SIGN[2, 3])
    assert of(2, 3, 2.0 + 5.0 * I - 7.0 * J) == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_cell_exceeds_its_neighbours_by_the_least_checkerboard_around_it(sign):
    excess = checkerboard.cell_excess.py_func
    around = np.zeros((5, 6, 6))
    around[COUNTS], around[OF_P] = 1.0, sign * 3.0 * SIGN
    around[OF_P, 3, 3] *= 0.5
    assert excess(OF_P, 2, 2, around) == sign * 1.5
    assert excess(OF_P, 1, 1, around) == sign * 3.0
    around[OF_P, 3, 3] *= -1.0  # not of one sign
    assert excess(OF_P, 2, 2, around) == 0.0
    around[COUNTS, 3, 3] = 0.0  # three vertices count, then one
    assert excess(OF_P, 2, 2, around) == sign * 3.0
    around[COUNTS, 2, 2:4] = 0.0
    assert excess(OF_P, 2, 2, around) == 0.0


def test_faces_sweep_from_a_cell_that_stands_out_to_its_neighbours_in_the_same_body():
    """An eighth of the difference of the two rooms."""
    vof, room = np.ones((1, 6, 6)), 8.0 * I + 80.0 * J
    assert checkerboard.left_face.py_func(0, 2, 3, vof, room) == -1.0
    assert checkerboard.lower_face.py_func(0, 2, 3, vof, room) == -10.0
    vof[0, 2, 3] = 0.99
    assert checkerboard.left_face.py_func(0, 2, 4, vof, room) == 0.0
    assert checkerboard.lower_face.py_func(0, 3, 3, vof, room) == 0.0
