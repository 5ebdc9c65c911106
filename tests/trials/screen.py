"""States beyond the reach of the bodies, with the worst place for each bound."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter

from hydro2d.mesh.fields import EP, RHO, E
from tests.trials.reach import SPEED, STRAIN, Reach

#: least volume fraction at which the state of a body in a cell counts, and share of a full vertex mass at which its speed does
FRACTION, MASS = 1e-2, 1e-2
#: rounding errors of fractions and masses
ROUNDING = 1e-9


class Screen:
    """Looks at a simulation that has not yet begun, at any time from then on.

    Parameters
    ----------
    simulation : Simulation
    least : float
        Factor on the bound above which a place is noted; 1 is the requirement, less shows how close a state is.
    """

    def __init__(self, simulation, least: float = 1.0):
        self.simulation, self.least, self.reach = simulation, least, Reach(simulation)
        self._found: dict[str, dict] = {}

    def beyond(self) -> dict[str, dict]:
        """The worst place by name of the bound: times the bound, value, limit, number of places, body, cell, fractions."""
        self._found = {}
        for m in range(len(self.reach.bodies)):
            self._numbers(m)
            self._energy(m)
        self._fractions()
        self._mass()
        self._speed()
        return self._found

    def _note(self, bound: str, times, values, limit: float, m: int | None = None) -> None:
        """Notes where ``times`` [j, i] is largest, if it is beyond the bound or not a number, and none before was worse."""
        times = np.where(np.isnan(times), np.inf, times)
        j, i = (int(x) for x in np.unravel_index(np.argmax(times), times.shape))
        worst, sim = float(times[j, i]), self.simulation
        if worst <= self.least or worst <= self._found.get(bound, {"times": 0.0})["times"]:
            return
        cell = min(j, sim.grid.nz - 1), min(i, sim.grid.nr - 1)
        self._found[bound] = {
            "times": worst, "value": float(values[j, i]), "limit": float(limit), "places": int((times > 1.0).sum()),
            "body": None if m is None else sim.table.names[m], "cell": cell, "cycle": sim.cycle,
            "fractions": self._inside(sim.state.vof)[(slice(None), *cell)].tolist()}

    def _inside(self, array: np.ndarray) -> np.ndarray:
        return self.simulation.grid.interior(array)

    def _numbers(self, m: int) -> None:
        """Finite numbers and a positive density, wherever a body has any material."""
        fields = self._inside(self.simulation.state.q)[:, m]
        there, rho = self._inside(self.simulation.state.vof)[m] > 0.0, fields[RHO]
        self._note("finite", np.where(there & ~np.isfinite(fields).all(axis=0), np.inf, 0.0), rho, 0.0, m)
        self._note("density 0", np.where(there & ~(rho > 0.0), np.inf, 0.0), rho, 0.0, m)

    def _energy(self, m: int) -> None:
        """Density, energy and temperature, where the body fills enough of a cell."""
        sim, limits = self.simulation, self.reach.bodies[m]
        rho, e, strain = (self._inside(sim.state.q)[row, m] for row in (RHO, E, EP))
        counts = self._inside(sim.state.vof)[m] >= FRACTION
        work = limits.shear * np.clip(strain, 0.0, STRAIN) + self.reach.friction * sim.time / limits.rho
        self._note("density", np.where(counts, rho / limits.most_rho, 0.0), rho, limits.most_rho, m)
        self._note("energy", np.where(counts, e / (limits.most_e + work), 0.0), e, limits.most_e, m)
        self._note("least energy", np.where(counts & (e < 0.0), e / limits.least_e, 0.0), e, limits.least_e, m)
        if limits.warm:
            cold = np.zeros(e.shape)
            for j, i in np.argwhere(counts & (e < 0.0)):
                cold[j, i] = 1.0 + abs(e[j, i] / limits.least_e) if self._is_at_zero(m, rho[j, i], e[j, i]) else 0.0
            self._note("0 K", cold, e, 0.0, m)

    def _is_at_zero(self, m: int, rho: float, e: float) -> bool:
        return not self.reach.materials[m].temperature(rho, e) > 0.0

    def _fractions(self) -> None:
        vof = self._inside(self.simulation.state.vof)
        self._note("fractions", vof.sum(axis=0) / (1.0 + ROUNDING), vof.sum(axis=0), 1.0)
        self._note("fraction 0", np.where((vof < 0.0).any(axis=0), np.inf, 0.0), vof.min(axis=0), 0.0)

    def _mass(self) -> None:
        """Change of mass of each body, less the amounts that left and entered by name."""
        s, audit = self.simulation.state, self.simulation.audit
        mass = (self._inside(s.vof) * self._inside(s.q)[RHO] * self._inside(self.simulation.grid.volume)).sum(axis=(1, 2))
        gone = sum(sink.mass for sink in audit.sinks.values())
        whole = np.maximum(audit.start.mass + np.abs(audit.sinks["inflow"].mass), 1e-300)
        for m, lost in enumerate(np.abs(mass + gone - audit.start.mass) / whole):
            self._note("mass", np.full((1, 1), lost / ROUNDING), np.full((1, 1), lost), ROUNDING, m)

    def _speed(self) -> None:
        """Speeds of vertices with enough mass: jets of the collision, and the expansion of the bodies within two cells."""
        sim, reach = self.simulation, self.reach
        grid, s = sim.grid, sim.state
        there = self._inside(s.vof) > 0.0
        of = [[limits.speed for limits in reach.bodies], [limits.rho for limits in reach.bodies]]
        expands, density = (np.max(there * np.array(each)[:, None, None], axis=0) for each in of)
        expands, density = (np.pad(maximum_filter(each, 5), ((0, 1), (0, 1)), mode="edge") for each in (expands, density))
        most = 1.05 * reach.fastest + SPEED * (reach.closing + expands) + 1e-300
        full = grid.interior_vertices(self._dual_volume()) * density
        for b in range(s.groups):
            u, v, mass = (grid.interior_vertices(array)[b] for array in (s.u, s.v, s.mass))
            speed = np.where(mass > MASS * full, np.hypot(u, v), 0.0)
            self._note("speed", speed / most, speed, most.max())

    def _dual_volume(self) -> np.ndarray:
        """The volume around every vertex, per radian."""
        grid = self.simulation.grid
        volume = np.zeros(grid.vertex_shape)
        self.simulation._gather(grid.volume, volume)
        return volume
