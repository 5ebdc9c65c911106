"""Velocities at points, and points that move with the material."""

from __future__ import annotations

import numpy as np

from hydro2d.jit import point, serial


@point
def place(edges, first, number, x):
    """(cell, share) of a position: the cell among `number` cells from `first` on, and how far into it x lies, 0 to 1."""
    low, high = first, first + number
    while high - low > 1:
        middle = (low + high) // 2
        if edges[middle] <= x:
            low = middle
        else:
            high = middle
    return low, min(max((x - edges[low]) / (edges[low + 1] - edges[low]), 0.0), 1.0)


@point
def between(w, j, i, x, y):
    """A vertex field at shares x, y of the cell, bilinear."""
    low = w[j, i] * (1 - x) + w[j, i + 1] * x
    high = w[j + 1, i] * (1 - x) + w[j + 1, i + 1] * x
    return low * (1 - y) + high * y


@point
def group_of(group, vof, j, i):
    """Body group that a point of a cell moves with: 1 where hard bodies fill half of the cell or more, else 0."""
    hard = 0.0
    for m in range(group.shape[0]):
        hard += group[m] * vof[m, j, i]
    return int(hard >= 0.5)


@serial
def velocities(g, nr, nz, own, r, z, group, vof, u, v, points, result):
    """Velocity (u, v) at points (r, z), bilinear in the cell; those beyond the mesh have that of its edge.

    It is that of body group `own`, or of the group of the cell where `own` is negative.

    Reads    r, z edges;  group [m];  vof [m, j, i];  u, v [b, j-1/2, i-1/2];  points [n, 2]
    Writes   result [n, 2]
    """
    for n in range(points.shape[0]):
        i, x = place(r, g, nr, points[n, 0])
        j, y = place(z, g, nz, points[n, 1])
        b = own if own >= 0 else group_of(group, vof, j, i)
        result[n, 0] = between(u[b], j, i, x, y)
        result[n, 1] = between(v[b], j, i, x, y)


@serial
def follow(g, nr, nz, dt, r, z, group, vof, u, v, points):
    """Moves points (r, z) with the velocity of the body group of their cell over dt, by the midpoint rule.

    Reads    r, z edges;  group [m];  vof [m, j, i];  u, v [b, j-1/2, i-1/2]
    Updates  points [n, 2]
    """
    for n in range(points.shape[0]):
        i, x = place(r, g, nr, points[n, 0])
        j, y = place(z, g, nz, points[n, 1])
        b = group_of(group, vof, j, i)
        half_r = points[n, 0] + 0.5 * dt * between(u[b], j, i, x, y)
        half_z = points[n, 1] + 0.5 * dt * between(v[b], j, i, x, y)
        i, x = place(r, g, nr, half_r)
        j, y = place(z, g, nz, half_z)
        b = group_of(group, vof, j, i)
        points[n, 0] += dt * between(u[b], j, i, x, y)
        points[n, 1] += dt * between(v[b], j, i, x, y)


def velocity_at(grid, state, points: np.ndarray, group: int | None = None) -> np.ndarray:
    """Velocity (u, v) at points (r, z), shape [n, 2], bilinear in the cell; m/s.

    group : body group whose velocity it is; without it that which the cell moves with
    """
    result = np.empty_like(points)
    own = -1 if group is None else int(group)
    velocities(grid.g, grid.nr, grid.nz, own, grid.r, grid.z, state.group, state.vof, state.u, state.v, points, result)
    return result
