"""Ghost cells and vertices: mirrored at the axis and at walls, copied where the mesh is open; what transmitting edges hold.

Through an open edge material leaves freely; beyond it is void without stress, and only void comes in, or, where the mesh
travels, what the deck has placed there (hydro2d/following). A transmitting edge lets in what is beside it.
"""


from hydro2d.jit import apart, kernel, point, serial
from hydro2d.kernels.column_ranges import outer_rows, past_row
from hydro2d.mesh.fields import PARITY
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, GHOSTS
from hydro2d.physics.waves import impedances


@apart
def fill(m, j, i, from_j, from_i, mirror, fields, rules, vof, q, centroid):
    """Makes cell (j, i) of body m a copy or, in a mirror, an image of cell (from_j, from_i)."""
    if 0.0 < vof[m, j, i] < 1.0 or 0.0 < vof[m, from_j, from_i] < 1.0:  # else it is 0 and stays so
        centroid[0, m, j, i] = -centroid[0, m, from_j, from_i] if mirror and j == from_j else centroid[0, m, from_j, from_i]
        centroid[1, m, j, i] = -centroid[1, m, from_j, from_i] if mirror and i == from_i else centroid[1, m, from_j, from_i]
    vof[m, j, i] = vof[m, from_j, from_i]
    for k in range(fields):
        q[k, m, j, i] = -q[k, m, from_j, from_i] if mirror and rules[m, k, PARITY] < 0.0 else q[k, m, from_j, from_i]


@kernel
def ghost_columns(di, part, parts, nr, mirror_r_min, mirror_r_max, rules, body_range, vof, q, centroid):
    """Ghost cells left and right of rows j0 to j1, of bodies that are near or were: fractions and, before a sweep along r, q.

    Interfaces of a sweep along z need the fractions alone.

    Reads    rules [m, k, 4]; body_range [m, j, 2]
    Updates  vof [m, j, i], q [k, m, j, i], centroid [2, m, j, i]
    """
    g = GHOSTS
    fields = di * q.shape[0]
    for j in range(parts[part], parts[part + 1]):
        for m in range(vof.shape[0]):
            for side in range(2):
                edge = g + nr - 1 if side else g  # the last cell of the mesh
                out = 1 if side else -1
                near = body_range[m, j, 1] > nr if side else body_range[m, j, 0] < 2 * g
                if not (near or vof[m, j, edge + out] > 0.0 or vof[m, j, edge + 2 * out] > 0.0):
                    continue
                mirror = mirror_r_max if side else mirror_r_min
                for n in range(g):
                    ghost = edge + (n + 1) * out
                    source = edge - n * out if mirror else edge
                    fill(m, j, ghost, j, source, mirror, fields, rules, vof, q, centroid)


@kernel
def ghost_rows(dj, part, parts, i0, i1, nz, mirror_z_min, mirror_z_max, leading, rules, vof, q, centroid):
    """Ghost cells below and above columns i0 - 2 to i1 + 2, likewise, q before a sweep along z; the first and the last part
    have one side each.

    The side `leading` of a mesh that travels (0 low, 1 high, -1 none) is left as it is: what flows in has been placed there.

    Reads    rules [m, k, 4]
    Updates  vof [m, j, i], q [k, m, j, i], centroid [2, m, j, i]
    """
    g = GHOSTS
    fields = dj * q.shape[0]
    for side in range(2):
        if side == leading or part != (parts.shape[0] - 2 if side else 0):
            continue
        edge = g + nz - 1 if side else g
        out = 1 if side else -1
        mirror = mirror_z_max if side else mirror_z_min
        for m in range(vof.shape[0]):
            for n in range(g):
                ghost = edge + (n + 1) * out
                source = edge - n * out if mirror else edge
                for i in range(i0 - g, i1 + g):
                    fill(m, ghost, i, source, i, mirror, fields, rules, vof, q, centroid)


@kernel
def ghost_vertices_r(part, parts, nr, mirror_r_min, mirror_r_max, u, v):
    """Ghost vertices left and right of rows j0 to j1; u changes its sign in a mirror.

    Updates  u, v [b, j, i]
    """
    g = GHOSTS
    for j in range(parts[part], past_row(part, parts, 1)):
        for b in range(u.shape[0]):
            for n in range(1, g + 1):
                u[b, j, g - n] = -u[b, j, g + n] if mirror_r_min else u[b, j, g]
                v[b, j, g - n] = v[b, j, g + n] if mirror_r_min else v[b, j, g]
                u[b, j, g + nr + n] = -u[b, j, g + nr - n] if mirror_r_max else u[b, j, g + nr]
                v[b, j, g + nr + n] = v[b, j, g + nr - n] if mirror_r_max else v[b, j, g + nr]


@kernel
def ghost_vertices_z(part, parts, i0, i1, nz, mirror_z_min, mirror_z_max, u, v):
    """Ghost vertices below and above the mesh, by the first and the last part; v changes its sign in a mirror.

    Updates  u, v [b, j, i]
    """
    g = GHOSTS
    for b in range(u.shape[0]):
        for n in range(1, g + 1):
            for i in range(i0 - g, i1 + g + 1):
                if part == 0:
                    u[b, g - n, i] = u[b, g + n, i] if mirror_z_min else u[b, g, i]
                    v[b, g - n, i] = -v[b, g + n, i] if mirror_z_min else v[b, g, i]
                if part == parts.shape[0] - 2:
                    u[b, g + nz + n, i] = u[b, g + nz - n, i] if mirror_z_max else u[b, g + nz, i]
                    v[b, g + nz + n, i] = -v[b, g + nz - n, i] if mirror_z_max else v[b, g + nz, i]


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


@apart
def transmit(along_r, at, first, last, crossing, constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u, v, drag):
    """Tractions -rho c_l v_n and -rho c_s v_t on the vertices first to last of an edge: what an endless plate would hold with.

    J. Lysmer & R. L. Kuhlemeyer, J. Engng Mech. Div. ASCE 95 (1969) 859: exact for plane waves that meet the edge squarely.
    The dashpots are taken at the end of the step. Vertices that two groups share are the contact's. At a corner of two
    transmitting edges, the edge along z holds with the dashpots of both and the other one leaves the corner out; a velocity
    that a wall or the axis gives is not held. The edge is column `at` where along_r, else row `at`; what is taken from the
    vertices goes on beyond the edge.

    Reads    crossing [2], places along the edge where another transmitting edge crosses it, -1 for none; constrained [4],
             columns and rows whose normal velocity is given, -1 for none; rhobar, cl, bulk [j, i]; mass [b, j, i]
    Updates  u, v [b, j, i];  writes drag [b, c, j or i], the impulses that are taken, where there are any
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
            drag[b, 0, place] = m * (u[b, j, i] - radial)
            drag[b, 1, place] = m * (v[b, j, i] - axial)
            u[b, j, i] = radial
            v[b, j, i] = axial


@serial
def transmit_edges(parts, i0, i1, transmitting, constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u, v, drag):
    """`transmit` for every transmitting edge that the active box has reached.

    Reads    transmitting, constrained [4], columns (2) and rows (2), -1 for none; the rest as `transmit`
    Updates  u, v [b, j, i];  writes drag [edge, b, c, j or i]
    """
    j0, j1 = outer_rows(parts)
    for edge in range(4):
        at, along_r = transmitting[edge], edge < 2
        if at < 0:
            continue
        for b in range(mass.shape[0]):
            for place in range(drag.shape[3]):
                drag[edge, b, 0, place] = 0.0
                drag[edge, b, 1, place] = 0.0
        if along_r and (at == i0 or at == i1):
            transmit(along_r, at, j0, j1 + 1, transmitting[2:4], constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u, v,
                     drag[edge])
        elif not along_r and (at == j0 or at == j1):
            transmit(along_r, at, i0, i1 + 1, transmitting[0:2], constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u, v,
                     drag[edge])


@serial
def sum_drag(parts, i0, i1, transmitting, drag, u0, v0, u, v, held_back):
    """What transmitting edges have taken, by the velocities at the end of the step.

    Reads    transmitting [4]; drag [edge, b, c, j or i], impulses; u0, v0, u, v [b, j, i]
    Writes   held_back [2], axial momentum and energy
    """
    j0, j1 = outer_rows(parts)
    held_back[0], held_back[1] = 0.0, 0.0
    for edge in range(4):
        at = transmitting[edge]
        if at < 0:
            continue
        first, last = (j0, j1 + 1) if edge < 2 else (i0, i1 + 1)
        for place in range(first, last):
            j, i = (place, at) if edge < 2 else (at, place)
            for b in range(u.shape[0]):
                radial, axial = drag[edge, b, 0, place], drag[edge, b, 1, place]
                held_back[0] += axial
                held_back[1] += 0.5 * (radial * (u0[b, j, i] + u[b, j, i]) + axial * (v0[b, j, i] + v[b, j, i]))


@point
def own_rows(part, parts, rows):
    """First row and one past the last of a part, with all rows of the mesh beyond the active box: 0 to `rows`."""
    return 0 if part == 0 else parts[part], rows if part == parts.shape[0] - 2 else parts[part + 1]


@point
def held_at(edge, only_pushes, given, free):
    """Normal velocity of a vertex at an edge: the one that is given, or its own if it leaves an edge that only pushes."""
    return free if only_pushes and (free > 0.0 if edge % 2 == 0 else free < 0.0) else given


@point
def left_by_edges(at, low, constrained, pushing, velocity, free):
    """Normal velocity that the edges leave a vertex in column (low = 0) or row (low = 2) `at`: its own where none is."""
    for edge in range(low, low + 2):
        if at == constrained[edge]:
            return velocity[edge]
        if at == pushing[edge]:
            return held_at(edge, True, velocity[edge], free)
    return free


@kernel
def constrain(part, parts, constrained, pushing, edge_velocity, mass, u0, v0, u, v, walls):
    """The given normal velocity of constrained vertices: axis, walls, edges with a velocity, anvils that are not left.

    The axis and walls along z take no axial momentum and do no work.

    Reads    constrained, pushing [4], columns (2) and rows (2), -1 for none; edge_velocity [4], m/s; mass, u0, v0 [b, j, i]
    Updates  u, v [b, j, i]
    Writes   walls [4, 2, j]: axial momentum and energy that each edge takes in a row
    """
    first, last = own_rows(part, parts, u.shape[1])
    for j in range(first, last):
        for edge in range(4):
            walls[edge, 0, j], walls[edge, 1, j] = 0.0, 0.0
        for b in range(u.shape[0]):
            for edge in range(2):
                at = max(constrained[edge], pushing[edge])
                if at < 0:
                    continue
                given = held_at(edge, pushing[edge] >= 0, edge_velocity[edge], u[b, j, at])
                impulse = mass[b, j, at] * (u[b, j, at] - given)
                walls[edge, 1, j] += 0.5 * impulse * (u0[b, j, at] + given)
                u[b, j, at] = given
            for edge in range(2, 4):
                if max(constrained[edge], pushing[edge]) != j:
                    continue
                for i in range(u.shape[2]):
                    given = held_at(edge, pushing[edge] >= 0, edge_velocity[edge], v[b, j, i])
                    impulse = mass[b, j, i] * (v[b, j, i] - given)
                    walls[edge, 0, j] += impulse
                    walls[edge, 1, j] += 0.5 * impulse * (v0[b, j, i] + given)
                    v[b, j, i] = given


@kernel
def close_mass_flux(part, parts, di, mesh_box, opens_low, opens_high, flux_mass):
    """Mass flux beyond the edges of the mesh, where the sweep along the other direction has left its own: there is none.

    Beyond an open edge of this direction it goes on as it was.

    Reads    mesh_box [4], rows j0, j1 and columns i0, i1 of the mesh
    Updates  flux_mass [b, j, i]
    """
    first, last = own_rows(part, parts, flux_mass.shape[1])
    j0, j1, i0, i1 = mesh_box[0], mesh_box[1], mesh_box[2], mesh_box[3]
    for b in range(flux_mass.shape[0]):
        if di == 1:
            for i in range(flux_mass.shape[2]):
                if part == 0:
                    flux_mass[b, j0 - 1, i] = 0.0
                if part == parts.shape[0] - 2:
                    flux_mass[b, j1, i] = 0.0
            for j in range(first, last):
                if opens_low:
                    flux_mass[b, j, i0 - 1] = flux_mass[b, j, i0]
                if opens_high:
                    flux_mass[b, j, i1 + 1] = flux_mass[b, j, i1]
        else:
            for j in range(first, last):
                flux_mass[b, j, i0 - 1] = 0.0
                flux_mass[b, j, i1] = 0.0
            for i in range(flux_mass.shape[2]):
                if opens_low and part == 0:
                    flux_mass[b, j0 - 1, i] = flux_mass[b, j0, i]
                if opens_high and part == parts.shape[0] - 2:
                    flux_mass[b, j1 + 1, i] = flux_mass[b, j1, i]
