"""Forces on vertices from the total stress of the cells around them, and the velocities that result."""

from math import sqrt

from hydro2d.jit import cell_rows, point, rowwise, vertex_rows
from hydro2d.kernels.boundaries import velocity_at_edges
from hydro2d.kernels.column_ranges import columns, copy_beside, union
from hydro2d.kernels.cut_cells import KIND, WHOLE, bodies_stress, cut_pressure, pull_of_ties, ties
from hydro2d.mesh.fields import SRR, SRZ, SZZ
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, CM_IN, CM_OUT, FACE_R, VOL_R
from hydro2d.physics.advection import TINY
from hydro2d.physics.contents import contains_group, dominant_body
from hydro2d.physics.corner import axial_force, hourglass_force, radial_force
from hydro2d.physics.kinematics import alternating_mode, divergence
from hydro2d.physics.momentum import corner_sum
from hydro2d.physics.traction import strained_pressure

#: speeds below this carry no signal and are set to zero, so that the active region has an edge (explanation/speed)
SMALLEST_SPEED = 1e-20


@point
def mixed_stress(j, i, w):
    """(rr, zz, tt, rz) of a mixed cell without its pressure, Pa: of its bodies, or of the dominant one in a hard zone."""
    m = dominant_body(j, i, w.hard_bodies, w.threshold, w.vof)
    if m < 0:
        return bodies_stress(-1, j, i, w)
    rr, zz = w.solid[j, i] * w.q[SRR, m, j, i], w.solid[j, i] * w.q[SZZ, m, j, i]
    return rr, zz, -(rr + zz), w.solid[j, i] * w.q[SRZ, m, j, i]


@rowwise
def filter_row(b, j, w):
    """What the hourglass filters of row j push with: their coefficient times what alternates of the mode of group b.

    Reads    u0, v0, cell_mass [b, j, i]; hg_coefficient [j, i]
    Writes   filter_r, filter_z [b, j, i], N per radian
    """
    lo, n = columns(w.active_range[j, 0], w.active_range[j, 1])
    u = w.u0[b]
    v = w.v0[b]
    mass = w.cell_mass[b]
    hg_j = w.hg_coefficient[j]
    r_j = w.filter_r[b, j]
    z_j = w.filter_z[b, j]
    for x in range(n):
        i = lo + x
        r_j[i] = hg_j[i] * alternating_mode(j, i, u, mass)
        z_j[i] = hg_j[i] * alternating_mode(j, i, v, mass)


@cell_rows
def total_stress(j, w):
    """sigma = s - p I - q with the pressure at half the step, p^(n+1/2) = p - (dt/2) K div u^n.

    The cell's deviator is sum f_m s_m, in mode `solid` divided by the share of solids; in the hard zone of a slip layer it is
    the hard body's own times the share of solids (explanation/mixed-cells, sliding). In a cut cell the pressure is p_c and each
    body contributes s - (n . s . n) I.

    Reads    u0, v0 [b, j, i]; vof [m, j, i]; q (deviators) [k, m, j, i]; p, bulk, solid, qr, qz, qt, qrz [j, i];
             hard_bodies [m]
    Writes   ph, sig_rr, sig_zz, sig_tt, sig_rz [j, i]
    """
    lo, n = columns(w.active_range[j, 0], w.active_range[j, 1])
    rr = w.sig_rr[j]
    zz = w.sig_zz[j]
    tt = w.sig_tt[j]
    rz = w.sig_rz[j]
    ph_j = w.ph[j]
    for x in range(n):
        i = lo + x
        rr[i] = 0.0
        zz[i] = 0.0
        rz[i] = 0.0
    for m in range(w.vof.shape[0]):
        f_j = w.vof[m, j]
        a_j = w.q[SRR, m, j]
        b_j = w.q[SZZ, m, j]
        c_j = w.q[SRZ, m, j]
        first, number = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        for x in range(number):
            i = first + x
            rr[i] += f_j[i] * a_j[i]
            zz[i] += f_j[i] * b_j[i]
            rz[i] += f_j[i] * c_j[i]
    ub = w.u0[0, j]
    ut = w.u0[0, j + 1]
    vb = w.v0[0, j]
    vt = w.v0[0, j + 1]
    p_j = w.p[j]
    k_j = w.bulk[j]
    qr_j = w.qr[j]
    qz_j = w.qz[j]
    qt_j = w.qt[j]
    qrz_j = w.qrz[j]
    for x in range(n):
        i = lo + x
        div = divergence(i, ub, ut, vb, vt, w.metrics, w.dz[j])
        pressure = strained_pressure(p_j[i], k_j[i], 0.5 * w.dt * div)
        ph_j[i] = pressure
        tt[i] = -(rr[i] + zz[i]) - pressure - qt_j[i]
        rr[i] = rr[i] - pressure - qr_j[i]
        zz[i] = zz[i] - pressure - qz_j[i]
        rz[i] -= qrz_j[i]
    for k in range(w.mixed_count[j]):  # again from s: in a crumb beside a full cell's pressure s may be lost to rounding
        i = w.mixed[j, k]
        own_rr, own_zz, own_tt, own_rz = mixed_stress(j, i, w)
        if w.skin[KIND, j, i] != WHOLE:
            ph_j[i] = cut_pressure(j, i, divergence(i, ub, ut, vb, vt, w.metrics, w.dz[j]), w)
        rr[i] = own_rr - ph_j[i] - qr_j[i]
        zz[i] = own_zz - ph_j[i] - qz_j[i]
        tt[i] = own_tt - ph_j[i] - qt_j[i]
        rz[i] = own_rz - qrz_j[i]
    for b in range(w.u0.shape[0]):
        filter_row(b, j, w)


@vertex_rows
def vertex_masses(j, w):
    """Mass of the dual cells: corner shares of the four cells around a vertex, weighted by radius.

    Reads    cell_mass [b, j, i]
    Writes   mass [b, j, i]
    """
    for b in range(w.mass.shape[0]):
        lo, hi = w.group_ranges[b, 1, j, 0], w.group_ranges[b, 1, j, 1]
        lo, n = columns(max(lo, w.i0), min(hi, w.i1) + 1)
        below = w.cell_mass[b, j - 1]
        above = w.cell_mass[b, j]
        m_j = w.mass[b, j]
        for x in range(n):
            i = lo + x
            m_j[i] = corner_sum(w.metrics[CM_IN, i], w.metrics[CM_OUT, i - 1], below[i - 1], above[i - 1], below[i], above[i])


@point
def accelerated_columns(b, j, w):
    """First vertex of row j that group b may move, and how many there are."""
    lo, hi = union(w.occupied[b], j - 1, j + 1)
    return columns(max(lo, w.i0), min(hi + 1, w.i1 + 1))


@vertex_rows
def limit_speed(j, w):
    """Limits the speed of under-filled nodes of row j to speed_limit, after all forces and before edges set their velocities.

    A node is under-filled if the density of its dual cell is below underfilled_density; contact nodes are left to the contact.
    The work of an impulse uses the mean of the velocities at the start and at the end of the step, which edges may prescribe.

    Reads    constrained [8], pushing [4], columns and rows, -1 for none; edge_velocity [8]; mass, u0, v0 [b, j, i]
    Updates  u, v [b, j, i]
    Writes   limited [3, j]: momentum and energy removed, and how often
    """
    for row in range(3):
        w.limited[row, j] = 0.0
    underfilled = w.underfilled_density * 0.25 * (w.dz[j - 1] + w.dz[j])
    for b in range(w.mass.shape[0]):
        lo, n = accelerated_columns(b, j, w)
        u_c = w.u0[b, j]
        v_c = w.v0[b, j]
        m_j = w.mass[b, j]
        un = w.u[b, j]
        vn = w.v[b, j]
        other = w.mass[w.mass.shape[0] - 1 - b, j]
        alone = w.mass.shape[0] == 1
        lost_p, lost_e, count = 0.0, 0.0, 0.0
        for x in range(n):
            i = lo + x
            m = m_j[i]
            square = un[i] * un[i] + vn[i] * vn[i]
            thin = m < underfilled * (w.metrics[VOL_R, i - 1] + w.metrics[VOL_R, i])
            if square <= w.speed_limit * w.speed_limit or not thin:
                continue
            if not alone and other[i] > 0.0:
                continue
            shrink = w.speed_limit / sqrt(square)
            end_u = velocity_at_edges(j, i, 0, shrink * un[i], w)
            end_v = velocity_at_edges(j, i, 1, shrink * vn[i], w)
            lost_p += m * vn[i] * (1.0 - shrink)
            lost_e += 0.5 * m * (1.0 - shrink) * (un[i] * (u_c[i] + end_u) + vn[i] * (v_c[i] + end_v))
            count += 1.0
            un[i] *= shrink
            vn[i] *= shrink
        w.limited[0, j] += lost_p
        w.limited[1, j] += lost_e
        w.limited[2, j] += count


@rowwise
def accelerate_row(b, j, w):
    """Velocities at the end of the Lagrangian step: u = u0 + dt f/M, f the sum of the corner forces of four cells.

    The cells take the work of the same corner forces (`hydro2d.physics.corner`) in `deform` (explanation/lagrangian-step,
    equations 4 to 6). Contact nodes are left to the contact (explanation/sliding).

    Reads    u0, v0, mass, filter_r, filter_z [b, j, i]; sig_rr, sig_zz, sig_tt, sig_rz [j, i]
    Writes   u, v [b, j, i] for whole rows
    """
    lo, n = accelerated_columns(b, j, w)
    copy_beside(w.u0[b, j], w.u[b, j], w.i0 - 2, lo, lo + n, w.i1 + 3)
    copy_beside(w.v0[b, j], w.v[b, j], w.i0 - 2, lo, lo + n, w.i1 + 3)
    u_j = w.u0[b, j]
    v_j = w.v0[b, j]
    m_j = w.mass[b, j]
    un = w.u[b, j]
    vn = w.v[b, j]
    for x in range(n):
        i = lo + x
        # Step 1: forces of the stresses of the four cells around the vertex, and of their hourglass filters (4 and 6)
        force_r = radial_force(j, i, w.sig_rr, w.sig_tt, w.sig_rz, w.metrics, w.dz)
        force_z = axial_force(j, i, w.sig_zz, w.sig_rz, w.metrics, w.dz)
        force_r += hourglass_force(j, i, w.filter_r[b])
        force_z += hourglass_force(j, i, w.filter_z[b])
        # Step 2: the velocity (5); a vertex without mass has none
        keep = 1.0 if m_j[i] > 0.0 else 0.0
        scale = keep * w.dt / max(m_j[i], TINY)
        radial = keep * u_j[i] + scale * force_r
        axial = keep * v_j[i] + scale * force_z
        un[i] = radial if abs(radial) > SMALLEST_SPEED else 0.0
        vn[i] = axial if abs(axial) > SMALLEST_SPEED else 0.0


@rowwise
def tie_row(b, j, w):
    """Velocities of the vertices of row j once vertices in a gas are tied to the bodies that have mass there (`ties`).

    Reads    mass, u0, v0 [b, j, i], skin [3, j, i], vof, q, the list of mixed cells
    Updates  u, v [b, j, i]
    """
    lo, n = accelerated_columns(b, j, w)
    for row in range(j - 1, j + 1):
        for k in range(w.mixed_count[row]):
            i = w.mixed[row, k]
            by_r, by_z = ties(row, i, w)
            if by_r + by_z == 0.0 or not contains_group(b, row, i, w.group, w.vof):
                continue
            for at in range(i, i + 2):
                if lo <= at < lo + n and w.mass[b, j, at] > 0.0:
                    pull_r, pull_z = pull_of_ties(b, j, at, row, i, by_r, by_z, w)
                    w.u[b, j, at] += pull_r / w.mass[b, j, at]
                    w.v[b, j, at] += pull_z / w.mass[b, j, at]


@vertex_rows
def accelerate(j, w):
    """Velocities of both groups at the end of the Lagrangian step: from forces, ties beside gases, and forces of sources.

    Reads    as accelerate_row and tie_row; pushed [c, b, j, i], m/s, or empty
    Updates  u, v [b, j, i]
    """
    for b in range(w.mass.shape[0]):
        accelerate_row(b, j, w)
        tie_row(b, j, w)
        if w.pushed.shape[0] > 0:
            for i in range(w.i0, w.i1 + 1):
                w.u[b, j, i] += w.pushed[0, b, j, i]
                w.v[b, j, i] += w.pushed[1, b, j, i]


@vertex_rows
def swept_volumes(j, w):
    """Volumes swept by the faces in the step, from the velocity at mid-step (explanation/remap, equation 1).

    F_r = dt r h <u>,  F_z = dt (a v_inner + b v_outer), with the areas of the cell vectors, so that their sum over a cell is
    its change of volume to the last bit.

    Reads    u0, v0, u, v [b, j, i]
    Writes   fr, fz [j, i]
    """
    lo, hi = w.group_ranges[0, 1, j, 0], w.group_ranges[0, 1, j, 1]
    lo, n = columns(max(lo, w.i0), min(hi, w.i1))
    ub = w.u[0, j]
    ub0 = w.u0[0, j]
    ut = w.u[0, j + 1]
    ut0 = w.u0[0, j + 1]
    vb = w.v[0, j]
    vb0 = w.v0[0, j]
    fr_j = w.fr[j]
    fz_j = w.fz[j]
    h = w.dz[j]
    for x in range(n):
        i = lo + x
        fr_j[i] = 0.25 * w.dt * w.metrics[FACE_R, i] * h * ((ub[i] + ub0[i]) + (ut[i] + ut0[i]))
        fz_j[i] = 0.5 * w.dt * (w.metrics[AZ_IN, i] * (vb[i] + vb0[i]) + w.metrics[AZ_OUT, i] * (vb[i + 1] + vb0[i + 1]))
    if n > 0:
        i = lo + n
        fr_j[i] = 0.25 * w.dt * w.metrics[FACE_R, i] * h * ((ub[i] + ub0[i]) + (ut[i] + ut0[i]))
