"""The state of a run: one block of memory per centring, named views into it. The only mutable object of the physics."""

from __future__ import annotations

import numpy as np

from hydro2d.mesh import fields
from hydro2d.mesh.grid import Grid

#: a range (low, high) that holds nothing, so that min and max of ranges need no special case
EMPTY = (1 << 30, 0)


class State:
    """Fields of ``bodies`` bodies on a mesh, and the scratch that one cycle needs.

    Shapes: body fields [m, j, i], cell fields [j, i], vertex fields [b, j, i] with a leading index of body group b (one
    group unless contact is on); all with ghosts. Face volumes lie left of (``fr``) or below (``fz``) their cell.

    Parameters
    ----------
    grid : Grid
    bodies : int
    group : int64[m], optional
        Body group of every body, which is the velocity field that it moves with: 0, and 1 for the hard bodies of a contact.
    internal : sequence of a sequence of Field for every body, optional
        Internal variables of its strength model; none without.
    """

    def __init__(self, grid: Grid, bodies: int, group=None, internal=None):
        self.grid, self.bodies = grid, bodies
        self.group = np.zeros(bodies, dtype=np.int64) if group is None else np.asarray(group, dtype=np.int64)
        groups = self.groups = int(self.group.max()) + 1
        nj, ni = grid.shape
        self.vof = np.zeros((bodies, nj, ni))
        self.rules = fields.remap_rules(internal or [()] * bodies)
        self.q = np.zeros((self.rules.shape[1], bodies, nj, ni))
        for field, rows in zip(fields.BODY, self.q, strict=False):
            setattr(self, field.symbol, rows)
        self._derived = np.zeros((3, bodies, nj, ni))
        self.pm, self.km, self.tm = self._derived

        self._cells = np.zeros((17, nj, ni))
        (self.p, self.ph, self.bulk, self.rhobar, self.solid, self.cl, self.qr, self.qz, self.sig_rr, self.sig_zz, self.sig_tt,
         self.sig_rz, self.pre, self.hard, self.distance, self.weight, self.contact_pressure) = self._cells
        self.cell_mass = np.zeros((groups, nj, ni))
        self.pre[...] = grid.volume  # ghosts keep it: a face beside them divides by it

        self._vertices = np.zeros((5, groups, nj + 1, ni + 1))
        self.u, self.v, self.u0, self.v0, self.mass = self._vertices
        self.velocity, self.velocity0 = self._vertices[:2], self._vertices[2:4]

        self.fr = np.zeros((nj + 1, ni + 1))
        self.fz = np.zeros((nj + 1, ni + 1))
        self.flux_volume = np.zeros((bodies, nj + 1, ni + 1))
        self.flux_mass = np.zeros((groups, nj + 1, ni + 1))
        blocks = nj // fields.BLOCK + 1
        self.flux = np.zeros((self.q.shape[0], bodies, 6 * blocks, ni + 1))
        self.scratch = np.zeros((fields.SCRATCH, blocks, ni + 1))
        self.dual = np.zeros((6, 2 * blocks, ni + 1))
        longest = max(nj, ni) + 1
        self.edge_flux = np.zeros((2, 2, bodies, longest))
        self.edge_dual = np.zeros((groups, 2, 5, longest))
        self.deficit = np.zeros((groups, nj + 1, ni + 1))

        self.near = np.zeros((3, bodies, nj, 2), dtype=np.int64)
        self.around = np.zeros((groups, 4, nj, 2), dtype=np.int64)
        self.occupied = np.zeros((groups, nj, 2), dtype=np.int64)
        self.span, self.reach = self.near[0], self.around[0, 0]
        self.empty_spans()
        self.mixed_count = np.zeros(nj, dtype=np.int64)
        self.mixed = np.zeros((nj, ni), dtype=np.int64)

        self.motion = np.zeros((nj, groups, 10))
        self.cut = np.zeros((nj, 2), dtype=np.int64)
        if groups > 1:
            self._contact(nj, ni)

        self.zone = np.zeros((nj, ni), dtype=np.int8)
        self.normal = np.zeros((2, nj, ni))
        self.mix = np.zeros((nj, 8, bodies))
        self.internal = np.zeros((nj, self.q.shape[0] - fields.INTERNAL))
        self.rows = np.zeros((8, nj + 1))
        self.booked = np.zeros((4 + bodies, nj + 1))
        self.row_numbers = np.zeros((nj + 1, 4), dtype=np.int64)
        self.row_moving = np.zeros((nj + 1, 2), dtype=np.int64)
        self.found = np.zeros(4, dtype=np.int64)

    def _contact(self, nj: int, ni: int) -> None:
        """What the contact of two groups needs, see kernels/contact."""
        self.shared_count = np.zeros(nj + 1, dtype=np.int64)
        self.shared = np.zeros((nj + 1, ni + 1), dtype=np.int64)
        self.warmed = np.zeros((nj + 1, 2), dtype=np.int64)
        self.link = np.zeros((2, nj + 1, ni + 1), dtype=np.int8)
        self.soft, self.rate, self.size = np.zeros((3, nj, ni))
        self.part = np.zeros_like(self.vof)
        self.line = np.zeros((9, nj, ni))
        self.wet_r, self.wet_z, self.own_r, self.own_z, self.heat = np.zeros((5, 2, nj + 1, ni + 1))
        self.contact_normal = np.zeros((3, 2, nj + 1, ni + 1))
        self.touch = np.zeros((nj + 1, ni + 1))
        self.ease, self.taken = np.zeros((2, 2, 2, nj + 1, ni + 1))
        self.light_weights = np.zeros((4, 2, nj + 1, ni + 1))
        self.impulse = np.zeros((6, nj + 1, ni + 1))
        self.exchange = np.zeros((5, nj + 1))

    def empty_spans(self) -> None:
        """No body is in any row."""
        for ranges in (self.near, self.around, self.occupied):
            ranges[..., 0], ranges[..., 1] = EMPTY

    def swap_velocities(self) -> None:
        """Makes the velocities the old ones; what were the old ones is written next."""
        self.velocity, self.velocity0 = self.velocity0, self.velocity
        self.u, self.v = self.velocity
        self.u0, self.v0 = self.velocity0

    def restartable(self) -> dict[str, np.ndarray]:
        """The arrays from which every other one follows."""
        return {"vof": self.vof, "q": self.q, "u": self.u, "v": self.v, "zone": self.zone, "normal": self.normal}

    def nbytes(self) -> int:
        """Memory of all arrays, bytes."""
        return sum(array.nbytes for array in vars(self).values() if isinstance(array, np.ndarray) and array.base is None)
