"""What flows through a face between a cell that both groups and void share and a full one: no void into a body."""

import numpy as np
import pytest

from hydro2d.kernels.contact_geometry import FIRST
from hydro2d.kernels.contact_volumes import contact_fluxes

#: rows and columns, the row and the column of the cell that volume leaves to the left
SHAPE, ROW, GIVER = (7, 10), 3, 5


def flux(hard: float, soft: float, swept: float) -> tuple[float, float]:
    """Volumes of the hard and the soft body through the left face of the giver, per volume of a cell.

    Left of the giver all is hard, right of it soft; the nested interfaces begin with the soft body.
    """
    vof = np.zeros((2, *SHAPE))
    vof[0, :, :GIVER] = 1.0
    vof[1, :, GIVER + 1:] = 1.0
    vof[:, :, GIVER] = np.array([hard, soft])[:, None]
    line = np.zeros((9, *SHAPE))
    line[FIRST] = 0.0
    face, own, result = np.full(SHAPE, swept), np.full((2, *SHAPE), swept), np.zeros((2, *SHAPE))
    first = [np.array(order, dtype=np.int64) for order in ((0, 1), (1, 0))]
    contact_columns = np.tile(np.array([GIVER - 1, GIVER + 2], dtype=np.int64), (SHAPE[0], 1))
    mesh_box = np.array([2, SHAPE[0] - 2, 2, SHAPE[1] - 2], dtype=np.int64)
    contact_fluxes(0, 1, ROW, ROW + 1, mesh_box, np.ones(SHAPE[1]), np.ones(SHAPE[0]), *first, np.array([1, 0], dtype=np.int64),
                   contact_columns, line, face, own, vof.copy(), np.ones(SHAPE), vof, result)
    return tuple(result[:, ROW, GIVER])


def test_a_full_cell_takes_its_own_body_from_a_cell_with_a_gap():
    assert flux(0.3, 0.6, -0.01) == pytest.approx((-0.01, 0.0), abs=1e-15)


def test_it_takes_no_more_than_there_is():
    hard, soft = flux(0.004, 0.6, -0.01)
    assert hard == pytest.approx(-0.004, abs=1e-15)
    assert soft == 0.0


def test_without_void_all_that_is_swept_is_body():
    assert sum(flux(0.4, 0.6, -0.01)) == pytest.approx(-0.01, abs=1e-15)
