"""One step of the method. The only file that knows both the state and the kernels.

`Cycle.advance` is the page to read: equation of state, mixed-cell closure, viscosity and time step; stress, forces and
velocities, work and strain (the Lagrangian step); then the remap, one sweep per direction, their order reversed every cycle.
`kernels.lagrangian_step` and `kernels.remap_step` list the kernels of its phases.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from hydro2d import jit
from hydro2d.kernels import between_phases, lagrangian_step, remap_step
from hydro2d.kernels.between.active_box import FEWEST, RECUT
from hydro2d.measure.audit import Audit
from hydro2d.measure.courses import Courses
from hydro2d.mesh.sinks import SINKS
from hydro2d.solver import time_step
from hydro2d.solver.active import ActiveBox
from hydro2d.solver.contact_ties import Contact
from hydro2d.solver.edge_lines import EdgeLines
from hydro2d.solver.following import FixedMesh
from hydro2d.solver.given import Given
from hydro2d.solver.method import Method
from hydro2d.solver.refusals import Refusals
from hydro2d.solver.sources import Sources


def _number(name: str, meaning: str) -> property:
    """A number that the handle has."""
    return property(lambda cycle: getattr(cycle.given.handle, name), lambda cycle, value: cycle.given.handle.update(
        **{name: value}), doc=meaning)


class Cycle:
    """Advances a state, cycle by cycle.

    Parameters
    ----------
    state : State, with vof, q, u and v set
    table : MaterialTable
    method : Method
    mesh : the motion of the mesh; without it the mesh is fixed
    sources : Sources; without them no energy is added
    speed : with which bodies may meet, m/s (`reach.speed_of_all`)

    Attributes
    ----------
    active : ActiveBox, the cells that are active;  box : its rows and columns [j0, j1, i0, i1]
    rows : int64[n + 1], first row of each part of the box and one past the last
    sound_floor : float, least square of the speed of sound, m^2/s^2
    sound_speeds : float64[m], bulk sound speed of every body at rest, m/s
    audit : Audit
    watches : functions of the conductor that are called at the end of every cycle, as the parts of the page are
    """

    time = _number("reached", "time reached, s")
    dt = _number("dt", "last time step, s")
    number = _number("cycle", "cycles done")
    speed_limit = _number("speed_limit", "greatest speed of a vertex, m/s")

    def __init__(self, state, table, method: Method, mesh=None, sources: Sources | None = None, speed: float = 0.0):
        self.state, self.table, self.method = state, table, method
        self.mesh, self.sources = mesh or FixedMesh(), sources or Sources((), state, table, [])
        self.grid = state.grid
        self.contact = Contact(state)
        skips = method.numerics.active_region and self.mesh.leading is None and not self.sources
        self.edges, self.active = EdgeLines(method.boundaries, state.grid), ActiveBox(state, table, method.boundaries, skips)
        self.courses, self.mesh_box = Courses(state), self.active.mesh
        self.sound_floor = time_step.sound_floor(speed, table.sound_speeds())
        self.sound_speeds = table.sound_speeds(self.sound_floor)
        self.sink_names = (*SINKS, *method.boundaries.sinks, *self.sources.names)
        self._audit: Audit | None = None
        self._cause: tuple[int, str] = (0, "start")
        self._tape: jit.Tape | None = None
        self.watches: list[Callable[[Given], None]] = []
        self.refusals, self.given = Refusals(self), Given(self, table)

    @property
    def box(self) -> list[int]:
        """Rows and columns [j0, j1, i0, i1] of the cells that are active."""
        return self.active.box

    @property
    def rows(self) -> np.ndarray:
        """First row of each part of the box and one past the last, int64[n + 1]."""
        return self.given.handle.parts

    @property
    def audit(self) -> Audit | None:
        """The audit; None before the first `prepare`, which opens it."""
        return self._audit

    @audit.setter
    def audit(self, audit: Audit | None) -> None:
        self._audit = audit
        if audit is not None:
            self.given.handle.update(sinks=audit.amounts, transfers=audit.exchanged)

    @property
    def cause(self) -> str:
        """What has set the last time step, and its place, in words."""
        number, said = self._cause
        return said if number == self.number else time_step.cause(self)

    @cause.setter
    def cause(self, said: str) -> None:
        self._cause = self.number, said

    # ------------------------------------------------------------------------------------------------ the page

    def advance(self) -> None:
        """One step: time n to n + 1."""
        self._limit_parts()
        self._step(self.number % 2)
        self.given.meet()

    def _step(self, odd: int) -> None:
        """The list of a step, the same for every step whose number is even, or odd."""
        self.activate()
        self.find_slip_zones()
        self.mesh.follow(self.given)
        self.close_cells()
        self.choose_step()

        self.accelerate()
        self.deform()

        directions = ((1, 0), (0, 1)) if odd else ((0, 1), (1, 0))
        for second, (dj, di) in enumerate(directions):
            self.remap_bodies(dj, di, second)
            self.remap_momentum(dj, di, second)

        self.mesh.move(self.given)
        self.add_heat()
        self.given.run(between_phases.end_step)
        for watch in self.watches:
            watch(self.given)
        self.given.ask(between_phases.look_at_clock, None)

    def play(self, until: float, last: int) -> None:
        """Steps until a time in s, or up to the step of this number: at least one, all in one call of compiled code.

        The first step of an engine goes through the list as `advance` does, since the tape of it needs its compiled code.
        """
        if self._tape is None:
            self.advance()
            self._tape = self._recorded()
            if self.time >= until or self.number >= last:
                return
        self._limit_parts()
        self.given.handle.update(until=float(until), last_cycle=int(last))
        try:
            self._tape.play(self.given.handle, self._tape.starts[self.number % 2])
        finally:
            self.given.meet()

    def _recorded(self) -> jit.Tape:
        """The list of an even step and of an odd one on a tape."""
        with self.given.record() as tape:
            for odd in range(2):
                tape.starts.append(len(tape))
                self._step(odd)
        return tape

    # ------------------------------------------------------------------------------------------------ preparation

    def prepare(self) -> None:
        """Everything that follows from vof, q, u, v: masses, ranges, the active box. Called at the start or a restart."""
        s, every = self.state, self.box
        self.active.box = self.mesh_box.tolist()
        self.mesh.prepare(self.given)
        self._find_bodies()
        s.cell_mass[...], s.mass[...] = 0.0, 0.0
        self.given.run(remap_step.find_masses)
        if self.audit is None:
            self.active.begin()
            self.courses.look(self.time)
            self.audit = Audit.open(s, self.sound_speeds, self.sink_names[len(SINKS):])
            self.speed_limit = time_step.speed_limit(s, self.sound_speeds)
        else:
            self.active.box = every
        self.given.set(sound_floor=self.sound_floor)
        if not self.active.is_all:  # beyond the box nothing has a range yet
            s.empty_ranges()
            self._find_bodies()

    def _find_bodies(self) -> None:
        """Looks for every body in all columns of the active box, as one part."""
        j0, j1, i0, i1 = self.box
        self.given.set(parts=np.array([j0, j1], dtype=np.int64), i0=i0, i1=i1, grows=not self.active.is_all, age=RECUT)
        self.given.run(remap_step.find_bodies, anew=True)

    def activate(self) -> None:
        """Grows the active box ahead of all motion, and cuts it into parts."""
        self.given.run(remap_step.find_moving)
        self.given.run(between_phases.grow_box)
        self.given.ask(between_phases.cut_parts, self._cut_anew)
        self.given.run(remap_step.find_bodies)
        self.given.set(anew=False)

    def _limit_parts(self) -> None:
        """Allows as many parts as there are threads; if there are more, they are cut anew before they wait for one another."""
        most = jit.parts_at_once()
        self.given.handle.update(most_parts=most)
        if len(self.given.handle.parts) - 1 > most:
            self._cut_anew()

    def _cut_anew(self) -> None:
        """Cuts the active box into another number of parts."""
        j0, j1, _, _ = self.box
        number = max(min(self.given.handle.most_parts, (j1 - j0) // FEWEST), 1)
        self.given.handle.update(parts=np.zeros(number + 1, dtype=np.int64), age=RECUT)
        between_phases.cut_parts(self.given.handle)

    # ------------------------------------------------------------------------------------------------ Lagrangian step

    def find_slip_zones(self) -> None:
        """Distance to the hard bodies and the zones next to them, every few cycles."""
        if self.method.slip_layer:
            self.given.run(between_phases.is_time_for_zones)
            self.given.run(lagrangian_step.slip_zones)

    def close_cells(self) -> None:
        """Pressure and sound speed of every body, void where a cell fractures, viscosity, contact, the step a cell allows."""
        self.given.run(lagrangian_step.close_cells)
        if self.state.groups > 1:
            self.given.ask(between_phases.count_slots, partial(self.contact.make_room, self.given.handle))
            self.given.run(lagrangian_step.find_contact)
        self.given.ask(between_phases.judge_cells, self.refusals.bad_cells)

    def choose_step(self) -> None:
        """The time step, with the cell and the term that set it."""
        self.given.run(between_phases.choose_step_length)
        if self.method.boundaries.moves:
            self.given.do(partial(time_step.by_edges, self))
        self.given.ask(between_phases.begin_step, self.refusals.small_step)

    def accelerate(self) -> None:
        """Total stress of every cell at half the step, and the velocities at its end."""
        self.given.swap_velocities()
        if self.method.boundaries.changes:
            self.given.do(self._drive)
        if self.sources:
            self.given.do(self._push)
        self.given.run(lagrangian_step.accelerate)
        self.given.run(between_phases.book_acceleration)
        if self.sources:
            self.given.do(self._account)

    def _drive(self) -> None:
        self.method.boundaries.drive(self.time + self.dt, self.dt)

    def _push(self) -> None:
        self.sources.push(self.time, self.dt, self.edges.constrained_vertices)

    def _account(self) -> None:
        self.sources.account(self.audit)

    def deform(self) -> None:
        """Volumes that the faces sweep; work, volume, strain: body by body in pure cells, then the mixed cells."""
        self.given.run(lagrangian_step.deform)
        self.given.run(lagrangian_step.deform_mixed)

    # ------------------------------------------------------------------------------------------------ remap

    def remap_bodies(self, dj: int, di: int, second: int) -> None:
        """Volume of every body through every face of one direction, quantities it carries, and the cells after the sweep."""
        s = self.state
        face, own = (s.fr, self.given.handle.own_r) if di else (s.fz, self.given.handle.own_z)
        self.given.set(dj=dj, di=di, second=bool(second), face=face, own=own)
        self.given.run(between_phases.aim)
        self.mesh.fill_ghosts(self.given)
        self.given.run(remap_step.carry_bodies)
        self.given.ask(between_phases.book_outflow, partial(self.refusals.turned_cells, second))

    def remap_momentum(self, dj: int, di: int, second: int) -> None:
        """Velocities after the sweep, by the advection choice; discarded and tidied amounts are audited."""
        self.given.swap_velocities()
        self.given.run(remap_step.carry_momentum)
        self.given.run(between_phases.book_momentum)

    def add_heat(self) -> None:
        """Energy of sources."""
        if self.sources:
            self.given.do(self._heat)

    def _heat(self) -> None:
        self.sources.add_heat(self.time, self.dt, self.audit)
