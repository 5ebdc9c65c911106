"""Motion of the mesh: none, or along z with a body (explanation/following-mesh).

A travelling mesh has one axial velocity w, constant within a step. It does not affect the Lagrangian step, but the remap:
relative to the mesh a face along z sweeps F_z - w dt A, with A the axial area of its column. After the sweeps the whole mesh
has advanced by w dt. The material that the deck has placed ahead flows in through the leading edge.
"""

from __future__ import annotations

import numpy as np

from hydro2d.deck.layout import layout
from hydro2d.materials.starts import slot_of
from hydro2d.mesh import sums
from hydro2d.mesh.fields import RHO, E
from hydro2d.mesh.grid import Grid
from hydro2d.mesh.state import EMPTY
from hydro2d.mesh.sums import HALF
from hydro2d.solver import insertion

#: entering material is looked up in a strip of at least this share of a cell, so that it has a height when the mesh rests
THINNEST = 1e-9


class FixedMesh:
    """A mesh that stays where it is.

    velocity : float, of the mesh along z, m/s;  leading : the leading edge along z, 0 low, 1 high, None: neither
    """

    velocity = 0.0
    leading = None

    def prepare(self) -> None:
        """Begins with the state as it is, at the start or after a restart."""

    def follow(self) -> None:
        """Chooses the velocity of the mesh for the step."""

    def fill_ghosts(self, dt: float) -> None:
        """Fills the ghost cells ahead of the mesh with the inflow."""

    def move(self, dt: float) -> None:
        """Moves the mesh to the end of the step."""


class UndisturbedSpace:
    """The bodies that a deck has placed anywhere along z, on the columns of a mesh.

    Parameters
    ----------
    deck, table : Deck and MaterialTable
    grid : Grid, whose columns it is for
    """

    def __init__(self, deck, table, grid: Grid):
        self.deck, self.table, self.grid = deck, table, grid
        slots = slot_of(deck, table)
        outlines = [placed.outline for placed in layout(deck).bodies]
        slabs = [slab for entry in outlines for slab in entry.slabs]
        self._levels = np.array(sorted({z for slab in slabs for z in (slab.low, slab.high)}))
        self._curved = [(slab.low, slab.high) for slab in slabs if not (slab.inner.constant and slab.outer.constant)]
        self._extents = [(m, *entry.extent("z")) for m, entry in zip(slots, outlines, strict=True)]
        self._layers: dict[int, dict] = {}

    def beyond(self, z: float, direction: float) -> set[int]:
        """The bodies m that reach beyond z in a direction along the axis."""
        return {m for m, low, high in self._extents if (high > z if direction > 0 else low < z)}

    def strip(self, low: float, high: float) -> dict[str, np.ndarray]:
        """``vof``, ``rho`` (kg/m^3), ``e`` (J/kg) and ``centroid`` between two heights, as `insertion` gives them.

        Shapes (m, nr), of ``centroid`` (2, m, nr).

        Where no body begins, ends or curves between two heights, they are computed once for all of the space between, so that
        they do not depend on the time of the call: a run continued from a restart has the same bits.
        """
        first, last = np.searchsorted(self._levels, [low, high], side="right")
        if first != last or any(a < high and b > low for a, b in self._curved):
            return self._insert(low, high)
        if first not in self._layers:
            between = 0 < first < len(self._levels)
            self._layers = {first: self._insert(*(self._levels[first - 1:first + 1] if between else (low, high)))}
        return self._layers[first]

    def _insert(self, low: float, high: float) -> dict[str, np.ndarray]:
        row = Grid(self.grid.r_edges, [low, high], self.grid.geometry)
        state = insertion.initial_state(self.deck, row, self.table)
        return {name: state[name][..., 0, :] for name in ("vof", "centroid", "rho", "e")}


class FollowingMesh:
    """A mesh that travels with the core of a body, forward only.

    The core is the intact part of the body that is connected from the axis outward along its longest run on the axis, so that
    debris does not drag the mesh along, unless it lies against the core. A body that is not on the axis is followed as a whole.

    Parameters
    ----------
    state : State
    space : UndisturbedSpace
    m : int, the body
    direction : +1 or -1, the sense of its motion along z
    mirrors : (bool, bool), whether the inner and the outer edge along r mirror
    """

    def __init__(self, state, space: UndisturbedSpace, m: int, direction: float, mirrors: tuple[bool, bool]):
        self.state, self.grid, self.space, self.m, self.direction = state, state.grid, space, m, direction
        self.velocity, self.leading = 0.0, int(direction > 0)
        self._pads = tuple("symmetric" if mirror else "edge" for mirror in mirrors)
        self._run = np.zeros(2, dtype=np.int64)
        self._sums = np.zeros(2)
        self._placed: dict | None = None

    def prepare(self) -> None:
        """Begins with the state as it is, at the start or after a restart: nothing is placed beyond the leading edge yet."""
        self._placed = None
        self._announce()

    def _announce(self) -> None:
        """Gives bodies that may enter all columns of the ghost rows ahead as their range."""
        s, g = self.state, self.grid
        coming = self.space.beyond(self._edge, self.direction)
        for row in self._ghost_rows:
            s.body_ranges[0, :, row], s.occupied[:, row] = EMPTY, EMPTY
            for m in coming:
                s.body_ranges[0, m, row] = g.g, g.g + g.nr
                s.occupied[: s.group[m] + 1, row] = g.g, g.g + g.nr

    def follow(self) -> None:
        """Takes the mass-weighted mean velocity of the body's core, or of the whole body if it has no core; never backward."""
        s, g, m = self.state, self.grid, self.m
        sums.axis_run(g.g, g.nz, m, HALF, g.z, s.vof, s.dmg, self._run)
        first, last = self._run
        if first < last:
            first, last = max(first - 1, g.g), min(last + 1, g.g + g.nz)
        sums.core_sums(g.g, g.nr, first, last, m, HALF, self.direction, np.inf, 0.0, g.volume, s.vof, s.dmg, s.rho,
                       s.v[s.group[m]], self._sums)
        if self._sums[0] == 0.0:
            rows = np.zeros((2, g.shape[0]))
            sums.body_sums(g.g, g.nz, g.nr, m, g.cm_in, g.cm_out, g.volume, s.vof, s.rho, s.v[s.group[m]], rows)
            self._sums[:] = rows[:, g.inside[0]].sum(axis=1)
        mass, momentum = self._sums
        velocity = momentum / mass if mass > 0.0 else 0.0
        self.velocity = velocity if velocity * self.direction > 0.0 else 0.0

    def fill_ghosts(self, dt: float) -> None:
        """Inserts the deck's material in the strip that the leading edge crosses in the step, at rest and without stress.

        Nothing else writes there: the material stays until other material replaces it.
        """
        s, g, z = self.state, self.grid, self._edge
        row = self._ghost_rows[0]
        height = max(abs(self.velocity) * dt, THINNEST * g.dz[row])
        strip = self.space.strip(*((z, z + height) if self.leading else (z - height, z)))
        if strip is self._placed:
            return
        self._placed = strip
        vof, rho, e, centroid = (self._padded(strip[name]) for name in ("vof", "rho", "e", "centroid"))
        for row in self._ghost_rows:
            s.vof[:, row], s.q[:, :, row] = vof, s.initial[:, :, None]
            s.q[RHO, :, row], s.q[E, :, row], s.centroid[:, :, row] = rho, e, centroid

    def move(self, dt: float) -> None:
        """Advances the mesh by w dt, and drops bodies that are wholly inside."""
        self.grid.move(self.grid.offset + self.velocity * dt)
        self._announce()

    @property
    def _edge(self) -> float:
        """Position of the leading edge, m."""
        return float(self.grid.z_edges[-1] if self.leading else self.grid.z_edges[0])

    @property
    def _ghost_rows(self) -> tuple[int, int]:
        """The ghost rows ahead of the mesh, the nearest first."""
        g = self.grid
        return (g.g + g.nz, g.g + g.nz + 1) if self.leading else (g.g - 1, g.g - 2)

    def _padded(self, values: np.ndarray) -> np.ndarray:
        """Values (..., nr) with those of the ghost columns."""
        low, high = self._pads
        g = self.grid.g
        rest = ((0, 0),) * (values.ndim - 1)
        return np.pad(np.pad(values, (*rest, (g, 0)), mode=low), (*rest, (0, g)), mode=high)
