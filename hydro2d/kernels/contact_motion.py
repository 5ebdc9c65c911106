"""Motion of two groups in contact: viscosity and stress of the cells between them, their forces, impulses and friction."""

from math import sqrt

from hydro2d.fields import RHO, SRR, SRZ, SZZ
from hydro2d.jit import apart, kernel, point, prange, serial
from hydro2d.kernels.acceleration import stress_scale
from hydro2d.kernels.contact import GAP, HARD_R, HARD_Z, HEAVY, SHARE, SOFT_R, SOFT_Z, STUCK
from hydro2d.kernels.contact_volumes import volume_rate
from hydro2d.kernels.deformation import hourglass_mode
from hydro2d.kernels.spans import mixed_row
from hydro2d.kernels.thermodynamics import directional_viscosity

#: void given to cells without pressure whose groups part, so that it takes the opening and nothing is stretched
SEED = 1e-11


@point
def meeting(j, i, edges, hard, soft):
    """Whether both groups are in cell (j, i), or one fills it and the other a cell beside it."""
    h, s = hard[j, i] > 0.0, soft[j, i] > 0.0
    if h and s:
        return True
    for row, column in ((j - 1, i), (j + 1, i), (j, i - 1), (j, i + 1)):
        if edges[0] <= row < edges[1] and edges[2] <= column < edges[3]:
            if (soft[row, column] if h else hard[row, column]) >= 1.0 - GAP:
                return True
    return False


@kernel
def cut_viscosity(j0, j1, edges, linear, quadratic, courant, dr, dz, vol_r, face_r, az_in, az_out, cut, line, around, normal,
                  wet_r, wet_z, hard, soft, u, v, cl, rhobar, vof, q, p, solid, bulk, qr, qz, rate, row_step, mixed_count,
                  mixed, scratch):
    """Volume rate and viscosity of the cut cells, the step they allow, and room where their groups part.

    One q answers to the one rate of volume over the cell's length along the normal, unless the cell has void to lose. Where
    the groups part at a vertex of a cell without pressure where they meet, the cell is given a seed of void.

    Reads    what face_weights wrote; hard, soft [j, i]; u, v [b, j, i]; cl, rhobar, p [j, i]
    Updates  vof [m, j, i], q (rho) [k, m, j, i], solid, bulk [j, i], row_step [j], mixed_count [j], mixed [j, k]
    Writes   qr, qz, rate [j, i] (1/s)
    Scratch  scratch [row, i]
    """
    for j in prange(j0, j1):
        seeded = False
        for i in range(cut[j, 0], cut[j, 1]):
            opens = 0.0
            for row in range(j, j + 2):
                for column in range(i, i + 2):
                    w = (normal[0, 0, row, column] * (u[1, row, column] - u[0, row, column])
                         + normal[0, 1, row, column] * (v[1, row, column] - v[0, row, column]))
                    opens = min(opens, w)
            if opens < 0.0 and p[j, i] <= 0.0 and solid[j, i] > 1.0 - SEED and meeting(j, i, edges, hard, soft):
                for m in range(vof.shape[0]):
                    if vof[m, j, i] > 0.0:
                        vof[m, j, i] *= 1.0 - SEED
                        q[RHO, m, j, i] /= 1.0 - SEED
                solid[j, i] *= 1.0 - SEED
                bulk[j, i] = 0.0
                seeded = True
            h = dz[j]
            volume = vol_r[i] * h
            loss = -volume_rate(j, i, -1, face_r, az_in, az_out, h, wet_r, wet_z, u, v) / volume
            rate[j, i] = -loss
            qr[j, i] = 0.0
            qz[j, i] = 0.0
            rho = rhobar[j, i]
            if rho > 0.0:
                shock = 1.0 if solid[j, i] >= 1.0 - GAP else 0.0
                c = bulk[j, i] / rho
                c = sqrt(c) if c > 0.0 else cl[j, i]
                slope_r = abs(line[HARD_R, j, i] + line[SOFT_R, j, i])
                slope_z = abs(line[HARD_Z, j, i] + line[SOFT_Z, j, i])
                steep = sqrt(slope_r * slope_r + slope_z * slope_z)
                length = steep / (slope_r / dr[i] + slope_z / h) if steep > 0.0 else min(dr[i], h)
                viscosity = shock * directional_viscosity(rho, c, -max(loss, 0.0) * length, 0.0, linear, quadratic)
                qr[j, i] = viscosity
                qz[j, i] = viscosity
                sound = courant * min(dr[i], h) / sqrt(cl[j, i] * cl[j, i] + 2.0 * viscosity / rho)
                row_step[j] = min(row_step[j], min(sound, 0.2 / loss if loss > 0.0 else 1e300))
        if seeded:
            mixed_row(j, around[0, 0], vof, scratch, j, mixed_count, mixed)


@point
def normal_pressure(j, i, n_r, n_z, sig_rr, sig_zz, sig_rz):
    """-n . sigma . n of cell (j, i)."""
    return -(n_r * n_r * sig_rr[j, i] + 2.0 * n_r * n_z * sig_rz[j, i] + n_z * n_z * sig_zz[j, i])


@kernel
def cut_stress(j0, j1, dt, cut, around, line, hard, soft, rate, p, bulk, ph, sig_rr, sig_zz, sig_tt, sig_rz, contact_pressure):
    """The pressure of cut cells at half the step by their one rate of volume, and the normal pressure of the contact.

    Reads    rate, p, bulk, hard, soft, sig_rz [j, i], line [9, j, i]
    Updates  ph, sig_rr, sig_zz, sig_tt [j, i];  writes contact_pressure [j, i], 0 where a cell does not hold both groups
    """
    for j in prange(j0, j1):
        for i in range(around[1, 0, j, 0], around[1, 0, j, 1]):
            contact_pressure[j, i] = 0.0
        for i in range(cut[j, 0], cut[j, 1]):
            pressure = p[j, i] - 0.5 * dt * bulk[j, i] * rate[j, i]
            gain = pressure - ph[j, i]
            ph[j, i] = pressure
            sig_rr[j, i] -= gain
            sig_zz[j, i] -= gain
            sig_tt[j, i] -= gain
            n_r, n_z = line[HARD_R, j, i] + line[SOFT_R, j, i], line[HARD_Z, j, i] + line[SOFT_Z, j, i]
            steep = n_r * n_r + n_z * n_z
            if hard[j, i] > 0.0 and soft[j, i] > 0.0 and steep > 0.0:
                contact_pressure[j, i] = normal_pressure(j, i, n_r, n_z, sig_rr, sig_zz, sig_rz) / steep


@apart
def group_stress(g, j, i, group, solid_mode, solid, vof, q):
    """Deviators that group g gives a cell: (rr, zz, rz), each body's by its share, as in total_stress."""
    scale = stress_scale(solid_mode, solid[j, i])
    rr, zz, rz = 0.0, 0.0, 0.0
    for m in range(vof.shape[0]):
        if group[m] == g and vof[m, j, i] > 0.0:
            part = vof[m, j, i] * scale
            rr += part * q[SRR, m, j, i]
            zz += part * q[SZZ, m, j, i]
            rz += part * q[SRZ, m, j, i]
    return rr, zz, rz


@apart
def corner_force(g, j, i, at_j, at_i, group, solid_mode, solid, vof, q, weight, hard, soft, face_r, hoop, az_in, az_out, mid_r,
                 dz, u0, v0):
    """Force of the deviators of group g in cell (at_j, at_i), and of its hourglass filter, on vertex (j, i) (as accelerate)."""
    share = hard[at_j, at_i] if g == 1 else soft[at_j, at_i]
    if share == 0.0:
        return 0.0, 0.0
    rr, zz, rz = group_stress(g, at_j, at_i, group, solid_mode, solid, vof, q)
    tt = -(rr + zz)
    h = dz[at_j]
    left = at_i < i  # the cell lies left of the vertex, and below it
    low = at_j < j
    area = az_out[at_i] if left else az_in[at_i]
    upward = area if low else -area
    outward = mid_r[at_i] * h if left else -mid_r[at_i] * h
    half = 0.5 * face_r[i]
    normal = h * (half - hoop[at_i]) if left else -h * (half + hoop[at_i])
    force_r = -(normal * rr + hoop[at_i] * h * tt + upward * rz)
    force_z = -(upward * zz + outward * rz)
    w = weight[at_j, at_i] * share / (hard[at_j, at_i] + soft[at_j, at_i])
    sign = w if left == low else -w
    force_r -= sign * hourglass_mode(at_i, u0[g, at_j], u0[g, at_j + 1])
    force_z -= sign * hourglass_mode(at_i, v0[g, at_j], v0[g, at_j + 1])
    return force_r, force_z


@kernel
def shared_forces(j0, j1, dt, group, solid_mode, face_r, hoop, az_in, az_out, mid_r, dz, still, count, shared, wet_r, wet_z,
                  ph, qr, solid, vof, q, weight, hard, soft, mass, u0, v0, trial, exchange):
    """Velocities that the forces alone would give both groups at shared vertices.

    The pressure of a cell acts on each group by the weights of the cell's faces, the deviators of a group act on it alone
    (explanation/sliding, contact).

    Reads    ph, qr, solid, weight, hard, soft [j, i]; vof, q; mass, u0, v0 [b, j, i]
    Writes   trial [c, b, j, i], without what walls and the axis take; exchange[4, j], axial momentum given to walls
    """
    for j in prange(j0, j1 + 1):
        exchange[4, j] = 0.0
        for k in range(count[j]):
            i = shared[j, k]
            ll, lr = ph[j - 1, i - 1] + qr[j - 1, i - 1], ph[j - 1, i] + qr[j - 1, i]
            ul, ur = ph[j, i - 1] + qr[j, i - 1], ph[j, i] + qr[j, i]
            for g in range(2):
                below, above, left, right = wet_r[1, j - 1, i], wet_r[0, j, i], wet_z[1, j, i - 1], wet_z[0, j, i]
                if g == 0:
                    below, above, left, right = 1.0 - below, 1.0 - above, 1.0 - left, 1.0 - right
                force_r = 0.5 * face_r[i] * (below * dz[j - 1] * (ll - lr) + above * dz[j] * (ul - ur))
                force_z = az_out[i - 1] * left * (ll - ul) + az_in[i] * right * (lr - ur)
                for row in range(j - 1, j + 1):
                    for column in range(i - 1, i + 1):
                        more_r, more_z = corner_force(g, j, i, row, column, group, solid_mode, solid, vof, q, weight, hard,
                                                      soft, face_r, hoop, az_in, az_out, mid_r, dz, u0, v0)
                        force_r += more_r
                        force_z += more_z
                trial[0, g, j, i] = u0[g, j, i] + dt * force_r / mass[g, j, i]
                trial[1, g, j, i] = v0[g, j, i] + dt * force_z / mass[g, j, i]
                if i == still[0] or i == still[1]:
                    trial[0, g, j, i] = 0.0
                if j == still[2] or j == still[3]:
                    exchange[4, j] += mass[g, j, i] * trial[1, g, j, i]
                    trial[1, g, j, i] = 0.0


@point
def leader(g, j, i, link):
    """(group, j, i) of the vertex that moves group g of vertex (j, i): itself, or that of a link, its own or its partner's."""
    code = link[g, j, i]
    if code == STUCK:
        g = 1 - g
        code = link[g, j, i]
        if code == HEAVY or code == STUCK:
            return 1 - g, j, i
    elif code == HEAVY:
        return g, j, i
    return g, j + code // 5 - 2, i + code % 5 - 2


@point
def take_tied(g, j, i, still, mass, tied, u, v, exchange):
    """Velocity of a vertex once it carries the momentum tied to it; the axis and walls take their component."""
    m, more = mass[g, j, i], tied[0, g, j, i]
    u[g, j, i] = (m * u[g, j, i] + tied[1, g, j, i]) / (m + more)
    v[g, j, i] = (m * v[g, j, i] + tied[2, g, j, i]) / (m + more)
    if i == still[0] or i == still[1]:
        u[g, j, i] = 0.0
    if j == still[2] or j == still[3]:
        exchange[4, j] += tied[2, g, j, i]
        v[g, j, i] = 0.0


@serial
def tie_light(j0, j1, still, count, shared, link, mass, trial, tied, u, v, exchange):
    """The velocities that the forces give at shared vertices, and at the vertices that light ones give their momentum to.

    Reads    link [b, j, i], mass, trial [c, b, j, i]
    Updates  tied [3, b, j, i] (mass, momentum), 0 before; u, v [b, j, i]; adds to exchange[4, j]
    """
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            for g in range(2):
                by, row, column = leader(g, j, i, link)
                if row != j or column != i:
                    m = mass[g, j, i]
                    tied[0, by, row, column] += m
                    tied[1, by, row, column] += m * trial[0, g, j, i]
                    tied[2, by, row, column] += m * trial[1, g, j, i]
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            for g in range(2):
                u[g, j, i] = trial[0, g, j, i]
                v[g, j, i] = trial[1, g, j, i]
                take_tied(g, j, i, still, mass, tied, u, v, exchange)
                by, row, column = leader(g, j, i, link)
                alone = mass[1 - by, row, column] == 0.0  # a leader that is not shared is not met elsewhere in these rows
                if alone and tied[0, by, row, column] > 0.0:
                    take_tied(by, row, column, still, mass, tied, u, v, exchange)
                    tied[0, by, row, column] *= -1.0  # taken


@point
def pressed(j, i, n_r, n_z, cut, face_r, hoop, az_in, az_out, dz, line, sig_rr, sig_zz, sig_rz):
    """Normal force (N, never negative) on the interface at vertex (j, i): its area there times the mean normal pressure."""
    area_r, area_z, pressure, cells = 0.0, 0.0, 0.0, 0.0
    for row in range(j - 1, j + 1):
        for column in range(i - 1, i + 1):
            if not cut[row, 0] <= column < cut[row, 1]:
                continue
            share = line[SHARE, row, column]
            if share < 0.0:
                continue
            left, low = column < i, row < j
            half = 0.5 * face_r[i] * dz[row]
            area = az_out[column] if left else az_in[column]
            area_r += share * ((half - hoop[column] * dz[row]) if left else -(half + hoop[column] * dz[row]))
            area_z += share * (area if low else -area)
            pressure += normal_pressure(row, column, n_r, n_z, sig_rr, sig_zz, sig_rz)
            cells += 1.0
    return max(pressure / cells, 0.0) * abs(n_r * area_r + n_z * area_z) if cells > 0.0 else 0.0


@point
def give(g, j, i, push_r, push_z, still, mass, tied, u, v, exchange):
    """An impulse to a vertex and what is tied to it; the axis and walls take their component."""
    m = mass[g, j, i] + abs(tied[0, g, j, i])
    if i != still[0] and i != still[1]:
        u[g, j, i] += push_r / m
    if j == still[2] or j == still[3]:
        exchange[4, j] += push_z
    else:
        v[g, j, i] += push_z / m


@serial
def touch_and_rub(j0, j1, dt, friction, still, face_r, hoop, az_in, az_out, dz, cut, line, count, shared, normal, touch, link,
                  sig_rr, sig_zz, sig_rz, mass, tied, u0, v0, u, v, impulse, heat, exchange):
    """Impulses between the groups at shared vertices, friction also between the vertices that these are linked to.

    Where the groups touch and close by every normal, the impulse along that by which they close least gives them one normal
    velocity, unless one is linked: then the pressure between them is enough. Along the tangent there is at most friction
    times the normal impulse, that one and that of the normal stress on the surface. Vertices come one after another, by rows:
    two may be linked to one. A light group that has nothing to move with takes the velocity of the other. An impulse J between
    two velocities makes the heat J . (w0 + w1)/2, w their difference at either end of the step, which is what the work of the
    cells and the kinetic energy differ by (explanation/sliding, contact).

    Reads    mass, u0, v0 [b, j, i]; tied [3, b, j, i]; normal [3, 2, j, i], touch, link; line, sig_.. [j, i]
    Updates  u, v [b, j, i]; heat [b, j, i], J per kg of the group's mass at a vertex; adds to exchange[4, j]
    Writes   exchange[:3, j]: axial momentum that the rest gains from the hard group, heat of contact and of friction
    Scratch  impulse [4, j, i]
    """
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            for part in range(4):
                impulse[part, j, i] = 0.0
            s, j_s, i_s = leader(0, j, i, link)
            h, j_h, i_h = leader(1, j, i, link)
            if s == h:
                continue
            stuck = link[0, j, i] == STUCK or link[1, j, i] == STUCK
            if not stuck and touch[j, i] == 0.0:
                continue
            m_s = mass[0, j_s, i_s] + abs(tied[0, 0, j_s, i_s])
            m_h = mass[1, j_h, i_h] + abs(tied[0, 1, j_h, i_h])
            reduced = m_s * m_h / (m_s + m_h)
            w_r, w_z = u[1, j_h, i_h] - u[0, j_s, i_s], v[1, j_h, i_h] - v[0, j_s, i_s]
            way, closing = 0, 1e300
            for other in range(3):
                w = normal[other, 0, j, i] * w_r + normal[other, 1, j, i] * w_z
                way = other if w < closing else way
                closing = min(closing, w)
            n_r, n_z = normal[way, 0, j, i], normal[way, 1, j, i]
            along_r, along_z = w_r - closing * n_r, w_z - closing * n_z
            slip = sqrt(along_r * along_r + along_z * along_z)
            if stuck:
                push, drag = reduced * closing, reduced * slip
            else:
                itself = j_s == j and i_s == i and j_h == j and i_h == i
                push, drag = reduced * max(closing, 0.0) if itself else 0.0, 0.0
                if friction > 0.0 and slip > 0.0:
                    force = pressed(j, i, n_r, n_z, cut, face_r, hoop, az_in, az_out, dz, line, sig_rr, sig_zz, sig_rz)
                    drag = min(reduced * slip, friction * (push + force * dt))
            t_r = along_r / slip if slip > 0.0 else 0.0
            t_z = along_z / slip if slip > 0.0 else 0.0
            impulse[0, j, i] = push * n_r
            impulse[1, j, i] = push * n_z
            impulse[2, j, i] = drag * t_r
            impulse[3, j, i] = drag * t_z
            give_r, give_z = push * n_r + drag * t_r, push * n_z + drag * t_z
            give(0, j_s, i_s, give_r, give_z, still, mass, tied, u, v, exchange)
            give(1, j_h, i_h, -give_r, -give_z, still, mass, tied, u, v, exchange)
    for j in range(j0, j1 + 1):
        for row in range(3):
            exchange[row, j] = 0.0
        for k in range(count[j]):
            i = shared[j, k]
            s, j_s, i_s = leader(0, j, i, link)
            h, j_h, i_h = leader(1, j, i, link)
            if s == h:
                continue
            w_r = 0.5 * ((u0[1, j_h, i_h] - u0[0, j_s, i_s]) + (u[1, j_h, i_h] - u[0, j_s, i_s]))
            w_z = 0.5 * ((v0[1, j_h, i_h] - v0[0, j_s, i_s]) + (v[1, j_h, i_h] - v[0, j_s, i_s]))
            pushed = impulse[0, j, i] * w_r + impulse[1, j, i] * w_z
            rubbed = impulse[2, j, i] * w_r + impulse[3, j, i] * w_z
            stuck = link[0, j, i] == STUCK or link[1, j, i] == STUCK
            if stuck and mass[1, j, i] > mass[0, j, i]:
                heat[1, j, i] += (pushed + rubbed) / mass[1, j, i]
            else:
                heat[0, j_s, i_s] += (pushed + rubbed) / mass[0, j_s, i_s]
            exchange[0, j] += impulse[1, j, i] + impulse[3, j, i]
            exchange[1, j] += pushed
            exchange[2, j] += rubbed


@serial
def follow(j0, j1, still, count, shared, link, mass, trial, u0, v0, u, v, heat, exchange):
    """Light vertices take the velocity of what they are linked to, and the heat that this makes goes there.

    Reads    link [b, j, i], mass, u0, v0 [b, j, i], trial [c, b, j, i]
    Updates  u, v, heat [b, j, i]; adds to exchange[0, j] and exchange[4, j];  writes exchange[3, j], the heat
    """
    for j in range(j0, j1 + 1):
        exchange[3, j] = 0.0
        for k in range(count[j]):
            i = shared[j, k]
            for g in range(2):
                by, row, column = leader(g, j, i, link)
                if row == j and column == i:
                    continue
                m = mass[g, j, i]
                u[g, j, i] = 0.0 if i == still[0] or i == still[1] else u[by, row, column]
                v[g, j, i] = v[by, row, column]
                if j == still[2] or j == still[3]:
                    v[g, j, i] = 0.0
                    exchange[4, j] += m * v[by, row, column]
                made = 0.5 * m * (
                    (trial[0, g, j, i] - u[g, j, i]) * (u0[g, j, i] + u[g, j, i])
                    - (trial[0, g, j, i] - u[by, row, column]) * (u0[by, row, column] + u[by, row, column])
                    + (trial[1, g, j, i] - v[g, j, i]) * (v0[g, j, i] + v[g, j, i])
                    - (trial[1, g, j, i] - v[by, row, column]) * (v0[by, row, column] + v[by, row, column]))
                heat[by, row, column] += made / mass[by, row, column]
                exchange[3, j] += made
                if by != g:
                    given = m * (v[g, j, i] - trial[1, g, j, i])
                    exchange[0, j] += given if g == 0 else -given


@kernel
def keep_one(j0, j1, i0, i1, around, mass, u, v):
    """Where one group has no mass its velocity is the other's, so that a vertex of one group has one velocity.

    Updates  u, v [b, j, i] around hard bodies
    """
    for j in prange(j0, j1 + 1):
        for i in range(max(around[1, 1, j, 0], i0), min(around[1, 1, j, 1] + 1, i1 + 1)):
            if mass[1, j, i] == 0.0:
                u[1, j, i] = u[0, j, i]
                v[1, j, i] = v[0, j, i]
            elif mass[0, j, i] == 0.0:
                u[0, j, i] = u[1, j, i]
                v[0, j, i] = v[1, j, i]
