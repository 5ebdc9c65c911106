"""The line between the hard and the soft side of a cell of a contact (explanation/sliding, contact).

Without void it is Youngs' line. Where there is void around, a surface may end or have a corner, and several lines are tried:
the better one fits what is in the neighbouring cells, the more it counts.
"""

from hydro2d.jit import not_inlined, point
from hydro2d.physics.contact_faces import GAP
from hydro2d.physics.interfaces import area_below, line_constant
from hydro2d.physics.traction import smoothstep

#: excess over 1 of the squared ratio of two slopes from which the line is drawn from the steeper surface alone
STEEPER = 1e-3

#: squared ratio of the slope of all solids to those of the groups, below which void lies between the groups
BETWEEN = 0.25

#: share of void in a cell from which its groups begin to have separate surfaces, and from which they have them in full
SEPARATION_START, SEPARATION_FULL = 0.5, 0.75

#: squared misfits of lines that differ by less are alike
FIT = 1e-5

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
def share_at(j, i, mesh_box, hard, soft):
    """(hard share of the solids of cell (j, i), how well it is known there); beyond the mesh, of the nearest cell in it.

    The share of a cell with void, which may lie on either side, is known with the weight 1/(1 + (void/GAP)^2), and that of a
    cell without solids not at all.
    """
    row = min(max(j, mesh_box[0]), mesh_box[1] - 1)
    column = min(max(i, mesh_box[2]), mesh_box[3] - 1)
    total = hard[row, column] + soft[row, column]
    if total <= 0.0:
        return 0.0, 0.0
    void = max(1.0 - total, 0.0) / GAP
    return hard[row, column] / total, min(total, 1.0) / (1.0 + void * void)


@point
def share_fall(j, i, dj, di, mesh_box, hard, soft, dr, dz):
    """Fall of the hard share of the solids across cell (j, i) along r (di = 1) or z (dj = 1).

    The mean over the three lines of cells through its neighbours, the middle one counting twice: of the differences of the two
    outer cells, by how well both shares are known, and, with the weight ONE_SIDED, of twice those to the cell between them. In
    cells without void this is a quarter of Youngs' gradient.
    """
    fall, whole = 0.0, 0.0
    for line in range(-1, 2):
        row, column = j + di * line, i + dj * line
        share, known_here = share_at(row, column, mesh_box, hard, soft)
        before, known_before = share_at(row - dj, column - di, mesh_box, hard, soft)
        after, known_after = share_at(row + dj, column + di, mesh_box, hard, soft)
        part = 2.0 if line == 0 else 1.0
        both = part * known_before * known_after
        low, high = part * ONE_SIDED * known_before * known_here, part * ONE_SIDED * known_here * known_after
        fall += both * (before - after) + 2.0 * low * (before - share) + 2.0 * high * (share - after)
        whole += both + low + high
    if whole == 0.0:
        return 0.0
    width = dr[i] / (dr[i] + 0.5 * (dr[i - 1] + dr[i + 1])) if di == 1 else dz[j] / (
        dz[j] + 0.5 * (dz[j - 1] + dz[j + 1]))
    return fall / whole * width


@point
def void_around(j, i, mesh_box, hard, soft):
    """Largest share of void in a cell and its eight neighbours."""
    most = 0.0
    for row in range(max(j - 1, mesh_box[0]), min(j + 2, mesh_box[1])):
        for column in range(max(i - 1, mesh_box[2]), min(i + 2, mesh_box[3])):
            most = max(most, 1.0 - hard[row, column] - soft[row, column])
    return most


@point
def misfit(j, i, n_r, n_z, share, mesh_box, hard, soft, dr, dz):
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
        row = min(max(j + b, mesh_box[0]), mesh_box[1] - 1)
        high = dz[j + b] / dz[j]
        y = 0.0 if b == 0 else (1.0 if b > 0 else -high)
        for a in range(-1, 2):
            column = min(max(i + a, mesh_box[2]), mesh_box[3] - 1)
            wide = dr[i + a] / dr[i]
            x = 0.0 if a == 0 else (1.0 if a > 0 else -wide)
            m_r, m_z = n_r * wide, n_z * high
            inside = area_below(abs(m_r), abs(m_z), constant - n_r * x - n_z * y - min(m_r, 0.0) - min(m_z, 0.0))
            beyond = max(hard[row, column] - inside, inside - 1.0 + soft[row, column])
            total += beyond * beyond if beyond > 0.0 else 0.0
    return total


@not_inlined
def fitting_line(j, i, share, hard_r, hard_z, soft_r, soft_z, mesh_box, hard, soft, dr, dz):
    """(normal of the hard side, its share of the cell) of the line between the groups in cell (j, i).

    Youngs' normal of f_hard - f_soft. Where there is void around, a surface may have a corner: the line is then drawn from the
    two surfaces, from either of them, or from the hard share of the solids, weighted by how well it fits what is around.
    """
    if void_around(j, i, mesh_box, hard, soft) <= 0.0:
        return hard_r - soft_r, hard_z - soft_z, share
    whole, n_r, n_z, part = 0.0, 0.0, 0.0, 0.0
    for way in range(4):
        along_r, along_z, side = hard_r - soft_r, hard_z - soft_z, share
        if way == 1:
            along_r, along_z, side = hard_r, hard_z, hard[j, i]
        elif way == 2:
            along_r, along_z, side = -soft_r, -soft_z, 1.0 - soft[j, i]
        elif way == 3:
            along_r, along_z = share_fall(j, i, 0, 1, mesh_box, hard, soft, dr, dz), share_fall(
                j, i, 1, 0, mesh_box, hard, soft, dr, dz)
        size = abs(along_r) + abs(along_z)
        if size < 1e-14:
            continue
        off = misfit(j, i, along_r, along_z, side, mesh_box, hard, soft, dr, dz)
        weight = 1.0 / (off * off + FIT * FIT)
        whole += weight
        n_r += weight * along_r / size
        n_z += weight * along_z / size
        part += weight * side
    if whole == 0.0:
        return 0.0, 0.0, share
    return n_r / whole, n_z / whole, part / whole
