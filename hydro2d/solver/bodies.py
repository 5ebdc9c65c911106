"""What one measures of every body, whatever it is: mass, motion, extent, what has failed and what has left the mesh."""

from __future__ import annotations

import numpy as np

from hydro2d.mesh import sums
from hydro2d.mesh.sums import HALF

#: what is known of a body, and its meaning; of what is in the mesh where nothing else is said
QUANTITIES = {
    "mass_kg": "mass",
    "momentum_N_s": "axial momentum",
    "velocity_m_s": "mean axial velocity, by mass; null where nothing of it is in the mesh",
    "kinetic_energy_J": "kinetic energy, of the radial motion as well",
    "failed_mass_kg": "mass that has failed by damage",
    "outflow_kg": "mass that has left through open edges of the mesh since the start",
    "inflow_kg": "mass that a mesh that travels has met since the start",
    "r_min_m": "least radius that it reaches; null where it fills no cell by half",
    "r_max_m": "largest radius that it reaches",
    "z_min_m": "lowest axial position that it reaches",
    "z_max_m": "highest axial position that it reaches",
}


def measure(sim) -> dict[str, dict[str, float | None]]:
    """QUANTITIES by body; SI, whole circumference (per metre of depth in planar geometry).

    Mass, axial momentum, mean axial velocity and kinetic energy are of what is in the mesh. Outflow and inflow are the masses
    that have left and entered through its open edges. The extent is that of the cells that the body fills by half or more, and
    of the share of the cells beside them that it fills; None where there are none such.
    """
    grid, state = sim.grid, sim.state
    around = 2 * np.pi if grid.cylindrical else 1.0
    flows = {name: sim.audit.sinks[name].mass if name in sim.audit.sinks else None for name in ("outflow", "inflow")}
    found = {}
    for m, name in enumerate(sim.table.names):
        mass, momentum, kinetic, failed = motion(sim, m)
        went, came = (0.0 if flow is None else abs(float(flow[m])) * around for flow in flows.values())
        fraction = grid.interior(state.vof)[m]
        extent = (*_extent(fraction.T, grid.r_edges), *_extent(fraction, grid.z_edges))
        values = (mass, momentum, momentum / mass if mass > 0.0 else None, kinetic, failed, went, came, *extent)
        found[name] = dict(zip(QUANTITIES, values, strict=True))
    return found


def motion(sim, m: int) -> list[float]:
    """Mass, axial momentum, kinetic energy and failed mass of body m; SI, as in `measure`."""
    grid, state, found = sim.grid, sim.state, np.zeros(4)
    b = state.group[m]
    sums.body_motion(grid.g, grid.nz, grid.nr, m, grid.cm_in, grid.cm_out, grid.volume, state.vof, state.dmg, state.rho,
                     state.u[b], state.v[b], found)
    return ((2 * np.pi if grid.cylindrical else 1.0) * found).tolist()


def _extent(fraction: np.ndarray, edges: np.ndarray) -> tuple[float | None, float | None]:
    """Lowest and highest coordinate, m, along the first axis of the fractions [k, n] in cells with these edges [k + 1]."""
    inside = fraction >= HALF
    lines = np.nonzero(inside.any(axis=0))[0]
    if len(lines) == 0:
        return None, None
    size = np.diff(edges)
    ends = []
    for sign in (1, -1):
        cells, widths, faces = (array[::sign] for array in (fraction, size, edges))
        first = np.argmax(inside[::sign], axis=0)[lines]
        beside = np.where(first > 0, cells[np.maximum(first - 1, 0), lines] * widths[np.maximum(first - 1, 0)], 0.0)
        surface = faces[first] + sign * ((1.0 - cells[first, lines]) * widths[first] - beside)
        ends.append(float((sign * surface).min() * sign))
    return ends[0], ends[1]
