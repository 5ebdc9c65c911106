"""Volumes in contact-interface cells: their common rate of change, its work in pure cells, and the fluxes of bodies.

Both groups sweep the faces, each by its aperture (kernels/contact_geometry); a body flows with its group's velocity.
"""

from hydro2d.jit import cell_rows, kernel, not_inlined, vertex_rows
from hydro2d.kernels.column_ranges import first_row, outer_rows, past_row, union
from hydro2d.kernels.contact.contact_geometry import HARD_FIRST, SOFT_AFTER
from hydro2d.kernels.interfaces import ACROSS, ALONG, NOTHING, SHARE, fill_strips
from hydro2d.mesh.fields import E
from hydro2d.mesh.grid import FACE_R
from hydro2d.physics.contact_faces import GAP, face_flow_r, face_flow_z, largest_of, volume_rate
from hydro2d.physics.interfaces import cumulative
from hydro2d.physics.traction import smoothstep

#: share of other bodies and void, and of void alone, in a cell at which the rules of `contact_shares` apply in full
BLEND_RANGE = 0.01


@vertex_rows
def contact_swept_volumes(j, w):
    """Volumes swept in the step by the faces of contact-interface cells: by aperture, and by each group as if it were alone.

    Reads    u0, v0, u, v [b, j, i]
    Writes   fr, fz [j, i]; own_r, own_z [b, j, i]
    """
    j0, j1 = outer_rows(w.parts)
    if j < j1:
        for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1] + 1):
            scale = 0.25 * w.dt * w.metrics[FACE_R, i] * w.dz[j]
            w.fr[j, i] = w.even_r[j, i] + scale * (
                face_flow_r(j, i, -1, w.aperture_r, w.u) + face_flow_r(j, i, -1, w.aperture_r, w.u0))
            for g in range(2):
                w.own_r[g, j, i] = w.even_r[j, i] + scale * (
                    face_flow_r(j, i, g, w.aperture_r, w.u) + face_flow_r(j, i, g, w.aperture_r, w.u0))
    lo, hi = union(w.contact_columns, max(j - 1, j0), min(j + 1, j1))
    for i in range(lo, hi):
        w.fz[j, i] = w.even_z[j, i] + 0.5 * w.dt * (
            face_flow_z(j, i, -1, w.metrics, w.aperture_z, w.v) + face_flow_z(j, i, -1, w.metrics, w.aperture_z, w.v0))
        for g in range(2):
            w.own_z[g, j, i] = w.even_z[j, i] + 0.5 * w.dt * (
                face_flow_z(j, i, g, w.metrics, w.aperture_z, w.v) + face_flow_z(j, i, g, w.metrics, w.aperture_z, w.v0))


@cell_rows
def contact_work(j, w):
    """Pressure work in pure contact-interface cells: by the volume that they lose, not by their group's own.

    `deform` does the work of the group's own rate of volume; this adds the rest.

    Reads    ph, qr [j, i], velocities, fr, fz [j, i], cell_mass [b, j, i]
    Updates  q (e) [k, m, j, i]
    """
    for i in range(w.contact_columns[j, 0], w.contact_columns[j, 1]):
        for m in range(w.vof.shape[0]):
            if w.vof[m, j, i] == 1.0:
                g = w.group[m]
                own = 0.5 * w.dt * (
                    volume_rate(j, i, g, w.metrics, w.dz[j], w.aperture_r, w.aperture_z, w.u, w.v)
                    + volume_rate(j, i, g, w.metrics, w.dz[j], w.aperture_r, w.aperture_z, w.u0, w.v0))
                change = (w.fr[j, i + 1] - w.fr[j, i]) + (w.fz[j + 1, i] - w.fz[j, i])
                w.q[E, m, j, i] -= (w.ph[j, i] + w.qr[j, i]) * (change - own) / w.cell_mass[g, j, i]


@kernel
def contact_shares(part, w):
    """Fractions of the undeformed cell on the mesh, in contact-interface cells and three around them.

    Flux out of the next cell is computed as well, from the interfaces in it, for which 5 x 5 fractions are read.

    The volume before a sweep depends on the motion of both groups, but neither group is stretched by the other's motion: a line
    scaled with that volume would move and turn without its body. Next to void the bodies fill no more than the cell. Both rules
    are blended in over the first BLEND_RANGE of anything but the largest body and of void.

    Reads    volume, pre_sweep_volume [j, i], vof [m, j, i]
    Writes   own_share [m, j, i], the fractions; size [j, i] (m^3), the volume that they are of
    """
    j0, j1 = outer_rows(w.parts)
    for j in range(max(first_row(part, w.parts, 3), 0), min(past_row(part, w.parts, 3), w.vof.shape[1])):
        lo, hi = union(w.contact_columns, max(j - 3, j0), min(j + 4, j1))
        for i in range(max(lo - 3, 0), min(hi + 3, w.vof.shape[2])):
            total, largest = 0.0, 0.0
            for m in range(w.vof.shape[0]):
                total += w.vof[m, j, i]
                largest = max(largest, w.vof[m, j, i])
            scale = 1.0
            if w.mesh_box[0] <= j < w.mesh_box[1] and w.mesh_box[2] <= i < w.mesh_box[3] and 0.0 < total and largest < 1.0:
                scale += smoothstep((1.0 - largest) / BLEND_RANGE) * (w.pre_sweep_volume[j, i] / w.volume[j, i] - 1.0)
                scale -= smoothstep((1.0 - total) / BLEND_RANGE) * max(scale - 1.0 / total, 0.0)
            for m in range(w.vof.shape[0]):
                w.own_share[m, j, i] = w.vof[m, j, i] * scale
            w.size[j, i] = w.pre_sweep_volume[j, i] / scale


@not_inlined
def add_group_flux(g, more, j, i, w):
    """Adds `more` to the volume of group g through face (j, i); returns the volume that the group cannot supply.

    Flow in the opposite direction is reduced first, for every body by the same share. Then the body with the largest share of
    the donor cell gives up to all that it has there.
    """
    swept = 0.0
    for m in range(w.vof.shape[0]):
        swept += w.flux_volume[m, j, i] if w.group[m] == g else 0.0
    if swept * more < 0.0:
        keep = max((swept + more) / swept, 0.0)
        for m in range(w.vof.shape[0]):
            if w.group[m] == g:
                w.flux_volume[m, j, i] *= keep
        more = more + swept if keep == 0.0 else 0.0
    row, column = (j - w.dj, i - w.di) if more > 0.0 else (j, i)
    m = largest_of(g, row, column, w.group, w.vof)
    if m < 0 or more == 0.0:
        return more
    given = min(abs(more), max(w.own_share[m, row, column] * w.size[row, column] - abs(w.flux_volume[m, j, i]), 0.0))
    given = given if more > 0.0 else -given
    w.flux_volume[m, j, i] += given
    return more - given


@kernel
def contact_fluxes(part, w):
    """Volume of every body through the faces of contact-interface cells, with the velocity of its group.

    In a cell the group with the flatter surface comes first among the nested interfaces; where void separates the groups, each
    group comes first for itself, by the weights of `contact_lines`. The bodies together may flow less or more than the volume
    that the face sweeps. Void makes up the difference as far as the cell from which it flows has any. The soft bodies take the
    remainder as far as they can supply it, then the hard ones (`add_group_flux`). Where the donor cell has a gap, a full cell
    that receives volume is filled by its own body as long as the donor has any: no void enters a body from its surface.

    Reads    face [j, i], own [b, j, i], the arrays that contact_shares wrote, vof [m, j, i], group [m], line [10, j, i];
             hard_first, soft_first [m], the bodies in the order in which their interfaces are nested
    Updates  flux_volume [m, j, i]; flux_place [2, m, j, i]
    Scratch  strips [j, 3, 4, m]
    """
    dj, di = w.dj, w.di
    j0, j1 = outer_rows(w.parts)
    for j in range(w.parts[part], past_row(part, w.parts, dj)):
        lo, hi = union(w.contact_columns, max(j - dj, j0), min(j + 1, j1))
        if lo >= hi:
            continue
        for i in range(lo, hi + di):
            at, low = (i, 2) if di == 1 else (j, 0)
            if at == w.mesh_box[low] or at == w.mesh_box[low + 1]:
                continue
            total = 0.0
            for m in range(w.group.shape[0]):
                swept = w.own[w.group[m], j, i]
                up = swept > 0.0
                row, column = (j - dj, i - di) if up else (j, i)
                volume = 0.0
                w.flux_place[0, m, j, i] = 0.0
                w.flux_place[1, m, j, i] = 0.0
                if w.vof[m, row, column] == 1.0:
                    volume = swept
                elif w.vof[m, row, column] > 0.0 and swept != 0.0:
                    width = min(abs(swept) / w.size[row, column], 1.0)
                    weight, given, along, across = 1.0, 0.0, 0.0, 0.0
                    void = 1.0 - cumulative(row, column, w.group.shape[0] - 1, w.hard_first, w.vof)
                    widths = (0.0, width, 0.0) if up else (width, 0.0, 0.0)
                    strip = w.strips[j, 1 if up else 0]
                    if w.contact_columns[row, 0] <= column < w.contact_columns[row, 1]:
                        weight = w.line[HARD_FIRST if w.group[m] == 1 else SOFT_AFTER, row, column]
                    if weight > 0.0:
                        fill_strips(row, column, m, widths, w.hard_first, w.own_share, void, w.strips[j], w)
                        given, along, across = weight * strip[SHARE, m], weight * strip[ALONG, m], weight * strip[ACROSS, m]
                    if weight < 1.0:
                        fill_strips(row, column, m, widths, w.soft_first, w.own_share, void, w.strips[j], w)
                        given += (1.0 - weight) * strip[SHARE, m]
                        along += (1.0 - weight) * strip[ALONG, m]
                        across += (1.0 - weight) * strip[ACROSS, m]
                    if given > NOTHING:
                        w.flux_place[0, m, j, i] = along / given
                        w.flux_place[1, m, j, i] = across / given
                    volume = given * w.size[row, column] if up else -given * w.size[row, column]
                w.flux_volume[m, j, i] = volume
                total += volume
            rest = w.face[j, i] - total
            up = w.face[j, i] > 0.0
            row, column = (j - dj, i - di) if up else (j, i)
            to_row, to_column = (j, i) if up else (j - dj, i - di)
            void = 1.0 - cumulative(row, column, w.group.shape[0] - 1, w.hard_first, w.vof)
            gap = smoothstep(void / GAP - 0.5)
            if gap > 0.0 and (rest > 0.0) == up:
                for m in range(w.group.shape[0]):
                    full = smoothstep(1.0 - (1.0 - w.vof[m, to_row, to_column]) / BLEND_RANGE)
                    if full > 0.0:
                        swept = w.own[w.group[m], j, i] if up else -w.own[w.group[m], j, i]
                        most = min(swept, w.own_share[m, row, column] * w.size[row, column]) - abs(w.flux_volume[m, j, i])
                        more = gap * full * min(abs(rest), max(most, 0.0))
                        more = more if up else -more
                        w.flux_volume[m, j, i] += more
                        rest -= more
            row, column = (j - dj, i - di) if rest > 0.0 else (j, i)
            void = 1.0 - cumulative(row, column, w.group.shape[0] - 1, w.hard_first, w.vof)
            room = void * w.size[row, column]
            beyond = max(abs(rest) - room, 0.0)
            if beyond > 0.0:
                left = add_group_flux(0, beyond if rest > 0.0 else -beyond, j, i, w)
                add_group_flux(1, left, j, i, w)


@cell_rows
def limit_fluxes(j, w):
    """Limits the fluxes so that no cell gives more of a body through both of its faces than it has.

    Reads    pre_sweep_volume [j, i], vof [m, j, i]
    Updates  flux_volume [m, j, i] of the faces around contact-interface cells
    """
    dj, di = w.dj, w.di
    j0, j1 = outer_rows(w.parts)
    lo, hi = union(w.contact_columns, max(j - dj, j0), min(j + dj + 1, j1))
    for i in range(max(lo - di, w.mesh_box[2]), min(hi + di, w.mesh_box[3])):
        for m in range(w.vof.shape[0]):
            low, high = max(-w.flux_volume[m, j, i], 0.0), max(w.flux_volume[m, j + dj, i + di], 0.0)
            there = w.vof[m, j, i] * w.pre_sweep_volume[j, i]
            if low + high > there and w.vof[m, j, i] > 0.0:
                keep = there / (low + high)
                if low > 0.0:
                    w.flux_volume[m, j, i] = -keep * low
                if high > 0.0:
                    w.flux_volume[m, j + dj, i + di] = keep * high
