"""States in which a cycle ends the run, with messages: cells that are not finite or inside out, a step that is too small."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hydro2d.base.errors import UnphysicalState
from hydro2d.mesh import fields
from hydro2d.solver import time_step
from hydro2d.solver.time_step import COLLAPSED, PATIENCE


class Refusals:
    """Ends a run that has become unphysical.

    Parameters
    ----------
    cycle : Cycle
    """

    def __init__(self, cycle):
        self._cycle = cycle

    def bad_cells(self) -> None:
        """Raises UnphysicalState for cells or velocities that are not finite."""
        s, g, row = self._cycle.state, self._cycle.grid, self._cycle.state.least_row
        if row[1] >= 0:
            j = row[1]
            i, m = int(s.bad[j, 1]), int(s.bad[j, 2])
            limits = self._cycle.table.limits(m, s.rho[m, j, i], s.q[self._cycle.table.memory[m]:, m, j, i])
            raise UnphysicalState(
                f"{self._where(j, i, m)}: volume fraction {s.vof[m, j, i]:.6g}, density {s.rho[m, j, i]:.6g} kg/m^3, energy "
                f"{s.e[m, j, i]:.6g} J/kg, pressure {s.pm[m, j, i]:.6g} Pa ({int(s.bad[j, 0])} such cells in its row)"
                + (f"; material {self._cycle.table.materials[m].name}: {limits}" if limits else ""))
        raise UnphysicalState(f"{self._when}: velocities that are not finite near z = {g.zc[row[2]]:.6g} m")

    def not_finite(self) -> str | None:
        """The first number of the bodies or of the velocities that is not finite, with its place; None if all are."""
        for what, values, r, z in self._carried():
            wrong = ~np.isfinite(values)
            if wrong.any():
                j, i = np.unravel_index(int(np.argmax(wrong)), wrong.shape)
                return f"{self._when}: the {what} is {values[j, i]} at (r, z) = ({r[i]:.6g}, {z[j]:.6g}) m"
        return None

    def _carried(self) -> Iterator[tuple[str, np.ndarray, np.ndarray, np.ndarray]]:
        """Everything that a state consists of, by its name in words: values (j, i), 0 without the body, and positions, m."""
        s, g, table = self._cycle.state, self._cycle.grid, self._cycle.table
        r, z = g.rc[g.inside[1]], g.zc[g.inside[0]]
        for m, name in enumerate(table.names):
            fraction = g.interior(s.vof)[m]
            yield f'volume fraction of body "{name}"', fraction, r, z
            known = [field.name for field in (*fields.BODY, *table.internal[m])]
            for what, values in zip(known, g.interior(s.q)[:, m], strict=False):  # the rows beyond are of other bodies
                yield f'{what.replace("_", " ")} of body "{name}"', np.where(fraction > 0.0, values, 0.0), r, z
        for b in range(s.groups):
            for what, values in (("radial", s.u), ("axial", s.v)):
                yield f"{what} velocity", g.interior_vertices(values)[b], g.r_edges, g.z_edges

    def small_step(self) -> None:
        """Raises UnphysicalState for a time step below the least one."""
        raise UnphysicalState(
            f"{self._when}: time step {self._cycle.dt:.3g} s, below dt_min = {self._cycle.method.numerics.dt_min:.3g} s, set "
            f'by {time_step.cause(self._cycle)}, in body "{self._slowest}"')

    def collapsed_step(self, median: float) -> None:
        """Raises UnphysicalState for time steps that have collapsed, see `time_step.Steps`; median : of the run so far, s."""
        raise UnphysicalState(
            f"{self._when}: the time step has fallen to {self._cycle.dt:.3g} s and was below {COLLAPSED:g} of its median, "
            f'{median:.2g} s, for {PATIENCE} cycles, set by {self._cycle.cause}, in body "{self._slowest}": no wave that this '
            "shot can cause is as fast")

    def turned_cells(self, second: int) -> None:
        """Raises UnphysicalState: the faces of a cell sweep more than its volume, in both directions or in the second one, so
        that no remap can recover its contents."""
        s = self._cycle.state
        j, i, m = s.first_turned.tolist()
        share = s.pre_sweep_volume[j, i] / self._cycle.grid.volume[j, i]
        raise UnphysicalState(
            f"{self._where(j, i, m)}: the step of {self._cycle.dt:.3g} s turned the cell inside out"
            f"{' along one direction' if second else ''}, to {share:.3g} of its volume")

    @property
    def _slowest(self) -> str:
        """Name of the body that fills most of the cell with the least step."""
        s = self._cycle.state
        return self._cycle.table.names[int(np.argmax(s.vof[:, int(s.least_row[0]), s.cause[1]]))]

    @property
    def _when(self) -> str:
        return f"cycle {self._cycle.number}, time {self._cycle.time:.6g} s"

    def _where(self, j: int, i: int, m: int) -> str:
        g = self._cycle.grid
        return f'{self._when}, cell (r, z) = ({g.rc[i]:.6g}, {g.zc[j]:.6g}) m, body "{self._cycle.table.names[m]}"'
