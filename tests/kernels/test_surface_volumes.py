"""Volumes that pressure moves between the cells of a contact: what alternates evens out, and void between groups closes."""

import numpy as np
import pytest

from hydro2d.kernels.contact.contact_geometry import HARD_R, HARD_Z
from hydro2d.kernels.contact.surface_volumes import even_out, heat_evened_cells
from hydro2d.kernels.cut_cells import FREE_SURFACE, INTERFACE, KIND, WHOLE
from hydro2d.mesh.fields import RHO, E
from tests.kernels.cells import Cells

#: cells of the mesh along either side, the first of them after the ghosts, and the rows and columns of all
N, FIRST = 6, 2
MESH, EDGES = slice(FIRST, FIRST + N), slice(FIRST, FIRST + N + 1)
SOFT, HARD = 0, 1
#: factor between pressure and what a face of 1 m closes in a step of 0.1 s: rho c is 5
CLOSED = 0.1 / 5.0


class Surface(Cells):
    """6 x 6 cells of half of each group, all of them in the contact; indices without the ghosts, of which nothing is known.

    pressure : p_c, Pa;  kind, solid : kinds and filled shares of the cells;  normal : of the surface;  slip : of the hard
    group along z beside the soft one, m/s.  K and rho c are 5 in SI units; the volumes of the cells differ.
    """

    def __init__(self, pressure=0.0, kind=INTERFACE, solid=1.0, normal=(1.0, 0.0), slip=1e3, viscosity=0.0):
        super().__init__(nr=N, nz=N, bodies=2, group=[SOFT, HARD])
        for name in ("ph", "qr", "sig_rr", "sig_zz", "sig_tt", "sig_rz"):
            getattr(self, name)[...] = np.nan
            getattr(self, name)[MESH, MESH] = 0.0
        self.ph[MESH, MESH], self.qr[MESH, MESH], self.solid[MESH, MESH] = pressure, viscosity, solid
        self.skin[KIND, MESH, MESH], self.vof[:, MESH, MESH] = kind, 0.5
        self.q[RHO] = np.array([2.0, 6.0])[:, None, None]
        self.bulk[MESH, MESH], self.rhobar[MESH, MESH] = 5.0, 5.0
        self.line[HARD_R], self.line[HARD_Z] = normal
        self.contact_columns[MESH] = FIRST, FIRST + N
        self.v[HARD] = slip
        self.volumes = np.ones(self.grid.shape)
        self.volumes[MESH, MESH] = 2.0 + np.add.outer(np.arange(N), np.arange(N))

    def fill(self, group: int, j, i) -> None:
        """Fills whole cells with one group."""
        at = np.s_[MESH, MESH]
        self.vof[group][at][j, i], self.vof[1 - group][at][j, i], self.skin[KIND][at][j, i] = 1.0, 0.0, WHOLE

    def press(self, j, i, rr: float, zz: float, tt: float, rz: float = 0.0) -> None:
        """Gives cells a stress."""
        for name, value in (("sig_rr", rr), ("sig_zz", zz), ("sig_tt", tt), ("sig_rz", rz)):
            getattr(self, name)[MESH, MESH][j, i] = value

    def moved(self):
        """(volumes through faces along r and along z, growth of the cells, heat of both bodies of every cell in J)."""
        self.even_r[...], self.even_z[...] = np.nan, np.nan
        self.soft[...], self.hard[...] = self.vof
        self.firm[...] = self.vof
        self.call(even_out, dt=0.1, volume=self.volumes)
        r, z = self.even_r[MESH, EDGES], self.even_z[EDGES, MESH]
        self.q[E] = 0.0
        self.call(heat_evened_cells, volume=self.volumes)
        heat = (self.q[E] * self.q[RHO] * self.vof * self.volumes)[:, MESH, MESH]
        return r, z, np.diff(r, axis=1) + np.diff(z, axis=0), heat


#: up and down from cell to cell, in both directions
CHECKERS = 0.2 * (-1.0) ** np.add.outer(np.arange(N), np.arange(N))


# -------------------------------------------------------------------------------------------------- equation 8: evening


def test_a_uniform_pressure_moves_nothing():
    r, z, _, heat = Surface(3.0, viscosity=0.7).moved()
    assert (r == 0.0).all()
    assert (z == 0.0).all()
    assert (heat == 0.0).all()


def test_a_pattern_along_the_surface_decays_and_what_it_loses_is_heat():
    """Every cell that is above its neighbours grows by a twentieth of what would make the stiffer of a pair even."""
    pattern, cells = 3.0 + CHECKERS, Surface(3.0 + CHECKERS)
    r, z, change, heat = cells.moved()
    volume = cells.volumes[MESH, MESH]
    assert ((change > 0.0) == (pattern > 3.0)).all()
    after = pattern - 5.0 * change / volume
    assert np.ptp(after) < np.ptp(pattern)
    assert after.mean() == pytest.approx(3.0, abs=0.05)
    assert r[2, 3] == pytest.approx(0.05 * volume[2, 2] / 5.0 * (pattern[2, 2] - pattern[2, 3]))
    assert change.sum() == pytest.approx(0.0, abs=1e-14)  # nothing leaves
    lost = np.sum(change * pattern)
    by_faces = np.sum(r[:, 1:N] * -np.diff(pattern, axis=1)) + np.sum(z[1:N] * -np.diff(pattern, axis=0))
    assert lost == pytest.approx(by_faces)
    assert heat.sum() == pytest.approx(lost, rel=1e-12)
    np.testing.assert_allclose(heat[1], 3.0 * heat[0])  # by mass


def along_z(pressure) -> Surface:
    """A surface of one column of cells with these pressures."""
    kind = np.full((N, N), WHOLE)
    kind[:, 3] = INTERFACE
    return Surface(np.tile(pressure, (N, 1)).T, kind)


@pytest.mark.parametrize("pressure", [1.0 + 2.0 * np.arange(N), -7.0 * np.arange(N), (np.arange(N) - 2.3) ** 2])
def test_what_is_linear_along_the_surface_or_bends_stays(pressure):
    _, z, _, heat = along_z(pressure).moved()
    assert z[1:N, 3] == pytest.approx(0.0, abs=1e-14)
    assert heat == pytest.approx(0.0, abs=1e-13)


# --------------------------------------------------------------------------------------------------- equation 9: closing


def between(kind=WHOLE, void=0.1, soft=(-9.0, -9.0, -9.0), hard=(-9.0, -9.0, -9.0), pressure=0.0, **given) -> Surface:
    """Void between the groups in cell (2, 3): left of it, below and above all is soft, on its right hard, with these stresses.

    kind : of all other cells
    """
    cells = Surface(pressure, **given)
    cells.fill(SOFT, np.s_[:], np.s_[:])
    cells.fill(HARD, np.s_[:], np.s_[4:])
    cells.press(np.s_[:], np.s_[:4], *soft)
    cells.press(np.s_[:], np.s_[4:], *hard)
    cells.skin[KIND, MESH, MESH] = kind
    cells.skin[KIND, FIRST + 2, FIRST + 3], cells.solid[FIRST + 2, FIRST + 3] = INTERFACE, 1.0 - void
    cells.vof[:, FIRST + 2, FIRST + 3] = 0.5 * (1.0 - void)
    return cells


def around() -> np.ndarray:
    """Pressure of 3 Pa everywhere but in cell (2, 3)."""
    pressure = np.full((N, N), 3.0)
    pressure[2, 3] = 0.0
    return pressure


#: faces of cell (2, 3), along r and z, and the sign of what flows into it
AROUND = ((0, (2, 3), 1.0), (0, (2, 4), -1.0), (1, (2, 3), 1.0), (1, (3, 3), -1.0))


@pytest.mark.parametrize("slip", [0.0, 0.1, 0.5])
def test_cells_of_the_surface_close_void_no_faster_than_the_groups_slip(slip):
    """0.6 m/s otherwise; a full soft cell does not ask for the slip."""
    found = between(INTERFACE, pressure=around(), slip=slip).moved()
    for way, at, sign in AROUND:
        assert found[way][at] == pytest.approx(sign * 0.1 * slip), at
    assert between(slip=slip).moved()[0][2, 3] == pytest.approx(9.0 * CLOSED)


def test_void_in_a_free_surface_is_no_void_between_the_groups():
    cells = between()
    cells.skin[KIND, FIRST + 2, FIRST + 3] = FREE_SURFACE
    assert (cells.moved()[0] == 0.0).all()
