"""One step of the method. The only file that knows both the state and the kernels.

`Cycle.advance` is the page to read: equation of state, mixed-cell closure, viscosity and time step; stress, forces and
velocities, work and strain (the Lagrangian step); then the remap, one sweep per direction, their order reversed every cycle.
"""

from __future__ import annotations

import numpy as np

from hydro2d.errors import UnphysicalState
from hydro2d.kernels import (
    acceleration,
    boundaries,
    column_ranges,
    cut_cells,
    deformation,
    interfaces,
    mixed,
    momentum,
    remap,
    sliding,
    thermodynamics,
)
from hydro2d.materials import rows
from hydro2d.mesh import fields
from hydro2d.physics import waves
from hydro2d.solver.audit import Audit
from hydro2d.solver.contact import Contact
from hydro2d.solver.following import StandingMesh
from hydro2d.solver.method import Method

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

    Attributes
    ----------
    time, dt, number : time reached (s), last time step (s), cycles done
    cause : str, what set the last time step, and where
    box : [j0, j1, i0, i1] of the cells that are active
    audit : Audit
    """

    def __init__(self, state, table, method: Method, mesh=None):
        self.state, self.table, self.method = state, table, method
        self.mesh = mesh or StandingMesh()
        grid = self.grid = state.grid
        self.time, self.dt, self.number, self.cause = 0.0, 0.0, 0, "start"
        g = grid.g
        self.mesh_box = np.array([g, g + grid.nz, g, g + grid.nr], dtype=np.int64)
        at = np.array([g, g + grid.nr, g, g + grid.nz], dtype=np.int64)
        self.constrained = np.where(method.boundaries.having("holds"), at, -1)
        self.transmitting = np.where(method.boundaries.having("transmits"), at, -1)
        self.void_only = self._edges_with_void_beyond()
        self.carried = np.array([self._carried(m) for m in range(state.bodies)])
        self.contact = Contact(state, method, self.mesh_box, self.constrained, table) if state.groups > 1 else None
        self.box = list(self.mesh_box)
        self.audit: Audit | None = None
        self.speed_limit = 0.0
        self.models, self.materials = rows.packed(table, method.strength_cutoff * table.rho0, method.yield_factor)
        self.underfilled_density = method.mass_floor * float(np.max(table.rho0))

    def _edges_with_void_beyond(self) -> np.ndarray:
        """The edges of the mesh (rows j0, j1, columns i0, i1) through which nothing but void comes in, -1 for the others."""
        found = self.mesh_box.copy()
        found[np.roll(self.method.boundaries.having("supplies"), 2)] = -1
        if self.mesh.leading is not None:
            found[self.mesh.leading] = -1
        return found

    def _carried(self, m: int) -> int:
        if self.table.internal[m]:
            return fields.INTERNAL + len(self.table.internal[m])
        if self.table.damage_model[m]:
            return fields.CARRIED_DAMAGE
        return fields.CARRIED_SOLID if self.table.strength_model[m] else fields.CARRIED_FLUID

    # ------------------------------------------------------------------------------------------------ the page

    def advance(self) -> None:
        """One step: time n to n + 1."""
        self.activate()
        self.ghost_vertices()
        self.find_slip_zones()
        self.mesh.follow()
        self.close_cells()
        self.choose_step()

        self.stress()
        self.accelerate()
        self.sweep_faces()
        self.deform()
        self.mesh.leave(self.box, self.carried, self.dt)

        directions = ((0, 1), (1, 0)) if self.number % 2 == 0 else ((1, 0), (0, 1))
        for second, (dj, di) in enumerate(directions):
            self.interface_fluxes(dj, di, second)
            self.remap_bodies(dj, di, second)
            self.remap_momentum(dj, di)
            self.tidy(dj, di, second)

        self.mesh.move(self.dt)
        self.time += self.dt
        self.number += 1

    # ------------------------------------------------------------------------------------------------ preparation

    def prepare(self) -> None:
        """Everything that follows from vof, q, u, v: masses, ranges, the active box. Called once, and after a restart."""
        s = self.state
        every = self.box
        self.box = list(self.mesh_box)
        self.mesh.announce()
        self._find_ranges(anew=True)
        s.cell_mass[...], s.mass[...] = 0.0, 0.0
        j0, j1, _, _ = self.box
        remap.sum_cell_mass(j0, j1, s.group_ranges, s.group, self.grid.volume, s.vof, s.q, s.cell_mass)
        self._vertex_mass()
        self._keep_one()
        if self.audit is None:
            self.box = self._first_box() if self._skips_cells else list(self.mesh_box)
            self.audit = Audit.open(s)
            sound = float(self.table.sound_speeds(thermodynamics.SOUND_FLOOR).min())
            fastest = float(np.sqrt(np.max(s.u**2 + s.v**2)))
            self.speed_limit = SPEED_LIMIT_FACTOR * max(fastest, sound)
        else:
            self.box = every
        if self.box != list(self.mesh_box):  # beyond the box nothing has a range yet
            s.empty_ranges()
            self._find_ranges(anew=True)
        self._list_mixed()

    @property
    def _skips_cells(self) -> bool:
        """Whether quiet cells may be skipped: not where the mesh travels, and every cell hands on what it holds."""
        return self.method.active_region and self.mesh.leading is None

    def _first_box(self) -> list[int]:
        """Smallest box around everything that moves or is under pressure or stress, and the margin."""
        s, t = self.state, self.table
        from eos.dispatch import evaluate

        loud = np.zeros(self.grid.shape, dtype=bool)
        for m in range(s.bodies):
            present = s.vof[m] > 0
            quiet_p = evaluate(t.eos_model[m], t.rho0[m], 0.0, t.eos_par[m])[0] == 0.0
            at_rest = (s.rho[m] == t.rho0[m]) & (s.e[m] == 0.0) & (s.q[2:5, m] == 0.0).all(axis=0)
            loud |= present & ~(at_rest & quiet_p)
        moving = ((s.u != 0) | (s.v != 0)).any(axis=0)
        loud |= moving[:-1, :-1] | moving[1:, :-1] | moving[:-1, 1:] | moving[1:, 1:]
        j0, j1, i0, i1 = self.mesh_box
        rows, columns = np.nonzero(loud[j0:j1, i0:i1])
        if len(rows) == 0:
            return list(self.mesh_box)
        return self._clipped([rows.min() + j0, rows.max() + j0 + 1, columns.min() + i0, columns.max() + i0 + 1], MARGIN)

    def _clipped(self, box, margin) -> list[int]:
        j0, j1, i0, i1 = self.mesh_box
        return [int(max(box[0] - margin, j0)), int(min(box[1] + margin, j1)), int(max(box[2] - margin, i0)),
                int(min(box[3] + margin, i1))]

    def activate(self) -> None:
        """Lets the active box grow ahead of whatever moves (explanation/active-region)."""
        if self.box == list(self.mesh_box):
            return
        s, (j0, j1, i0, i1) = self.state, self.box
        column_ranges.moving_columns(j0, j1 + 1, i0, i1 + 1, s.u, s.v, s.row_moving)
        column_ranges.moving_box(j0, j1 + 1, s.row_moving, s.moving)
        first, last, low, high = s.moving
        if first == last:
            return
        grown = self._clipped([first - 1, last, low - 1, high], MARGIN)
        box = [min(j0, grown[0]), max(j1, grown[1]), min(i0, grown[2]), max(i1, grown[3])]
        if box != self.box:
            self.box = box
            self._find_ranges(anew=True)
            self._list_mixed()

    def _find_ranges(self, anew: bool) -> None:
        s, box = self.state, self.box
        column_ranges.find_body_ranges(*box, anew, s.group, s.vof, s.body_ranges, s.occupied)
        column_ranges.find_active_ranges(*box, s.occupied, s.group_ranges)
        column_ranges.widen_ranges(box[0], box[1], s.body_ranges, s.group_ranges)

    def _list_mixed(self) -> None:
        s, (j0, j1, _, _) = self.state, self.box
        column_ranges.list_mixed(j0, j1, s.active_range, s.vof, s.mixed_count, s.mixed, s.scratch)

    def _vertex_mass(self) -> None:
        s, g, (j0, j1, i0, i1) = self.state, self.grid, self.box
        acceleration.vertex_masses(j0, j1 + 1, i0, i1 + 1, g.metrics, s.group_ranges, s.cell_mass, s.mass)

    def _keep_one(self) -> None:
        if self.contact:
            self.contact.keep_one(self.box)

    def ghost_vertices(self) -> None:
        """Mirrors or copies velocities beyond the edges of the mesh."""
        s, g, (low_r, high_r, low_z, high_z) = self.state, self.grid, self.method.boundaries.having("mirrors")
        j0, j1, i0, i1 = self.box
        boundaries.ghost_vertices_r(j0, j1 + 1, g.nr, low_r, high_r, s.u, s.v)
        boundaries.ghost_vertices_z(i0 - 2, i1 + 3, g.nz, low_z, high_z, s.u, s.v)

    def _constrain(self) -> None:
        """The given normal velocity of constrained nodes: axis, walls, edges with a velocity; impulse and work are audited."""
        s = self.state
        for edge, (at, velocity) in enumerate(zip(self.constrained, self.method.boundaries.velocity, strict=True)):
            if at < 0:
                continue
            along_r = edge < 2
            normal = s.u[..., at] if along_r else s.v[:, at]
            if velocity or not along_r:  # the axis and walls along z take no axial momentum and do no work
                before, mass = (s.u0[..., at], s.mass[..., at]) if along_r else (s.v0[:, at], s.mass[:, at])
                impulse = mass * (normal - velocity)
                work = float(np.sum(0.5 * impulse * (before + velocity))) if velocity else 0.0
                self.audit.add("walls", momentum=0.0 if along_r else float(np.sum(impulse)), energy=work)
            normal[...] = velocity

    def _transmit(self) -> None:
        """What an endless plate would hold the transmitting edges with; what it takes goes into the audit."""
        s, g, taken = self.state, self.grid, np.zeros(2)
        for along_r in (True, False):
            j0, j1, i0, i1 = self.box
            first, last = (j0, j1 + 1) if along_r else (i0, i1 + 1)
            crossing = self.transmitting[2:] if along_r else self.transmitting[:2]
            for at, _ in self._open_faces(along_r, "transmits"):
                boundaries.transmit(along_r, at, first, last, crossing, self.constrained, self.dt, g.metrics, g.dz, s.rhobar,
                                    s.cl, s.bulk, s.mass, s.u0, s.v0, s.u, s.v, taken)
        if taken.any():
            self.audit.add("transmitted", momentum=float(taken[0]), energy=float(taken[1]))

    # ------------------------------------------------------------------------------------------------ Lagrangian step

    def find_slip_zones(self) -> None:
        """Distance to the hard bodies and the zones beside them, every few cycles."""
        s, g, method = self.state, self.grid, self.method
        if method.slip_widths is None or self.number % method.refresh:
            return
        sliding.slip_zones(*self.box, *method.slip_widths, method.threshold, g.rc, g.zc, g.dr, g.dz, method.hard, s.vof, s.hard,
                           s.distance, s.zone, s.normal)

    def close_cells(self) -> None:
        """Pressure and sound speed of every body, void where a cell fractures, artificial viscosity, the step a cell allows."""
        s, g, method, (j0, j1, _, _) = self.state, self.grid, self.method, self.box
        cut_cells.find_surfaces(*self.box, self.mesh_box, g.dr, g.dz, s.group, method.hard, method.threshold, s.mixed_count,
                                s.mixed, s.vof, s.skin)
        mixed.close_cells(
            j0, j1, method.max_opening, method.smallest_tension, method.viscosity_linear, method.viscosity_quadratic,
            method.courant, method.advective_courant, self.mesh.velocity, method.hourglass, g.metrics, g.dr, g.dz, s.body_range,
            s.active_range, s.mixed_count, s.mixed, self.models, self.materials, s.u, s.v, s.vof, s.q, s.pm, s.km, s.tm, s.skin,
            s.p, s.bulk, s.rhobar, s.solid, s.cl, s.qr, s.qz, s.hg_coefficient, s.opened, s.row_step, s.bad, s.scratch)
        if self.contact:
            self.contact.find(self.box)
        thermodynamics.least_step(j0, j1, s.row_step, s.bad, s.least_row)
        if s.least_row[1] >= 0:
            self._report_bad(s.least_row[1])
        if s.least_row[2] >= 0:
            raise UnphysicalState(f"cycle {self.number}, time {self.time:.6g} s: velocities that are not finite near "
                                  f"z = {g.zc[s.least_row[2]]:.6g} m")

    def _report_bad(self, j: int) -> None:
        s, g = self.state, self.grid
        i, m = int(s.bad[j, 1]), int(s.bad[j, 2])
        raise UnphysicalState(
            f"cycle {self.number}, time {self.time:.6g} s, cell (r, z) = ({g.rc[i]:.6g}, {g.zc[j]:.6g}) m, body "
            f'"{self.table.names[m]}": volume fraction {s.vof[m, j, i]:.6g}, density {s.rho[m, j, i]:.6g} kg/m^3, energy '
            f"{s.e[m, j, i]:.6g} J/kg, pressure {s.pm[m, j, i]:.6g} Pa ({int(s.bad[j, 0])} such cells in its row)")

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
        if not method.dt_min < dt < 1e300:
            m = int(np.argmax(s.vof[:, j, i]))
            raise UnphysicalState(f"cycle {self.number}, time {self.time:.6g} s: time step {dt:.3g} s, below dt_min = "
                                  f'{method.dt_min:.3g} s, set by {self.cause}, in body "{self.table.names[m]}"')
        self.dt = dt

    def stress(self) -> None:
        """Total stress of every cell at half the step."""
        s, g, method, (j0, j1, _, _) = self.state, self.grid, self.method, self.box
        acceleration.total_stress(
            j0, j1, self.dt, g.metrics, g.dz, s.body_range, s.active_range, s.mixed_count, s.mixed,
            method.by_what_is_solid, method.hard, method.threshold, s.u, s.v, s.vof, s.q, s.skin, s.p, s.bulk,
            s.solid, s.qr, s.qz, s.ph, s.sig_rr, s.sig_zz, s.sig_tt, s.sig_rz)
        if self.contact:
            self.contact.stress(j0, j1, self.dt)

    def accelerate(self) -> None:
        """Velocities at the end of the step."""
        s, g, (j0, j1, i0, i1) = self.state, self.grid, self.box
        s.swap_velocities()
        limited = s.limited
        acceleration.accelerate(
            j0, j1 + 1, i0, i1 + 1, self.dt, self.speed_limit, self.underfilled_density, g.metrics, g.dz, s.occupied, s.mass,
            s.hg_coefficient, s.sig_rr, s.sig_zz, s.sig_tt, s.sig_rz, s.u0, s.v0, s.u, s.v, limited)
        if limited[2, j0:j1 + 1].any():
            self.audit.add("speed_limit", momentum=float(limited[0, j0:j1 + 1].sum()),
                           energy=float(limited[1, j0:j1 + 1].sum()))
        if self.contact:
            self.contact.meet(j0, j1, self.dt, self.audit)
        self._transmit()
        self._constrain()
        self._keep_one()
        self.ghost_vertices()

    def sweep_faces(self) -> None:
        """Volumes that the faces sweep in the step; they are the change of volume, and later the remap's fluxes."""
        s, g, (j0, j1, i0, i1) = self.state, self.grid, self.box
        acceleration.swept_volumes(j0, j1 + 1, i0, i1, self.dt, g.metrics, g.dz, s.group_ranges, s.u0, s.v0, s.u, s.v, s.fr,
                                   s.fz)
        if self.contact:
            self.contact.volumes(j0, j1, self.dt)

    def deform(self) -> None:
        """Work, volume, strain: body by body in pure cells, then the mixed cells; no shear in the slip layer."""
        s, g, method, (j0, j1, _, _) = self.state, self.grid, self.method, self.box
        deformation.deform(
            j0, j1, self.dt, g.metrics, g.dz, s.body_range, s.group, self.models, self.materials, s.u0, s.v0, s.u, s.v, s.fr,
            s.fz, s.sig_rr, s.sig_zz, s.sig_tt, s.sig_rz, s.hg_coefficient, s.vof, s.pm, s.tm, s.scratch, s.q, s.internal,
            s.lanes)
        mixed.deform_mixed(
            j0, j1, self.dt, method.relaxation, method.tipton, method.mixed_strength, method.hard, method.threshold, g.metrics,
            g.dz, s.mixed_count, s.mixed, s.group, s.contact_columns, s.cell_mass, self.models, self.materials, s.u0, s.v0, s.u,
            s.v, s.fr, s.fz, s.ph, s.qr, s.qz, s.hg_coefficient, s.skin, s.p, s.bulk, s.solid, s.pm, s.km, s.tm, s.vof, s.q,
            s.mix, s.motion, s.internal)
        if self.contact:
            self.contact.warm(j0, j1)
        if method.slip_widths is not None:
            sliding.cut_shear(j0, j1, method.shear, method.friction, s.occupied[0], s.zone, s.normal, method.hard, s.vof, s.pm,
                              s.q)

    # ------------------------------------------------------------------------------------------------ remap

    def interface_fluxes(self, dj: int, di: int, second: int) -> None:
        """Volume of every body through every face of one direction."""
        s, g, box = self.state, self.grid, self.box
        j0, j1, i0, i1 = box
        low_r, high_r, low_z, high_z = self.method.boundaries.having("mirrors")
        along_r, along_z = di * len(s.q), dj * len(s.q)  # the other direction's interfaces need fractions
        boundaries.ghost_columns(j0, j1, g.nr, low_r, high_r, along_r, s.rules, s.body_range, s.vof, s.q)
        boundaries.ghost_rows(i0 - 2, i1 + 2, g.nz, low_z, high_z, along_z, s.rules, s.vof, s.q)
        self.mesh.fill_ghosts(self.dt)
        if not second:  # cells may have been filled by the Lagrangian step
            self._list_mixed()
        face = s.fr if di else s.fz
        interfaces.donor_volumes(dj, di, *box, second == 0, self.void_only, g.volume, s.body_ranges, s.active_range, s.fr, s.fz,
                                 s.vof, s.pre, s.flux_volume)
        interfaces.interface_volumes(dj, di, j0, j1, g.dr, g.dz, self.method.interface_order, s.mixed_count, s.mixed, face,
                                     s.pre, s.vof, s.flux_volume, s.strips)
        if self.contact:
            self.contact.fluxes(dj, di, j0, j1)

    def remap_bodies(self, dj: int, di: int, second: int) -> None:
        """Fluxes and update of every body's fields; the cells' masses, and which of them are mixed."""
        s, g, box = self.state, self.grid, self.box
        if dj:
            remap.block_edge_fluxes(*box, self.carried, s.rules, s.body_ranges, s.pre, s.flux_volume, s.vof, s.q, s.scratch,
                                    s.flux)
        sweep = remap.sweep_r if di else remap.sweep_z
        sweep(*box, self.carried, s.rules, s.group, self.mesh_box, s.body_ranges, s.group_ranges, s.fr if di else s.fz, s.pre,
              g.volume, bool(second), s.flux_volume, s.scratch, s.flux, s.flux_mass, s.edge_flux, s.vof, s.q, s.cell_mass,
              s.mixed_count, s.mixed)
        self._audit_outflow(di)

    def _open_faces(self, di: int, flag: str = "opens"):
        """(index of the face, outward sign) of the edges of a direction that have a flag of the table of boundary conditions,
        where the active box has reached them."""
        having = self.method.boundaries.having(flag)
        low, high = having[0:2] if di else having[2:4]
        box, ends = (self.box[2:4], self.mesh_box[2:4]) if di else (self.box[0:2], self.mesh_box[0:2])
        if low and box[0] == ends[0]:
            yield int(ends[0]), -1.0
        if high and box[1] == ends[1]:
            yield int(ends[1]), 1.0

    def _audit_outflow(self, di: int) -> None:
        s, (j0, j1, i0, i1) = self.state, self.box
        for _, sign in self._open_faces(di):
            side, along = int(sign > 0), slice(j0, j1) if di else slice(i0, i1)
            for name, (mass, energy) in self._out_and_in(sign, s.edge_flux[side, ..., along]):
                self.audit.add(name, mass=mass, energy=float(energy.sum()))

    @staticmethod
    def _out_and_in(sign: float, flow: np.ndarray):
        """(name of the sink, sum over the edge) for what goes out through an edge and for what comes in, if anything does.

        flow : [k, ..., i] towards higher r or z, the first k the mass, which says which of the two it is; sign : of outward
        """
        ends = sign * flow[0].min(axis=-1).min(), sign * flow[0].max(axis=-1).max()  # all at once would copy the rows
        both = min(ends) < 0.0 < max(ends)
        for name, way, there in (("outflow", 1.0, max(ends) > 0.0), ("inflow", -1.0, min(ends) < 0.0)):
            if there:
                part = np.where(way * sign * flow[0] > 0.0, flow, 0.0) if both else flow
                yield name, sign * part.sum(axis=-1)

    def remap_momentum(self, dj: int, di: int) -> None:
        """Velocities after the sweep, by the advection choice; what it discards goes into the audit."""
        s, g, method = self.state, self.grid, self.method
        flow = s.flux_mass
        j0, j1, i0, i1 = self.mesh_box
        if di:  # the sweep along the other direction has left its fluxes beyond the mesh, where nothing flows along this one
            flow[:, [j0 - 1, j1]] = 0.0
        else:
            flow[:, :, [i0 - 1, i1]] = 0.0
        for face, sign in self._open_faces(di):  # beyond an open edge the flux goes on as it was
            beyond = face + int(sign)
            for of_group in flow:
                if di:
                    of_group[:, beyond] = of_group[:, face]
                else:
                    of_group[beyond] = of_group[face]
        s.swap_velocities()
        sums = s.momentum_sums
        momentum.sweep_momentum(
            dj, di, *self.box, method.advection, method.ke_bound, self.constrained, method.boundaries.velocity, self.mesh_box,
            g.metrics, s.group_ranges, s.cell_mass, flow, s.mass, s.velocity0, s.velocity, s.dual, s.edge_dual, s.deficit, sums)
        j0, j1, _, _ = self.box
        before, after, p_gained, k_cut, p_wall = sums[:, j0:j1 + 1].sum(axis=1)
        lost = before - after - self._kinetic_outflow(di)
        if method.advection == momentum.BOTH:
            momentum.deposit(j0, j1, g.metrics, s.active_range, s.group, s.deficit, s.cell_mass, s.vof, s.q, s.deposited)
            lost -= s.deposited[j0:j1].sum()
        self.audit.add("advection", momentum=-float(p_gained), energy=float(lost - k_cut))
        self.audit.add("ke_bound", energy=float(k_cut))
        self.audit.add("walls", momentum=float(p_wall))
        self.ghost_vertices()

    def _kinetic_outflow(self, di: int) -> float:
        """Audits the momentum that went through open edges and returns the kinetic energy that left with it."""
        s, (j0, j1, i0, i1) = self.state, self.box
        total = 0.0
        for _, sign in self._open_faces(di):
            flow = s.edge_dual[:, int(sign > 0), :, j0:j1 + 1] if di else s.edge_dual[:, int(sign > 0), :, i0:i1 + 1]
            for name, part in self._out_and_in(sign, flow.swapaxes(0, 1)):
                _, _, axial, *kinetic = part.sum(axis=-1)
                energy = float(sum(kinetic))
                if energy != 0.0:
                    self.audit.add(name, momentum=float(axial), energy=energy)
                total += energy
        return total

    def tidy(self, dj: int, di: int, second: int) -> None:
        """Removes sub-cutoff volume fractions, makes full cells full, and finds the bodies anew."""
        s, g, (j0, j1, _, _) = self.state, self.grid, self.box
        remap.tidy(j0, j1, self.method.cutoff, g.metrics, g.volume, s.group, s.mixed_count, s.mixed, s.pre, dj, di, s.fr, s.fz,
                   bool(second), s.u, s.v, s.vof, s.q, s.cell_mass, s.removed)
        internal, kinetic, axial, _, *mass = s.removed[:, j0:j1].sum(axis=1)
        self.audit.add("cutoff", mass=np.array(mass), momentum=float(axial), energy=float(internal + kinetic))
        self._vertex_mass()  # by the ranges before: where nothing is left there is no mass either
        self._find_ranges(anew=False)
        self._keep_one()
