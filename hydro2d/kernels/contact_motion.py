"""Stress of the cells between two groups in contact: their one pressure, viscosity, and the forces on either group."""

from math import sqrt

from hydro2d.jit import kernel, point
from hydro2d.kernels.column_ranges import mixed_row, past_row
from hydro2d.kernels.contact_geometry import HARD_R, HARD_Z, SOFT_R, SOFT_Z
from hydro2d.kernels.cut_cells import (
    FREE_SURFACE,
    INTERFACE,
    KIND,
    WHOLE,
    cut_pressure,
    holds,
    normal_deviator,
    pull_of_ties,
    ties,
)
from hydro2d.mesh.fields import RHO, SRR, SRZ, SZZ
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, HOOP, MID_R, VOL_R
from hydro2d.physics.closure import stiff_density
from hydro2d.physics.contact import meeting, volume_rate
from hydro2d.physics.kinematics import hourglass_mode
from hydro2d.physics.stress import normal_pressure, stress_scale
from hydro2d.physics.viscosity import directional_viscosity, shut
from hydro2d.physics.waves import sound_step, volume_step

#: void given to full cells without pressure whose groups part, so that it takes the opening and nothing is stretched
SEED = 1e-11


@point
def come_apart(j, i, normal, u, v):
    """Whether the groups part along the normal at a vertex of cell (j, i)."""
    opens = 0.0
    for row in range(j, j + 2):
        for column in range(i, i + 2):
            w = (normal[0, 0, row, column] * (u[1, row, column] - u[0, row, column])
                 + normal[0, 1, row, column] * (v[1, row, column] - v[0, row, column]))
            opens = min(opens, w)
    return opens < 0.0


@kernel
def contact_viscosity(part, parts, mesh_box, viscosity_linear, viscosity_quadratic, courant, dr, dz, metrics, contact_columns,
                      line, group_ranges, contact_normal, aperture_r, aperture_z, hard, soft, u, v, cl, rhobar, vof, q, km,
                      skin, p, solid, bulk, qr, qz, qt, qrz, rate, row_step, mixed_count, mixed, kinds):
    """Volume rate and viscosity of the contact-interface cells, the step they allow, and room where their groups part.

    A cell of both groups has the density of its mean by compressibility: the stiffer body's mass must not push the other. One q
    answers to the one rate of volume over the cell's length along the normal, the less the more void the cell has to lose.
    Void beside the other group is a gap, across which nothing pulls. Where the groups part at a vertex of a full cell without
    pressure, the cell is given a seed of it.

    Reads    what face_apertures wrote; hard, soft, p, bulk [j, i]; u, v [b, j, i]; km [m, j, i]; cl, rhobar [j, i]
    Updates  vof [m, j, i], q (rho) [k, m, j, i], solid [j, i], skin [3, j, i] (kind), row_step [j], mixed_count [j],
             mixed [j, k]
    Writes   qr, qz, qt, qrz, rate [j, i] (1/s)
    Scratch  kinds [row, i]
    """
    for j in range(parts[part], parts[part + 1]):
        seeded = False
        for i in range(contact_columns[j, 0], contact_columns[j, 1]):
            rho = rhobar[j, i]
            if hard[j, i] > 0.0 and soft[j, i] > 0.0:
                rho = stiff_density(j, i, vof, q, km)
            elif skin[KIND, j, i] == FREE_SURFACE and meeting(j, i, mesh_box, hard, soft):
                skin[KIND, j, i] = INTERFACE
            elif solid[j, i] > 1.0 - SEED and p[j, i] <= 0.0 and meeting(j, i, mesh_box, hard, soft) and come_apart(
                    j, i, contact_normal, u, v):
                for m in range(vof.shape[0]):
                    if vof[m, j, i] > 0.0:
                        vof[m, j, i] *= 1.0 - SEED
                        q[RHO, m, j, i] /= 1.0 - SEED
                solid[j, i] *= 1.0 - SEED
                skin[KIND, j, i] = INTERFACE
                seeded = True
            h = dz[j]
            volume = metrics[VOL_R, i] * h
            loss = -volume_rate(j, i, -1, metrics, h, aperture_r, aperture_z, u, v) / volume
            rate[j, i] = -loss
            qr[j, i] = 0.0
            qz[j, i] = 0.0
            qt[j, i] = 0.0
            qrz[j, i] = 0.0
            if rho > 0.0:
                shock = shut(solid[j, i])
                c = bulk[j, i] / rho
                c = sqrt(c) if c > 0.0 else cl[j, i]
                slope_r = abs(line[HARD_R, j, i] + line[SOFT_R, j, i])
                slope_z = abs(line[HARD_Z, j, i] + line[SOFT_Z, j, i])
                steep = sqrt(slope_r * slope_r + slope_z * slope_z)
                length = steep / (slope_r / dr[i] + slope_z / h) if steep > 0.0 else min(dr[i], h)
                viscosity = shock * directional_viscosity(rho, c, -max(loss, 0.0) * length, 0.0, viscosity_linear,
                                                         viscosity_quadratic)
                qr[j, i] = viscosity
                qz[j, i] = viscosity
                qt[j, i] = viscosity
                sound = sound_step(courant, min(dr[i], h), rho, cl[j, i], viscosity)
                row_step[j] = min(row_step[j], min(sound, volume_step(loss)))
        if seeded:
            mixed_row(j, group_ranges[0, 0], vof, kinds, j, mixed_count, mixed)


@kernel
def contact_stress(part, parts, dt, contact_columns, group_ranges, line, hard, soft, rate, skin, p, bulk, solid, ph, sig_rr,
                   sig_zz, sig_tt, sig_rz, contact_pressure):
    """Pressure of contact-interface cells at half the step by their one rate of volume, and normal pressure of the contact.

    Reads    rate, p, bulk, solid, skin, hard, soft, sig_rz [j, i], line [10, j, i]
    Updates  ph, sig_rr, sig_zz, sig_tt [j, i];  writes contact_pressure [j, i], 0 where a cell does not hold both groups
    """
    for j in range(parts[part], parts[part + 1]):
        for i in range(group_ranges[1, 0, j, 0], group_ranges[1, 0, j, 1]):
            contact_pressure[j, i] = 0.0
        for i in range(contact_columns[j, 0], contact_columns[j, 1]):
            if skin[KIND, j, i] == WHOLE:
                pressure = p[j, i] - 0.5 * dt * bulk[j, i] * rate[j, i]
            else:
                pressure = cut_pressure(j, i, dt, rate[j, i], skin, p, bulk, solid)
            gain = pressure - ph[j, i]
            ph[j, i] = pressure
            sig_rr[j, i] -= gain
            sig_zz[j, i] -= gain
            sig_tt[j, i] -= gain
            n_r, n_z = line[HARD_R, j, i] + line[SOFT_R, j, i], line[HARD_Z, j, i] + line[SOFT_Z, j, i]
            steep = n_r * n_r + n_z * n_z
            if hard[j, i] > 0.0 and soft[j, i] > 0.0 and steep > 0.0:
                contact_pressure[j, i] = normal_pressure(j, i, n_r, n_z, sig_rr, sig_zz, sig_rz) / steep


@point
def group_stress(g, j, i, group, solid_mode, solid, skin, vof, q):
    """What group g gives the stress of a cell beside p_c: (rr, zz, tt, rz), each body's by its share, as in total_stress."""
    scale = stress_scale(solid_mode, solid[j, i])
    rr, zz, tt, rz = 0.0, 0.0, 0.0, 0.0
    for m in range(vof.shape[0]):
        if group[m] == g and vof[m, j, i] > 0.0:
            part = vof[m, j, i] * scale
            across = normal_deviator(m, j, i, skin, q)
            rr += part * (q[SRR, m, j, i] - across)
            zz += part * (q[SZZ, m, j, i] - across)
            tt -= part * (q[SRR, m, j, i] + q[SZZ, m, j, i] + across)
            rz += part * q[SRZ, m, j, i]
    return rr, zz, tt, rz


@point
def corner_force(g, j, i, at_j, at_i, group, solid_mode, solid, skin, vof, q, hg_coefficient, cell_mass, metrics, dz, u0, v0):
    """Force of the deviators of group g in cell (at_j, at_i), and of its hourglass filter, on vertex (j, i) (as accelerate)."""
    if cell_mass[g, at_j, at_i] == 0.0:
        return 0.0, 0.0
    rr, zz, tt, rz = group_stress(g, at_j, at_i, group, solid_mode, solid, skin, vof, q)
    h = dz[at_j]
    left = at_i < i  # the cell lies left of the vertex, and below it
    low = at_j < j
    area = metrics[AZ_OUT, at_i] if left else metrics[AZ_IN, at_i]
    upward = area if low else -area
    outward = metrics[MID_R, at_i] * h if left else -metrics[MID_R, at_i] * h
    half = 0.5 * metrics[FACE_R, i]
    normal = h * (half - metrics[HOOP, at_i]) if left else -h * (half + metrics[HOOP, at_i])
    force_r = -(normal * rr + metrics[HOOP, at_i] * h * tt + upward * rz)
    force_z = -(upward * zz + outward * rz)
    w = hg_coefficient[at_j, at_i] * cell_mass[g, at_j, at_i] / (cell_mass[0, at_j, at_i] + cell_mass[1, at_j, at_i])
    sign = w if left == low else -w
    force_r -= sign * hourglass_mode(at_i, u0[g, at_j], u0[g, at_j + 1])
    force_z -= sign * hourglass_mode(at_i, v0[g, at_j], v0[g, at_j + 1])
    return force_r, force_z


@kernel
def contact_node_forces(part, parts, dt, group, gases, by_what_is_solid, metrics, dz, constrained, contact_node_count,
                        contact_nodes, aperture_r, aperture_z, ph, qr, solid, skin, vof, q, hg_coefficient, cell_mass, mass,
                        pushed, u0, v0, u, v, transfer):
    """Velocities that the forces alone, of stresses and of sources, would give both groups at contact nodes.

    The pressure of a cell acts on each group by the apertures of the cell's faces, the deviators of a group act on it alone
    (explanation/sliding, contact).

    Reads    ph, qr, solid, hg_coefficient [j, i]; skin [3, j, i]; vof, q; cell_mass, mass, u0, v0 [b, j, i];
             pushed [c, b, j, i], m/s, or nothing
    Writes   u, v [b, j, i], without what walls and the axis take; transfer[4, j], axial momentum given to walls
    """
    for j in range(parts[part], past_row(part, parts, 1)):
        transfer[4, j] = 0.0
        for k in range(contact_node_count[j]):
            i = contact_nodes[j, k]
            ll, lr = ph[j - 1, i - 1] + qr[j - 1, i - 1], ph[j - 1, i] + qr[j - 1, i]
            ul, ur = ph[j, i - 1] + qr[j, i - 1], ph[j, i] + qr[j, i]
            for g in range(2):
                below, above = aperture_r[1, j - 1, i], aperture_r[0, j, i]
                left, right = aperture_z[1, j, i - 1], aperture_z[0, j, i]
                if g == 0:
                    below, above, left, right = 1.0 - below, 1.0 - above, 1.0 - left, 1.0 - right
                force_r = 0.5 * metrics[FACE_R, i] * (below * dz[j - 1] * (ll - lr) + above * dz[j] * (ul - ur))
                force_z = metrics[AZ_OUT, i - 1] * left * (ll - ul) + metrics[AZ_IN, i] * right * (lr - ur)
                tied_r, tied_z = 0.0, 0.0
                for row in range(j - 1, j + 1):
                    for column in range(i - 1, i + 1):
                        by_r, by_z = ties(row, column, metrics, dz[row], skin, gases, vof, q)
                        if by_r + by_z > 0.0 and holds(g, row, column, group, vof):
                            tied_r += pull_of_ties(g, j, i, row, column, by_r, by_z, u0)
                            tied_z += pull_of_ties(g, j, i, row, column, by_r, by_z, v0)
                        more_r, more_z = corner_force(g, j, i, row, column, group, by_what_is_solid, solid, skin, vof, q,
                                                      hg_coefficient, cell_mass, metrics, dz, u0, v0)
                        force_r += more_r
                        force_z += more_z
                u[g, j, i] = u0[g, j, i] + (dt * force_r + tied_r) / mass[g, j, i]
                v[g, j, i] = v0[g, j, i] + (dt * force_z + tied_z) / mass[g, j, i]
                if pushed.shape[0] > 0:
                    u[g, j, i] += pushed[0, g, j, i]
                    v[g, j, i] += pushed[1, g, j, i]
                if i == constrained[0] or i == constrained[1]:
                    u[g, j, i] = 0.0
                if j == constrained[2] or j == constrained[3]:
                    transfer[4, j] += mass[g, j, i] * v[g, j, i]
                    v[g, j, i] = 0.0


@kernel
def keep_one(part, parts, i0, i1, group_ranges, mass, u, v):
    """Where one group has no mass its velocity is the other's, so that a vertex of one group has one velocity.

    Updates  u, v [b, j, i] around hard bodies
    """
    for j in range(parts[part], past_row(part, parts, 1)):
        for i in range(max(group_ranges[1, 1, j, 0], i0), min(group_ranges[1, 1, j, 1] + 1, i1 + 1)):
            if mass[1, j, i] == 0.0:
                u[1, j, i] = u[0, j, i]
                v[1, j, i] = v[0, j, i]
            elif mass[0, j, i] == 0.0:
                u[0, j, i] = u[1, j, i]
                v[0, j, i] = v[1, j, i]
