"""The graded r-z mesh: edges, volumes, and the metrics of its columns, which kernels use instead of asking for the geometry.

Per radian in cylindrical geometry, per unit depth in planar geometry. With r1, r2 the inner and outer radius of a
column, dr = r2 - r1 and h the height of a row (explanation/lagrangian-step, equations 1 to 3):

    face_r   radius of the inner face                                r1              planar: 1
    hoop     quarter of the area behind a hoop stress, per height    dr/4            planar: 0
    vol_r    volume of the column per height                         (r2^2 - r1^2)/2 planar: dr
    az_in    axial area of the inner vertex                          dr (2 r1 + r2)/6   planar: dr/2
    az_out   axial area of the outer vertex                          dr (r1 + 2 r2)/6   planar: dr/2
    mid_r    half the mean radius of the column                      (r1 + r2)/4       planar: 1/2
    cm_in    share of the cell's mass at each inner vertex           az_in / (2 vol_r)
    cm_out   share of the cell's mass at each outer vertex           az_out / (2 vol_r)

They are the rows of one block that kernels read, ``Grid.metrics[k, i]``, by the constants below, and attributes of the grid.
"""

from __future__ import annotations

import numpy as np

GHOSTS = 2

#: rows of `Grid.metrics`
FACE_R, HOOP, VOL_R, AZ_IN, AZ_OUT, MID_R, CM_IN, CM_OUT = range(8)


def _with_ghosts(edges: np.ndarray) -> np.ndarray:
    """Adds mirrored cells of the same size on either side of the edges."""
    first, last = np.diff(edges)[:GHOSTS], np.diff(edges)[-GHOSTS:]
    if len(edges) <= GHOSTS:
        first = np.full(GHOSTS, edges[1] - edges[0])
        last = np.full(GHOSTS, edges[-1] - edges[-2])
    low = edges[0] - np.cumsum(first)
    high = edges[-1] + np.cumsum(last[::-1])
    return np.concatenate([low[::-1], edges, high])


class Grid:
    """A mesh of nr by nz cells with two layers of ghost cells.

    Parameters
    ----------
    r_edges, z_edges : array_like, shapes (nr + 1,), (nz + 1,)
        Increasing edges in metres, without ghosts.
    geometry : "cylindrical" or "planar"

    Attributes
    ----------
    r, z : float64, shapes (nr + 2 g + 1,), (nz + 2 g + 1,)
        Edges with ghosts; index g is the first interior edge.
    volume : float64, shape (nz + 2 g, nr + 2 g)
        Cell volumes per radian (planar: per unit depth), positive in ghosts as well.
    metrics : float64, shape (8, nr + 2 g + 1)
        Metrics of a column or its inner face for every kernel, in the rows FACE_R to CM_OUT; beyond the last column only
        FACE_R has a value, the others are zero.
    face_r, hoop, vol_r, az_in, az_out, mid_r, cm_in, cm_out : float64
        The rows by name, those of columns without the last entry.
    offset : float
        Distance that the mesh has travelled along z since the start, m; see `move`.
    """

    def __init__(self, r_edges, z_edges, geometry: str = "cylindrical"):
        r_edges, z_edges = np.asarray(r_edges, dtype=float), np.asarray(z_edges, dtype=float)
        for name, edges in (("r", r_edges), ("z", z_edges)):
            if edges.ndim != 1 or len(edges) < 2 or not np.all(np.diff(edges) > 0):
                raise ValueError(f"{name} edges must be at least two increasing numbers")
        if geometry not in ("cylindrical", "planar"):
            raise ValueError(f'geometry is "{geometry}"; allowed are "cylindrical" and "planar"')
        self.cylindrical = geometry == "cylindrical"
        if self.cylindrical and r_edges[0] < 0:
            raise ValueError("a cylindrical mesh starts at r >= 0")
        self.geometry = geometry
        self.g = GHOSTS
        self.nr, self.nz = len(r_edges) - 1, len(z_edges) - 1
        self.r, self.z = _with_ghosts(r_edges), _with_ghosts(z_edges)
        self.dr, self.dz = np.diff(self.r), np.diff(self.z)
        self.rc, self.zc = 0.5 * (self.r[1:] + self.r[:-1]), 0.5 * (self.z[1:] + self.z[:-1])
        self.moved = np.zeros(1)
        self.start = self.z.copy(), self.zc.copy()
        self._columns()
        self.volume = self.dz[:, None] * self.vol_r[None, :]
        self.shape = self.volume.shape
        self.vertex_shape = (self.shape[0] + 1, self.shape[1] + 1)

    def _columns(self) -> None:
        dr = self.dr
        if self.cylindrical:
            r1, r2 = np.abs(self.r[:-1]), np.abs(self.r[1:])  # ghosts left of the axis mirror the cells to its right
            inner, outer = np.minimum(r1, r2), np.maximum(r1, r2)
            self.face_r = np.abs(self.r)
            self.hoop = dr / 4
            self.vol_r = (outer**2 - inner**2) / 2
            self.az_in = dr * (2 * r1 + r2) / 6
            self.az_out = dr * (r1 + 2 * r2) / 6
        else:
            self.face_r = np.ones(len(dr) + 1)
            self.hoop = np.zeros(len(dr))
            self.vol_r = dr.copy()
            self.az_in = dr / 2
            self.az_out = dr / 2
        self.mid_r = self.vol_r / (2 * dr)
        self.cm_in = self.az_in / (2 * self.vol_r)
        self.cm_out = self.az_out / (2 * self.vol_r)
        rows = self.face_r, self.hoop, self.vol_r, self.az_in, self.az_out, self.mid_r, self.cm_in, self.cm_out
        self.metrics = np.stack([np.pad(row, (0, len(self.face_r) - len(row))) for row in rows])

    def move(self, offset: float) -> None:
        """Places the whole mesh at `offset` from where it was at the start: edges and centres along z, in place."""
        self.moved[0] = offset
        for now, start in zip((self.z, self.zc), self.start, strict=True):
            np.add(start, offset, out=now)

    @property
    def offset(self) -> float:
        """Distance that the mesh has travelled along z since the start, m; see `move`."""
        return float(self.moved[0])

    @property
    def cells(self) -> int:
        """Number of interior cells."""
        return self.nr * self.nz

    @property
    def r_edges(self) -> np.ndarray:
        """Interior edges in r, shape (nr + 1,)."""
        return self.r[self.g : self.g + self.nr + 1]

    @property
    def z_edges(self) -> np.ndarray:
        """Interior edges in z, shape (nz + 1,)."""
        return self.z[self.g : self.g + self.nz + 1]

    @property
    def inside(self) -> tuple[slice, slice]:
        """Slices of the interior cells of a [j, i] array."""
        return slice(self.g, self.g + self.nz), slice(self.g, self.g + self.nr)

    @property
    def inside_vertices(self) -> tuple[slice, slice]:
        """Slices of the interior vertices of a [j, i] vertex array."""
        return slice(self.g, self.g + self.nz + 1), slice(self.g, self.g + self.nr + 1)

    def interior(self, array: np.ndarray) -> np.ndarray:
        """View of a cell array without its ghosts, shape (..., nz, nr)."""
        return array[(..., *self.inside)]

    def vertex_mean(self, array: np.ndarray) -> np.ndarray:
        """Mean of the four vertices of each cell of a vertex array, without ghosts, shape (..., nz, nr)."""
        w = self.interior_vertices(array)
        return 0.25 * ((w[..., :-1, :-1] + w[..., 1:, 1:]) + (w[..., :-1, 1:] + w[..., 1:, :-1]))

    def interior_vertices(self, array: np.ndarray) -> np.ndarray:
        """View of a vertex array without its ghosts, shape (..., nz + 1, nr + 1)."""
        return array[(..., *self.inside_vertices)]
