"""Velocities of under-filled nodes of a group, extrapolated from the cells of its body further inward.

A node whose group fills half of its dual cell or less is a slave: its velocity is the mean of the linear velocity fields of the
cells inward of it, extended to the node. All of this is continuous in the fractions (explanation/sliding, equation 5): the tie
fades in as the share falls from SURE to UNDERFILLED, and the weight of a cell fades out as its least filled vertex does so.
"""

from math import sqrt

from hydro2d.jit import kernel, not_inlined, point, vertex_rows
from hydro2d.kernels.column_ranges import NOTHING, first_row, outer_rows, past_row
from hydro2d.kernels.contact.contact_geometry import REACH
from hydro2d.mesh.fields import DMG, RHO
from hydro2d.mesh.grid import CM_IN, CM_OUT
from hydro2d.physics.contact_faces import dual_share, own_inward
from hydro2d.physics.traction import smoothstep

#: filled share of its dual cell up to which a node of a group is under-filled, and from which it is not
UNDERFILLED, SURE = 0.5, 0.6
#: sum of the weights of cells, or of vertices, from which no further ones are used
ENOUGH = 1e-3
#: vertices along an edge of the square of possible masters, their number, and the index of the other group's own vertex
SPAN = 2 * REACH + 1
MASTERS = SPAN * SPAN
TIED = MASTERS
#: most_squares of a gas, too light for any larger one
LEAST_SQUARES = 1.0
#: rows of `inward`
WEIGHT, SQUARES, OFF_R, OFF_Z = range(4)
#: reduction of the tie of two nodes that are tied to each other and have no other masters
SLACK = 1e-3


@point
def filled_share(g, row, column, hard, soft, w):
    """Share that group g fills of the dual cell of a vertex, 0 where it has no mass there or the mesh ends.

    hard, soft : shares of the cells [j, i] that the groups fill, with their gases or without
    """
    j0, j1, i0, i1 = w.mesh_box[0], w.mesh_box[1], w.mesh_box[2], w.mesh_box[3]
    if row < j0 or row > j1 or column < i0 or column > i1 or w.mass[g, row, column] == 0.0:
        return 0.0
    return dual_share(g, row, column, w.mesh_box, w.volume, w.metrics, hard, soft)


@point
def share_of_firm_mass(g, j, i, w):
    """Share of the mass of group g at vertex (j, i) that is not that of a gas."""
    firm, gas = 0.0, 0.0
    for m in range(w.group.shape[0]):
        if w.group[m] == g:
            for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
                for column in range(max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3])):
                    if w.vof[m, row, column] > 0.0:
                        corner = w.volume[row, column] * (w.metrics[CM_OUT, column] if column < i else w.metrics[CM_IN, column])
                        mass = corner * w.vof[m, row, column] * w.q[RHO, m, row, column]
                        firm += 0.0 if w.gases[m] else mass
                        gas += mass if w.gases[m] else 0.0
    return firm / (firm + gas) if gas > 0.0 else 1.0


@point
def sureness(share):
    """Weight with which a node or a cell with this filled share counts as filled: 0 up to UNDERFILLED, 1 from SURE on."""
    return smoothstep((share - UNDERFILLED) / (SURE - UNDERFILLED))


@point
def in_debris(g, j, i, w):
    """Whether failed material of the group other than g fills a cell around vertex (j, i) by half or more."""
    failed = False
    for m in range(w.group.shape[0]):
        if w.group[m] != g:
            for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
                for column in range(max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3])):
                    failed = failed or (w.vof[m, row, column] >= 0.5 and w.q[DMG, m, row, column] >= 1.0)
    return failed


@kernel
def find_filled(part, w):
    """filled_share of both groups at all vertices that can be masters of a contact node.

    Reads    hard, soft [j, i]; firm, mass [b, j, i]; the list of contact nodes
    Writes   filled, firmly [b, j, i] within REACH of contact nodes, in the mesh
    """
    j0, j1 = outer_rows(w.parts)
    first, last = first_row(part, w.parts, REACH), past_row(part, w.parts, REACH + 1)
    for j in range(max(first, w.mesh_box[0]), min(last, w.mesh_box[1] + 1)):
        lo, hi = NOTHING, 0
        for row in range(max(j - REACH, j0), min(j + REACH, j1) + 1):
            if w.contact_node_count[row] > 0:
                lo = min(lo, w.contact_nodes[row, 0])
                hi = max(hi, w.contact_nodes[row, w.contact_node_count[row] - 1])
        for i in range(max(lo - REACH, w.mesh_box[2]), min(hi + REACH, w.mesh_box[3]) + 1):
            for g in range(2):
                w.filled[g, j, i] = filled_share(g, j, i, w.hard, w.soft, w)
                w.firmly[g, j, i] = filled_share(g, j, i, w.firm[1], w.firm[0], w)


@not_inlined
def cell_weight(j, i, row, column, inward_r, inward_z, share, filled, w):
    """Weight of cell (row, column) of a group for the slave (j, i): (share cos/distance)^4 times its `sureness`.

    The cosine is that of the angle between the cell's direction and the inward normal.

    share, filled : of the cells [j, i] and of the vertices' dual cells that the group fills, with its gases or without
    """
    if row < w.mesh_box[0] or row >= w.mesh_box[1] or column < w.mesh_box[2] or column >= w.mesh_box[3]:
        return 0.0
    part = share[row, column]
    y, x = row - j + 0.5, column - i + 0.5
    along = part * (inward_r * x + inward_z * y) / (x * x + y * y)
    if part <= UNDERFILLED or along <= 0.0:
        return 0.0
    least = min(min(filled[row, column], filled[row, column + 1]), min(filled[row + 1, column], filled[row + 1, column + 1]))
    least = min(least, 1.0)
    return sureness(part) * sureness(least) * (along * along) * (along * along)


@not_inlined
def weigh_cells(j, i, reach, inward_r, inward_z, share, filled, w):
    """Weights of the cells around the slave (j, i), its offsets from their middles, in cells, and the sums of the squares of
    their vertices' weights.

    Writes   inward [j, WEIGHT to OFF_Z, n], the places of cells row by row
    """
    n = 0
    for row in range(j - reach, j + reach):
        for column in range(i - reach, i + reach):
            weight = cell_weight(j, i, row, column, inward_r, inward_z, share, filled, w)
            w.inward[j, WEIGHT, n] = weight
            if weight != 0.0:
                a = (w.r[i] - 0.5 * (w.r[column] + w.r[column + 1])) / (w.r[column + 1] - w.r[column])
                b = (w.z[j] - 0.5 * (w.z[row] + w.z[row + 1])) / (w.z[row + 1] - w.z[row])
                w.inward[j, SQUARES, n] = 0.25 + a * a + b * b
                w.inward[j, OFF_R, n] = a
                w.inward[j, OFF_Z, n] = b
            n += 1


@not_inlined
def extend_cells(x, g, j, reach, least_squares, most_squares, factor, w):
    """Adds, with the total weight `factor`, the linear fields of cells inward whose vertex weights have a sum of squares above
    least_squares and up to most_squares; returns the share of `factor` that is used.

    The sum of squares multiplies the stiffness of the slave's cells as the masters' mass feels it, so the time step bounds it:
    with a least_squares above 0 the gradients are reduced to that sum.

    Reads    inward [j, WEIGHT to OFF_Z, n]
    Updates  weights [x, g, n]
    """
    whole = 0.0
    for run in range(2):
        scale = factor * smoothstep(whole / ENOUGH) / whole if whole > 0.0 else 0.0
        for place in range(4 * reach * reach):
            weight, squares = w.inward[j, WEIGHT, place], w.inward[j, SQUARES, place]
            if weight == 0.0 or squares <= least_squares or squares > most_squares:
                continue
            whole += weight if run == 0 else 0.0
            if run == 1:
                dj, di = place // (2 * reach) - reach, place % (2 * reach) - reach
                a, b = w.inward[j, OFF_R, place], w.inward[j, OFF_Z, place]
                shrink = sqrt((least_squares - 0.25) / (squares - 0.25)) if least_squares > 0.0 else 1.0
                for n in range(4):
                    along = (a if n % 2 == 1 else -a) + (b if n // 2 == 1 else -b)
                    w.weights[x, g, SPAN * (dj + REACH + n // 2) + di + REACH + n % 2] += scale * weight * (
                        0.25 + 0.5 * shrink * along)
    return smoothstep(whole / ENOUGH)


@not_inlined
def extend_vertices(x, g, j, i, reach, inward_r, inward_z, filled, factor, w):
    """Adds, with the total weight `factor`, the velocities of single vertices inward; returns the share of `factor` used.

    Updates  weights [x, g, n]
    """
    whole = 0.0
    for run in range(2):
        scale = factor * smoothstep(whole / ENOUGH) / whole if whole > 0.0 else 0.0
        for dj in range(-reach, reach + 1):
            for di in range(-reach, reach + 1):
                row, column = j + dj, i + di
                if (dj == 0 and di == 0) or not (
                        w.mesh_box[0] <= row <= w.mesh_box[1] and w.mesh_box[2] <= column <= w.mesh_box[3]):
                    continue
                share = filled[row, column]
                along = share * (inward_r * di + inward_z * dj) / (di * di + dj * dj)
                if share <= UNDERFILLED or along <= 0.0:
                    continue
                weight = sureness(share) * (along * along) * (along * along)
                if run == 0:
                    whole += weight
                else:
                    w.weights[x, g, SPAN * (dj + REACH) + di + REACH] += scale * weight
    return smoothstep(whole / ENOUGH)


@not_inlined
def extend(x, g, j, i, share, filled, most_squares, factor, w):
    """Adds, with the total weight `factor`, all masters of the slave of group g in slot x.

    These are cells that most_squares allows; where there are none (or hardly any, ENOUGH), cells with a reduced gradient, then
    vertices, and finally the other group's velocity at the node.

    share, filled : of the cells [j, i] and of the vertices' dual cells that the group fills, with its gases or without

    Updates  weights [x, g, n]
    """
    sign = 1.0 if g == 0 else -1.0
    inward_r, inward_z = sign * w.contact_normal[0, 0, j, i], sign * w.contact_normal[0, 1, j, i]
    own_r, own_z = own_inward(j, i, w.mesh_box, w.constrained, share)
    if own_r != 0.0 or own_z != 0.0:
        inward_r, inward_z = own_r, own_z
    reach = REACH - 1 if in_debris(g, j, i, w) else REACH
    weigh_cells(j, i, reach, inward_r, inward_z, share, filled, w)
    left = factor * (1.0 - extend_cells(x, g, j, reach, 0.0, most_squares, factor, w))
    if left > 0.0:
        left *= 1.0 - extend_cells(x, g, j, reach, most_squares, 1e300, left, w)
    if left > 0.0:
        left *= 1.0 - extend_vertices(x, g, j, i, reach - 1, inward_r, inward_z, filled, left, w)
    if left > 0.0:
        w.weights[x, g, TIED] += left


@point
def tied_weight(x, g, w):
    """Weight of the other group's velocity at the node for the slave of group g in slot x."""
    last = w.masters[x, g] - 1
    return w.weights[x, g, last] if last >= 0 and w.where[x, g, last] == TIED else 0.0


@vertex_rows
def find_extensions(j, w):
    """Slaves among the contact nodes, the strength of their ties, and their masters with weights.

    A slave is tied to the mean of the linear fields of cells inward of it (`extend`). A crumb within failed material of the
    other group looks two vertices away, others three. Ties of two nodes to each other are reduced by SLACK, so that no master
    with hardly any weight holds both of them.

    A gas is as good as void to the other bodies of its group: the mass that they have at a vertex is tied to cells that they
    fill themselves, and only the gas's own mass looks into the gas. A vertex with both is tied to either by its share of the
    mass. A vertex in the gas that held the edge of a solid would be thrown off by it.

    Reads    first_slot [j], the slot of a row's first contact node; contact_normal [3, 2, j, i]; hard, soft [j, i];
             firm, filled, firmly [b, j, i]; vof [m, j, i]; q (rho, dmg) [k, m, j, i]
    Writes   strength [x, b], 0 for a node that moves by itself to 1; masters [x, b], how many; where [x, b, n], their places
             SPAN (dj + REACH) + (di + REACH), or TIED; weights [x, b, n], which add up to 1
    Scratch  inward [j, 4, n]
    """
    for k in range(w.contact_node_count[j]):
        i, x = w.contact_nodes[j, k], w.first_slot[j] + k
        for g in range(2):
            w.masters[x, g] = 0
            firm = share_of_firm_mass(g, j, i, w)
            w.strength[x, g] = 1.0 - sureness(w.filled[g, j, i])
            if w.strength[x, g] == 0.0:
                continue
            for n in range(MASTERS + 1):
                w.weights[x, g, n] = 0.0
            if firm > 0.0:
                extend(x, g, j, i, w.firm[g], w.firmly[g], w.most_squares, firm, w)
            if firm < 1.0:
                extend(x, g, j, i, w.hard if g == 1 else w.soft, w.filled[g], LEAST_SQUARES, 1.0 - firm, w)
            count = 0
            for n in range(MASTERS + 1):
                weight = w.weights[x, g, n]
                if weight != 0.0:
                    w.where[x, g, count] = n
                    w.weights[x, g, count] = weight
                    count += 1
            w.masters[x, g] = count
        slack = SLACK * tied_weight(x, 0, w) * tied_weight(x, 1, w)
        for g in range(2):
            w.strength[x, g] *= 1.0 - slack
