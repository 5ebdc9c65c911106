"""Stress, forces and contact, kernel by kernel, on cells made by hand.

In the contact the hard body fills columns 2 and 3, the soft one columns 5 and beyond, and column 4 is half of each.
"""

import numpy as np
import pytest

from hydro2d.kernels import vertex_forces
from hydro2d.kernels.contact import contact_geometry, contact_motion, contact_volumes, dividing_lines
from hydro2d.kernels.contact.contact_geometry import (
    CONSTANT,
    HARD_FIRST,
    HARD_R,
    HARD_Z,
    LINE_R,
    LINE_Z,
    SHARE,
    SOFT_AFTER,
    SOFT_R,
)
from hydro2d.kernels.contact.contact_motion import SEED
from hydro2d.kernels.cut_cells import FREE_SURFACE, INTERFACE, KIND, WHOLE
from hydro2d.mesh.fields import RHO, SRR, SRZ, SZZ
from hydro2d.physics.contact_faces import GAP, weights_beside
from tests.kernels.cells import Cells, lines

ROWS = slice(2, 6)


def stressed(**q) -> Cells:
    """Bodies with s_rr = 10, s_zz = -4, s_rz = 3 Pa at a pressure of 100 Pa, which expand at 1/s; K = 50 Pa."""
    cells = Cells(bodies=2)
    cells.q[SRR], cells.q[SZZ], cells.q[SRZ] = 10.0, -4.0, 3.0
    cells.p[...], cells.bulk[...], cells.solid[...], cells.qr[...], cells.qz[...] = 100.0, 50.0, 1.0, 5.0, 7.0
    cells.qt[...], cells.qrz[...] = 2.0, 0.5
    cells.v0[0] = np.arange(9.0)[:, None]
    cells.vof[0] = 1.0
    return cells


def sums(cells: Cells, **given) -> list:
    cells.call(vertex_forces.total_stress, **{"dt": 0.4, "by_what_is_solid": False, "hard_bodies": np.array([False, False]),
                                             "threshold": 0.5, **given})
    return [getattr(cells, name)[3, 3] for name in ("ph", "sig_rr", "sig_zz", "sig_tt", "sig_rz")]


def test_the_stress_of_a_pure_cell():
    """The pressure at half the step is 100 - 0.2 * 50 * 1 = 90 Pa."""
    assert sums(stressed()) == pytest.approx([90.0, 10 - 90 - 5, -4 - 90 - 7, -6 - 90 - 2, 3.0 - 0.5])


def test_the_deviator_of_a_crumb_is_not_swallowed_by_the_pressure_of_a_full_cell():
    """A crumb with a free surface in a cell that would have 1e17 Pa if it were full: its deviator used to be lost in that."""
    cells = stressed()
    crumb = 1e-9
    cells.mixed_count[3], cells.mixed[3, 0], cells.skin[KIND, 3, 3] = 1, 3, FREE_SURFACE
    cells.vof[:, 3, 3], cells.solid[3, 3], cells.bulk[3, 3] = (crumb, 0.0), crumb, 1e20
    cells.q[SRR, 0], cells.q[SZZ, 0], cells.p[3, 3], cells.qr[3, 3], cells.qz[3, 3] = 3e9, -2e9, 0.0, 0.0, 0.0
    assert sums(cells)[:3] == pytest.approx([0.0, 3.0, -2.0], rel=1e-12)


NOTHING = np.zeros((0, 0, 0, 0))


def accelerated(pushed: np.ndarray = NOTHING, **fields) -> Cells:
    """0.1 s later: vertices of 1 kg around the cell (3, 3), the only one with a stress or an hourglass filter."""
    cells = Cells()
    cells.mass[...] = 1.0
    for name, value in fields.items():
        getattr(cells, name)[..., 3, 3] = value
    cells.call(vertex_forces.accelerate, dt=0.1, pushed=pushed)
    return cells


def test_the_push_of_sources_is_added():
    pushed = np.zeros((2, 1, 9, 9))
    pushed[0, 0, 3, 3], pushed[1, 0, 4, 4] = 2.0, 3.0
    cells = accelerated(pushed, sig_rr=-8.0, sig_zz=-8.0, sig_tt=-8.0)
    assert cells.u[0, 3:5, 3:5] == pytest.approx(np.array([[1.6, 0.4], [-0.4, 0.4]]))
    assert cells.v[0, 3:5, 3:5] == pytest.approx(np.array([[-0.4, -0.4], [0.4, 3.4]]))


def limited(**given) -> Cells:
    """Vertices of 1 kg around the cell (3, 3) that were at rest and fly apart by 0.4 m/s both ways, limited to 0.2 m/s."""
    cells = accelerated(sig_rr=-8.0, sig_zz=-8.0, sig_tt=-8.0)
    cells.call(vertex_forces.limit_speed, speed_limit=0.2, underfilled_density=10.0, **{"edge_velocity": np.zeros(8), **given})
    return cells


def test_a_limited_node_ends_the_step_with_the_velocity_that_an_edge_gives():
    """Column 3 is fixed and row 4 moves at 0.5 m/s: of each row one component of one node ends as limited."""
    end = 0.2 / np.sqrt(2.0)
    cells = limited(constrained=lines(3, -1, -1, 4), edge_velocity=np.array([0.0, 9.0, 9.0, 0.5, 0.0, 0.0, 0.0, 0.0]))
    assert cells.limited[:, 3] == pytest.approx([2 * (end - 0.4), 0.5 * (0.4 - end) * (0.0 + end + 2 * end), 2.0])
    assert cells.limited[:, 4] == pytest.approx([2 * (0.4 - end), 0.5 * (0.4 - end) * (0.0 + end + 2 * 0.5), 2.0])


def test_a_limited_node_ends_the_step_at_rest_on_an_anvil_that_it_does_not_leave():
    """Column 3 is the low edge of r, beyond which the first node of a row would go, and row 4 the low one of z."""
    end = 0.2 / np.sqrt(2.0)
    cells = limited(pushing=np.array([3, -1, 4, -1]))
    assert cells.limited[1, 3] == pytest.approx(0.5 * (0.4 - end) * (0.0 + end + 2 * end))
    assert cells.limited[1, 4] == pytest.approx(0.5 * (0.4 - end) * (0.0 + end + 2 * end))
    assert limited(pushing=np.array([-1, 3, -1, 3])).limited[1, 3] == pytest.approx(0.5 * (0.4 - end) * 4 * end)  # all leave


# -------------------------------------------------------------------------------------------------------- contact


def halves(nz: int = 4) -> Cells:
    """The hard and the soft body, with densities of 4 and 1 kg/m^3, their masses, and where they meet."""
    cells = Cells(nr=5, nz=nz, bodies=2, group=[0, 1])
    cells.vof[1, :, 2:7], cells.vof[0, :, 2:7] = (1.0, 1.0, 0.5, 0.0, 0.0), (0.0, 0.0, 0.5, 1.0, 1.0)
    cells.q[RHO, 0], cells.q[RHO, 1] = 1.0, 4.0
    cells.cell_mass[:, 2:2 + nz] = (cells.vof * cells.q[RHO])[:, 2:2 + nz]
    cells.skin[KIND] = WHOLE
    cells.call(vertex_forces.vertex_masses, i1=8)
    cells.call(contact_geometry.find_contact_nodes)
    cells.call(dividing_lines.contact_lines)
    cells.call(contact_geometry.face_apertures)
    return cells


def test_contact_nodes_are_where_both_groups_have_mass():
    cells = halves()
    assert cells.contact_node_count.tolist() == [0, 0, 2, 2, 2, 2, 2, 0, 0]
    assert cells.contact_nodes[2:7, :2].tolist() == 5 * [[4, 5]]
    assert cells.hard[3, 2:7].tolist() == [1, 1, 0.5, 0, 0]
    assert cells.soft[3, 2:7].tolist() == [0, 0, 0.5, 1, 1]
    np.testing.assert_array_equal(cells.firm, [cells.soft, cells.hard])
    assert cells.heated_columns[4].tolist() == [2, 7]
    cells.call(contact_geometry.number_nodes)
    assert cells.first_slot[2:8].tolist() == [0, 2, 4, 6, 8, 10]


def test_a_vertex_of_one_group_has_one_velocity():
    cells = halves()
    cells.u[0], cells.u[1] = 1.0, 2.0
    cells.call(contact_motion.keep_one, i1=7)
    assert cells.u[:, 3, 3:8].tolist() == [[2, 1, 1, 1, 1], [2, 2, 2, 1, 1]]


def test_the_line_in_the_middle_of_a_cell():
    """Youngs' gradient of 1 to 0 over two cells of 1 m, with weights that add up to 4: a fall of 2 in his units."""
    cells = halves()
    assert cells.contact_columns[ROWS].tolist() == 4 * [[3, 6]]
    line = cells.line[:, 3, 4]
    assert line[[LINE_R, LINE_Z, SHARE]].tolist() == [1.0, 0.0, 0.5]
    assert line[[CONSTANT, SOFT_AFTER, HARD_FIRST]] == pytest.approx([0.5, 1.0, 1.0])
    assert line[HARD_R] == line[SOFT_R] > 0.0
    assert line[HARD_Z] == 0.0


def test_apertures_are_what_the_line_leaves_of_a_face():
    """Half of a face, from its inner end: (2 a - a^2, a^2) with a = 1/2."""
    cells = halves()
    assert cells.aperture_r[:, 3, 3:7].T.tolist() == [[1, 1], [1, 1], [0, 0], [0, 0]]
    assert cells.aperture_z[:, 4, 3:6].T.tolist() == [[1, 1], [0.75, 0.25], [0, 0]]
    assert cells.contact_normal[:, :, 3, 4].tolist() == 3 * [[1, 0]]
    assert cells.touch[3, 4:6].tolist() == [1, 1]
    cells.soft[ROWS, 4] = 0.45  # a twentieth of void between them
    cells.soft[ROWS, 3] = cells.hard[ROWS, 5] = 0.0
    cells.firm[...] = cells.soft, cells.hard
    cells.call(contact_geometry.face_apertures)
    assert not cells.touch[3, 4:6].any()


def void_and_void(left: float, right: float) -> Cells:
    """Half of the solids hard left of r-face 5 and two tenths right of it, with this void; both groups have mass everywhere."""
    cells = halves()
    cells.mass[...] = 1.0
    for column, share, void in ((4, 0.5, left), (5, 0.2, right)):
        cells.hard[ROWS, column], cells.soft[ROWS, column] = share * (1.0 - void), (1.0 - share) * (1.0 - void)
        cells.line[[LINE_R, LINE_Z], :, column], cells.line[SHARE, :, column] = 0.0, share
    cells.firm[...] = cells.soft, cells.hard
    cells.call(contact_geometry.face_apertures)
    return cells


@pytest.mark.parametrize(("left", "right"), [(0.75, 0.75), (0.6, 0.9), (0.3, 0.7)])
def test_the_aperture_of_a_face_is_a_mean_whatever_the_weights_add_up_to(left, right):
    """Two cells with some void each: no part of the face is lost."""
    cells = void_and_void(left * GAP, right * GAP)
    on_left, on_right = weights_beside(3, 4, 3, 5, cells.hard, cells.soft, cells.firm)
    assert 0.8 < on_left * on_right < 1.0
    mean = (0.5 * on_left + 0.2 * on_right) / (on_left + on_right)
    assert cells.aperture_r[:, 3, 5] == pytest.approx([mean, mean], rel=1e-14)
    assert cells.aperture_z[:, 4, 4].tolist() == [0.5, 0.5]  # along z both cells are alike


def test_the_contact_cell_has_the_stress_of_its_one_rate_of_volume():
    cells = halves()
    cells.p[...], cells.bulk[...], cells.rate[...], cells.ph[...] = 100.0, 50.0, 1.0, 70.0
    cells.sig_rr[...], cells.sig_zz[...], cells.sig_tt[...], cells.contact_pressure[...] = -80.0, -75.0, -90.0, 9.0
    cells.call(contact_motion.contact_stress, dt=0.4)
    assert [a[3, 4] for a in (cells.ph, cells.sig_rr, cells.sig_zz, cells.sig_tt)] == pytest.approx([90, -100, -95, -110])
    assert cells.contact_pressure[3, 2:7] == pytest.approx([0, 0, 100, 0, 0])
    assert cells.ph[3, 6] == 70.0


def seen(cells: Cells, dt: float = 0.0) -> np.ndarray:
    step = np.full(8, 1e300)
    cells.call(contact_motion.contact_viscosity, viscosity_linear=0.5, viscosity_quadratic=2.0, courant=0.5,
               shock_courant=0.5, dt=dt, row_step=step)
    return step


def parting(soft: float, pressure: float, dt: float, closing: float = 0.0) -> list[bool]:
    """Whether the full cells on either side of the surface, of hard and of soft body, get a seed of void in a step.

    soft : velocity of the soft body along r, m/s; the soft cell gains as much of its volume per second;  closing : share of
    its volume that every cell loses per second as both groups move along z
    """
    cells = halves()
    cells.km[...] = cells.bulk[...] = cells.cl[...] = cells.rhobar[...] = cells.solid[...] = 1.0
    cells.vof[:, :, 4], cells.hard[:, 4], cells.soft[:, 4] = [[1.0], [0.0]], 0.0, 1.0
    cells.p[...], cells.u[0], cells.v[...] = pressure, soft, -closing * np.arange(9.0)[:, None]
    seen(cells, dt)
    assert cells.rate[3, 3:5] == pytest.approx([-closing, soft - closing])
    assert ((cells.solid[3] < 1.0) == (cells.skin[KIND, 3] == INTERFACE)).all()
    return (cells.solid[3, 3:5] == 1.0 - SEED).tolist()


def test_a_cell_whose_volume_falls_gets_no_seed_before_its_pressure_is_gone():
    assert parting(1.0, 1e-6, 0.5, closing=3.0) == [False, False]
    assert parting(1.0, -1e-6, 0.5, closing=3.0) == [True, True]


def pushed(**given) -> Cells:
    """Velocities after 0.1 s at the nodes between columns 3 and 4: 10 Pa left of them, 2 Pa on their right."""
    cells = halves()
    cells.ph[:, :4], cells.ph[:, 4:], cells.aperture_r[...] = 10.0, 2.0, 0.5
    cells.call(contact_motion.contact_node_forces, dt=0.1, by_what_is_solid=False,
               **{"pushed": NOTHING, **given})
    return cells


def test_pressure_acts_on_each_group_by_its_aperture():
    """On a length of 1 m: half of 8 N on either group, whose masses are 3 kg (hard) and 0.25 kg (soft)."""
    cells = pushed()
    assert cells.mass[:, 3, 4].tolist() == [0.25, 3.0]
    assert cells.u[:, 3, 4] == pytest.approx([0.1 * 4.0 / 0.25, 0.1 * 4.0 / 3.0])
    assert cells.v[:, 3, 4] == pytest.approx([0.0, 0.0])
    of_source = np.zeros((2, *cells.u.shape))
    of_source[:, 1, 3, 4] = 0.5, -7.0
    both = pushed(pushed=of_source)
    assert both.u[:, 3, 4] == pytest.approx([0.1 * 4.0 / 0.25, 0.1 * 4.0 / 3.0 + 0.5])
    assert both.v[:, 3, 4] == pytest.approx([0.0, -7.0])
    constrained_cells = pushed(constrained=lines(4, -1, -1, -1))
    assert constrained_cells.u[:, 3, 4].tolist() == [0.0, 0.0]


def test_both_ways_of_summing_the_corner_forces_agree():
    """Four cells a vertex row by row (`accelerate`), and cell by cell for one group (`contact_node_forces`)."""
    random = np.random.default_rng(3)
    cells = Cells(bodies=2, group=np.array([0, 1]), geometry="cylindrical")
    cells.vof[0], cells.solid[...], cells.cell_mass[0] = 1.0, 1.0, 1.0
    cells.mass[0] = random.uniform(1.0, 2.0, cells.grid.vertex_shape)
    cells.q[SRR, 0], cells.q[SZZ, 0], cells.q[SRZ, 0] = random.standard_normal((3, *cells.grid.shape))
    cells.sig_rr[...], cells.sig_zz[...], cells.sig_rz[...] = cells.q[[SRR, SZZ, SRZ], 0]
    cells.sig_tt[...] = -(cells.sig_rr + cells.sig_zz)
    cells.filter_r[0], cells.filter_z[0] = random.standard_normal((2, *cells.grid.shape))
    cells.u0[0], cells.v0[0] = random.standard_normal((2, *cells.grid.vertex_shape))
    cells.call(vertex_forces.accelerate, dt=0.1, pushed=NOTHING)
    inside = np.s_[0, 3:6, 3:6]
    by_rows = np.array([cells.u[inside], cells.v[inside]])
    cells.contact_node_count[3:6], cells.contact_nodes[3:6, :3] = 3, [3, 4, 5]
    cells.mass[1] = 1.0  # only a divisor here
    cells.call(contact_motion.contact_node_forces, dt=0.1, by_what_is_solid=False, pushed=NOTHING)
    np.testing.assert_allclose([cells.u[inside], cells.v[inside]], by_rows, rtol=1e-12, atol=1e-13)
    assert np.abs(by_rows - [cells.u0[inside], cells.v0[inside]]).min() > 1e-4


def test_no_cell_gives_more_through_both_faces_than_it_has():
    cells = halves()
    cells.flux_volume[0, 3, 4], cells.flux_volume[0, 3, 5] = -0.4, 0.6
    cells.flux_volume[1, 3, 4], cells.flux_volume[1, 3, 5] = -0.1, 0.3
    cells.call(contact_volumes.limit_fluxes, dj=0, di=1)
    assert cells.flux_volume[0, 3, 4:6] == pytest.approx([-0.2, 0.3])
    assert cells.flux_volume[1, 3, 4:6].tolist() == [-0.1, 0.3]
    cells.flux_volume[1, 3, 4], cells.flux_volume[1, 4, 4] = 0.4, 1.0
    cells.call(contact_volumes.limit_fluxes, dj=1, di=0)
    assert cells.flux_volume[1, 3:5, 4] == pytest.approx([0.4, 0.5])
