"""Ranges of bodies and of motion, ghosts, edges with a traction, sums along edges, a mesh that travels: cells made by hand."""

import numpy as np
import pytest

from hydro2d.kernels import audit_sums, boundaries, column_ranges, mesh_motion, triad
from hydro2d.kernels.column_ranges import NOTHING
from hydro2d.mesh.fields import CUT, FAR_P, FAR_U, RHO, SRR, SRZ, E
from tests.kernels.cells import Cells, lines

EMPTY = [NOTHING, 0]


# ------------------------------------------------------------------------------------------------ where bodies are


@pytest.mark.parametrize("anew", [True, False])
def test_a_body_lies_from_its_first_column_to_its_last(anew):
    cells = Cells(bodies=2, group=[0, 1])
    cells.vof[0, 3, 2:6] = 0.0, 0.5, 1.0, 0.0
    cells.vof[1, 3, 5] = 0.1
    cells.call(column_ranges.find_body_ranges, anew=anew)
    assert cells.body_ranges[0, :, 3].tolist() == [[3, 5], [5, 6]]
    assert cells.body_ranges[0, :, 4].tolist() == [EMPTY, EMPTY]
    assert cells.occupied[:, 3].tolist() == [[3, 6], [5, 6]]
    assert cells.occupied[0, 4].tolist() == EMPTY


def test_cells_are_active_within_two_of_a_body():
    cells = Cells(nr=12, nz=12)
    cells.occupied[...] = EMPTY
    cells.occupied[0, 6] = 7, 8
    cells.call(column_ranges.find_active_ranges)
    active = cells.group_ranges[0, 0]
    assert active[4:9].tolist() == [[5, 10]] * 5
    assert active[3].tolist() == active[9].tolist() == EMPTY
    cells.occupied[0, 6] = 2, 3
    cells.call(column_ranges.find_active_ranges)
    assert active[6].tolist() == [2, 5]  # not outside the box


def test_ranges_are_joined_with_those_of_the_neighbouring_rows():
    cells = Cells(nr=8, nz=8)
    cells.empty_ranges()
    cells.body_ranges[0, 0, 5], cells.body_ranges[0, 0, 6] = (8, 9), (3, 4)
    cells.group_ranges[0, 0, 5] = 8, 9
    cells.call(column_ranges.widen_ranges)
    cell, face = cells.body_ranges[1, 0], cells.body_ranges[2, 0]
    assert [cell[j].tolist() for j in (3, 4, 5, 7, 8)] == [EMPTY, [8, 9], [3, 9], [3, 4], EMPTY]
    assert [face[j].tolist() for j in (3, 4, 7, 8, 9)] == [EMPTY, [8, 9], [3, 9], [3, 4], EMPTY]
    assert [cells.group_ranges[0, 1, j].tolist() for j in (4, 5, 6, 7)] == [EMPTY, [8, 9], [8, 9], EMPTY]
    assert [cells.group_ranges[0, 3, j].tolist() for j in (2, 3, 8, 9)] == [EMPTY, [8, 9], [8, 9], EMPTY]


def test_cells_are_mixed_where_a_body_and_something_else_meet():
    cells = Cells(bodies=2)
    cells.vof[:, 3, 2:6] = [[1.0, 0.5, 0.25, 0.0], [0.0, 0.5, 0.0, 0.0]]
    cells.call(column_ranges.list_mixed)
    assert cells.mixed_count[2:6].tolist() == [0, 2, 0, 0]
    assert cells.mixed[3, :2].tolist() == [3, 4]


def test_the_box_of_what_moves():
    cells = Cells()
    limits, box = cells.row_moving, cells.moving
    cells.u[0, 3, 4], cells.v[0, 4, 2] = 1e-300, -1.0
    cells.call(column_ranges.moving_columns)
    assert limits[2:7].tolist() == [EMPTY, [4, 5], [2, 3], EMPTY, EMPTY]
    cells.call(column_ranges.moving_box)
    assert box.tolist() == [3, 5, 2, 5]
    limits[...] = EMPTY
    cells.call(column_ranges.moving_box)
    assert box[0] == box[1] == 7


# ------------------------------------------------------------------------------------------------ beyond the edges


def ghosts() -> Cells:
    cells = Cells()
    cells.vof[0, 2:6, 2:6] = np.arange(1.0, 17.0).reshape(4, 4) / 32
    cells.q[:, 0, 2:6, 2:6] = cells.vof[0, 2:6, 2:6]
    return cells


def test_ghost_columns_are_images_at_a_mirror_and_copies_at_an_open_edge():
    cells = ghosts()
    cells.call(boundaries.ghost_columns, mirror_r_min=True, mirror_r_max=False, di=1)
    row = 32 * cells.vof[0, 3]
    assert row.tolist() == [6, 5, 5, 6, 7, 8, 8, 8]
    assert (32 * cells.q[RHO, 0, 3]).tolist() == row.tolist()
    assert (32 * cells.q[SRZ, 0, 3]).tolist() == [-6, -5, 5, 6, 7, 8, 8, 8]


def test_ghost_vertices_are_images_at_a_mirror_and_copies_at_an_open_edge():
    cells = Cells()
    cells.u[0] = cells.v[0] = 10.0 * np.arange(9.0)[:, None] + np.arange(9.0)
    cells.call(boundaries.ghost_vertices_r, mirror_r_min=True, mirror_r_max=False)
    assert cells.u[0, 3].tolist() == [-34, -33, 32, 33, 34, 35, 36, 36, 36]
    assert cells.v[0, 3].tolist() == [34, 33, 32, 33, 34, 35, 36, 36, 36]
    cells.call(boundaries.ghost_vertices_z, mirror_z_min=False, mirror_z_max=True)
    assert cells.u[0, :, 4].tolist() == [24, 24, 24, 34, 44, 54, 64, 54, 44]
    assert cells.v[0, :, 4].tolist() == [24, 24, 24, 34, 44, 54, 64, -54, -44]


def test_an_edge_with_a_velocity_takes_momentum_and_work_and_the_axis_neither():
    cells, velocity = Cells(), np.array([0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0])
    cells.u[...], cells.v[...], cells.v0[...], cells.mass[0, 6, 3], cells.mass[0, 4, 2] = 1.0, 7.0, 6.0, 3.0, 3.0
    cells.call(boundaries.constrain, constrained=lines(2, -1, -1, 6), edge_velocity=velocity)
    assert not cells.u[0, :, 2].any()
    assert cells.u[0, :, 3].all()
    assert cells.v[0, 4:8, 3].tolist() == [7, 7, 5, 7]
    assert cells.walls[3, :, 6].tolist() == [3.0 * (7 - 5), 0.5 * 3.0 * (7 - 5) * (6 + 5)]
    assert not cells.walls[3, :, :6].any()
    assert not cells.walls[:3].any()


def test_a_held_edge_takes_the_velocity_along_it_but_not_that_across_another_edge():
    """Column 6 is held at 5 m/s along z, and row 2 has a velocity of 2 m/s across it, which goes first at their corner."""
    cells, velocity = Cells(), np.array([0.0, 0.0, 2.0, 0.0, 0.0, 5.0, 0.0, 0.0])
    cells.u[...], cells.v[...], cells.v0[...], cells.mass[...] = 1.0, 7.0, 6.0, 3.0
    cells.call(boundaries.constrain, constrained=lines(-1, 6, 2, -1, along=(-1, 6, -1, -1)), edge_velocity=velocity)
    assert cells.v[0, 1:5, 6].tolist() == [5, 2, 5, 5]
    assert cells.v[0, 4, 5] == 7
    assert not cells.u[0, :, 6].any()
    assert cells.walls[1, 0, 4] == 3.0 * (7 - 5)
    assert cells.walls[1, 1, 4] == 0.5 * 3.0 * (1 - 0) * (0 + 0) + 0.5 * 3.0 * (7 - 5) * (6 + 5)
    cells.u[...] = 1.0
    cells.u0[...] = 4.0
    cells.call(boundaries.constrain, constrained=lines(-1, -1, 2, -1, along=(-1, -1, 2, -1)), edge_velocity=np.zeros(8))
    assert not cells.u[0, 2].any()
    assert cells.u[0, 3].all()
    assert cells.walls[2, 1, 2] == 9 * 0.5 * 3.0 * (1 * 4 + 2 * 6)  # along r, and along z of what has 2 m/s


def test_no_mass_flows_beyond_the_edges_but_on_through_an_open_one():
    flow = np.ones((1, 9, 9))
    Cells().call(boundaries.close_mass_flux, di=1, opens_low=False, opens_high=False, flux_mass=flow)
    assert not flow[0, [1, 6]].any()
    assert flow[0, 2:6].all()
    flow[0, 2:6] = np.arange(9.0)
    Cells().call(boundaries.close_mass_flux, di=1, opens_low=True, opens_high=True, flux_mass=flow)
    assert flow[0, 3].tolist() == [0, 2, 2, 3, 4, 5, 6, 6, 8]
    flow[...] = np.arange(9.0)[:, None]
    Cells().call(boundaries.close_mass_flux, di=0, opens_low=True, opens_high=False, flux_mass=flow)
    assert flow[0, :, 4].tolist() == [0, 2, 2, 3, 4, 5, 6, 7, 8]
    assert not flow[0, :, [1, 6]].any()


def stiff(bodies: int = 1) -> Cells:
    """Cells of rho c_l = 6 without shear waves, full of the first body, which the outer edge along r cuts, at 4 m/s."""
    cells = Cells(bodies=bodies)
    cells.rhobar[2:6, 2:6], cells.cl[2:6, 2:6], cells.bulk[2:6, 2:6] = 2.0, 3.0, 18.0
    cells.vof[0, 2:6, 2:6], cells.far[CUT, 1, 0] = 1.0, 1.0
    cells.mass[...], cells.u[0, :, 6], cells.drag[...] = 1.0, 4.0, 9.0
    return cells


AT_OUTER = np.array([-1, 6, -1, -1])


def test_a_transmitting_edge_has_the_impedance_of_the_cells_next_to_it():
    """rho c_l = 6: over the step of 0.5 s, 3 kg/s on a vertex between two cells of the edge and half of that at its ends."""
    cells = stiff()
    cells.call(boundaries.load_edges, loaded=AT_OUTER, dt=0.5)
    assert cells.u[0, 1:8, 6].tolist() == pytest.approx([4.0, 1.6, 1.0, 1.0, 1.0, 1.6, 4.0])
    assert cells.drag[1, 0, 0, 1:8] == pytest.approx([0.0, 2.4, 3.0, 3.0, 3.0, 2.4, 0.0])
    assert not cells.drag[1, 0, 1].any()
    before = cells.u.copy()
    cells.call(boundaries.load_edges, dt=0.5)
    assert (cells.u == before).all()


def test_a_transmitting_edge_acts_on_what_differs_from_the_start_and_on_bodies_that_it_cuts():
    """With 4 m/s at the start there is no drag; 8 Pa push inward by 0.5 s 8 N/(1 + 3) kg; a body that is not cut is free."""
    cells = stiff()
    cells.far[FAR_U, 1] = 4.0
    cells.call(boundaries.load_edges, loaded=AT_OUTER, dt=0.5)
    assert cells.u[0, 3:6, 6] == pytest.approx([4.0, 4.0, 4.0], rel=1e-15)
    cells.far[FAR_P, 1] = 8.0
    cells.call(boundaries.load_edges, loaded=AT_OUTER, dt=0.5)
    assert cells.u[0, 3:6, 6] == pytest.approx([3.0, 3.0, 3.0], rel=1e-15)
    cells = stiff()
    cells.far[...] = 0.0
    cells.call(boundaries.load_edges, loaded=AT_OUTER, dt=0.5)
    assert (cells.u[0, :, 6] == 4.0).all()
    half = stiff(bodies=2)  # half of the cell is a second body, which is not cut
    half.vof[:, 2:6, 2:6] = 0.5
    half.call(boundaries.load_edges, loaded=AT_OUTER, dt=0.5)
    assert half.u[0, 3:6, 6] == pytest.approx(4.0 / (1.0 + 0.5 * 3.0))


@pytest.mark.parametrize(("edge", "push"), [(0, 2.0), (1, -2.0), (2, 2.0), (3, -2.0)])
def test_a_pressure_pushes_inward_where_a_body_lies(edge, push):
    """4 Pa on 1 m for 0.5 s give 2 m/s to 1 kg, and half of that where the cells are half full; nothing where there is void."""
    cells, loaded, pressure = Cells(), np.full(4, -1), np.zeros(4)
    loaded[edge], pressure[edge] = (2, 6, 2, 6)[edge], 4.0
    cells.rhobar[2:6, 2:6], cells.vof[0, 2:6, 2:6], cells.mass[...] = 2.0, 1.0, 1.0
    velocity = cells.u[0].T if edge < 2 else cells.v[0]
    cells.call(boundaries.load_edges, loaded=loaded, edge_pressure=pressure, dt=0.5)
    assert velocity[loaded[edge], 1:8].tolist() == [0.0, 0.5 * push, push, push, push, 0.5 * push, 0.0]
    cells.u[...], cells.v[...], cells.vof[0, 2:6, 2:6] = 0.0, 0.0, 0.5
    cells.call(boundaries.load_edges, loaded=loaded, edge_pressure=pressure, dt=0.5)
    assert velocity[loaded[edge], 3:6].tolist() == [0.5 * push] * 3
    cells.u[...], cells.v[...], cells.rhobar[...] = 0.0, 0.0, 0.0
    cells.call(boundaries.load_edges, loaded=loaded, edge_pressure=pressure, dt=0.5)
    assert not velocity.any()


def test_both_groups_at_a_vertex_gain_the_same_velocity_from_a_pressure():
    """4 Pa on 1 m for 0.5 s on masses of 1 and 3 kg, which keep their difference of velocities."""
    cells = Cells(bodies=2, group=[0, 1])
    cells.rhobar[2:6, 2:6], cells.vof[:, 2:6, 2:6] = 2.0, 0.5
    cells.mass[0], cells.mass[1], cells.u[1] = 1.0, 3.0, 7.0
    cells.call(boundaries.load_edges, loaded=AT_OUTER, edge_pressure=np.array([0.0, 4.0, 0.0, 0.0]), dt=0.5)
    assert cells.u[:, 4, 6].tolist() == [-0.5, 6.5]


def test_energy_taken_by_dashpots_follows_the_velocities_at_the_end():
    """2 N s along r and 3 N s along z on a vertex that goes from 4 to 1 m/s and from 0 to 5 m/s, from any cause."""
    cells, energy = Cells(), np.full((4, 2), 9.0)
    cells.drag[1, 0, :, 3] = 2.0, 3.0
    cells.u0[0, 3, 6], cells.u[0, 3, 6], cells.v[0, 3, 6] = 4.0, 1.0, 5.0
    cells.call(boundaries.sum_drag, loaded=AT_OUTER, taken=energy)
    assert energy[1].tolist() == [3.0, 2.0 * 2.5 + 3.0 * 2.5]
    assert not energy[[0, 2, 3]].any()
    cells.call(boundaries.sum_drag, taken=energy)
    assert not energy.any()


# ------------------------------------------------------------------------------------------- sums of what goes out


def test_outflow_and_inflow_are_summed_separately():
    cells = Cells(bodies=2)
    cells.edge_flux[:, 0, 1, 3], cells.edge_flux[:, 1, 1, 3] = (2.0, 3.0), (8.0, 30.0)
    cells.edge_flux[1, 0, 0, 4], cells.edge_flux[1, 1, 0, 4] = -1.0, -5.0
    cells.edge_flux[1, 0, 0, 6] = 100.0  # beyond the active box
    cells.call(audit_sums.sum_outflow, di=1)
    assert cells.outflow[0].tolist() == [[0, 0, 0], [-8, 0, -2]]
    assert cells.outflow[1].tolist() == [[30, 0, 3], [-5, -1, 0]]


def test_momentum_that_goes_out_and_that_comes_in():
    cells = Cells()
    cells.edge_dual[0, 1, :, 6] = 2.0, 7.0, 3.0, 1.0, 0.5  # the last vertex of the box counts
    cells.edge_dual[0, 0, :, 2] = 1.0, 7.0, -4.0, 0.25, 1.0
    cells.call(audit_sums.sum_kinetic_outflow, di=1)
    assert cells.kinetic_outflow.tolist() == [[[0, 0], [4, -1.25]], [[3, 1.5], [0, 0]]]


def test_what_the_rows_of_vertices_lose_is_summed():
    cells = Cells(bodies=2, group=[0, 1])
    cells.limited[...], cells.transfer[...] = np.arange(27.0).reshape(3, 9), -np.arange(45.0).reshape(5, 9)
    cells.walls[3, 1] = np.arange(9.0)
    cells.limited_sum[...], cells.walls_sum[...], cells.transfer_sum[...] = 9.0, 9.0, 9.0
    cells.call(audit_sums.sum_acceleration, contact=True)
    assert cells.limited_sum.tolist() == [36.0, 117.0, 198.0]
    assert cells.transfer_sum.tolist() == [-36.0, -117.0, -198.0, -279.0, -360.0]
    assert cells.walls_sum.tolist() == [[0, 0], [0, 0], [0, 0], [0, 36.0]]


@pytest.mark.parametrize("both", [True, False])
def test_what_a_sweep_discards_is_summed(both):
    """The energy that vertices give to cells is among it only if the advection keeps both."""
    cells = Cells(bodies=2)
    cells.momentum_sums[...], cells.removed[...] = np.arange(45.0).reshape(5, 9), np.arange(54.0).reshape(6, 9)
    cells.deposited[...], cells.deposited_sum[...] = np.arange(9.0), 7.0
    cells.call(audit_sums.sum_momentum, both=both)
    assert cells.momentum_sum.tolist() == [36.0, 117.0, 198.0, 279.0, 360.0]
    assert cells.removed_sum.tolist() == [36.0, 117.0, 198.0, 279.0, 360.0, 441.0]
    assert cells.deposited_sum.tolist() == [36.0 if both else 0.0]


# ------------------------------------------------------------------------------------------------ a mesh that travels


def test_faces_sweep_less_by_what_the_mesh_advances():
    """A column from 1 to 2 m of radius has an area of 1.5 m^2 per radian."""
    cells = Cells(bodies=2, group=[0, 1], geometry="cylindrical")
    cells.group_ranges[0, 1, :] = 3, 4
    cells.call(mesh_motion.subtract_mesh_motion, advance=0.1)
    assert cells.fz[2:7, 3] == pytest.approx(5 * [-0.15])
    assert np.count_nonzero(cells.fz) == 5
    cells.contact_columns[...], cells.contact_columns[3] = EMPTY, (3, 4)
    cells.call(mesh_motion.subtract_mesh_motion_of_groups, advance=0.1)
    assert cells.own_z[:, 3:5, 3] == pytest.approx(np.full((2, 2), -0.15))
    assert np.count_nonzero(cells.own_z) == 4


def test_faded_values_are_zero():
    cells = Cells()
    cells.q[:, 0, 3, 3:5] = -1e-31, 1e-29
    cells.call(mesh_motion.flush_tiny_values)
    assert cells.q[RHO, 0, 3, 3] == -1e-31
    assert cells.q[[E, SRR, SRZ], 0, 3, 3].tolist() == [0.0, 0.0, 0.0]
    assert (cells.q[:, 0, 3, 4] == 1e-29).all()


def test_the_triad():
    b, c, a = np.full((3, 2), 5.0), np.full((3, 2), 7.0), np.zeros((3, 2))
    triad.triad(1, 3, 2.0, b, c, a)
    assert a.tolist() == [[0, 0], [19, 19], [19, 19]]
