"""Checkerboards of stress in the bodies of the hard group: what no vertex feels, fades as fast as the hourglass mode does.

A stress that is constant in every cell, while velocities are linear, has a blind spot: where it goes up and down from cell to
cell, the forces on every vertex cancel. On a mesh that follows the body nothing washes that away either (explanation/sliding,
equation 9).
"""

from hydro2d.jit import kernel, point, prange
from hydro2d.kernels.column_ranges import union
from hydro2d.mesh.fields import SRR, SRZ, SZZ, E

#: rows of `checkerboard`: share that fades in the step, 0 for a vertex that is not between four full cells of one body;
#: checkerboards of the pressure and the deviators around it, Pa
FADES, OF_P, OF_RR, OF_ZZ, OF_RZ = range(5)
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
def find_checkerboards(j0, j1, i0, i1, dt, group, group_ranges, hg_coefficient, cell_mass, vof, q, pm, checkerboard):
    """Checkerboards around the vertices between four cells that one body of the hard group fills.

    Reads    group [m]; vof, pm [m, j, i]; q (deviators) [k, m, j, i]; hg_coefficient [j, i]; cell_mass [b, j, i]
    Writes   checkerboard [5, j, i], rows FADES to OF_RZ, 0 at all other vertices
    """
    for j in prange(j0, j1 + 1):
        lo, hi = group_ranges[1, 1, j, 0], group_ranges[1, 1, j, 1]
        for i in range(lo, hi + 1):
            for row in range(5):
                checkerboard[row, j, i] = 0.0
            if j == j0 or j == j1 or i <= i0 or i >= i1:
                continue
            for m in range(vof.shape[0]):
                if group[m] != 1 or not filled_around(m, j, i, vof):
                    continue
                share = MOST
                for row in range(j - 1, j + 1):
                    for column in range(i - 1, i + 1):
                        share = min(share, fading(row, column, dt, hg_coefficient, cell_mass))
                checkerboard[FADES, j, i] = share
                checkerboard[OF_P, j, i] = checkerboard_of(j, i, pm[m])
                checkerboard[OF_RR, j, i] = checkerboard_of(j, i, q[SRR, m])
                checkerboard[OF_ZZ, j, i] = checkerboard_of(j, i, q[SZZ, m])
                checkerboard[OF_RZ, j, i] = checkerboard_of(j, i, q[SRZ, m])


@point
def stands_out(of, j, i, checkerboard):
    """By how much a cell stands out of the cells around it (Pa): the least of the checkerboards at its vertices.

    0 where they are not of one sign, as in every field that the mesh resolves, or fewer than two are known.
    """
    known, least, most = 0, 1e300, -1e300
    for n in range(4):
        row, column = j + n // 2, i + n % 2
        if checkerboard[FADES, row, column] > 0.0:
            value = checkerboard[of, row, column]
            value = value if n == 0 or n == 3 else -value
            known += 1
            least = min(least, value)
            most = max(most, value)
    if known < 2:
        return 0.0
    return max(least, 0.0) + min(most, 0.0)


@kernel
def fade_deviators(j0, j1, group, group_ranges, volume, checkerboard, vof, km, q, room):
    """Takes from the deviators of every cell its share of what stands out, and finds the volume it would have to gain.

    The elastic energy that goes with it stays as heat.

    Reads    checkerboard [5, j, i]; group [m]; vof, km [m, j, i]; volume [j, i]
    Updates  q (deviators) [k, m, j, i]
    Writes   room [j, i], volume that makes the pressure that stands out fade, m^3 per radian
    """
    for j in prange(j0, j1):
        for i in range(group_ranges[1, 0, j, 0], group_ranges[1, 0, j, 1]):
            room[j, i] = 0.0
            share = max(max(checkerboard[FADES, j, i], checkerboard[FADES, j, i + 1]),
                        max(checkerboard[FADES, j + 1, i], checkerboard[FADES, j + 1, i + 1]))
            if share == 0.0:
                continue
            for m in range(vof.shape[0]):
                if group[m] == 1 and vof[m, j, i] == 1.0:
                    room[j, i] = share * stands_out(OF_P, j, i, checkerboard) * volume[j, i] / km[m, j, i]
                    q[SRR, m, j, i] -= share * stands_out(OF_RR, j, i, checkerboard)
                    q[SZZ, m, j, i] -= share * stands_out(OF_ZZ, j, i, checkerboard)
                    q[SRZ, m, j, i] -= share * stands_out(OF_RZ, j, i, checkerboard)


@point
def left_face(m, j, i, vof, room):
    """Volume by which the left face of cell (j, i) sweeps more, if both of its cells are full of body m."""
    return 0.125 * (room[j, i - 1] - room[j, i]) if vof[m, j, i - 1] == 1.0 and vof[m, j, i] == 1.0 else 0.0


@point
def lower_face(m, j, i, vof, room):
    """Volume by which the lower face of cell (j, i) sweeps more, if both of its cells are full of body m."""
    return 0.125 * (room[j - 1, i] - room[j, i]) if vof[m, j - 1, i] == 1.0 and vof[m, j, i] == 1.0 else 0.0


@kernel
def fade_pressures(j0, j1, i0, i1, group, group_ranges, contact_columns, cell_mass, room, vof, pm, fr, fz, own_r, own_z, q):
    """Lets faces sweep volume from cells whose pressure stands out to their neighbours.

    Two cells do work on one another by their mean pressure, so that their sum of energy stays.

    Reads    room [j, i]; group [m]; vof, pm [m, j, i]; cell_mass [b, j, i]; contact_columns [j, 2]
    Updates  fr, fz [j, i]; own_r, own_z [b, j, i] where they are in use; q (e) [k, m, j, i]
    """
    for j in prange(j0, j1):
        first, last = contact_columns[j, 0], contact_columns[j, 1]
        low, high = union(contact_columns, max(j - 1, j0), j + 1)
        for i in range(group_ranges[1, 0, j, 0], group_ranges[1, 0, j, 1]):
            for m in range(vof.shape[0]):
                if group[m] != 1 or vof[m, j, i] != 1.0:
                    continue
                left = left_face(m, j, i, vof, room) if i > i0 else 0.0
                lower = lower_face(m, j, i, vof, room) if j > j0 else 0.0
                right = left_face(m, j, i + 1, vof, room) if i + 1 < i1 else 0.0
                upper = lower_face(m, j + 1, i, vof, room) if j + 1 < j1 else 0.0
                if left == 0.0 and lower == 0.0 and right == 0.0 and upper == 0.0:
                    continue
                fr[j, i] += left
                fz[j, i] += lower
                for g in range(2):
                    own_r[g, j, i] += left if first <= i <= last else 0.0
                    own_z[g, j, i] += lower if low <= i < high else 0.0
                here = pm[m, j, i]
                along_r = left * (here + pm[m, j, i - 1]) - right * (here + pm[m, j, i + 1])
                along_z = lower * (here + pm[m, j - 1, i]) - upper * (here + pm[m, j + 1, i])
                q[E, m, j, i] += 0.5 * (along_r + along_z) / cell_mass[1, j, i]
