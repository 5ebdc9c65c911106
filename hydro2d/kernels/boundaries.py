"""Ghost cells and vertices: mirrored at the axis and at walls, copied where the mesh is open.

Through an open edge material leaves freely; beyond it is void without stress, and only void comes in.
"""

from hydro2d.fields import SRZ
from hydro2d.grid import GHOSTS
from hydro2d.jit import kernel, prange


@kernel
def ghost_columns(j0, j1, nr, mirror_low, mirror_high, fields, span, vof, q):
    """Ghost cells left and right of rows j0 to j1, of bodies that are near or were: fractions and the first `fields` of q.

    Reads    span [m, j, 2]
    Updates  vof [m, j, i], q [k, m, j, i]
    """
    g = GHOSTS
    for j in prange(j0, j1):
        for m in range(vof.shape[0]):
            near_low = span[m, j, 0] < 2 * g or vof[m, j, g - 1] > 0.0 or vof[m, j, g - 2] > 0.0
            near_high = span[m, j, 1] > nr or vof[m, j, g + nr] > 0.0 or vof[m, j, g + nr + 1] > 0.0
            for n in range(g):
                if near_low:
                    low = g + n if mirror_low else g
                    vof[m, j, g - 1 - n] = vof[m, j, low]
                    for k in range(fields):
                        q[k, m, j, g - 1 - n] = q[k, m, j, low] * (-1.0 if k == SRZ and mirror_low else 1.0)
                if near_high:
                    high = g + nr - 1 - n if mirror_high else g + nr - 1
                    vof[m, j, g + nr + n] = vof[m, j, high]
                    for k in range(fields):
                        q[k, m, j, g + nr + n] = q[k, m, j, high] * (-1.0 if k == SRZ and mirror_high else 1.0)


@kernel
def ghost_rows(i0, i1, nz, mirror_low, mirror_high, fields, vof, q):
    """Ghost cells below and above the mesh, columns i0 to i1 (threaded over columns: there are only two rows); likewise.

    Updates  vof [m, j, i], q [k, m, j, i]
    """
    g = GHOSTS
    for i in prange(i0, i1):
        for m in range(vof.shape[0]):
            for n in range(g):
                low = g + n if mirror_low else g
                high = g + nz - 1 - n if mirror_high else g + nz - 1
                vof[m, g - 1 - n, i] = vof[m, low, i]
                vof[m, g + nz + n, i] = vof[m, high, i]
                for k in range(fields):
                    q[k, m, g - 1 - n, i] = q[k, m, low, i] * (-1.0 if k == SRZ and mirror_low else 1.0)
                    q[k, m, g + nz + n, i] = q[k, m, high, i] * (-1.0 if k == SRZ and mirror_high else 1.0)


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
