"""The surface of a body on a line of the mesh: its place, and a point that stays on it."""

from __future__ import annotations

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.measure import bodies, tracers
from hydro2d.mesh.sums import HALF
from hydro2d.physics.centroids import FILLED

#: largest distance that a surface may move in a cycle, in cells
NEAR = 2.0


def surfaces(column: np.ndarray, edges: np.ndarray) -> list[tuple[float, int]]:
    """Coordinate and side of every end of a body on a line of cells, -1 where it begins and +1 where it ends.

    column (n,) : the share of each cell that the body fills;  edges (n + 1,) of the cells, m

    A run of cells that are filled by half or more is the body; the cells at either side of its end count by their share. Ends
    at the edge of the mesh do not count. If no cell is FILLED, `thin_surfaces` finds bodies narrower than a cell.
    """
    size, ends_of_runs = np.diff(edges), []
    inside = np.concatenate([[False], column >= HALF, [False]])
    for edge in np.nonzero(inside[1:] != inside[:-1])[0].tolist():
        if 0 < edge < len(column):
            below, above = column[edge - 1] * size[edge - 1], column[edge] * size[edge]
            ends = inside[edge]
            at = edges[edge] - size[edge - 1] + below + above if ends else edges[edge] + size[edge] - above - below
            ends_of_runs.append((float(at), 1 if ends else -1))
    return ends_of_runs


def thin_surfaces(sim, m: int, axis: int, line: int) -> list[tuple[float, int]]:
    """`surfaces` of body m on a line of cells, along r (axis 0) or z (1), from its boxes; neighbouring ones are merged."""
    ends: list[tuple[float, int]] = []
    before = -2
    for _, cell, low, high in bodies.boxes(sim, m, axis, line):
        if cell == before + 1:
            ends[-1] = high, 1
        else:
            ends += [(low, -1), (high, 1)]
        before = cell
    return ends


class Follower:
    """A point that stays on the surface of a body, on the line through its first place along r or z.

    It takes the surface of the same side that is nearest to its last place, at most NEAR cells away: material that breaks off
    takes it along, and if the material is used up it has no place from then on.

    Parameters
    ----------
    sim : Simulation, as it begins
    gauge : Gauge of the deck, with `surface`
    place : float64[2], r and z in m, moved to the nearest surface; NaN once there is none

    Raises DeckError if the body has no surface on the line.
    """

    def __init__(self, sim, gauge, place: np.ndarray):
        self._sim, self._m, self.place = sim, sim.table.names.index(gauge.surface), place
        self._group = int(sim.state.group[self._m])
        self._axis = 0 if gauge.along == "r" else 1
        places = self._surfaces()
        if not places:
            line = f"{'zr'[self._axis]} = {place[1 - self._axis]:g}"
            raise DeckError(f'gauge "{gauge.name}": "{gauge.surface}" has no surface within the mesh on the line {line} m')
        self.place[self._axis], self._side = min(places, key=lambda one: abs(one[0] - self.place[self._axis]))

    def velocity(self) -> np.ndarray:
        """Velocity (u, v) of the body one cell inside its surface, or at its middle, m/s; NaN if there is no surface.

        At the surface itself the velocity is partly that of vertices in void, which lags behind it: by 22 m/s (r.m.s.) in a
        spall at 500 m/s, where one cell inside it differs by 4 m/s from the speed of the place.
        """
        grid, inside = self._sim.grid, self.place.copy()
        if not np.isfinite(inside).all():
            return np.full(2, np.nan)
        here = inside[self._axis]
        through = [self._side * (here - at) for at, side in self._surfaces() if side != self._side]
        inside[self._axis] -= self._side * min([self._cell(), *(0.5 * way for way in through if way > 0.0)])
        return tracers.velocity_at(grid, self._sim.state, inside[None], self._group)[0]

    def _surfaces(self) -> list[tuple[float, int]]:
        grid = self._sim.grid
        edges = (grid.r_edges, grid.z_edges)
        across, along = edges[1 - self._axis], edges[self._axis]
        line = int(np.searchsorted(across, self.place[1 - self._axis], "right")) - 1
        line = min(max(line, 0), len(across) - 2)
        fraction = grid.interior(self._sim.state.vof)[self._m]
        column = fraction[line] if self._axis == 0 else fraction[:, line]
        return surfaces(column, along) if (column >= FILLED).any() else thin_surfaces(self._sim, self._m, self._axis, line)

    def _cell(self) -> float:
        """Size of the cell at the place, along the direction of the surface's motion, m."""
        edges = (self._sim.grid.r_edges, self._sim.grid.z_edges)[self._axis]
        cell = min(max(int(np.searchsorted(edges, self.place[self._axis], "right")) - 1, 0), len(edges) - 2)
        return float(edges[cell + 1] - edges[cell])

    def follow(self) -> None:
        """Moves the place to the present surface; to be called after every cycle."""
        here = self.place[self._axis]
        ends = []
        if np.isfinite(here):
            reach = NEAR * self._cell()
            ends = [at for at, side in self._surfaces() if side == self._side and abs(at - here) <= reach]
        self.place[self._axis] = min(ends, key=lambda at: abs(at - here)) if ends else np.nan
