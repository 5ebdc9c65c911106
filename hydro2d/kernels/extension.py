"""How an under-filled node of a group moves: as its body inward of there does.

A node whose group fills half of its dual cell or less is a slave: its velocity is the mean of the linear fields that the cells
inward of it carry to its place. Every part of that is continuous in what fills the cells (explanation/sliding, equation 5): the
tie fades in as the share falls from SURE to UNDERFILLED, and a cell counts by how much its least filled vertex is above that.
"""

from math import sqrt

from hydro2d.jit import apart, kernel, point
from hydro2d.kernels.column_ranges import NOTHING, first_row, outer_rows, past_row
from hydro2d.kernels.contact_geometry import REACH
from hydro2d.physics.contact import dual_share
from hydro2d.physics.traction import smoothstep

#: share of its dual cell up to which a node of a group is under-filled, and from which it is not
UNDERFILLED, SURE = 0.5, 0.6
#: sum of the weights of cells, or of vertices, from which nothing further away is asked
ENOUGH = 1e-3
#: vertices along an edge of the square of possible masters, and how many there are; then the other group's own vertex
SPAN = 2 * REACH + 1
MASTERS = SPAN * SPAN
TIED = MASTERS
#: by how much two nodes let go that are tied to each other and have no other masters
SLACK = 1e-3


@point
def filled_share(g, row, column, mesh_box, volume, metrics, hard, soft, mass):
    """Share that group g fills of the dual cell of a vertex, 0 where it has no mass there or the mesh ends."""
    if row < mesh_box[0] or row > mesh_box[1] or column < mesh_box[2] or column > mesh_box[3] or mass[g, row, column] == 0.0:
        return 0.0
    return dual_share(g, row, column, mesh_box, volume, metrics, hard, soft)


@point
def sureness(share):
    """How much a node or a cell that is filled so far counts as filled: 0 up to UNDERFILLED, 1 from SURE on."""
    return smoothstep((share - UNDERFILLED) / (SURE - UNDERFILLED))


@point
def in_debris(g, j, i, mesh_box, group, vof, dmg):
    """Whether material of the group other than g that has failed fills a cell around vertex (j, i) by half or more."""
    found = False
    for m in range(group.shape[0]):
        if group[m] != g:
            for row in range(max(j - 1, mesh_box[0]), min(j + 1, mesh_box[1])):
                for column in range(max(i - 1, mesh_box[2]), min(i + 1, mesh_box[3])):
                    found = found or (vof[m, row, column] >= 0.5 and dmg[m, row, column] >= 1.0)
    return found


@kernel
def find_filled(part, parts, mesh_box, volume, metrics, contact_node_count, contact_nodes, hard, soft, mass, filled):
    """filled_share of both groups at all vertices from which a contact node can be extended.

    Reads    hard, soft [j, i]; mass [b, j, i]; the list of contact nodes of rows j0 to j1
    Writes   filled [b, j, i] within REACH of contact nodes, in the mesh
    """
    j0, j1 = outer_rows(parts)
    for j in range(max(first_row(part, parts, REACH), mesh_box[0]), min(past_row(part, parts, REACH + 1), mesh_box[1] + 1)):
        lo, hi = NOTHING, 0
        for row in range(max(j - REACH, j0), min(j + REACH, j1) + 1):
            if contact_node_count[row] > 0:
                lo = min(lo, contact_nodes[row, 0])
                hi = max(hi, contact_nodes[row, contact_node_count[row] - 1])
        for i in range(max(lo - REACH, mesh_box[2]), min(hi + REACH, mesh_box[3]) + 1):
            for g in range(2):
                filled[g, j, i] = filled_share(g, j, i, mesh_box, volume, metrics, hard, soft, mass)


@apart
def cell_weight(g, j, i, row, column, inward_r, inward_z, mesh_box, hard, soft, filled):
    """Weight of cell (row, column) of group g for the slave (j, i): (share cos/distance)^4, as far as all of it counts.

    The cosine is that between its direction and the normal inwards.
    """
    if row < mesh_box[0] or row >= mesh_box[1] or column < mesh_box[2] or column >= mesh_box[3]:
        return 0.0
    part = hard[row, column] if g == 1 else soft[row, column]
    y, x = row - j + 0.5, column - i + 0.5
    along = part * (inward_r * x + inward_z * y) / (x * x + y * y)
    if part <= UNDERFILLED or along <= 0.0:
        return 0.0
    least = min(min(filled[g, row, column], filled[g, row, column + 1]),
                min(filled[g, row + 1, column], filled[g, row + 1, column + 1]))
    least = min(least, 1.0)
    return sureness(part) * sureness(least) * (along * along) * (along * along)


@apart
def extend_cells(x, g, j, i, reach, inward_r, inward_z, mesh_box, least_squares, most_squares, factor, r, z, hard, soft,
                 filled, weights):
    """Adds the linear fields of the cells inward whose weights have squares that sum up to more than least_squares and to no
    more than most_squares, together with the weight `factor`; returns the share of it that is used.

    The squares are the stiffness that the slave's cells have for the masters' mass, and the time step bounds them: with a
    least_squares above 0 the gradients are reduced to that sum.

    Updates  weights [x, g, n]
    """
    whole = 0.0
    for run in range(2):
        scale = factor * smoothstep(whole / ENOUGH) / whole if whole > 0.0 else 0.0
        for dj in range(-reach, reach):
            for di in range(-reach, reach):
                row, column = j + dj, i + di
                w = cell_weight(g, j, i, row, column, inward_r, inward_z, mesh_box, hard, soft, filled)
                if w == 0.0:
                    continue
                a = (r[i] - 0.5 * (r[column] + r[column + 1])) / (r[column + 1] - r[column])
                b = (z[j] - 0.5 * (z[row] + z[row + 1])) / (z[row + 1] - z[row])
                squares = 0.25 + a * a + b * b
                if squares <= least_squares or squares > most_squares:
                    continue
                whole += w if run == 0 else 0.0
                if run == 1:
                    shrink = sqrt((least_squares - 0.25) / (squares - 0.25)) if least_squares > 0.0 else 1.0
                    for n in range(4):
                        along = (a if n % 2 == 1 else -a) + (b if n // 2 == 1 else -b)
                        weights[x, g, SPAN * (dj + REACH + n // 2) + di + REACH + n % 2] += scale * w * (
                            0.25 + 0.5 * shrink * along)
    return smoothstep(whole / ENOUGH)


@apart
def extend_vertices(x, g, j, i, reach, inward_r, inward_z, mesh_box, factor, filled, weights):
    """Adds the velocities of single vertices inward, which together have the weight `factor`; returns the share of it used.

    Updates  weights [x, g, n]
    """
    whole = 0.0
    for run in range(2):
        scale = factor * smoothstep(whole / ENOUGH) / whole if whole > 0.0 else 0.0
        for dj in range(-reach, reach + 1):
            for di in range(-reach, reach + 1):
                row, column = j + dj, i + di
                if (dj == 0 and di == 0) or not (
                        mesh_box[0] <= row <= mesh_box[1] and mesh_box[2] <= column <= mesh_box[3]):
                    continue
                share = filled[g, row, column]
                along = share * (inward_r * di + inward_z * dj) / (di * di + dj * dj)
                if share <= UNDERFILLED or along <= 0.0:
                    continue
                w = sureness(share) * (along * along) * (along * along)
                if run == 0:
                    whole += w
                else:
                    weights[x, g, SPAN * (dj + REACH) + di + REACH] += scale * w
    return smoothstep(whole / ENOUGH)


@point
def tied_weight(x, g, number, where, weights):
    """Weight that the other group's velocity at its node has for the slave of group g in slot x."""
    last = number[x, g] - 1
    return weights[x, g, last] if last >= 0 and where[x, g, last] == TIED else 0.0


@kernel
def find_extensions(part, parts, mesh_box, most_squares, r, z, contact_node_count, contact_nodes, first_slot, contact_normal,
                    hard, soft, filled, group, vof, dmg, strength, masters, where, weights):
    """Which contact nodes are slaves, how firmly they are tied, and to what.

    To the mean of the linear fields of cells that most_squares allows; where there are none (or hardly any, ENOUGH), of cells
    with a reduced gradient, then to vertices, and in the end to the other group's velocity at the node. A crumb within failed
    material of the other group asks two vertices away, others three. Two nodes that are tied to each other let go by SLACK, so
    that no master with hardly any weight holds both of them.

    Reads    first_slot [j], the slot of a row's first contact node; contact_normal [3, 2, j, i]; hard, soft [j, i];
             filled [b, j, i]; vof, dmg [m, j, i]
    Writes   strength [x, b], 0 for a node that moves by itself to 1; masters [x, b], how many; where [x, b, n], their places
             SPAN (dj + REACH) + (di + REACH), or TIED; weights [x, b, n], which add up to 1
    """
    for j in range(parts[part], past_row(part, parts, 1)):
        for k in range(contact_node_count[j]):
            i, x = contact_nodes[j, k], first_slot[j] + k
            for g in range(2):
                masters[x, g] = 0
                strength[x, g] = 1.0 - sureness(filled[g, j, i])
                if strength[x, g] == 0.0:
                    continue
                for n in range(MASTERS + 1):
                    weights[x, g, n] = 0.0
                sign = 1.0 if g == 0 else -1.0
                inward_r, inward_z = sign * contact_normal[0, 0, j, i], sign * contact_normal[0, 1, j, i]
                reach = REACH - 1 if in_debris(g, j, i, mesh_box, group, vof, dmg) else REACH
                left = 1.0 - extend_cells(x, g, j, i, reach, inward_r, inward_z, mesh_box, 0.0, most_squares, 1.0, r, z, hard,
                                          soft, filled, weights)
                if left > 0.0:
                    left *= 1.0 - extend_cells(x, g, j, i, reach, inward_r, inward_z, mesh_box, most_squares, 1e300, left, r,
                                               z, hard, soft, filled, weights)
                if left > 0.0:
                    used = extend_vertices(x, g, j, i, reach - 1, inward_r, inward_z, mesh_box, left, filled, weights)
                    weights[x, g, TIED] = left * (1.0 - used)
                found = 0
                for n in range(MASTERS + 1):
                    w = weights[x, g, n]
                    if w != 0.0:
                        where[x, g, found] = n
                        weights[x, g, found] = w
                        found += 1
                masters[x, g] = found
            slack = SLACK * tied_weight(x, 0, masters, where, weights) * tied_weight(x, 1, masters, where, weights)
            for g in range(2):
                strength[x, g] *= 1.0 - slack
