"""What the phases of a step are called with: arrays and numbers of the state, mesh, materials and method, found by their names.

A phase (`kernels.lagrangian_step`, `kernels.remap_step`) first takes what changes from call to call, then what stays: arrays
by their symbols in the tables of fields and of work or by the names that `Grid` and `Method` give them.
"""

from __future__ import annotations

import functools
import inspect
from typing import Any

import numpy as np

from hydro2d.materials import rows
from hydro2d.mesh import fields
from hydro2d.mesh.edges.base import EDGES
from hydro2d.solver.contact import most_squares

#: what a phase is given by `Cycle` with every call, before anything else
OF_THE_CALL = ("parts", "i0", "i1", "time", "dt", "mesh_speed", "travels", "advance", "dj", "di", "second", "leading",
               "opens_low", "opens_high")


@functools.cache
def names(phase) -> tuple[str, ...]:
    """What a phase takes beside what it is given with every call, in order."""
    return tuple(name for name in inspect.signature(phase).parameters if name not in OF_THE_CALL)


class Arguments:
    """The arguments of phases that stay from call to call.

    Parameters
    ----------
    cycle : Cycle, with its edges set
    table : MaterialTable
    """

    def __init__(self, cycle, table):
        state, method, boundaries = cycle.state, cycle.method, cycle.method.boundaries
        self._contact, self._ties = cycle.contact, cycle.contact.ties
        self._owners = state, cycle.grid, method, cycle.sources
        order, own = method.interface_order, state.group[method.interface_order]
        soft_first, hard_first = (np.array([*order[own == b], *order[own != b]], dtype=np.int64) for b in range(2))
        models, materials = rows.packed(table, method.strength_cutoff * table.rho0, method.yield_factor)
        self._own: dict[str, Any] = {
            **dict(zip((f"mirror_{edge}" for edge in EDGES), boundaries.having("mirrors"), strict=True)),
            "mesh_box": cycle.mesh_box, "constrained": cycle.constrained, "pushing": cycle.pushing,
            "edge_velocity": boundaries.velocity, "void_only": cycle.edges_with_void_beyond(),
            "transmitting": cycle.transmitting, "models": models, "materials": materials,
            "carried": cycle.carried, "gases": materials[:, rows.GAS] > 0.0, "strong": models[:, rows.STRENGTH] != 0,
            "hard_bodies": method.hard, "hard_first": hard_first,
            "soft_first": soft_first, "slip_layer": method.slip_widths is not None, "mixed_columns": state.mixed,
            "underfilled_density": method.mass_floor * float(np.max(table.rho0)),
            "most_squares": most_squares(table, method.courant) if state.groups > 1 else 1.0,
        }
        absent = (*(fields.CONTACT_WORK if state.groups == 1 else ()), *(() if table.remembers else fields.MEMORY_WORK))
        self._own |= {work.symbol: np.zeros((0,) * len(work.axes.split()), dtype=work.kind)
                      for work in absent}  # arrays of the same types without entries
        self._found: dict[tuple, tuple] = {}

    def limit_speed(self, speed: float) -> None:
        """Bounds the speed of every vertex, m/s."""
        self._own["speed_limit"] = float(speed)
        self._found.clear()

    def of(self, phase) -> tuple:
        """The arguments of a phase beside what it is given with every call."""
        if self._contact.ties is not self._ties:
            self._ties = self._contact.ties
            self._found.clear()
        key = phase, id(self._owners[0].velocity)  # the velocities take turns
        if key not in self._found:
            self._found[key] = tuple(self._look_up(name) for name in names(phase))
        return self._found[key]

    def _look_up(self, name: str):
        if name in self._own:
            return self._own[name]
        return next(getattr(owner, name) for owner in (self._ties, *self._owners) if hasattr(owner, name))
