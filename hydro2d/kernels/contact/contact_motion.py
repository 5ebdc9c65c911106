"""Stress of the cells between two groups in contact: their common pressure and viscosity, and the forces on either group."""

from math import sqrt

from hydro2d.jit import cell_rows, point, vertex_rows
from hydro2d.kernels.cell_viscosity import limit_of_sound, viscosity
from hydro2d.kernels.column_ranges import mixed_row
from hydro2d.kernels.contact.contact_geometry import HARD_R, HARD_Z, SOFT_R, SOFT_Z
from hydro2d.kernels.cut_cells import (
    FREE_SURFACE,
    INTERFACE,
    KIND,
    WHOLE,
    bodies_stress,
    cut_pressure,
    pull_of_ties,
    ties,
)
from hydro2d.mesh.fields import RHO
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, VOL_R
from hydro2d.physics.closure import stiff_density
from hydro2d.physics.contact_faces import meeting, volume_rate
from hydro2d.physics.contents import contains_group
from hydro2d.physics.corner import corner, corner_force
from hydro2d.physics.edges import is_constrained
from hydro2d.physics.stress import normal_pressure
from hydro2d.physics.traction import strained_pressure
from hydro2d.physics.waves import volume_step

#: void given to full cells without pressure whose groups separate, so that the void opens and no body is stretched
SEED = 1e-11


@point
def is_separating(j, i, w):
    """Whether the groups separate along the normal at a vertex of cell (j, i)."""
    opens = 0.0
    for row in range(j, j + 2):
        for column in range(i, i + 2):
            opening = (w.contact_normal[0, 0, row, column] * (w.u[1, row, column] - w.u[0, row, column])
                 + w.contact_normal[0, 1, row, column] * (w.v[1, row, column] - w.v[0, row, column]))
            opens = min(opens, opening)
    return opens < 0.0


@cell_rows
def contact_viscosity(j, w):
    """Volume rate and viscosity of the contact-interface cells, the step they allow, and seeds of void where groups separate.

    The density of a cell of both groups is the mean by compressibility: the stiffer body's mass must not push the other. One q
    follows from the common rate of volume over the cell's length along the normal; it falls as the cell has more void to close.
    Void next to the other group is a gap, across which nothing pulls. Where the groups separate at a vertex of a full cell
    that would be under tension after the step, the cell is given a seed of void.

    Reads    the arrays that face_apertures wrote; hard, soft, p, bulk [j, i]; u, v [b, j, i]; km [m, j, i]; cl, rhobar [j, i]
    Updates  vof [m, j, i], q (rho) [k, m, j, i], solid [j, i], skin [3, j, i] (kind), row_step [j], mixed_count [j],
             mixed [j, k]
    Writes   qr, qz, qt, qrz, rate [j, i] (1/s)
    Scratch  kinds [row, i]
    """
    seeded = False
    for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1]):
        rho, h = w.rhobar[j, i], w.dz[j]
        loss = -volume_rate(j, i, -1, w.metrics, h, w.aperture_r, w.aperture_z, w.u, w.v) / (w.metrics[VOL_R, i] * h)
        w.rate[j, i] = -loss
        if w.hard[j, i] > 0.0 and w.soft[j, i] > 0.0:
            rho = stiff_density(j, i, w.vof, w.q, w.km)
        elif w.skin[KIND, j, i] == FREE_SURFACE and meeting(j, i, w.mesh_box, w.hard, w.soft):
            w.skin[KIND, j, i] = INTERFACE
        elif (w.solid[j, i] > 1.0 - SEED and meeting(j, i, w.mesh_box, w.hard, w.soft) and is_separating(j, i, w)
              and strained_pressure(w.p[j, i], w.bulk[j, i], w.dt * max(w.rate[j, i], 0.0)) <= 0.0):
            for m in range(w.vof.shape[0]):
                if w.vof[m, j, i] > 0.0:
                    w.vof[m, j, i] *= 1.0 - SEED
                    w.q[RHO, m, j, i] /= 1.0 - SEED
            w.solid[j, i] *= 1.0 - SEED
            w.skin[KIND, j, i] = INTERFACE
            seeded = True
        w.qr[j, i] = 0.0
        w.qz[j, i] = 0.0
        w.qt[j, i] = 0.0
        w.qrz[j, i] = 0.0
        if rho > 0.0:
            slope_r = abs(w.line[HARD_R, j, i] + w.line[SOFT_R, j, i])
            slope_z = abs(w.line[HARD_Z, j, i] + w.line[SOFT_Z, j, i])
            steep = sqrt(slope_r * slope_r + slope_z * slope_z)
            length = steep / (slope_r / w.dr[i] + slope_z / h) if steep > 0.0 else min(w.dr[i], h)
            jump = -max(loss, 0.0) * length
            q = viscosity(rho, w.bulk[j, i], w.cl[j, i], w.solid[j, i], jump, length, 0.0, w)
            w.qr[j, i] = q
            w.qz[j, i] = q
            w.qt[j, i] = q
            w.row_step[j] = min(w.row_step[j], min(limit_of_sound(j, i, rho, q, w), volume_step(loss)))
    if seeded:
        mixed_row(j, w.group_ranges[0, 0], w.kinds[j], w)


@cell_rows
def contact_stress(j, w):
    """Pressure of contact-interface cells at half the step, by their common rate of volume, and normal pressure of the contact.

    Reads    rate, p, bulk, solid, skin, hard, soft, sig_rz [j, i], line [10, j, i]
    Updates  ph, sig_rr, sig_zz, sig_tt [j, i];  writes contact_pressure [j, i], 0 where a cell does not contain both groups
    """
    for i in range(w.group_ranges[1, 0, j, 0], w.group_ranges[1, 0, j, 1]):
        w.contact_pressure[j, i] = 0.0
    for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1]):
        if w.skin[KIND, j, i] == WHOLE:
            pressure = strained_pressure(w.p[j, i], w.bulk[j, i], 0.5 * w.dt * w.rate[j, i])
        else:
            pressure = cut_pressure(j, i, w.rate[j, i], w)
        gain = pressure - w.ph[j, i]
        w.ph[j, i] = pressure
        w.sig_rr[j, i] -= gain
        w.sig_zz[j, i] -= gain
        w.sig_tt[j, i] -= gain
        n_r, n_z = w.line[HARD_R, j, i] + w.line[SOFT_R, j, i], w.line[HARD_Z, j, i] + w.line[SOFT_Z, j, i]
        steep = n_r * n_r + n_z * n_z
        if w.hard[j, i] > 0.0 and w.soft[j, i] > 0.0 and steep > 0.0:
            w.contact_pressure[j, i] = normal_pressure(j, i, n_r, n_z, w.sig_rr, w.sig_zz, w.sig_rz) / steep


@point
def group_force(g, j, i, at_j, at_i, w):
    """Force of the deviators of group g in cell (at_j, at_i), and of its hourglass filter, on vertex (j, i) (as accelerate)."""
    if w.cell_mass[g, at_j, at_i] == 0.0:
        return 0.0, 0.0
    rr, zz, tt, rz = bodies_stress(g, at_j, at_i, w)
    outer, upper = at_i < i, at_j < j  # the vertex is on the outer side of a cell to the left of it
    across, hoop, c_z, along = corner(at_i, outer, upper, w.metrics, w.dz[at_j])
    force_r, force_z = corner_force(rr, zz, tt, rz, across, hoop, c_z, along)
    own, other = w.cell_mass[g, at_j, at_i], w.cell_mass[1 - g, at_j, at_i]
    filter_share = own / (own + other)
    sign = filter_share if outer == upper else -filter_share
    force_r -= sign * w.filter_r[g, at_j, at_i]
    force_z -= sign * w.filter_z[g, at_j, at_i]
    return force_r, force_z


@vertex_rows
def contact_node_forces(j, w):
    """Velocities of both groups at contact nodes from the forces of stresses and sources alone.

    The pressure of a cell acts on each group by the apertures of the cell's faces; the deviators of a group act on it alone
    (explanation/sliding, contact).

    Reads    ph, qr, solid [j, i]; skin [3, j, i]; vof, q; cell_mass, mass, u0, v0, filter_r, filter_z [b, j, i];
             pushed [c, b, j, i], m/s, or empty
    Writes   u, v [b, j, i], without the part that walls and the axis take; transfer[4, j], axial momentum given to walls
    """
    w.transfer[4, j] = 0.0
    for k in range(w.contact_node_count[j]):
        i = w.contact_nodes[j, k]
        ll, lr = w.ph[j - 1, i - 1] + w.qr[j - 1, i - 1], w.ph[j - 1, i] + w.qr[j - 1, i]
        ul, ur = w.ph[j, i - 1] + w.qr[j, i - 1], w.ph[j, i] + w.qr[j, i]
        for g in range(2):
            below, above = w.aperture_r[1, j - 1, i], w.aperture_r[0, j, i]
            left, right = w.aperture_z[1, j, i - 1], w.aperture_z[0, j, i]
            if g == 0:
                below, above, left, right = 1.0 - below, 1.0 - above, 1.0 - left, 1.0 - right
            force_r = 0.5 * w.metrics[FACE_R, i] * (below * w.dz[j - 1] * (ll - lr) + above * w.dz[j] * (ul - ur))
            force_z = w.metrics[AZ_OUT, i - 1] * left * (ll - ul) + w.metrics[AZ_IN, i] * right * (lr - ur)
            tied_r, tied_z = 0.0, 0.0
            for row in range(j - 1, j + 1):
                for column in range(i - 1, i + 1):
                    by_r, by_z = ties(row, column, w)
                    if by_r + by_z > 0.0 and contains_group(g, row, column, w.group, w.vof):
                        pull_r, pull_z = pull_of_ties(g, j, i, row, column, by_r, by_z, w)
                        tied_r += pull_r
                        tied_z += pull_z
                    more_r, more_z = group_force(g, j, i, row, column, w)
                    force_r += more_r
                    force_z += more_z
            w.u[g, j, i] = w.u0[g, j, i] + (w.dt * force_r + tied_r) / w.mass[g, j, i]
            w.v[g, j, i] = w.v0[g, j, i] + (w.dt * force_z + tied_z) / w.mass[g, j, i]
            if w.pushed.shape[0] > 0:
                w.u[g, j, i] += w.pushed[0, g, j, i]
                w.v[g, j, i] += w.pushed[1, g, j, i]
            constrained_r, constrained_z = is_constrained(j, i, w.constrained)
            if constrained_r:
                w.u[g, j, i] = 0.0
            if constrained_z:
                w.transfer[4, j] += w.mass[g, j, i] * w.v[g, j, i]
                w.v[g, j, i] = 0.0


@vertex_rows
def keep_one(j, w):
    """Gives a group without mass at a vertex the other group's velocity, so that a vertex of one group has one velocity.

    Updates  u, v [b, j, i] around hard bodies
    """
    for i in range(max(w.group_ranges[1, 1, j, 0], w.i0), min(w.group_ranges[1, 1, j, 1] + 1, w.i1 + 1)):
        if w.mass[1, j, i] == 0.0:
            w.u[1, j, i] = w.u[0, j, i]
            w.v[1, j, i] = w.v[0, j, i]
        elif w.mass[0, j, i] == 0.0:
            w.u[0, j, i] = w.u[1, j, i]
            w.v[0, j, i] = w.v[1, j, i]
