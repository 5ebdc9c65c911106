"""Local values at points, and points that move with the material."""

from __future__ import annotations

from math import nan, sqrt

import numpy as np

from eos.dispatch import evaluate
from hydro2d.jit import Phase, alone, point, serial
from hydro2d.kernels import names  # noqa: F401 (declares the names of handles)
from hydro2d.measure.station_columns import DENSITY, FAILED, MISES, PRESSURE, S_RR, S_RZ, S_TT, S_ZZ, STRAIN, TEMPERATURE, U, V
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import GHOSTS
from hydro2d.physics.stress import von_mises


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


@point
def group_at(own, group, vof, j, i):
    """Body group that a point of group `own` moves with in a cell: its own as long as it is present, else the cell's.

    A point without a group of its own (-1) always moves with the cell's.
    """
    if own >= 0:
        for m in range(group.shape[0]):
            if group[m] == own and vof[m, j, i] > 0.0:
                return own
    return group_of(group, vof, j, i)


@serial
def velocities(g, nr, nz, own, r, z, group, vof, u, v, points, result):
    """Velocity (u, v) at points (r, z), bilinear in the cell; those beyond the mesh have that of its edge.

    It is that of body group `own`, or of the group of the cell if `own` is negative.

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
def advect(g, nr, nz, dt, r, z, own, group, vof, u, v, points):
    """Moves points (r, z) with the velocity of their body group over dt, by the midpoint rule.

    Reads    r, z edges;  own [n], groups of the points (`group_at`);  group [m];  vof [m, j, i];  u, v [b, j-1/2, i-1/2]
    Updates  points [n, 2]
    """
    for n in range(points.shape[0]):
        i, x = place(r, g, nr, points[n, 0])
        j, y = place(z, g, nz, points[n, 1])
        b = group_at(own[n], group, vof, j, i)
        half_r = points[n, 0] + 0.5 * dt * between(u[b], j, i, x, y)
        half_z = points[n, 1] + 0.5 * dt * between(v[b], j, i, x, y)
        i, x = place(r, g, nr, half_r)
        j, y = place(z, g, nz, half_z)
        b = group_at(own[n], group, vof, j, i)
        points[n, 0] += dt * between(u[b], j, i, x, y)
        points[n, 1] += dt * between(v[b], j, i, x, y)


@serial
def sample(g, nr, nz, r, z, own, group, eos_model, memory, eos_par, vof, q, u, v, points, values):
    """Values in the cell of each point: mixtures over the bodies, as in the fields of these names.

    Pressure and stress are sums of volume fraction times value, with zero for void; temperature, strain and damage are means by
    mass; stresses are total, tension positive. The velocity is that of the point's group at the point. Beyond the mesh all is
    NaN.

    Reads    r, z edges;  own [n], groups of the points (`group_at`);  group, eos_model, memory [m], eos_par [m, k];
             vof [m, j, i], q [k, m, j, i];  u, v [b, j-1/2, i-1/2];  points [n, 2]
    Writes   values [n, QUANTITIES]
    """
    for n in range(points.shape[0]):
        at_r, at_z = points[n, 0], points[n, 1]
        if not (r[g] <= at_r <= r[g + nr] and z[g] <= at_z <= z[g + nz]):
            values[n] = nan
            continue
        i, x = place(r, g, nr, at_r)
        j, y = place(z, g, nz, at_z)
        b = group_at(own[n], group, vof, j, i)
        values[n] = 0.0
        values[n, U] = between(u[b], j, i, x, y)
        values[n, V] = between(v[b], j, i, x, y)
        for m in range(vof.shape[0]):
            f = vof[m, j, i]
            if f <= 0.0:
                continue
            pressure, _, _, temperature = evaluate(eos_model[m], q[RHO, m, j, i], q[E, m, j, i], q[memory[m]:, m, j, i],
                                                     eos_par[m])
            if q[DMG, m, j, i] >= 1.0:
                pressure = max(pressure, 0.0)
            mass = f * q[RHO, m, j, i]
            values[n, DENSITY] += mass
            values[n, PRESSURE] += f * pressure
            values[n, S_RR] += f * q[SRR, m, j, i]
            values[n, S_ZZ] += f * q[SZZ, m, j, i]
            values[n, S_RZ] += f * q[SRZ, m, j, i]
            values[n, TEMPERATURE] += mass * temperature
            values[n, STRAIN] += mass * q[EP, m, j, i]
            values[n, FAILED] += mass * min(q[DMG, m, j, i], 1.0)
        mass = max(values[n, DENSITY], 1e-300)
        values[n, TEMPERATURE] /= mass
        values[n, STRAIN] /= mass
        values[n, FAILED] /= mass
        values[n, MISES] = von_mises(values[n, S_RR], values[n, S_ZZ], values[n, S_RZ])
        values[n, S_TT] = -(values[n, S_RR] + values[n, S_ZZ]) - values[n, PRESSURE]
        values[n, S_RR] -= values[n, PRESSURE]
        values[n, S_ZZ] -= values[n, PRESSURE]


@serial
def keep_peaks(time, values, peaks):
    """Updates the extreme values of points by their present ones; NaN does not count.

    Reads    values [n, QUANTITIES]
    Updates  peaks [n, PEAKS]
    """
    for n in range(values.shape[0]):
        if not values[n, DENSITY] >= 0.0:
            continue
        if values[n, PRESSURE] > peaks[n, 0]:
            peaks[n, 0] = values[n, PRESSURE]
            peaks[n, 1] = time
        peaks[n, 2] = min(peaks[n, 2], values[n, PRESSURE])
        peaks[n, 3] = max(peaks[n, 3], sqrt(values[n, U] ** 2 + values[n, V] ** 2))
        peaks[n, 4] = max(peaks[n, 4], values[n, MISES])
        peaks[n, 5] = max(peaks[n, 5], values[n, TEMPERATURE])
        peaks[n, 6] = max(peaks[n, 6], values[n, STRAIN])


@serial
def move_all(w):
    """Moves the tracers of a run over its step (`advect`).

    Reads    r, z; station_groups [n]; group [m]; vof [m, j, i]; u, v [b, j-1/2, i-1/2]
    Updates  tracer_places [k, 2]
    """
    advect(GHOSTS, w.nr, w.nz, w.dt, w.r, w.z, w.station_groups, w.group, w.vof, w.u, w.v, w.tracer_places)


@serial
def sample_all(w):
    """Values at the stations of a run (`sample`).

    Reads    r, z; station_groups [n]; group, eos_model, memory [m]; eos_par [m, k]; vof [m, j, i]; q [k, m, j, i];
             u, v [b, j-1/2, i-1/2]; station_places [n, 2]
    Writes   station_values [n, QUANTITIES]
    """
    sample(GHOSTS, w.nr, w.nz, w.r, w.z, w.station_groups, w.group, w.eos_model, w.memory, w.eos_par, w.vof, w.q, w.u, w.v,
           w.station_places, w.station_values)


@serial
def keep_all_peaks(w):
    """Extreme values at the stations of a run (`keep_peaks`).

    Reads    station_values [n, QUANTITIES]
    Updates  station_peaks [n, PEAKS]
    """
    keep_peaks(w.reached, w.station_values, w.station_peaks)


move_tracers = Phase("move_tracers", "Moves the tracers of a run.", alone(move_all))
sample_stations = Phase("sample_stations", "Values at the stations of a run.", alone(sample_all))
keep_peaks_of_stations = Phase("keep_peaks_of_stations", "Extreme values at the stations of a run.", alone(keep_all_peaks))


def velocity_at(grid, state, points, group: int | None = None) -> np.ndarray:
    """Velocity (u, v) at points (r, z), array_like of shape [n, 2], bilinear in the cell; m/s.

    group : body group whose velocity it is; without it the group that the cell moves with
    """
    points = np.ascontiguousarray(points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"points have the shape [n, 2], rows of r and z; these have {list(points.shape)}")
    result = np.empty_like(points)
    own = -1 if group is None else int(group)
    velocities(grid.g, grid.nr, grid.nz, own, grid.r, grid.z, state.group, state.vof, state.u, state.v, points, result)
    return result
