"""Arguments of the phases of a step: a handle to the arrays and numbers of state, mesh, materials and method.

`hydro2d.kernels.names` has the meanings of the names.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hydro2d.jit import Handle, Phase
from hydro2d.kernels import names
from hydro2d.materials import rows
from hydro2d.mesh import fields
from hydro2d.mesh.edges.base import EDGES
from hydro2d.solver.contact_ties import most_squares

#: arrays that alternate: the velocities at the end of a step and at its beginning
AT_END, AT_BEGINNING = ("velocity", "u", "v"), ("velocity0", "u0", "v0")


def values(*owned: tuple[object, Iterable[fields.Work]]) -> dict[str, object]:
    """The values of names, each an attribute of its one owner.

    Raises ValueError for a name with two owners, AttributeError for one that its owner does not have.
    """
    owner_of: dict[str, object] = {}
    for owner, some in owned:
        for symbol in (name.symbol for name in some):
            if symbol in owner_of:
                raise ValueError(f"the name {symbol} has two owners")
            owner_of[symbol] = owner
    return {symbol: getattr(owner, symbol) for symbol, owner in owner_of.items()}


def _carried(table) -> np.ndarray:
    """The rows of q that the remap carries, body by body."""
    return fields.carried_rows([
        fields.carried(own, bool(strength), bool(damage) or bool(stress < np.inf)) for own, strength, damage, stress in
        zip(table.internal, table.strength_model, table.damage_model, table.fracture_stress, strict=True)])


class Given:
    """The handle of an engine, kept up to date.

    Parameters
    ----------
    cycle : Cycle, with its edges set
    table : MaterialTable

    Attributes
    ----------
    handle : Handle
    """

    def __init__(self, cycle, table):
        self._state, self._contact, self.handle = cycle.state, cycle.contact, Handle()
        state, method = cycle.state, cycle.method
        beside, absent = ((fields.CONTACT_WORK, fields.HOLD_WORK) if state.groups > 1 else
                          (fields.HOLD_WORK, fields.CONTACT_WORK))
        memory, no_memory = (fields.MEMORY_WORK, ()) if table.remembers else ((), fields.MEMORY_WORK)
        sections = method.numerics, method.sliding, method.failure
        owned = values((state, (*names.STATE, *beside, *memory)), (cycle.grid, names.MESH), (method, names.WORDS),
                       *((section, names.NUMBERS[type(section)]) for section in sections))
        empty = {work.symbol: np.zeros((0,) * len(work.axes.split()), dtype=work.kind) for work in (*absent, *no_memory)}
        order, own = method.interface_order, state.group[method.interface_order]
        models, materials = rows.packed(table, method.failure.strength_cutoff * table.rho0, method.yield_factor)
        bodies = {
            "models": models, "materials": materials, "carried": _carried(table), "gases": materials[:, rows.GAS] > 0.0,
            "strong": models[:, rows.STRENGTH] != 0, "fades": materials[:, rows.FADES].copy(),
            "tension": rows.tension(models, materials), "hard_bodies": method.hard_bodies, "interface_order": order,
            "hard_first": np.concatenate([order[own != 0], order[own == 0]]),
            "soft_first": np.concatenate([order[own == 0], order[own != 0]]),
        }
        edges = {
            **{f"mirror_{edge}": mirrors for edge, mirrors in zip(EDGES, method.boundaries.having("mirrors"), strict=True)},
            "mesh_box": cycle.mesh_box, "constrained": cycle.edges.constrained, "pushing": cycle.edges.pushing,
            "loaded": cycle.edges.loaded, "edge_velocity": method.boundaries.velocity,
            "edge_pressure": method.boundaries.pressure,
            "void_only": cycle.edges.void_beyond(cycle.mesh.leading), "pushed": cycle.sources.pushed,
        }
        derived = {
            "contact": state.groups > 1, "remembers": table.remembers,
            "underfilled_density": method.numerics.mass_floor * float(np.max(table.rho0)),
            "width_bl": method.slip_widths[0], "width_sl": method.slip_widths[1],
            "most_squares": most_squares(table, method.numerics.courant) if state.groups > 1 else 1.0,
        }
        self.handle.update(**owned, **empty, **bodies, **edges, **derived, anew=False)
        self._keep_up()

    def _keep_up(self) -> None:
        """Updates the handle: velocities alternate, and ties may have new slots."""
        if self.handle.values.get("masters") is not self._contact.ties.masters:
            self.handle.update(**self._contact.ties._asdict())
        if self.handle.values["velocity"] is not self._state.velocity:
            self.handle.exchange(AT_END, AT_BEGINNING)

    def run(self, phase: Phase, **given) -> None:
        """Runs a phase with these values, which stay set."""
        self._keep_up()
        self.handle.update(**given)
        phase(self.handle)
