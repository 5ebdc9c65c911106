"""The hole in the target: its radius row by row, also of rows that a travelling mesh has left behind."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hydro2d.measure.result import Number, Result, result
from hydro2d.measure.shot import Target

#: for the wall of the hole, the target fills a cell from this share on
HALF = 0.5
#: a wall begins where a row is filled to this share of its fullest cell beyond; the rest is round-off
FULL = 0.999
#: pieces of the target with less than this share of the largest one's volume are debris
PIECE = 0.05


class Hole(Result):
    """The hole in a target, corrected for its bending. SI, whole circumference."""

    entrance_diameter_m: Number = result(
        "in the first row below the surface from which the wall is steeper than 45 degrees; null if there is no hole, if its "
        "entrance has closed, or if no wall of it is left")
    exit_diameter_m: Number = result(
        "in the last such row, also beyond the rear face; null while metal of the target closes the hole at its end, such as a "
        "cap on the nose of the projectile that is still connected to the target")
    hole_diameter_m: Number = result(
        "in the narrowest such row of a hole that is open right through, whether the projectile went through or not; null "
        "while it is closed")
    mean_diameter_m: Number = result("of the cylinder with the volume and depth of the hole; null if there is no hole")
    volume_m3: Number = result("of the hole, the whole circumference; in planar geometry of the meshed half, per metre")
    volume_per_energy_m3_J: Number = result("that volume over the kinetic energy of the projectile at the start")
    efficiency: Number = result(
        "mass of the target that initially filled that volume, over the projectile's mass at the start: pi_V of the scaling "
        "of craters")
    depth_m: Number = result(
        "from the surface to the bottom on the axis, or the loss of thickness there if the target has bent; its whole "
        "thickness if it is perforated")
    ejected_mass_kg: Number = result(
        "mass of the target beyond its rear face that is no longer connected to it: plug and debris")
    ejected_velocity_m_s: Number = result("mean axial velocity of that mass; null if there is none")


class Rows(NamedTuple):
    """Rows of cells along the rod's flight, arrays of shape (n,).

    near, far : their ends as depths below the original surface, m;  radius : of the hole, m, NaN if there is no wall
    axis : share of the cell on the axis that the target fills, relative to a full cell of the row; 0 without a wall
    """

    near: np.ndarray
    far: np.ndarray
    radius: np.ndarray
    axis: np.ndarray


class Crater:
    """Measures the hole that a rod makes.

    The wall belongs to the target's pieces: cells that the target fills by half or more, failed or not, connected over faces,
    from 5 % of the volume of the largest piece within the target's original extent. Smaller pieces and the rest of the
    target are debris, which is part of the hole, as the rod is. The wall of a row is its first
    run of such cells from the axis, up to a cell that is full. The hole's radius in the row is that of a circle, or in
    planar geometry the width, with the row's area from the axis to there, less the target's share of the wall's own
    cells and of those next to them: exact for any straight wall, and smooth in time.

    A plate that the rod has dished has a hole only where material is missing, not where its face has left its plane. Its
    columns of cells are moved back by the distance that their rear has moved with the plate. If the rear has not moved, or is
    not in the mesh, as for a thick target, that changes nothing.

    Parameters
    ----------
    sim : Simulation
    target : the body that the hole is in
    direction : of the rod's flight along z, 1 or -1
    next_row : float64[1], depth at which the next row leaves the mesh, m, which a cycle compares with the mesh's edge
        (`hydro2d.kernels.between.judgements`)
    """

    def __init__(self, sim, target: Target, direction: float, next_row: np.ndarray):
        self.sim, self.m = sim, target.m
        self.direction, self._target = direction, target
        self.rear = float(direction * ((target.high if direction > 0 else target.low) - target.surface))
        self._left: list[tuple[float, float]] = []
        self._next = next_row
        self._next[0] = self._trailing_edge()

    # ------------------------------------------------------------------------------------------------ rows in the mesh

    @property
    def target(self) -> Target:
        """The target as it would be now if nothing had touched it."""
        return self._target.at(self.sim.time)

    def depths(self) -> np.ndarray:
        """Depths of the rows of cells below the original surface, m, [j, 1]."""
        return self.depth(self.sim.grid.zc[self.sim.grid.inside[0]])[:, None]

    def depth(self, z):
        """Depth below the original surface of an axial position, m."""
        return self.direction * (z - self.target.surface)

    def _trailing_edge(self) -> float:
        """The mesh's edge behind the rod, as depth below the original surface, m."""
        return float(self.depth(self.sim.grid.z_edges[0 if self.direction > 0 else -1]))

    def _walls(self) -> tuple[np.ndarray, np.ndarray]:
        """The cells [j, i] of the target's pieces (bool), and the target's share of these and of the cells next to them."""
        from scipy import ndimage

        grid = self.sim.grid
        fraction = grid.interior(self.sim.state.vof)[self.m]
        labels, count = ndimage.label(fraction >= HALF)
        size = np.bincount(labels.ravel(), (fraction * grid.volume[grid.inside]).ravel(), count + 1)
        centres = grid.zc[grid.inside[0]]
        at_home = np.zeros(count + 1, dtype=bool)
        at_home[labels[(centres > self.target.low) & (centres < self.target.high)]] = True
        at_home[0] = False
        pieces = at_home & (size >= PIECE * np.max(size, where=at_home, initial=0.0))
        wall = pieces[labels]
        return wall, np.where(ndimage.binary_dilation(wall), fraction, 0.0)

    def pieces(self) -> np.ndarray:
        """The cells [j, i] in the target's pieces or next to one (bool), as those that their surfaces cut do."""
        return self._walls()[1] > 0.0

    def beyond(self) -> np.ndarray:
        """Which rows of cells are beyond the target's original rear face, [j, 1]."""
        return self.depths() > self.rear

    def before(self) -> np.ndarray:
        """Which rows of cells are before the target's original front face, [j, 1]."""
        return self.depths() < 0.0

    def has_rear(self) -> bool:
        """Whether the target's original rear face lies within the mesh."""
        return bool(self.depth(self.sim.grid.z_edges).max() > self.rear)

    def masses(self, m: int, where: np.ndarray | bool) -> tuple[np.ndarray, np.ndarray]:
        """Mass of body m in some cells, kg, whole circumference, and its axial velocity, m/s, the mean of the four vertices."""
        grid, s = self.sim.grid, self.sim.state
        fraction = grid.interior(s.vof)[m]
        mass = np.where(where & (fraction > 0.0), fraction * grid.interior(s.rho)[m], 0.0) * grid.volume[grid.inside]
        return mass * (2.0 * np.pi if grid.cylindrical else 1.0), grid.vertex_mean(s.v[s.group[m]])

    def _bends(self, wall: np.ndarray, filled: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """For every column of cells the depth of its face and the motion of its rear, m, and whether it is whole; (nr,) each.

        A column that lacks less than half a cell of the target's thickness is whole, and the missing part is no hole. Gaps in
        it, as of a spall, do not move its face; a column less than half full takes the values of the next one outside. All
        are zero while the rear is beyond the mesh, where nothing is known of it.

        wall, filled : from `_walls`, along the rod's flight;  edges : of their rows, as depths
        """
        height = np.diff(edges)
        face, way, whole = np.zeros(wall.shape[1]), np.zeros(wall.shape[1]), np.zeros(wall.shape[1], dtype=bool)
        if edges[-1] <= self.rear:
            return face, way, whole
        for i in range(wall.shape[1] - 1, -1, -1):
            cells = np.nonzero(wall[:, i])[0]
            if not len(cells):
                face[i], way[i], whole[i] = (face[i + 1], way[i + 1], whole[i + 1]) if i + 1 < len(way) else (0.0, 0.0, False)
                continue
            first, last = cells[0], cells[-1]
            metal = filled[:, i] / filled[:, i].max() * height
            gap = height[first : last + 1].sum(where=~wall[first : last + 1, i])
            face[i] = edges[first + 1] - metal[: first + 1].sum()
            way[i] = edges[last] + metal[last:].sum() - gap - self.rear
            whole[i] = way[i] - face[i] > -HALF * height[first]
        way[way <= (1.0 - FULL) * height[0]] = 0.0
        return face, way, whole

    def bulge(self) -> float:
        """How much further the rear of the target has moved in one column of cells than in another, m."""
        order = slice(None, None, 1 if self.direction > 0 else -1)
        _, way, _ = self._bends(*(cells[order] for cells in self._walls()), self.depth(self.sim.grid.z_edges)[order])
        return float(np.ptp(way))

    def _unbent(self, walls: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Walls with every column of cells moved back by its motion with the plate: that of its rear."""
        order = slice(None, None, 1 if self.direction > 0 else -1)
        edges = self.depth(self.sim.grid.z_edges)[order]
        wall, filled = (cells[order].copy() for cells in walls)
        face, way, whole = self._bends(wall, filled, edges)
        for i in np.nonzero(way * np.where(whole, face, 1.0) > 0.0)[0]:
            if whole[i]:
                behind = filled[:, i].max() * np.clip(edges, 0.0, self.rear)
            else:
                behind = np.concatenate([[0.0], np.cumsum(filled[:, i] * np.diff(edges))])
                behind = np.interp(edges + way[i], np.maximum(edges, face[i]), behind)
            filled[:, i] = np.diff(behind) / np.diff(edges)
            wall[:, i] = filled[:, i] >= HALF
        return wall[order], filled[order]

    def _row(self, wall: np.ndarray, filled: np.ndarray) -> tuple[float, float]:
        """(radius, share on the axis) of a row, shapes (nr,); (NaN, 0) if it has no wall."""
        if not wall.any():
            return np.nan, 0.0
        first = int(np.argmax(wall))
        beyond = wall[first:]
        last = len(wall) if beyond.all() else first + int(np.argmin(beyond))
        full = filled[first:last].max()
        end = first + int(np.argmax(filled[first:last] >= FULL * full)) + 1
        share = np.minimum(filled[:end] / full, 1.0)
        share[share >= FULL] = 1.0
        grid = self.sim.grid
        area = float(np.sum((1.0 - share) * grid.vol_r[grid.inside[1]][:end]))
        return float(np.sqrt(2.0 * area)) if grid.cylindrical else area, float(share[0])

    def _rows(self, walls: tuple[np.ndarray, np.ndarray]) -> Rows:
        """The rows of the mesh, from the result of `_walls`."""
        edges = self.depth(self.sim.grid.z_edges)
        hole = np.array([self._row(*row) for row in zip(*walls, strict=True)])
        if self.direction < 0:
            edges, hole = edges[::-1], hole[::-1]
        return Rows(edges[:-1], edges[1:], hole[:, 0], hole[:, 1])

    def _bottom(self, rows: Rows) -> tuple[int, float]:
        """Row of the hole's bottom on the axis and its depth in m; the number of rows and the rear if perforated."""
        closed = (rows.axis >= HALF) & (rows.near + rows.far > 0.0)
        if not closed.any():
            return len(closed), max(min(self.rear, float(rows.far[-1])), 0.0)
        k = int(np.argmax(closed))
        height = rows.far - rows.near
        depth = rows.near[k] + (1.0 - rows.axis[k]) * height[k]
        if k > 0:
            depth -= rows.axis[k - 1] * height[k - 1]
        return k, max(float(depth), 0.0)

    # ------------------------------------------------------------------------------------------------ rows left behind

    def record(self) -> None:
        """After a cycle: keeps the radius in the mesh's last row, once for every row height that the mesh has moved."""
        edge = self._trailing_edge()
        if self.sim.grid.offset == 0.0 or edge < self._next[0]:
            return
        last = 0 if self.direction > 0 else -1
        self._next[0] = edge + float(np.diff(self.sim.grid.z_edges)[last])
        depth, radius = self._last_row(last, *self._walls())
        if np.isfinite(radius) and not (self._left and depth <= self._left[-1][0]):
            self._left.append((depth, radius))

    def _last_row(self, last: int, wall: np.ndarray, filled: np.ndarray) -> tuple[float, float]:
        """Depth and radius of the hole in a row that leaves the mesh, in the plate as it was before it bent, m.

        The radius is NaN if there is no wall, and while the row is no deeper than the plate has bent.
        """
        order = slice(None, None, 1 if self.direction > 0 else -1)
        _, way, _ = self._bends(wall[order], filled[order], self.depth(self.sim.grid.z_edges)[order])
        depth = float(self.depth(self.sim.grid.zc[self.sim.grid.inside[0]][last]))
        if 0.0 < way.max() and depth <= way.max():
            return depth, np.nan
        radius, _ = self._row(wall[last], filled[last])
        return depth - float(way[np.argmax(wall[last])]), radius

    def saved(self) -> dict:
        """Data for a restart file."""
        return {"next": float(self._next[0]), "left": [list(pair) for pair in self._left]}

    def resume(self, saved: dict) -> None:
        """Continues from the result of `saved`."""
        self._next[0], self._left = saved["next"], [(depth, radius) for depth, radius in saved["left"]]

    # ------------------------------------------------------------------------------------------------ results

    def _hole(self, walls: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, bool]:
        """Near and far ends of the hole's rows as depths and their radii, all (n,), and the depth of the bottom; m. Last,
        whether the hole is open at its end."""
        rows = self._rows(self._unbent(walls))
        bottom, depth = self._bottom(rows)
        live = np.nonzero(np.isfinite(rows.radius[: bottom + 1]))[0]
        edge = rows.near[0]
        left = np.array(self._left).reshape(-1, 2)
        left = left[left[:, 0] < edge]
        between = 0.5 * (left[1:, 0] + left[:-1, 0])
        near = np.concatenate([left[:1, 0] - 0.5 * (rows.far[0] - edge), between, rows.near[live]])
        far = np.concatenate([between, [edge] * min(len(left), 1), rows.far[live]])
        radius = np.concatenate([left[:, 1], rows.radius[live]])
        count = int(np.max(np.nonzero(radius)[0], initial=-1)) + 1
        return near[:count], far[:count], radius[:count], depth, bottom == len(rows.radius)

    @staticmethod
    def _ends(middles: np.ndarray, radius: np.ndarray) -> tuple[int, int]:
        """First and last row of a hole that lie in a wall steeper than 45 degrees; twice the middles and the radii, m."""
        steep = np.nonzero(2.0 * np.abs(np.diff(radius)) <= np.diff(middles))[0]
        return (int(steep[0]), int(steep[-1]) + 1) if len(steep) else (0, len(radius) - 1)

    def profile(self) -> tuple[np.ndarray, np.ndarray]:
        """Axial positions and radii of the hole in m, shapes (n,), along the rod's flight from the entrance to the bottom.

        It includes rows of a lip before the target's original face and of a bulge behind its rear; it is empty before impact.
        """
        near, far, radius, _, _ = self._hole(self._walls())
        return self.target.surface + self.direction * 0.5 * (near + far), radius

    def measure(self) -> Hole:
        """The hole now; SI, whole circumference, within the target's original faces.

        All lengths are those of the plate as it was before it bent, see `_unbent`. The entrance is where the wall becomes
        steeper than 45 degrees, and the exit is the last such place. The mean diameter is that of the cylinder (in planar
        geometry: the slot) with the hole's volume and depth. A diameter is None if there is no such place, or no hole.
        """
        walls = self._walls()
        near, far, radius, depth, through = self._hole(walls)
        below = near + far > 0.0
        near, far, radius = near[below], far[below], radius[below]
        mouth, end = self._ends(near + far, radius)
        near[:1] = np.minimum(near[:1], 0.0)  # a row that the original face cuts has no wall if less than half is left
        height = np.maximum(np.minimum(far, self.rear) - np.maximum(near, 0.0), 0.0)
        cylindrical, penetrator = self.sim.grid.cylindrical, self.sim.penetrator
        volume = float(np.sum((np.pi * radius**2 if cylindrical else radius) * height))
        mean = None
        if depth > 0.0:
            mean = 2.0 * (float(np.sqrt(volume / (np.pi * depth))) if cylindrical else volume / depth)
        return Hole(
            entrance_diameter_m=2.0 * float(radius[mouth]) or None if len(radius) else None,
            exit_diameter_m=2.0 * float(radius[end]) if len(radius) and through else None,
            hole_diameter_m=2.0 * float(radius[mouth : end + 1].min()) if len(radius) and through else None,
            mean_diameter_m=mean,
            volume_m3=volume,
            volume_per_energy_m3_J=volume / penetrator.impact_energy if penetrator.impact_energy > 0.0 else None,
            efficiency=volume * float(self.sim.table.rho0[self.m]) / penetrator.mass,
            depth_m=depth,
            **self._ejected(walls[1] > 0.0),
        )

    def _ejected(self, pieces: np.ndarray) -> dict[str, float | None]:
        """Mass and mean axial velocity of target material ejected through its rear; pieces : see `pieces`."""
        mass, velocity = self.masses(self.m, ~pieces & self.beyond())
        total = float(mass.sum())
        return {"ejected_mass_kg": total,
                "ejected_velocity_m_s": float((mass * velocity).sum()) / total if total > 0.0 else None}
