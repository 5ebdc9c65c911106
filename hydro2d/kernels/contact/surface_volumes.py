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
from hydro2d.physics.stress import least_pressure
from hydro2d.physics.traction import smoothstep


@point
def push_of(j, i, w):
    """With what a full cell pushes into void beside it, Pa: p_c + q in a cell of the surface, else its least pressure.

    0 in a cell with void itself. The normal stress of a skin is noise about zero where nothing presses on it, and what its
    outward half moved would never come back; the least pressure is below zero there, and so is that of a stretched ring.
    """
    if w.solid[j, i] <= 1.0 - GAP or w.bulk[j, i] <= 0.0:
        return 0.0
    if w.skin[KIND, j, i] == INTERFACE:
        return w.ph[j, i] + w.qr[j, i]
    return least_pressure(j, i, w.sig_rr, w.sig_zz, w.sig_tt, w.sig_rz)


@point
def contains(g, j, i, w):
    """Whether group g is in cell (j, i), a full cell of the surface counting for both."""
    if w.skin[KIND, j, i] == INTERFACE:
        return True
    share = 0.0
    for m in range(w.vof.shape[0]):
        share += w.vof[m, j, i] if w.group[m] == g else 0.0
    return share > 0.5


@point
def pressed_by(g, j, i, w):
    """The largest push of group g on cell (j, i) from its four neighbours, Pa."""
    largest = 0.0
    for row, column in ((j, i - 1), (j, i + 1), (j - 1, i), (j + 1, i)):
        if contains(g, row, column, w):
            largest = max(largest, push_of(row, column, w))
    return largest


@point
def stands_out(j, i, w):
    """By how much p_c + q of a cell of the surface exceeds the mean of its neighbours in the surface, Pa.

    0 where there are no two neighbours, one on either side. A cell counts as long as it has no void, up to GAP; the axis and
    walls are mirrors.
    """
    here = w.ph[j, i] + w.qr[j, i]
    number, total = 0.0, 0.0
    for edge, row, column, at in ((0, j, i - 1, i), (1, j, i + 1, i + 1), (2, j - 1, i, j), (3, j + 1, i, j + 1)):
        if at == w.mesh_box[2 - 2 * (edge // 2) + edge % 2]:
            if at == w.constrained[edge]:
                number += 1.0
                total += here
        elif w.skin[KIND, row, column] == INTERFACE:
            part = smoothstep(1.0 - (1.0 - w.solid[row, column]) / GAP)
            number += part
            total += part * (w.ph[row, column] + w.qr[row, column])
    if number <= 1.0:
        return 0.0
    return (here - total / number) * min(number - 1.0, 1.0) * smoothstep(1.0 - (1.0 - w.solid[j, i]) / GAP)


@point
def slip_at(j, i, along_r, n_r, n_z, w):
    """Mean speed at which the groups slip along the surface with the normal n at the ends of face (j, i), m/s."""
    total, steep = 0.0, n_r * n_r + n_z * n_z
    for end in range(2):
        row, column = (j + end, i) if along_r else (j, i + end)
        w_r, w_z = w.u[1, row, column] - w.u[0, row, column], w.v[1, row, column] - w.v[0, row, column]
        total += abs(w_z * n_r - w_r * n_z) / sqrt(steep)
    return 0.5 * total


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
        moved = evened_volume(compliance, alternation(here - there, stands_out(j, i, w), stands_out(row, column, w)))
    opened = (smoothstep((1.0 - w.solid[row, column]) / GAP) if there_meets else 0.0) - (
        smoothstep((1.0 - w.solid[j, i]) / GAP) if here_meets else 0.0)
    if opened == 0.0:
        return moved
    full, at, hole, beside = (j, i, row, column) if opened > 0.0 else (row, column, j, i)
    n_r = w.line[HARD_R, hole, beside] + w.line[SOFT_R, hole, beside]
    n_z = w.line[HARD_Z, hole, beside] + w.line[SOFT_Z, hole, beside]
    steep = n_r * n_r + n_z * n_z
    push = push_of(full, at, w)
    if steep == 0.0 or push <= 0.0 or (w.skin[KIND, full, at] != INTERFACE and contains(1, full, at, w)):
        return moved
    push = min(push, min(pressed_by(0, hole, beside, w), pressed_by(1, hole, beside, w)))
    excess = push - w.ph[hole, beside] - w.qr[hole, beside]
    if excess <= 0.0:
        return moved
    swept = w.metrics[FACE_R, column] * w.dz[j] if row == j else w.metrics[AZ_IN, i] + w.metrics[AZ_OUT, i]
    if w.skin[KIND, full, at] == INTERFACE:
        more = closed_volume(swept, w.dt, excess, w.rhobar[full, at], w.bulk[full, at])
        more = min(more, swept * w.dt * slip_at(row, column, row == j, n_r, n_z, w))
    else:
        part = sqrt((n_r * n_r if row == j else n_z * n_z) / steep)
        more = closed_volume(part * swept, w.dt, excess, w.rhobar[full, at], w.bulk[full, at])
    return moved + opened * more


@vertex_rows
def even_out(j, w):
    """Volumes that even out p_c along the surface, and those that close void between the groups.

    With a pressure constant in every cell of the surface and linear velocities, a pattern that alternates from cell to cell
    pushes no vertex. The volumes that the faces between these cells sweep are therefore corrected by the difference.

    Reads    ph, qr, bulk, rhobar, solid, volume, sig_rr, sig_zz, sig_tt, sig_rz [j, i], skin [3, j, i], line [10, j, i],
             vof [m, j, i]; u, v [b, j, i]
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
