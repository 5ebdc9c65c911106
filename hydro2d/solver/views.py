"""The structures of arrays and numbers that the phases of a step take (`kernels.views`), made once for a state."""

from __future__ import annotations

import numpy as np

from hydro2d.kernels import views
from hydro2d.materials import rows
from hydro2d.mesh import fields
from hydro2d.solver.contact import most_squares


def _gathered(kind, *owners):
    """A named tuple of the arrays that the owners have under its names, the first that has one."""
    return kind(**{name: next(getattr(owner, name) for owner in owners if hasattr(owner, name)) for name in kind._fields})


#: work of contact where there is none: arrays of the same types without entries
_NO_CONTACT = views.ContactWork(*(np.zeros((0,) * len(work.axes.split()), dtype=work.kind) for work in fields.CONTACT_WORK))


class Views:
    """What the phases of a cycle take of its state, mesh, materials and method.

    Parameters
    ----------
    cycle : Cycle, with its boxes and edges set
    table : MaterialTable

    Attributes
    ----------
    geometry, edges, bodies, choices, work, contact : as in `kernels.views`
    """

    def __init__(self, cycle, table):
        state, grid, method = cycle.state, cycle.grid, cycle.method
        self._state = state
        self.geometry = _gathered(views.Geometry, grid, cycle)
        at = cycle.edge_lines
        boundaries = method.boundaries
        self.edges = views.Edges(
            mirrors=boundaries.having("mirrors"), constrained=cycle.constrained, velocity=boundaries.velocity,
            void_only=cycle.edges_with_void_beyond(), transmitting=np.where(boundaries.having("transmits"), at, -1))
        order, own = method.interface_order, state.group[method.interface_order]
        soft_first, hard_first = (np.array([*order[own == b], *order[own != b]], dtype=np.int64) for b in range(2))
        models, materials = rows.packed(table, method.strength_cutoff * table.rho0, method.yield_factor)
        self.bodies = views.Bodies(state.group, models, materials, cycle.carried, state.rules, method.hard, order, hard_first,
                                   soft_first)
        numbers = {name: kind(getattr(method, name)) for name, kind in views.Choices.__annotations__.items()
                   if hasattr(method, name)}
        self.choices = views.Choices(
            **numbers, slip_layer=method.slip_widths is not None, speed_limit=0.0,
            underfilled_density=method.mass_floor * float(np.max(table.rho0)), most_squares=most_squares(table, method.courant))
        self.work = _gathered(views.Work, state)
        self.contact = _gathered(views.ContactWork, state if state.groups > 1 else _NO_CONTACT)
        self._fields: dict[int, views.Fields] = {}

    def limit_speed(self, speed: float) -> None:
        """Bounds the speed of every vertex, m/s."""
        self.choices = self.choices._replace(speed_limit=float(speed))

    @property
    def fields(self) -> views.Fields:
        """The fields, with the velocities that are the new and the old ones now."""
        key = id(self._state.velocity)
        if key not in self._fields:
            self._fields[key] = _gathered(views.Fields, self._state)
        return self._fields[key]
