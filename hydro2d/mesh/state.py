"""The state of a run: the arrays of the field table and of the table of work. The only mutable object of the physics."""

from __future__ import annotations

import numpy as np

from hydro2d.mesh import fields
from hydro2d.mesh.grid import Grid

#: a range (low, high) that holds nothing, so that min and max of ranges need no special case
EMPTY = (1 << 30, 0)


class State:
    """Fields of ``bodies`` bodies on a mesh, and what the kernels of a cycle leave for one another.

    Its arrays are those of `fields.FIELDS` and `fields.WORK`, by their symbols; with two groups, of `fields.CONTACT_WORK` as
    well. Shapes: body fields [m, j, i], cell fields [j, i], vertex fields [b, j, i] with a leading index of body group b (one
    group unless contact is on); all with ghosts. ``velocity`` and ``velocity0`` hold u, v and u0, v0; ``span`` and ``reach``
    are the first of ``near`` and ``around``.

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
        self.rules = fields.remap_rules(internal or [()] * bodies)
        self.lengths = {"m": bodies, "b": groups, "j": nj, "i": ni, "J": nj + 1, "I": ni + 1, "k": self.rules.shape[1],
                        "n": self.rules.shape[1] - fields.INTERNAL, "B": nj // fields.BLOCK + 1, "L": max(nj, ni) + 1}
        self.vof, self.q = self._zeros("m j i"), self._zeros("k m j i")
        self.velocity, self.velocity0 = self._zeros("2 b J I"), self._zeros("2 b J I")
        self.u, self.v = self.velocity
        self.u0, self.v0 = self.velocity0
        for field, row in zip(fields.BODY, self.q, strict=False):
            setattr(self, field.symbol, row)
        for centring, axes in (("body", "m j i"), ("cell", "j i"), ("vertex", "b J I")):
            for field in fields.FIELDS:
                if field.centring == centring and not hasattr(self, field.symbol):
                    setattr(self, field.symbol, self._zeros(axes))
        for work in (*fields.WORK, *(fields.CONTACT_WORK if groups > 1 else ())):
            setattr(self, work.symbol, self._zeros(work.axes, work.kind))
        self.pre[...] = grid.volume  # ghosts keep it: a face beside them divides by it
        self.span, self.reach = self.near[0], self.around[0, 0]
        self.empty_spans()

    def _zeros(self, axes: str, kind: type = float) -> np.ndarray:
        """An array of zeros with axes as in `fields.Work`."""
        return np.zeros([sum(self._length(part) for part in axis.split("+")) for axis in axes.split()], dtype=kind)

    def _length(self, axis: str) -> int:
        number = axis.rstrip("mbjiJIknBL")
        return int(number or 1) * self.lengths.get(axis[len(number):], 1)

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
