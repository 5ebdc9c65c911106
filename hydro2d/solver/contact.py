"""Contact within a step: what `Cycle` does beside its own kernels where two body groups meet (explanation/sliding)."""

from __future__ import annotations

import numpy as np

from hydro2d.kernels import (
    contact_checkerboard,
    contact_geometry,
    contact_motion,
    contact_velocities,
    contact_volumes,
    extension,
    momentum,
)
from hydro2d.solver.audit import Audit
from hydro2d.solver.method import Method


class Slots:
    """What contact keeps of every contact node, in slots: the nodes of row j have those from first_slot[j] on.

    The arrays grow with the number of nodes, and nothing in them outlives a step.
    """

    def __init__(self, number: int = 0):
        self.number = number
        self.strength = np.zeros((number, 2))
        self.masters = np.zeros((number, 2), dtype=np.int64)
        self.where = np.zeros((number, 2, extension.MASTERS + 1), dtype=np.int64)
        self.weights = np.zeros((number, 2, extension.MASTERS + 1))
        most = 2 * number * (extension.MASTERS + 1)
        self.nodes = np.zeros((6, 2 * number), dtype=np.int64)
        self.starts = np.zeros(2 * number + 1, dtype=np.int64)
        self.entries = np.zeros((4, most), dtype=np.int64)
        self.parts = np.zeros((most, 4))
        self.impulses = np.zeros((10, number, 2))
        self.gain = np.zeros((most + 2 * number, 2))
        self.taken = np.zeros((2, number, 2))
        self.rubbing = np.zeros((3, number))

    def ties(self) -> tuple[np.ndarray, ...]:
        """How firmly nodes are tied, to how many masters, to which and with what weights (`find_extensions`)."""
        return self.strength, self.masters, self.where, self.weights

    def scratch(self, places: np.ndarray) -> tuple[np.ndarray, ...]:
        """What `settle` needs to solve for the impulses of the ties; places [b, j, i] is 0."""
        return self.nodes, self.starts, self.entries, self.parts, places, self.impulses, self.gain


def most_squares(table, courant: float) -> float:
    """Largest sum of the squares of an extension's weights that the time step allows (explanation/sliding, equation 7).

    A cell with the modulus K of the stiffest body that pushes a slave whose masters have the density rho of the lightest
    swings with omega^2 = (K/rho) sum N^2/h^2; omega dt <= 2 with dt = courant h/c of the fastest.
    """
    speeds = table.sound_speeds()
    return max(4.0 * table.rho0.min() * speeds.max() ** 2 / ((table.rho0 * speeds**2).max() * courant**2), 1.0)


class Contact:
    """Two groups of bodies of a state that touch, press and slide.

    Most methods take the rows j0 to j1 (past the end) that are active.

    Parameters
    ----------
    state : State, with two groups
    method : Method
    mesh_box, constrained : int64 arrays [4]
        The cells of the mesh, and the vertices that walls and the axis hold, as `Cycle` has them.
    table : MaterialTable
    """

    def __init__(self, state, method: Method, mesh_box: np.ndarray, constrained: np.ndarray, table):
        self.state, self.grid, self.method, self.mesh_box, self.constrained = state, state.grid, method, mesh_box, constrained
        self.most_squares, self.slots = most_squares(table, method.courant), Slots()
        order = method.interface_order
        own = state.group[order]
        self.soft_first, self.hard_first = (
            np.array([*order[own == b], *order[own != b]], dtype=np.int64) for b in range(2))

    def _number_nodes(self, j0: int, j1: int) -> None:
        """The slot of every row's first contact node."""
        s = self.state
        np.cumsum(s.contact_node_count[j0:j1 + 1], out=s.first_slot[j0 + 1:j1 + 2])
        s.first_slot[j0] = 0
        if (needed := int(s.first_slot[j1 + 1])) > self.slots.number:
            self.slots = Slots(2 * needed)

    def find(self, box: list[int]) -> None:
        """Where the groups meet: face apertures, normals, slave nodes; volume rate and viscosity of contact-interface cells.

        box : [j0, j1, i0, i1] of the active cells; beyond them bodies that touch have no pressure to exchange yet
        """
        s, g, method, (j0, j1, i0, i1) = self.state, self.grid, self.method, box
        contact_geometry.find_contact_nodes(j0, j1, self.mesh_box, s.group_ranges, s.mass, s.group, s.vof, s.contact_node_count,
                                            s.contact_nodes, s.hard, s.soft, s.heat, s.warmed)
        self._number_nodes(j0, j1)
        contact_geometry.contact_lines(j0, j1, i0, i1, self.mesh_box, g.dr, g.dz, s.contact_node_count, s.contact_nodes,
                                       s.hard, s.soft, s.contact_columns, s.line)
        contact_geometry.face_apertures(j0, j1, self.mesh_box, self.constrained, s.contact_columns, s.line, s.hard, s.soft,
                                        s.mass, s.contact_node_count, s.contact_nodes, s.aperture_r, s.aperture_z,
                                        s.contact_normal, s.touch)
        extension.find_filled(j0, j1, self.mesh_box, g.volume, g.metrics, s.contact_node_count, s.contact_nodes, s.hard,
                              s.soft, s.mass, s.filled)
        extension.find_extensions(j0, j1, self.mesh_box, self.most_squares, g.r, g.z, s.contact_node_count, s.contact_nodes,
                                  s.first_slot, s.contact_normal, s.hard, s.soft, s.filled, s.group, s.vof, s.dmg,
                                  *self.slots.ties())
        contact_motion.contact_viscosity(
            j0, j1, self.mesh_box, method.viscosity_linear, method.viscosity_quadratic, method.courant, g.dr, g.dz, g.metrics,
            s.contact_columns, s.line, s.group_ranges, s.contact_normal, s.aperture_r, s.aperture_z, s.hard, s.soft, s.u, s.v,
            s.cl, s.rhobar, s.vof, s.q, s.km, s.skin, s.p, s.solid, s.bulk, s.qr, s.qz, s.rate, s.row_step, s.mixed_count,
            s.mixed, s.kinds)

    def stress(self, j0: int, j1: int, dt: float) -> None:
        """Total stress of the contact-interface cells, and the pressure of the contact."""
        s = self.state
        contact_motion.contact_stress(j0, j1, dt, s.contact_columns, s.group_ranges, s.line, s.hard, s.soft, s.rate, s.skin,
                                      s.p, s.bulk, s.solid, s.ph, s.sig_rr, s.sig_zz, s.sig_tt, s.sig_rz, s.contact_pressure)

    def meet(self, j0: int, j1: int, dt: float, audit: Audit) -> None:
        """Velocities of both groups at contact nodes: forces, slave nodes, contact and friction."""
        s, g, method = self.state, self.grid, self.method
        contact_motion.contact_node_forces(
            j0, j1, dt, s.group, method.by_what_is_solid, g.metrics, g.dz, self.constrained, s.contact_node_count,
            s.contact_nodes, s.aperture_r, s.aperture_z, s.ph, s.qr, s.solid, s.skin, s.vof, s.q, s.hg_coefficient, s.cell_mass,
            s.mass, s.u0, s.v0, s.u, s.v, s.transfer)
        slots = self.slots
        contact_velocities.settle(
            j0, j1, dt, method.friction, self.constrained, g.metrics, g.dz, s.contact_columns, s.line, s.contact_node_count,
            s.contact_nodes, s.first_slot, s.contact_normal, s.touch, *slots.ties(), s.sig_rr, s.sig_zz, s.sig_rz,
            s.mass, s.u0, s.v0, s.u, s.v, *slots.scratch(s.places), slots.taken, slots.rubbing, s.heat, s.transfer)
        pushed, *heats, walls = s.transfer[:, j0:j1 + 1].sum(axis=1)
        audit.add("walls", momentum=float(walls))
        audit.transfer("contact", momentum=float(pushed), energy=float(heats[0]))
        audit.transfer("friction", energy=float(heats[1]))
        audit.transfer("under-filled nodes", energy=float(heats[2]))

    def keep_one(self, box: list[int]) -> None:
        """One velocity where one group is alone."""
        s = self.state
        contact_motion.keep_one(*box, s.group_ranges, s.mass, s.u, s.v)

    def volumes(self, j0: int, j1: int, dt: float) -> None:
        """Volumes that faces of contact-interface cells sweep, and each group's own; the work that they do in pure cells."""
        s, g = self.state, self.grid
        contact_volumes.even_out(j0, j1, s.contact_columns, g.volume, s.skin, s.bulk, s.ph, s.qr, s.even_r, s.even_z)
        contact_volumes.warm_evened(j0, j1, s.contact_columns, g.volume, s.ph, s.qr, s.even_r, s.even_z, s.vof, s.q)
        contact_volumes.contact_swept_volumes(j0, j1, dt, g.metrics, g.dz, s.contact_columns, s.aperture_r, s.aperture_z, s.u0,
                                              s.v0, s.u, s.v, s.even_r, s.even_z, s.fr, s.fz, s.own_r, s.own_z)
        contact_volumes.contact_work(j0, j1, dt, g.metrics, g.dz, s.contact_columns, s.group, s.aperture_r, s.aperture_z, s.ph,
                                     s.qr, s.u0, s.v0, s.u, s.v, s.fr, s.fz, s.cell_mass, s.vof, s.q)
        self._fade_checkerboards(j0, j1, dt)

    def _fade_checkerboards(self, j0: int, j1: int, dt: float) -> None:
        """What no vertex feels of the stress in the hard bodies."""
        s, g = self.state, self.grid
        _, _, i0, i1 = self.mesh_box
        contact_checkerboard.find_insides(j0, j1, i0, i1, s.group, s.group_ranges, s.vof, s.inside)
        contact_checkerboard.find_checkerboards(j0, j1, i0, i1, s.group, s.group_ranges, s.vof, s.q, s.pm, s.inside,
                                                s.checkerboard)
        contact_checkerboard.fade_deviators(j0, j1, dt, s.group, s.group_ranges, g.volume, s.hg_coefficient, s.cell_mass,
                                            s.inside, s.checkerboard, s.vof, s.km, s.q, s.room)
        contact_checkerboard.fade_pressures(j0, j1, i0, i1, s.group, s.group_ranges, s.contact_columns, s.cell_mass, s.room,
                                            s.vof, s.pm, s.fr, s.fz, s.own_r, s.own_z, s.q)

    def warm(self, j0: int, j1: int) -> None:
        """Gives the heat of the impulses to the bodies around their vertices."""
        s, g = self.state, self.grid
        momentum.deposit(j0, j1, g.metrics, s.warmed, s.group, s.heat, s.cell_mass, s.vof, s.q, s.deposited)

    def fluxes(self, dj: int, di: int, j0: int, j1: int) -> None:
        """Volume of every body through the faces of contact-interface cells, in one direction."""
        s, g = self.state, self.grid
        face, own = (s.fr, s.own_r) if di else (s.fz, s.own_z)
        contact_volumes.contact_shares(j0, j1, self.mesh_box, s.contact_columns, g.volume, s.pre, s.vof, s.part, s.size)
        contact_volumes.contact_fluxes(dj, di, j0, j1, self.mesh_box, g.dr, g.dz, self.hard_first, self.soft_first, s.group,
                                       s.contact_columns, s.line, face, own, s.part, s.size, s.vof, s.flux_volume)
        contact_volumes.limit_fluxes(dj, di, j0, j1, self.mesh_box, s.contact_columns, s.pre, s.vof, s.flux_volume)
