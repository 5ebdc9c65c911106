"""The state of a run: the arrays of the field table and of the table of work. The only mutable object of the physics."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.jit import GATE, max_threads
from hydro2d.mesh import fields
from hydro2d.mesh.grid import Grid

#: an empty range (low, high), so that min and max of ranges need no special case
EMPTY = (1 << 30, 0)


def _lengths(nj: int, ni: int, bodies: int, groups: int, rows: int) -> dict[str, int]:
    """The lengths that the letters of `fields.Work.axes` stand for."""
    return {"m": bodies, "b": groups, "j": nj, "i": ni, "J": nj + 1, "I": ni + 1, "k": rows, "n": rows - fields.INTERNAL,
            "B": max_threads(), "L": max(nj, ni) + 1, "G": GATE}


def _shape(axes: str, lengths: dict[str, int]) -> list[int]:
    """The shape of an array with axes as in `fields.Work`."""
    def length(part: str) -> int:
        number = part.rstrip("mbjiJIknBLG")
        return int(number or 1) * lengths.get(part[len(number):], 1)

    return [sum(length(part) for part in axis.split("+")) for axis in axes.split()]


def _arrays(groups: int, remembers: bool) -> Iterator[tuple[str, str, type]]:
    """Symbol, axes and kind of every array with memory of its own; the other fields are views of q and the velocities."""
    yield from (("q", "k m j i", float), ("centroid", "2 m j i", float), ("velocity", "2 b J I", float),
                ("velocity0", "2 b J I", float))
    views = {"u", "v", "u0", "v0", "centroid_r", "centroid_z", *(field.symbol for field in fields.BODY)}
    axes = {"body": "m j i", "cell": "j i", "vertex": "b J I"}
    yield from ((field.symbol, axes[field.centring], float) for field in fields.FIELDS if field.symbol not in views)
    beside = (*(fields.CONTACT_WORK if groups > 1 else fields.HOLD_WORK), *(fields.MEMORY_WORK if remembers else ()))
    yield from ((work.symbol, work.axes, work.kind) for work in (*fields.WORK, *beside))


def bytes_needed(nj: int, ni: int, bodies: int, groups: int, internal: int = 0, remembers: bool = False) -> int:
    """Memory of a State on nj by ni cells, ghosts included, bytes; allocates nothing. internal : most variables of a body."""
    lengths = _lengths(nj, ni, bodies, groups, fields.INTERNAL + internal)
    return sum(math.prod(_shape(axes, lengths)) * np.dtype(kind).itemsize for _, axes, kind in _arrays(groups, remembers))


class State:
    """Fields of ``bodies`` bodies on a mesh, and the arrays through which the kernels of a cycle pass values to one another.

    Its arrays are those of `fields.FIELDS` and `fields.WORK`, by their symbols; with two groups, of `fields.CONTACT_WORK`
    as well, with one of `fields.HOLD_WORK`, and if an equation of state has memory, of `fields.MEMORY_WORK`. Shapes: body
    fields [m, j, i], cell fields [j, i], vertex fields [b, j, i] with a leading index of body group b (one group unless
    contact is on); all with ghosts.
    ``velocity`` and ``velocity0`` contain u, v and u0, v0, ``centroid`` contains centroid_r and centroid_z; ``body_range`` and
    ``active_range`` are the first of ``body_ranges`` and ``group_ranges``.

    Parameters
    ----------
    grid : Grid
    bodies : int
    group : int64[m], optional
        Body group of every body, that is, the velocity field that it moves with: 0, and 1 for the hard bodies of a contact.
    internal : sequence of a sequence of Field for every body, optional
        Internal variables of its strength model, then of its equation of state; none without.
    initial : sequence of float64[n] for every body, optional
        Their values in virgin material, everywhere at first; zeros without.
    remembers : bool
        Whether an equation of state has internal variables.

    ``initial`` is kept as float64[k, m], for the rows of q.
    """

    if TYPE_CHECKING:
        def __getattr__(self, symbol: str) -> np.ndarray: ...

    def __init__(self, grid: Grid, bodies: int, group=None, internal=None, initial=None,
                 remembers: bool = False):
        self.grid, self.bodies = grid, bodies
        self.group = np.zeros(bodies, dtype=np.int64) if group is None else np.asarray(group, dtype=np.int64)
        groups = self.groups = int(self.group.max()) + 1
        self.rules = fields.remap_rules(internal or [()] * bodies)
        lengths = _lengths(*grid.shape, bodies, groups, self.rules.shape[1])
        for symbol, axes, kind in _arrays(groups, remembers):
            setattr(self, symbol, np.zeros(_shape(axes, lengths), dtype=kind))
        self.u, self.v = self.velocity
        self.u0, self.v0 = self.velocity0
        self.centroid_r, self.centroid_z = self.centroid
        for field, row in zip(fields.BODY, self.q, strict=False):
            setattr(self, field.symbol, row)
        self.initial = np.zeros(self.rules.shape[1::-1])
        for m, values in enumerate(initial or ()):
            self.initial[fields.INTERNAL:fields.INTERNAL + len(values), m] = values
        self.q[...] = self.initial[:, :, None, None]
        self.pre_sweep_volume[...] = grid.volume  # ghosts keep it: a face next to them divides by it
        self.body_range, self.active_range = self.body_ranges[0], self.group_ranges[0, 0]
        self.empty_ranges()

    def empty_ranges(self) -> None:
        """Sets all ranges to empty: no body is in any row."""
        for ranges in (self.body_ranges, self.group_ranges, self.occupied):
            ranges[..., 0], ranges[..., 1] = EMPTY

    def swap_velocities(self) -> None:
        """Makes the velocities the old ones; the arrays of the old ones are written next."""
        self.velocity, self.velocity0 = self.velocity0, self.velocity
        self.u, self.v = self.velocity
        self.u0, self.v0 = self.velocity0

    def restartable(self) -> dict[str, np.ndarray]:
        """The arrays from which every other one follows."""
        return {"vof": self.vof, "q": self.q, "centroid": self.centroid, "u": self.u, "v": self.v, "zone": self.zone,
                "normal": self.normal}
