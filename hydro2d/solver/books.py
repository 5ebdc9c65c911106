"""Sums that the phases of a step leave for the audit, each under the name of its sink."""

from __future__ import annotations

import numpy as np

from hydro2d.measure.audit import Audit


class Books:
    """Enters the losses of a cycle from the totals into its audit.

    Parameters
    ----------
    cycle : Cycle, whose audit is open
    """

    def __init__(self, cycle):
        self._cycle, self._state = cycle, cycle.state
        self._edges, self._opens = cycle.method.boundaries.edges, cycle.method.boundaries.having("opens")
        rows = np.maximum(cycle.edges.constrained[:4], cycle.edges.pushing)[2:].tolist()
        loaded = [cycle.state.taken] if (cycle.edges.loaded >= 0).any() else []
        self._edge_sums = (*loaded, cycle.state.walls_sum)
        self._held_columns = [edge.sink for n, edge in enumerate(self._edges[:2]) if cycle.edges.constrained[4 + n] >= 0]
        self._rows_that_hold = [(edge, j) for edge, j in zip(self._edges[2:], rows, strict=True) if j >= 0]

    @property
    def audit(self) -> Audit:
        """The audit of the cycle."""
        return self._cycle.audit

    def acceleration(self) -> None:
        """Enters losses and gains by the speed limit, contact, tractions and velocities of edges, and sources."""
        s, cycle = self._state, self._cycle
        momentum, energy, number = s.limited_sum.tolist()
        if number:
            self.audit.add("speed_limit", momentum=momentum, energy=energy)
        cycle.contact.account(self.audit)
        for sums in self._edge_sums:
            for edge, (momentum, energy) in zip(self._edges, sums.tolist(), strict=True):
                if momentum != 0.0 or energy != 0.0:
                    self.audit.add(edge.sink, momentum=momentum, energy=energy)
        cycle.sources.account(self.audit)

    def open_edges(self, di: int) -> tuple[bool, bool]:
        """Whether bodies flow through the low and the high edge of a direction, if the active box has reached them."""
        (low, high), reached = (self._opens[0:2], [2, 3]) if di else (self._opens[2:4], [0, 1])
        there = self._cycle.active.reaches()
        return bool(low) and there[reached[0]], bool(high) and there[reached[1]]

    def outflow(self, di: int) -> None:
        """Enters the outflow and inflow through the edges of a sweep."""
        cycle, edges = self._cycle, self.open_edges(di)
        if not any(edges):
            return
        first, last = cycle.box[:2] if di else cycle.box[2:]
        for side, (opened, ways) in enumerate(zip(edges, self._state.outflow.tolist(), strict=True)):
            if not opened:
                continue
            cycle.courses.crossed(di, side, first, last, cycle.mesh.velocity * cycle.dt)
            for crossed in cycle.crossings:
                crossed(di, side, first, last)
            for name, (energy, *mass) in zip(("outflow", "inflow"), ways, strict=True):
                if energy != 0.0 or any(mass):
                    self.audit.add(name, mass=np.array(mass), energy=energy)

    def momentum(self, di: int) -> None:
        """Enters amounts discarded by the advection of momentum and removed by the tidying."""
        s = self._state
        before, after, p_gained, k_cut, p_edges = s.momentum_sum.tolist()
        lost = before - after - self._kinetic_outflow(di) - float(s.deposited_sum[0])
        self.audit.add("advection", momentum=-p_gained, energy=lost - k_cut)
        if k_cut != 0.0:
            self.audit.add("ke_bound", energy=k_cut)
        for edge, j in self._rows_that_hold:
            if self._cycle.box[0] <= j <= self._cycle.box[1]:
                self.audit.add(edge.sink, momentum=float(s.momentum_sums[4, j]))
                p_edges -= float(s.momentum_sums[4, j])
        if self._held_columns:  # two of them have one sink
            self.audit.add(self._held_columns[0], momentum=p_edges)
        internal, kinetic, axial, _, *mass = s.removed_sum.tolist()
        if any(mass) or internal + kinetic != 0.0 or axial != 0.0:
            self.audit.add("cutoff", mass=np.array(mass), momentum=axial, energy=internal + kinetic)

    def _kinetic_outflow(self, di: int) -> float:
        """Enters the momentum that went through open edges and returns the kinetic energy that left with it."""
        total, edges = 0.0, self.open_edges(di)
        if not any(edges):
            return total
        for opened, ways in zip(edges, self._state.kinetic_outflow.tolist(), strict=True):
            for name, (axial, energy) in zip(("outflow", "inflow"), ways, strict=True):
                if opened and energy != 0.0:
                    self.audit.add(name, momentum=axial, energy=energy)
                    total += energy
        return total
