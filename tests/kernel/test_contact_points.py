"""What contact does at one vertex: the masters of a slave node, impulses, the force on a piece of surface."""

import numpy as np
import pytest

from hydro2d.kernels import contact_geometry, contact_velocities
from hydro2d.kernels.contact_geometry import EXTENDS, FREE, REACH, TIED
from hydro2d.mesh.grid import Grid

number_of_masters = contact_velocities.number_of_masters.py_func
first_master = contact_velocities.first_master.py_func
master = contact_velocities.master.py_func
weigh = contact_velocities.weigh.py_func
extended_cell = contact_velocities.extended_cell.py_func
held = contact_velocities.held.py_func
give = contact_velocities.give.py_func
mobility = contact_velocities.mobility.py_func
pressed = contact_velocities.pressed.py_func
face_aperture = contact_geometry.face_aperture.py_func
filled_share = contact_geometry.filled_share.py_func

#: edges of the cells of a graded mesh, as kernels see them
R, Z = np.cumsum(1.0 + 0.3 * np.sin(np.arange(12))), np.cumsum(0.8 + 0.2 * np.cos(np.arange(12)))
NOWHERE = np.full(4, -1)


def code_of(dj: int, di: int) -> int:
    """What find_masters writes for a cell so far from the vertex."""
    return EXTENDS + 2 * REACH * (dj + REACH) + di + REACH


def masters(g, j, i, code, weights):
    """(group, j, i, weight) of every master of a slave."""
    by, row, column = first_master(g, j, i, code)
    return [(by, *master(n, row, column, g, j, i, code, weights)) for n in range(number_of_masters(code))]


NO_WEIGHTS = np.full((4, 2, 12, 12), np.nan)
CELLS = [(dj, di) for dj in range(-REACH, REACH) for di in range(-REACH, REACH)]


@pytest.mark.parametrize(("dj", "di"), CELLS)
def test_a_slave_has_the_linear_field_of_its_cell(dj, di):
    j, i, code = 5, 6, code_of(dj, di)
    weights = np.full((4, 2, 12, 12), np.nan)
    weigh(1, j, i, code, R, Z, weights)
    assert extended_cell(j, i, code) == (j + dj, i + di)
    found = masters(1, j, i, code, weights)
    assert {(row - j, column - i) for _, row, column, _ in found} == {(dj + a, di + b) for a in (0, 1) for b in (0, 1)}
    assert sum(weight for *_, weight in found) == pytest.approx(1.0)
    velocity = sum(weight * (3.0 - 2.0 * R[column] + 0.7 * Z[row]) for _, row, column, weight in found)
    assert velocity == pytest.approx(3.0 - 2.0 * R[i] + 0.7 * Z[j])
    assert {group for group, *_ in found} == {1}


def test_a_node_in_tied_contact_moves_with_the_other_group():
    assert masters(0, 5, 6, TIED, NO_WEIGHTS) == [(1, 5, 6, 1.0)]
    assert masters(1, 5, 6, TIED, NO_WEIGHTS) == [(0, 5, 6, 1.0)]


def test_a_vertex_that_is_linked_moves_with_one_of_its_group():
    found = [masters(1, 5, 6, code, NO_WEIGHTS) for code in range(25)]
    assert {len(each) for each in found} == {1}
    assert {each[0][1:3] for each in found} == {(5 + dj, 6 + di) for dj in range(-2, 3) for di in range(-2, 3)}
    assert {(each[0][0], each[0][3]) for each in found} == {(1, 1.0)}


def test_codes_do_not_meet():
    assert len({FREE, TIED, *range(25), *(code_of(*cell) for cell in CELLS)}) == 2 + 25 + len(CELLS)
    assert max(code_of(*cell) for cell in CELLS) < 128  # masters is an int8


def test_axis_and_walls_hold_one_component():
    constrained = np.array([2, 9, -1, 7])
    assert held(4, 2, constrained) == (True, False)
    assert held(4, 9, constrained) == (True, False)
    assert held(7, 5, constrained) == (False, True)
    assert held(7, 2, constrained) == (True, True)
    assert held(4, 5, constrained) == (False, False)


@pytest.mark.parametrize(("constrained", "gained"), [(NOWHERE, (1.5, -2.0)), (np.array([1, -1, -1, -1]), (0.0, -2.0)),
                                               (np.array([-1, -1, 1, -1]), (1.5, 0.0))])
def test_an_impulse_moves_what_is_not_held(constrained, gained):
    mass, u, v, transfer = np.full((2, 3, 3), 2.0), np.zeros((2, 3, 3)), np.zeros((2, 3, 3)), np.zeros((5, 3))
    give(0, 1, 1, 3.0, -4.0, constrained, mass, u, v, transfer)
    assert (u[0, 1, 1], v[0, 1, 1]) == gained
    assert np.count_nonzero(u) + np.count_nonzero(v) == np.count_nonzero(gained)
    assert mass[0, 1, 1] * v[0, 1, 1] + transfer[4, 1] == -4.0  # what moves and what a wall takes is the impulse


def test_a_slave_is_as_heavy_as_it_and_its_masters():
    mass, ease = np.full((2, 2, 2), 4.0), np.zeros((2, 2, 2, 2))
    assert mobility(0, 1, 1, FREE, mass, ease) == 0.25
    ease[:, 0, 1, 1] = 1.0 / 6.0  # they yield like one mass of 6
    assert mobility(0, 1, 1, 3, mass, ease) == pytest.approx(1.0 / (4.0 + 6.0))


def test_pressure_on_a_flat_surface_is_force_over_its_area():
    """A surface across the axis at a row of vertices: its area at a vertex is that of the dual cell."""
    g = Grid(np.linspace(0.0, 8e-3, 9), np.linspace(0.0, 6e-3, 7))
    shape = g.shape
    contact_columns = np.tile([2, shape[1]], (shape[0], 1))
    line = np.zeros((9, *shape))
    j, i = 5, 7
    line[contact_geometry.SHARE, :j] = 1.0  # the hard body lies below
    zz = np.full(shape, -3e9)
    nothing = np.zeros(shape)
    force = pressed(j, i, 0.0, 1.0, contact_columns, g.metrics, g.dz, line, nothing, zz, nothing)
    area = g.az_out[i - 1] + g.az_in[i]
    assert area == pytest.approx(g.face_r[i] * 1e-3, rel=0.02)
    assert force == pytest.approx(3e9 * area)
    assert pressed(j, i, 0.0, 1.0, contact_columns, g.metrics, g.dz, line, nothing, -zz, nothing) == 0.0


def test_the_line_of_a_cell_wets_its_edges():
    line, hard, soft = np.zeros((9, 1, 1)), np.full((1, 1), 0.25), np.full((1, 1), 0.75)
    line[contact_geometry.SHARE], line[contact_geometry.LINE_R] = 0.25, 1.0
    line[contact_geometry.CONSTANT] = 0.25  # hard where x <= 1/4
    assert face_aperture(0, 0, 0.0, 0.0, 0.0, 1.0, True, line, hard, soft) == (1.0, 1.0, 1.0)
    assert face_aperture(0, 0, 1.0, 0.0, 1.0, 1.0, True, line, hard, soft) == (1.0, 0.0, 0.0)
    solid, low, high = face_aperture(0, 0, 0.0, 0.0, 1.0, 0.0, True, line, hard, soft)
    assert (solid, low + high) == (1.0, pytest.approx(2.0 * 0.25))  # the two ends share the quarter that is open
    assert low > high


@pytest.mark.parametrize("inside", [True, False])
def test_without_a_line_an_edge_has_the_share_of_its_cell(inside):
    line, hard, soft = np.zeros((9, 1, 1)), np.full((1, 1), 0.3), np.full((1, 1), 0.3)
    line[contact_geometry.SHARE] = 0.5
    assert face_aperture(0, 0, 0.0, 0.0, 1.0, 0.0, inside, line, hard, soft) == (1.0, 0.5, 0.5)


def test_an_edge_of_a_void_cell_has_no_weight():
    line, nothing = np.full((9, 1, 1), -1.0), np.zeros((1, 1))
    for inside in (True, False):
        assert face_aperture(0, 0, 0.0, 0.0, 1.0, 0.0, inside, line, nothing, nothing) == (0.0, 0.0, 0.0)


def test_a_vertex_is_weighty_from_half_of_its_dual_cell_on():
    g = Grid(np.linspace(0.0, 4e-3, 5), np.linspace(0.0, 4e-3, 5), "planar")
    mesh_box = np.array([2, 6, 2, 6])
    hard, soft, mass = np.zeros(g.shape), np.zeros(g.shape), np.ones((2, *g.vertex_shape))

    def share(j, i):
        return filled_share(1, j, i, mesh_box, g.volume, g.metrics, hard, soft, mass)

    hard[3, 3:5] = 1.0
    assert share(4, 4) == pytest.approx(0.5)
    hard[3, 4] = 0.98
    assert share(4, 4) == 0.0
    hard[3, 4], hard[4, 4] = 1.0, 0.4
    assert share(4, 4) == pytest.approx(0.6)
    assert share(1, 4) == 0.0  # beyond the mesh
    mass[1, 4, 4] = 0.0
    assert share(4, 4) == 0.0


def links(damage: float) -> np.ndarray:
    """masters [b, j, i] of a mesh with the hard body, of this damage, to the left and the soft one from column 7 on, and with a
    crumb of the soft one in the hard cell (6, 4)."""
    grid = Grid(np.arange(11.0), np.arange(11.0), "planar")
    inside = (0, *grid.inside)
    vof = np.zeros((2, *grid.shape))
    vof[inside] = (np.arange(grid.shape[1]) < 7 + grid.g)[grid.inside[1]]
    vof[0, 6 + grid.g, 4 + grid.g] = 0.999
    vof[1][grid.inside] = 1.0 - vof[inside]
    mass = np.zeros((2, *grid.vertex_shape))
    for group, body in ((0, 1), (1, 0)):
        for dj, di in ((0, 0), (0, 1), (1, 0), (1, 1)):
            mass[group, dj:dj + grid.shape[0], di:di + grid.shape[1]] += 0.25 * vof[body]
    mesh_box = np.array([grid.g, grid.g + grid.nz, grid.g, grid.g + grid.nr])
    both = (mass > 0.0).all(axis=0)
    both[:, [grid.g, grid.g + grid.nr]] = False
    contact_nodes, count = np.zeros(both.shape, dtype=np.int64), both.sum(axis=1)
    for j in range(both.shape[0]):
        contact_nodes[j, : count[j]] = np.nonzero(both[j])[0]
    normal = np.zeros((3, 2, *both.shape))
    normal[:, 0] = 1.0
    masters = np.full((2, *both.shape), FREE)
    contact_geometry.find_masters(grid.g, grid.g + grid.nz, mesh_box, grid.volume, grid.metrics, count, contact_nodes, normal,
                                  vof[0], vof[1], mass, np.array([1, 0]), vof,
                                  np.stack([np.full(grid.shape, damage), np.zeros(grid.shape)]), masters)
    return masters[:, grid.g:, grid.g:]


def test_a_crumb_is_tied_in_debris_alone():
    sound, failed = links(0.9), links(1.0)
    assert extended_cell(6, 5, sound[0, 6, 5])[1] == 7
    assert (failed[0, 6:8, 4:6] == TIED).all()
    assert (failed[0, :, 7] == sound[0, :, 7]).all()
    assert (failed[1] == sound[1]).all()
