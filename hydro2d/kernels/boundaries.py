"""Ghost cells and vertices: mirrored at the axis and at walls, copied where the mesh is open.

Through an open edge material leaves freely; beyond it is void without stress, and only void comes in.
"""

from hydro2d.fields import SRZ
from hydro2d.grid import GHOSTS
from hydro2d.jit import apart, kernel, prange


@apart
def fill(m, j, i, from_j, from_i, mirror, fields, vof, q):
    """Makes cell (j, i) of body m a copy or, in a mirror, an image of cell (from_j, from_i)."""
    vof[m, j, i] = vof[m, from_j, from_i]
    for k in range(fields):
        q[k, m, j, i] = q[k, m, from_j, from_i]
    if mirror and fields > SRZ:
        q[SRZ, m, j, i] = -q[SRZ, m, from_j, from_i]


@kernel
def ghost_columns(j0, j1, nr, mirror_low, mirror_high, fields, span, vof, q):
    """Ghost cells left and right of rows j0 to j1, of bodies that are near or were: fractions and the first `fields` of q.

    Reads    span [m, j, 2]
    Updates  vof [m, j, i], q [k, m, j, i]
    """
    g = GHOSTS
    for j in prange(j0, j1):
        for m in range(vof.shape[0]):
            for side in range(2):
                edge = g + nr - 1 if side else g  # the last cell of the mesh
                out = 1 if side else -1
                near = span[m, j, 1] > nr if side else span[m, j, 0] < 2 * g
                if not (near or vof[m, j, edge + out] > 0.0 or vof[m, j, edge + 2 * out] > 0.0):
                    continue
                mirror = mirror_high if side else mirror_low
                for n in range(g):
                    ghost = edge + (n + 1) * out
                    source = edge - n * out if mirror else edge
                    fill(m, j, ghost, j, source, mirror, fields, vof, q)


@kernel
def ghost_rows(i0, i1, nz, mirror_low, mirror_high, fields, vof, q):
    """Ghost cells below and above the mesh, columns i0 to i1 (threaded over columns: there are only two rows); likewise.

    Updates  vof [m, j, i], q [k, m, j, i]
    """
    g = GHOSTS
    for i in prange(i0, i1):
        for m in range(vof.shape[0]):
            for side in range(2):
                edge = g + nz - 1 if side else g
                out = 1 if side else -1
                mirror = mirror_high if side else mirror_low
                for n in range(g):
                    ghost = edge + (n + 1) * out
                    source = edge - n * out if mirror else edge
                    fill(m, ghost, i, source, i, mirror, fields, vof, q)


@kernel
def ghost_vertices_r(j0, j1, nr, mirror_low, mirror_high, u, v):
    """Ghost vertices left and right of rows j0 to j1; u changes its sign in a mirror.

    Updates  u, v [b, j, i]
    """
    g = GHOSTS
    for j in prange(j0, j1):
        for b in range(u.shape[0]):
            for n in range(1, g + 1):
                u[b, j, g - n] = -u[b, j, g + n] if mirror_low else u[b, j, g]
                v[b, j, g - n] = v[b, j, g + n] if mirror_low else v[b, j, g]
                u[b, j, g + nr + n] = -u[b, j, g + nr - n] if mirror_high else u[b, j, g + nr]
                v[b, j, g + nr + n] = v[b, j, g + nr - n] if mirror_high else v[b, j, g + nr]


@kernel
def ghost_vertices_z(i0, i1, nz, mirror_low, mirror_high, u, v):
    """Ghost vertices below and above the mesh; v changes its sign in a mirror.

    Updates  u, v [b, j, i]
    """
    g = GHOSTS
    for i in prange(i0, i1):
        for b in range(u.shape[0]):
            for n in range(1, g + 1):
                u[b, g - n, i] = u[b, g + n, i] if mirror_low else u[b, g, i]
                v[b, g - n, i] = -v[b, g + n, i] if mirror_low else v[b, g, i]
                u[b, g + nz + n, i] = u[b, g + nz - n, i] if mirror_high else u[b, g + nz, i]
                v[b, g + nz + n, i] = -v[b, g + nz - n, i] if mirror_high else v[b, g + nz, i]
