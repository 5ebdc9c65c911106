"""The active box: the part of the mesh that a cycle works on; it grows ahead of all motion (explanation/speed)."""

from __future__ import annotations

import numpy as np

from hydro2d.kernels.between.active_box import MARGIN


class ActiveBox:
    """The rows and columns of the cells that are active.

    Parameters
    ----------
    state : State
    table : MaterialTable
    boundaries : BoundaryConditions
    skips : bool, whether quiet cells may be skipped: not if the mesh travels, since every cell then passes on its contents,
        nor if sources may heat cells that no signal has reached

    Attributes
    ----------
    mesh : int64[4], rows j0, j1 and columns i0, i1 of the mesh without ghosts
    bounds : int64[4], those of the cells that are active
    """

    def __init__(self, state, table, boundaries, skips: bool):
        self._state, self._table, self._boundaries, self._skips = state, table, boundaries, skips
        g, nz, nr = state.grid.g, state.grid.nz, state.grid.nr
        self.mesh = np.array([g, g + nz, g, g + nr], dtype=np.int64)
        self.bounds = self.mesh.copy()

    @property
    def box(self) -> list[int]:
        """Rows and columns [j0, j1, i0, i1] of the cells that are active."""
        return self.bounds.tolist()

    @box.setter
    def box(self, box: list[int]) -> None:
        self.bounds[:] = box

    @property
    def is_all(self) -> bool:
        """Whether every cell is active."""
        return bool((self.bounds == self.mesh).all())

    def begin(self) -> None:
        """Becomes the smallest box around everything that moves or is under pressure or stress and the driving edges, plus the
        margin; the whole mesh if there are only such edges, or if no cell may be skipped."""
        if not self._skips:
            return
        s, t, (j0, j1, i0, i1) = self._state, self._table, self.mesh
        loud = np.zeros(s.grid.shape, dtype=bool)
        for m in range(s.bodies):
            present = s.vof[m] > 0
            quiet_p = t.evaluate(m, t.rho0[m], 0.0)[0] == 0.0
            at_rest = (s.rho[m] == t.rho0[m]) & (s.e[m] == 0.0) & (s.q[2:5, m] == 0.0).all(axis=0)
            loud |= present & ~(at_rest & quiet_p)
        moving, drives = ((s.u != 0) | (s.v != 0)).any(axis=0), self._boundaries.having("drives")
        for at, edge_drives in zip((np.s_[:, i0], np.s_[:, i1], np.s_[j0], np.s_[j1]), drives, strict=True):
            moving[at] &= not edge_drives
        loud |= moving[:-1, :-1] | moving[1:, :-1] | moving[:-1, 1:] | moving[1:, 1:]
        if not loud[j0:j1, i0:i1].any():
            return
        beside = np.s_[:, i0], np.s_[:, i1 - 1], np.s_[j0], np.s_[j1 - 1]
        for cells, edge_drives in zip(beside, drives, strict=True):
            loud[cells] |= edge_drives
        rows, columns = np.nonzero(loud[j0:j1, i0:i1])
        self.box = self._clipped([rows.min() + j0, rows.max() + j0 + 1, columns.min() + i0, columns.max() + i0 + 1])

    def _clipped(self, box) -> list[int]:
        """A box with the margin, inside the mesh."""
        j0, j1, i0, i1 = self.mesh
        return [int(max(box[0] - MARGIN, j0)), int(min(box[1] + MARGIN, j1)), int(max(box[2] - MARGIN, i0)),
                int(min(box[3] + MARGIN, i1))]
