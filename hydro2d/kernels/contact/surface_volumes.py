"""Volumes that pressure moves between the cells of a contact: p_c evens out, and void between the groups closes.

The faces sweep them in addition to what the velocities give (explanation/sliding, equations 8 and 9).
"""

from math import sqrt

from hydro2d.jit import cell_rows, point, vertex_rows
from hydro2d.kernels.column_ranges import outer_rows, union
from hydro2d.kernels.contact.contact_geometry import HARD_R, HARD_Z, SOFT_R, SOFT_Z
from hydro2d.kernels.cut_cells import INTERFACE, KIND
from hydro2d.mesh.fields import RHO, E
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R
from hydro2d.physics.contact_faces import GAP, alternation, closed_volume, evened_volume
from hydro2d.physics.contact_pushes import along_surface, pressed_by, push_of, slip_at, stands_out
from hydro2d.physics.traction import smoothstep


@point
def surface_volume(j, i, row, column, w):
    """Volume that moves in a step from cell (j, i) of a contact to its neighbour (row, column) in addition to the swept volume.

    Between cells of the surface it evens out what alternates in p_c + q (explanation/sliding, equation 8). Void between groups
    that both press on it is closed by its full neighbours (equation 9), by a cell of the surface no faster than the groups slip
    past one another. The weight of this grows with the void, up to GAP.
    """
    here_meets, there_meets = w.skin[KIND, j, i] == INTERFACE, w.skin[KIND, row, column] == INTERFACE
    here, there = w.ph[j, i] + w.qr[j, i], w.ph[row, column] + w.qr[row, column]
    moved = 0.0
    if here_meets and there_meets:
        compliance = min(w.volume[j, i] / w.bulk[j, i], w.volume[row, column] / w.bulk[row, column])
        moved = along_surface(j, i, row, column, w.hard, w.soft) * evened_volume(compliance, alternation(here - there,
            stands_out(j, i, w.mesh_box, w.constrained, w.skin, w.hard, w.soft, w.firm, w.solid, w.ph, w.qr),
            stands_out(row, column, w.mesh_box, w.constrained, w.skin, w.hard, w.soft, w.firm, w.solid, w.ph, w.qr)))
    opened = (smoothstep((1.0 - w.solid[row, column]) / GAP) if there_meets else 0.0) - (
        smoothstep((1.0 - w.solid[j, i]) / GAP) if here_meets else 0.0)
    if opened == 0.0:
        return moved
    full, at, hole, beside = (j, i, row, column) if opened > 0.0 else (row, column, j, i)
    n_r = w.line[HARD_R, hole, beside] + w.line[SOFT_R, hole, beside]
    n_z = w.line[HARD_Z, hole, beside] + w.line[SOFT_Z, hole, beside]
    steep = n_r * n_r + n_z * n_z
    push = push_of(full, at, w.skin, w.solid, w.bulk, w.ph, w.qr, w.sig_rr, w.sig_zz, w.sig_tt, w.sig_rz)
    if steep == 0.0 or push <= 0.0 or (w.skin[KIND, full, at] != INTERFACE and w.hard[full, at] > 0.5):
        return moved
    for g in range(2):
        push = min(push, pressed_by(g, hole, beside, w.hard, w.soft, w.skin, w.solid, w.bulk, w.ph, w.qr, w.sig_rr, w.sig_zz,
                                    w.sig_tt, w.sig_rz))
    excess = push - w.ph[hole, beside] - w.qr[hole, beside]
    if excess <= 0.0:
        return moved
    swept = w.metrics[FACE_R, column] * w.dz[j] if row == j else w.metrics[AZ_IN, i] + w.metrics[AZ_OUT, i]
    part = 1.0 if w.skin[KIND, full, at] == INTERFACE else sqrt((n_r * n_r if row == j else n_z * n_z) / steep)
    more = closed_volume(part * swept, w.dt, excess, w.rhobar[full, at], w.bulk[full, at])
    if w.skin[KIND, full, at] == INTERFACE:
        more = min(more, swept * w.dt * slip_at(row, column, row == j, n_r, n_z, w.u, w.v))
    return moved + opened * more


@vertex_rows
def even_out(j, w):
    """Volumes that even out p_c along the surface, and those that close void between the groups.

    With a pressure constant in every cell of the surface and linear velocities, a pattern that alternates from cell to cell
    pushes no vertex. The volumes that the faces between these cells sweep are therefore corrected by the difference.

    Reads    ph, qr, bulk, rhobar, solid, volume, sig_rr, sig_zz, sig_tt, sig_rz [j, i], skin [3, j, i], line [10, j, i],
             hard, soft [j, i]; u, v [b, j, i]
    Writes   even_r, even_z [j, i]
    """
    j0, j1 = outer_rows(w.parts)
    if j < j1:
        for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1] + 1):
            inside = w.contact_columns[j, 0] < i < w.contact_columns[j, 1]
            w.even_r[j, i] = surface_volume(j, i - 1, j, i, w) if inside else 0.0
    lo, hi = union(w.contact_columns, max(j - 1, j0), min(j + 1, j1))
    for i in range(lo, hi):
        inside = j0 < j < j1 and w.contact_columns[j - 1, 0] <= i < w.contact_columns[j - 1, 1] and (
            w.contact_columns[j, 0] <= i < w.contact_columns[j, 1])
        w.even_z[j, i] = surface_volume(j - 1, i, j, i, w) if inside else 0.0


@cell_rows
def heat_evened_cells(j, w):
    """Heats the bodies by the work lost as p_c evens out: half to either cell, shared by mass.

    Updates  q (e) [k, m, j, i]
    """
    for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1]):
        here = w.ph[j, i] + w.qr[j, i]
        heat = 0.0
        if w.even_r[j, i] != 0.0:
            heat += w.even_r[j, i] * (w.ph[j, i - 1] + w.qr[j, i - 1] - here)
        if w.even_r[j, i + 1] != 0.0:
            heat += w.even_r[j, i + 1] * (here - w.ph[j, i + 1] - w.qr[j, i + 1])
        if w.even_z[j, i] != 0.0:
            heat += w.even_z[j, i] * (w.ph[j - 1, i] + w.qr[j - 1, i] - here)
        if w.even_z[j + 1, i] != 0.0:
            heat += w.even_z[j + 1, i] * (here - w.ph[j + 1, i] - w.qr[j + 1, i])
        if heat == 0.0:
            continue
        mass = 0.0
        for m in range(w.vof.shape[0]):
            mass += w.vof[m, j, i] * w.q[RHO, m, j, i] * w.volume[j, i] if w.vof[m, j, i] > 0.0 else 0.0
        for m in range(w.vof.shape[0]):
            if w.vof[m, j, i] > 0.0:
                w.q[E, m, j, i] += 0.5 * heat / mass
