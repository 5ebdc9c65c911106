"""Two groups that meet: face apertures, dual cells, and the rate of volume from both velocities."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.physics import contact_faces
from hydro2d.physics.contact_faces import GAP
from hydro2d.physics.traction import FILM
from tests.physics.cells import COLUMNS, GEOMETRIES, ROWS, polygon_volume, rate_of_volume, small
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
face_flow_r = contact_faces.face_flow_r.py_func
face_flow_z = contact_faces.face_flow_z.py_func
volume_rate = contact_faces.volume_rate.py_func
alternation = contact_faces.alternation.py_func
evened_volume = contact_faces.evened_volume.py_func
closed_volume = contact_faces.closed_volume.py_func
largest_of = contact_faces.largest_of.py_func

HARD, SOFT, BOTH = 1, 0, -1
LEVEL = st.integers(-1000, 1000).map(lambda number: number / 1000)
VELOCITY = st.floats(-1e3, 1e3)
#: places along a face, halfway through as many pieces of it
ALONG = (np.arange(20000) + 0.5) / 20000


# ------------------------------------------------------------------------------------------------------------ faces


@given(LEVEL, LEVEL)
def test_apertures_are_twice_the_integrals_of_the_linear_functions_over_the_open_part(first, last):
    open_part = first + (last - first) * ALONG >= 0.0
    expected = 2.0 * np.mean((1.0 - ALONG) * open_part), 2.0 * np.mean(ALONG * open_part)
    assert end_apertures(first, last) == pytest.approx(expected, abs=2e-4)


def test_of_a_face_that_is_open_to_its_middle_the_near_end_has_three_quarters_and_the_far_one_a_quarter():
    assert end_apertures(0.2, -0.2) == (0.75, 0.25)


@given(LEVEL, LEVEL)
def test_a_face_seen_from_its_other_end_has_the_same_apertures(first, last):
    assert end_apertures(last, first) == end_apertures(first, last)[::-1]


@given(LEVEL.filter(bool), LEVEL.filter(bool))
def test_one_group_has_the_rest_of_the_other(first, last):
    np.testing.assert_allclose(np.add(end_apertures(first, last), end_apertures(-first, -last)), 1.0, rtol=1e-14)


@pytest.mark.parametrize(("first", "last", "aperture"), [(1.0, 0.5, 1.0), (0.0, 0.3, 1.0), (-1.0, -0.5, 0.0)])
def test_a_face_on_one_side_of_the_line_is_open_all_or_not_at_all(first, last, aperture):
    assert end_apertures(first, last) == (aperture, aperture)


def test_an_aperture_holds_where_both_groups_have_mass():
    assert known(0.3, 2.0, 5.0) == 0.3


def test_a_group_that_is_alone_has_all_of_the_aperture():
    assert known(0.3, 0.0, 5.0) == 1.0
    assert known(0.3, 2.0, 0.0) == 0.0


@given(st.floats(0.0, 1.0), VELOCITY)
def test_groups_of_one_velocity_have_that_velocity(aperture, velocity):
    assert blend(aperture, velocity, velocity) == pytest.approx(velocity, rel=1e-14)


def test_a_quarter_of_the_aperture_is_a_quarter_of_the_way_to_the_hard_velocity():
    assert blend(0.25, 100.0, 20.0) == pytest.approx(40.0)
    assert blend(1.0, 100.0, 20.0) == 100.0
    assert blend(0.0, 100.0, 20.0) == 20.0


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


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("cell", [(2, 2), (2, 3), (3, 2), (3, 3)])
def test_a_cell_fills_its_corner_of_a_dual_cell(geometry, cell):
    """The corner is the integral over the cell of the bilinear function of the vertex."""
    g = small(geometry)

    def corner(j, i):
        r, weights = g.r[i] + g.dr[i] * ALONG, (1.0 - ALONG if i == 3 else ALONG)
        return g.dz[j] * g.dr[i] * np.mean(weights * (r if g.cylindrical else 1.0))

    whole = sum(corner(j, i) for j in (2, 3) for i in (2, 3))
    assert share_of(g, HARD, 3, 3, [cell]) == pytest.approx(corner(*cell) / whole, rel=1e-7)


@pytest.mark.parametrize("vertex", [(2, 2), (2, 4), (3, 3), (3, 5), (4, 5)])
def test_both_groups_fill_the_dual_cell_together(vertex):
    g = small("cylindrical")
    hard_cells = [(2, 2), (3, 3), (2, 4)]
    assert share_of(g, HARD, *vertex, hard_cells) + share_of(g, SOFT, *vertex, hard_cells) == pytest.approx(1.0)


@pytest.mark.parametrize(("vertex", "cell"), [((2, 2), (2, 2)), ((2, 5), (2, 4)), ((4, 2), (3, 2)), ((4, 5), (3, 4))])
def test_at_a_corner_of_the_mesh_only_its_one_cell_counts(vertex, cell):
    g = small("cylindrical")
    assert share_of(g, HARD, *vertex, [cell]) == 1.0
    assert share_of(g, SOFT, *vertex, [cell]) == 0.0


def test_parts_of_cells_count_by_their_share():
    g = small("planar")
    hard, soft = np.full((2, *g.shape), np.nan)
    hard[g.inside], soft[g.inside] = 0.3, 0.2
    arguments = 3, 3, edges_of(g), g.volume, g.metrics, hard, soft
    assert dual_share(HARD, *arguments) == pytest.approx(0.3)
    assert dual_share(SOFT, *arguments) == pytest.approx(0.2)


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


def test_the_face_of_a_full_cell_beside_a_gap_is_its_own():
    assert beside(0.0, 0.0) == (1.0, 1.0)
    assert beside(0.0, 1.5 * GAP) == pytest.approx((1.0, 0.0), abs=1e-12)
    assert beside(0.3, 0.0) == (0.0, 1.0)


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


def test_the_weight_of_a_cell_falls_from_half_of_gap_to_gap_and_a_half():
    assert beside(0.5 * GAP, 0.0)[0] == 1.0
    assert beside(GAP, 0.0)[0] == pytest.approx(0.5)
    assert beside(0.3, 0.5 * GAP)[0] == pytest.approx(0.5)


@pytest.mark.parametrize(("other", "void"), [(1.0, 0.5 * GAP), (1.0, 1.5 * GAP), (1.0 - GAP, 0.5), (1.0, 0.5)])
def test_a_full_cell_has_the_face_to_a_gap_for_itself(other, void):
    """The weight of a cell with void on its face to a cell of the other group is nil, and becomes so without a jump."""
    def weight(void: float, other: float) -> float:
        hard, soft = np.array([[1.0 - void, 0.0]]), np.array([[0.0, other]])
        firm = np.stack([soft, hard])
        assert weight_beside(0, 1, 0, 0, hard, soft, firm) == 1.0 or other < 1.0 - 0.5 * GAP
        return weight_beside(0, 0, 0, 1, hard, soft, firm)

    changes_in_proportion(lambda x: weight(x, other), void, 2.0 / GAP)
    changes_in_proportion(lambda x: weight(void, x), other, 2.0 / GAP)
    assert weight(0.5, 1.0) == 0.0
    assert weight(0.5, 1.0 - GAP) == weight(0.5 * GAP, 1.0) == weight(0.5, 0.5) == 1.0


@pytest.mark.parametrize("hard", [0.0, 0.4, 1.0])
def test_a_cell_full_of_both_groups_has_the_face_to_a_gap_for_itself(hard):
    """As one full of either group."""
    w = np.array([[0.2, hard]]), np.array([[0.3, 1.0 - hard]])
    w = (*w, np.stack(w[::-1]))
    assert weight_beside(0, 0, 0, 1, *w) == 0.0
    assert weight_beside(0, 1, 0, 0, *w) == 1.0


# -------------------------------------------------------------------------------------------- the own side of a group

#: edges that are held, left, right, bottom, top: none; the axis; all
NOWHERE, AXIS, MIRRORS = (-1, -1, -1, -1), (2, -1, -1, -1), (2, 6, 2, 6)


def inward(soft, j: int, i: int, constrained=NOWHERE, mesh=(2, 6, 2, 6)) -> tuple[float, float]:
    """`own_inward` at vertex (j, i) for shares in cells."""
    return own_inward(j, i, np.array(mesh), np.array(constrained), np.asarray(soft, float))


@pytest.mark.parametrize("filled", [0.2, 0.5, 1.0])
def test_on_a_flat_surface_inward_is_the_normal(filled):
    """The surface lies in the row of cells below the vertex, which are filled by this share."""
    soft = np.zeros((8, 8))
    soft[:3], soft[3] = 1.0, filled
    assert inward(soft, 4, 4) == pytest.approx((0.0, -1.0), abs=1e-15)
    assert inward(soft[::-1], 4, 4) == pytest.approx((0.0, 1.0), abs=1e-15)
    assert inward(soft.T, 4, 4) == pytest.approx((-1.0, 0.0), abs=1e-15)
    assert inward(soft.T[:, ::-1], 4, 4) == pytest.approx((1.0, 0.0), abs=1e-15)


@pytest.mark.parametrize(("rows", "columns", "sign"), [(np.s_[:4], np.s_[:4], (-1, -1)), (np.s_[4:], np.s_[:4], (-1, 1)),
                                                 (np.s_[:4], np.s_[4:], (1, -1)), (np.s_[4:], np.s_[4:], (1, 1))])
def test_at_a_corner_inward_is_the_diagonal(rows, columns, sign):
    soft = np.zeros((8, 8))
    soft[rows, columns] = 1.0
    assert inward(soft, 4, 4) == pytest.approx(np.array(sign) / np.sqrt(2.0))
    assert inward(1.0 - soft, 4, 4) == pytest.approx(-np.array(sign) / np.sqrt(2.0))  # a corner of nothing in the body


def test_of_what_is_two_cells_away_a_tenth_as_much_counts():
    """By share over distance: (0.5, -0.5) and (-1.5, -1.5), a third as far and along the other diagonal."""
    soft = np.zeros((8, 8))
    soft[3, 4], soft[2, 2] = 1.0, 0.6
    r, z = 0.5 / 0.5 - 0.6 * 1.5 / 4.5, -0.5 / 0.5 - 0.6 * 1.5 / 4.5
    assert inward(soft, 4, 4) == pytest.approx((r / np.hypot(r, z), z / np.hypot(r, z)))
    soft[1, 4] = soft[3, 6] = 1.0  # three cells away
    assert inward(soft, 4, 4) == pytest.approx((r / np.hypot(r, z), z / np.hypot(r, z)))


@pytest.mark.parametrize("filled", [0.2, 0.5, 1.0])
@pytest.mark.parametrize("column", [2, 3, 4])
def test_a_flat_surface_goes_on_beyond_the_axis(column, filled):
    """Beside it as on it, inward is exactly along the axis, and so is it at an outer wall."""
    soft = np.zeros((8, 8))
    soft[:3], soft[3] = 1.0, filled
    assert inward(soft, 4, column, AXIS) == pytest.approx((0.0, -1.0), abs=1e-15)
    assert inward(soft[::-1], 4, column, AXIS) == pytest.approx((0.0, 1.0), abs=1e-15)
    assert inward(soft, 4, 8 - column, (-1, 6, -1, -1)) == pytest.approx((0.0, -1.0), abs=1e-15)


@pytest.mark.parametrize("row", [2, 3, 4])
def test_an_upright_surface_goes_on_beyond_a_wall_across_the_axis(row):
    soft = np.zeros((8, 8))
    soft[:, :3], soft[:, 3] = 1.0, 0.4
    assert inward(soft, row, 4, (-1, -1, 2, -1)) == pytest.approx((-1.0, 0.0), abs=1e-15)
    assert inward(soft, 8 - row, 4, (-1, -1, -1, 6)) == pytest.approx((-1.0, 0.0), abs=1e-15)


def test_at_an_edge_that_is_no_mirror_there_is_nothing_beyond():
    """Inward is away from the edge as well: what is beyond the mesh does not count, whatever it is there."""
    soft = np.zeros((8, 8))
    soft[:3], soft[3] = 1.0, 0.4
    for column, sign in ((2, 1.0), (3, 1.0), (4, 0.0), (5, -1.0), (6, -1.0)):
        assert np.sign(inward(soft, 4, column)[0].round(12)) == sign, column
    full = np.ones((8, 8))
    assert [inward(full, *at) for at in ((4, 2), (4, 6), (2, 4), (6, 4))] == [
        pytest.approx(way, abs=1e-15) for way in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))]


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


def test_a_mirror_elsewhere_is_none_at_the_edge():
    """The edge that is held is compared with the mesh."""
    soft = np.zeros((8, 8))
    soft[:3], soft[3] = 1.0, 0.4
    assert inward(soft, 4, 2, (3, -1, -1, -1)) == inward(soft, 4, 2)


@pytest.mark.parametrize("share", [0.1, 1.0])
def test_in_the_middle_of_a_film_nothing_is_inward(share):
    soft = np.zeros((8, 8))
    soft[3:5] = share
    assert inward(soft, 4, 4) == (0.0, 0.0)
    assert inward(soft.T, 4, 4) == (0.0, 0.0)
    assert inward(np.zeros((8, 8)), 4, 4) == (0.0, 0.0)


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


def test_groups_meet_in_a_cell_of_both():
    assert meet(1, 1, {(1, 1): 1e-6}, {(1, 1): 0.5})


@pytest.mark.parametrize(("cell", "beside"), [((1, 1), (2, 1)), ((1, 1), (1, 2)), ((2, 2), (1, 2)), ((2, 2), (2, 1))])
def test_a_full_cell_meets_a_full_neighbour_of_the_other_group(cell, beside):
    assert meet(*cell, {cell: 1.0}, {beside: 1.0})
    assert meet(*cell, {beside: 1.0}, {cell: 1.0})


def test_a_full_cell_meets_none_of_its_own_group():
    assert not meet(1, 1, {(1, 1): 1.0, (1, 2): 1.0, (2, 1): 1.0}, {})
    assert not meet(1, 1, {}, {(1, 1): 1.0, (1, 2): 1.0, (2, 1): 1.0})


def test_cells_that_share_only_a_vertex_do_not_meet():
    assert not meet(1, 1, {(1, 1): 1.0}, {(2, 2): 1.0})


def test_a_neighbour_may_have_void_of_one_and_a_half_per_cent():
    """Half as much again as where groups part: a cell that has just opened still meets its neighbour."""
    assert meet(1, 1, {(1, 1): 1.0}, {(1, 2): 0.9851})
    assert not meet(1, 1, {(1, 1): 1.0}, {(1, 2): 0.9849})


@pytest.mark.parametrize("cell", [(1, 1), (1, 2), (2, 1), (2, 2)])
def test_cells_beyond_the_mesh_meet_nothing(cell):
    assert not meet(*cell, {cell: 1.0}, {})
    assert not meet(*cell, {}, {cell: 1.0})


# ------------------------------------------------------------------------------------------------------------ flows


def ends(first, last, shape, at, step):
    """A field [2, j, i] of pairs at two vertices, one `step` behind the other, unknown elsewhere."""
    field = np.full((2, *shape), np.nan)
    field[:, at[0], at[1]] = first
    field[:, at[0] + step[0], at[1] + step[1]] = last
    return field


def at_face(first, last, shape, at):
    """Weights [end, j, i] of the one face."""
    field = np.full((2, *shape), np.nan)
    field[:, at[0], at[1]] = first, last
    return field


@given(st.lists(VELOCITY, min_size=4, max_size=4), LEVEL, LEVEL)
def test_the_flow_through_an_r_face_is_that_of_each_group_through_its_part(velocities, first, last):
    """Twice the mean over the face of the velocity of the group that wets it, both linear along it."""
    soft_low, hard_low, soft_high, hard_high = velocities
    u = ends((soft_low, hard_low), (soft_high, hard_high), (4, 3), (2, 1), (1, 0))
    hard, soft = (low + (high - low) * ALONG for low, high in ((hard_low, hard_high), (soft_low, soft_high)))
    expected = 2.0 * np.mean(np.where(first + (last - first) * ALONG >= 0.0, hard, soft))
    assert face_flow_r(2, 1, BOTH, at_face(*end_apertures(first, last), (4, 3), (2, 1)), u) == pytest.approx(expected, abs=0.5)


def test_the_flow_of_one_group_through_an_r_face_is_its_own():
    u = ends((3.0, 50.0), (5.0, 70.0), (4, 3), (2, 1), (1, 0))
    unknown = np.full((2, 4, 3), np.nan)
    assert face_flow_r(2, 1, SOFT, unknown, u) == 8.0
    assert face_flow_r(2, 1, HARD, unknown, u) == 120.0


@pytest.mark.parametrize("group", [SOFT, HARD])
@pytest.mark.parametrize("i", COLUMNS)
def test_through_a_z_face_flows_the_velocity_times_the_area_of_the_ring(group, i):
    """v = 4 + 7 r over r dr from r1 to r2."""
    g = small("cylindrical")
    v = np.full((2, *g.vertex_shape), np.nan)
    v[group] = 4.0 + 7.0 * g.r
    r1, r2 = g.r[i], g.r[i + 1]
    expected = 4.0 * (r2**2 - r1**2) / 2.0 + 7.0 * (r2**3 - r1**3) / 3.0
    assert face_flow_z(3, i, group, g.metrics, np.full_like(v, np.nan), v) == pytest.approx(expected, rel=1e-12)


@given(st.lists(VELOCITY, min_size=4, max_size=4), LEVEL, LEVEL)
def test_through_a_planar_z_face_flows_what_each_group_carries_through_its_part(velocities, first, last):
    g, i = small("planar"), 3
    soft_in, hard_in, soft_out, hard_out = velocities
    v = ends((soft_in, hard_in), (soft_out, hard_out), g.vertex_shape, (3, i), (0, 1))
    hard, soft = (inner + (outer - inner) * ALONG for inner, outer in ((hard_in, hard_out), (soft_in, soft_out)))
    expected = g.dr[i] * np.mean(np.where(first + (last - first) * ALONG >= 0.0, hard, soft))
    apertures = at_face(*end_apertures(first, last), g.vertex_shape, (3, i))
    assert face_flow_z(3, i, BOTH, g.metrics, apertures, v) == pytest.approx(expected, abs=0.1)


def test_each_end_of_a_face_has_its_own_aperture():
    """The inner vertex of a z-face belongs to the hard group alone, the outer one to the other."""
    g = small("cylindrical")
    v = ends((np.nan, 6.0), (2.0, np.nan), g.vertex_shape, (3, 3), (0, 1))
    v = np.where(np.isnan(v), 1e9, v)
    flow = face_flow_z(3, 3, BOTH, g.metrics, at_face(1.0, 0.0, g.vertex_shape, (3, 3)), v)
    # 6 at r = 0.1 down to 0 at 0.25 and 0 up to 2: the integrals of the linear functions over r dr
    inner = 6.0 * np.mean((1.0 - ALONG) * (0.1 + 0.15 * ALONG)) * 0.15
    outer = 2.0 * np.mean(ALONG * (0.1 + 0.15 * ALONG)) * 0.15
    assert flow == pytest.approx(inner + outer, rel=1e-6)


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


@pytest.mark.parametrize("aperture", [0.0, 1.0])
def test_by_the_apertures_of_one_group_the_rate_is_that_groups(aperture):
    g = small("cylindrical")
    u, v = velocities(g, 12)
    apertures = np.full_like(u, aperture)
    for i in COLUMNS:
        one = rate_of_volume(g, 2, i, u[int(aperture)], v[int(aperture)])
        assert rate(g, 2, i, BOTH, apertures, apertures, u, v) == pytest.approx(one, rel=1e-5)


def test_where_both_groups_move_alike_the_apertures_do_not_matter():
    g = small("cylindrical")
    u, v = velocities(g, 13)
    u[HARD], v[HARD] = u[SOFT], v[SOFT]
    aperture_r, aperture_z = np.random.default_rng(14).uniform(size=(2, *u.shape))
    for i in COLUMNS:
        expected = rate(g, 3, i, SOFT, aperture_r, aperture_z, u, v)
        assert rate(g, 3, i, BOTH, aperture_r, aperture_z, u, v) == pytest.approx(expected, abs=1e-15)


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


def test_groups_that_close_in_take_the_volume_that_the_line_sweeps():
    """A line 2 r/dr + z/dz = 1 through the cell, hard below: its length times the speed along its normal."""
    g = small("planar")
    apertures = apertures_of_line(g, 2, 3, 2.0 / g.dr[3], 1.0 / g.dz[2], (0.5, 0.0))
    u, v = np.zeros((2, 2, *g.vertex_shape))
    u[HARD], v[HARD] = 3.0, 5.0
    triangle = g.r[3] + np.array([0.0, 0.5, 0.0]) * g.dr[3], g.z[2] + np.array([0.0, 0.0, 1.0]) * g.dz[2]
    moved = triangle[0] + np.array([0.0, 3.0, 3.0]), triangle[1] + np.array([0.0, 5.0, 5.0])
    # from the side of the triangle that is the line to where it would be one second later
    swept = polygon_volume(*(np.array([a[1], b[1], b[2], a[2]]) for a, b in zip(triangle, moved, strict=True)), False)
    assert rate(g, 2, 3, BOTH, *apertures, u, v) == pytest.approx(-swept)


# ----------------------------------------------------------------------------------------------------------- bodies

GROUP = np.array([0, 1, 1, 0, 1])


def largest(group, *shares):
    vof = np.full((len(shares), 2, 2), np.nan)
    vof[:, 0, 1] = shares
    return largest_of(group, 0, 1, GROUP, vof)


def test_the_largest_body_is_looked_for_in_its_group_alone():
    assert largest(HARD, 0.4, 0.1, 0.3, 0.2, 0.0) == 2
    assert largest(SOFT, 0.4, 0.1, 0.3, 0.2, 0.0) == 0
    assert largest(SOFT, 0.1, 0.5, 0.0, 0.2, 0.1) == 3


def test_of_a_group_that_is_not_there_no_body_is_the_largest():
    assert largest(HARD, 0.4, 0.0, 0.0, 0.6, 0.0) == -1
    assert largest(SOFT, 0.0, 0.4, 0.0, 0.0, 0.6) == -1


def test_of_bodies_as_large_as_each_other_the_first_counts():
    assert largest(HARD, 0.1, 0.3, 0.3, 0.0, 0.3) == 1


# ----------------------------------------------------------------------------------------- volumes that pressure moves


def alternating(*pressures):
    """`alternation` between the second and the third of four cells in a row along the surface."""
    first, here, there, last = pressures
    return alternation(here - there, here - 0.5 * (first + there), there - 0.5 * (here + last))


@given(VELOCITY, VELOCITY)
def test_a_linear_field_does_not_alternate(first, slope):
    assert alternating(*(first + slope * n for n in range(4))) == pytest.approx(0.0, abs=1e-12 * (abs(first) + abs(slope)))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_of_a_field_that_alternates_the_whole_difference_counts(sign):
    assert alternating(3.0 - sign, 3.0 + sign, 3.0 - sign, 3.0 + sign) == 2.0 * sign


@pytest.mark.parametrize("bend", [1.0, -1.0])
def test_a_field_that_bends_does_not_alternate(bend):
    assert alternating(*(bend * (n - 1.2) ** 2 for n in range(4))) == 0.0


def test_a_difference_against_the_pattern_does_not_alternate():
    """A cell above its neighbours beside a still higher one that is below the mean of its own."""
    assert alternation(-1.0, 2.0, -3.0) == 0.0
    assert alternation(1.0, -2.0, 3.0) == 0.0


@given(VELOCITY, VELOCITY, VELOCITY)
def test_what_alternates_has_the_sign_of_the_difference_and_is_no_larger_than_anything_it_comes_from(difference, here, there):
    found = alternation(difference, here, there)
    assert found * difference >= 0.0
    assert abs(found) <= min(abs(difference), abs(here), abs(there))


@given(VELOCITY, VELOCITY, VELOCITY)
def test_what_alternates_is_the_same_from_either_cell_and_upside_down(difference, here, there):
    found = alternation(difference, here, there)
    assert alternation(-difference, there, here) == -found
    assert alternation(-difference, -here, -there) == -found


@pytest.mark.parametrize("values", [(0.0, 2.0, -3.0), (2.0, 0.0, -3.0), (1.0, 2.0, 0.0), (2.0, 2.0, -2.0)])
@pytest.mark.parametrize("which", range(3))
def test_alternation_comes_in_without_a_jump(values, which):
    changes_in_proportion(lambda x: alternation(*values[:which], x, *values[which + 1:]), values[which], 1.0)


def test_evening_takes_a_twentieth_of_what_would_balance_the_softer_cell():
    """The volume goes from the higher pressure to the lower."""
    assert evened_volume(2.0, 3.0) == pytest.approx(0.05 * 6.0)
    assert evened_volume(2.0, -3.0) == -evened_volume(2.0, 3.0)


def test_a_face_closes_void_at_the_velocity_of_an_acoustic_wave():
    """Aluminium at 1 GPa: rho c = sqrt(2785 * 78e9) = 14.74e6 kg/(m^2 s), a velocity of 67.8 m/s."""
    assert closed_volume(1e-6, 1e-8, 1e9, 2785.0, 78e9) == pytest.approx(1e-14 * 67.85, rel=1e-3)
    assert closed_volume(2e-6, 3e-8, 1e9, 2785.0, 78e9) == pytest.approx(6.0 * closed_volume(1e-6, 1e-8, 1e9, 2785.0, 78e9))
