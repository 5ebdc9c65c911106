"""Outlines of bodies: lines along which a body fills half of a cell, and lines around parts narrower than a cell."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hydro2d.mesh.sums import HALF
from hydro2d.physics.centroids import CRUMB, FILLED, box_ends

#: largest gap, in cells, at which the boxes of neighbouring cells are joined, within a cut and between cuts
WITHIN, BESIDE = 0.2, 1.0
#: codes of a matplotlib path: the first point of a line, a further one, and the last of a closed line
MOVE, LINE, CLOSE = 1, 2, 79


@dataclass(frozen=True)
class Cut:
    """The part of a line of cells that the boxes of consecutive cells fill, m.

    low, high : its ends along the line;  first, last : its ends across it;  along, across : its centroid;  width : of the line
    thickness : along the line, averaged across it;  cell : number of the last cell;  size : of that cell
    """

    low: float
    high: float
    first: float
    last: float
    along: float
    across: float
    width: float
    thickness: float
    cell: int
    size: float

    def with_next(self, other: Cut) -> Cut:
        """This cut and the next one joined."""
        both = self.thickness + other.thickness
        along, across = ((mine * self.thickness + its * other.thickness) / both
                         for mine, its in ((self.along, other.along), (self.across, other.across)))
        return replace(other, low=self.low, first=min(self.first, other.first), last=max(self.last, other.last), along=along,
                       across=across, thickness=both)

    def near(self, other: Cut, gap: float) -> bool:
        """Whether the cuts overlap, or are no further apart than ``gap``, in cells."""
        return max(self.low, other.low) - min(self.high, other.high) <= gap * max(self.size, other.size)

    @property
    def half_at_an_end(self) -> float:
        """Half of the thickness if the cut fills the line only from `first` to `last`."""
        return 0.5 * min(self.thickness * self.width / (self.last - self.first), self.high - self.low)


@dataclass(frozen=True)
class Filling:
    """The share of each cell that a body, or several together, fill, and its place in the cell.

    r_edges (nr + 1,), z_edges (nz + 1,) in m; fraction (nz, nr); offsets (2, nz, nr) along r and z of its centroid from that of
    the cell, m. Without offsets, parts narrower than a cell are not known.
    """

    r_edges: np.ndarray
    z_edges: np.ndarray
    fraction: np.ndarray
    offsets: np.ndarray | None = None

    @cached_property
    def thin(self) -> np.ndarray:
        """Cells (nz, nr) of parts narrower than a cell: filled by CRUMB or more, and none of the 5 x 5 around by FILLED."""
        if self.offsets is None:
            return np.zeros(self.fraction.shape, dtype=bool)
        from scipy import ndimage

        return (self.fraction >= CRUMB) & (ndimage.maximum_filter(self.fraction, 5) < FILLED)

    @property
    def shown(self) -> np.ndarray:
        """Cells (nz, nr) whose values are shown: filled by half, or of a part narrower than a cell."""
        return (self.fraction >= HALF) | self.thin

    def outlines(self, closed: bool = False) -> list[np.ndarray]:
        """Contours of the fraction 1/2 through the cell centres, and closed lines around parts narrower than a cell.

        The outermost values are extended to the edges of the mesh, so that lines reach the axis and the boundary; `closed`
        continues the lines along the boundary, except the inner one. Returns arrays (n, 2) of r, z.
        """
        import contourpy

        r, z, values = self._at_centres()
        if closed:
            r, z = np.append(r, _beyond(r[-1], r[-2])), np.concatenate([[_beyond(z[0], z[1])], z, [_beyond(z[-1], z[-2])]])
            values = np.pad(values, ((1, 1), (0, 1)))
        return [*contourpy.contour_generator(r, z, values).lines(HALF), *self.around_thin]

    def regions(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """The areas bounded by `outlines` and the edges of the mesh.

        Each is an array (n, 2) of r, z and the codes (n,) of a matplotlib path: an outline, and those of its holes.
        """
        import contourpy

        points, codes = contourpy.contour_generator(*self._at_centres(), fill_type="OuterCode").filled(HALF, np.inf)
        thin = [(line, np.array([MOVE, *[LINE] * (len(line) - 2), CLOSE], dtype=np.uint8)) for line in self.around_thin]
        return [*zip(points, codes, strict=True), *thin]

    @cached_property
    def around_thin(self) -> list[np.ndarray]:
        """Closed lines (n, 2) of r, z around parts narrower than a cell, from their boxes (explanation/interfaces, equation 7).

        Each connected part is cut along its shorter side, column by column if it is wide and row by row if it is tall, and the
        ends of neighbouring cuts are joined.
        """
        if not self.thin.any():
            return []
        from scipy import ndimage

        labels, _ = ndimage.label(self.thin, np.ones((3, 3)))
        lines = []
        for number, (rows, columns) in enumerate(ndimage.find_objects(labels), start=1):
            cells = np.argwhere(labels[rows, columns] == number) + (rows.start, columns.start)
            axis = int(columns.stop - columns.start >= rows.stop - rows.start)
            lines += [_around(chain)[:, ::1 if axis else -1] for chain in _chains(self._cuts(cells, axis))]
        return lines

    def _at_centres(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """r and z of the cell centres and of the edges of the mesh, and the fractions there, without thin parts."""
        r, z = (np.concatenate([e[:1], 0.5 * (e[1:] + e[:-1]), e[-1:]]) for e in (self.r_edges, self.z_edges))
        return r, z, np.pad(np.where(self.thin, 0.0, self.fraction), 1, mode="edge")

    def _cuts(self, cells: np.ndarray, axis: int) -> Iterator[tuple[int, list[Cut]]]:
        """Yields (line, its cuts, the lowest first) of cells (n, 2), row and column, cut along r (axis 0) or z (1)."""
        widths = np.diff((self.z_edges, self.r_edges)[axis])
        for line in np.unique(cells[:, axis]).tolist():
            cuts: list[Cut] = []
            for cell in cells[cells[:, axis] == line].tolist():
                (low, high, along, size), (first, last, across, _) = self._box(cell, axis), self._box(cell, 1 - axis)
                cut = Cut(low, high, first, last, along, across, float(widths[line]), float(self.fraction[tuple(cell)]) * size,
                          cell[1 - axis], size)
                if cuts and cuts[-1].cell == cut.cell - 1 and cuts[-1].near(cut, WITHIN):
                    cuts[-1] = cuts[-1].with_next(cut)
                else:
                    cuts.append(cut)
            yield line, cuts

    def _box(self, cell: list[int], axis: int) -> tuple[float, float, float, float]:
        """Ends and middle of the box in a cell (row, column) along r (axis 0) or z (1), and the cell's size, m."""
        edges = self.r_edges, self.z_edges
        size, across = (float(edges[n][cell[1 - n] + 1] - edges[n][cell[1 - n]]) for n in (axis, 1 - axis))
        along = self.fraction[cell[0]] if axis == 0 else self.fraction[:, cell[1]]
        at, offsets = cell[1 - axis], self.offsets[:, cell[0], cell[1]]
        before, after = (along[n] if 0 <= n < len(along) else 0.0 for n in (at - 1, at + 1))
        low, high = box_ends(along[at], offsets[axis] / size, offsets[1 - axis] / across, before, after)
        middle = 0.5 * float(edges[axis][at] + edges[axis][at + 1])
        return middle + low * size, middle + high * size, middle + 0.5 * (low + high) * size, size


def _chains(lines: Iterator[tuple[int, list[Cut]]]) -> list[list[Cut]]:
    """Chains of neighbouring cuts on consecutive lines."""
    chains: list[list[Cut]] = []
    before: list[list[Cut]] = []
    last = -2
    for line, cuts in lines:
        open_ended, before = before if line == last + 1 else [], []
        for cut in cuts:
            chain = next((each for each in open_ended if each[-1].near(cut, BESIDE)), None)
            if chain is None:
                chain = []
                chains.append(chain)
            else:
                open_ended = [each for each in open_ended if each is not chain]
            chain.append(cut)
            before.append(chain)
        last = line
    return chains


def _around(chain: list[Cut]) -> np.ndarray:
    """Closed line (n, 2) around cuts; points are across and along the lines of cells."""
    one, other = chain[0], chain[-1]
    if len(chain) == 1:
        places = [(one.first, one.low, one.high), (one.last, one.low, one.high)]
    else:
        inner = [(cut.across, cut.along - 0.5 * cut.thickness, cut.along + 0.5 * cut.thickness) for cut in chain[1:-1]]
        places = [_end(one, chain[1], one.first), *inner, _end(other, chain[-2], other.last)]
    return np.array([*((x, low) for x, low, _ in places), *((x, high) for x, _, high in reversed(places)), places[0][:2]])


def _end(cut: Cut, beside: Cut, at: float) -> tuple[float, float, float]:
    """(across, low, high) at the end of a chain: a cut extended to a place in its line, in the direction from its neighbour."""
    slope = (beside.along - cut.along) / (beside.across - cut.across)
    middle = cut.along + slope * (at - cut.across)
    return at, middle - cut.half_at_an_end, middle + cut.half_at_an_end


def _beyond(edge: float, inside: float) -> float:
    """A point just outside the mesh."""
    return edge + 1e-6 * (edge - inside)
