"""Measurements of every body: mass, motion, extent, failed mass and mass that has left the mesh."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hydro2d.measure.result import Number, Result, result
from hydro2d.mesh import sums
from hydro2d.mesh.sums import HALF
from hydro2d.physics.centroids import CRUMB, FILLED, box_ends


class Body(Result):
    """A body: of material in the mesh unless stated otherwise. SI, whole circumference; planar: per metre of depth."""

    mass_kg: Number = result("mass")
    momentum_N_s: Number = result("axial momentum")
    velocity_m_s: Number = result("mean axial velocity, by mass; null if none of it is in the mesh")
    kinetic_energy_J: Number = result("kinetic energy, including the radial motion")
    failed_mass_kg: Number = result("mass that has failed by damage")
    outflow_kg: Number = result("mass that has left through open edges of the mesh since the start")
    inflow_kg: Number = result("mass that has entered a travelling mesh since the start")
    r_min_m: Number = result("least radius that it reaches; null if it fills less than a hundredth of any cell")
    r_max_m: Number = result("largest radius that it reaches")
    z_min_m: Number = result("lowest axial position that it reaches")
    z_max_m: Number = result("highest axial position that it reaches")
    length_m: Number = result("its extent along the axis")
    initial_length_m: Number = result("its extent along the axis at the start")
    radius_at_z_min_m: Number = result("radius of its lowest row of cells: the foot of a bar standing there")
    radius_at_z_max_m: Number = result("radius of its highest row of cells")


def measure(sim) -> dict[str, Body]:
    """Every body by name; SI, whole circumference (per metre of depth in planar geometry).

    Mass, axial momentum, mean axial velocity and kinetic energy are of material in the mesh. Outflow and inflow are the masses
    that have left and entered through its open edges. The extent is that of the cells that the body fills by half or more,
    plus its share of the cells next to them. A body by which no cell is FILLED is narrower than one: its extent is that of its
    boxes (explanation/interfaces, equation 7) in the cells of which it fills CRUMB or more; None if there are no such cells.
    The radius of its ends is the largest in its lowest and its highest row of these cells.
    """
    grid = sim.grid
    around = 2 * np.pi if grid.cylindrical else 1.0
    flows = {name: sim.audit.sinks[name].mass if name in sim.audit.sinks else None for name in ("outflow", "inflow")}
    results = {}
    for m, name in enumerate(sim.table.names):
        mass, momentum, kinetic, failed = motion(sim, m)
        went, came = (0.0 if flow is None else abs(float(flow[m])) * around for flow in flows.values())
        inner, outer = _extent(sim, m, 0)
        extent = (*_ends(inner, outer), *_ends(*_extent(sim, m, 1)))
        ends = (float(outer[0]), float(outer[-1])) if len(outer) else (None, None)
        values = (mass, momentum, momentum / mass if mass > 0.0 else None, kinetic, failed, went, came, *extent,
                  _between(*extent[2:]), sim.lengths.get(name), *ends)
        results[name] = Body(**dict(zip(Body.model_fields, values, strict=True)))
    return results


def lengths(sim) -> dict[str, float | None]:
    """Extent of every body along the axis now, m, by name; None if it fills CRUMB of no cell."""
    return {name: _between(*_ends(*_extent(sim, m, 1))) for m, name in enumerate(sim.table.names)}


def _between(low: float | None, high: float | None) -> float | None:
    return None if low is None or high is None else high - low


def motion(sim, m: int) -> list[float]:
    """Mass, axial momentum, kinetic energy and failed mass of body m; SI, as in `measure`."""
    grid, state, totals = sim.grid, sim.state, np.zeros(4)
    b = state.group[m]
    sums.body_motion(grid.g, grid.nz, grid.nr, m, grid.cm_in, grid.cm_out, grid.volume, state.vof, state.dmg, state.rho,
                     state.u[b], state.v[b], totals)
    return ((2 * np.pi if grid.cylindrical else 1.0) * totals).tolist()


def _extent(sim, m: int, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinate of body m along r (axis 0) or z (1), m, of each line of cells with it; see `measure`."""
    grid = sim.grid
    fraction, edges = grid.interior(sim.state.vof)[m], (grid.r_edges, grid.z_edges)[axis]
    if (fraction >= FILLED).any():
        return _surfaces(fraction if axis == 1 else fraction.T, edges)
    return _boxes(sim, m, axis)


def _boxes(sim, m: int, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """`_extent` of a body that is narrower than a cell, from its boxes."""
    extents: dict[int, tuple[float, float]] = {}
    for line, _, first, last in boxes(sim, m, axis):
        low, high = extents.get(line, (np.inf, -np.inf))
        extents[line] = min(low, first), max(high, last)
    ends = np.array([extents[line] for line in sorted(extents)]).reshape(-1, 2)
    return ends[:, 0], ends[:, 1]


def boxes(sim, m: int, axis: int, line: int | None = None) -> Iterator[tuple[int, int, float, float]]:
    """(line of cells along the axis, cell on it, lower and upper end in m) of the boxes of body m, cell by cell.

    axis : 0 along r, 1 along z;  line : the only one to use. Cells of which the body fills less than CRUMB have none.
    """
    grid = sim.grid
    f, centroid = grid.interior(sim.state.vof)[m], grid.interior(sim.state.centroid)[:, m]
    f, centroid = (f, centroid) if axis == 0 else (f.T, centroid.swapaxes(1, 2))
    round_axis = axis == 0 and grid.cylindrical
    edges = (0.5 * grid.r_edges**2 if round_axis else grid.r_edges) if axis == 0 else grid.z_edges
    beside = np.pad(f, ((0, 0), (1, 1)))
    for row in range(len(f)) if line is None else [line]:
        for cell in np.nonzero(f[row] >= CRUMB)[0].tolist():
            share, at = float(f[row, cell]), centroid[:, row, cell]
            ends = box_ends(share, at[axis], at[1 - axis], beside[row, cell], beside[row, cell + 2])
            middle, size = 0.5 * (edges[cell] + edges[cell + 1]), edges[cell + 1] - edges[cell]
            low, high = (float(middle + end * size) for end in ends)
            low, high = ((2.0 * max(end, 0.0)) ** 0.5 if round_axis else end for end in (low, high))
            yield row, cell, low, high


def _surfaces(fraction: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinate, m, along the first axis of the fractions [k, n] in cells with these edges [k + 1], of each
    line that has a cell filled by half; both empty if none has."""
    inside = fraction >= HALF
    lines = np.nonzero(inside.any(axis=0))[0]
    size = np.diff(edges)
    ends = []
    for sign in (1, -1):
        cells, widths, faces = (array[::sign] for array in (fraction, size, edges))
        first = np.argmax(inside[::sign], axis=0)[lines]
        beside = np.where(first > 0, cells[np.maximum(first - 1, 0), lines] * widths[np.maximum(first - 1, 0)], 0.0)
        ends.append(faces[first] + sign * ((1.0 - cells[first, lines]) * widths[first] - beside))
    return ends[0], ends[1]


def _ends(low: np.ndarray, high: np.ndarray) -> tuple[float | None, float | None]:
    """The lowest and the highest result of `_surfaces`; None if there are none."""
    return (float(low.min()), float(high.max())) if len(low) else (None, None)
