"""Ghost cells and vertices: mirrored at the axis and at walls, copied where the mesh is open; what transmitting edges hold.

Through an open edge material leaves freely; beyond it is void without stress, and only void comes in, or, where the mesh
travels, what the deck has placed there (hydro2d/following). A transmitting edge lets in what is beside it.
"""


from hydro2d.jit import apart, kernel, point, prange, serial
from hydro2d.mesh.fields import PARITY
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, GHOSTS
from hydro2d.physics.waves import impedances


@apart
def fill(m, j, i, from_j, from_i, mirror, fields, rules, vof, q):
    """Makes cell (j, i) of body m a copy or, in a mirror, an image of cell (from_j, from_i)."""
    vof[m, j, i] = vof[m, from_j, from_i]
    for k in range(fields):
        q[k, m, j, i] = -q[k, m, from_j, from_i] if mirror and rules[m, k, PARITY] < 0.0 else q[k, m, from_j, from_i]


@kernel
def ghost_columns(j0, j1, nr, mirror_low, mirror_high, fields, rules, body_range, vof, q):
    """Ghost cells left and right of rows j0 to j1, of bodies that are near or were: fractions and the first `fields` of q.

    Reads    rules [m, k, 4]; body_range [m, j, 2]
    Updates  vof [m, j, i], q [k, m, j, i]
    """
    g = GHOSTS
    for j in prange(j0, j1):
        for m in range(vof.shape[0]):
            for side in range(2):
                edge = g + nr - 1 if side else g  # the last cell of the mesh
                out = 1 if side else -1
                near = body_range[m, j, 1] > nr if side else body_range[m, j, 0] < 2 * g
                if not (near or vof[m, j, edge + out] > 0.0 or vof[m, j, edge + 2 * out] > 0.0):
                    continue
                mirror = mirror_high if side else mirror_low
                for n in range(g):
                    ghost = edge + (n + 1) * out
                    source = edge - n * out if mirror else edge
                    fill(m, j, ghost, j, source, mirror, fields, rules, vof, q)


@kernel
def ghost_rows(i0, i1, nz, mirror_low, mirror_high, fields, rules, vof, q):
    """Ghost cells below and above the mesh, columns i0 to i1 (threaded over columns: there are only two rows); likewise.

    Reads    rules [m, k, 4]
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
                    fill(m, ghost, i, source, i, mirror, fields, rules, vof, q)


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


@point
def dashpots(along_r, j, i, metrics, dz, rhobar, cl, bulk):
    """Dashpots of a vertex on an edge along the normal and along the edge, N s/m: the impedances of the cells around it."""
    normal, shear = 0.0, 0.0
    for row in range(j - 1, j + 1):
        for column in range(i - 1, i + 1):
            axial = metrics[AZ_OUT, column] if column < i else metrics[AZ_IN, column]
            area = 0.5 * metrics[FACE_R, i] * dz[row] if along_r else axial
            z_l, z_s = impedances(row, column, rhobar, cl, bulk)
            normal += area * z_l
            shear += area * z_s
    return normal, shear


@serial
def transmit(along_r, at, first, last, crossing, constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u0, v0, u, v, taken):
    """Tractions -rho c_l v_n and -rho c_s v_t on the vertices first to last of an edge: what an endless plate would hold with.

    J. Lysmer & R. L. Kuhlemeyer, J. Engng Mech. Div. ASCE 95 (1969) 859: exact for plane waves that meet the edge squarely.
    The dashpots are taken at the end of the step. Vertices that two groups share are the contact's. At a corner of two
    transmitting edges, the edge along z holds with the dashpots of both and the other one leaves the corner out; a velocity
    that a wall or the axis gives is not held. The edge is column `at` where along_r, else row `at`; what is taken from the
    vertices goes on beyond the edge.

    Reads    crossing [2], places along the edge where another transmitting edge crosses it, -1 for none; constrained [4],
             columns and rows whose normal velocity is given, -1 for none; rhobar, cl, bulk [j, i]; mass, u0, v0 [b, j, i]
    Updates  u, v [b, j, i]; adds to taken[0] axial momentum, to taken[1] energy
    """
    groups = mass.shape[0]
    for place in range(first, last):
        j, i = (place, at) if along_r else (at, place)
        corner = place == crossing[0] or place == crossing[1]
        if corner and not along_r:
            continue
        normal, shear = dashpots(along_r, j, i, metrics, dz, rhobar, cl, bulk)
        radial_drag, axial_drag = (normal, shear) if along_r else (shear, normal)
        if corner:
            normal, shear = dashpots(False, j, i, metrics, dz, rhobar, cl, bulk)
            radial_drag += shear
            axial_drag += normal
        radial_drag = 0.0 if i == constrained[0] or i == constrained[1] else radial_drag
        axial_drag = 0.0 if j == constrained[2] or j == constrained[3] else axial_drag
        for b in range(groups):
            m = mass[b, j, i]
            if m == 0.0 or (groups == 2 and mass[1 - b, j, i] > 0.0):
                continue
            radial = u[b, j, i] * (m / (m + dt * radial_drag))
            axial = v[b, j, i] * (m / (m + dt * axial_drag))
            lost_r, lost_z = m * (u[b, j, i] - radial), m * (v[b, j, i] - axial)
            taken[0] += lost_z
            taken[1] += 0.5 * (lost_r * (u0[b, j, i] + radial) + lost_z * (v0[b, j, i] + axial))
            u[b, j, i] = radial
            v[b, j, i] = axial
