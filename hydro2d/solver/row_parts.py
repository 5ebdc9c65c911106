"""The parts into which the rows of the active box are cut, one for each thread: every kernel of the step uses the same ones.

Data that a thread has written stay in its processor's cache until it reads them again. No result depends on the parts.
"""

from __future__ import annotations

import numpy as np

from hydro2d import jit

#: fewest rows of a part: the sweep along z shares three faces with each neighbour
FEWEST = 4
#: cycles between two cuts: expensive cells move by less than a cell in that time
RECUT = 10
#: cost of a cell full of one body, of a mixed cell, and of an empty one
FULL, MIXED, EMPTY = 10, 200, 1


def cut(costs: np.ndarray, number: int, first: int = 0, sums: np.ndarray | None = None) -> np.ndarray:
    """First row of each part and one past the last, int64[n + 1], with about equal sums of costs; n <= number, at least 1.

    costs : [rows], positive;  first : number of the first row;  sums : [rows], an array for their sums, if given
    """
    rows = len(costs)
    number = max(min(number, rows // FEWEST), 1)
    total = np.cumsum(costs, out=sums)
    bounds = np.zeros(number + 1, dtype=np.int64)
    shares = (total[-1] * np.arange(1, number) / number).astype(total.dtype)
    bounds[1:-1] = np.searchsorted(total, shares, side="right")
    bounds[-1] = rows
    for k in range(1, number):  # each part has enough rows, and leaves enough for those after it
        bounds[k] = min(max(bounds[k], bounds[k - 1] + FEWEST), rows - FEWEST * (number - k))
    return bounds + first


class Parts:
    """The parts of a state's active box, cut anew every few cycles by the cost of its rows."""

    def __init__(self, state):
        self.state = state
        self._parts, self._key, self._age = np.zeros(2, dtype=np.int64), None, 0
        self._cost, self._room = np.zeros((2, len(state.mixed_count)), dtype=np.int64)

    def of(self, box: list[int]) -> np.ndarray:
        """First row of each part and one past the last row of the box [j0, j1, i0, i1], int64[n + 1]; called once a cycle."""
        threads = jit.parts_at_once()
        key = (threads, *box)
        self._age += 1
        if key != self._key or (threads > 1 and self._age >= RECUT):
            self._parts, self._key, self._age = cut(self._costs(*box), threads, box[0], self._room[box[0]:box[1]]), key, 0
        return self._parts

    def _costs(self, j0: int, j1: int, i0: int, i1: int) -> np.ndarray:
        """The cost of a cycle in every row, in a reused array, since a cycle allocates no arrays of the size of the mesh."""
        s, cost, room = self.state, self._cost[j0:j1], self._room[j0:j1]
        np.subtract(s.active_range[j0:j1, 1], s.active_range[j0:j1, 0], out=cost)
        np.maximum(cost, 0, out=cost)
        cost *= FULL
        cost += np.multiply(s.mixed_count[j0:j1], MIXED, out=room)
        cost += EMPTY * (i1 - i0)
        return cost
