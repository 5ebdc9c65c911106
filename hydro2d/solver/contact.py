"""Contact within a step: what `Cycle` does beside its own kernels where two body groups meet (explanation/sliding)."""

from __future__ import annotations

import numpy as np

from hydro2d.kernels import contact, contact_motion, contact_velocities, contact_volumes, mixed, momentum
from hydro2d.solver.audit import Ledger
from hydro2d.solver.method import Method


class Contact:
    """Two groups of bodies of a state that touch, press and slide.

    Every method takes the rows j0 to j1 (past the end) that are active.

    Parameters
    ----------
    state : State, with two groups
    method : Method
    edges, still : int64 arrays [4]
        The cells of the mesh, and the vertices that walls and the axis hold, as `Cycle` has them.
    """

    def __init__(self, state, method: Method, edges: np.ndarray, still: np.ndarray):
        self.state, self.grid, self.method, self.edges, self.still = state, state.grid, method, edges, still
        order = method.interface_order
        own = state.group[order]
        self.soft_first, self.hard_first = (
            np.array([*order[own == b], *order[own != b]], dtype=np.int64) for b in range(2))

    def find(self, j0: int, j1: int) -> None:
        """Where the groups meet: weights of faces, normals, light vertices; volume rate and viscosity of the cut cells."""
        s, g, method = self.state, self.grid, self.method
        contact.find_shared(j0, j1, self.edges, s.around, s.mass, s.group, s.vof, s.shared_count, s.shared, s.hard, s.soft,
                            s.heat, s.warmed)
        contact.cut_lines(j0, j1, self.edges, g.dr, g.dz, s.shared_count, s.shared, s.hard, s.soft, s.cut, s.line)
        contact.face_weights(j0, j1, self.edges, self.still, s.cut, s.line, s.hard, s.soft, s.mass, s.shared_count, s.shared,
                             s.wet_r, s.wet_z, s.contact_normal, s.touch)
        contact.link_light(j0, j1, self.edges, g.volume, g.metrics, s.shared_count, s.shared, s.contact_normal, s.hard, s.soft,
                           s.mass, s.group, s.vof, s.dmg, s.link)
        contact_motion.cut_viscosity(
            j0, j1, self.edges, method.viscosity_linear, method.viscosity_quadratic, method.courant, g.dr, g.dz, g.metrics,
            s.cut, s.line, s.around, s.contact_normal, s.wet_r, s.wet_z, s.hard, s.soft, s.u, s.v, s.cl, s.rhobar, s.vof, s.q,
            s.pm, s.km, s.p, s.solid, s.bulk, s.qr, s.qz, s.rate, s.row_step, s.mixed_count, s.mixed, s.kinds)

    def stress(self, j0: int, j1: int, dt: float) -> None:
        """Total stress of the cut cells, and the pressure of the contact."""
        s = self.state
        contact_motion.cut_stress(j0, j1, dt, s.cut, s.around, s.line, s.hard, s.soft, s.rate, s.p, s.bulk, s.ph, s.sig_rr,
                                  s.sig_zz, s.sig_tt, s.sig_rz, s.contact_pressure)

    def meet(self, j0: int, j1: int, dt: float, ledger: Ledger) -> None:
        """Velocities of both groups where they share vertices: forces, light vertices, contact and friction."""
        s, g, method = self.state, self.grid, self.method
        contact_motion.shared_forces(
            j0, j1, dt, s.group, method.mixed_strength == mixed.SOLID, g.metrics, g.dz, self.still, s.shared_count, s.shared,
            s.wet_r, s.wet_z, s.ph, s.qr, s.solid, s.vof, s.q, s.weight, s.cell_mass, s.mass, s.u0, s.v0, s.u, s.v, s.exchange)
        contact_velocities.settle(
            j0, j1, dt, method.friction, self.still, g.r, g.z, g.metrics, g.dz, s.cut, s.line, s.shared_count, s.shared,
            s.contact_normal, s.touch, s.link, s.sig_rr, s.sig_zz, s.sig_rz, s.mass, s.u0, s.v0, s.u, s.v, s.light_weights,
            s.ease, s.taken, s.impulse, s.heat, s.exchange)
        pushed, *heats, walls = s.exchange[:, j0:j1 + 1].sum(axis=1)
        ledger.book("walls", momentum=float(walls))
        ledger.exchange("contact", momentum=float(pushed), energy=float(heats[0]))
        ledger.exchange("friction", energy=float(heats[1]))
        ledger.exchange("light vertices", energy=float(heats[2]))

    def keep_one(self, box: list[int]) -> None:
        """One velocity where one group is alone."""
        s = self.state
        contact_motion.keep_one(*box, s.around, s.mass, s.u, s.v)

    def volumes(self, j0: int, j1: int, dt: float) -> None:
        """Volumes that the faces of cut cells sweep, and each group's own; the work that they do in pure cells."""
        s, g = self.state, self.grid
        contact_volumes.cut_volumes(j0, j1, dt, g.metrics, g.dz, s.cut, s.wet_r, s.wet_z, s.u0, s.v0, s.u, s.v, s.fr, s.fz,
                                    s.own_r, s.own_z)
        contact_volumes.cut_work(j0, j1, dt, g.metrics, g.dz, s.cut, s.group, s.wet_r, s.wet_z, s.ph, s.qr, s.u0, s.v0, s.u,
                                 s.v, s.fr, s.fz, s.cell_mass, s.vof, s.q)

    def warm(self, j0: int, j1: int) -> None:
        """Gives the heat of the impulses to the bodies around their vertices."""
        s, g = self.state, self.grid
        momentum.deposit(j0, j1, g.metrics, s.warmed, s.group, s.heat, s.cell_mass, s.vof, s.q, s.deposited)

    def fluxes(self, dj: int, di: int, j0: int, j1: int) -> None:
        """Volume of every body through the faces of cut cells, in one direction."""
        s, g = self.state, self.grid
        face, own = (s.fr, s.own_r) if di else (s.fz, s.own_z)
        contact_volumes.cut_shares(j0, j1, self.edges, s.cut, g.volume, s.pre, s.vof, s.part, s.size)
        contact_volumes.cut_fluxes(dj, di, j0, j1, self.edges, g.dr, g.dz, self.hard_first, self.soft_first, s.group, s.cut,
                                   s.line, face, own, s.part, s.size, s.vof, s.flux_volume)
        contact_volumes.limit_fluxes(dj, di, j0, j1, self.edges, s.cut, s.pre, s.vof, s.flux_volume)
