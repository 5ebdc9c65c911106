"""Two groups that meet: face apertures, dual cells, and the rate of volume from both velocities."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import contact_faces
from hydro2d.physics.contact_faces import GAP
from hydro2d.physics.traction import FILM
from tests.physics.cells import COLUMNS, GEOMETRIES, ROWS, rate_of_volume, small
from tests.physics.continuity import changes_in_proportion

end_apertures = contact_faces.end_apertures.py_func
known = contact_faces.known.py_func
dual_share = contact_faces.dual_share.py_func
weight_beside = contact_faces.weight_beside.py_func
weights_beside = contact_faces.weights_beside.py_func
gas_share = contact_faces.gas_share.py_func
own_inward = contact_faces.own_inward.py_func
meeting = contact_faces.meeting.py_func
blend = contact_faces.blend.py_func
volume_rate = contact_faces.volume_rate.py_func
alternation = contact_faces.alternation.py_func
evened_volume = contact_faces.evened_volume.py_func
closed_volume = contact_faces.closed_volume.py_func
largest_of = contact_faces.largest_of.py_func

HARD, SOFT, BOTH = 1, 0, -1
VELOCITY = st.floats(-1e3, 1e3)


# ------------------------------------------------------------------------------------------------------------ faces


def test_a_group_that_is_alone_has_all_of_the_aperture():
    assert known(0.3, 0.0, 5.0) == 1.0
    assert known(0.3, 2.0, 0.0) == 0.0


@given(st.floats(0.0, 1.0), VELOCITY)
def test_groups_of_one_velocity_have_that_velocity(aperture, velocity):
    assert blend(aperture, velocity, velocity) == pytest.approx(velocity, rel=1e-14)


# ------------------------------------------------------------------------------------------------------- dual cells


def filled(g, hard_cells):
    """Shares of the hard and the soft group: those cells all hard, the rest soft, ghosts unknown."""
    hard, soft, volume = np.full((3, *g.shape), np.nan)
    hard[g.inside], soft[g.inside], volume[g.inside] = 0.0, 1.0, g.volume[g.inside]
    for cell in hard_cells:
        hard[cell], soft[cell] = 1.0, 0.0
    return hard, soft, volume


def edges_of(g):
    return np.array([g.g, g.g + g.nz, g.g, g.g + g.nr])


def share_of(g, group, j, i, hard_cells):
    hard, soft, volume = filled(g, hard_cells)
    return dual_share(group, j, i, edges_of(g), volume, g.metrics, hard, soft)


@pytest.mark.parametrize(("vertex", "cell"), [((2, 2), (2, 2)), ((2, 5), (2, 4)), ((4, 2), (3, 2)), ((4, 5), (3, 4))])
def test_at_a_corner_of_the_mesh_only_its_one_cell_counts(vertex, cell):
    g = small("cylindrical")
    assert share_of(g, HARD, *vertex, [cell]) == 1.0
    assert share_of(g, SOFT, *vertex, [cell]) == 0.0


# ------------------------------------------------------------------------------- weights of the cells beside a face


def beside(void_here: float, void_there: float, gas_here: float = 0.0, gas_there: float = 0.0) -> tuple[float, float]:
    """`weights_beside` of two cells with these shares of void and of gas, and those of `weight_beside` alike."""
    hard, soft = np.full((2, 3, 3), np.nan)
    left, right = 1.0 - void_here - gas_here, 1.0 - void_there - gas_there
    hard[1, 1], soft[1, 1] = 0.3 * left, 0.7 * left
    hard[1, 2], soft[1, 2] = 0.6 * right, 0.4 * right
    firm = np.stack([soft, hard])
    soft[1, 1] += gas_here
    hard[1, 2] += gas_there
    assert gas_share(1, 1, hard, soft, firm) == pytest.approx(gas_here, abs=1e-15)
    assert gas_share(1, 2, hard, soft, firm) == pytest.approx(gas_there, abs=1e-15)
    found = weights_beside(1, 1, 1, 2, hard, soft, firm)
    assert found == (weight_beside(1, 1, 1, 2, hard, soft, firm), weight_beside(1, 2, 1, 1, hard, soft, firm))
    return found


def test_the_face_of_a_full_cell_beside_a_gas_is_its_own():
    assert beside(0.0, 0.0, gas_there=FILM) == pytest.approx((1.0, 0.0), abs=1e-12)
    assert beside(0.0, 0.0, gas_here=0.3) == (0.0, 1.0)
    assert beside(0.2, 0.0, gas_here=0.3) == (0.0, 1.0)


def test_beside_a_gas_a_cell_with_a_film_of_it_or_as_much_void_is_full():
    assert beside(0.0, 0.0, gas_here=0.3, gas_there=FILM) == pytest.approx((0.0, 1.0))
    assert beside(0.0, FILM, gas_here=0.3)[0] == pytest.approx(0.0, abs=1e-12)
    assert beside(0.0, 0.0, gas_here=0.3, gas_there=FILM + GAP) == pytest.approx((1.0, 1.0))
    for gas in (0.0, 0.5 * FILM, FILM):
        changes_in_proportion(lambda x: beside(0.3, 0.5 * GAP, gas_here=x), gas, 4.0 / GAP, sides=(1.0,))
        changes_in_proportion(lambda x: beside(0.0, 0.0, gas_here=0.3, gas_there=x), gas, 4.0 / GAP, sides=(1.0,))


def test_of_two_cells_with_gaps_both_have_the_face():
    assert beside(0.3, 0.2) == (1.0, 1.0)
    assert beside(GAP, 2.0 * GAP) == (1.0, 1.0)


# -------------------------------------------------------------------------------------------- the own side of a group

#: edges that are held, left, right, bottom, top: none; the axis; all
NOWHERE, AXIS, MIRRORS = (-1, -1, -1, -1), (2, -1, -1, -1), (2, 6, 2, 6)


def inward(soft, j: int, i: int, constrained=NOWHERE, mesh=(2, 6, 2, 6)) -> tuple[float, float]:
    """`own_inward` at vertex (j, i) for shares in cells."""
    return own_inward(j, i, np.array(mesh), np.array(constrained), np.asarray(soft, float))


@pytest.mark.parametrize(("rows", "columns", "sign"), [(np.s_[:4], np.s_[:4], (-1, -1)), (np.s_[4:], np.s_[:4], (-1, 1)),
                                                 (np.s_[:4], np.s_[4:], (1, -1)), (np.s_[4:], np.s_[4:], (1, 1))])
def test_at_a_corner_inward_is_the_diagonal(rows, columns, sign):
    soft = np.zeros((8, 8))
    soft[rows, columns] = 1.0
    assert inward(soft, 4, 4) == pytest.approx(np.array(sign) / np.sqrt(2.0))
    assert inward(1.0 - soft, 4, 4) == pytest.approx(-np.array(sign) / np.sqrt(2.0))  # a corner of nothing in the body


@pytest.mark.parametrize("at", [(2, 2), (2, 3), (3, 2), (3, 3), (6, 6), (6, 5), (5, 6), (2, 6), (5, 3), (4, 2)])
def test_mirrors_have_what_is_in_front_of_them(at):
    """In a mesh between four mirrors, inward is the same as in a mesh of mirrored cells; on a mirror it lies in it."""
    shares = np.random.default_rng(8).random((4, 4))
    wide = np.pad(shares, 4, mode="symmetric")
    unknown = np.full((8, 8), np.nan)
    unknown[2:6, 2:6] = shares
    here = inward(unknown, *at, MIRRORS)
    assert here == pytest.approx(inward(wide, at[0] + 2, at[1] + 2, mesh=(0, 12, 0, 12)), abs=1e-14)
    assert at[1] not in (2, 6) or here[0] == pytest.approx(0.0, abs=1e-15)
    assert at[0] not in (2, 6) or here[1] == pytest.approx(0.0, abs=1e-15)


# ---------------------------------------------------------------------------------------------------------- meeting

#: 4 by 4 cells, of which the inner 2 by 2 are the mesh
EDGES = np.array([1, 3, 1, 3])


def meet(j, i, hard, soft):
    """Whether groups meet in a cell, given the cells that contain some of each; beyond the mesh all is full of both."""
    shares = np.ones((2, 4, 4))
    shares[:, 1:3, 1:3] = 0.0
    for share, cells in zip(shares, (hard, soft), strict=True):
        for cell, value in cells.items():
            share[cell] = value
    return meeting(j, i, EDGES, *shares)


@pytest.mark.parametrize(("cell", "beside"), [((1, 1), (2, 1)), ((1, 1), (1, 2)), ((2, 2), (1, 2)), ((2, 2), (2, 1))])
def test_a_full_cell_meets_a_full_neighbour_of_the_other_group(cell, beside):
    assert meet(*cell, {cell: 1.0}, {beside: 1.0})
    assert meet(*cell, {beside: 1.0}, {cell: 1.0})


def test_cells_that_share_only_a_vertex_do_not_meet():
    assert not meet(1, 1, {(1, 1): 1.0}, {(2, 2): 1.0})


# ------------------------------------------------------------------------------------------------ rates of volume


def rate(g, j, i, group, aperture_r, aperture_z, u, v):
    return volume_rate(j, i, group, g.metrics, g.dz[j], aperture_r, aperture_z, u, v)


def velocities(g, seed):
    return np.random.default_rng(seed).normal(size=(2, 2, *g.vertex_shape))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("group", [SOFT, HARD])
def test_with_one_groups_velocities_a_cell_grows_as_its_corners_move(geometry, group):
    g = small(geometry)
    u, v = velocities(g, 11)
    unknown = np.full_like(u, np.nan)
    for j in ROWS:
        for i in COLUMNS:
            expected = rate_of_volume(g, j, i, u[group], v[group])
            assert rate(g, j, i, group, unknown, unknown, u, v) == pytest.approx(expected, rel=1e-5)


def apertures_of_line(g, j, i, n_r, n_z, place):
    """Weights on the four faces of cell (j, i) left by a line in it, unknown elsewhere."""
    def level(row, column):
        r0, z0 = g.r[i] + place[0] * g.dr[i], g.z[j] + place[1] * g.dz[j]
        return n_r * (r0 - g.r[column]) + n_z * (z0 - g.z[row])

    aperture_r, aperture_z = np.full((2, 2, *g.vertex_shape), np.nan)
    for column in (i, i + 1):
        aperture_r[:, j, column] = end_apertures(level(j, column), level(j + 1, column))
    for row in (j, j + 1):
        aperture_z[:, row, i] = end_apertures(level(row, i), level(row, i + 1))
    return aperture_r, aperture_z


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.0, 1.9, 2.7, 4.0, 5.5])
@pytest.mark.parametrize("place", [(0.5, 0.5), (0.1, 0.3), (0.7, 0.9)])
def test_slip_along_a_straight_line_changes_no_volume(angle, place):
    g, n_r, n_z = small("planar"), np.cos(angle), np.sin(angle)
    apertures = apertures_of_line(g, 2, 3, n_r, n_z, place)
    u, v = np.zeros((2, 2, *g.vertex_shape))
    u[HARD], v[HARD] = -800.0 * n_z, 800.0 * n_r
    assert rate(g, 2, 3, BOTH, *apertures, u, v) == pytest.approx(0.0, abs=1e-11)


# ----------------------------------------------------------------------------------------------------------- bodies

GROUP = np.array([0, 1, 1, 0, 1])


def largest(group, *shares):
    vof = np.full((len(shares), 2, 2), np.nan)
    vof[:, 0, 1] = shares
    return largest_of(group, 0, 1, GROUP, vof)


def test_of_a_group_that_is_not_there_no_body_is_the_largest():
    assert largest(HARD, 0.4, 0.0, 0.0, 0.6, 0.0) == -1
    assert largest(SOFT, 0.0, 0.4, 0.0, 0.0, 0.6) == -1


# ----------------------------------------------------------------------------------------- volumes that pressure moves


@given(VELOCITY, VELOCITY, VELOCITY)
def test_what_alternates_is_the_same_from_either_cell_and_upside_down(difference, here, there):
    found = alternation(difference, here, there)
    assert alternation(-difference, there, here) == -found
    assert alternation(-difference, -here, -there) == -found


def test_evening_takes_a_twentieth_of_what_would_balance_the_softer_cell():
    """The volume goes from the higher pressure to the lower."""
    assert evened_volume(2.0, 3.0) == pytest.approx(0.05 * 6.0)
    assert evened_volume(2.0, -3.0) == -evened_volume(2.0, 3.0)


def test_a_face_closes_void_at_the_velocity_of_an_acoustic_wave():
    """Aluminium at 1 GPa: rho c = sqrt(2785 * 78e9) = 14.74e6 kg/(m^2 s), a velocity of 67.8 m/s."""
    assert closed_volume(1e-6, 1e-8, 1e9, 2785.0, 78e9) == pytest.approx(1e-14 * 67.85, rel=1e-3)
    assert closed_volume(2e-6, 3e-8, 1e9, 2785.0, 78e9) == pytest.approx(6.0 * closed_volume(1e-6, 1e-8, 1e9, 2785.0, 78e9))
