"""Flow through a face between a cell shared by both groups and void, and a full one: no void enters a body."""

import numpy as np
import pytest

from hydro2d.kernels.contact.contact_volumes import contact_fluxes
from tests.kernels.cells import handle
from tests.physics.continuity import changes_in_proportion

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
