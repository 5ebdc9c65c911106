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


def _of(owner, some: Iterable[fields.Work]) -> dict:
    """The attributes of an owner that have these names."""
    return {name.symbol: getattr(owner, name.symbol) for name in some if hasattr(owner, name.symbol)}


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
        arrays = _of(state, [name for name in names.NAMES if name not in names.TIES])
        absent = (*(fields.CONTACT_WORK if state.groups == 1 else fields.HOLD_WORK),
                  *(() if table.remembers else fields.MEMORY_WORK))
        arrays |= {work.symbol: np.zeros((0,) * len(work.axes.split()), dtype=work.kind) for work in absent}
        order, own = method.interface_order, state.group[method.interface_order]
        models, materials = rows.packed(table, method.strength_cutoff * table.rho0, method.yield_factor)
        bodies = {
            "models": models, "materials": materials, "carried": _carried(table), "gases": materials[:, rows.GAS] > 0.0,
            "strong": models[:, rows.STRENGTH] != 0, "fades": materials[:, rows.FADES].copy(),
            "tension": rows.tension(models, materials), "hard_bodies": method.hard, "interface_order": order,
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
        choices = _of(method, [name for name in names.METHOD]) | {
            "contact": state.groups > 1, "remembers": table.remembers, "slip_layer": method.slip_widths is not None,
            "strength_mode": method.mixed_strength,
            "hard_threshold": method.threshold, "underfilled_density": method.mass_floor * float(np.max(table.rho0)),
            "most_squares": most_squares(table, method.courant) if state.groups > 1 else 1.0,
        }
        if method.slip_widths is not None:
            choices["width_bl"], choices["width_sl"] = method.slip_widths
        self.handle.update(**arrays, **_of(cycle.grid, names.MESH), **bodies, **edges, **choices, anew=False)
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
