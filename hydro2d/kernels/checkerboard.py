"""Checkerboards of stress in the bodies of the hard group: what no vertex feels, fades as fast as the hourglass mode does.

A stress that is constant in every cell, while velocities are linear, has a blind spot: where it goes up and down from cell to
cell, the forces on every vertex cancel. On a mesh that follows the body nothing washes that away either
(explanation/lagrangian-step, equations 13 and 14).
"""

from hydro2d.jit import kernel, point, prange
from hydro2d.kernels.column_ranges import union
from hydro2d.mesh.fields import SRR, SRZ, SZZ, E

#: rows of `checkerboard`: the volume that a face beside the vertex sweeps, and what its four cells lose of each deviator
SWEPT, OF_RR, OF_ZZ, OF_RZ = range(4)
#: largest share of a checkerboard that fades in a step
MOST = 0.5


@point
def fading(j, i, dt, hg_coefficient, cell_mass):
    """Share of a checkerboard in cell (j, i) that fades in a step: the rate of the hourglass filter times dt."""
    return 16.0 * hg_coefficient[j, i] * dt / cell_mass[1, j, i]


@point
def checkerboard_of(j, i, a):
    """(a00 - a01 + a11 - a10)/4 of the four cells around vertex (j, i): the size of a checkerboard."""
    return 0.25 * ((a[j - 1, i - 1] + a[j, i]) - (a[j - 1, i] + a[j, i - 1]))


@point
def filled_around(m, j, i, vof):
    """Whether body m fills the four cells around vertex (j, i)."""
    return vof[m, j - 1, i - 1] == 1.0 and vof[m, j - 1, i] == 1.0 and vof[m, j, i - 1] == 1.0 and vof[m, j, i] == 1.0


@kernel
def find_checkerboards(j0, j1, i0, i1, dt, group, group_ranges, volume, hg_coefficient, cell_mass, vof, q, pm, km,
                       checkerboard):
    """What fades of the checkerboards around the vertices between four cells that one body of the hard group fills.

    Reads    group [m]; vof, pm, km [m, j, i]; q (deviators) [k, m, j, i]; hg_coefficient, volume [j, i]; cell_mass [b, j, i]
    Writes   checkerboard [4, j, i], rows SWEPT (m^3 per radian) and OF_RR to OF_RZ (Pa), 0 at all other vertices
    """
    for j in prange(j0, j1 + 1):
        lo, hi = group_ranges[1, 1, j, 0], group_ranges[1, 1, j, 1]
        for i in range(lo, hi + 1):
            for row in range(4):
                checkerboard[row, j, i] = 0.0
            if j == j0 or j == j1 or i <= i0 or i >= i1:
                continue
            for m in range(vof.shape[0]):
                if group[m] != 1 or not filled_around(m, j, i, vof):
                    continue
                share, give = MOST, 1e300
                for row in range(j - 1, j + 1):
                    for column in range(i - 1, i + 1):
                        share = min(share, fading(row, column, dt, hg_coefficient, cell_mass))
                        give = min(give, volume[row, column] / km[m, row, column])
                checkerboard[SWEPT, j, i] = 0.125 * share * give * checkerboard_of(j, i, pm[m])
                checkerboard[OF_RR, j, i] = 0.25 * share * checkerboard_of(j, i, q[SRR, m])
                checkerboard[OF_ZZ, j, i] = 0.25 * share * checkerboard_of(j, i, q[SZZ, m])
                checkerboard[OF_RZ, j, i] = 0.25 * share * checkerboard_of(j, i, q[SRZ, m])


@point
def left_face(j, i, checkerboard):
    """Volume by which the left face of cell (j, i) sweeps more for the checkerboards at its two ends."""
    return checkerboard[SWEPT, j + 1, i] - checkerboard[SWEPT, j, i]


@point
def lower_face(j, i, checkerboard):
    """Volume by which the lower face of cell (j, i) sweeps more for the checkerboards at its two ends."""
    return checkerboard[SWEPT, j, i + 1] - checkerboard[SWEPT, j, i]


@point
def taken(row, j, i, checkerboard):
    """What a cell loses by the checkerboards at its vertices."""
    return (checkerboard[row, j, i] + checkerboard[row, j + 1, i + 1]) - (
        checkerboard[row, j, i + 1] + checkerboard[row, j + 1, i])


@kernel
def fade_checkerboards(j0, j1, group, group_ranges, contact_columns, cell_mass, checkerboard, vof, pm, fr, fz, own_r, own_z, q):
    """Lets checkerboards fade: faces sweep volume from cells of more pressure to those of less, and deviators lose theirs.

    Two cells do work on one another by their mean pressure, so that their sum of energy stays; what elastic energy the
    deviators lose stays as heat.

    Reads    checkerboard [4, j, i]; group [m]; vof, pm [m, j, i]; cell_mass [b, j, i]; contact_columns [j, 2]
    Updates  fr, fz [j, i]; own_r, own_z [b, j, i] where they are in use; q (e, deviators) [k, m, j, i]
    """
    for j in prange(j0, j1):
        lo, hi = group_ranges[1, 0, j, 0], group_ranges[1, 0, j, 1]
        for i in range(lo, hi):
            left, lower = left_face(j, i, checkerboard), lower_face(j, i, checkerboard)
            fr[j, i] += left
            fz[j, i] += lower
            first, last = contact_columns[j, 0], contact_columns[j, 1]
            low, high = union(contact_columns, max(j - 1, j0), j + 1)
            for g in range(2):
                own_r[g, j, i] += left if first <= i <= last else 0.0
                own_z[g, j, i] += lower if low <= i < high else 0.0
            for m in range(vof.shape[0]):
                if group[m] != 1 or vof[m, j, i] != 1.0:
                    continue
                here, made = pm[m, j, i], 0.0
                made += left * (here + pm[m, j, i - 1]) - left_face(j, i + 1, checkerboard) * (here + pm[m, j, i + 1])
                made += lower * (here + pm[m, j - 1, i]) - lower_face(j + 1, i, checkerboard) * (here + pm[m, j + 1, i])
                q[E, m, j, i] += 0.5 * made / cell_mass[1, j, i]
                q[SRR, m, j, i] -= taken(OF_RR, j, i, checkerboard)
                q[SZZ, m, j, i] -= taken(OF_ZZ, j, i, checkerboard)
                q[SRZ, m, j, i] -= taken(OF_RZ, j, i, checkerboard)
