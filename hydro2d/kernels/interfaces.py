"""Piecewise-linear interfaces: Youngs' normal, the constant of the line, and the share of a donor strip.

All in the unit square of a cell with axes s = r^2/2 and z, in which areas are volumes of revolution, so that the planar
formulas are exact (explanation/interfaces). More than two materials are nested: the interface of the first k bodies of the
stated order bounds their cumulative fraction, void comes last.
"""


from hydro2d.jit import kernel, point, rowwise
from hydro2d.kernels.column_ranges import columns, outer_rows, past_row
from hydro2d.physics.interfaces import cumulative, nested, share_in_strip, surface


@rowwise
def sweep_volumes_row(j, dj, di, first, volume, active_range, fr, fz, pre):
    """Volume of cells before a sweep: V + dF_r + dF_z for the first sweep, V + dF of its own direction for the second.

    Reads    volume [j, i], fr, fz [j, i]
    Writes   pre [j, i]
    """
    lo, n = columns(active_range[j, 0], active_range[j, 1])
    fr_j = fr[j]
    fz_b = fz[j]
    fz_t = fz[j + 1]
    volume_j = volume[j]
    out = pre[j]
    for x in range(n):
        i = lo + x
        along_r = fr_j[i + 1] - fr_j[i]
        along_z = fz_t[i] - fz_b[i]
        out[i] = volume_j[i] + (along_r + along_z if first else dj * along_z + di * along_r)


@point
def flux_range(dj, di, i0, i1, m, j, body_ranges):
    """Faces of row j through which body m may flow within the active columns: one beyond its own; empty is (0, 0)."""
    lo, hi = max(body_ranges[2 * dj, m, j, 0] - 1, i0), min(body_ranges[2 * dj, m, j, 1] + 2, i1 + di)
    return (lo, hi) if lo < hi else (0, 0)


@rowwise
def donor_volumes_row(j, dj, di, i0, i1, open_faces, body_ranges, f_face, vof, flux_volume):
    """Volume of each body through each face, taken as if the donor cell were filled evenly: right where it is pure.

    Nothing but void flows in through the faces of the mesh's edge.

    Reads    f_face (fr or fz) [j, i], vof [m, j, i], open_faces (j0, j1, i0, i1 of the mesh)
    Writes   flux_volume [m, j, i]
    """
    bodies = vof.shape[0]
    for m in range(bodies):
        lo, hi = flux_range(dj, di, i0, i1, m, j, body_ranges)
        if lo >= hi:
            continue
        swept = f_face[j, lo:hi]
        given = flux_volume[m, j, lo:hi]
        here = vof[m, j, lo:hi]
        before = vof[m, j - dj, lo - di:hi - di]
        for x in range(hi - lo):
            given[x] = max(swept[x], 0.0) * before[x] + min(swept[x], 0.0) * here[x]
        swept = f_face[j]
        out = flux_volume[m, j]
        if dj == 1:
            for i in range(lo, hi):
                if (j == open_faces[0] and swept[i] > 0.0) or (j == open_faces[1] and swept[i] < 0.0):
                    out[i] = 0.0
        else:
            if lo <= open_faces[2] < hi and swept[open_faces[2]] > 0.0:
                out[open_faces[2]] = 0.0
            if lo <= open_faces[3] < hi and swept[open_faces[3]] < 0.0:
                out[open_faces[3]] = 0.0


@rowwise
def interface_volumes_row(j, dj, di, dr, dz, order, mixed_count, mixed, f_face, pre, vof, flux_volume, strips):
    """Volume of each body out of each mixed cell, from the nested linear interfaces.

    The cumulative volumes of a strip are kept monotone, each body gives no more than it has, and what two opposite strips
    ask together beyond that is passed on to the next body.

    Reads    mixed [j, k], order [k], f_face, pre [j, i], vof [m, j, i]
    Updates  flux_volume [m, j, i] at the faces through which mixed cells lose volume
    Scratch  strips [j, 2, m]
    """
    bodies = order.shape[0]
    left = strips[j, 0]
    right = strips[j, 1]
    for k in range(mixed_count[j]):
        i = mixed[j, k]
        out_low = max(-f_face[j, i], 0.0)
        out_high = max(f_face[j + dj, i + di], 0.0)
        if out_low == 0.0 and out_high == 0.0:
            continue
        size = pre[j, i]
        w_low, w_high = out_low / size, out_high / size
        below_low, below_high, total = 0.0, 0.0, 0.0
        void = 1.0 - cumulative(j, i, bodies - 1, order, vof)
        for n in range(bodies):
            f = vof[order[n], j, i]
            total = min(total + f, 1.0)
            if f == 0.0:
                left[n] = 0.0
                right[n] = 0.0
                continue
            n_r, n_z, w, h, weight = surface(j, i, n, order, vof, dr, dz, void)
            if dj == 1:
                n_r, n_z, w, h = n_z, n_r, h, w
            low = share_in_strip(n_r, n_z, w, h, weight, total, w_low, False) if w_low > 0.0 else 0.0
            high = share_in_strip(n_r, n_z, w, h, weight, total, w_high, True) if w_high > 0.0 else 0.0
            low = nested(low, below_low, f, total, w_low)
            high = nested(high, below_high, f, total, w_high)
            left[n] = low - below_low
            right[n] = high - below_high
            below_low = low
            below_high = high
        # two strips together may not take more of a body than there is; the excess moves on to the next body
        if w_low > 0.0 and w_high > 0.0:
            excess = 0.0
            for n in range(bodies):
                f = vof[order[n], j, i]
                right[n] += excess
                kept = min(right[n], max(f - left[n], 0.0))
                excess = right[n] - kept
                right[n] = kept
        for n in range(bodies):
            if w_low > 0.0:
                flux_volume[order[n], j, i] = -left[n] * size
            if w_high > 0.0:
                flux_volume[order[n], j + dj, i + di] = right[n] * size


@kernel
def donor_volumes(dj, di, part, parts, i0, i1, first, open_faces, volume, body_ranges, active_range, fr, fz, vof, pre,
                  flux_volume):
    """Rows j0 to j1 before a sweep: sweep_volumes_row, and donor_volumes_row, which has one more row of faces along z."""
    j0, j1 = outer_rows(parts)
    for j in range(parts[part], past_row(part, parts, dj)):
        if j < j1:
            sweep_volumes_row(j, dj, di, first, volume, active_range, fr, fz, pre)
        if di == 1:
            donor_volumes_row(j, dj, di, i0, i1, open_faces, body_ranges, fr, vof, flux_volume)
        else:
            donor_volumes_row(j, dj, di, i0, i1, open_faces, body_ranges, fz, vof, flux_volume)


@kernel
def interface_volumes(dj, di, part, parts, dr, dz, order, mixed_count, mixed, face, pre, vof, flux_volume, strips):
    """interface_volumes_row for rows j0 to j1."""
    for j in range(parts[part], parts[part + 1]):
        interface_volumes_row(j, dj, di, dr, dz, order, mixed_count, mixed, face, pre, vof, flux_volume, strips)
