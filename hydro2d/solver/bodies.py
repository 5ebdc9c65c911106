"""What one measures of every body, whatever it is: mass, motion, extent, what has failed and what has left the mesh."""

from __future__ import annotations

import numpy as np

from hydro2d.mesh import sums
from hydro2d.mesh.measured import BODY
from hydro2d.mesh.sums import HALF


def measure(sim) -> dict[str, dict[str, float | None]]:
    """BODY by body; SI, whole circumference (per metre of depth in planar geometry).

    Mass, axial momentum, mean axial velocity and kinetic energy are of what is in the mesh. Outflow and inflow are the masses
    that have left and entered through its open edges. The extent is that of the cells that the body fills by half or more, and
    of the share of the cells beside them that it fills; None where there are none such. The radius of its ends is the largest
    in its lowest and its highest row of such cells.
    """
    grid, state = sim.grid, sim.state
    around = 2 * np.pi if grid.cylindrical else 1.0
    flows = {name: sim.audit.sinks[name].mass if name in sim.audit.sinks else None for name in ("outflow", "inflow")}
    found = {}
    for m, name in enumerate(sim.table.names):
        mass, momentum, kinetic, failed = motion(sim, m)
        went, came = (0.0 if flow is None else abs(float(flow[m])) * around for flow in flows.values())
        fraction = grid.interior(state.vof)[m]
        inner, outer = _surfaces(fraction.T, grid.r_edges)
        extent = (*_ends(inner, outer), *_ends(*_surfaces(fraction, grid.z_edges)))
        ends = (float(outer[0]), float(outer[-1])) if len(outer) else (None, None)
        values = (mass, momentum, momentum / mass if mass > 0.0 else None, kinetic, failed, went, came, *extent,
                  _between(*extent[2:]), sim.lengths.get(name), *ends)
        found[name] = dict(zip(BODY, values, strict=True))
    return found


def lengths(sim) -> dict[str, float | None]:
    """Extent of every body along the axis now, m, by name; None where it fills no cell by half."""
    grid = sim.grid
    fractions = zip(sim.table.names, grid.interior(sim.state.vof), strict=True)
    return {name: _between(*_ends(*_surfaces(fraction, grid.z_edges))) for name, fraction in fractions}


def _between(low: float | None, high: float | None) -> float | None:
    return None if low is None or high is None else high - low


def motion(sim, m: int) -> list[float]:
    """Mass, axial momentum, kinetic energy and failed mass of body m; SI, as in `measure`."""
    grid, state, found = sim.grid, sim.state, np.zeros(4)
    b = state.group[m]
    sums.body_motion(grid.g, grid.nz, grid.nr, m, grid.cm_in, grid.cm_out, grid.volume, state.vof, state.dmg, state.rho,
                     state.u[b], state.v[b], found)
    return ((2 * np.pi if grid.cylindrical else 1.0) * found).tolist()


def _surfaces(fraction: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinate, m, along the first axis of the fractions [k, n] in cells with these edges [k + 1], of each
    line that has a cell filled by half; both empty where none has."""
    inside = fraction >= HALF
    lines = np.nonzero(inside.any(axis=0))[0]
    size = np.diff(edges)
    found = []
    for sign in (1, -1):
        cells, widths, faces = (array[::sign] for array in (fraction, size, edges))
        first = np.argmax(inside[::sign], axis=0)[lines]
        beside = np.where(first > 0, cells[np.maximum(first - 1, 0), lines] * widths[np.maximum(first - 1, 0)], 0.0)
        found.append(faces[first] + sign * ((1.0 - cells[first, lines]) * widths[first] - beside))
    return found[0], found[1]


def _ends(low: np.ndarray, high: np.ndarray) -> tuple[float | None, float | None]:
    """The lowest and the highest of what `_surfaces` gives; None where there are none."""
    return (float(low.min()), float(high.max())) if len(low) else (None, None)
