"""Flow through a face between a cell shared by both groups and void, and a full one: no void enters a body."""

import numpy as np
import pytest

from hydro2d.kernels.contact.contact_volumes import BLEND_RANGE, contact_fluxes, contact_shares
from tests.kernels.cells import handle
from tests.physics.continuity import changes_in_proportion, largest_jump

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


# ------------------------------------------------------------------------------------------- counterflow


def test_void_to_the_left_goes_the_other_way_as_well():
    """The hard body flows to the right, into a cell of soft body and void; without void the soft body is taken from there."""
    for face in (0.015, 0.005):
        assert fluxes(upright(0.0, 0.95), face, (0.0, 0.02)) == (0.02, 0.0)
        assert fluxes(upright(0.0, 1.0), face, (0.0, 0.02)) == pytest.approx((0.02, face - 0.02), abs=1e-15)


# ------------------------------------------------------------------------------------------- continuity


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
