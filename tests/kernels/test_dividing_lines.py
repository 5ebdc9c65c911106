"""The line between the groups in every cell of a contact, as `contact_lines` writes it."""

import numpy as np
import pytest

from hydro2d.kernels.contact.contact_geometry import (
    CONSTANT,
    HARD_FIRST,
    LINE_R,
    LINE_Z,
    SHARE,
    SOFT_AFTER,
    find_contact_nodes,
)
from hydro2d.kernels.contact.dividing_lines import contact_lines
from hydro2d.kernels.vertex_forces import vertex_masses
from hydro2d.mesh.fields import RHO
from tests.kernels.cells import Cells
from tests.physics.test_dividing_lines import N, rimmed


def test_lines_are_drawn_in_all_cells_of_a_contact():
    """A flat face that ends in a rim, as `contact_lines` writes it; beyond the contact nothing is written."""
    cells, rim = Cells(nr=N, nz=N, bodies=2, group=[0, 1]), rimmed(2.3, 2.6, 2.6)
    cells.vof[1][cells.grid.inside], cells.vof[0][cells.grid.inside] = (
        rim.hard[rim.grid.inside], rim.soft[rim.grid.inside])
    cells.q[RHO] = 1.0
    cells.cell_mass[...] = cells.vof
    cells.call(vertex_masses, i1=N + 3)
    cells.call(find_contact_nodes)
    cells.line[...] = np.nan
    cells.call(contact_lines)
    assert cells.contact_columns[4].tolist() == [2, 6]
    for i in range(2, 5):
        assert cells.line[[LINE_R, LINE_Z, CONSTANT, SHARE], 4, i] == pytest.approx([0.0, 1.0, 0.3, 0.3], abs=1e-5), i
    assert cells.line[[LINE_R, LINE_Z, CONSTANT, SHARE], 4, 5].tolist() == [0.0, 0.0, 0.0, -1.0]
    assert cells.line[[SOFT_AFTER, HARD_FIRST], 4, 2].tolist() == [1.0, 1.0]
    assert np.isnan(cells.line[:, 2]).all()
