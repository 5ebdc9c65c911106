"""Where bodies lie in the cells that they share: what sweeps and changes of volume do to their centroids.

explanation/interfaces, thin bodies.
"""

from hydro2d.jit import kernel, point
from hydro2d.kernels.interfaces import NOTHING
from hydro2d.kernels.mixed_scratch import BEFORE, SHIFT_R, SHIFT_Z
from hydro2d.physics.centroids import side, within

#: share of a cell from which a body filled it before a sweep, to round-off
FULL = 1.0 - 1e-9


@point
def size_after(j, i, dj, di, second, volume, pre, face):
    """Volume of a cell after a sweep, m^3 per radian."""
    return volume[j, i] if second else pre[j, i] - (face[j + dj, i + di] - face[j, i])


@point
def volume_before(m, j, i, dj, di, second, volume, pre, face, vof, flux_volume):
    """Volume that body m had in a cell before a sweep, m^3 per radian."""
    return vof[m, j, i] * size_after(j, i, dj, di, second, volume, pre, face) + (
        flux_volume[m, j + dj, i + di] - flux_volume[m, j, i])


@point
def donor_place(m, j, i, face_j, face_i, dj, di, second, mesh_box, volume, pre, face, vof, flux_volume, flux_place, centroid):
    """Where in the strip that it swept lies what body m gave from cell (j, i) through a face, off the middle: along, across."""
    if not (mesh_box[0] <= j < mesh_box[1] and mesh_box[2] <= i < mesh_box[3]):
        return 0.0, centroid[di, m, j, i]
    if volume_before(m, j, i, dj, di, second, volume, pre, face, vof, flux_volume) > FULL * pre[j, i]:
        return 0.0, 0.0
    return flux_place[0, m, face_j, face_i], flux_place[1, m, face_j, face_i]


@kernel
def carry_centroids(dj, di, part, parts, second, mesh_box, group, contact_columns, mixed_count, mixed, face, own, volume, pre,
                    vof, flux_volume, flux_place, centroid):
    """Centroids of the bodies in mixed cells after a sweep: those of what stays and what comes, by volume.

    What stays moves with the cell, or with the volumes that the faces sweep with the velocity of the body's group
    (explanation/interfaces, equation 8).

    Reads    mixed [j, k]; face, volume, pre [j, i], own [b, j, i]; vof [m, j, i] after the sweep; flux_volume [m, j, i],
             flux_place [2, m, j, i]
    Updates  centroid [2, m, j, i]
    """
    contact = own.shape[0] > 1
    for j in range(parts[part], parts[part + 1]):
        for k in range(mixed_count[j]):
            i = mixed[j, k]
            after = size_after(j, i, dj, di, second, volume, pre, face)
            for m in range(vof.shape[0]):
                if not 0.0 < vof[m, j, i] < 1.0:
                    continue
                left = vof[m, j, i] * after
                s_low, s_high = face[j, i], face[j + dj, i + di]
                if contact and contact_columns[j, 0] <= i < contact_columns[j, 1]:
                    s_low, s_high = own[group[m], j, i], own[group[m], j + dj, i + di]
                drift = 0.5 * (s_low + s_high)
                v_low, v_high = flux_volume[m, j, i], flux_volume[m, j + dj, i + di]
                stood = left + (v_high - v_low)
                low, side_low, high, side_high = 0.0, 0.0, 0.0, 0.0
                if v_low != 0.0:
                    row, column = (j - dj, i - di) if v_low > 0.0 else (j, i)
                    x, y = donor_place(m, row, column, j, i, dj, di, second, mesh_box, volume, pre, face, vof, flux_volume,
                                       flux_place, centroid)
                    low = (0.5 + x) * abs(s_low) - (0.5 * after if v_low > 0.0 else 0.5 * pre[j, i] - drift)
                    low *= v_low
                    side_low = v_low * y
                if v_high != 0.0:
                    row, column = (j + dj, i + di) if v_high < 0.0 else (j, i)
                    x, y = donor_place(m, row, column, j + dj, i + di, dj, di, second, mesh_box, volume, pre, face, vof,
                                       flux_volume, flux_place, centroid)
                    high = (0.5 * after if v_high < 0.0 else 0.5 * pre[j, i] + drift) - (0.5 - x) * abs(s_high)
                    high *= -v_high
                    side_high = -v_high * y
                along = stood * (centroid[dj, m, j, i] * pre[j, i] + drift) + (low + high)
                across = stood * centroid[di, m, j, i] + (side_low + side_high)
                centroid[dj, m, j, i] = within(along / (left * after), vof[m, j, i])
                centroid[di, m, j, i] = within(across / left, vof[m, j, i])


@point
def push_bodies(j, i, vof, centroid, mix):
    """Moves the centroids of the bodies of a mixed cell as these and void take and give volume in the Lagrangian step.

    Void that opens where there was none opens in the midst of the bodies that shrink, and pushes none; where there was some, it
    opens there, the more the more there was.

    Reads    mix [j, BEFORE, m], fractions before; vof [m, j, i], after
    Updates  centroid [2, m, j, i]
    """
    bodies = vof.shape[0]
    void, gained, shrunk, void_r, void_z = 1.0, 0.0, 0.0, 0.0, 0.0
    for m in range(bodies):
        f = mix[j, BEFORE, m]
        void -= f
        gained += f - vof[m, j, i]
        shrunk += max(f - vof[m, j, i], 0.0)
        void_r -= f * centroid[0, m, j, i]
        void_z -= f * centroid[1, m, j, i]
    void = max(void, 0.0)
    if void > NOTHING:
        void_r, void_z = within(void_r / void, void), within(void_z / void, void)
    inside = gained * gained / (void + gained) if gained > 0.0 else 0.0  # of the new void, what opens in the bodies
    for m in range(bodies):
        mix[j, SHIFT_R, m], mix[j, SHIFT_Z, m] = 0.0, 0.0
    for m in range(bodies):
        f = mix[j, BEFORE, m]
        if f == 0.0:
            continue
        change = vof[m, j, i] - f
        change += inside * max(-change, 0.0) / shrunk if inside > 0.0 else 0.0
        for k in range(m + 1, bodies):
            other = mix[j, BEFORE, k]
            if other == 0.0:
                continue
            change_other = vof[k, j, i] - other
            change_other += inside * max(-change_other, 0.0) / shrunk if inside > 0.0 else 0.0
            along_r = side(centroid[0, m, j, i], centroid[0, k, j, i], f, other)
            along_z = side(centroid[1, m, j, i], centroid[1, k, j, i], f, other)
            mix[j, SHIFT_R, m] += 0.5 * change_other * along_r
            mix[j, SHIFT_Z, m] += 0.5 * change_other * along_z
            mix[j, SHIFT_R, k] -= 0.5 * change * along_r
            mix[j, SHIFT_Z, k] -= 0.5 * change * along_z
        if gained != inside:
            mix[j, SHIFT_R, m] += 0.5 * (gained - inside) * side(centroid[0, m, j, i], void_r, f, void)
            mix[j, SHIFT_Z, m] += 0.5 * (gained - inside) * side(centroid[1, m, j, i], void_z, f, void)
    for m in range(bodies):
        if mix[j, BEFORE, m] > 0.0:
            centroid[0, m, j, i] = within(centroid[0, m, j, i] + mix[j, SHIFT_R, m], vof[m, j, i])
            centroid[1, m, j, i] = within(centroid[1, m, j, i] + mix[j, SHIFT_Z, m], vof[m, j, i])
