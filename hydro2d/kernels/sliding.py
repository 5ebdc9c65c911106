"""The slip layer: distance to the hard bodies' surface, zones next to it, and the cut of shear (explanation/sliding)."""

from math import sqrt

from hydro2d.jit import cell_rows, point, serial
from hydro2d.kernels.column_ranges import outer_rows
from hydro2d.mesh.fields import SRR, SRZ, SZZ
from hydro2d.physics.interfaces import line_centre, youngs_difference
from hydro2d.physics.stress import release

#: zones of a cell
OUTSIDE, HARD, BOUNDARY_LAYER, SLIP_LAYER = range(4)

#: slip-layer treatments by name
SHEARS = ("fluid", "shear")
FLUID, SHEAR = range(2)

#: hard fraction from which a cell has a surface of the hard bodies
SURFACE = 1e-3


@point
def paint(j, i, r0, z0, n_r, n_z, half, w):
    """Distance of the cells around (j, i) to a piece of surface at (r0, z0), where it is the nearest so far.

    half is half the length of the piece; cells on its inner side are left out. No mirror images are needed at the axis, where
    the column range begins.
    """
    low_j, high_j = outer_rows(w.parts)
    reach = w.width_bl + w.width_sl
    j_first = j
    while j_first > low_j and z0 - w.zc[j_first - 1] <= reach:
        j_first -= 1
    j_last = j
    while j_last < high_j - 1 and w.zc[j_last + 1] - z0 <= reach:
        j_last += 1
    i_first = i
    while i_first > w.i0 and r0 - w.rc[i_first - 1] <= reach:
        i_first -= 1
    i_last = i
    while i_last < w.i1 - 1 and w.rc[i_last + 1] - r0 <= reach:
        i_last += 1
    for row in range(j_first, j_last + 1):
        for column in range(i_first, i_last + 1):
            a, b = w.rc[column] - r0, w.zc[row] - z0
            along_n, along_t = a * n_r + b * n_z, abs(b * n_r - a * n_z)
            if along_n < 0.0 or w.hard[row, column] >= 1.0:
                continue
            beside = max(along_t - half, 0.0)
            d = sqrt(along_n * along_n + beside * beside)
            if d < w.distance[row, column]:
                w.distance[row, column] = d
                size = d if d > 0.0 else 1.0
                # beyond the end of the piece the nearest point is its end, from which the normal points
                t_sign = 1.0 if b * n_r - a * n_z > 0.0 else -1.0
                w.normal[0, row, column] = (along_n * n_r - beside * t_sign * n_z) / size if d > 0.0 else n_r
                w.normal[1, row, column] = (along_n * n_z + beside * t_sign * n_r) / size if d > 0.0 else n_z


@serial
def slip_zones(w):
    """Zones of the slip layer from the distance to the reconstructed surface of the hard bodies.

    zone is HARD where the hard fraction reaches the threshold, BOUNDARY_LAYER up to a distance width_bl, SLIP_LAYER up to
    width_bl + width_sl (measured to the cell's centre), else OUTSIDE.

    Reads    vof [m, j, i], hard_bodies [m]
    Writes   hard, distance, zone [j, i]; normal [2, j, i], outward from the hard body
    """
    j0, j1 = outer_rows(w.parts)
    reach = w.width_bl + w.width_sl
    for j in range(j0 - 1, j1 + 1):
        for i in range(w.i0 - 1, w.i1 + 1):
            total = 0.0
            for m in range(w.vof.shape[0]):
                total += w.vof[m, j, i] if w.hard_bodies[m] else 0.0
            w.hard[j, i] = total if total < 1.0 - 1e-12 else 1.0
            w.distance[j, i] = 1e300
            w.zone[j, i] = OUTSIDE
    for j in range(j0, j1):
        for i in range(w.i0, w.i1):
            f = w.hard[j, i]
            if f < SURFACE:
                continue
            west = w.hard[j, i - 1]
            east = w.hard[j, i + 1]
            south = w.hard[j - 1, i]
            north = w.hard[j + 1, i]
            if f == 1.0:
                half_r, half_z = 0.5 * w.dr[i], 0.5 * w.dz[j]
                if east < SURFACE:
                    paint(j, i, w.rc[i] + half_r, w.zc[j], 1.0, 0.0, half_z, w)
                if west < SURFACE:
                    paint(j, i, w.rc[i] - half_r, w.zc[j], -1.0, 0.0, half_z, w)
                if north < SURFACE:
                    paint(j, i, w.rc[i], w.zc[j] + half_z, 0.0, 1.0, half_r, w)
                if south < SURFACE:
                    paint(j, i, w.rc[i], w.zc[j] - half_z, 0.0, -1.0, half_r, w)
                continue
            sw = w.hard[j - 1, i - 1]
            se = w.hard[j - 1, i + 1]
            nw = w.hard[j + 1, i - 1]
            ne = w.hard[j + 1, i + 1]
            n_r, n_z = youngs_difference(sw, south, se, west, east, nw, north, ne)  # unweighted on graded meshes
            size = abs(n_r) + abs(n_z)
            if size < 1e-14:
                continue
            x, y = line_centre(n_r / size, n_z / size, f)
            g_r, g_z = n_r / w.dr[i], n_z / w.dz[j]
            length = sqrt(g_r * g_r + g_z * g_z)
            paint(j, i, w.rc[i] + (x - 0.5) * w.dr[i], w.zc[j] + (y - 0.5) * w.dz[j], g_r / length, g_z / length,
                  0.5 * max(w.dr[i], w.dz[j]), w)
    for j in range(j0, j1):
        for i in range(w.i0, w.i1):
            if w.hard[j, i] >= w.threshold:
                w.zone[j, i] = HARD
            elif w.distance[j, i] <= w.width_bl:
                w.zone[j, i] = BOUNDARY_LAYER
            elif w.distance[j, i] <= reach:
                w.zone[j, i] = SLIP_LAYER


@cell_rows
def cut_viscosity(j, w):
    """Makes the artificial viscosity isotropic in the slip layer, so that it transmits no shear there.

    Reads    zone [j, i]
    Updates  qr, qz, qt, qrz [j, i]
    """
    for i in range(w.occupied[0, j, 0], w.occupied[0, j, 1]):
        if w.zone[j, i] == SLIP_LAYER:
            q = w.qr[j, i] + w.qz[j, i]
            w.qr[j, i] = q
            w.qz[j, i] = q
            w.qt[j, i] = q
            w.qrz[j, i] = 0.0


@cell_rows
def cut_shear(j, w):
    """Removes shear from soft material in the slip layer: all of the deviator, or the shear on the surface beyond friction.

    `shear`: with s turned to (n, t), |s_nt| <= friction max(-sigma_nn, 0).

    Reads    zone [j, i], normal [2, j, i]; vof, pm [m, j, i]
    Updates  q (deviators) [k, m, j, i]
    """
    for i in range(w.occupied[0, j, 0], w.occupied[0, j, 1]):
        if w.zone[j, i] != SLIP_LAYER:
            continue
        n_r = w.normal[0, j, i]
        n_z = w.normal[1, j, i]
        for m in range(w.vof.shape[0]):
            if w.hard_bodies[m] or w.vof[m, j, i] == 0.0:
                continue
            if w.shear == FLUID:
                release(m, j, i, w.q)
                continue
            rr = w.q[SRR, m, j, i]
            zz = w.q[SZZ, m, j, i]
            rz = w.q[SRZ, m, j, i]
            nn = n_r * n_r * rr + 2.0 * n_r * n_z * rz + n_z * n_z * zz
            nt = n_r * n_z * (zz - rr) + (n_r * n_r - n_z * n_z) * rz
            limit = w.friction * max(w.pm[m, j, i] - nn, 0.0)
            change = min(max(nt, -limit), limit) - nt
            w.q[SRR, m, j, i] = rr - 2.0 * change * n_r * n_z
            w.q[SZZ, m, j, i] = zz + 2.0 * change * n_r * n_z
            w.q[SRZ, m, j, i] = rz + change * (n_r * n_r - n_z * n_z)
