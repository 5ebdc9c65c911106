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


def carry(cells, dj, **more) -> None:
    face = cells.fz if dj else cells.fr
    given = {"second": True, "own": ONE_GROUP, "contact_columns": NO_CONTACT, **more}
    cells.call(centroids.carry_centroids, dj=dj, di=1 - dj, face=face, **given)


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


@AXES
def test_void_that_opens_from_nothing_moves_nobody(axis):
    where = [-0.35, -0.1, 0.25]
    np.testing.assert_array_equal(pushed([0.3, 0.2, 0.5], [0.2, 0.2, 0.4], where, axis), where)


@AXES
def test_nothing_moves_where_nothing_changes(axis):
    where = [-0.31, 0.07, 0.2]
    np.testing.assert_array_equal(pushed([0.3, 0.2, 0.4], [0.3, 0.2, 0.4], where, axis), where)


@AXES
@pytest.mark.parametrize("change", [0.0, 1e-12])
def test_a_push_changes_in_proportion_to_the_growth_of_a_body(change, axis):
    changes_in_proportion(lambda more: pushed([0.3, 0.2], [0.3 + more, 0.2], [-0.35, -0.1], axis), change, 1.0)
    assert largest_jump(lambda more: pushed([0.3, 0.2], [0.3 + more, 0.2], [-0.35, -0.1], axis), -0.3, 0.5) < 1e-12


# --------------------------------------------------------------------------------------------- who has a centroid


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
