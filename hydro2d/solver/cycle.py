"""One step of the method. The only file that knows both the state and the kernels.

`Cycle.advance` is the page to read: equation of state, mixed-cell closure, viscosity and time step; stress, forces and
velocities, work and strain (the Lagrangian step); then the remap, one sweep per direction, their order reversed every cycle.
`kernels.lagrangian_step` and `kernels.remap_step` list the kernels of its phases.
"""

from __future__ import annotations

from collections.abc import Callable

from hydro2d.kernels import lagrangian_step, remap_step
from hydro2d.measure.audit import Audit
from hydro2d.measure.courses import Courses
from hydro2d.solver import time_step
from hydro2d.solver.active import ActiveBox
from hydro2d.solver.books import Books
from hydro2d.solver.contact_ties import Contact, NoContact
from hydro2d.solver.edge_lines import EdgeLines
from hydro2d.solver.following import FixedMesh
from hydro2d.solver.given import Given
from hydro2d.solver.method import Method
from hydro2d.solver.refusals import Refusals
from hydro2d.solver.row_parts import Parts
from hydro2d.solver.sources import Sources


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
    time, dt, number : time reached (s), last time step (s), cycles done
    cause : str, the cause of the last time step, and its place
    active : ActiveBox, the cells that are active;  box : its rows and columns [j0, j1, i0, i1]
    rows : int64[n + 1], first row of each part of the box and one past the last (`row_parts`)
    sound_floor : float, least square of the speed of sound, m^2/s^2
    sound_speeds : float64[m], bulk sound speed of every body at rest, m/s
    audit : Audit
    crossings : functions of direction, edge, and first and last place along it, called after a sweep for every open edge that
        the active box has reached, see `Courses.crossed`
    """

    def __init__(self, state, table, method: Method, mesh=None, sources: Sources | None = None, speed: float = 0.0):
        self.state, self.table, self.method = state, table, method
        self.mesh, self.sources = mesh or FixedMesh(), sources or Sources((), state, table, [])
        self.grid = state.grid
        self.time, self.dt, self.number, self.cause = 0.0, 0.0, 0, "start"
        self.contact = Contact(state) if state.groups > 1 else NoContact()
        skips = method.numerics.active_region and self.mesh.leading is None and not self.sources
        self.edges, self.active = EdgeLines(method.boundaries, state.grid), ActiveBox(state, table, method.boundaries, skips)
        self.parts, self.courses = Parts(state), Courses(state)
        self.mesh_box, self.rows = self.active.mesh, self.active.rows
        self.sound_floor = time_step.sound_floor(speed, table.sound_speeds())
        self.sound_speeds = table.sound_speeds(self.sound_floor)
        self.speed_limit = 0.0
        self.audit: Audit | None = None
        self.crossings: list[Callable[[int, int, int, int], None]] = []
        self.books, self.refusals, self.given = Books(self), Refusals(self), Given(self, table)

    @property
    def box(self) -> list[int]:
        """Rows and columns [j0, j1, i0, i1] of the cells that are active."""
        return self.active.box

    # ------------------------------------------------------------------------------------------------ the page

    def advance(self) -> None:
        """One step: time n to n + 1."""
        self.activate()
        self.find_slip_zones()
        self.mesh.follow()
        self.close_cells()
        self.choose_step()

        self.accelerate()
        self.deform()

        directions = ((0, 1), (1, 0)) if self.number % 2 == 0 else ((1, 0), (0, 1))
        for second, (dj, di) in enumerate(directions):
            self.remap_bodies(dj, di, second)
            self.remap_momentum(dj, di, second)

        self.mesh.move(self.dt)
        self.sources.add_heat(self.time, self.dt, self.audit)
        self.time += self.dt
        self.number += 1

    # ------------------------------------------------------------------------------------------------ preparation

    def prepare(self) -> None:
        """Everything that follows from vof, q, u, v: masses, ranges, the active box. Called at the start or a restart."""
        s, every = self.state, self.box
        self.active.box = self.mesh_box.tolist()
        self.mesh.prepare()
        self._in_one_part(remap_step.find_bodies, anew=True)
        s.cell_mass[...], s.mass[...] = 0.0, 0.0
        self.given.run(remap_step.find_masses)
        if self.audit is None:
            self.active.begin()
            self.courses.look(self.time)
            self.audit = Audit.open(s, self.sound_speeds, (*self.method.boundaries.sinks, *self.sources.names))
            self.speed_limit = time_step.speed_limit(s, self.sound_speeds)
        else:
            self.active.box = every
        self.given.handle.update(speed_limit=self.speed_limit, sound_floor=self.sound_floor, dt=self.dt)
        if not self.active.is_all:  # beyond the box nothing has a range yet
            s.empty_ranges()
            self._in_one_part(remap_step.find_bodies, anew=True)
        self._in_one_part(remap_step.list_mixed)

    def _in_one_part(self, phase, **given) -> None:
        """Runs a phase on the active box as one part."""
        _, _, i0, i1 = self.box
        self.given.run(phase, parts=self.active.rows, i0=i0, i1=i1, **given)

    def activate(self) -> None:
        """Grows the active box ahead of all motion, and cuts it into parts."""
        if not self.active.is_all:
            self._in_one_part(remap_step.find_moving)
            if self.active.grow():
                self._in_one_part(remap_step.find_bodies, anew=True)
                self._in_one_part(remap_step.list_mixed)
        self.rows = self.parts.of(self.box)
        self.given.handle.update(parts=self.rows, i0=self.box[2], i1=self.box[3], anew=False)

    # ------------------------------------------------------------------------------------------------ Lagrangian step

    def find_slip_zones(self) -> None:
        """Distance to the hard bodies and the zones next to them, every few cycles."""
        if self.method.slip_layer and self.number % self.method.sliding.refresh == 0:
            self.given.run(lagrangian_step.slip_zones)

    def close_cells(self) -> None:
        """Pressure and sound speed of every body, void where a cell fractures, viscosity, contact, the step a cell allows."""
        self.given.run(lagrangian_step.close_cells, mesh_speed=self.mesh.velocity)
        self.contact.find(self.rows, self.given)
        self.refusals.bad_cells()

    def choose_step(self) -> None:
        """The time step, with the cell and the term that set it."""
        dt, self.cause = time_step.chosen(self)
        self.refusals.small_step(dt, self.cause)
        self.dt = dt

    def accelerate(self) -> None:
        """Total stress of every cell at half the step, and the velocities at its end."""
        self.state.swap_velocities()
        self.method.boundaries.drive(self.time + self.dt, self.dt)
        self.sources.push(self.time, self.dt, self.edges.constrained_vertices)
        self.given.run(lagrangian_step.accelerate, dt=self.dt)
        self.books.acceleration()

    def deform(self) -> None:
        """Volumes that the faces sweep; work, volume, strain: body by body in pure cells, then the mixed cells."""
        self.given.run(lagrangian_step.deform)
        self.given.run(lagrangian_step.deform_mixed, time=self.time + self.dt, travels=self.mesh.leading is not None,
                       advance=self.mesh.velocity * self.dt)

    # ------------------------------------------------------------------------------------------------ remap

    def remap_bodies(self, dj: int, di: int, second: int) -> None:
        """Volume of every body through every face of one direction, quantities it carries, and the cells after the sweep."""
        s, leading = self.state, self.mesh.leading
        self.mesh.fill_ghosts(self.dt)
        face, own = (s.fr, "own_r") if di else (s.fz, "own_z")
        self.given.run(remap_step.carry_bodies, dj=dj, di=di, second=bool(second), leading=-1 if leading is None else leading,
                       face=face, own=self.given.handle.values[own])
        self.refusals.turned_cells(second)
        self.books.outflow(di)

    def remap_momentum(self, dj: int, di: int, second: int) -> None:
        """Velocities after the sweep, by the advection choice; discarded and tidied amounts are audited."""
        low, high = self.books.open_edges(di)
        self.state.swap_velocities()
        self.given.run(remap_step.carry_momentum, dj=dj, di=di, second=bool(second), opens_low=low, opens_high=high)
        self.books.momentum(di)
