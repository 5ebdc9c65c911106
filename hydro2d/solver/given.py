"""The handle of the phases of a step: arrays and numbers of state, mesh, materials and method.

`hydro2d.kernels.names` has the meanings of the names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import numpy as np

from hydro2d.jit import Conductor, Phase
from hydro2d.kernels import names
from hydro2d.kernels.between.choose_step import CELL
from hydro2d.materials import rows
from hydro2d.mesh import fields
from hydro2d.mesh.edges.base import EDGES
from hydro2d.solver.contact_ties import most_squares

#: names whose arrays alternate: the velocities at the end of a step and at its beginning
ALTERNATING = ("velocity", "velocity0"), ("u", "u0"), ("v", "v0")
#: steps that are remembered, more than are played at a time
REMEMBERED = 64


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


class Given(Conductor):
    """Runs phases on the handle of an engine.

    Parameters
    ----------
    cycle : Cycle, with its edges set
    table : MaterialTable
    """

    def __init__(self, cycle, table):
        super().__init__()
        self._state = state = cycle.state
        method, grid = cycle.method, cycle.grid
        beside, absent = ((fields.CONTACT_WORK, fields.HOLD_WORK) if state.groups > 1 else
                          (fields.HOLD_WORK, fields.CONTACT_WORK))
        memory, no_memory = (fields.MEMORY_WORK, ()) if table.remembers else ((), fields.MEMORY_WORK)
        sections = method.numerics, method.sliding, method.failure
        owned = values((state, (*names.STATE, *beside, *memory)), (grid, names.MESH), (method, names.WORDS),
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
        travel = {
            **cycle.mesh.values(), "z_start": grid.start[0], "zc_start": grid.start[1], "offset": grid.moved, "mesh_speed": 0.0,
            "travels": cycle.mesh.leading is not None, "leading": -1 if cycle.mesh.leading is None else cycle.mesh.leading,
        }
        books = {
            **cycle.edges.sinks(cycle.sink_names), "course_moved": cycle.courses.moved, "course_whole": cycle.courses.whole,
            "course_columns": cycle.courses.columns, "ejecta": np.zeros((0, 4)),
            "ejecta_bodies": np.zeros((0, 2), dtype=np.int64), "ejecta_gone": np.zeros((0, 3)),
        }
        none, no_rows = np.zeros((0, 0)), np.zeros(0, dtype=np.int64)
        watches = {
            "station_places": none, "tracer_places": none, "station_values": none, "station_peaks": none, "eos_par": none,
            "station_groups": no_rows, "eos_model": no_rows, "memory": no_rows, "rod_exits": no_rows, "rod": -1,
            "looks_every": 1, "rod_leaves": False, "crater_rows": np.zeros(0),
        }
        derived = {
            "contact": state.groups > 1, "remembers": table.remembers,
            "underfilled_density": method.numerics.mass_floor * float(np.max(table.rho0)),
            "width_bl": method.slip_widths[0], "width_sl": method.slip_widths[1],
            "most_squares": most_squares(table, method.numerics.courant) if state.groups > 1 else 1.0,
        }
        start = {
            "reached": 0.0, "time": 0.0, "dt": 0.0, "cycle": 0, "asks": 0, "until": np.inf, "last_cycle": 0, "limited_by": CELL,
            "ramped": False, "lengths": np.zeros(REMEMBERED), "grown": np.zeros(REMEMBERED, dtype=np.bool_), "advance": 0.0,
            "box": cycle.active.bounds, "grows": not cycle.active.is_all, "anew": False, "most_parts": 1, "age": 0,
            "parts": cycle.active.bounds[:2].copy(), "row_costs": np.zeros(grid.shape[0], dtype=np.int64),
            "finds_zones": False, "opens_low": False, "opens_high": False, "i0": cycle.box[2], "i1": cycle.box[3],
        }
        self.handle.update(**owned, **empty, **bodies, **edges, **travel, **books, **watches, **derived, **start,
                           **cycle.contact.ties._asdict())

    def ask(self, phase: Phase, function: Callable[[], object] | None) -> None:
        """Runs a phase, then a function of Python if the phase has set `asks`, see `jit.tape.Conductor`."""
        super().ask(phase, function and partial(self._met, function))

    def do(self, function: Callable[[], object]) -> None:
        """Runs a function of Python, every time."""
        super().do(partial(self._met, function))

    def _met(self, function: Callable[[], object]) -> None:
        self.meet()
        function()

    def swap_velocities(self) -> None:
        """Makes the velocities the old ones; the arrays of the old ones are written next."""
        self.exchange(*ALTERNATING)
        self.meet()

    def meet(self) -> None:
        """Gives the state the velocities that the handle has."""
        if self.handle.velocity is not self._state.velocity:
            self._state.swap_velocities()
