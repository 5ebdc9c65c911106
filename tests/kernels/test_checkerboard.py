"""Checkerboards of stress: which patterns fade, how fast, which stay, and that a smooth field is left alone."""

import numpy as np
import pytest

from hydro2d.kernels.contact import contact_checkerboard as kernels
from hydro2d.mesh.fields import RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import Grid
from tests.kernels.cells import handle

#: cells along either side of the mesh, and those that the hard body fills
N, FILLED = 10, np.s_[2:12, 2:9]
BULK, DENSITY, STEP = 3e11, 18000.0, 1e-8
#: share of a checkerboard that fades in a step
SHARE = 0.08


class Block:
    """A hard body (1) that fills columns 0 to 6 of a mesh, and a soft one (0) in the rest; vertices do not move."""

    def __init__(self, geometry="planar", edges=None):
        edges = 1e-3 * np.arange(N + 1.0) if edges is None else edges
        self.grid = g = Grid(edges, edges, geometry)
        self.rows = np.array([g.g, g.g + N])
        self.vof, self.pm, self.q = np.zeros((2, *g.shape)), np.zeros((2, *g.shape)), np.zeros((7, 2, *g.shape))
        self.vof[1][FILLED] = 1.0
        self.vof[0][g.inside] = 1.0 - self.vof[1][g.inside]
        self.q[RHO], self.km = DENSITY, np.full((2, *g.shape), BULK)
        self.j, self.i = np.indices(g.shape)
        self.sign = (-1.0) ** (self.j + self.i)

    def fade(self, contact_columns=None):
        """One step; leaves the swept volumes in fr, fz and own_r, own_z."""
        g, rows, (j0, j1) = self.grid, self.rows, self.rows
        ranges = np.zeros((2, 4, g.vertex_shape[0], 2), dtype=np.int64)
        ranges[..., 0], ranges[..., 1] = j0, j1
        cell_mass = DENSITY * self.vof * g.volume
        self.mass = cell_mass[1]
        hg = SHARE / 16.0 * cell_mass.sum(axis=0) / STEP
        columns = np.zeros((g.shape[0] + 1, 2), dtype=np.int64)
        if contact_columns:
            columns[:] = contact_columns
        found, room, inside = np.full((5, *g.vertex_shape), np.nan), np.full(g.shape, np.nan), np.full(g.shape, np.nan)
        self.fr, self.fz = np.zeros(g.vertex_shape), np.zeros(g.vertex_shape)
        self.own_r, self.own_z = np.zeros((2, *g.vertex_shape)), np.zeros((2, *g.vertex_shape))
        group = np.array([0, 1])
        names = handle(
            parts=rows, mesh_box=np.array([j0, j1, j0, j1]), dt=STEP, group=group, group_ranges=ranges, volume=g.volume,
            hg_coefficient=hg, cell_mass=cell_mass, contact_columns=columns, inside=inside, checkerboard=found, room=room,
            vof=self.vof, pm=self.pm, km=self.km, q=self.q, fr=self.fr, fz=self.fz, own_r=self.own_r, own_z=self.own_z)
        for kernel in (kernels.find_insides, kernels.find_checkerboards, kernels.damp_deviators, kernels.damp_pressures):
            kernel(0, names)
        return self

    @property
    def grown(self):
        """Share that every cell grows by."""
        swept = (self.fr[:-1, 1:] - self.fr[:-1, :-1]) + (self.fz[1:, :-1] - self.fz[:-1, :-1])
        return swept / self.grid.volume


def inner(a):
    """Cells away from the edges of the body."""
    return a[4:10, 4:7]


@pytest.mark.parametrize("row", [SRR, SZZ, SRZ])
def test_a_checkerboard_of_a_deviator_fades_by_its_share(row):
    block = Block()
    block.q[row, 1] = 1e9 * block.sign
    block.fade()
    assert inner(block.q[row, 1] / block.sign) == pytest.approx(1e9 * (1 - SHARE), rel=1e-12)


@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
def test_volume_and_energy_stay(geometry):
    """For any stress: one cell gains what another one loses."""
    block, rng = Block(geometry, 1e-3 * np.cumsum(1.0 + 0.3 * np.sin(np.arange(N + 1.0)))), np.random.default_rng(4)
    block.pm[1], block.q[SRR:SRZ + 1, 1] = rng.normal(0, 1e9, block.grid.shape), rng.normal(0, 1e9, (3, *block.grid.shape))
    block.fade()
    swept = block.grown * block.grid.volume
    assert abs(swept).max() > 1e-14
    assert abs(swept.sum()) < 1e-13 * abs(swept).sum()
    given = block.mass * block.q[E, 1]
    assert abs(given.sum()) < 1e-13 * abs(given).sum()
    assert (block.pm[1] * swept)[block.vof[1] == 1.0].sum() > 0.0  # higher pressures expand


@pytest.mark.parametrize("axis", [0, 1])
def test_waves_along_one_direction_stay(axis):
    """Even of two cells: they push vertices."""
    block = Block()
    block.q[SRR, 1] = wave = 1e9 * (-1.0) ** (block.j if axis else block.i)
    block.fade()
    assert (block.q[SRR, 1] == wave).all()


def test_a_cell_that_stands_out_alone_leaves_nothing_in_its_row_and_column():
    """A linear filter would spread it along both: a stress forced in one cell would stripe the whole rod."""
    block = Block()
    block.q[SZZ, 1, 6, 5] = 1e9
    for _ in range(200):
        block.fade()
    assert abs(block.q[SZZ, 1, 6, 5]) < 0.02e9
    block.q[SZZ, 1, 6, 5] = 0.0
    assert abs(block.q[SZZ, 1]).max() == 0.0


def test_the_groups_own_volumes_are_swept_with_it_where_they_are_in_use():
    block = Block()
    block.pm[1] = 1e9 * block.sign
    block.fade(contact_columns=(5, 7))
    assert abs(block.fr).max() > 0.0
    for own_r, own_z in zip(block.own_r, block.own_z, strict=True):
        assert (own_r[2:12, 5:8] == block.fr[2:12, 5:8]).all()
        assert (own_z[3:12, 5:7] == block.fz[3:12, 5:7]).all()
        assert abs(own_r[:, [2, 3, 4, 8]]).max() == abs(own_z[:, [2, 3, 4, 7]]).max() == 0.0
