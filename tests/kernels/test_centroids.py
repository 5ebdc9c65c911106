"""Positions of bodies in the cells that they share, while they are carried and while they push each other."""

import numpy as np
import pytest

from hydro2d.kernels import boundaries, centroids, column_ranges, interfaces, remap
from hydro2d.kernels.mixed_scratch import BEFORE, SHIFT_Z
from hydro2d.mesh.fields import RHO
from tests.kernels.cells import Cells, handle
from tests.physics.continuity import changes_in_proportion, largest_jump

push_bodies = centroids.push_bodies.source
size_after = centroids.size_after.source
volume_before = centroids.volume_before.source
donor_place = centroids.donor_place.source
forget_centroids = remap.forget_centroids.py_func

#: no body has a velocity of its own
ONE_GROUP, NO_CONTACT = np.zeros((1, 1, 1)), np.zeros((1, 2), dtype=np.int64)


# ----------------------------------------------------------------------------------------------------- slabs that fly


def sizes(cells, dj):
    """Sizes of the cells along the sweep, by which a volume is divided: the same in all cells across."""
    return cells.grid.dz if dj else cells.grid.volume[3]


def faces_of(cells, dj):
    """Sum of the sizes up to every face along the sweep, ghosts included."""
    return np.append(0.0, np.cumsum(sizes(cells, dj)))


def place_slab(cells, m, first, last, dj) -> None:
    """Puts body m between two places along the sweep, in all cells across, and sets the centroids of its parts."""
    faces, size = faces_of(cells, dj), sizes(cells, dj)
    low, high = np.clip(faces[:-1], first, last), np.clip(faces[1:], first, last)
    share = (high - low) / size
    place = np.where((share > 0.0) & (share < 1.0), (0.5 * (low + high) - 0.5 * (faces[:-1] + faces[1:])) / size, 0.0)
    cells.vof[m] = share[:, None] if dj else share[None, :]
    cells.centroid[dj, m] = place[:, None] if dj else place[None, :]
    cells.q[RHO, m] = 1.0


def centre(cells, m, dj) -> float:
    """Centre of a body along the sweep, in one row of cells along it."""
    faces, size = faces_of(cells, dj), sizes(cells, dj)
    vof, place = (each[:, 3] if dj else each[3] for each in (cells.vof[m], cells.centroid[dj, m]))
    inside = slice(2, -2)
    weight = (vof * size)[inside]
    return (weight * (0.5 * (faces[1:] + faces[:-1]) + place * size)[inside]).sum() / weight.sum()


def sweep(cells, dj, swept, order) -> None:
    """Carries all bodies by one step along the sweep, and tidies away the round-off of fractions."""
    face = cells.fz if dj else cells.fr
    face[:-1, :-1] = swept * (cells.grid.volume if dj else 1.0)  # rows have a height of 1
    way = {"dj": dj, "di": 1 - dj, "face": face}
    mirrors = {f"mirror_{edge}": True for edge in ("r_min", "r_max", "z_min", "z_max")}
    cells.call(boundaries.ghost_columns, di=1, **{name: mirrors[name] for name in ("mirror_r_min", "mirror_r_max")})
    cells.call(boundaries.ghost_rows, dj=1, leading=-1, **{name: mirrors[name] for name in ("mirror_z_min", "mirror_z_max")})
    cells.call(column_ranges.list_mixed)
    cells.call(interfaces.sweep_volumes, dj=dj, di=1 - dj, second=True)
    cells.call(interfaces.donor_volumes, void_only=cells.mesh_box, **way)
    cells.call(interfaces.interface_volumes, interface_order=order, gases=np.zeros(len(order), dtype=bool), **way)
    cells.call(remap.sweep_z if dj else remap.sweep_r, second=True, face=face)
    cells.call(centroids.carry_centroids, second=True, own=ONE_GROUP, contact_columns=NO_CONTACT, **way)
    cells.call(remap.tidy, cutoff=1e-13, dj=dj, di=1 - dj, second=True)


#: forth and back, as shares of the smallest cell
STEPS = 2 * (0.3, 0.45, 0.4, 0.35, 0.5, 0.3, -0.2, -0.45, 0.5, 0.1, 0.45, 0.4)


def fly(cells, bodies, dj, smallest, order) -> None:
    """Each body moves by the swept distance, to round-off, from its first place through several cells."""
    start = [centre(cells, m, dj) for m in bodies]
    moved = 0.0
    for step in STEPS:
        sweep(cells, dj, step * smallest, order)
        moved += step * smallest
        for m, first in zip(bodies, start, strict=True):
            assert centre(cells, m, dj) - first == pytest.approx(moved, abs=1e-12)
            assert np.abs(cells.centroid[1 - dj, m]).max() < 1e-12
    assert moved > 6.0 * smallest


@pytest.mark.thorough
@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
@pytest.mark.parametrize("dj", [0, 1])
@pytest.mark.parametrize("thickness", [0.3, 0.9, 1.3])
def test_a_slab_that_flies_through_several_cells_keeps_its_centre(thickness, dj, geometry):
    cells = Cells(nr=16, nz=16, geometry=geometry)
    smallest = sizes(cells, dj)[5]
    first = faces_of(cells, dj)[5] + 0.25 * smallest
    place_slab(cells, 0, first, first + thickness * smallest, dj)
    fly(cells, [0], dj, smallest, np.array([0]))


@pytest.mark.parametrize("dj", [0, 1])
@pytest.mark.parametrize("order", [[0, 1, 2], [2, 1, 0], [1, 0, 2]])
def test_a_slab_between_two_wide_ones_keeps_its_centre_in_any_order(order, dj):
    """Between a gas from the edge on and a third body behind a gap, all of them moving."""
    cells = Cells(nr=20, nz=20, bodies=3)
    for m, (first, last) in enumerate([(4.2, 7.3), (7.3, 7.6), (7.6, 9.9)]):
        place_slab(cells, m, first, last, dj)
    fly(cells, [0, 1, 2], dj, 1.0, np.array(order))


# ------------------------------------------------------------------------------------------------------- cells by hand


def crossed(dj, swept, given=None, place=(0.0, 0.0)) -> Cells:
    """Cells of 1 m^3 with (3, 3) and the next one along the sweep, between which a face sweeps a volume.

    given : how much of it is body; place : where in the strip the body lies
    """
    cells = Cells()
    target = (3 + dj, 4 - dj)
    face = cells.fz if dj else cells.fr
    face[target] = swept
    cells.flux_volume[0, *target] = swept if given is None else given
    cells.flux_place[:, 0, *target] = place
    cells.pre_sweep_volume[...] = 1.0
    cells.pre_sweep_volume[3, 3], cells.pre_sweep_volume[target] = 1.0 + swept, 1.0 - swept
    for row, column in ((3, 3), target):
        cells.mixed[row, cells.mixed_count[row]] = column
        cells.mixed_count[row] += 1
    return cells


def carry(cells, dj, **more) -> None:
    face = cells.fz if dj else cells.fr
    given = {"second": True, "own": ONE_GROUP, "contact_columns": NO_CONTACT, **more}
    cells.call(centroids.carry_centroids, dj=dj, di=1 - dj, face=face, **given)


@pytest.mark.parametrize("second", [False, True])
@pytest.mark.parametrize("dj", [0, 1])
def test_the_flux_of_a_full_cell_lies_at_the_face_all_across(dj, second):
    """A quarter, in the first quarter of the next cell; its place was not written, and the full cell keeps none."""
    cells = crossed(dj, 0.25, place=(np.nan, np.nan))
    target = (3 + dj, 4 - dj)
    cells.vof[0, 3, 3], cells.vof[0, *target] = 1.0, 0.25
    carry(cells, dj, second=second)
    assert cells.centroid[dj, 0, *target] == pytest.approx(-0.375, abs=1e-15)
    assert cells.centroid[1 - dj, 0, *target] == 0.0
    assert np.count_nonzero(cells.centroid) == 1
    cells = crossed(dj, -0.25, place=(np.nan, np.nan))
    cells.vof[0, 3, 3], cells.vof[0, *target] = 0.25, 1.0
    carry(cells, dj, second=second)
    assert cells.centroid[dj, 0, 3, 3] == pytest.approx(0.375, abs=1e-15)
    assert np.count_nonzero(cells.centroid) == 1


@pytest.mark.parametrize("dj", [0, 1])
def test_a_full_cell_that_gives_more_than_comes_keeps_the_rest_where_it_was(dj):
    """It was as large as 1.25 cells; half a cell flows on and the cell behind gives nothing."""
    cells = crossed(dj, 0.5)
    face = cells.fz if dj else cells.fr
    face[3, 3], cells.pre_sweep_volume[3, 3] = 0.25, 1.25
    target = (3 + dj, 4 - dj)
    cells.vof[0, 3, 3], cells.vof[0, *target] = 0.75, 0.5
    carry(cells, dj)
    assert cells.centroid[dj, 0, 3, 3] == pytest.approx(0.125, abs=1e-15)  # from a quarter on
    assert cells.centroid[dj, 0, *target] == pytest.approx(-0.25, abs=1e-15)


@pytest.mark.parametrize("dj", [0, 1])
def test_parts_that_stay_and_that_come_have_one_centroid_by_volume(dj):
    """Of a strip of 0.4 cells a tenth of a cell is body: at 3/4 of the strip along, and at 0.2 across."""
    cells = crossed(dj, 0.4, given=0.1, place=(0.25, 0.2))
    target = (3 + dj, 4 - dj)
    cells.vof[0, 3, 3], cells.vof[0, *target] = 0.2, 0.3
    cells.centroid[dj, 0, *target], cells.centroid[1 - dj, 0, *target] = 0.3 / 0.6, -0.1
    cells.centroid[dj, 0, 3, 3], cells.centroid[1 - dj, 0, 3, 3] = 0.1, 0.05
    before = cells.centroid.copy()
    carry(cells, dj)
    # the next one had 0.6 m^3 of its own, whose middle was 0.2 m up, and 0.2 m^3 of body in that
    along = (0.2 * (before[dj, 0, *target] * 0.6 + 0.2) + 0.1 * (-0.5 + 0.75 * 0.4)) / 0.3
    assert along < 0.35
    assert cells.centroid[dj, 0, *target] == pytest.approx(along, abs=1e-15)
    assert cells.centroid[1 - dj, 0, *target] == pytest.approx((0.2 * -0.1 + 0.1 * 0.2) / 0.3, abs=1e-15)
    # the first one had 1.4 m^3, whose middle was 0.2 m up, and gave from 0.5 to 0.9
    along = (0.3 * (0.1 * 1.4 + 0.2) - 0.1 * (0.5 + 0.75 * 0.4)) / 0.2
    assert cells.centroid[dj, 0, 3, 3] == pytest.approx(along, abs=1e-15)
    assert cells.centroid[1 - dj, 0, 3, 3] == pytest.approx((0.3 * 0.05 - 0.1 * 0.2) / 0.2, abs=1e-15)


@pytest.mark.parametrize("dj", [0, 1])
def test_a_centroid_moves_with_the_cell_where_only_void_flows(dj):
    """Both faces move in by a tenth of a cell: the body does not flow, and is as before, in a cell of 0.8 m^3."""
    cells = crossed(dj, -0.1, given=0.0)
    face = cells.fz if dj else cells.fr
    face[3, 3], cells.pre_sweep_volume[3, 3], cells.vof[0, 3, 3], cells.centroid[dj, 0, 3, 3] = 0.1, 0.8, 0.3, 0.2
    carry(cells, dj)
    assert cells.centroid[dj, 0, 3, 3] == pytest.approx(0.16, abs=1e-15)
    face[3 + dj, 4 - dj], cells.pre_sweep_volume[3, 3] = 0.1, 1.0  # both forward: it is carried along
    carry(cells, dj)
    assert cells.centroid[dj, 0, 3, 3] == pytest.approx(0.26, abs=1e-15)
    carry(cells, dj)
    assert cells.centroid[dj, 0, 3, 3] == pytest.approx(0.35, abs=1e-15)  # no further than to the face


@pytest.mark.parametrize("dj", [0, 1])
def test_inflow_through_the_edge_of_the_mesh_lies_in_the_middle_of_its_strip(dj):
    """Across, it has the place of the ghost cell, whose volumes are not kept; the place written for the face is not read."""
    for side in (0, 1):
        cells = Cells()
        edge, ghost = (5, 6) if side else (2, 1)
        cell, beyond = ((edge, 3), (ghost, 3)) if dj else ((3, edge), (3, ghost))
        face_cell = beyond if side else cell
        face = cells.fz if dj else cells.fr
        face[face_cell], cells.flux_volume[0, *face_cell] = (-0.2, -0.1) if side else (0.2, 0.1)
        cells.flux_place[:, 0, *face_cell] = np.nan
        cells.centroid[:, 0, *beyond] = 0.15
        cells.pre_sweep_volume[...], cells.pre_sweep_volume[cell] = 1.0, 0.8
        cells.vof[0, *cell], cells.vof[0, *beyond] = 0.1, np.nan
        cells.mixed_count[cell[0]], cells.mixed[cell[0], 0] = 1, cell[1]
        carry(cells, dj)
        assert cells.centroid[dj, 0, *cell] == pytest.approx(0.4 if side else -0.4, abs=1e-15)
        assert cells.centroid[1 - dj, 0, *cell] == pytest.approx(0.15, abs=1e-15)


@pytest.mark.parametrize("dj", [0, 1])
def test_outflow_through_the_edge_of_the_mesh_is_removed_at_its_place(dj):
    """A slab of 0.3 m at the lower edge, of which 0.1 m leaves; the cell had 1.1 m^3."""
    cells = Cells()
    face = cells.fz if dj else cells.fr
    cell = (2, 3) if dj else (3, 2)
    face[cell], cells.flux_volume[0, *cell], cells.pre_sweep_volume[cell], cells.vof[0, *cell] = -0.1, -0.1, 1.1, 0.2
    cells.centroid[dj, 0, *cell] = (0.15 - 0.55) / 1.1
    cells.mixed_count[cell[0]], cells.mixed[cell[0], 0] = 1, cell[1]
    carry(cells, dj)
    assert cells.centroid[dj, 0, *cell] == pytest.approx(-0.4, abs=1e-15)


@pytest.mark.parametrize("dj", [0, 1])
def test_outflow_through_either_face_is_removed_at_its_place_in_the_strip(dj):
    """From a cell of 1.1 m^3: a fiftieth of one, at a quarter of a strip of 0.1 m off its middle, and at 0.1 across."""
    for side, place in ((0, 0.25), (0, -0.25), (1, 0.25), (1, -0.25)):
        cells = Cells()
        face = cells.fz if dj else cells.fr
        cell, swept = (3 + dj * side, 3 + (1 - dj) * side), 0.1 if side else -0.1
        face[cell], cells.flux_volume[0, *cell], cells.pre_sweep_volume[3, 3], cells.vof[0, 3, 3] = swept, 0.2 * swept, 1.1, 0.2
        cells.flux_place[:, 0, *cell] = place, 0.1
        cells.centroid[dj, 0, 3, 3], cells.mixed_count[3], cells.mixed[3, 0] = 0.1, 1, 3
        carry(cells, dj)
        left = (0.55 if side else -0.55) + 0.1 * place  # from the middle of the cell as it is after the sweep
        assert cells.centroid[dj, 0, 3, 3] == pytest.approx((0.22 * (0.11 + 0.5 * swept) - 0.02 * left) / 0.2, abs=1e-15)
        assert cells.centroid[1 - dj, 0, 3, 3] == pytest.approx(-0.01, abs=1e-15)


@pytest.mark.parametrize("dj", [0, 1])
def test_in_cells_of_a_contact_a_body_moves_with_its_group(dj):
    """The face is at rest; the body's group moves forward by a tenth of a cell, the other one back by two tenths."""
    cells = Cells(bodies=2, group=[1, 0])
    cells.pre_sweep_volume[...] = 1.0
    cells.vof[:, 3, 3] = 0.3, 0.4
    cells.centroid[dj, :, 3, 3] = -0.3, 0.2
    cells.mixed_count[3], cells.mixed[3, 0] = 1, 3
    own = np.array([-0.2, 0.1])[:, None, None] * np.ones(cells.fr.shape)
    columns = np.zeros((cells.vof.shape[1], 2), dtype=np.int64)
    carry(cells, dj, own=own, contact_columns=columns)
    np.testing.assert_allclose(cells.centroid[dj, :, 3, 3], [-0.3, 0.2], atol=1e-15)
    columns[3] = 3, 4
    carry(cells, dj, own=own, contact_columns=columns)
    np.testing.assert_allclose(cells.centroid[dj, :, 3, 3], [-0.2, 0.0], atol=1e-15)
    assert not cells.centroid[1 - dj].any()


def test_only_cells_that_are_mixed_get_centroids():
    cells = crossed(0, 0.25)
    cells.vof[0, 3, 3:5] = 1.0, 0.25
    cells.mixed_count[:] = 0
    carry(cells, 0)
    assert not cells.centroid.any()


def test_sizes_and_volumes_of_a_cell_around_a_sweep():
    """After the first of two sweeps the faces give the size of a cell, after the second it is that of the mesh."""
    face = np.zeros((4, 4))
    sizes = {"volume": np.full((3, 3), 2.0), "pre_sweep_volume": np.full((3, 3), 1.75), "face": face}
    face[1, 1], face[1, 2], face[2, 1] = 0.5, 0.25, 0.125
    assert size_after(1, 1, handle(dj=0, di=1, second=True, **sizes)) == 2.0
    assert size_after(1, 1, handle(dj=0, di=1, second=False, **sizes)) == 2.0
    assert size_after(1, 1, handle(dj=1, di=0, second=False, **sizes)) == 2.125
    vof, flux = np.full((1, 3, 3), 0.5), np.zeros((1, 4, 4))
    flux[0, 1, 1], flux[0, 1, 2], flux[0, 2, 1] = 0.25, 0.125, 0.0625
    assert volume_before(0, 1, 1, handle(dj=0, di=1, second=True, **sizes, vof=vof,
                         flux_volume=flux)) == 0.875
    assert volume_before(0, 1, 1, handle(dj=1, di=0, second=False, **sizes, vof=vof,
                         flux_volume=flux)) == 0.875


def test_a_donor_gives_from_where_it_was_cut_or_all_across_or_from_beyond_the_edge():
    shape, box = (4, 4), np.array([1, 3, 1, 3])
    volume, face, flux, vof = np.ones(shape), np.zeros(shape), np.zeros((1, *shape)), np.full((1, *shape), 0.5)
    place, centroid = np.zeros((2, 1, *shape)), np.zeros((2, 1, *shape))
    place[:, 0, 1, 2], centroid[:, 0] = (0.25, -0.125), 0.0625

    def given(j, i):
        return donor_place(0, j, i, 1, 2, handle(dj=0, di=1, second=True, mesh_box=box, volume=volume, pre_sweep_volume=volume,
                           face=face, vof=vof, flux_volume=flux, flux_place=place, centroid=centroid))

    assert given(1, 1) == (0.25, -0.125)
    assert given(1, 3) == (0.0, 0.0625)
    vof[0, 1, 1] = 1.0 - 0.5 * (1.0 - centroids.FULL)
    assert given(1, 1) == (0.0, 0.0)


# ------------------------------------------------------------------------------------------------------- what pushes


def pushed(before, after, where, axis) -> np.ndarray:
    """Centroids, along r or z, of the bodies of a cell whose fractions change."""
    centroid, mix = np.zeros((2, len(before), 2, 2)), np.full((2, SHIFT_Z + 1, len(before)), np.nan)
    centroid[axis, :, 1, 1], mix[1, BEFORE] = where, before
    vof = np.zeros((len(before), 2, 2))
    vof[:, 1, 1] = after
    push_bodies(1, 1, handle(vof=vof, centroid=centroid, mix=mix))
    assert not centroid[1 - axis].any()
    return centroid[axis, :, 1, 1]


AXES = pytest.mark.parametrize("axis", [0, 1])
SIDES = pytest.mark.parametrize("side", [-1.0, 1.0])


@AXES
@SIDES
def test_a_gas_that_grows_pushes_a_plate_into_the_void_by_what_it_grows(side, axis):
    """Gas from the face to 0.3, the plate to 0.5, then void."""
    offsets = pushed([0.3, 0.2], [0.4, 0.2], [-0.35 * side, -0.1 * side], axis)
    np.testing.assert_allclose(offsets, [-0.3 * side, 0.0], atol=1e-15)


@AXES
@SIDES
def test_a_body_at_a_face_stays_there_as_others_take_and_give(side, axis):
    """Alone as it grows into void, next to a body that loses what it gains, and with another body beyond the void."""
    assert pushed([0.3], [0.35], [-0.35 * side], axis) == pytest.approx([-0.325 * side], abs=1e-15)
    for growth in (0.05, -0.05):
        offsets = pushed([0.4, 0.6], [0.4 + growth, 0.6 - growth], [-0.3 * side, 0.2 * side], axis)
        np.testing.assert_allclose(offsets, [side * (0.5 * growth - 0.3), side * (0.5 * growth + 0.2)], atol=1e-15)
    for growth in (0.2, 0.1):
        offsets = pushed([0.3, 0.5], [0.3 + growth, 0.5], [-0.35 * side, 0.25 * side], axis)
        np.testing.assert_allclose(offsets, [side * (0.5 * growth - 0.35), 0.25 * side], atol=1e-15)


@AXES
@SIDES
@pytest.mark.parametrize("void", [0.6, 0.1, 1e-3, 1e-9])
def test_the_more_void_there_was_the_more_opens_next_to_it(void, side, axis):
    """A body at the face loses a tenth: in its midst opens the share gained / (void + gained) of that."""
    f = 1.0 - void
    within = 0.1 * 0.1 / (void + 0.1)
    expected = side * (0.5 * f - 0.5 - 0.5 * (0.1 - within))
    assert pushed([f], [f - 0.1], [side * (0.5 * f - 0.5)], axis) == pytest.approx([expected], abs=1e-12)


@AXES
@SIDES
def test_three_slabs_that_trade_volume_stay_side_by_side(side, axis):
    """The middle one grows at the expense of both, three times as much of one as of the other."""
    offsets = pushed([0.3, 0.2, 0.5], [0.27, 0.24, 0.49], np.array([-0.35, -0.1, 0.25]) * side, axis)
    np.testing.assert_allclose(offsets, np.array([-0.365, -0.11, 0.255]) * side, atol=1e-15)


@AXES
@pytest.mark.parametrize("where", [-0.2, 0.0, 0.3])
def test_a_body_in_the_midst_of_void_grows_into_either_gap_in_proportion(where, axis):
    """It fills 0.2; the gaps on either side, of 0.4 - where and 0.4 + where, shrink by a tenth."""
    offsets = pushed([0.2], [0.28], [where], axis)
    assert offsets == pytest.approx([0.9 * where], abs=1e-15)


@AXES
def test_void_that_opens_from_nothing_moves_nobody(axis):
    where = [-0.35, -0.1, 0.25]
    np.testing.assert_array_equal(pushed([0.3, 0.2, 0.5], [0.2, 0.2, 0.4], where, axis), where)


@AXES
def test_void_opens_in_the_midst_of_bodies_that_shrink_by_more_than_others_grow_by(axis):
    """The first body grows by 0.05 from the face on, the second loses 0.15: the rest opens in the middle of the second."""
    assert pushed([0.3, 0.7], [0.35, 0.55], [-0.35, 0.15], axis) == pytest.approx([-0.325, 0.175], abs=1e-15)


@AXES
def test_a_push_does_not_jump_where_there_is_no_void(axis):
    """As void opens or closes, from none or from a little: the bodies trade a tenth of the cell."""
    where = [-0.31, 0.22]  # not quite those of slabs that fill the cell

    def traded(void, opened):
        return pushed([0.4, 0.6 - void], [0.5, 0.5 - void - opened], where, axis)

    for void in (0.0, 1e-12):
        changes_in_proportion(lambda opened: traded(void, max(opened, 0.0)), 0.0, 2.0)  # noqa: B023
    for opened in (0.0, 1e-12, 0.05):
        changes_in_proportion(lambda void: traded(void, opened), 0.0, 20.0, sides=(1.0,))  # noqa: B023
    assert largest_jump(lambda void: traded(void, 0.05), 0.0, 0.2) < 1e-11


@AXES
def test_nothing_moves_where_nothing_changes(axis):
    where = [-0.31, 0.07, 0.2]
    np.testing.assert_array_equal(pushed([0.3, 0.2, 0.4], [0.3, 0.2, 0.4], where, axis), where)


@AXES
def test_a_body_that_was_not_there_before_is_not_pushed(axis):
    assert pushed([0.0, 0.4], [0.1, 0.4], [0.0, -0.1], axis)[0] == 0.0


@AXES
@pytest.mark.parametrize("change", [0.0, 1e-12])
def test_a_push_changes_in_proportion_to_the_growth_of_a_body(change, axis):
    changes_in_proportion(lambda more: pushed([0.3, 0.2], [0.3 + more, 0.2], [-0.35, -0.1], axis), change, 1.0)
    assert largest_jump(lambda more: pushed([0.3, 0.2], [0.3 + more, 0.2], [-0.35, -0.1], axis), -0.3, 0.5) < 1e-12


# --------------------------------------------------------------------------------------------- who has a centroid


def test_bodies_that_fill_a_cell_and_that_are_not_in_it_have_no_centroid():
    vof = np.array([1.0, 0.0, 0.4, 1.0 - 1e-12])[:, None, None] * np.ones((2, 2))
    centroid = np.full((2, 4, 2, 2), 0.1)
    forget_centroids(1, 0, vof, centroid)
    np.testing.assert_array_equal(centroid[:, :, 1, 0], [[0.0, 0.0, 0.1, 0.1]] * 2)
    centroid[:, :, 1, 0] = 0.1
    assert (centroid == 0.1).all()


def test_a_cell_that_a_sweep_fills_forgets_its_centroids():
    """Two thirds are in it, and a third flows in."""
    cells = Cells()
    cells.vof[0, 3, 3:5], cells.q[RHO, 0], cells.centroid[:, 0, 3, 4] = (1.0, 0.75), 2.0, 0.1
    cells.pre_sweep_volume[3, 3], cells.pre_sweep_volume[3, 4], cells.fr[3, 4] = 1.25, 0.75, 0.25
    cells.vof[0, 3, 4], cells.flux_volume[0, 3, 4] = 1.0, 0.25
    cells.mixed_count[3], cells.mixed[3, 0] = 1, 4
    cells.call(remap.sweep_r, face=cells.fr, second=True)
    assert cells.vof[0, 3, 4] == 1.0
    assert not cells.centroid.any()


def test_tidied_cells_forget_centroids_of_what_is_removed_and_of_what_is_made_full():
    cells = Cells(bodies=2)
    cells.vof[:, 3, 3], cells.vof[:, 3, 4] = (0.999999999, 1e-9), (0.5, 0.3)
    cells.q[RHO], cells.centroid[...] = 1000.0, 0.1
    cells.mixed_count[3], cells.mixed[3, :2] = 2, (3, 4)
    cells.call(remap.tidy, cutoff=1e-5, second=True, dj=0, di=1)
    assert cells.vof[:, 3, 3].tolist() == [1.0, 0.0]
    assert not cells.centroid[:, :, 3, 3].any()
    assert (cells.centroid[:, :, 3, 4] == 0.1).all()


# ------------------------------------------------------------------------------------------------------ ghost cells


def with_centroids() -> Cells:
    cells = Cells()
    cells.vof[...] = 0.5
    cells.centroid[0, 0, 2:6, 2:6] = np.arange(1.0, 17.0).reshape(4, 4)
    cells.centroid[1, 0, 2:6, 2:6] = 100.0 + cells.centroid[0, 0, 2:6, 2:6]
    return cells


def test_centroids_beyond_the_ends_of_a_row_are_mirrored_along_it_or_copied():
    cells = with_centroids()
    cells.call(boundaries.ghost_columns, mirror_r_min=True, mirror_r_max=False, di=0)
    assert cells.centroid[0, 0, 3].tolist() == [-6, -5, 5, 6, 7, 8, 8, 8]
    assert cells.centroid[1, 0, 3].tolist() == [106, 105, 105, 106, 107, 108, 108, 108]
    cells.call(boundaries.ghost_columns, mirror_r_min=False, mirror_r_max=True, di=0)
    assert cells.centroid[0, 0, 3].tolist() == [5, 5, 5, 6, 7, 8, -8, -7]
    assert cells.centroid[1, 0, 3].tolist() == [105, 105, 105, 106, 107, 108, 108, 107]


def test_centroids_below_and_above_the_mesh_are_mirrored_along_z_or_copied():
    cells = with_centroids()
    cells.call(boundaries.ghost_rows, mirror_z_min=True, mirror_z_max=False, leading=-1, dj=0)
    assert cells.centroid[0, 0, :, 4].tolist() == [7, 3, 3, 7, 11, 15, 15, 15]
    assert cells.centroid[1, 0, :, 4].tolist() == [-107, -103, 103, 107, 111, 115, 115, 115]
    cells.call(boundaries.ghost_rows, mirror_z_min=False, mirror_z_max=True, leading=-1, dj=0)
    assert cells.centroid[0, 0, :, 4].tolist() == [3, 3, 3, 7, 11, 15, 15, 11]
    assert cells.centroid[1, 0, :, 4].tolist() == [103, 103, 103, 107, 111, 115, -115, -111]
    cells = with_centroids()
    cells.call(boundaries.ghost_rows, mirror_z_min=True, mirror_z_max=True, leading=0, dj=0)
    assert not cells.centroid[:, 0, :2, 4].any()
