"""The line in every cell of a contact between its hard and its soft side.

Without void it is Youngs' line. Where there is void around, a surface may end or have a corner, and several lines are tried:
the better one fits what is in the neighbouring cells, the more it counts (explanation/sliding, contact).
"""

from hydro2d.jit import cell_rows, not_inlined, point
from hydro2d.kernels.contact.contact_geometry import (
    CONSTANT,
    HARD_FIRST,
    HARD_R,
    HARD_Z,
    LINE_R,
    LINE_Z,
    SHARE,
    SOFT_AFTER,
    SOFT_R,
    SOFT_Z,
)
from hydro2d.physics.contact_faces import GAP
from hydro2d.physics.interfaces import area_below, line_constant, youngs_gradient
from hydro2d.physics.traction import smoothstep

#: excess over 1 of the squared ratio of two slopes from which the line is drawn from the steeper surface alone
STEEPER = 1e-3

#: squared ratio of the slope of all solids to those of the groups, below which void lies between the groups
BETWEEN = 0.25

#: share of void in a cell from which its groups begin to have separate surfaces, and from which they have them in full
SEPARATION_START, SEPARATION_FULL = 0.5, 0.75

#: squared misfits of lines that differ by less are alike
FIT = 1e-6

#: weight of differences between neighbouring cells beside those across a cell in the fall of the hard share
ONE_SIDED = 0.01


@point
def steeper(one, other):
    """Weight of the line drawn from one surface alone, for the squares of its slope and of the other surface's."""
    return smoothstep((one / other - 1.0) / STEEPER) if one > other > 0.0 else (1.0 if one > other else 0.0)


@point
def separation_weight(void, whole, less):
    """Weight with which void lies between the groups, each of which then has its own surface.

    void is its share of the cell, whole the squared slope of all solids, less the smaller squared slope of the two groups.
    """
    if less == 0.0:
        return 0.0
    opposed = smoothstep(void / GAP - 1.0) * smoothstep(2.0 - 2.0 * whole / (BETWEEN * less))
    return max(opposed, smoothstep((void - SEPARATION_START) / (SEPARATION_FULL - SEPARATION_START)))


@point
def share_at(j, i, w):
    """(hard share of the solids of cell (j, i), how well it is known there); beyond the mesh, of the nearest cell in it.

    The share of a cell with void, which may lie on either side, is known with the weight 1/(1 + (void/GAP)^2), and that of a
    cell without solids not at all.
    """
    row = min(max(j, w.mesh_box[0]), w.mesh_box[1] - 1)
    column = min(max(i, w.mesh_box[2]), w.mesh_box[3] - 1)
    total = w.hard[row, column] + w.soft[row, column]
    if total <= 0.0:
        return 0.0, 0.0
    void = max(1.0 - total, 0.0) / GAP
    return w.hard[row, column] / total, min(total, 1.0) / (1.0 + void * void)


@point
def share_fall(j, i, dj, di, w):
    """Fall of the hard share of the solids across cell (j, i) along r (di = 1) or z (dj = 1).

    The mean over the three lines of cells through its neighbours, the middle one counting twice: of the differences of the two
    outer cells, by how well both shares are known, and, with the weight ONE_SIDED, of twice those to the cell between them. In
    cells without void this is Youngs' gradient.
    """
    fall, whole = 0.0, 0.0
    for line in range(-1, 2):
        row, column = j + di * line, i + dj * line
        share, known_here = share_at(row, column, w)
        before, known_before = share_at(row - dj, column - di, w)
        after, known_after = share_at(row + dj, column + di, w)
        part = 2.0 if line == 0 else 1.0
        both = part * known_before * known_after
        low, high = part * ONE_SIDED * known_before * known_here, part * ONE_SIDED * known_here * known_after
        fall += both * (before - after) + 2.0 * low * (before - share) + 2.0 * high * (share - after)
        whole += both + low + high
    if whole == 0.0:
        return 0.0
    width = w.dr[i] / (w.dr[i] + 0.5 * (w.dr[i - 1] + w.dr[i + 1])) if di == 1 else w.dz[j] / (
        w.dz[j] + 0.5 * (w.dz[j - 1] + w.dz[j + 1]))
    return fall / whole * width


@point
def void_around(j, i, w):
    """Largest share of void in a cell and its eight neighbours that contain solids."""
    most = 0.0
    for row in range(max(j - 1, w.mesh_box[0]), min(j + 2, w.mesh_box[1])):
        for column in range(max(i - 1, w.mesh_box[2]), min(i + 2, w.mesh_box[3])):
            most = max(most, 1.0 - w.hard[row, column] - w.soft[row, column])
    return most


@point
def misfit(j, i, n_r, n_z, share, w):
    """By how much a line of cell (j, i), drawn on through its eight neighbours, disagrees with what is in them, squared.

    The hard side takes at least the hard share of a cell and leaves at least the soft one.
    """
    size = abs(n_r) + abs(n_z)
    if size < 1e-14:
        return 1.0
    n_r, n_z = n_r / size, n_z / size
    constant = line_constant(abs(n_r), abs(n_z), share) + min(n_r, 0.0) + min(n_z, 0.0)
    total = 0.0
    for b in range(-1, 2):
        row = min(max(j + b, w.mesh_box[0]), w.mesh_box[1] - 1)
        high = w.dz[j + b] / w.dz[j]
        y = 0.0 if b == 0 else (1.0 if b > 0 else -high)
        for a in range(-1, 2):
            column = min(max(i + a, w.mesh_box[2]), w.mesh_box[3] - 1)
            wide = w.dr[i + a] / w.dr[i]
            x = 0.0 if a == 0 else (1.0 if a > 0 else -wide)
            m_r, m_z = n_r * wide, n_z * high
            inside = area_below(abs(m_r), abs(m_z), constant - n_r * x - n_z * y - min(m_r, 0.0) - min(m_z, 0.0))
            beyond = max(w.hard[row, column] - inside, inside - 1.0 + w.soft[row, column])
            total += beyond * beyond if beyond > 0.0 else 0.0
    return total


@not_inlined
def fitting_line(j, i, share, hard_r, hard_z, soft_r, soft_z, w):
    """(normal of the hard side, its share of the cell) of the line between the groups in cell (j, i).

    Youngs' normal of f_hard - f_soft. Where there is void around, a surface may have a corner: the line is then drawn from the
    two surfaces, from either of them, or from the hard share of the solids, weighted by how well it fits what is around.
    """
    if void_around(j, i, w) <= 0.0:
        return hard_r - soft_r, hard_z - soft_z, share
    whole, n_r, n_z, part = 0.0, 0.0, 0.0, 0.0
    for way in range(4):
        along_r, along_z, side = hard_r - soft_r, hard_z - soft_z, share
        if way == 1:
            along_r, along_z, side = hard_r, hard_z, w.hard[j, i]
        elif way == 2:
            along_r, along_z, side = -soft_r, -soft_z, 1.0 - w.soft[j, i]
        elif way == 3:
            along_r, along_z = share_fall(j, i, 0, 1, w), share_fall(j, i, 1, 0, w)
        size = abs(along_r) + abs(along_z)
        if size < 1e-14:
            continue
        off = misfit(j, i, along_r, along_z, side, w)
        weight = 1.0 / (off * off + FIT * FIT)
        whole += weight
        n_r += weight * along_r / size
        n_z += weight * along_z / size
        part += weight * side
    if whole == 0.0:
        return 0.0, 0.0, share
    return n_r / whole, n_z / whole, part / whole


@cell_rows
def contact_lines(j, w):
    """Contact-interface columns of every row, from i0 to i1, and the line in each of their cells between the hard and the soft
    side.

    The normal is Youngs' from f_hard - f_soft; the line encloses the hard share of the solids. Near void one of the two
    surfaces may have a corner. The line is then drawn from the flat one, which has the steeper slope, and the void of the cell
    lies on the other side. Where there is more than GAP of void and the two slopes almost cancel, the void lies between the
    groups. Each of these cases has a weight. Beyond the edges of the mesh the cells next to them are repeated.

    Reads    contact_node_count [j], contact_nodes [j, k]; hard, soft [j, i]
    Writes   contact_columns [j, 2]; line [10, j, i]
    """
    lo, hi = 1 << 30, 0
    for row in range(j, j + 2):
        if w.contact_node_count[row] > 0:
            lo = min(lo, w.contact_nodes[row, 0] - 1)
            hi = max(hi, w.contact_nodes[row, w.contact_node_count[row] - 1] + 1)
    if lo < hi:
        lo = max(lo, w.i0)
        hi = min(hi, w.i1)
    w.contact_columns[j, 0] = lo
    w.contact_columns[j, 1] = hi
    below, above = max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1] - 1)
    for i in range(lo, hi):
        left, right = max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3] - 1)
        hard_r, hard_z = youngs_gradient(
            j, i, w.hard[below, left], w.hard[below, i], w.hard[below, right], w.hard[j, left], w.hard[j, right],
            w.hard[above, left], w.hard[above, i], w.hard[above, right], w.dr, w.dz)
        soft_r, soft_z = youngs_gradient(
            j, i, w.soft[below, left], w.soft[below, i], w.soft[below, right], w.soft[j, left], w.soft[j, right],
            w.soft[above, left], w.soft[above, i], w.soft[above, right], w.dr, w.dz)
        steep_h, steep_s = hard_r * hard_r + hard_z * hard_z, soft_r * soft_r + soft_z * soft_z
        total = w.hard[j, i] + w.soft[j, i]
        share = min(max(w.hard[j, i] / total, 0.0), 1.0) if total > 0.0 else -1.0
        w.line[HARD_R, j, i] = hard_r / w.dr[i]
        w.line[HARD_Z, j, i] = hard_z / w.dz[j]
        w.line[SOFT_R, j, i] = -soft_r / w.dr[i]
        w.line[SOFT_Z, j, i] = -soft_z / w.dz[j]
        w.line[SHARE, j, i] = share
        by_soft = steeper(steep_s, steep_h)
        open_r, open_z = hard_r + soft_r, hard_z + soft_z
        separated = separation_weight(1.0 - total, open_r * open_r + open_z * open_z, min(steep_h, steep_s))
        w.line[SOFT_AFTER, j, i] = (1.0 - separated) * (1.0 - by_soft)
        w.line[HARD_FIRST, j, i] = 1.0 - (1.0 - separated) * by_soft
        w.line[LINE_R, j, i] = 0.0
        w.line[LINE_Z, j, i] = 0.0
        w.line[CONSTANT, j, i] = 0.0
        if 0.0 < share < 1.0:
            n_r, n_z, share = fitting_line(j, i, share, hard_r, hard_z, soft_r, soft_z, w)
            size = abs(n_r) + abs(n_z)
            if size > 1e-14:
                n_r, n_z = n_r / size, n_z / size
                w.line[LINE_R, j, i] = n_r
                w.line[LINE_Z, j, i] = n_z
                w.line[CONSTANT, j, i] = line_constant(abs(n_r), abs(n_z), share) + min(n_r, 0.0) + min(n_z, 0.0)
