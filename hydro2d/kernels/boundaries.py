"""Ghost cells and vertices, mirrored at the axis and at walls and copied at open edges; tractions and constraints of edges.

Material leaves freely through an open edge; beyond it is void without stress. Only void comes in, or, where the mesh travels,
the material that the deck has placed there (hydro2d/following). An edge with a traction, which transmits waves or has a
pressure, lets in the material next to it.
"""


from hydro2d.jit import cell_rows, kernel, not_inlined, point, serial, vertex_rows
from hydro2d.kernels.column_ranges import outer_rows
from hydro2d.mesh.fields import CUT, FAR_P, FAR_U, FAR_V, PARITY
from hydro2d.mesh.grid import GHOSTS
from hydro2d.physics.corner import corner
from hydro2d.physics.edges import edge_normal_velocity, is_constrained
from hydro2d.physics.waves import impedances


@not_inlined
def fill(m, j, i, from_j, from_i, mirror, w):
    """Makes cell (j, i) of body m a copy or, in a mirror, an image of cell (from_j, from_i)."""
    if 0.0 < w.vof[m, j, i] < 1.0 or 0.0 < w.vof[m, from_j, from_i] < 1.0:  # otherwise it stays 0
        along_r, along_z = w.centroid[0, m, from_j, from_i], w.centroid[1, m, from_j, from_i]
        w.centroid[0, m, j, i] = -along_r if mirror and j == from_j else along_r
        w.centroid[1, m, j, i] = -along_z if mirror and i == from_i else along_z
    w.vof[m, j, i] = w.vof[m, from_j, from_i]
    for k in range(w.q.shape[0] * (w.di if j == from_j else w.dj)):  # none before a sweep along the other direction
        w.q[k, m, j, i] = -w.q[k, m, from_j, from_i] if mirror and w.rules[m, k, PARITY] < 0.0 else w.q[k, m, from_j, from_i]


@cell_rows
def ghost_columns(j, w):
    """Ghost cells left and right of the mesh, of bodies that are or were near: fractions and, before a sweep along r, q.

    A sweep along z needs only the fractions there, for its interfaces.

    Reads    rules [m, k, 4]; body_range [m, j, 2]
    Updates  vof [m, j, i], q [k, m, j, i], centroid [2, m, j, i]
    """
    g = GHOSTS
    for m in range(w.vof.shape[0]):
        for side in range(2):
            edge = g + w.nr - 1 if side else g  # the last cell of the mesh
            out = 1 if side else -1
            near = w.body_range[m, j, 1] > w.nr if side else w.body_range[m, j, 0] < 2 * g
            if not (near or w.vof[m, j, edge + out] > 0.0 or w.vof[m, j, edge + 2 * out] > 0.0):
                continue
            mirror = w.mirror_r_max if side else w.mirror_r_min
            for n in range(g):
                ghost = edge + (n + 1) * out
                source = edge - n * out if mirror else edge
                fill(m, j, ghost, j, source, mirror, w)


@kernel
def ghost_rows(part, w):
    """Ghost cells below and above columns i0 - 2 to i1 + 2: fractions and, before a sweep along z, q. The first and the last
    part do one side each.

    The side `leading` of a mesh that travels (0 low, 1 high, -1 none) is left alone: inflowing material has been placed there.

    Reads    rules [m, k, 4]
    Updates  vof [m, j, i], q [k, m, j, i], centroid [2, m, j, i]
    """
    g = GHOSTS
    for side in range(2):
        if side == w.leading or part != (w.parts.shape[0] - 2 if side else 0):
            continue
        edge = g + w.nz - 1 if side else g
        out = 1 if side else -1
        mirror = w.mirror_z_max if side else w.mirror_z_min
        for m in range(w.vof.shape[0]):
            for n in range(g):
                ghost = edge + (n + 1) * out
                source = edge - n * out if mirror else edge
                for i in range(w.i0 - g, w.i1 + g):
                    fill(m, ghost, i, source, i, mirror, w)


@vertex_rows
def ghost_vertices_r(j, w):
    """Ghost vertices left and right of the mesh; u changes its sign in a mirror.

    Updates  u, v [b, j, i]
    """
    g = GHOSTS
    for b in range(w.u.shape[0]):
        for n in range(1, g + 1):
            w.u[b, j, g - n] = -w.u[b, j, g + n] if w.mirror_r_min else w.u[b, j, g]
            w.v[b, j, g - n] = w.v[b, j, g + n] if w.mirror_r_min else w.v[b, j, g]
            w.u[b, j, g + w.nr + n] = -w.u[b, j, g + w.nr - n] if w.mirror_r_max else w.u[b, j, g + w.nr]
            w.v[b, j, g + w.nr + n] = w.v[b, j, g + w.nr - n] if w.mirror_r_max else w.v[b, j, g + w.nr]


@kernel
def ghost_vertices_z(part, w):
    """Ghost vertices below and above the mesh, by the first and the last part; v changes its sign in a mirror.

    Updates  u, v [b, j, i]
    """
    g = GHOSTS
    for b in range(w.u.shape[0]):
        for n in range(1, g + 1):
            for i in range(w.i0 - g, w.i1 + g + 1):
                if part == 0:
                    w.u[b, g - n, i] = w.u[b, g + n, i] if w.mirror_z_min else w.u[b, g, i]
                    w.v[b, g - n, i] = -w.v[b, g + n, i] if w.mirror_z_min else w.v[b, g, i]
                if part == w.parts.shape[0] - 2:
                    w.u[b, g + w.nz + n, i] = w.u[b, g + w.nz - n, i] if w.mirror_z_max else w.u[b, g + w.nz, i]
                    w.v[b, g + w.nz + n, i] = -w.v[b, g + w.nz - n, i] if w.mirror_z_max else w.v[b, g + w.nz, i]


@point
def far_field(edge, j, i, w):
    """(drag_r, drag_z, push_r, push_z) on a vertex from beyond an edge with a traction, N s/m and N per radian.

    The traction on a body that the edge cuts is -p_0 n - rho c (v - v_0), with the impedance c of the wave and the pressure and
    the velocity of the body at the start; on every body, besides, that of the edge. drag : the impedances;  push : all that
    does not depend on the velocity of the vertex.
    """
    along_r, inward = edge < 2, 1.0 if edge % 2 == 0 else -1.0
    drag_r, drag_z, push_r, push_z = 0.0, 0.0, 0.0, 0.0
    for row in range(j - 1, j + 1):
        for column in range(i - 1, i + 1):
            if w.rhobar[row, column] == 0.0:  # void, or beyond the mesh
                continue
            filled, cut, u_far, v_far, p_far = 0.0, 0.0, 0.0, 0.0, 0.0
            for m in range(w.vof.shape[0]):
                far = w.far[:, edge, m, row if along_r else column]
                filled += w.vof[m, row, column]
                part = w.vof[m, row, column] * far[CUT]
                cut += part
                u_far += part * far[FAR_U]
                v_far += part * far[FAR_V]
                p_far += part * far[FAR_P]
            across, hoop, c_z, _ = corner(column, column < i, row < j, w.metrics, w.dz[row])
            area = abs(across + hoop) if along_r else abs(c_z)
            push = inward * area * (p_far + filled * w.edge_pressure[edge])
            push_r += push if along_r else 0.0
            push_z += 0.0 if along_r else push
            if cut > 0.0:
                z_l, z_s = impedances(row, column, w.rhobar, w.cl, w.bulk)
                radial = area * (cut / filled) * (z_l if along_r else z_s)
                axial = area * (cut / filled) * (z_s if along_r else z_l)
                drag_r += radial
                drag_z += axial
                push_r += radial * (u_far / cut)
                push_z += axial * (v_far / cut)
    return drag_r, drag_z, push_r, push_z


@not_inlined
def load_edge(edge, w):
    """Tractions of `far_field` on the vertices of an edge: a body that it cuts feels what its continuation would do.

    J. Lysmer & R. L. Kuhlemeyer, J. Engng Mech. Div. ASCE 95 (1969) 859: exact for plane waves that meet the edge squarely,
    here waves on the state and the motion with which the body starts. The dashpots use the velocity at the end of the step.
    Vertices that two groups share have no dashpots, which are left to the contact; both groups there gain the same velocity. At
    a corner of two such edges, the edge along z has the tractions of both and the other one leaves the corner out. A velocity
    that a wall, the axis or a held edge prescribes has none. Momentum and energy taken from the vertices leave the mesh.

    Reads    loaded [4], constrained [8], columns and rows, -1 for none; far [4, edge, m, j or i]; edge_pressure [4];
             vof [m, j, i]; rhobar, cl, bulk [j, i]; mass [b, j, i]
    Updates  u, v [b, j, i];  writes drag [edge, b, c, j or i], the impulses taken, where there are any
    """
    at, along_r = w.loaded[edge], edge < 2
    crossing = w.loaded[2:4] if along_r else w.loaded[0:2]
    drag = w.drag[edge]
    j0, j1 = outer_rows(w.parts)
    first, last = (j0, j1 + 1) if along_r else (w.i0, w.i1 + 1)
    groups = w.mass.shape[0]
    for place in range(first, last):
        j, i = (place, at) if along_r else (at, place)
        if not along_r and (place == crossing[0] or place == crossing[1]):
            continue
        drag_r, drag_z, push_r, push_z = far_field(edge, j, i, w)
        for other in range(2, 4):
            if along_r and place == w.loaded[other]:
                more_drag_r, more_drag_z, more_push_r, more_push_z = far_field(other, j, i, w)
                drag_r += more_drag_r
                drag_z += more_drag_z
                push_r += more_push_r
                push_z += more_push_z
        constrained_r, constrained_z = is_constrained(j, i, w.constrained)
        if constrained_r:
            drag_r, push_r = 0.0, 0.0
        if constrained_z:
            drag_z, push_z = 0.0, 0.0
        for b in range(groups):
            m = w.mass[b, j, i]
            if m == 0.0:
                continue
            if groups == 2 and w.mass[1 - b, j, i] > 0.0:
                both = w.mass[0, j, i] + w.mass[1, j, i]
                radial = w.u[b, j, i] + w.dt * push_r / both
                axial = w.v[b, j, i] + w.dt * push_z / both
            else:
                radial = w.u[b, j, i] * (m / (m + w.dt * drag_r)) + w.dt * push_r / (m + w.dt * drag_r)
                axial = w.v[b, j, i] * (m / (m + w.dt * drag_z)) + w.dt * push_z / (m + w.dt * drag_z)
            drag[b, 0, place] = m * (w.u[b, j, i] - radial)
            drag[b, 1, place] = m * (w.v[b, j, i] - axial)
            w.u[b, j, i] = radial
            w.v[b, j, i] = axial


@serial
def load_edges(w):
    """Tractions of every edge with dashpots or a pressure that the active box has reached (`load_edge`).

    Reads    loaded [4], columns (2) and rows (2), -1 for none; the rest as `load_edge`
    Updates  u, v [b, j, i];  writes drag [edge, b, c, j or i]
    """
    j0, j1 = outer_rows(w.parts)
    for edge in range(4):
        at, along_r = w.loaded[edge], edge < 2
        if at < 0:
            continue
        for b in range(w.mass.shape[0]):
            for place in range(w.drag.shape[3]):
                w.drag[edge, b, 0, place] = 0.0
                w.drag[edge, b, 1, place] = 0.0
        if (at == w.i0 or at == w.i1) if along_r else (at == j0 or at == j1):
            load_edge(edge, w)


@serial
def sum_drag(w):
    """Momentum and energy that edges with a traction have taken, from the velocities at the end of the step.

    Reads    loaded [4]; drag [edge, b, c, j or i], impulses; u0, v0, u, v [b, j, i]
    Writes   taken [edge, 2], axial momentum and energy
    """
    j0, j1 = outer_rows(w.parts)
    for edge in range(4):
        w.taken[edge, 0], w.taken[edge, 1] = 0.0, 0.0
        at = w.loaded[edge]
        if at < 0:
            continue
        first, last = (j0, j1 + 1) if edge < 2 else (w.i0, w.i1 + 1)
        for place in range(first, last):
            j, i = (place, at) if edge < 2 else (at, place)
            for b in range(w.u.shape[0]):
                radial, axial = w.drag[edge, b, 0, place], w.drag[edge, b, 1, place]
                w.taken[edge, 0] += axial
                w.taken[edge, 1] += 0.5 * (radial * (w.u0[b, j, i] + w.u[b, j, i]) + axial * (w.v0[b, j, i] + w.v[b, j, i]))


@point
def own_rows(part, parts, rows):
    """First row and one past the last of a part, with all rows of the mesh beyond the active box: 0 to `rows`."""
    return 0 if part == 0 else parts[part], rows if part == parts.shape[0] - 2 else parts[part + 1]


@point
def velocity_at_edges(j, i, c, free, w):
    """Component c (0 radial, 1 axial) of the velocity that the edges allow vertex (j, i): its own away from edges, m/s."""
    for edge in range(2 * c, 2 * c + 2):  # those across this component, then those that hold it along them
        if (j if c else i) == w.constrained[edge]:
            return w.edge_velocity[edge]
        if (j if c else i) == w.pushing[edge]:
            return edge_normal_velocity(edge, True, w.edge_velocity[edge], free)
    for edge in range(6 - 2 * c, 8 - 2 * c):
        if (i if c else j) == w.constrained[edge]:
            return w.edge_velocity[edge]
    return free


@kernel
def constrain(part, w):
    """Prescribed velocity of constrained vertices: axis, walls, held edges, edges with a velocity, anvils that nothing leaves.

    The axis and walls along z take no axial momentum and do no work. A velocity across an edge goes before one along another.

    Reads    constrained [8], pushing [4], columns and rows, -1 for none; edge_velocity [8], m/s; mass, u0, v0 [b, j, i]
    Updates  u, v [b, j, i]
    Writes   walls [4, 2, j]: axial momentum and energy that each edge takes in a row
    """
    first, last = own_rows(part, w.parts, w.u.shape[1])
    for j in range(first, last):
        for edge in range(4):
            w.walls[edge, 0, j], w.walls[edge, 1, j] = 0.0, 0.0
        for b in range(w.u.shape[0]):
            for edge in range(2):
                at = max(w.constrained[edge], w.pushing[edge])
                if at < 0:
                    continue
                given = edge_normal_velocity(edge, w.pushing[edge] >= 0, w.edge_velocity[edge], w.u[b, j, at])
                impulse = w.mass[b, j, at] * (w.u[b, j, at] - given)
                w.walls[edge, 1, j] += 0.5 * impulse * (w.u0[b, j, at] + given)
                w.u[b, j, at] = given
                if w.constrained[4 + edge] == at and j != w.constrained[2] and j != w.constrained[3]:
                    given = w.edge_velocity[4 + edge]
                    impulse = w.mass[b, j, at] * (w.v[b, j, at] - given)
                    w.walls[edge, 0, j] += impulse
                    w.walls[edge, 1, j] += 0.5 * impulse * (w.v0[b, j, at] + given)
                    w.v[b, j, at] = given
            for edge in range(2, 4):
                if max(w.constrained[edge], w.pushing[edge]) != j:
                    continue
                for i in range(w.u.shape[2]):
                    given = edge_normal_velocity(edge, w.pushing[edge] >= 0, w.edge_velocity[edge], w.v[b, j, i])
                    impulse = w.mass[b, j, i] * (w.v[b, j, i] - given)
                    w.walls[edge, 0, j] += impulse
                    w.walls[edge, 1, j] += 0.5 * impulse * (w.v0[b, j, i] + given)
                    w.v[b, j, i] = given
                    if w.constrained[4 + edge] == j and i != w.constrained[0] and i != w.constrained[1]:
                        given = w.edge_velocity[4 + edge]
                        impulse = w.mass[b, j, i] * (w.u[b, j, i] - given)
                        w.walls[edge, 1, j] += 0.5 * impulse * (w.u0[b, j, i] + given)
                        w.u[b, j, i] = given


@kernel
def close_mass_flux(part, w):
    """Mass flux beyond the edges of the mesh: zero, in place of values left by the sweep along the other direction.

    Beyond an open edge along the direction of the sweep the flux of the edge is copied.

    Reads    mesh_box [4], rows j0, j1 and columns i0, i1 of the mesh
    Updates  flux_mass [b, j, i]
    """
    first, last = own_rows(part, w.parts, w.flux_mass.shape[1])
    j0, j1, i0, i1 = w.mesh_box[0], w.mesh_box[1], w.mesh_box[2], w.mesh_box[3]
    for b in range(w.flux_mass.shape[0]):
        if w.di == 1:
            for i in range(w.flux_mass.shape[2]):
                if part == 0:
                    w.flux_mass[b, j0 - 1, i] = 0.0
                if part == w.parts.shape[0] - 2:
                    w.flux_mass[b, j1, i] = 0.0
            for j in range(first, last):
                if w.opens_low:
                    w.flux_mass[b, j, i0 - 1] = w.flux_mass[b, j, i0]
                if w.opens_high:
                    w.flux_mass[b, j, i1 + 1] = w.flux_mass[b, j, i1]
        else:
            for j in range(first, last):
                w.flux_mass[b, j, i0 - 1] = 0.0
                w.flux_mass[b, j, i1] = 0.0
            for i in range(w.flux_mass.shape[2]):
                if w.opens_low and part == 0:
                    w.flux_mass[b, j0 - 1, i] = w.flux_mass[b, j0, i]
                if w.opens_high and part == w.parts.shape[0] - 2:
                    w.flux_mass[b, j1 + 1, i] = w.flux_mass[b, j1, i]
