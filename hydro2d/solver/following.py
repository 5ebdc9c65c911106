"""Motion of the mesh: none, or along z with a body (explanation/following-mesh).

A travelling mesh has one axial velocity w, constant within a step. It does not affect the Lagrangian step, but the remap:
relative to the mesh a face along z sweeps F_z - w dt A, with A the axial area of its column. After the sweeps the whole mesh
has advanced by w dt. The material that the deck has placed ahead flows in through the leading edge.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from hydro2d.deck.layout import layout
from hydro2d.jit import Conductor, Handle
from hydro2d.kernels import between_phases
from hydro2d.kernels.between.mesh_travel import THINNEST
from hydro2d.materials.starts import slot_of
from hydro2d.mesh import sums
from hydro2d.mesh.fields import RHO, E
from hydro2d.mesh.grid import Grid
from hydro2d.solver import insertion


class FixedMesh:
    """A mesh that stays where it is.

    Attributes
    ----------
    leading : the leading edge along z, 0 low, 1 high, None: neither
    """

    leading: int | None = None

    def values(self) -> dict[str, object]:
        """Its values in a handle (`hydro2d.kernels.names.TRAVEL`)."""
        none = np.zeros(0)
        return {"followed": -1, "heading": 0.0, "core_run": np.zeros(2, dtype=np.int64), "core": np.zeros(2),
                "placed": np.zeros(2), "reach": none}

    def prepare(self, given: Conductor) -> None:
        """Begins with the state as it is, at the start or after a restart."""

    def follow(self, given: Conductor) -> None:
        """Chooses the velocity of the mesh for the step."""

    def fill_ghosts(self, given: Conductor) -> None:
        """Fills the ghost cells ahead of the mesh with the inflow."""

    def move(self, given: Conductor) -> None:
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

    def reach(self, direction: float) -> np.ndarray:
        """How far each body reaches along the axis in a direction, m, float64[m]."""
        reach = np.full(len(self.table.names), -direction * np.inf)
        for m, low, high in self._extents:
            reach[m] = max(reach[m], high) if direction > 0 else min(reach[m], low)
        return reach

    def strip(self, low: float, high: float) -> tuple[dict[str, np.ndarray], tuple[float, float]]:
        """What is between two heights, and the heights from and up to which it is the same.

        ``vof``, ``rho`` (kg/m^3), ``e`` (J/kg) and ``centroid``, as `insertion` gives them: shapes (m, nr), of ``centroid``
        (2, m, nr).

        Where no body begins, ends or curves between two heights, they are computed once for all of the space between, so that
        they do not depend on the time of the call: a run continued from a restart has the same bits. Elsewhere they are for
        this strip only.
        """
        first, last = np.searchsorted(self._levels, [low, high], side="right")
        if first != last or any(a < high and b > low for a, b in self._curved):
            return self._insert(low, high), (np.inf, -np.inf)
        same = tuple(np.concatenate([[-np.inf], self._levels, [np.inf]])[first:first + 2].tolist())
        if first not in self._layers:
            self._layers = {first: self._insert(*(same if np.isfinite(same).all() else (low, high)))}
        return self._layers[first], same

    def _insert(self, low: float, high: float) -> dict[str, np.ndarray]:
        row = Grid(self.grid.r_edges, [low, high], self.grid.geometry)
        state = insertion.initial_state(self.deck, row, self.table)
        return {name: state[name][..., 0, :] for name in ("vof", "centroid", "rho", "e")}


class FollowingMesh(FixedMesh):
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
        self.leading = int(direction > 0)
        self._pads = tuple("symmetric" if mirror else "edge" for mirror in mirrors)
        self._placed = np.zeros(2)

    def values(self) -> dict[str, object]:
        """Its values in a handle (`hydro2d.kernels.names.TRAVEL`)."""
        return {**super().values(), "followed": self.m, "heading": float(self.direction), "placed": self._placed,
                "reach": self.space.reach(self.direction)}

    def prepare(self, given: Conductor) -> None:
        """Begins with the state as it is, at the start or after a restart: nothing is placed beyond the leading edge yet."""
        self._placed[:] = np.inf, -np.inf
        given.run(between_phases.announce)

    def follow(self, given: Conductor) -> None:
        """Takes the mass-weighted mean velocity of the body's core, or of the whole body if it has no core; never backward."""
        given.ask(between_phases.follow_core, partial(self._follow_whole, given.handle))

    def _follow_whole(self, handle: Handle) -> None:
        """Takes the mean velocity of the whole body."""
        s, g, m, rows = self.state, self.grid, self.m, np.zeros((2, self.grid.shape[0]))
        sums.body_sums(g.g, g.nz, g.nr, m, g.cm_in, g.cm_out, g.volume, s.vof, s.rho, handle.v[s.group[m]], rows)
        mass, momentum = rows[:, g.inside[0]].sum(axis=1)
        velocity = momentum / mass if mass > 0.0 else 0.0
        handle.update(mesh_speed=velocity if velocity * self.direction > 0.0 else 0.0)

    def fill_ghosts(self, given: Conductor) -> None:
        """Inserts the deck's material in the strip that the leading edge crosses in the step, at rest and without stress.

        Nothing else writes there: the material stays until other material replaces it.
        """
        given.ask(between_phases.look_ahead, partial(self._place, given.handle))

    def _place(self, handle: Handle) -> None:
        """Inserts the material in the ghost rows ahead."""
        s, g, z, rows = self.state, self.grid, self._edge, self._ghost_rows
        height = max(abs(handle.mesh_speed) * handle.dt, THINNEST * g.dz[rows[0]])
        strip, self._placed[:] = self.space.strip(*((z, z + height) if self.leading else (z - height, z)))
        vof, rho, e, centroid = (self._padded(strip[name]) for name in ("vof", "rho", "e", "centroid"))
        for row in rows:
            s.vof[:, row], s.q[:, :, row] = vof, s.initial[:, :, None]
            s.q[RHO, :, row], s.q[E, :, row], s.centroid[:, :, row] = rho, e, centroid

    def move(self, given: Conductor) -> None:
        """Advances the mesh by w dt, and drops bodies that are wholly inside."""
        given.run(between_phases.move_mesh)

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
