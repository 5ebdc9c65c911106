"""The sources of a deck during a run: energy and impulse for cells and vertices, and their entries in the audit."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from hydro2d.measure.audit import Audit
from hydro2d.mesh.fields import INTERNAL
from hydro2d.mesh.grid import CM_IN, CM_OUT
from hydro2d.sources.base import Reached, Source


def begin(entries, slots: list[int], grid, table, vof, rho, variables: dict[int, np.ndarray]) -> list[str]:
    """Lets sources set the variables of their bodies that they need, and returns their warnings.

    Parameters
    ----------
    entries : the tables of [[source]];  slots : index m of the body of each
    grid : Grid;  table : MaterialTable
    vof, rho : float64[m, nz, nr]
    variables : internal variables by body, float64[k, nz, nr], which are changed

    Raises DeckError for a source that does not fit the body as it lies in the mesh.
    """
    said = []
    for entry, m in zip(entries, slots, strict=True):
        own = {field.name: variables[m][k] for k, field in enumerate(table.internal[m])}
        mass = vof[m] * rho[m] * grid.interior(grid.volume)
        said += entry.begin(grid, Reached(table.materials[m], vof[m], mass, own, partial(arrival, grid, vof[m])))
    return said


def arrival(grid, share: np.ndarray, points: np.ndarray, speed: float) -> np.ndarray:
    """Times at which a detonation from points float64[n, 3] (r, z, time) arrives within a body, s, float64[nz, nr].

    share : of every cell's volume that the body fills. inf where it does not arrive.
    """
    from hydro2d.kernels.light_times import bend_around, light_points  # no model can be added after this import

    light, front = np.full(share.shape, np.inf), np.zeros((3, *share.shape))
    rows, columns = grid.inside
    given = SimpleNamespace(points=points, speed=speed, r=grid.r_edges, z=grid.z_edges, rc=grid.rc[columns].copy(),
                            zc=grid.zc[rows].copy(), share=np.ascontiguousarray(share), light=light, front=front)
    light_points(given)
    while bend_around(given):
        pass
    return light


def at_vertices(grid, cells: np.ndarray) -> np.ndarray:
    """Sums at the vertices over their cells, by the shares of corner masses; float64[nz + 1, nr + 1] of float64[nz, nr]."""
    columns = grid.inside[1]
    inner, outer = cells * grid.metrics[CM_IN, columns], cells * grid.metrics[CM_OUT, columns]
    total = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1))
    for rows in (slice(None, -1), slice(1, None)):
        total[rows, :-1] += inner
        total[rows, 1:] += outer
    return total


class Impulse(NamedTuple):
    """The effect of a source on one component (0 radial, 1 axial) of the velocities of a body group in a step.

    passed : impulses on the vertices of the mesh, N s, per radian, float64[nz + 1, nr + 1];  gained : their velocities
    absorbed : (sink, line, impulses) of the edges that constrain vertices
    """

    name: str
    group: int
    component: int
    passed: np.ndarray
    gained: np.ndarray
    absorbed: list[tuple[str, tuple, np.ndarray]]


class Sources:
    """The action of the sources of a deck on a state.

    Parameters
    ----------
    entries : the tables of [[source]]
    state : State;  table : MaterialTable
    slots : list of int, index m of the body of every source

    Attributes
    ----------
    given : float64[m], the most energy given to a cell of each body, J/kg
    pushed : float64[2, b, j, i], velocity that forces of sources add in the step, m/s; without such sources it is empty
    """

    def __init__(self, entries, state, table, slots: list[int]):
        self._all, self.state, self._table = list(zip(entries, slots, strict=True)), state, table
        self.given = np.zeros(state.bodies)
        pushes = any(type(entry).push is not Source.push for entry in entries)
        self.pushed = np.zeros_like(state.velocity) if pushes else np.zeros((0,) * state.velocity.ndim)
        self._impulses: list[Impulse] = []

    def __bool__(self) -> bool:
        return bool(self._all)

    @property
    def names(self) -> list[str]:
        """Names of their sinks."""
        return [entry.name for entry, _ in self._all]

    def begin(self) -> list[str]:
        """Lets every source prepare its body before the first step. Returns their warnings."""
        s = self.state
        inner = s.grid.interior
        return begin([entry for entry, _ in self._all], [m for _, m in self._all], s.grid, self._table,
                     inner(s.vof), inner(s.rho), {m: inner(s.q[INTERNAL:, m]) for _, m in self._all})

    def add_heat(self, time: float, dt: float, audit: Audit) -> None:
        """Adds the heat of the step from ``time`` on to the bodies in their state after it, and books it; J per radian."""
        s, grid = self.state, self.state.grid
        for entry, m in self._all:
            heat = entry.heat(grid, time, dt)
            if heat is None:
                continue
            vof, rho, e = (grid.interior(array[m]) for array in (s.vof, s.rho, s.e))
            there = vof > 0.0
            before = np.where(there, e, 0.0)
            e[...] = np.where(there, e + heat, e)
            gained = np.where(there, e, 0.0) - before  # the part that the sum has kept, to the last bit
            audit.add(entry.name, energy=-float(np.sum(vof * rho * grid.interior(grid.volume) * gained)))
            self.given[m] += float(np.abs(heat).max(initial=0.0))

    def push(self, time: float, dt: float, constrained_vertices: Iterable[tuple[str, int, tuple]]) -> None:
        """Computes the velocity that sources add to the vertices from ``time`` to ``time + dt``.

        The material of a cell gains it, and a vertex moves with the contents of its cells: its velocity changes by the
        impulse of the corner masses over its mass. An edge that constrains its vertices takes their impulse.

        constrained_vertices : (sink, component, line) of the constraining edges: 0 for radial velocities and 1 for axial ones;
        index of their vertices among those of the mesh
        """
        if self.pushed.size == 0:
            return
        s, grid = self.state, self.state.grid
        self.pushed[...] = 0.0
        self._impulses.clear()
        gains = [(entry.name, m, gain) for entry, m in self._all if (gain := entry.push(grid, time, dt)) is not None]
        for component in range(2):
            for name, m, gain in gains:
                impulse = at_vertices(grid, grid.interior(s.vof[m] * s.rho[m] * grid.volume) * gain[component])
                absorbed = []
                for sink, of, line in constrained_vertices:
                    if of == component:
                        absorbed.append((sink, line, impulse[line].copy()))
                        impulse[line] = 0.0  # the next edge does not take the impulse of a common corner again
                mass = grid.interior_vertices(s.mass[s.group[m]])
                gained = np.divide(impulse, mass, out=np.zeros_like(mass), where=mass > 0.0)
                grid.interior_vertices(self.pushed[component, s.group[m]])[...] += gained
                self._impulses.append(Impulse(name, s.group[m], component, mass * gained, gained, absorbed))

    def account(self, audit: Audit) -> None:
        """Books the work and momentum of forces of sources, by the velocities at the end of the step.

        The work of an impulse is that at the mean of the velocities at the start and at the end, as for the other forces.
        """
        s, grid = self.state, self.state.grid
        for name, g, component, impulse, gained, absorbed in self._impulses:
            start, end = (s.u0, s.u) if component == 0 else (s.v0, s.v)
            mean = 0.5 * (grid.interior_vertices(start[g]) + grid.interior_vertices(end[g]))
            momentum, energy = component * float(impulse.sum()), float((impulse * mean).sum())
            for sink, line, absorbed_impulse in absorbed:
                part, work = component * float(absorbed_impulse.sum()), float((absorbed_impulse * mean[line]).sum())
                momentum, energy = momentum + part, energy + work
                audit.add(sink, momentum=part, energy=work)
            audit.add(name, momentum=-momentum, energy=-energy)
            work = np.maximum(np.abs(gained * mean), 0.5 * gained**2)  # at least its work if alone
            self.given += float(work.max(initial=0.0))  # a pushed body may meet any of the others

    def saved(self) -> list[float]:
        """Data for a restart file."""
        return self.given.tolist()

    def resume(self, saved: list[float] | float) -> None:
        """Continues from the result of `saved`."""
        self.given[:] = saved
