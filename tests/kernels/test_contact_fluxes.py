"""Flow through a face between a cell shared by both groups and void, and a full one: no void enters a body."""

import numpy as np
import pytest

from hydro2d.kernels import interfaces
from hydro2d.kernels.contact import contact_volumes
from hydro2d.kernels.contact.contact_volumes import BLEND_RANGE, contact_fluxes, contact_shares
from hydro2d.kernels.interfaces import fill_strips
from hydro2d.physics.contact_faces import GAP
from tests.kernels.cells import handle
from tests.physics.continuity import changes_in_proportion, largest_jump

add_group_flux = contact_volumes.add_group_flux.source

#: rows and columns, the row and the column of the cell that volume leaves to the left
SHAPE, ROW, GIVER = (7, 10), 3, 5


GROUP = np.array([1, 0], dtype=np.int64)
SOLIDS = np.zeros(2, dtype=bool)
MESH_BOX = np.array([2, SHAPE[0] - 2, 2, SHAPE[1] - 2], dtype=np.int64)
#: one part, with the giver's row only
ROWS = np.array([ROW, ROW + 1])
COLUMNS = np.tile(np.array([GIVER - 1, GIVER + 2], dtype=np.int64), (SHAPE[0], 1))


def fluxes(vof, face: float, own: tuple[float, float], part=None, size=None, place=None,
           centroid=None) -> tuple[float, float]:
    """Volumes of the hard and the soft body through the left face of the giver, per volume of a cell.

    own are the volumes that the face sweeps with the velocities of the soft and of the hard body; the nested interfaces begin
    with the soft body.
    place, centroid [2, m, j, i] : receives the positions in the swept volume; the positions in the cells
    """
    line, result = np.zeros((10, *SHAPE)), np.zeros((2, *SHAPE))
    place = np.zeros((2, *vof.shape)) if place is None else place
    centroid = np.zeros((2, *vof.shape)) if centroid is None else centroid
    first = [np.array(order, dtype=np.int64) for order in ((0, 1), (1, 0))]
    swept = np.array(own)[:, None, None] * np.ones(SHAPE)
    contact_fluxes(0, handle(
        dj=0, di=1, parts=ROWS, mesh_box=MESH_BOX, dr=np.ones(SHAPE[1]), dz=np.ones(SHAPE[0]), hard_first=first[0],
        soft_first=first[1], group=GROUP, gases=SOLIDS, contact_columns=COLUMNS, line=line, face=np.full(SHAPE, face),
        own=swept, own_share=vof.copy() if part is None else part, size=np.ones(SHAPE) if size is None else size, vof=vof,
        centroid=centroid, flux_volume=result, flux_place=place, strips=np.zeros((SHAPE[0], 3, 4, 2))))
    return tuple(result[:, ROW, GIVER])


def upright(hard: float, soft: float, beside: float = 1.0):
    """Fractions: left of the giver all is hard, or the share `beside`, right of it soft."""
    vof = np.zeros((2, *SHAPE))
    vof[0, :, :GIVER] = 1.0
    vof[0, ROW, GIVER - 1] = beside
    vof[1, :, GIVER + 1:] = 1.0
    vof[:, :, GIVER] = np.array([hard, soft])[:, None]
    return vof


def oblique(hard: float, soft: float):
    """As `upright`, but below the giver all is hard, and above it soft: both are at its left face."""
    vof = upright(hard, soft)
    vof[:, :ROW, GIVER] = np.array([1.0, 0.0])[:, None]
    vof[:, ROW + 1:, GIVER] = np.array([0.0, 1.0])[:, None]
    return vof


def flux(hard: float, soft: float, swept: float) -> tuple[float, float]:
    """`fluxes` of upright bodies that move together."""
    return fluxes(upright(hard, soft), swept, (swept, swept))


@pytest.mark.thorough
def test_a_full_cell_takes_its_own_body_from_a_cell_with_a_gap():
    assert flux(0.3, 0.6, -0.01) == pytest.approx((-0.01, 0.0), abs=1e-15)


def test_the_flux_lies_where_the_body_was():
    """The ordered interfaces place the hard body; a body that gives nothing or comes from a full cell is in the middle."""
    place, centroid = np.full((2, 2, *SHAPE), np.nan), np.zeros((2, 2, *SHAPE))
    centroid[0, :, :, GIVER] = np.array([-0.498, 0.2])[:, None]
    fluxes(upright(0.004, 0.6), -0.01, (-0.01, -0.01), place=place, centroid=centroid)
    np.testing.assert_allclose(place[:, :, ROW, GIVER], 0.0, atol=1e-12)
    fluxes(upright(0.3, 0.6), 0.01, (0.01, 0.01), place=place)
    assert not place[:, :, ROW, GIVER].any()
    fluxes(oblique(0.1, 0.9), -0.01, (-0.01, -0.01), place=place)
    assert place[1, 0, ROW, GIVER] < 0.0 < place[1, 1, ROW, GIVER]  # the hard body lies below the soft one


def test_it_takes_no_more_than_there_is():
    hard, soft = flux(0.004, 0.6, -0.01)
    assert hard == pytest.approx(-0.004, abs=1e-15)
    assert soft == 0.0


def test_without_void_all_that_is_swept_is_body():
    assert sum(flux(0.4, 0.6, -0.01)) == pytest.approx(-0.01, abs=1e-15)


# ------------------------------------------------------------------------------------------- counterflow


def counterflow(void: float, face: float) -> tuple[float, float]:
    """The soft body flows to the left, out of a full cell, more than the face sweeps; on the left is the hard body, at rest,
    and void. What goes the other way is of the left cell."""
    return fluxes(upright(0.0, 1.0, 1.0 - void), face, (-0.02, 0.0))


def test_void_goes_the_other_way_and_no_body_is_held_up():
    for face in (-0.015, -0.005, 0.0):
        assert counterflow(0.05, face) == (0.0, -0.02)


def mirrored(void: float, face: float) -> tuple[float, float]:
    """`counterflow` seen in a mirror: the soft body flows to the right out of a full cell; the giver has hard body and void."""
    vof = np.zeros((2, *SHAPE))
    vof[1, :, :GIVER], vof[0, :, GIVER:] = 1.0, 1.0
    vof[0, ROW, GIVER] = 1.0 - void
    return fluxes(vof, -face, (0.02, 0.0))


def test_a_face_that_sweeps_nothing_is_like_one_that_sweeps_hardly_anything():
    """Void makes up the flow from where it comes, whichever way the face moves."""
    for face in (-1e-12, 0.0, 1e-12):
        assert counterflow(0.05, face) == (0.0, -0.02)
        assert mirrored(0.05, face) == (0.0, 0.02)


@pytest.mark.parametrize("void", [0.0, 0.01, 0.05])
@pytest.mark.parametrize("face", [-0.015, -1e-12, 0.0, 1e-12, 0.005])
def test_counterflow_in_a_mirror_is_mirrored(void, face):
    hard, soft = counterflow(void, face)
    assert mirrored(void, face) == pytest.approx((-hard, -soft), abs=1e-15)


@pytest.mark.parametrize("void", [0.0, 0.01, 0.05])
def test_counterflow_does_not_jump_where_the_face_turns(void):
    changes_in_proportion(lambda face: counterflow(void, face), 0.0, 2.0)
    changes_in_proportion(lambda face: mirrored(void, face), 0.0, 2.0)


def test_void_to_the_left_goes_the_other_way_as_well():
    """The hard body flows to the right, into a cell of soft body and void; without void the soft body is taken from there."""
    for face in (0.015, 0.005):
        assert fluxes(upright(0.0, 0.95), face, (0.0, 0.02)) == (0.02, 0.0)
        assert fluxes(upright(0.0, 1.0), face, (0.0, 0.02)) == pytest.approx((0.02, face - 0.02), abs=1e-15)


def test_no_more_void_goes_the_other_way_than_there_is():
    for void in (0.0, 0.004, 0.01):
        assert counterflow(void, -0.005) == pytest.approx((0.0, -0.005 - void), abs=1e-15)


@pytest.mark.parametrize("void", [0.0, 0.01, 0.015])
def test_a_counterflow_of_void_comes_in_without_a_jump(void):
    changes_in_proportion(lambda x: counterflow(x, -0.005), void, 2.0, sides=(1.0,) if void == 0.0 else (-1.0, 1.0))
    changes_in_proportion(lambda face: counterflow(0.01, face), -0.02 + void, 2.0)


# ------------------------------------------------------------------------------------------- continuity


@pytest.mark.parametrize("swept", [-0.01, -0.02])
def test_the_body_that_takes_the_rest_does_not_depend_on_a_sign(swept):
    """The soft body would come from where there is none as soon as the face sweeps more than the hard body does."""
    vof = oblique(0.1, 0.9)
    assert fluxes(vof, 0.01, (swept, 0.01)) == pytest.approx((0.01, 0.0), abs=1e-15)
    changes_in_proportion(lambda face: fluxes(vof, face, (swept, 0.01)), 0.01, 1.0)
    for face in (0.008, 0.01, 0.012):
        assert sum(fluxes(vof, face, (swept, 0.01))) == pytest.approx(face, abs=1e-15)


@pytest.mark.parametrize("face", [0.008, 0.012])
def test_a_crumb_takes_no_more_than_it_is(face):
    """A crumb of the soft body in the cell that gives the rest: the hard one gives it."""
    def with_crumb(share):
        vof = oblique(0.1, 0.9)
        vof[:, ROW, GIVER - 1] = 1.0 - share, share
        return fluxes(vof, face, (-0.01, 0.01))

    changes_in_proportion(with_crumb, 0.0, 3.0, sides=(1.0,))
    assert with_crumb(1e-4)[1] < 1.01e-4
    assert sum(with_crumb(1e-4)) == pytest.approx(face, abs=1e-15)


@pytest.mark.parametrize("own", [-0.008, -0.012])
def test_bodies_make_up_for_what_the_void_cannot_give(own):
    """A full cell and one with a little void give the same except for that void."""
    def with_void(void):
        return fluxes(upright(0.3, 0.7 - void), -0.01, (own, own))

    assert sum(with_void(0.0)) == pytest.approx(-0.01, abs=1e-15)
    assert abs(sum(with_void(1e-3)) + 0.01) < 1.001e-3
    for void in (0.0, 1e-12):
        changes_in_proportion(with_void, void, 3.0, sides=(1.0,))
    assert largest_jump(with_void, 0.0, 0.05) < 1e-11


@pytest.mark.parametrize("share", [0.5, 1.0, 1.5])
def test_a_full_cell_takes_its_own_body_more_and_more_as_the_gap_opens(share):
    def with_gap(void):
        return fluxes(upright(0.3, 0.7 - void), -0.05, (-0.05, -0.05))

    changes_in_proportion(with_gap, share * GAP, 10.0)


@pytest.mark.parametrize("share", [1.0, 1.0 - BLEND_RANGE])
def test_a_cell_is_full_by_degrees(share):
    changes_in_proportion(lambda beside: fluxes(upright(0.3, 0.6, beside), -0.01, (-0.01, -0.01)), share, 5.0, sides=(-1.0,))


def shares(hard: float, soft: float, stretch: float) -> tuple[float, float]:
    """(scale of the fractions, size) of a cell of 1 m^3 whose volume before the sweep is stretch."""
    vof, part, size = upright(hard, soft), np.zeros((2, *SHAPE)), np.zeros(SHAPE)
    contact_shares(0, handle(parts=ROWS, mesh_box=MESH_BOX, contact_columns=COLUMNS, volume=np.ones(SHAPE),
                   pre_sweep_volume=np.full(SHAPE, stretch), vof=vof, own_share=part, size=size))
    return part[0, ROW, GIVER] / hard, size[ROW, GIVER]


@pytest.mark.parametrize("stretch", [0.95, 1.05])
def test_the_shares_of_a_cell_do_not_jump_as_it_becomes_one_body_s_or_full(stretch):
    assert shares(1.0, 0.0, stretch) == (1.0, stretch)
    assert shares(0.6, 0.4, stretch) == pytest.approx((stretch, 1.0))
    assert shares(0.6, 0.3, stretch)[0] == pytest.approx(min(stretch, 1.0 / 0.9))
    steepness = 1.5 / BLEND_RANGE * 0.06
    for share in (1.0, 1.0 - BLEND_RANGE):
        changes_in_proportion(lambda hard: shares(hard, 0.0, stretch), share, steepness, sides=(-1.0,))
        changes_in_proportion(lambda hard: shares(hard, 1.0 - hard, stretch), share, steepness, sides=(-1.0,))
        changes_in_proportion(lambda filled: shares(0.6, filled - 0.6, stretch), share, steepness + 2.0, sides=(-1.0,))
    assert largest_jump(lambda filled: shares(0.6, filled - 0.6, stretch), 0.8, 1.0) < 1e-11


def corner_of(scale: float, void: float) -> list[float]:
    """Shares, in strips of a tenth of a cell, of a body with a corner there, next to another one; mixed cells are scaled."""
    f = np.clip(2.5 - np.arange(5), 0.0, 1.0)
    body = np.outer(f, f)
    vof = np.array([body, 1.0 - body])
    vof[1, 2, 2] -= void
    share, rest = np.where(vof == 1.0, 1.0, vof * scale), 1.0 - vof[:, 2, 2].sum()
    strips, given = np.zeros((3, 4, 2)), []
    for dj in (0, 1):
        fill_strips(2, 2, interfaces.ALL, (0.1, 0.1, 0.0), np.arange(2), share, rest, strips, handle(
            group=np.zeros(2, dtype=np.int64), gases=SOLIDS, centroid=np.zeros((2, 2, 5, 5)), dr=np.ones(5), dz=np.ones(5),
            dj=dj))
        given += list(strips[:2, interfaces.SHARE].ravel() / scale)
    return given


def test_a_cell_without_void_has_no_corner_however_its_fractions_are_scaled():
    """Fractions that do not fill the cell on the mesh leave no void."""
    assert corner_of(1.0, 0.3)[0] == pytest.approx(0.05)  # the rectangle is as high as half of the cell
    assert corner_of(0.9, 0.0)[0] > corner_of(1.0, 0.0)[0] > 0.06  # a line goes up beyond
    for scale in (1.0, 1.0 - 1e-12):
        changes_in_proportion(lambda scale: corner_of(scale, 0.0), scale, 2.0)
    assert largest_jump(lambda scale: corner_of(scale, 0.0), 0.9, 1.1) < 1e-11
    assert largest_jump(lambda void: corner_of(1.0, void), 0.0, 0.5) < 1e-11


# ------------------------------------------------------------------------------------------------ which body takes what


def taken(g, more, vof, flux):
    """(what group g of bodies soft, hard, soft cannot take, fluxes of all): cells of 2 m^3 left and right of the face."""
    vof, result = np.array(vof)[:, None, :], np.zeros((3, 1, 2))
    result[:, 0, 1] = flux
    left = add_group_flux(g, more, 0, 1, handle(dj=0, di=1, group=np.array([0, 1, 0]), own_share=vof, size=np.full((1, 2), 2.0),
                vof=vof, flux_volume=result))
    return left, list(result[:, 0, 1])


def test_the_largest_body_of_the_group_takes_what_a_face_lacks():
    assert taken(0, 0.1, [[0.2, 0.0], [0.5, 0.5], [0.3, 0.5]], [0.0, 0.0, 0.0]) == (0.0, [0.0, 0.0, 0.1])
    assert taken(1, -0.1, [[0.2, 0.0], [0.5, 0.5], [0.3, 0.5]], [0.0, -0.2, 0.0]) == (0.0, [0.0, pytest.approx(-0.3), 0.0])


def test_a_body_takes_no_more_than_it_has_there():
    left, flux = taken(0, 0.5, [[0.0, 0.5], [0.9, 0.0], [0.1, 0.5]], [0.0, 0.0, 0.05])
    assert left == pytest.approx(0.35)
    assert flux == pytest.approx([0.0, 0.0, 0.2])
    assert taken(0, 0.5, [[0.0, 0.5], [1.0, 0.0], [0.0, 0.5]], [0.0, 0.0, 0.0]) == (0.5, [0.0, 0.0, 0.0])


def test_flow_the_other_way_ends_first():
    """No body gives from a cell that it is not in: the third flows from the right, and is not on the left."""
    vof = [[0.3, 0.1], [0.7, 0.0], [0.0, 0.9]]
    assert taken(0, 0.2, vof, [-0.1, 0.0, -0.3]) == (0.0, pytest.approx([-0.05, 0.0, -0.15]))
    assert taken(0, 0.5, vof, [-0.1, 0.0, -0.3]) == (0.0, pytest.approx([0.1, 0.0, 0.0]))
    changes_in_proportion(lambda more: taken(0, more, vof, [-0.1, 0.0, -0.3])[1], 0.4, 1.0)
    changes_in_proportion(lambda more: taken(0, more, vof, [0.1, 0.0, 0.0])[1], 0.0, 1.0)
