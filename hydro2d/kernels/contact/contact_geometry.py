"""Geometry of the contact of two body groups, each with its own velocity: contact nodes, face apertures and normals.

Group 1 are the hard bodies, group 0 the soft ones. A vertex at which both have mass is a contact node; the cells around contact
nodes are contact-interface cells. The kernels of contact work in the columns contact_columns[j] of every row, the smallest
range that contains its contact-interface cells. Elsewhere one group is alone and the other kernels apply (explanation/sliding,
contact).

A face has at either end an aperture of the hard group, aperture[end, j, i], which is the weight w of explanation/sliding,
equation 1; that of the soft group is 1 minus it.
"""

from math import sqrt

from hydro2d.jit import point, serial, vertex_rows
from hydro2d.kernels.column_ranges import outer_rows, union
from hydro2d.physics.contact_faces import GAP, end_apertures, known, weights_beside
from hydro2d.physics.edges import is_constrained
from hydro2d.physics.traction import FILM, smoothstep

#: rows of `line`: normal of the hard side in the unit square, its constant, hard share of the solids; slopes, down the hard
#: bodies' fraction and up that of the soft ones; weights with which the fluxes of the soft and of the hard group come from
#: interfaces nested hard bodies first, the rest soft bodies first
LINE_R, LINE_Z, CONSTANT, SHARE, HARD_R, HARD_Z, SOFT_R, SOFT_Z, SOFT_AFTER, HARD_FIRST = range(10)

#: share of the solids of a cell from which a group counts in full in the apertures of its faces
SLIVER = 0.005

#: largest distance, in vertices, from a node to the part of its body with which it moves
REACH = 3


@vertex_rows
def find_contact_nodes(j, w):
    """Contact nodes of every row, and the fractions of hard and of soft bodies in the cells near hard ones.

    Reads    group_ranges[1] [n, j, 2], the columns near hard bodies; mass [b, j, i]; vof [m, j, i]; group [m]
    Writes   contact_node_count [j], contact_nodes [j, k] (columns, ascending); hard, soft [j, i]; zero in heat [b, j, i];
             heated_columns [j, 2], the cells around vertices that can be masters of a contact node
    """
    j0, j1 = outer_rows(w.parts)
    count = 0
    lo, hi = union(w.group_ranges[1, 0], j - REACH - 2, j + REACH + 2)
    for i in range(max(lo - REACH - 1, w.mesh_box[2]), min(hi + REACH + 2, w.mesh_box[3] + 1)):
        for g in range(2):
            w.heat[g, j, i] = 0.0
    for i in range(max(w.group_ranges[1, 1, j, 0], w.mesh_box[2]), min(w.group_ranges[1, 1, j, 1] + 1, w.mesh_box[3] + 1)):
        if w.mass[0, j, i] > 0.0 and w.mass[1, j, i] > 0.0:
            w.contact_nodes[j, count] = i
            count += 1
    w.contact_node_count[j] = count
    lo, hi = union(w.group_ranges[1, 0], j - REACH - 1, j + REACH + 2)
    w.heated_columns[j, 0] = max(lo - REACH - 1, w.mesh_box[2])
    w.heated_columns[j, 1] = min(hi + REACH + 1, w.mesh_box[3])
    if j < j1:
        lo, hi = union(w.group_ranges[1, 0], j - 2, j + 3)
        lo, hi = max(lo - 2, w.mesh_box[2]), min(hi + 2, w.mesh_box[3])
        for i in range(lo, hi):
            w.hard[j, i] = 0.0
            w.soft[j, i] = 0.0
            w.firm[0, j, i] = 0.0
            w.firm[1, j, i] = 0.0
        for m in range(w.vof.shape[0]):
            for i in range(lo, hi):
                if w.group[m] == 1:
                    w.hard[j, i] += w.vof[m, j, i]
                else:
                    w.soft[j, i] += w.vof[m, j, i]
                if not w.gases[m]:
                    w.firm[w.group[m], j, i] += w.vof[m, j, i]


@serial
def number_nodes(w):
    """Slot of every row's first contact node and, after the last row, the number of slots.

    Reads    contact_node_count [j], contact nodes
    Writes   first_slot [j]
    """
    j0, j1 = outer_rows(w.parts)
    w.first_slot[j0] = 0
    for j in range(j0, j1 + 1):
        w.first_slot[j + 1] = w.first_slot[j] + w.contact_node_count[j]


@point
def face_aperture(j, i, x0, y0, x1, y1, w):
    """(solid, apertures of the hard side at both ends) of the edge (x0, y0) to (x1, y1) of the unit square of cell (j, i).

    A group with less than SLIVER of the solids counts as if it were not there, ever more the less it is: the faces of a body
    that ends on a mesh line are the body's, and so they are when a breath of the other group is beyond the line. Of a gas, a
    FILM counts as if it were not there.
    """
    if not w.contact_columns[j, 0] <= i < w.contact_columns[j, 1]:
        total = w.hard[j, i] + w.soft[j, i]
        share = w.hard[j, i] / total if total > 0.0 else 0.0
        return (1.0 if total > 0.0 else 0.0), share, share
    share = w.line[SHARE, j, i]
    if share < 0.0:
        return 0.0, 0.0, 0.0
    n_r, n_z, constant = w.line[LINE_R, j, i], w.line[LINE_Z, j, i], w.line[CONSTANT, j, i]
    if n_r == 0.0 and n_z == 0.0:
        return 1.0, share, share
    first, last = end_apertures(constant - (n_r * x0 + n_z * y0), constant - (n_r * x1 + n_z * y1))
    total = w.hard[j, i] + w.soft[j, i]
    of_hard = min(w.hard[j, i] - w.firm[1, j, i], FILM) / total
    of_soft = min(w.soft[j, i] - w.firm[0, j, i], FILM) / total
    low, high = smoothstep((share - of_hard) / SLIVER), smoothstep((1.0 - share - of_soft) / SLIVER)
    return 1.0, 1.0 - high * (1.0 - low * first), 1.0 - high * (1.0 - low * last)


@vertex_rows
def face_apertures(j, w):
    """Apertures of the hard group on the faces around contact nodes, and the normals and contact at these nodes.

    The aperture of a face is the mean of those by the lines of both neighbours. A normal is the mean of the four cells' slopes,
    from hard to soft, along the axis and along walls: of f_hard - f_soft, of f_hard, and of -f_soft, which differ near void.
    Groups touch where a cell contains both and no more than GAP of void, or where a full cell of one is a neighbour of a full
    cell of the other.

    Reads    contact_columns [j, 2], line [10, j, i], hard, soft [j, i], mass [b, j, i], contact_node_count [j],
             contact_nodes [j, k]
    Writes   aperture_r, aperture_z [end, j, i]; contact_normal [3, 2, j, i], touch [j, i] at contact nodes
    """
    j0, j1 = outer_rows(w.parts)
    if j < j1:
        for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1] + 1):
            solid_l, low_l, high_l = 0.0, 0.0, 0.0
            solid_r, low_r, high_r = 0.0, 0.0, 0.0
            if i > w.mesh_box[2]:
                solid_l, low_l, high_l = face_aperture(j, i - 1, 1.0, 0.0, 1.0, 1.0, w)
            if i < w.mesh_box[3]:
                solid_r, low_r, high_r = face_aperture(j, i, 0.0, 0.0, 0.0, 1.0, w)
            if solid_l > 0.0 and solid_r > 0.0:
                solid_l, solid_r = weights_beside(j, i - 1, j, i, w.hard, w.soft, w.firm)
            number = max(solid_l + solid_r, 1.0)
            low = (solid_l * low_l + solid_r * low_r) / number
            high = (solid_l * high_l + solid_r * high_r) / number
            w.aperture_r[0, j, i] = known(low, w.mass[0, j, i], w.mass[1, j, i])
            w.aperture_r[1, j, i] = known(high, w.mass[0, j + 1, i], w.mass[1, j + 1, i])
    lo, hi = union(w.contact_columns, max(j - 1, j0), min(j + 1, j1))
    for i in range(lo, hi):
        solid_b, in_b, out_b = 0.0, 0.0, 0.0
        solid_t, in_t, out_t = 0.0, 0.0, 0.0
        if j > w.mesh_box[0]:
            solid_b, in_b, out_b = face_aperture(j - 1, i, 0.0, 1.0, 1.0, 1.0, w)
        if j < w.mesh_box[1]:
            solid_t, in_t, out_t = face_aperture(j, i, 0.0, 0.0, 1.0, 0.0, w)
        if solid_b > 0.0 and solid_t > 0.0:
            solid_b, solid_t = weights_beside(j - 1, i, j, i, w.hard, w.soft, w.firm)
        number = max(solid_b + solid_t, 1.0)
        w.aperture_z[0, j, i] = known((solid_b * in_b + solid_t * in_t) / number, w.mass[0, j, i], w.mass[1, j, i])
        w.aperture_z[1, j, i] = known((solid_b * out_b + solid_t * out_t) / number, w.mass[0, j, i + 1], w.mass[1, j, i + 1])
    for k in range(w.contact_node_count[j]):
        i = w.contact_nodes[j, k]
        hard_r, hard_z, soft_r, soft_z = 0.0, 0.0, 0.0, 0.0
        both, full_hard, full_soft = 1.0, 0, 0
        for row in range(max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1])):
            for column in range(max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3])):
                hard_r += w.line[HARD_R, row, column]
                hard_z += w.line[HARD_Z, row, column]
                soft_r += w.line[SOFT_R, row, column]
                soft_z += w.line[SOFT_Z, row, column]
                h, s = w.hard[row, column], w.soft[row, column]
                if h > 0.0 and s > 0.0:
                    both = min(both, 1.0 - (h + s))
                full_hard += 1 if h > 1.0 - GAP else 0
                full_soft += 1 if s > 1.0 - GAP else 0
        constrained_r, constrained_z = is_constrained(j, i, w.constrained)
        free_r, free_z = 0.0 if constrained_r else 1.0, 0.0 if constrained_z else 1.0
        for way in range(3):
            n_r = free_r * ((hard_r if way != 2 else 0.0) + (soft_r if way != 1 else 0.0))
            n_z = free_z * ((hard_z if way != 2 else 0.0) + (soft_z if way != 1 else 0.0))
            size = sqrt(n_r * n_r + n_z * n_z)
            w.contact_normal[way, 0, j, i] = n_r / size if size > 0.0 else 0.0
            w.contact_normal[way, 1, j, i] = n_z / size if size > 0.0 else 0.0
        w.touch[j, i] = 1.0 if both <= GAP or (full_hard > 0 and full_soft > 0) else 0.0
