"""Centroids of bodies in the cells that they share, after sweeps and after changes of volume.

explanation/interfaces, thin bodies.
"""

from hydro2d.jit import cell_rows, point
from hydro2d.kernels.interfaces import NOTHING
from hydro2d.kernels.mixed_scratch import BEFORE, SHIFT_R, SHIFT_Z
from hydro2d.physics.centroids import side, within

#: share of a cell above which a body filled it before a sweep, to round-off
FULL = 1.0 - 1e-9


@point
def size_after(j, i, w):
    """Volume of a cell after a sweep, m^3 per radian."""
    return w.volume[j, i] if w.second else w.pre_sweep_volume[j, i] - (w.face[j + w.dj, i + w.di] - w.face[j, i])


@point
def volume_before(m, j, i, w):
    """Volume that body m had in a cell before a sweep, m^3 per radian."""
    return w.vof[m, j, i] * size_after(j, i, w) + (
        w.flux_volume[m, j + w.dj, i + w.di] - w.flux_volume[m, j, i])


@point
def donor_place(m, j, i, face_j, face_i, w):
    """Offset (along, across), from the middle of a face's swept strip, of the volume that body m gave from cell (j, i)."""
    if not (w.mesh_box[0] <= j < w.mesh_box[1] and w.mesh_box[2] <= i < w.mesh_box[3]):
        return 0.0, w.centroid[w.di, m, j, i]
    if volume_before(m, j, i, w) > FULL * w.pre_sweep_volume[j, i]:
        return 0.0, 0.0
    return w.flux_place[0, m, face_j, face_i], w.flux_place[1, m, face_j, face_i]


@cell_rows
def carry_centroids(j, w):
    """Centroids of the bodies in mixed cells after a sweep: the mean by volume of the part that stays and the part that enters.

    The part that stays moves with the cell, or with the volumes that the faces sweep at the velocity of the body's group
    (explanation/interfaces, equation 8).

    Reads    mixed [j, k]; face, volume, pre_sweep_volume [j, i], own [b, j, i]; vof [m, j, i] after the sweep;
             flux_volume [m, j, i], flux_place [2, m, j, i]
    Updates  centroid [2, m, j, i]
    """
    dj, di = w.dj, w.di
    contact = w.own.shape[0] > 1
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        after = size_after(j, i, w)
        for m in range(w.vof.shape[0]):
            if not 0.0 < w.vof[m, j, i] < 1.0:
                continue
            left = w.vof[m, j, i] * after
            s_low, s_high = w.face[j, i], w.face[j + dj, i + di]
            if contact and w.contact_columns[j, 0] <= i < w.contact_columns[j, 1]:
                s_low, s_high = w.own[w.group[m], j, i], w.own[w.group[m], j + dj, i + di]
            drift = 0.5 * (s_low + s_high)
            v_low, v_high = w.flux_volume[m, j, i], w.flux_volume[m, j + dj, i + di]
            stood = left + (v_high - v_low)
            low, side_low, high, side_high = 0.0, 0.0, 0.0, 0.0
            if v_low != 0.0:
                row, column = (j - dj, i - di) if v_low > 0.0 else (j, i)
                x, y = donor_place(m, row, column, j, i, w)
                low = (0.5 + x) * abs(s_low) - (0.5 * after if v_low > 0.0 else 0.5 * w.pre_sweep_volume[j, i] - drift)
                low *= v_low
                side_low = v_low * y
            if v_high != 0.0:
                row, column = (j + dj, i + di) if v_high < 0.0 else (j, i)
                x, y = donor_place(m, row, column, j + dj, i + di, w)
                high = (0.5 * after if v_high < 0.0 else 0.5 * w.pre_sweep_volume[j, i] + drift) - (0.5 - x) * abs(s_high)
                high *= -v_high
                side_high = -v_high * y
            along = stood * (w.centroid[dj, m, j, i] * w.pre_sweep_volume[j, i] + drift) + (low + high)
            across = stood * w.centroid[di, m, j, i] + (side_low + side_high)
            w.centroid[dj, m, j, i] = within(along / (left * after), w.vof[m, j, i])
            w.centroid[di, m, j, i] = within(across / left, w.vof[m, j, i])


@point
def push_bodies(j, i, w):
    """Moves the centroids of the bodies of a mixed cell as bodies and void exchange volume in the Lagrangian step.

    Void that opens in a cell without void opens inside the bodies that shrink, and pushes none. Where there is void already, it
    opens there, in a share that grows with the void.

    Reads    mix [j, BEFORE, m], fractions before; vof [m, j, i], after
    Updates  centroid [2, m, j, i]
    """
    void, gained, shrunk, void_r, void_z = 1.0, 0.0, 0.0, 0.0, 0.0
    for m in range(w.vof.shape[0]):
        f = w.mix[j, BEFORE, m]
        void -= f
        gained += f - w.vof[m, j, i]
        shrunk += max(f - w.vof[m, j, i], 0.0)
        void_r -= f * w.centroid[0, m, j, i]
        void_z -= f * w.centroid[1, m, j, i]
    void = max(void, 0.0)
    if void > NOTHING:
        void_r, void_z = within(void_r / void, void), within(void_z / void, void)
    inside = gained * gained / (void + gained) if gained > 0.0 else 0.0  # the part of the new void that opens in the bodies
    for m in range(w.vof.shape[0]):
        w.mix[j, SHIFT_R, m], w.mix[j, SHIFT_Z, m] = 0.0, 0.0
    for m in range(w.vof.shape[0]):
        f = w.mix[j, BEFORE, m]
        if f == 0.0:
            continue
        change = w.vof[m, j, i] - f
        change += inside * max(-change, 0.0) / shrunk if inside > 0.0 else 0.0
        for k in range(m + 1, w.vof.shape[0]):
            other = w.mix[j, BEFORE, k]
            if other == 0.0:
                continue
            change_other = w.vof[k, j, i] - other
            change_other += inside * max(-change_other, 0.0) / shrunk if inside > 0.0 else 0.0
            along_r = side(w.centroid[0, m, j, i], w.centroid[0, k, j, i], f, other)
            along_z = side(w.centroid[1, m, j, i], w.centroid[1, k, j, i], f, other)
            w.mix[j, SHIFT_R, m] += 0.5 * change_other * along_r
            w.mix[j, SHIFT_Z, m] += 0.5 * change_other * along_z
            w.mix[j, SHIFT_R, k] -= 0.5 * change * along_r
            w.mix[j, SHIFT_Z, k] -= 0.5 * change * along_z
        if gained != inside:
            w.mix[j, SHIFT_R, m] += 0.5 * (gained - inside) * side(w.centroid[0, m, j, i], void_r, f, void)
            w.mix[j, SHIFT_Z, m] += 0.5 * (gained - inside) * side(w.centroid[1, m, j, i], void_z, f, void)
    for m in range(w.vof.shape[0]):
        if w.mix[j, BEFORE, m] > 0.0:
            w.centroid[0, m, j, i] = within(w.centroid[0, m, j, i] + w.mix[j, SHIFT_R, m], w.vof[m, j, i])
            w.centroid[1, m, j, i] = within(w.centroid[1, m, j, i] + w.mix[j, SHIFT_Z, m], w.vof[m, j, i])
