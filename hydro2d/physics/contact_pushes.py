"""What presses on void between two groups in contact, and what stands out along their surface (explanation/sliding, 8 and 9).

sig_.. : stress of the cells at half the step, Pa;  skin : kind of a cell and normal of its surface
"""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.contact_faces import GAP, gas_share
from hydro2d.physics.stress import least_pressure
from hydro2d.physics.traction import INTERFACE, KIND, smoothstep

#: share of a cell from which its group alone counts as being in it, as far as its neighbour across a mesh line goes
ALONE = 0.9


@point
def push_of(j, i, skin, solid, bulk, ph, qr, sig_rr, sig_zz, sig_tt, sig_rz):
    """With what a full cell pushes into void beside it, Pa: p_c + q in a cell of the surface, else its least pressure.

    It fades as the cell itself gets void, up to GAP. The normal stress of a skin is noise about zero where nothing presses on
    it, and what its outward half moved would never come back; the least pressure is below zero there, and so is that of a
    stretched ring.
    """
    full = smoothstep(1.0 - (1.0 - solid[j, i]) / GAP)
    if full == 0.0 or bulk[j, i] <= 0.0:
        return 0.0
    if skin[KIND, j, i] == INTERFACE:
        return full * (ph[j, i] + qr[j, i])
    return full * least_pressure(j, i, sig_rr, sig_zz, sig_tt, sig_rz)


@point
def counts_for(g, j, i, skin, hard, soft):
    """Whether what presses in cell (j, i) is of group g; a cell of the surface counts for both."""
    return skin[KIND, j, i] == INTERFACE or (hard[j, i] if g == 1 else soft[j, i]) > 0.5


@point
def pressed_by(g, j, i, hard, soft, skin, solid, bulk, ph, qr, sig_rr, sig_zz, sig_tt, sig_rz):
    """The largest push of group g on cell (j, i) from its four neighbours, Pa."""
    largest = 0.0
    for row, column in ((j, i - 1), (j, i + 1), (j - 1, i), (j + 1, i)):
        if counts_for(g, row, column, skin, hard, soft):
            largest = max(largest, push_of(row, column, skin, solid, bulk, ph, qr, sig_rr, sig_zz, sig_tt, sig_rz))
    return largest


@point
def along_surface(j, i, row, column, hard, soft):
    """Whether neighbours of a contact lie along its surface: 1, or 0 where the surface is the face between them.

    It is where one group fills the one and the other group the other.
    """
    return 1.0 - max(smoothstep((min(hard[j, i], soft[row, column]) - ALONE) / (1.0 - ALONE)),
                     smoothstep((min(soft[j, i], hard[row, column]) - ALONE) / (1.0 - ALONE)))


@point
def closed(j, i, hard, soft, firm, solid):
    """How far a cell counts as free of void and gas: 1 without either, 0 from GAP on."""
    return smoothstep(1.0 - (1.0 - solid[j, i] + gas_share(j, i, hard, soft, firm)) / GAP)


@point
def stands_out(j, i, mesh_box, constrained, skin, hard, soft, firm, solid, ph, qr):
    """By how much p_c + q of a cell of the surface exceeds the mean of its neighbours along the surface, Pa.

    0 where there are no two neighbours. A cell counts as long as it has no void and no gas, up to GAP; the axis and
    walls are mirrors.
    """
    here = ph[j, i] + qr[j, i]
    number, total = 0.0, 0.0
    for edge, row, column, at in ((0, j, i - 1, i), (1, j, i + 1, i + 1), (2, j - 1, i, j), (3, j + 1, i, j + 1)):
        if at == mesh_box[2 - 2 * (edge // 2) + edge % 2]:
            if at == constrained[edge]:
                number += 1.0
                total += here
        elif skin[KIND, row, column] == INTERFACE:
            part = closed(row, column, hard, soft, firm, solid) * along_surface(j, i, row, column, hard, soft)
            number += part
            total += part * (ph[row, column] + qr[row, column])
    if number <= 1.0:
        return 0.0
    return (here - total / number) * min(number - 1.0, 1.0) * closed(j, i, hard, soft, firm, solid)


@point
def slip_at(j, i, along_r, n_r, n_z, u, v):
    """By how much the groups slip faster along the surface with the normal n than they close or open across it, m/s.

    The mean of both ends of face (j, i). Bodies that meet close a gap; they do not slip.
    """
    total, steep = 0.0, n_r * n_r + n_z * n_z
    for end in range(2):
        row, column = (j + end, i) if along_r else (j, i + end)
        w_r, w_z = u[1, row, column] - u[0, row, column], v[1, row, column] - v[0, row, column]
        total += max(abs(w_z * n_r - w_r * n_z) - abs(w_r * n_r + w_z * n_z), 0.0) / sqrt(steep)
    return 0.5 * total
