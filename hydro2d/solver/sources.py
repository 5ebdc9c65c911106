"""The sources of a deck at work: what they give to the cells, and what the audit books of it."""

from __future__ import annotations

import numpy as np

from hydro2d.mesh.fields import INTERNAL
from hydro2d.solver.audit import Audit


class Sources:
    """What the sources of a deck do to a state.

    Parameters
    ----------
    entries : the tables of [[source]]
    state : State;  table : MaterialTable
    slots : list of int, index m of the body of every source

    Attributes
    ----------
    given : float64[m], the most energy that a cell of each body has been given, J/kg
    """

    def __init__(self, entries, state, table, slots: list[int]):
        self._all, self.state, self._table = list(zip(entries, slots, strict=True)), state, table
        self.given = np.zeros(state.bodies)

    def __bool__(self) -> bool:
        return bool(self._all)

    @property
    def names(self) -> list[str]:
        """Those of their sinks."""
        return [entry.name for entry, _ in self._all]

    def begin(self) -> None:
        """Lets every source set what it needs of its body before the first step."""
        s = self.state
        for entry, m in self._all:
            variables = {field.name: s.grid.interior(s.q[INTERNAL + k, m]) for k, field in enumerate(self._table.internal[m])}
            entry.begin(s.grid, variables)

    def give(self, time: float, dt: float, audit: Audit) -> None:
        """Adds the heat of the step from ``time`` on to the bodies as they are after it, and books it; J per radian."""
        s, grid = self.state, self.state.grid
        for entry, m in self._all:
            heat = entry.heat(grid, time, dt)
            vof, rho, e = (grid.interior(array[m]) for array in (s.vof, s.rho, s.e))
            there = vof > 0.0
            before = np.where(there, e, 0.0)
            e[...] = np.where(there, e + heat, e)
            gained = np.where(there, e, 0.0) - before  # what the sum has kept of it, to the last bit
            audit.add(entry.name, energy=-float(np.sum(vof * rho * grid.interior(grid.volume) * gained)))
            self.given[m] += float(np.abs(heat).max(initial=0.0))

    def saved(self) -> list[float]:
        """What a restart file keeps."""
        return self.given.tolist()

    def resume(self, saved: list[float] | float) -> None:
        """Continues from what `saved` gave."""
        self.given[:] = saved
