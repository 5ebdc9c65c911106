"""Contact of two body groups that move with velocities of their own: where they meet, their forces, and their volumes.

Group 1 are the hard bodies, group 0 the rest. A vertex at which both have mass is shared; the cells around shared vertices are
cut, and everything here is done in the columns cut[j] of every row, the smallest range that holds its cut cells. Elsewhere one
group is alone and the other kernels are right (explanation/sliding, contact).

A face has for either end the weight of the hard group, wet[end, j, i]; that of the rest is what is missing to 1.
"""

from math import sqrt

from hydro2d.fields import RHO, SRR, SRZ, SZZ, E
from hydro2d.jit import apart, kernel, point, prange, serial
from hydro2d.kernels.acceleration import TINY, stress_scale
from hydro2d.kernels.deformation import hourglass_mode
from hydro2d.kernels.interfaces import FULL, cumulative, line_constant, strip_share, youngs_normal
from hydro2d.kernels.spans import mixed_row, union
from hydro2d.kernels.thermodynamics import directional_viscosity

#: share of its dual cell below which a group is light at a vertex, and moves with a neighbour
LIGHT = 0.05
#: share of void in a cell of both groups up to which they touch
GAP = 0.01
#: void given to cells without pressure whose groups part, so that it takes the opening and nothing is stretched
SEED = 1e-11

#: square of the ratio of two slopes from which the steeper surface alone draws the line
FLATTER = 1.0 + 1e-12

#: rows of `line`: normal of the hard side in the unit square, its constant, share of the hard among the solids; slopes, down
#: the hard bodies' fraction and up that of the rest; the group whose surface is the flatter, 1 where none is
LINE_R, LINE_Z, CONSTANT, SHARE, HARD_R, HARD_Z, SOFT_R, SOFT_Z, FIRST = range(9)

#: how a light vertex moves: 0 to 24 with a vertex of its own group up to two away, else
HEAVY, STUCK = -1, 25


@kernel
def find_shared(j0, j1, edges, around, mass, group, vof, count, shared, hard, soft, tied, heat):
    """Shared vertices of rows j0 to j1, and what hard and other bodies fill of the cells near hard ones.

    Reads    around[1] [n, j, 2], the columns near hard bodies; mass [b, j, i]; vof [m, j, i]; group [m]
    Writes   count [j], shared [j, k] (columns, ascending); hard, soft [j, i]; zero in tied [3, b, j, i] and heat [b, j, i]
    """
    for j in prange(j0, j1 + 1):
        found = 0
        for i in range(max(around[1, 1, j, 0], edges[2]), min(around[1, 1, j, 1] + 1, edges[3] + 1)):
            for g in range(2):
                heat[g, j, i] = 0.0
                for c in range(3):
                    tied[c, g, j, i] = 0.0
            if mass[0, j, i] > 0.0 and mass[1, j, i] > 0.0:
                shared[j, found] = i
                found += 1
        count[j] = found
        if j < j1:
            for i in range(around[1, 0, j, 0], around[1, 0, j, 1]):
                hard[j, i] = 0.0
                soft[j, i] = 0.0
            for m in range(vof.shape[0]):
                for i in range(around[1, 0, j, 0], around[1, 0, j, 1]):
                    if group[m] == 1:
                        hard[j, i] += vof[m, j, i]
                    else:
                        soft[j, i] += vof[m, j, i]


@point
def slope(j, i, below, above, left, right, dr, dz, f):
    """Youngs' difference of a fraction over the 3 x 3 cells between the given rows and columns, downwards, per cell."""
    along_r = ((f[above, left] + f[below, left]) + 2.0 * f[j, left]) - ((f[above, right] + f[below, right]) + 2.0 * f[j, right])
    along_z = ((f[below, left] + f[below, right]) + 2.0 * f[below, i]) - ((f[above, left] + f[above, right]) + 2.0 * f[above, i])
    along_r *= dr[i] / (dr[i] + 0.5 * (dr[i - 1] + dr[i + 1]))
    along_z *= dz[j] / (dz[j] + 0.5 * (dz[j - 1] + dz[j + 1]))
    return along_r, along_z


@kernel
def cut_lines(j0, j1, edges, dr, dz, count, shared, hard, soft, cut, line):
    """The cut columns of every row, and in them the line that parts the hard side of a cell from the rest.

    The normal is Youngs' from f_hard - f_soft, the line encloses the hard share of what is solid. Near void, where one of the
    two surfaces has a corner, the steeper slope is that of the flat one: then the line is its own, and the void of the cell
    lies on the other side. Beyond the edges of the mesh the cells beside them are repeated.

    Reads    count [j], shared [j, k]; hard, soft [j, i]
    Writes   cut [j, 2]; line [9, j, i]
    """
    for j in prange(j0, j1):
        lo, hi = 1 << 30, 0
        for row in range(j, j + 2):
            if count[row] > 0:
                lo = min(lo, shared[row, 0] - 1)
                hi = max(hi, shared[row, count[row] - 1] + 1)
        if lo < hi:
            lo = max(lo, edges[2])
            hi = min(hi, edges[3])
        cut[j, 0] = lo
        cut[j, 1] = hi
        below, above = max(j - 1, edges[0]), min(j + 1, edges[1] - 1)
        for i in range(lo, hi):
            left, right = max(i - 1, edges[2]), min(i + 1, edges[3] - 1)
            hard_r, hard_z = slope(j, i, below, above, left, right, dr, dz, hard)
            soft_r, soft_z = slope(j, i, below, above, left, right, dr, dz, soft)
            along_r, along_z = hard_r - soft_r, hard_z - soft_z
            steep_h, steep_s = hard_r * hard_r + hard_z * hard_z, soft_r * soft_r + soft_z * soft_z
            size = abs(along_r) + abs(along_z)
            total = hard[j, i] + soft[j, i]
            share = min(max(hard[j, i] / total, 0.0), 1.0) if total > 0.0 else -1.0
            line[HARD_R, j, i] = hard_r / dr[i]
            line[HARD_Z, j, i] = hard_z / dz[j]
            line[SOFT_R, j, i] = -soft_r / dr[i]
            line[SOFT_Z, j, i] = -soft_z / dz[j]
            line[SHARE, j, i] = share
            line[FIRST, j, i] = 0.0 if steep_s > FLATTER * steep_h else 1.0
            line[LINE_R, j, i] = 0.0
            line[LINE_Z, j, i] = 0.0
            line[CONSTANT, j, i] = 0.0
            if size > 1e-14 and 0.0 < share < 1.0:
                if steep_s > FLATTER * steep_h:
                    along_r, along_z, share = -soft_r, -soft_z, 1.0 - soft[j, i]
                elif steep_h > FLATTER * steep_s:
                    along_r, along_z, share = hard_r, hard_z, hard[j, i]
                size = abs(along_r) + abs(along_z)
                n_r, n_z = along_r / size, along_z / size
                line[LINE_R, j, i] = n_r
                line[LINE_Z, j, i] = n_z
                line[CONSTANT, j, i] = line_constant(abs(n_r), abs(n_z), share) + min(n_r, 0.0) + min(n_z, 0.0)


@point
def wetted(first, last):
    """Weights of both ends of a face, of which the part with a level above 0 is wetted; levels at the ends, linear between.

    Over the wetted part of length a from one end: (2 a - a^2, a^2), the integrals of the two linear shape functions.
    """
    if first >= 0.0 and last >= 0.0:
        return 1.0, 1.0
    if first < 0.0 and last < 0.0:
        return 0.0, 0.0
    if first >= 0.0:
        a = first / (first - last)
        return (2.0 - a) * a, a * a
    a = last / (last - first)
    return a * a, (2.0 - a) * a


@point
def trace(j, i, x0, y0, x1, y1, inside, line, hard, soft):
    """(solid, weights of the hard side at both ends) of the edge (x0, y0) to (x1, y1) of the unit square of cell (j, i)."""
    if not inside:
        total = hard[j, i] + soft[j, i]
        share = hard[j, i] / total if total > 0.0 else 0.0
        return (1.0 if total > 0.0 else 0.0), share, share
    share = line[SHARE, j, i]
    if share < 0.0:
        return 0.0, 0.0, 0.0
    n_r, n_z, constant = line[LINE_R, j, i], line[LINE_Z, j, i], line[CONSTANT, j, i]
    if n_r == 0.0 and n_z == 0.0:
        return 1.0, share, share
    first, last = wetted(constant - (n_r * x0 + n_z * y0), constant - (n_r * x1 + n_z * y1))
    return 1.0, first, last


@point
def known(weight, rest, hard_mass):
    """A weight, all of which goes to the group that is alone at a vertex."""
    if hard_mass == 0.0:
        return 0.0
    return 1.0 if rest == 0.0 else weight


@kernel
def face_weights(j0, j1, edges, still, cut, line, hard, soft, mass, count, shared, wet_r, wet_z, normal, touch):
    """Weights of the hard group on the faces around shared vertices, and normals and contact at these.

    The weight of a face is the mean of what the lines of both neighbours wet of it. A normal is the mean of the four cells'
    slopes, from hard to soft, along the axis and along walls: of f_hard - f_soft, of f_hard, and of -f_soft, which differ
    where void is near. Groups touch where a cell holds both and no more than GAP of
    void, or where a full cell of one is a neighbour of a full cell of the other.

    Reads    cut [j, 2], line [9, j, i], hard, soft [j, i], mass [b, j, i], count [j], shared [j, k]
    Writes   wet_r, wet_z [end, j, i]; normal [3, 2, j, i], touch [j, i] at shared vertices
    """
    for j in prange(j0, j1 + 1):
        if j < j1:
            for i in range(cut[j, 0], cut[j, 1] + 1):
                solid_l, low_l, high_l = 0.0, 0.0, 0.0
                solid_r, low_r, high_r = 0.0, 0.0, 0.0
                if i > edges[2]:
                    solid_l, low_l, high_l = trace(j, i - 1, 1.0, 0.0, 1.0, 1.0, i - 1 >= cut[j, 0], line, hard, soft)
                if i < edges[3]:
                    solid_r, low_r, high_r = trace(j, i, 0.0, 0.0, 0.0, 1.0, i < cut[j, 1], line, hard, soft)
                number = max(solid_l + solid_r, 1.0)
                wet_r[0, j, i] = known((low_l + low_r) / number, mass[0, j, i], mass[1, j, i])
                wet_r[1, j, i] = known((high_l + high_r) / number, mass[0, j + 1, i], mass[1, j + 1, i])
        lo, hi = union(cut, max(j - 1, j0), min(j + 1, j1))
        for i in range(lo, hi):
            solid_b, in_b, out_b = 0.0, 0.0, 0.0
            solid_t, in_t, out_t = 0.0, 0.0, 0.0
            if j > edges[0]:
                solid_b, in_b, out_b = trace(j - 1, i, 0.0, 1.0, 1.0, 1.0, cut[j - 1, 0] <= i < cut[j - 1, 1], line, hard, soft)
            if j < edges[1]:
                solid_t, in_t, out_t = trace(j, i, 0.0, 0.0, 1.0, 0.0, cut[j, 0] <= i < cut[j, 1], line, hard, soft)
            number = max(solid_b + solid_t, 1.0)
            wet_z[0, j, i] = known((in_b + in_t) / number, mass[0, j, i], mass[1, j, i])
            wet_z[1, j, i] = known((out_b + out_t) / number, mass[0, j, i + 1], mass[1, j, i + 1])
        for k in range(count[j]):
            i = shared[j, k]
            hard_r, hard_z, soft_r, soft_z = 0.0, 0.0, 0.0, 0.0
            both, full_hard, full_soft = 1.0, 0, 0
            for row in range(max(j - 1, edges[0]), min(j + 1, edges[1])):
                for column in range(max(i - 1, edges[2]), min(i + 1, edges[3])):
                    hard_r += line[HARD_R, row, column]
                    hard_z += line[HARD_Z, row, column]
                    soft_r += line[SOFT_R, row, column]
                    soft_z += line[SOFT_Z, row, column]
                    h, s = hard[row, column], soft[row, column]
                    if h > 0.0 and s > 0.0:
                        both = min(both, 1.0 - (h + s))
                    full_hard += 1 if h > 1.0 - GAP else 0
                    full_soft += 1 if s > 1.0 - GAP else 0
            free_r = 0.0 if i == still[0] or i == still[1] else 1.0
            free_z = 0.0 if j == still[2] or j == still[3] else 1.0
            for way in range(3):
                n_r = free_r * ((hard_r if way != 2 else 0.0) + (soft_r if way != 1 else 0.0))
                n_z = free_z * ((hard_z if way != 2 else 0.0) + (soft_z if way != 1 else 0.0))
                size = sqrt(n_r * n_r + n_z * n_z)
                normal[way, 0, j, i] = n_r / size if size > 0.0 else 0.0
                normal[way, 1, j, i] = n_z / size if size > 0.0 else 0.0
            touch[j, i] = 1.0 if both <= GAP or (full_hard > 0 and full_soft > 0) else 0.0


@point
def blend(weight, hard, soft):
    """Velocity of a face at one end: the hard group's by its weight, the other's for the rest."""
    return weight * hard + (1.0 - weight) * soft


@point
def face_flow_r(j, i, g, wet_r, u):
    """Sum over both ends of the velocity of r-face (j, i): of group g, or of both by weight for g < 0."""
    if g >= 0:
        return u[g, j, i] + u[g, j + 1, i]
    return blend(wet_r[0, j, i], u[1, j, i], u[0, j, i]) + blend(wet_r[1, j, i], u[1, j + 1, i], u[0, j + 1, i])


@point
def face_flow_z(j, i, g, az_in, az_out, wet_z, v):
    """Volume per time through z-face (j, i), of group g or of both by weight for g < 0."""
    if g >= 0:
        return az_in[i] * v[g, j, i] + az_out[i] * v[g, j, i + 1]
    return az_in[i] * blend(wet_z[0, j, i], v[1, j, i], v[0, j, i]) + az_out[i] * blend(
        wet_z[1, j, i], v[1, j, i + 1], v[0, j, i + 1])


@point
def volume_rate(j, i, g, face_r, az_in, az_out, h, wet_r, wet_z, u, v):
    """Rate of change of the volume of cell (j, i) with the velocities of group g, or with both by weight for g < 0."""
    radial = face_r[i + 1] * face_flow_r(j, i + 1, g, wet_r, u) - face_r[i] * face_flow_r(j, i, g, wet_r, u)
    axial = face_flow_z(j + 1, i, g, az_in, az_out, wet_z, v) - face_flow_z(j, i, g, az_in, az_out, wet_z, v)
    return 0.5 * h * radial + axial


@kernel
def cut_viscosity(j0, j1, linear, quadratic, courant, dr, dz, vol_r, face_r, az_in, az_out, cut, line, around, normal,
                  wet_r, wet_z, u, v, cl, rhobar, vof, q, p, solid, bulk, qr, qz, rate, row_step, mixed_count, mixed,
                  scratch):
    """Volume rate and viscosity of the cut cells, the step they allow, and room where their groups part.

    One q answers to the one rate of volume over the cell's length along the normal, unless the cell has void to lose. Where the groups part at a vertex of a
    cell without pressure, the cell is given a seed of void.

    Reads    what face_weights wrote; u, v [b, j, i]; cl, rhobar, p [j, i]
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
            if opens < 0.0 and p[j, i] <= 0.0 and solid[j, i] > 1.0 - SEED:
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
def shared_forces(j0, j1, dt, group, solid_mode, face_r, hoop, az_in, az_out, mid_r, dz, still, count, shared, wet_r, wet_z, ph, qr,
                  solid, vof, q, weight, hard, soft, mass, u0, v0, trial, exchange):
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
                        more_r, more_z = corner_force(g, j, i, row, column, group, solid_mode, solid, vof, q, weight, hard, soft,
                                                      face_r, hoop, az_in, az_out, mid_r, dz, u0, v0)
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
def dual_share(g, j, i, edges, volume, cm_in, cm_out, hard, soft):
    """Share of the dual cell of vertex (j, i), as far as it lies in the mesh, that group g fills."""
    whole, part = 0.0, 0.0
    for row in range(max(j - 1, edges[0]), min(j + 1, edges[1])):
        for column in range(max(i - 1, edges[2]), min(i + 1, edges[3])):
            corner = volume[row, column] * (cm_out[column] if column < i else cm_in[column])
            whole += corner
            part += corner * (hard[row, column] if g == 1 else soft[row, column])
    return part / whole


@kernel
def link_light(j0, j1, edges, volume, cm_in, cm_out, count, shared, normal, hard, soft, mass, link):
    """How each group moves at a shared vertex: by itself, or, where it is light, with a vertex towards its inside.

    It is the one among its neighbours, or else among those two away, with the largest share of the group times the cosine
    between its direction and the normal inwards over the distance. Where there is none the group sticks to the other.

    Reads    normal [3, 2, j, i], hard, soft [j, i], mass [b, j, i]
    Writes   link [b, j, i]: HEAVY, 5 (dj + 2) + (di + 2), or STUCK to the other group
    """
    for j in prange(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            for g in range(2):
                link[g, j, i] = HEAVY
                if dual_share(g, j, i, edges, volume, cm_in, cm_out, hard, soft) >= LIGHT:
                    continue
                link[g, j, i] = STUCK
                most = 0.0
                inward = 1.0 if g == 0 else -1.0
                for ring in range(1, 3):
                    for dj in range(-ring, ring + 1):
                        for di in range(-ring, ring + 1):
                            row, column = j + dj, i + di
                            if max(abs(dj), abs(di)) < ring or row < edges[0] or row > edges[1]:
                                continue
                            if column < edges[2] or column > edges[3] or mass[g, row, column] == 0.0:
                                continue
                            share = dual_share(g, row, column, edges, volume, cm_in, cm_out, hard, soft)
                            along = inward * (normal[0, 0, j, i] * di + normal[0, 1, j, i] * dj) / (di * di + dj * dj)
                            if share >= LIGHT and share * along > most * (1.0 + 1e-9):
                                most = share * along
                                link[g, j, i] = 5 * (dj + 2) + (di + 2)
                    if most > 0.0:
                        break


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
def join(j0, j1, dt, friction, still, face_r, hoop, az_in, az_out, dz, cut, line, count, shared, normal, touch, link,
         sig_rr, sig_zz, sig_rz, mass, trial, tied, u0, v0, u, v, heat, exchange):
    """The velocities of both groups at shared vertices at the end of the step.

    Light vertices first: their momentum goes to the vertex that they are linked to, and they take its velocity. Then the contact:
    where the groups touch and close by every normal, the impulse along that by which they close least that gives them one
    normal velocity, and along the tangent at most friction times the normal impulse, that of the impulse and that of the normal stress on the surface. Each impulse
    J between two velocities makes the heat J . (w0 + w1)/2, w the difference of the two at either end of the step, which is
    what the work of the cells and the kinetic energy differ by (explanation/sliding, contact).

    Reads    still; mass, u0, v0 [b, j, i]; trial [c, b, j, i]; normal [3, 2, j, i], touch, link; line, sig_.. [j, i]
    Updates  u, v [b, j, i]; tied [3, b, j, i] (mass, momentum)
    Writes   heat [b, j, i], J per kg of the group's mass at a vertex; exchange[:4, j]: axial momentum that the rest gains
             from the hard group, and the heat of contact, of friction and of light vertices; adds to exchange[4, j]
    """
    for j in range(j0, j1 + 1):
        for row in range(4):
            exchange[row, j] = 0.0
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
                    tied[0, by, row, column] = 0.0
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            if 0 <= link[0, j, i] < STUCK or 0 <= link[1, j, i] < STUCK:
                continue
            stuck = link[0, j, i] == STUCK or link[1, j, i] == STUCK
            m_s = mass[0, j, i] + tied[0, 0, j, i]
            m_h = mass[1, j, i] + tied[0, 1, j, i]
            reduced = m_s * m_h / (m_s + m_h)
            w_r, w_z = u[1, j, i] - u[0, j, i], v[1, j, i] - v[0, j, i]
            way, closing = 0, 1e300
            for other in range(3):
                w = normal[other, 0, j, i] * w_r + normal[other, 1, j, i] * w_z
                way = other if w < closing else way
                closing = min(closing, w)
            n_r, n_z = normal[way, 0, j, i], normal[way, 1, j, i]
            along_r, along_z = w_r - closing * n_r, w_z - closing * n_z
            slip = sqrt(along_r * along_r + along_z * along_z)
            push, drag = 0.0, 0.0
            if stuck:
                push, drag = reduced * closing, reduced * slip
            elif touch[j, i] > 0.0:
                push = reduced * max(closing, 0.0)
                if friction > 0.0 and slip > 0.0:
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
                    area = abs(n_r * area_r + n_z * area_z)
                    pressed = max(pressure / cells, 0.0) * area * dt if cells > 0.0 else 0.0
                    drag = min(reduced * slip, friction * (push + pressed))
            t_r = along_r / slip if slip > 0.0 else 0.0
            t_z = along_z / slip if slip > 0.0 else 0.0
            push_r, push_z, drag_r, drag_z = push * n_r, push * n_z, drag * t_r, drag * t_z
            u[1, j, i] -= (push_r + drag_r) / m_h
            v[1, j, i] -= (push_z + drag_z) / m_h
            u[0, j, i] += (push_r + drag_r) / m_s
            v[0, j, i] += (push_z + drag_z) / m_s
            w_r = 0.5 * ((u0[1, j, i] - u0[0, j, i]) + (u[1, j, i] - u[0, j, i]))
            w_z = 0.5 * ((v0[1, j, i] - v0[0, j, i]) + (v[1, j, i] - v[0, j, i]))
            pushed, rubbed = push_r * w_r + push_z * w_z, drag_r * w_r + drag_z * w_z
            taker = 1 if stuck and mass[1, j, i] > mass[0, j, i] else 0
            heat[taker, j, i] += (pushed + rubbed) / mass[taker, j, i]
            exchange[0, j] += push_z + drag_z
            exchange[1, j] += pushed
            exchange[2, j] += rubbed
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            for g in range(2):
                by, row, column = leader(g, j, i, link)
                if row == j and column == i:
                    continue
                m = mass[g, j, i]
                u[g, j, i] = 0.0 if i == still[0] or i == still[1] else u[by, row, column]
                v[g, j, i] = 0.0 if j == still[2] or j == still[3] else v[by, row, column]
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


@kernel
def cut_volumes(j0, j1, dt, face_r, az_in, az_out, dz, cut, wet_r, wet_z, u0, v0, u, v, fr, fz, own_r, own_z):
    """Volumes swept in the step by the faces of cut cells: by weight, and by each group as if it were alone.

    Reads    u0, v0, u, v [b, j, i]
    Writes   fr, fz [j, i]; own_r, own_z [b, j, i]
    """
    for j in prange(j0, j1 + 1):
        if j < j1:
            for i in range(cut[j, 0], cut[j, 1] + 1):
                scale = 0.25 * dt * face_r[i] * dz[j]
                fr[j, i] = scale * (face_flow_r(j, i, -1, wet_r, u) + face_flow_r(j, i, -1, wet_r, u0))
                for g in range(2):
                    own_r[g, j, i] = scale * (face_flow_r(j, i, g, wet_r, u) + face_flow_r(j, i, g, wet_r, u0))
        lo, hi = union(cut, max(j - 1, j0), min(j + 1, j1))
        for i in range(lo, hi):
            fz[j, i] = 0.5 * dt * (face_flow_z(j, i, -1, az_in, az_out, wet_z, v) + face_flow_z(j, i, -1, az_in, az_out, wet_z, v0))
            for g in range(2):
                own_z[g, j, i] = 0.5 * dt * (face_flow_z(j, i, g, az_in, az_out, wet_z, v)
                                             + face_flow_z(j, i, g, az_in, az_out, wet_z, v0))


@kernel
def cut_work(j0, j1, dt, face_r, az_in, az_out, dz, cut, group, wet_r, wet_z, ph, qr, u0, v0, u, v, fr, fz, cell_mass, vof, q):
    """Pressure work in the pure cells among the cut ones: by the volume that they lose, not by their group's own.

    `deform` does the work of the group's own rate of volume; this is what is missing.

    Reads    ph, qr [j, i], velocities, fr, fz [j, i], cell_mass [b, j, i]
    Updates  q (e) [k, m, j, i]
    """
    for j in prange(j0, j1):
        for i in range(cut[j, 0], cut[j, 1]):
            for m in range(vof.shape[0]):
                if vof[m, j, i] == 1.0:
                    g = group[m]
                    own = 0.5 * dt * (volume_rate(j, i, g, face_r, az_in, az_out, dz[j], wet_r, wet_z, u, v)
                                      + volume_rate(j, i, g, face_r, az_in, az_out, dz[j], wet_r, wet_z, u0, v0))
                    change = (fr[j, i + 1] - fr[j, i]) + (fz[j + 1, i] - fz[j, i])
                    q[E, m, j, i] -= (ph[j, i] + qr[j, i]) * (change - own) / cell_mass[g, j, i]


@kernel
def cut_shares(j0, j1, edges, cut, volume, pre, vof, part, size):
    """Fractions of a volume that void does not stretch, in the cut cells and two around them.

    A cell with void that one group leaves grows, and with it what the fractions say of the group that rests in it: its line
    would move and turn. The fractions here are of the volume that the cell had, or of what its bodies fill if that is more;
    a full cell keeps its own.

    Reads    volume, pre [j, i], vof [m, j, i]
    Writes   part [m, j, i], the fractions; size [j, i] (m^3), the volume that they are of
    """
    for j in prange(j0 - 2, j1 + 2):
        lo, hi = union(cut, max(j - 2, j0), min(j + 3, j1))
        for i in range(lo - 2, hi + 2):
            total = 0.0
            for m in range(vof.shape[0]):
                total += vof[m, j, i]
            scale = 1.0
            inside = edges[0] <= j < edges[1] and edges[2] <= i < edges[3]
            if inside and 0.0 < total < 1.0 - FULL:
                scale = min(pre[j, i] / volume[j, i], 1.0 / total)
            for m in range(vof.shape[0]):
                part[m, j, i] = vof[m, j, i] * scale
            size[j, i] = pre[j, i] / scale


@apart
def strip_of(m, j, i, along_z, width, high, order, part, dr, dz):
    """Volume of body m in a strip of cell (j, i), as a share of the cell; nested in the order, never more than there is."""
    below, total, given = 0.0, 0.0, 0.0
    for k in range(order.shape[0]):
        f = part[order[k], j, i]
        total += f
        total = total if total < 1.0 - FULL else 1.0
        if f == 0.0:
            continue
        n_r, n_z = youngs_normal(j, i, k, order, part, dr, dz)
        if along_z:
            n_r, n_z = n_z, n_r
        filled = strip_share(n_r, n_z, total, width, high)
        filled = min(max(filled, max(below, width - (1.0 - total))), min(below + f, width))
        given = filled - below
        if order[k] == m:
            break
        below = filled
    return given


@kernel
def cut_fluxes(dj, di, j0, j1, edges, dr, dz, orders, group, cut, line, face, own, part, size, vof, flux_volume):
    """Volume of every body through the faces of cut cells, with the velocity of its group.

    In a cell the group with the flatter surface comes first among the nested interfaces. What the bodies together are short of,
    or beyond, the volume that the face sweeps goes to the largest body of the cell that loses it, unless that cell has void.

    Reads    face [j, i], own [b, j, i], what cut_shares wrote, vof [m, j, i], group [m], line [9, j, i]; orders [b, m], with
             the bodies of group b first
    Updates  flux_volume [m, j, i]
    """
    bodies = group.shape[0]
    for j in prange(j0, j1 + dj):
        lo, hi = union(cut, max(j - dj, j0), min(j + 1, j1))
        if lo >= hi:
            continue
        for i in range(lo, hi + di):
            if (di == 1 and (i == edges[2] or i == edges[3])) or (dj == 1 and (j == edges[0] or j == edges[1])):
                continue
            total = 0.0
            for m in range(bodies):
                swept = own[group[m], j, i]
                up = swept > 0.0
                row, column = (j - dj, i - di) if up else (j, i)
                volume = 0.0
                if vof[m, row, column] == 1.0:
                    volume = swept
                elif vof[m, row, column] > 0.0 and swept != 0.0:
                    width = min(abs(swept) / size[row, column], 1.0)
                    first = 1
                    if cut[row, 0] <= column < cut[row, 1]:
                        first = int(line[FIRST, row, column])
                    given = strip_of(m, row, column, dj == 1, width, up, orders[first], part, dr, dz) * size[row, column]
                    volume = given if up else -given
                flux_volume[m, j, i] = volume
                total += volume
            rest = face[j, i] - total
            up = face[j, i] > 0.0
            row, column = (j - dj, i - di) if up else (j, i)
            if rest != 0.0 and cumulative(row, column, bodies - 1, orders[1], vof) > 1.0 - FULL:
                largest = 0
                for m in range(bodies):
                    largest = m if vof[m, row, column] > vof[largest, row, column] else largest
                flux_volume[largest, j, i] += rest


@kernel
def limit_fluxes(dj, di, j0, j1, edges, cut, pre, vof, flux_volume):
    """No cell gives more of a body through both of its faces than it has.

    Reads    pre [j, i], vof [m, j, i]
    Updates  flux_volume [m, j, i] of the faces around cut cells
    """
    for j in prange(j0, j1):
        lo, hi = union(cut, max(j - dj, j0), min(j + dj + 1, j1))
        for i in range(max(lo - di, edges[2]), min(hi + di, edges[3])):
            for m in range(vof.shape[0]):
                low, high = max(-flux_volume[m, j, i], 0.0), max(flux_volume[m, j + dj, i + di], 0.0)
                there = vof[m, j, i] * pre[j, i]
                if low + high > there and vof[m, j, i] > 0.0:
                    keep = there / (low + high)
                    if low > 0.0:
                        flux_volume[m, j, i] = -keep * low
                    if high > 0.0:
                        flux_volume[m, j + dj, i + di] = keep * high
