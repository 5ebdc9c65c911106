"""The slip layer: distance to the hard bodies' surface, zones beside it, and the cut of shear (explanation/sliding)."""

from math import sqrt

from hydro2d.jit import kernel, point, serial
from hydro2d.kernels.column_ranges import outer_rows
from hydro2d.mesh.fields import SRR, SRZ, SZZ
from hydro2d.physics.interfaces import line_centre, youngs_difference

#: zones of a cell
OUTSIDE, HARD, BOUNDARY_LAYER, SLIP_LAYER = range(4)

#: slip-layer treatments by name
SHEARS = ("fluid", "shear")
FLUID, SHEAR = range(2)

#: hard fraction from which a cell holds a surface of the hard bodies
SURFACE = 1e-3


@point
def paint(j, i, r0, z0, n_r, n_z, half, reach, rc, zc, low_j, high_j, low_i, high_i, hard, distance, normal):
    """Distance of the cells around (j, i) to a piece of surface at (r0, z0), where it is the nearest so far.

    half is half the length of the piece; cells on its inner side are left out. Mirror images across the axis follow from
    the column range, which begins there.
    """
    j_first = j
    while j_first > low_j and z0 - zc[j_first - 1] <= reach:
        j_first -= 1
    j_last = j
    while j_last < high_j - 1 and zc[j_last + 1] - z0 <= reach:
        j_last += 1
    i_first = i
    while i_first > low_i and r0 - rc[i_first - 1] <= reach:
        i_first -= 1
    i_last = i
    while i_last < high_i - 1 and rc[i_last + 1] - r0 <= reach:
        i_last += 1
    for row in range(j_first, j_last + 1):
        for column in range(i_first, i_last + 1):
            a, b = rc[column] - r0, zc[row] - z0
            along_n, along_t = a * n_r + b * n_z, abs(b * n_r - a * n_z)
            if along_n < 0.0 or hard[row, column] >= 1.0:
                continue
            beside = max(along_t - half, 0.0)
            d = sqrt(along_n * along_n + beside * beside)
            if d < distance[row, column]:
                distance[row, column] = d
                size = d if d > 0.0 else 1.0
                # beyond the end of the piece the nearest point is its end, and the normal points from there
                t_sign = 1.0 if b * n_r - a * n_z > 0.0 else -1.0
                normal[0, row, column] = (along_n * n_r - beside * t_sign * n_z) / size if d > 0.0 else n_r
                normal[1, row, column] = (along_n * n_z + beside * t_sign * n_r) / size if d > 0.0 else n_z


@serial
def slip_zones(parts, i0, i1, width_bl, width_sl, hard_threshold, rc, zc, dr, dz, hard_bodies, vof, hard, distance, zone,
               normal):
    """Zones of the slip layer from the distance to the reconstructed surface of the hard bodies.

    zone is HARD where the hard fraction reaches the threshold, BOUNDARY_LAYER up to a distance width_bl, SLIP_LAYER up to
    width_bl + width_sl (measured to the cell's centre), else OUTSIDE.

    Reads    vof [m, j, i], hard_bodies [m]
    Writes   hard, distance, zone [j, i]; normal [2, j, i], outward from the hard body
    """
    j0, j1 = outer_rows(parts)
    reach = width_bl + width_sl
    for j in range(j0 - 1, j1 + 1):
        for i in range(i0 - 1, i1 + 1):
            total = 0.0
            for m in range(vof.shape[0]):
                total += vof[m, j, i] if hard_bodies[m] else 0.0
            hard[j, i] = total if total < 1.0 - 1e-12 else 1.0
            distance[j, i] = 1e300
            zone[j, i] = OUTSIDE
    for j in range(j0, j1):
        for i in range(i0, i1):
            f = hard[j, i]
            if f < SURFACE:
                continue
            w = hard[j, i - 1]
            e = hard[j, i + 1]
            s = hard[j - 1, i]
            n = hard[j + 1, i]
            if f == 1.0:
                half_r, half_z = 0.5 * dr[i], 0.5 * dz[j]
                if e < SURFACE:
                    paint(j, i, rc[i] + half_r, zc[j], 1.0, 0.0, half_z, reach, rc, zc, j0, j1, i0, i1, hard, distance,
                          normal)
                if w < SURFACE:
                    paint(j, i, rc[i] - half_r, zc[j], -1.0, 0.0, half_z, reach, rc, zc, j0, j1, i0, i1, hard, distance,
                          normal)
                if n < SURFACE:
                    paint(j, i, rc[i], zc[j] + half_z, 0.0, 1.0, half_r, reach, rc, zc, j0, j1, i0, i1, hard, distance,
                          normal)
                if s < SURFACE:
                    paint(j, i, rc[i], zc[j] - half_z, 0.0, -1.0, half_r, reach, rc, zc, j0, j1, i0, i1, hard, distance,
                          normal)
                continue
            sw = hard[j - 1, i - 1]
            se = hard[j - 1, i + 1]
            nw = hard[j + 1, i - 1]
            ne = hard[j + 1, i + 1]
            n_r, n_z = youngs_difference(sw, s, se, w, e, nw, n, ne)  # not weighted where the mesh is graded
            size = abs(n_r) + abs(n_z)
            if size < 1e-14:
                continue
            x, y = line_centre(n_r / size, n_z / size, f)
            g_r, g_z = n_r / dr[i], n_z / dz[j]
            length = sqrt(g_r * g_r + g_z * g_z)
            paint(j, i, rc[i] + (x - 0.5) * dr[i], zc[j] + (y - 0.5) * dz[j], g_r / length, g_z / length,
                  0.5 * max(dr[i], dz[j]), reach, rc, zc, j0, j1, i0, i1, hard, distance, normal)
    for j in range(j0, j1):
        for i in range(i0, i1):
            if hard[j, i] >= hard_threshold:
                zone[j, i] = HARD
            elif distance[j, i] <= width_bl:
                zone[j, i] = BOUNDARY_LAYER
            elif distance[j, i] <= reach:
                zone[j, i] = SLIP_LAYER


@kernel
def cut_shear(part, parts, shear, friction, occupied, zone, normal, hard_bodies, vof, pm, q):
    """Takes the shear from soft material in the slip layer: all of the deviator, or what the surface carries beyond friction.

    `shear`: with s turned to (n, t), |s_nt| <= friction max(-sigma_nn, 0).

    Reads    zone [j, i], normal [2, j, i]; vof, pm [m, j, i]
    Updates  q (deviators) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for i in range(occupied[0, j, 0], occupied[0, j, 1]):
            if zone[j, i] != SLIP_LAYER:
                continue
            n_r = normal[0, j, i]
            n_z = normal[1, j, i]
            for m in range(vof.shape[0]):
                if hard_bodies[m] or vof[m, j, i] == 0.0:
                    continue
                if shear == FLUID:
                    q[SRR, m, j, i] = 0.0
                    q[SZZ, m, j, i] = 0.0
                    q[SRZ, m, j, i] = 0.0
                    continue
                rr = q[SRR, m, j, i]
                zz = q[SZZ, m, j, i]
                rz = q[SRZ, m, j, i]
                nn = n_r * n_r * rr + 2.0 * n_r * n_z * rz + n_z * n_z * zz
                nt = n_r * n_z * (zz - rr) + (n_r * n_r - n_z * n_z) * rz
                limit = friction * max(pm[m, j, i] - nn, 0.0)
                change = min(max(nt, -limit), limit) - nt
                q[SRR, m, j, i] = rr - 2.0 * change * n_r * n_z
                q[SZZ, m, j, i] = zz + 2.0 * change * n_r * n_z
                q[SRZ, m, j, i] = rz + change * (n_r * n_r - n_z * n_z)
