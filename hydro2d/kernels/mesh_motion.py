"""A mesh that travels along z: volumes swept relative to it, and removal of vanishing stresses ahead of waves."""

from hydro2d.jit import cell_rows, vertex_rows
from hydro2d.kernels.column_ranges import columns, outer_rows, union
from hydro2d.mesh.grid import VOL_R

#: stresses (Pa), energies (J/kg) and strains below this are set to zero; a travelling mesh would carry them on, ever smaller
FLUSHED_BELOW = 1e-30


@vertex_rows
def subtract_mesh_motion(j, w):
    """F_z - d A for the faces j0 to j1 along z: the volume swept relative to a mesh that advances by d in the step.

    A is the axial area of the column (explanation/following-mesh, equation 1).

    Reads    group_ranges [b, n, j, 2]
    Updates  fz [j, i]
    """
    lo, n = columns(w.group_ranges[0, 1, j, 0], w.group_ranges[0, 1, j, 1])
    face = w.fz[j]
    area = w.metrics[VOL_R]
    for x in range(n):
        face[lo + x] -= w.advance * area[lo + x]


@vertex_rows
def subtract_mesh_motion_of_groups(j, w):
    """`subtract_mesh_motion` for the volume that each group of a contact sweeps at the faces around contact-interface cells.

    Reads    contact_columns [j, 2]
    Updates  own_z [b, j, i]
    """
    j0, j1 = outer_rows(w.parts)
    lo, hi = union(w.contact_columns, max(j - 1, j0), min(j + 1, j1))
    for i in range(lo, hi):
        for g in range(2):
            w.own_z[g, j, i] -= w.advance * w.metrics[VOL_R, i]


@cell_rows
def flush_tiny_values(j, w):
    """Sets tiny values to zero: numbers too small to be normal cost the processor a hundred times as much.

    In a travelling mesh every step mixes a share of the neighbours' stress into a cell, also ahead of all waves. The tail of
    stress that this makes falls below the smallest normal number.

    Reads    carried [m, n], body_range [m, j, 2]
    Updates  q (all but the density) [k, m, j, i]
    """
    for m in range(w.body_range.shape[0]):
        lo, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        for place in range(1, w.carried[m, 0] + 1):
            k = w.carried[m, place]
            row = w.q[k, m, j]
            for x in range(n):
                row[lo + x] = row[lo + x] if abs(row[lo + x]) > FLUSHED_BELOW else 0.0
