"""Damping of stress checkerboards, which exert no force on any vertex, in bodies of the hard group, at the hourglass rate.

With stresses constant in every cell and linear velocities, a stress that alternates from cell to cell exerts forces on every
vertex that cancel. On a mesh that follows the body, advection does not remove the pattern either (explanation/sliding,
equation 10).
"""

from hydro2d.jit import cell_rows, point, vertex_rows
from hydro2d.kernels.column_ranges import outer_rows, union
from hydro2d.mesh.fields import SRR, SRZ, SZZ, E
from hydro2d.physics.checkerboard import (
    COUNTS,
    OF_P,
    OF_RR,
    OF_RZ,
    OF_ZZ,
    cell_excess,
    checkerboard_of,
    left_face,
    lower_face,
)
from hydro2d.physics.traction import smoothstep

#: largest share of a checkerboard that fades in a step
MOST_DAMPED = 0.5
#: least fraction of a body in the eight neighbours of a full cell from which the cell counts as inside the body
INSIDE = 0.02


@point
def damping_share(j, i, w):
    """Share of a checkerboard in cell (j, i) that fades in a step: the rate of the hourglass filter times dt."""
    return 16.0 * w.hg_coefficient[j, i] * w.dt / w.cell_mass[1, j, i]


@cell_rows
def find_insides(j, w):
    """Weight with which cells that a body of the hard group fills lie inside it, by its least fraction in their neighbours.

    A cell that has just filled has a neighbour without any of the body, so its weight starts from 0. Cells beyond the edges of
    the mesh are not counted.

    Reads    group [m]; vof [m, j, i]
    Writes   inside [j, i], 0 to 1
    """
    j0, j1 = outer_rows(w.parts)
    for i in range(w.group_ranges[1, 0, j, 0], w.group_ranges[1, 0, j, 1]):
        w.inside[j, i] = 0.0
        for m in range(w.vof.shape[0]):
            if w.group[m] != 1 or w.vof[m, j, i] != 1.0:
                continue
            least = 1.0
            for row in range(max(j - 1, j0), min(j + 2, j1)):
                for column in range(max(i - 1, w.mesh_box[2]), min(i + 2, w.mesh_box[3])):
                    least = min(least, w.vof[m, row, column])
            w.inside[j, i] = smoothstep(least / INSIDE)


@vertex_rows
def find_checkerboards(j, w):
    """Checkerboards around the vertices between four cells that one body of the hard group fills.

    Reads    group [m]; vof, pm [m, j, i]; q (deviators) [k, m, j, i]; inside [j, i]
    Writes   checkerboard [5, j, i], rows COUNTS to OF_RZ, 0 at all other vertices
    """
    j0, j1 = outer_rows(w.parts)
    lo, hi = w.group_ranges[1, 1, j, 0], w.group_ranges[1, 1, j, 1]
    for i in range(lo, hi + 1):
        for row in range(5):
            w.checkerboard[row, j, i] = 0.0
        if j == j0 or j == j1 or i <= w.mesh_box[2] or i >= w.mesh_box[3]:
            continue
        least = min(min(w.inside[j - 1, i - 1], w.inside[j - 1, i]), min(w.inside[j, i - 1], w.inside[j, i]))
        for m in range(w.vof.shape[0]):
            if least > 0.0 and w.vof[m, j, i] == 1.0 and w.vof[m, j - 1, i - 1] == 1.0:
                w.checkerboard[COUNTS, j, i] = least
                w.checkerboard[OF_P, j, i] = checkerboard_of(j, i, w.pm[m])
                w.checkerboard[OF_RR, j, i] = checkerboard_of(j, i, w.q[SRR, m])
                w.checkerboard[OF_ZZ, j, i] = checkerboard_of(j, i, w.q[SZZ, m])
                w.checkerboard[OF_RZ, j, i] = checkerboard_of(j, i, w.q[SRZ, m])


@cell_rows
def damp_deviators(j, w):
    """Reduces each cell's deviators by the share of their excess that fades, and finds the volume that does so to its pressure.

    The elastic energy lost remains as heat.

    Reads    checkerboard [5, j, i]; group [m]; vof, km [m, j, i]; volume, hg_coefficient, inside [j, i]; cell_mass [b, j, i]
    Updates  q (deviators) [k, m, j, i]
    Writes   room [j, i], volume that reduces the excess pressure, m^3 per radian
    """
    for i in range(w.group_ranges[1, 0, j, 0], w.group_ranges[1, 0, j, 1]):
        w.room[j, i] = 0.0
        if w.inside[j, i] == 0.0:
            continue
        share = min(damping_share(j, i, w), MOST_DAMPED)
        for m in range(w.vof.shape[0]):
            if w.group[m] == 1 and w.vof[m, j, i] == 1.0:
                w.room[j, i] = share * cell_excess(OF_P, j, i, w.checkerboard) * w.volume[j, i] / w.km[m, j, i]
                w.q[SRR, m, j, i] -= share * cell_excess(OF_RR, j, i, w.checkerboard)
                w.q[SZZ, m, j, i] -= share * cell_excess(OF_ZZ, j, i, w.checkerboard)
                w.q[SRZ, m, j, i] -= share * cell_excess(OF_RZ, j, i, w.checkerboard)


@cell_rows
def damp_pressures(j, w):
    """Lets faces sweep volume from cells with an excess pressure to their neighbours.

    The two cells do work on each other at their mean pressure, so that their total energy is kept.

    Reads    room [j, i]; group [m]; vof, pm [m, j, i]; cell_mass [b, j, i]; contact_columns [j, 2]
    Updates  fr, fz [j, i]; own_r, own_z [b, j, i] where they are in use; q (e) [k, m, j, i]
    """
    j0, j1 = outer_rows(w.parts)
    first, last = w.contact_columns[j, 0], w.contact_columns[j, 1]
    low, high = union(w.contact_columns, max(j - 1, j0), j + 1)
    for i in range(w.group_ranges[1, 0, j, 0], w.group_ranges[1, 0, j, 1]):
        for m in range(w.vof.shape[0]):
            if w.group[m] != 1 or w.vof[m, j, i] != 1.0:
                continue
            left = left_face(m, j, i, w.vof, w.room) if i > w.mesh_box[2] else 0.0
            lower = lower_face(m, j, i, w.vof, w.room) if j > j0 else 0.0
            right = left_face(m, j, i + 1, w.vof, w.room) if i + 1 < w.mesh_box[3] else 0.0
            upper = lower_face(m, j + 1, i, w.vof, w.room) if j + 1 < j1 else 0.0
            if left == 0.0 and lower == 0.0 and right == 0.0 and upper == 0.0:
                continue
            w.fr[j, i] += left
            w.fz[j, i] += lower
            for g in range(2):
                w.own_r[g, j, i] += left if first <= i <= last else 0.0
                w.own_z[g, j, i] += lower if low <= i < high else 0.0
            here = w.pm[m, j, i]
            along_r = left * (here + w.pm[m, j, i - 1]) - right * (here + w.pm[m, j, i + 1])
            along_z = lower * (here + w.pm[m, j - 1, i]) - upper * (here + w.pm[m, j + 1, i])
            w.q[E, m, j, i] += 0.5 * (along_r + along_z) / w.cell_mass[1, j, i]
