"""The line in every cell of a contact between its hard and its soft side (`hydro2d.physics.dividing_lines`)."""

from hydro2d.jit import cell_rows
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
from hydro2d.physics.dividing_lines import fitting_line, separation_weight, steeper
from hydro2d.physics.interfaces import line_constant, youngs_gradient


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
            n_r, n_z, share = fitting_line(
                j, i, share, hard_r, hard_z, soft_r, soft_z, w.mesh_box, w.hard, w.soft, w.dr, w.dz)
            size = abs(n_r) + abs(n_z)
            if size > 1e-14:
                n_r, n_z = n_r / size, n_z / size
                w.line[LINE_R, j, i] = n_r
                w.line[LINE_Z, j, i] = n_z
                w.line[CONSTANT, j, i] = line_constant(abs(n_r), abs(n_z), share) + min(n_r, 0.0) + min(n_z, 0.0)
