"""Pressure and temperature of the bodies for output: from density and energy alone, changing nothing.

The cycle works with those at its beginning; these are at the time of the output.
"""

from __future__ import annotations

import numpy as np

from eos.dispatch import evaluate
from hydro2d.jit import prange, threaded
from hydro2d.mesh.fields import DMG, RHO, E


@threaded
def pressures_and_temperatures(eos_model, memory, eos_par, vof, q, pressure, temperature):
    """Equation of state of every body; a body that has failed bears no tension (explanation/fracture).

    Reads    eos_model, memory [m], eos_par [m, k]; vof [m, j, i], q [k, m, j, i]
    Writes   pressure, temperature [m, j, i], zero where the body is not
    """
    bodies, _, columns = vof.shape
    for j in prange(vof.shape[1]):
        for m in range(bodies):
            for i in range(columns):
                pressure[m, j, i] = 0.0
                temperature[m, j, i] = 0.0
                if vof[m, j, i] > 0.0:
                    p, dpdrho, dpde, t = evaluate(eos_model[m], q[RHO, m, j, i], q[E, m, j, i], q[memory[m]:, m, j, i],
                                                  eos_par[m])
                    pressure[m, j, i] = max(p, 0.0) if q[DMG, m, j, i] >= 1.0 else p
                    temperature[m, j, i] = t


def of(sim) -> tuple[np.ndarray, np.ndarray]:
    """Pressure in Pa and temperature in K of every body, without ghosts, shapes (m, nz, nr)."""
    vof, q = (np.ascontiguousarray(sim.grid.interior(array)) for array in (sim.state.vof, sim.state.q))
    pressure, temperature = np.empty_like(vof), np.empty_like(vof)
    pressures_and_temperatures(sim.table.eos_model, sim.table.memory, sim.table.eos_par, vof, q, pressure, temperature)
    return pressure, temperature
