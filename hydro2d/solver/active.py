"""The active box: the part of the mesh that a cycle works on; it grows ahead of all motion (explanation/speed)."""

from __future__ import annotations

import numpy as np

#: cells that the active box leads the moving vertices by; one cycle spreads a signal by fewer
MARGIN = 6


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
    box : list of int [j0, j1, i0, i1] of the cells that are active
    """

    def __init__(self, state, table, boundaries, skips: bool):
        self._state, self._table, self._boundaries, self._skips = state, table, boundaries, skips
        g, nz, nr = state.grid.g, state.grid.nz, state.grid.nr
        self.mesh = np.array([g, g + nz, g, g + nr], dtype=np.int64)
        self._all: list[int] = self.mesh.tolist()
        self.box = list(self._all)

    @property
    def is_all(self) -> bool:
        """Whether every cell is active."""
        return self.box == self._all

    @property
    def rows(self) -> np.ndarray:
        """Its rows as one part, int64[2]."""
        return np.array(self.box[:2], dtype=np.int64)

    def reaches(self) -> list[bool]:
        """Whether it has reached the low and the high edge along z, and along r."""
        return [True] * 4 if self.is_all else [here == there for here, there in zip(self.box, self._all, strict=True)]

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

    def grow(self) -> bool:
        """Grows ahead of the moving vertices in ``State.moving`` (equation 1). Returns whether it has grown."""
        first, last, low, high = self._state.moving
        if first == last:
            return False
        (j0, j1, i0, i1), ahead = self.box, self._clipped([first - 1, last, low - 1, high])
        grown = [min(j0, ahead[0]), max(j1, ahead[1]), min(i0, ahead[2]), max(i1, ahead[3])]
        before, self.box = self.box, grown
        return grown != before

    def _clipped(self, box) -> list[int]:
        """A box with the margin, inside the mesh."""
        j0, j1, i0, i1 = self.mesh
        return [int(max(box[0] - MARGIN, j0)), int(min(box[1] + MARGIN, j1)), int(max(box[2] - MARGIN, i0)),
                int(min(box[3] + MARGIN, i1))]
