"""Vertices that no full cell touches are held by the body that they belong to, and cut cells bear pressure beneath void.

The outermost layer of a body, in cells with void, has half of its mass at vertices outside of all full cells. No stress acts on
these in the direction of the surface's normal, since the traction there is that of void. They move with the vertices of full
cells inward of them, which take over their momentum (explanation/mixed-cells, equations 14 to 16). A step
with contact does not run these kernels.
"""

from math import sqrt

from hydro2d.jit import cell_rows, point, serial, vertex_rows
from hydro2d.kernels.boundaries import velocity_at_edges
from hydro2d.kernels.column_ranges import NOTHING, outer_rows
from hydro2d.kernels.mixed_scratch import HEAT
from hydro2d.kernels.vertex_forces import SMALLEST_SPEED
from hydro2d.mesh.fields import DMG, RHO
from hydro2d.mesh.grid import CM_IN, CM_OUT, VOL_R
from hydro2d.physics.contents import is_beside_gas, surface_weight
from hydro2d.physics.fracture import tension_limit
from hydro2d.physics.outer_vertices import (
    COLUMN,
    ROW,
    START_R,
    START_Z,
    TAKEN,
    WEIGHT,
    anchor,
    beyond_noise,
    borne_share,
    clearness,
    fullness,
    gain,
    gentleness,
    inward_step,
    is_beside_open_edge,
    is_free,
    is_plain_fluid,
    lost_by_hold,
    start_anchor,
)
from hydro2d.physics.traction import FREE_SURFACE, KIND, NORMAL_R, NORMAL_Z, smoothstep

#: distance up to which a vertex looks for the body inward, in cells; within it, a line crosses at most three lines of the mesh
REACH, CROSSINGS = 2.5, 3
#: columns of `hold`: outward normal at a held vertex, and the distance of its anchors in cells
OUT_R, OUT_Z, AWAY = range(3)
#: weight of an anchor below which it is left out; distance from a line of the mesh, in cells, up to which a point is on it
NO_WEIGHT, ON_LINE = 1e-12, 1e-9
#: sum of the weights of the cells inward of a cut cell from which no more are needed
ENOUGH = 1e-2


@point
def firmness(j, i, w):
    """Weight with which vertex (j, i) touches a full cell, and may hold others: 0 to 1."""
    j0, j1 = outer_rows(w.parts)
    if j < j0 or j > j1 or i < w.i0 or i > w.i1 or w.mass[0, j, i] == 0.0:
        return 0.0
    most = 0.0
    for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
        for column in range(max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3])):
            most = max(most, w.solid[row, column])
    return fullness(most)


@point
def outward(j, i, w):
    """(n_r, n_z, length) of the normal of the surface at a vertex: the mean of those of its cells with void, by filled share.

    The axis and walls are mirrors. A cell with a gas has none, nor has a vertex of a cell at an open edge, where it would tilt.
    """
    n_r, n_z, whole = 0.0, 0.0, 0.0
    if is_beside_open_edge(j, i, w.mesh_box, w.constrained):
        return 0.0, 0.0, 0.0
    for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
        row_r, row_z, row_whole = 0.0, 0.0, 0.0
        for column in range(max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3])):
            part = w.solid[row, column]
            if part > 0.0:
                row_whole += part
                if w.skin[KIND, row, column] == FREE_SURFACE and not is_beside_gas(row, column, w.gases, w.vof):
                    row_r += part * w.skin[NORMAL_R, row, column]
                    row_z += part * w.skin[NORMAL_Z, row, column]
        n_r, n_z, whole = n_r + row_r, n_z + row_z, whole + row_whole
    n_r = 0.0 if i == w.constrained[0] or i == w.constrained[1] else n_r
    n_z = 0.0 if j == w.constrained[2] or j == w.constrained[3] else n_z
    size = sqrt(n_r * n_r + n_z * n_z)
    if size == 0.0:
        return 0.0, 0.0, 0.0
    return n_r / size, n_z / size, size / whole


@point
def find_anchors(j, i, x, w):
    """(number of anchors of vertex (j, i), share of it that they hold, their distance in cells).

    A line runs inward from the vertex. Wherever it crosses a line of the mesh, the two vertices there hold the vertex by how
    near they are to the crossing and how firm they are, as far as those before have left it.

    Reads    hold [j, x, OUT_R to OUT_Z]
    Writes   anchors [j, x, ROW to WEIGHT, n], whose weights add up to 1
    """
    step_r, step_z = inward_step(j, i, w.hold[j, x, OUT_R], w.hold[j, x, OUT_Z], w.dr, w.dz)
    way_r, way_z = 1 if step_r > 0.0 else -1, 1 if step_z > 0.0 else -1
    every_r = 1.0 / abs(step_r) if abs(step_r) > NO_WEIGHT else 1e300
    every_z = 1.0 / abs(step_z) if abs(step_z) > NO_WEIGHT else 1e300
    n, left, away, past_r, past_z = 0, 1.0, 0.0, 1, 1
    for _ in range(CROSSINGS):
        at_r, at_z = past_r * every_r, past_z * every_z
        at = min(at_r, at_z)
        if at > REACH or left <= NO_WEIGHT:
            break
        if at_z <= at_r:
            off = at * abs(step_r)
            beside = off - int(off)
            row, column = j + way_z * past_z, i + way_r * int(off)
            row_1, column_1 = row, column + way_r
            past_z += 1
        else:
            off = at * abs(step_z)
            beside = off - int(off)
            row, column = j + way_z * int(off), i + way_r * past_r
            row_1, column_1 = row + way_z, column
            past_r += 1
        first = left * (1.0 - beside) * firmness(row, column, w) if beside < 1.0 else 0.0
        second = left * beside * firmness(row_1, column_1, w) if beside > 0.0 else 0.0
        if first > NO_WEIGHT:
            w.anchors[j, x, ROW, n], w.anchors[j, x, COLUMN, n], w.anchors[j, x, WEIGHT, n] = row, column, first
            n += 1
        if second > NO_WEIGHT:
            w.anchors[j, x, ROW, n], w.anchors[j, x, COLUMN, n], w.anchors[j, x, WEIGHT, n] = row_1, column_1, second
            n += 1
        away += at * (first + second)
        left -= first + second
    total = 0.0
    for k in range(n):
        total += w.anchors[j, x, WEIGHT, k]
    for k in range(n):
        w.anchors[j, x, WEIGHT, k] /= total
    return n, min(total, 1.0), away / total if total > 0.0 else 0.0


@vertex_rows
def find_held(j, w):
    """Vertices that no full cell touches and that the body inward holds, and the share of their mass that is held.

    Reads    mass [b, j, i]; solid [j, i]; skin [3, j, i]; vof [m, j, i]; the list of mixed cells
    Writes   held [j, i] for whole rows; held_count [j]; of the x-th of them held_columns, anchor_count [j, x], hold [j, x, 3],
             anchors [j, x, 3, n]
    """
    count, first, last = 0, NOTHING, 0
    for i in range(w.i0, w.i1 + 1):
        w.held[j, i] = 0.0
    for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
        if w.mixed_count[row] > 0:
            first = min(first, w.mixed[row, 0])
            last = max(last, w.mixed[row, w.mixed_count[row] - 1] + 1)
    for i in range(max(first, w.i0), min(last, w.i1) + 1):
        if w.mass[0, j, i] == 0.0:
            continue
        loose = 1.0 - firmness(j, i, w)
        if loose == 0.0:
            continue
        n_r, n_z, length = outward(j, i, w)
        if length == 0.0:
            continue
        w.hold[j, count, OUT_R], w.hold[j, count, OUT_Z] = n_r, n_z
        n, share, away = find_anchors(j, i, count, w)
        if n > 0:
            w.held[j, i] = loose * share * clearness(length)
            w.held_columns[j, count], w.anchor_count[j, count] = i, n
            w.hold[j, count, AWAY] = away
            count += 1
    w.held_count[j] = count


@point
def pull_of_body(j, x, w):
    """(largest velocity that the body may take from held vertex x as it parts, largest sound speed of the bodies there), m/s.

    The first is what the tensile strength takes in a step. It is the least of the bodies in the cells around the vertex (one
    without strength has none), and it acts on the layer, whose mass per area is the mean density of these cells times the width
    across.
    """
    i, least, density, cells, fastest = w.held_columns[j, x], 1e300, 0.0, 0, 0.0
    for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
        of_row = 0.0
        for column in range(max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3])):
            cells += 1
            for m in range(w.vof.shape[0]):
                if w.vof[m, row, column] > 0.0:
                    least = min(least, tension_limit(w.tension[m], w.fades[m], w.q[DMG, m, row, column]))
                    of_row += w.vof[m, row, column] * w.q[RHO, m, row, column]
                    fastest = max(fastest, sqrt(w.km[m, row, column] / w.q[RHO, m, row, column]))
        density += of_row
    across = 0.5 * (abs(w.hold[j, x, OUT_R]) * (w.dr[i - 1] + w.dr[i]) + abs(w.hold[j, x, OUT_Z]) * (w.dz[j - 1] + w.dz[j]))
    return least * w.dt * cells / (density * across), fastest


@point
def own_sinking(j, x, w):
    """Velocity towards its body, relative to its anchors, that the slope of the body's velocity gives held vertex x, m/s.

    The slope is that between the anchors and the point one cell further inward, at the beginning of the step; none where this
    does not lie between firm vertices.

    Reads    u0, v0 [b, j, i]; hold [j, x, 3], anchors [j, x, 3, n]
    """
    i, n_r, n_z = w.held_columns[j, x], w.hold[j, x, OUT_R], w.hold[j, x, OUT_Z]
    step_r, step_z = inward_step(j, i, n_r, n_z, w.dr, w.dz)
    way_r, way_z = 1 if step_r > 0.0 else -1, 1 if step_z > 0.0 else -1
    along_z, along_r, near = abs(step_z), abs(step_r), 0.0
    for k in range(w.anchor_count[j, x]):
        row, column, weight = anchor(j, x, k, w.anchors)
        along_z += weight * abs(row - j)
        along_r += weight * abs(column - i)
        near += weight * (n_r * w.u0[0, row, column] + n_z * w.v0[0, row, column])
    up, out = int(along_z + ON_LINE), int(along_r + ON_LINE)
    above, beside, firm, further = max(along_z - up, 0.0), max(along_r - out, 0.0), 1.0, 0.0
    for k in range(4):
        weight = (beside if k % 2 == 1 else 1.0 - beside) * (above if k // 2 == 1 else 1.0 - above)
        if weight > ON_LINE:
            row, column = j + way_z * (up + k // 2), i + way_r * (out + k % 2)
            firm *= firmness(row, column, w)
            further += weight * (n_r * w.u0[0, row, column] + n_z * w.v0[0, row, column])
    return firm * w.hold[j, x, AWAY] * (further - near)


@point
def let_go(j, x, w):
    """The velocity that the held share of held vertex x has to lose, and what it and its anchors start from.

    Writes   sinking [2, j, i]; anchored [11, j, i] there and at the anchors
    """
    i = w.held_columns[j, x]
    u, v = velocity_at_edges(j, i, 0, w.u[0, j, i], w), velocity_at_edges(j, i, 1, w.v[0, j, i], w)
    start_anchor(j, i, w.u[0], w.v[0], w.anchored)
    for k in range(w.anchor_count[j, x]):
        row, column, weight = anchor(j, x, k, w.anchors)
        start_anchor(row, column, w.u[0], w.v[0], w.anchored)
        u -= weight * velocity_at_edges(row, column, 0, w.u[0, row, column], w)
        v -= weight * velocity_at_edges(row, column, 1, w.v[0, row, column], w)
    inward = -(w.hold[j, x, OUT_R] * u + w.hold[j, x, OUT_Z] * v)
    most, sound = pull_of_body(j, x, w)
    lost = lost_by_hold(inward, beyond_noise(own_sinking(j, x, w), sound), most)
    if lost == 0.0:
        w.held[j, i] = 0.0
    elif most > 0.0:
        w.held[j, i] *= gentleness(inward, sound)
    free_r, free_z = is_free(j, i, w.constrained)
    w.sinking[0, j, i] = -lost * w.hold[j, x, OUT_R] if free_r else 0.0
    w.sinking[1, j, i] = -lost * w.hold[j, x, OUT_Z] if free_z else 0.0


@point
def take_over(j, x, upward, w):
    """Gives the mass and the momentum to be lost of the held share of held vertex x to its anchors above, or to the others.

    Updates  anchored [11, j, i] at the anchors; u, v [b, j, i] of anchors where an edge prescribes them, which the edge takes
    """
    i = w.held_columns[j, x]
    for k in range(w.anchor_count[j, x]):
        row, column, weight = anchor(j, x, k, w.anchors)
        if upward != (row > j):
            continue
        mass = weight * w.held[j, i] * w.mass[0, j, i]
        place = TAKEN if row > j else (TAKEN + 3 if row < j else TAKEN + 6)
        w.anchored[place, row, column] += mass
        w.anchored[place + 1, row, column] += mass * w.sinking[0, j, i]
        w.anchored[place + 2, row, column] += mass * w.sinking[1, j, i]
        free_r, free_z = is_free(row, column, w.constrained)
        if not free_r:
            w.u[0, row, column] += mass / w.mass[0, row, column] * w.sinking[0, j, i]
        if not free_z:
            w.v[0, row, column] += mass / w.mass[0, row, column] * w.sinking[1, j, i]


@point
def set_velocity(j, i, held_u, held_v, w):
    """Velocity of vertex (j, i): its own share gains as an anchor, the held one by what is given; edges keep theirs.

    Updates  u, v [b, j, i]
    """
    own_u, own_v = gain(j, i, w.held, w.mass[0], w.constrained, w.anchored)
    held = w.held[j, i]
    free_r, free_z = is_free(j, i, w.constrained)
    if free_r:
        u = w.anchored[START_R, j, i] + ((1.0 - held) * own_u + held * held_u)
        w.u[0, j, i] = u if abs(u) > SMALLEST_SPEED else 0.0
    if free_z:
        v = w.anchored[START_Z, j, i] + ((1.0 - held) * own_v + held * held_v)
        w.v[0, j, i] = v if abs(v) > SMALLEST_SPEED else 0.0


@point
def move_together(j, x, w):
    """Velocities of held vertex x and its anchors.

    Updates  u, v [b, j, i]
    """
    i = w.held_columns[j, x]
    u, v = -w.sinking[0, j, i], -w.sinking[1, j, i]
    for k in range(w.anchor_count[j, x]):
        row, column, weight = anchor(j, x, k, w.anchors)
        anchor_u, anchor_v = gain(row, column, w.held, w.mass[0], w.constrained, w.anchored)
        u += weight * anchor_u
        v += weight * anchor_v
        if w.held[row, column] == 0.0:
            set_velocity(row, column, 0.0, 0.0, w)
    set_velocity(j, i, u, v, w)


@serial
def hold_vertices(w):
    """Velocities of held vertices, which do not sink into their body, and of their anchors; momentum is kept.

    Reads    held [j, i]; held_columns, anchor_count [j, x], hold [j, x, 3], anchors [j, x, 3, n]; mass, u0, v0 [b, j, i];
             constrained [8], pushing [4], edge_velocity [8]
    Updates  u, v [b, j, i]
    Writes   anchored [11, j, i] at held vertices and their anchors; sinking [2, j, i] at held vertices
    """
    j0, j1 = outer_rows(w.parts)
    for phase in range(4):
        for k in range(j1 + 1 - j0):
            j = j1 - k if phase == 2 else j0 + k
            for x in range(w.held_count[j]):
                if phase == 0:
                    let_go(j, x, w)
                elif w.held[j, w.held_columns[j, x]] == 0.0:
                    continue
                elif phase == 3:
                    move_together(j, x, w)
                else:
                    take_over(j, x, phase == 1, w)


@vertex_rows
def heat_held_vertices(j, w):
    """Energy that holding a vertex has taken from the motion, by the velocities at the end of the step.

    Reads    u0, v0, u, v, mass [b, j, i]; held [j, i], sinking [2, j, i], anchored [11, j, i]; held_columns, anchor_count,
             anchors [j, x, 3, n]
    Writes   held_heat [j, i] at held vertices, J/kg
    """
    for x in range(w.held_count[j]):
        i = w.held_columns[j, x]
        if w.held[j, i] == 0.0:
            continue
        free_r, free_z = is_free(j, i, w.constrained)
        mean_u, mean_v = 0.5 * (w.u0[0, j, i] + w.u[0, j, i]), 0.5 * (w.v0[0, j, i] + w.v[0, j, i])
        heat = 0.0
        for k in range(w.anchor_count[j, x]):
            row, column, weight = anchor(j, x, k, w.anchors)
            u, v = gain(row, column, w.held, w.mass[0], w.constrained, w.anchored)
            apart_u = mean_u - 0.5 * (w.u0[0, row, column] + w.u[0, row, column])
            apart_v = mean_v - 0.5 * (w.v0[0, row, column] + w.v[0, row, column])
            heat += weight * ((w.sinking[0, j, i] - u) * apart_u if free_r else 0.0)
            heat += weight * ((w.sinking[1, j, i] - v) * apart_v if free_z else 0.0)
        w.held_heat[j, i] = w.held[j, i] * heat


@point
def heat_of_holding(j, i, w):
    """Gives the bodies of a cell, by mass, the cell's part of the heat of its held vertices.

    Updates  mix [j, HEAT, m]
    """
    if w.held[j, i] + w.held[j, i + 1] + w.held[j + 1, i] + w.held[j + 1, i + 1] == 0.0:
        return
    per_mass = 0.0
    for row in range(j, j + 2):
        of_row = 0.0
        for column in range(i, i + 2):
            if w.held[row, column] > 0.0:
                corner = w.metrics[CM_IN, i] if column == i else w.metrics[CM_OUT, i]
                of_row += corner * w.held_heat[row, column]
        per_mass += of_row
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0:
            w.mix[j, HEAT, m] += per_mass * w.q[RHO, m, j, i] * w.vof[m, j, i] * w.metrics[VOL_R, i] * w.dz[j]


# ------------------------------------------------------------------------------------------------ what a cut cell bears


@point
def borne_pressure(j, i, w):
    """Pressure half-way into the fluid in a cell with void, between that of the full cells of fluid inward of it and none, Pa.

    A body with strength has none: what its cut cells bear is small beside their stress, and the noise of a skin is not.
    """
    n_r, n_z, weight = w.skin[NORMAL_R, j, i], w.skin[NORMAL_Z, j, i], surface_weight(j, i, w.skin)
    if weight == 0.0:
        return 0.0
    size = sqrt(n_r * n_r + n_z * n_z)
    n_r, n_z = n_r / size, n_z / size
    across = abs(n_r) * w.dr[i] + abs(n_z) * w.dz[j]
    whole, push, away = 0.0, 0.0, 0.0
    for step in range(3):  # the rows below and above first: a mirror image adds the same two numbers
        row = j + (2 * step - 1 if step < 2 else 0)
        if row < w.mesh_box[0] or row >= w.mesh_box[1]:
            continue
        row_whole, row_push, row_away = 0.0, 0.0, 0.0
        for column in range(max(i - 1, w.mesh_box[2]), min(i + 2, w.mesh_box[3])):
            inward = n_r * (w.rc[i] - w.rc[column]) + n_z * (w.zc[j] - w.zc[row])
            if inward <= 0.0 or not is_plain_fluid(row, column, w.gases, w.strong, w.vof):
                continue
            along = across * inward / ((w.rc[i] - w.rc[column]) ** 2 + (w.zc[j] - w.zc[row]) ** 2)
            part = fullness(w.solid[row, column]) * (along * along) * (along * along)
            if part > 0.0:
                row_whole += part
                row_push += part * (w.p[row, column] + n_r * n_r * w.qr[row, column] + n_z * n_z * w.qz[row, column]
                                    + 2.0 * n_r * n_z * w.qrz[row, column])
                row_away += part * inward
        whole, push, away = whole + row_whole, push + row_push, away + row_away
    if whole == 0.0 or push <= 0.0:
        return 0.0
    share = borne_share(w.solid[j, i], away / whole, across)
    return weight * smoothstep(whole / ENOUGH) * share * push / whole


@cell_rows
def bear(j, w):
    """Pressures that cut cells next to void bear (`borne_pressure`).

    Reads    vof [m, j, i], gases, strong [m]; p, qr, qz, qrz, solid [j, i]; skin [3, j, i], the list of mixed cells
    Writes   borne [j, i]
    """
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        w.borne[j, i] = 0.0
        if w.skin[KIND, j, i] == FREE_SURFACE and is_plain_fluid(j, i, w.gases, w.strong, w.vof):
            w.borne[j, i] = borne_pressure(j, i, w)
