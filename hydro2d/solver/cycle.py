"""One step of the method. The only file that knows both the state and the kernels.

`Cycle.advance` is the page to read: equation of state, mixed-cell closure, viscosity and time step; stress, forces and
velocities, work and strain (the Lagrangian step); then the remap, one sweep per direction, their order reversed every cycle.
"""

from __future__ import annotations

import numpy as np

from hydro2d.errors import UnphysicalState
from hydro2d.kernels import (
    acceleration,
    column_ranges,
    contact_motion,
    lagrangian_step,
    momentum,
    remap,
    remap_step,
    sliding,
    thermodynamics,
)
from hydro2d.mesh import fields
from hydro2d.physics import waves
from hydro2d.solver.arguments import Arguments
from hydro2d.solver.audit import Audit
from hydro2d.solver.contact import Contact, NoContact
from hydro2d.solver.courses import Courses
from hydro2d.solver.following import StandingMesh
from hydro2d.solver.method import Method
from hydro2d.solver.parts import Parts
from hydro2d.solver.sources import Sources

#: cells that the active box leads the moving vertices by; one cycle spreads a signal by fewer
MARGIN = 6
#: vertices may be this much faster than the fastest body was at the start, or than the slowest wave
SPEED_LIMIT_FACTOR = 5.0


class Cycle:
    """Advances a state, cycle by cycle.

    Parameters
    ----------
    state : State, with vof, q, u and v set
    table : MaterialTable
    method : Method
    mesh : what says how the mesh moves; without it the mesh stands
    sources : Sources; without them nothing gives energy

    Attributes
    ----------
    time, dt, number : time reached (s), last time step (s), cycles done
    cause : str, what set the last time step, and where
    box : [j0, j1, i0, i1] of the cells that are active
    rows : int64[n + 1], first row of each part of the box and one past the last (`parts`)
    sound_speeds : float64[m], bulk sound speed of every body at rest, m/s
    audit : Audit
    """

    def __init__(self, state, table, method: Method, mesh=None, sources: Sources | None = None):
        self.state, self.table, self.method = state, table, method
        self.mesh, self.sources = mesh or StandingMesh(), sources or Sources((), state, table, [])
        grid = self.grid = state.grid
        self.time, self.dt, self.number, self.cause = 0.0, 0.0, 0, "start"
        g = grid.g
        self.mesh_box = np.array([g, g + grid.nz, g, g + grid.nr], dtype=np.int64)
        at = np.array([g, g + grid.nr, g, g + grid.nz], dtype=np.int64)
        self.constrained = np.where(method.boundaries.having("holds"), at, -1)
        self.pushing = np.where(method.boundaries.having("pushes"), at, -1)
        along_z = zip(method.boundaries.edges[2:], np.maximum(self.constrained, self.pushing)[2:].tolist(), strict=True)
        self._rows_that_hold = [(edge, j) for edge, j in along_z if j >= 0]
        lines = np.s_[:, 0], np.s_[:, -1], np.s_[0, :], np.s_[-1, :]
        self._held = [(edge.sink, n // 2, lines[n]) for n, edge in enumerate(method.boundaries.edges) if edge.holds()]
        self._widths = [*grid.dr[[g, g + grid.nr - 1]].tolist(), *grid.dz[[g, g + grid.nz - 1]].tolist()]
        self.transmitting = np.where(method.boundaries.having("transmits"), at, -1)
        self.carried = fields.carried_rows([
            fields.carried(own, bool(strength), bool(damage) or bool(stress < np.inf)) for own, strength, damage, stress in
            zip(table.internal, table.strength_model, table.damage_model, table.fracture_stress, strict=True)])
        self.contact = Contact(state) if state.groups > 1 else NoContact()
        self.box = list(self.mesh_box)
        self.parts, self.rows = Parts(state), self._one_part
        self.sound_speeds = table.sound_speeds(thermodynamics.SOUND_FLOOR)
        self.audit: Audit | None = None
        self.courses = Courses(state)
        self.speed_limit = 0.0
        self.arguments = Arguments(self, table)

    def edges_with_void_beyond(self) -> np.ndarray:
        """The edges of the mesh (rows j0, j1, columns i0, i1) through which nothing but void comes in, -1 for the others."""
        found = self.mesh_box.copy()
        found[np.roll(self.method.boundaries.having("supplies"), 2)] = -1
        if self.mesh.leading is not None:
            found[self.mesh.leading] = -1
        return found

    # ------------------------------------------------------------------------------------------------ the page

    def advance(self) -> None:
        """One step: time n to n + 1."""
        self.activate()
        self.rows = self.parts.of(self.box)
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
        self.sources.give(self.time, self.dt, self.audit)
        self.time += self.dt
        self.number += 1

    # ------------------------------------------------------------------------------------------------ preparation

    def prepare(self) -> None:
        """Everything that follows from vof, q, u, v: masses, ranges, the active box. Called once, and after a restart."""
        s = self.state
        every = self.box
        self.box = list(self.mesh_box)
        self.mesh.prepare()
        self._find_ranges()
        s.cell_mass[...], s.mass[...] = 0.0, 0.0
        remap.sum_cell_mass(0, self._one_part, s.group_ranges, s.group, self.grid.volume, s.vof, s.q, s.cell_mass)
        self._vertex_mass()
        if self.audit is None:
            self.box = self._first_box() if self._skips_cells else list(self.mesh_box)
            self.courses.look(self.time)
            self.audit = Audit.open(s, self.sound_speeds, (*self.method.boundaries.sinks, *self.sources.names))
            fastest = float(np.sqrt(np.max(s.u**2 + s.v**2)))
            self.speed_limit = SPEED_LIMIT_FACTOR * max(fastest, float(self.sound_speeds.min()))
        else:
            self.box = every
        self.arguments.limit_speed(self.speed_limit)
        if self.box != list(self.mesh_box):  # beyond the box nothing has a range yet
            s.empty_ranges()
            self._find_ranges()
        self._list_mixed()

    @property
    def _skips_cells(self) -> bool:
        """Whether quiet cells may be skipped: not where the mesh travels, and every cell hands on what it holds, nor where
        sources may heat what no signal has reached."""
        return self.method.active_region and self.mesh.leading is None and not self.sources

    def _first_box(self) -> list[int]:
        """Smallest box around everything that moves or is under pressure or stress, the edges that drive, and the margin; the
        whole mesh where there is nothing but edges."""
        s, t, (j0, j1, i0, i1) = self.state, self.table, self.mesh_box
        loud = np.zeros(self.grid.shape, dtype=bool)
        for m in range(s.bodies):
            present = s.vof[m] > 0
            quiet_p = t.evaluate(m, t.rho0[m], 0.0)[0] == 0.0
            at_rest = (s.rho[m] == t.rho0[m]) & (s.e[m] == 0.0) & (s.q[2:5, m] == 0.0).all(axis=0)
            loud |= present & ~(at_rest & quiet_p)
        moving, drives = ((s.u != 0) | (s.v != 0)).any(axis=0), self.method.boundaries.having("drives")
        for at, edge_drives in zip((np.s_[:, i0], np.s_[:, i1], np.s_[j0], np.s_[j1]), drives, strict=True):
            moving[at] &= not edge_drives
        loud |= moving[:-1, :-1] | moving[1:, :-1] | moving[:-1, 1:] | moving[1:, 1:]
        if not loud[j0:j1, i0:i1].any():
            return list(self.mesh_box)
        beside = np.s_[:, i0], np.s_[:, i1 - 1], np.s_[j0], np.s_[j1 - 1]
        for cells, edge_drives in zip(beside, drives, strict=True):
            loud[cells] |= edge_drives
        rows, columns = np.nonzero(loud[j0:j1, i0:i1])
        return self._clipped([rows.min() + j0, rows.max() + j0 + 1, columns.min() + i0, columns.max() + i0 + 1], MARGIN)

    def _clipped(self, box, margin) -> list[int]:
        j0, j1, i0, i1 = self.mesh_box
        return [int(max(box[0] - margin, j0)), int(min(box[1] + margin, j1)), int(max(box[2] - margin, i0)),
                int(min(box[3] + margin, i1))]

    def activate(self) -> None:
        """Lets the active box grow ahead of whatever moves (explanation/speed, equation 1)."""
        if self.box == list(self.mesh_box):
            return
        s, (j0, j1, i0, i1) = self.state, self.box
        column_ranges.moving_columns(0, self._one_part, i0, i1 + 1, s.u, s.v, s.row_moving)
        column_ranges.moving_box(j0, j1 + 1, s.row_moving, s.moving)
        first, last, low, high = s.moving
        if first == last:
            return
        grown = self._clipped([first - 1, last, low - 1, high], MARGIN)
        box = [min(j0, grown[0]), max(j1, grown[1]), min(i0, grown[2]), max(i1, grown[3])]
        if box != self.box:
            self.box = box
            self._find_ranges()
            self._list_mixed()

    @property
    def _one_part(self) -> np.ndarray:
        """The rows of the active box as one part."""
        return np.array(self.box[:2], dtype=np.int64)

    def _find_ranges(self) -> None:
        """Looks for every body in the whole of the active box."""
        s, rows, (_, _, i0, i1) = self.state, self._one_part, self.box
        column_ranges.find_body_ranges(0, rows, i0, i1, True, s.group, s.vof, s.body_ranges, s.occupied)
        column_ranges.find_active_ranges(0, rows, i0, i1, s.occupied, s.group_ranges)
        column_ranges.widen_ranges(0, rows, s.body_ranges, s.group_ranges)

    def _list_mixed(self) -> None:
        s = self.state
        column_ranges.list_mixed(0, self._one_part, s.active_range, s.vof, s.mixed_count, s.mixed, s.scratch)

    def _vertex_mass(self) -> None:
        s, rows, (_, _, i0, i1) = self.state, self._one_part, self.box
        acceleration.vertex_masses(0, rows, i0, i1 + 1, self.grid.metrics, s.group_ranges, s.cell_mass, s.mass)
        if s.groups > 1:
            contact_motion.keep_one(0, rows, i0, i1, s.group_ranges, s.mass, s.u, s.v)

    # ------------------------------------------------------------------------------------------------ Lagrangian step

    def find_slip_zones(self) -> None:
        """Distance to the hard bodies and the zones beside them, every few cycles."""
        s, g, method = self.state, self.grid, self.method
        if method.slip_widths is None or self.number % method.refresh:
            return
        sliding.slip_zones(*self.box, *method.slip_widths, method.threshold, g.rc, g.zc, g.dr, g.dz, method.hard, s.vof, s.hard,
                           s.distance, s.zone, s.normal)

    def close_cells(self) -> None:
        """Pressure and sound speed of every body, void where a cell fractures, viscosity, contact, the step a cell allows."""
        s, g, (_, _, i0, i1) = self.state, self.grid, self.box
        phase = lagrangian_step.close_cells
        phase(self.rows, i0, i1, float(self.mesh.velocity), *self.arguments.of(phase))
        self.contact.find(self.rows, i0, i1, self.arguments)
        if s.least_row[1] >= 0:
            self._report_bad(s.least_row[1])
        if s.least_row[2] >= 0:
            raise UnphysicalState(f"cycle {self.number}, time {self.time:.6g} s: velocities that are not finite near "
                                  f"z = {g.zc[s.least_row[2]]:.6g} m")

    def _report_bad(self, j: int) -> None:
        s, g = self.state, self.grid
        i, m = int(s.bad[j, 1]), int(s.bad[j, 2])
        limits = self.table.limits(m, s.rho[m, j, i], s.q[self.table.memory[m]:, m, j, i])
        raise UnphysicalState(
            f"cycle {self.number}, time {self.time:.6g} s, cell (r, z) = ({g.rc[i]:.6g}, {g.zc[j]:.6g}) m, body "
            f'"{self.table.names[m]}": volume fraction {s.vof[m, j, i]:.6g}, density {s.rho[m, j, i]:.6g} kg/m^3, energy '
            f"{s.e[m, j, i]:.6g} J/kg, pressure {s.pm[m, j, i]:.6g} Pa ({int(s.bad[j, 0])} such cells in its row)"
            + (f"; material {self.table.materials[m].name}: {limits}" if limits else ""))

    def choose_step(self) -> None:
        """The time step, with the cell and the term that set it."""
        s, g, method = self.state, self.grid, self.method
        j = int(s.least_row[0])
        stable = float(s.row_step[j])
        thermodynamics.step_cause(
            j, method.courant, method.advective_courant, self.mesh.velocity, g.dr, g.dz, g.metrics, s.active_range, s.u, s.v,
            s.rhobar, s.cl, s.qr, s.qz, s.cause)
        cause, i = s.cause
        ramp = min(1.0, method.initial_dt_factor + (1.0 - method.initial_dt_factor) * self.number / max(method.ramp_cycles, 1))
        dt, self.cause = stable * ramp, (f"{waves.CAUSES[cause]} at r = {g.rc[i] * 1e3:.3f} mm, "
                                         f"z = {g.zc[j] * 1e3:.3f} mm")
        if ramp < 1.0:
            self.cause += " (ramp)"
        if self.dt > 0.0 and dt > method.max_growth * self.dt:
            dt, self.cause = method.max_growth * self.dt, "growth"
        crossing, edge = method.boundaries.least_crossing(self._widths, self.time, self.time + dt)
        if dt > method.advective_courant * crossing:
            dt, self.cause = method.advective_courant * crossing, f"velocity of the edge {edge}"
        if not method.dt_min < dt < 1e300:
            m = int(np.argmax(s.vof[:, j, i]))
            raise UnphysicalState(f"cycle {self.number}, time {self.time:.6g} s: time step {dt:.3g} s, below dt_min = "
                                  f'{method.dt_min:.3g} s, set by {self.cause}, in body "{self.table.names[m]}"')
        self.dt = dt

    def accelerate(self) -> None:
        """Total stress of every cell at half the step, and the velocities at its end."""
        s, (j0, j1, i0, i1), phase = self.state, self.box, lagrangian_step.accelerate
        s.swap_velocities()
        self.method.boundaries.drive(self.time + self.dt)
        self.sources.push(self.time, self.dt, self._held)
        phase(self.rows, i0, i1, self.dt, *self.arguments.of(phase))
        if s.limited[2, j0:j1 + 1].any():
            self.audit.add("speed_limit", momentum=float(s.limited[0, j0:j1 + 1].sum()),
                           energy=float(s.limited[1, j0:j1 + 1].sum()))
        self.contact.account(j0, j1, self.audit)
        if s.held_back.any():
            self.audit.add("transmitted", momentum=float(s.held_back[0]), energy=float(s.held_back[1]))
        taken = s.walls.sum(axis=2).tolist()
        for edge, (momentum_taken, energy_taken) in zip(self.method.boundaries.edges, taken, strict=True):
            if momentum_taken != 0.0 or energy_taken != 0.0:
                self.audit.add(edge.sink, momentum=momentum_taken, energy=energy_taken)
        self.sources.account(self.audit)

    def deform(self) -> None:
        """Volumes that the faces sweep; work, volume, strain: body by body in pure cells, then the mixed cells."""
        (_, _, i0, i1), travels, dt, phase = self.box, self.mesh.leading is not None, self.dt, lagrangian_step.deform
        phase(self.rows, i0, i1, self.time + dt, dt, travels, float(self.mesh.velocity * dt), *self.arguments.of(phase))

    # ------------------------------------------------------------------------------------------------ remap

    def remap_bodies(self, dj: int, di: int, second: int) -> None:
        """Volume of every body through every face of one direction, what it carries with it, and the cells after the sweep."""
        (_, _, i0, i1), leading, phase = self.box, self.mesh.leading, remap_step.carry_bodies
        self.mesh.fill_ghosts(self.dt)
        phase(self.rows, i0, i1, dj, di, bool(second), -1 if leading is None else leading,
              *self.arguments.of(phase))
        self._refuse_turned_cells(second)
        self._audit_outflow(di)

    def _refuse_turned_cells(self, second: int) -> None:
        """Raises UnphysicalState where what the faces of a cell swept is more than its volume, of both directions or of the
        second, so that no remap can give back what was in it."""
        s, g, (j0, j1, _, _) = self.state, self.grid, self.box
        if s.turned[j0:j1, 0].max() < 0:
            return
        j = j0 + int(np.argmax(s.turned[j0:j1, 0] >= 0))
        i, m = s.turned[j].tolist()
        raise UnphysicalState(
            f"cycle {self.number}, time {self.time:.6g} s, cell (r, z) = ({g.rc[i]:.6g}, {g.zc[j]:.6g}) m, body "
            f'"{self.table.names[m]}": the step of {self.dt:.3g} s turned the cell inside out'
            f"{' along one direction' if second else ''}, to {s.pre[j, i] / g.volume[j, i]:.3g} of its volume")

    def _open_edges(self, di: int) -> tuple[bool, bool]:
        """Whether bodies flow through the low and the high edge of a direction, where the active box has reached them."""
        opens = self.method.boundaries.having("opens")
        (low, high), n = (opens[0:2], 2) if di else (opens[2:4], 0)
        return (bool(low) and self.box[n] == self.mesh_box[n], bool(high) and self.box[n + 1] == self.mesh_box[n + 1])

    def _audit_outflow(self, di: int) -> None:
        first, last = self.box[:2] if di else self.box[2:]
        for side, (opened, (out, back)) in enumerate(zip(self._open_edges(di), self.state.outflow, strict=True)):
            if opened:
                self.courses.crossed(di, side, first, last, self.mesh.velocity * self.dt)
            if opened and out.any():
                self.audit.add("outflow", mass=out[1:].copy(), energy=float(out[0]))
            if opened and back.any():
                self.audit.add("inflow", mass=back[1:].copy(), energy=float(back[0]))

    def remap_momentum(self, dj: int, di: int, second: int) -> None:
        """Velocities after the sweep, by the advection choice; what it discards and what is tidied away is audited."""
        s, (j0, j1, i0, i1), phase = self.state, self.box, remap_step.carry_momentum
        s.swap_velocities()
        phase(self.rows, i0, i1, dj, di, bool(second), *self._open_edges(di), *self.arguments.of(phase))
        before, after, p_gained, k_cut, _ = s.momentum_sums[:, j0:j1 + 1].sum(axis=1)
        lost = before - after - self._kinetic_outflow(di)
        if self.method.advection == momentum.BOTH:
            lost -= s.deposited[j0:j1].sum()
        self.audit.add("advection", momentum=-float(p_gained), energy=float(lost - k_cut))
        self.audit.add("ke_bound", energy=float(k_cut))
        for edge, j in self._rows_that_hold:
            if j0 <= j <= j1:
                self.audit.add(edge.sink, momentum=float(s.momentum_sums[4, j]))
        internal, kinetic, axial, _, *mass = s.removed[:, j0:j1].sum(axis=1)
        self.audit.add("cutoff", mass=np.array(mass), momentum=float(axial), energy=float(internal + kinetic))

    def _kinetic_outflow(self, di: int) -> float:
        """Audits the momentum that went through open edges and returns the kinetic energy that left with it."""
        total = 0.0
        for opened, ways in zip(self._open_edges(di), self.state.kinetic_outflow.tolist(), strict=True):
            for name, (axial, energy) in zip(("outflow", "inflow"), ways, strict=True):
                if opened and energy != 0.0:
                    self.audit.add(name, momentum=axial, energy=energy)
                    total += energy
        return total
