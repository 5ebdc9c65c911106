"""What presses on void between two groups, and what stands out along their surface."""

import numpy as np
import pytest

from hydro2d.physics import contact_pushes
from hydro2d.physics.contact_faces import GAP
from hydro2d.physics.traction import INTERFACE, KIND, WHOLE
from tests.physics.continuity import changes_in_proportion

push_of = contact_pushes.push_of.py_func
counts_for = contact_pushes.counts_for.py_func
pressed_by = contact_pushes.pressed_by.py_func
stands_out = contact_pushes.stands_out.py_func
slip_at = contact_pushes.slip_at.py_func
closed = contact_pushes.closed.py_func

#: cells of the mesh along either side, and the first of them after the ghosts
N, FIRST = 6, 2
MESH = slice(FIRST, FIRST + N)
MESH_BOX = np.array([FIRST, FIRST + N, FIRST, FIRST + N])
SOFT, HARD = 0, 1


class Surface:
    """6 x 6 cells of half of each group; indices without the ghosts, of which nothing is known.

    pressure : p_c, Pa;  kind : of the cells;  viscosity : q, Pa
    """

    def __init__(self, pressure=0.0, kind=INTERFACE, viscosity=0.0):
        whole = np.full((10, N + 2 * FIRST, N + 2 * FIRST), np.nan)
        whole[:, MESH, MESH] = 0.0
        self.ph, self.qr, self.solid, self.bulk, self.hard, self.soft, *self.stress = whole
        self.skin, self.constrained = np.full((3, *self.ph.shape), np.nan), np.full(4, -1)
        self.ph[MESH, MESH], self.qr[MESH, MESH], self.skin[KIND, MESH, MESH] = pressure, viscosity, kind
        self.solid[MESH, MESH], self.bulk[MESH, MESH] = 1.0, 5.0
        self.hard[MESH, MESH] = self.soft[MESH, MESH] = 0.5
        self.gas = np.zeros(self.ph.shape)  # of what is soft

    def fill(self, group: int, j, i) -> None:
        """Fills whole cells with one group."""
        for share, filled in ((self.hard, group == HARD), (self.soft, group == SOFT), (self.skin[KIND], WHOLE)):
            share[MESH, MESH][j, i] = filled

    def press(self, j, i, rr: float, zz: float, tt: float, rz: float = 0.0) -> None:
        """Gives cells a stress."""
        for stress, value in zip(self.stress, (rr, zz, tt, rz), strict=True):
            stress[MESH, MESH][j, i] = value

    def open(self, j: int, i: int, void: float) -> None:
        self.solid[FIRST + j, FIRST + i] = 1.0 - void

    def push(self, j: int, i: int) -> float:
        return push_of(FIRST + j, FIRST + i, self.skin, self.solid, self.bulk, self.ph, self.qr, *self.stress)

    def pressed(self, j: int, i: int, group: int) -> float:
        return pressed_by(group, FIRST + j, FIRST + i, self.hard, self.soft, self.skin, self.solid, self.bulk, self.ph, self.qr,
                          *self.stress)

    def out(self, j: int, i: int) -> float:
        """`stands_out` of a cell."""
        firm = np.stack([self.soft - self.gas, self.hard])
        return stands_out(FIRST + j, FIRST + i, MESH_BOX, self.constrained, self.skin, self.hard, self.soft, firm, self.solid,
                          self.ph, self.qr)


def along_z(pressure) -> Surface:
    """A surface of one column of cells with these pressures."""
    kind = np.full((N, N), WHOLE)
    kind[:, 3] = INTERFACE
    return Surface(np.tile(pressure, (N, 1)).T, kind)


# ---------------------------------------------------------------------------------- what stands out from its neighbours


def test_a_cell_with_gas_counts_as_one_with_void():
    cells, other = (along_z(np.arange(N) ** 2) for _ in range(2))
    cells.gas[FIRST + 2, FIRST + 3] = 0.3 * GAP
    other.open(2, 3, 0.3 * GAP)
    assert [cells.out(j, 3) for j in (1, 2, 3)] == pytest.approx([other.out(j, 3) for j in (1, 2, 3)])
    firm = np.stack([cells.soft - cells.gas, cells.hard])
    found = [closed(FIRST + 2, FIRST + i, cells.hard, cells.soft, firm, cells.solid) for i in (2, 3)]
    assert (found[0], 0.5 < found[1] < 1.0) == (1.0, True)
    cells.gas[FIRST + 2, FIRST + 3] = GAP
    assert cells.out(2, 3) == 0.0


@pytest.mark.parametrize(("edge", "j", "i"), [(0, 3, 0), (1, 3, N - 1), (2, 0, 3), (3, N - 1, 3)])
def test_at_the_axis_and_at_walls_a_surface_goes_on_as_in_a_mirror(edge, j, i):
    """Across it lies a cell of the same pressure, on the other side one of 1 Pa less."""
    inward = (0, 1 if edge == 0 else -1) if edge < 2 else (1 if edge == 2 else -1, 0)
    kind, pressure = np.full((N, N), WHOLE), np.full((N, N), 50.0)
    for at, value in (((j, i), 3.0), ((j + inward[0], i + inward[1]), 2.0)):
        kind[at], pressure[at] = INTERFACE, value
    cells = Surface(pressure, kind)
    assert cells.out(j, i) == 0.0
    cells.constrained = np.array([FIRST, FIRST + N, FIRST, FIRST + N])
    assert cells.out(j, i) == pytest.approx(0.5)


def filled(hard_below, hard_above, kind=INTERFACE):
    """A surface along r with rows of cells on both sides that one group fills by these shares, under 1, 2, 4 ... 32 Pa."""
    cells = Surface(2.0 ** np.arange(N), kind)
    for rows, hard in ((np.s_[:3], hard_below), (np.s_[3:], hard_above)):
        for group, share in ((cells.hard, hard), (cells.soft, 1.0 - hard)):
            group[MESH, MESH][rows] = share
    return cells


def test_two_rows_on_either_side_of_a_mesh_line_stand_out_as_one():
    """In the row at the line a cell has two neighbours along the surface; the end of a surface does not stand out."""
    cells = filled(1.0, 0.0)
    cells.skin[KIND, MESH, MESH][[0, 1, 4, 5]] = WHOLE
    for row in (2, 3):
        assert cells.out(row, 2) == pytest.approx(4.0 - 0.5 * (2.0 + 8.0))
    cells.skin[KIND, MESH, FIRST + 4:] = WHOLE
    assert cells.out(2, 3) == cells.out(3, 3) == 0.0  # with the cell across, 8 - (4 + 8)/2


# ---------------------------------------------------------------------------------------------- who pushes, and how much


@pytest.mark.parametrize("kind", [WHOLE, INTERFACE])
def test_the_push_of_a_cell_fades_as_it_gets_void_itself(kind):
    """It is all there without void, half at half of GAP, and gone at GAP."""
    cells = Surface(8.0, kind)
    cells.press(2, 2, -8.0, -8.0, -8.0)
    for void, push in ((0.0, 8.0), (0.25 * GAP, 8.0 * 27 / 32), (0.5 * GAP, 4.0), (0.75 * GAP, 8.0 * 5 / 32), (GAP, 0.0),
                       (0.5, 0.0)):
        cells.open(2, 2, void)
        assert cells.push(2, 2) == pytest.approx(push, abs=1e-12)


@pytest.mark.parametrize("kind", [WHOLE, INTERFACE])
@pytest.mark.parametrize("void", [0.0, 0.5 * GAP, GAP])
def test_the_push_of_a_cell_fades_without_a_jump(kind, void):
    """And what presses on the cell beside it."""
    cells = Surface(8.0, kind)
    cells.fill(SOFT, np.s_[:], np.s_[:])
    cells.skin[KIND, MESH, MESH] = kind
    cells.press(2, 2, -8.0, -8.0, -8.0)
    for at in ((1, 3), (3, 3), (2, 4)):  # the other neighbours have void
        cells.open(*at, 0.5)

    def pushes(void):
        cells.open(2, 2, void)
        return cells.push(2, 2), cells.pressed(2, 3, SOFT)

    assert pushes(void)[0] == pushes(void)[1]
    changes_in_proportion(pushes, void, 2.0 * 8.0 / GAP, sides=(1.0,) if void == 0.0 else (-1.0, 1.0))


@pytest.mark.parametrize("kind", [WHOLE, INTERFACE])
def test_a_cell_without_bodies_does_not_push(kind):
    cells = Surface(8.0, kind)
    cells.press(2, 2, -8.0, -8.0, -8.0)
    cells.bulk[FIRST + 2, FIRST + 2] = 0.0
    assert cells.push(2, 2) == 0.0


@pytest.mark.parametrize(("along_r", "second"), [(True, (1, 0)), (False, (0, 1))])
def test_slip_is_the_mean_over_a_face_of_what_goes_along_the_surface_beyond_what_closes(along_r, second):
    u, v = np.full((2, 2, N, N), np.nan)
    for at, w_r, w_z in (((2, 3), 3.0, 4.0), ((2 + second[0], 3 + second[1]), 0.0, 10.0)):
        u[SOFT][at], u[HARD][at], v[SOFT][at], v[HARD][at] = 1.0, 1.0 + w_r, -2.0, -2.0 + w_z

    def slip(n_r, n_z):
        return slip_at(2, 3, along_r, n_r, n_z, u, v)

    assert slip(1.0, 0.0) == pytest.approx(0.5 * ((4.0 - 3.0) + 10.0))
    assert slip(0.0, -5.0) == 0.0
    assert slip(4.0, -3.0) == pytest.approx(0.5 * (5.0 + (4 * 10 - 3 * 10) / 5.0))
