"""The places of the edges of the mesh, for kernels and sources."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


class EdgeLines:
    """The first and the last column and row of vertices, by the kind of edge.

    Parameters
    ----------
    boundaries : BoundaryConditions
    grid : Grid

    Attributes
    ----------
    constrained : int64[8], columns (2) and rows (2) of the edges whose normal velocity is given, then of those that also give
        the velocity along them; -1 for the others
    pushing, loaded : int64[4], columns and rows of the edges that only push, and that have a traction; -1 for the others
    constrained_vertices : list of (sink, component, vertices) of the edges that constrain their vertices
    widths : list of the four widths of the cells next to the edges along their normals, m
    limiting : name of the edge whose velocity has last set a time step
    """

    def __init__(self, boundaries, grid):
        g, lines = grid.g, (np.s_[:, 0], np.s_[:, -1], np.s_[0, :], np.s_[-1, :])
        at = np.array([g, g + grid.nr, g, g + grid.nz], dtype=np.int64)
        self._boundaries, self._mesh = boundaries, np.roll(at, 2)
        normal, held, self.pushing, self.loaded = (
            np.where(boundaries.having(flag), at, -1) for flag in ("constrains", "holds", "pushes", "loads"))
        self.constrained = np.concatenate([normal, held])
        self.constrained_vertices = [
            (edge.sink, n // 2, lines[n]) for n, edge in enumerate(boundaries.edges) if edge.constrains()]
        self.constrained_vertices += [
            (edge.sink, 1 - n // 2, lines[n]) for n, edge in enumerate(boundaries.edges) if held[n] >= 0]
        self.limiting = ""
        self.widths = [*grid.dr[[g, g + grid.nr - 1]].tolist(), *grid.dz[[g, g + grid.nz - 1]].tolist()]

    def sinks(self, all_sinks: Sequence[str]) -> dict[str, object]:
        """Their values for the books of a cycle (`hydro2d.kernels.names.BOOKS`); all_sinks : names of those of the audit."""
        conditions = self._boundaries
        of = [all_sinks.index(edge.sink) for edge in conditions.edges]
        held = [of[n] for n in range(2) if self.constrained[4 + n] >= 0]
        return {"edge_sinks": np.array(of, dtype=np.int64), "edges_open": np.array(conditions.having("opens")),
                "holding_rows": np.maximum(self.constrained[:4], self.pushing)[2:], "held_column": held[0] if held else -1}

    def void_beyond(self, leading: int | None) -> np.ndarray:
        """The edges (rows j0, j1, columns i0, i1) through which only void comes in, -1 for the others.

        leading : the leading edge of a travelling mesh, None for a fixed mesh
        """
        edges = self._mesh.copy()
        edges[np.roll(self._boundaries.having("supplies"), 2)] = -1
        if leading is not None:
            edges[leading] = -1
        return edges
