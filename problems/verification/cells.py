"""The cells of a simulation, and rays from the origin through them, to compare results with exact solutions."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RegularGridInterpolator

import hydro2d


class Cells:
    """The cells of a simulation without ghosts, float64[nz, nr] each.

    Attributes
    ----------
    r, z, volume : centres, m, and volumes, m^3 per radian (in planar geometry m^2)
    distance, angle : from the origin, m, and from the axis, degrees
    vof, rho, szz : by body, float64[m, nz, nr]
    u, v : radial and axial velocity, the mean of the vertices of a cell, m/s
    """

    def __init__(self, simulation: hydro2d.Simulation):
        grid, state = simulation.grid, simulation.state
        rows, columns = grid.inside
        self.simulation, self.columns, self.rows = simulation, grid.rc[columns], grid.zc[rows]
        self.r, self.z = np.meshgrid(self.columns, self.rows)
        self.size = float(self.columns[1] - self.columns[0])
        self.volume = np.broadcast_to(grid.interior(grid.volume), self.r.shape)
        self.distance, self.angle = np.hypot(self.r, self.z), np.degrees(np.arctan2(self.r, self.z))
        self.vof, self.rho, self.szz = (grid.interior(each) for each in (state.vof, state.rho, state.szz))
        self.u, self.v = (grid.vertex_mean(each[0]) for each in (state.u, state.v))

    @property
    def density(self) -> np.ndarray:
        """Mass per volume of the cell."""
        return np.sum(self.vof * self.rho, axis=0)

    @property
    def mean_pressure(self) -> np.ndarray:
        """Pressure by the equations of state, Pa."""
        return self.simulation.field("pressure")

    @property
    def axial_stress(self) -> np.ndarray:
        """p - s_zz by volume fraction, positive in compression."""
        return self.mean_pressure - np.sum(self.vof * self.szz, axis=0)

    @property
    def outward(self) -> np.ndarray:
        """Velocity away from the origin."""
        return (self.u * self.r + self.v * self.z) / self.distance

    def ray(self, values: np.ndarray, angle: float) -> tuple[np.ndarray, np.ndarray]:
        """Distances from the origin, a quarter of a cell apart, and values there along a ray.

        angle : from the axis, degrees. Values are interpolated between centres, and constant beyond the outermost.
        """
        across, up = np.sin(np.radians(angle)), np.cos(np.radians(angle))
        reach = min(self.columns[-1] / max(across, 1e-9), self.rows[-1] / max(up, 1e-9))
        distance = np.arange(0.25, reach / self.size * 4.0) * self.size / 4.0
        z = np.clip(distance * up, self.rows[0], self.rows[-1])
        r = np.clip(distance * across, self.columns[0], self.columns[-1])
        return distance, RegularGridInterpolator((self.rows, self.columns), values)(np.stack([z, r], axis=1))

    def along(self, values: np.ndarray, axis: str) -> tuple[np.ndarray, np.ndarray]:
        """Centres and values of a column (axis "z") or a row ("r") in the middle of the mesh."""
        return (self.rows, values[:, values.shape[1] // 2]) if axis == "z" else (self.columns, values[values.shape[0] // 2])

    def shells(self, values: np.ndarray, outer: float, width: float | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Radii of shells around the origin, and the mean of the values in each by volume; width: default a cell."""
        width = width or self.size
        count = int(outer / width)
        number = np.minimum((self.distance / width).astype(int), count).ravel()
        volume = np.bincount(number, self.volume.ravel(), count + 1)[:count]
        total = np.bincount(number, (values * self.volume).ravel(), count + 1)[:count]
        there = volume > 0.0
        return ((np.arange(count) + 0.5) * width)[there], total[there] / volume[there]


def crossing(x: np.ndarray, values: np.ndarray, level: float, side: int = 1) -> float:
    """Outermost position on side +1 or -1 where values falls through level, interpolated; nan if it does not."""
    above = np.nonzero(values > level)[0]
    if len(above) == 0:
        return float("nan")
    k = above[-1] if side > 0 else above[0]
    if not 0 <= k + side < len(x):
        return float("nan")
    share = (values[k] - level) / (values[k] - values[k + side])
    return float(x[k] + share * (x[k + side] - x[k]))
