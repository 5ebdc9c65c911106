"""Cells of a small mesh, and their properties computed without the code's own vectors."""

import numpy as np

from hydro2d.mesh.grid import GHOSTS, Grid

GEOMETRIES = ("cylindrical", "planar")

#: interior columns and rows of `small`
COLUMNS, ROWS = range(GHOSTS, GHOSTS + 3), range(GHOSTS, GHOSTS + 2)


def small(geometry: str) -> Grid:
    """Three columns from the axis on and two rows, all of different sizes."""
    return Grid([0.0, 0.1, 0.25, 0.3], [-0.1, 0.2, 0.7], geometry)


def corners(g: Grid, j: int, i: int) -> tuple[np.ndarray, np.ndarray]:
    """r and z of the vertices of cell (j, i): inner bottom, outer bottom, outer top, inner top."""
    return g.r[[i, i + 1, i + 1, i]], g.z[[j, j, j + 1, j + 1]]


def at_corners(j: int, i: int, w: np.ndarray) -> np.ndarray:
    """A vertex field at the corners of cell (j, i), in the same order."""
    return w[[j, j, j + 1, j + 1], [i, i + 1, i + 1, i]]


def polygon_volume(r: np.ndarray, z: np.ndarray, cylindrical: bool) -> float:
    """Volume per radian (planar: area) of a polygon whose vertices go around counterclockwise, by Green's theorem."""
    r2, z2 = np.roll(r, -1), np.roll(z, -1)
    twice = r * z2 - r2 * z
    return float(np.sum((r + r2) * twice) / 6.0 if cylindrical else np.sum(twice) / 2.0)


def rate_of_volume(g: Grid, j: int, i: int, u: np.ndarray, v: np.ndarray) -> float:
    """Rate of growth of cell (j, i): its volume a little later less that a little earlier."""
    r, z = corners(g, j, i)
    du, dv = 1e-4 * at_corners(j, i, u), 1e-4 * at_corners(j, i, v)
    later = polygon_volume(r + du, z + dv, g.cylindrical)
    return (later - polygon_volume(r - du, z - dv, g.cylindrical)) / 2e-4
