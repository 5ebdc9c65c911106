"""Volumes in contact-interface cells: one rate of change, what it does to pure cells, what flows.

The faces are swept by both groups, each by its aperture (kernels/contact_geometry); a body flows with its group's velocity.
"""

from hydro2d.jit import apart, kernel, point
from hydro2d.kernels.column_ranges import first_row, outer_rows, past_row, union
from hydro2d.kernels.contact_geometry import HARD_FIRST, SOFT_AFTER
from hydro2d.kernels.cut_cells import INTERFACE, KIND
from hydro2d.kernels.interfaces import ACROSS, ALONG, NOTHING, SHARE, fill_strips
from hydro2d.mesh.fields import RHO, E
from hydro2d.mesh.grid import FACE_R
from hydro2d.physics.contact import GAP, face_flow_r, face_flow_z, largest_of, volume_rate
from hydro2d.physics.interfaces import cumulative
from hydro2d.physics.traction import smoothstep

#: share of a cell that other bodies and void leave free from which it is in full no longer one body's, and has void
OTHERS = 0.01


@kernel
def contact_swept_volumes(part, parts, dt, metrics, dz, contact_columns, aperture_r, aperture_z, u0, v0, u, v, even_r, even_z,
                          fr, fz, own_r, own_z):
    """Volumes swept in the step by the faces of contact-interface cells: by aperture, and by each group as if it were alone.

    Reads    u0, v0, u, v [b, j, i]
    Writes   fr, fz [j, i]; own_r, own_z [b, j, i]
    """
    j0, j1 = outer_rows(parts)
    for j in range(parts[part], past_row(part, parts, 1)):
        if j < j1:
            for i in range(contact_columns[j, 0], contact_columns[j, 1] + 1):
                scale = 0.25 * dt * metrics[FACE_R, i] * dz[j]
                fr[j, i] = even_r[j, i] + scale * (face_flow_r(j, i, -1, aperture_r, u) + face_flow_r(j, i, -1, aperture_r, u0))
                for g in range(2):
                    own_r[g, j, i] = even_r[j, i] + scale * (face_flow_r(j, i, g, aperture_r, u) + face_flow_r(
                        j, i, g, aperture_r, u0))
        lo, hi = union(contact_columns, max(j - 1, j0), min(j + 1, j1))
        for i in range(lo, hi):
            fz[j, i] = even_z[j, i] + 0.5 * dt * (face_flow_z(j, i, -1, metrics, aperture_z, v) + face_flow_z(
                j, i, -1, metrics, aperture_z, v0))
            for g in range(2):
                own_z[g, j, i] = even_z[j, i] + 0.5 * dt * (face_flow_z(j, i, g, metrics, aperture_z, v) + face_flow_z(
                    j, i, g, metrics, aperture_z, v0))


#: share of a difference of p_c between two neighbouring cells of the surface that evens out in a step
EVENING = 0.05


@point
def evening_volume(j, i, row, column, volume, skin, bulk, ph, qr):
    """Volume that moves from cell (j, i) of a surface to its neighbour (row, column), also of it, by the difference of p_c + q.

    explanation/sliding, equation 8.
    """
    if skin[KIND, j, i] != INTERFACE or skin[KIND, row, column] != INTERFACE:
        return 0.0
    give = min(volume[j, i] / bulk[j, i], volume[row, column] / bulk[row, column])
    return EVENING * give * ((ph[j, i] + qr[j, i]) - (ph[row, column] + qr[row, column]))


@kernel
def even_out(part, parts, contact_columns, volume, skin, bulk, ph, qr, even_r, even_z):
    """Volumes that even out p_c along the surface.

    A pressure that is constant in every cell of the surface, while velocities are linear, has a pattern (up and down from cell
    to cell) that pushes no vertex. The volumes that the faces between these cells sweep are corrected by the difference.

    Reads    ph, qr, bulk, volume [j, i], skin [3, j, i]
    Writes   even_r, even_z [j, i]
    """
    j0, j1 = outer_rows(parts)
    for j in range(parts[part], past_row(part, parts, 1)):
        if j < j1:
            for i in range(contact_columns[j, 0], contact_columns[j, 1] + 1):
                inside = contact_columns[j, 0] < i < contact_columns[j, 1]
                even_r[j, i] = evening_volume(j, i - 1, j, i, volume, skin, bulk, ph, qr) if inside else 0.0
        lo, hi = union(contact_columns, max(j - 1, j0), min(j + 1, j1))
        for i in range(lo, hi):
            inside = j0 < j < j1 and contact_columns[j - 1, 0] <= i < contact_columns[j - 1, 1] and (
                contact_columns[j, 0] <= i < contact_columns[j, 1])
            even_z[j, i] = evening_volume(j - 1, i, j, i, volume, skin, bulk, ph, qr) if inside else 0.0


@kernel
def warm_evened(part, parts, contact_columns, volume, ph, qr, even_r, even_z, vof, q):
    """Gives the work that is lost as p_c evens out, half to either cell, to the bodies by mass.

    Updates  q (e) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for i in range(contact_columns[j, 0], contact_columns[j, 1]):
            here = ph[j, i] + qr[j, i]
            made = 0.0
            if even_r[j, i] != 0.0:
                made += even_r[j, i] * (ph[j, i - 1] + qr[j, i - 1] - here)
            if even_r[j, i + 1] != 0.0:
                made += even_r[j, i + 1] * (here - ph[j, i + 1] - qr[j, i + 1])
            if even_z[j, i] != 0.0:
                made += even_z[j, i] * (ph[j - 1, i] + qr[j - 1, i] - here)
            if even_z[j + 1, i] != 0.0:
                made += even_z[j + 1, i] * (here - ph[j + 1, i] - qr[j + 1, i])
            if made == 0.0:
                continue
            mass = 0.0
            for m in range(vof.shape[0]):
                mass += vof[m, j, i] * q[RHO, m, j, i] * volume[j, i] if vof[m, j, i] > 0.0 else 0.0
            for m in range(vof.shape[0]):
                if vof[m, j, i] > 0.0:
                    q[E, m, j, i] += 0.5 * made / mass


@kernel
def contact_work(part, parts, dt, metrics, dz, contact_columns, group, aperture_r, aperture_z, ph, qr, u0, v0, u, v, fr, fz,
                 cell_mass, vof, q):
    """Pressure work in the pure ones among contact-interface cells: by the volume that they lose, not by their group's own.

    `deform` does the work of the group's own rate of volume; this is what is missing.

    Reads    ph, qr [j, i], velocities, fr, fz [j, i], cell_mass [b, j, i]
    Updates  q (e) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for i in range(contact_columns[j, 0], contact_columns[j, 1]):
            for m in range(vof.shape[0]):
                if vof[m, j, i] == 1.0:
                    g = group[m]
                    own = 0.5 * dt * (volume_rate(j, i, g, metrics, dz[j], aperture_r, aperture_z, u, v) + volume_rate(j, i, g,
                                      metrics, dz[j], aperture_r, aperture_z, u0, v0))
                    change = (fr[j, i + 1] - fr[j, i]) + (fz[j + 1, i] - fz[j, i])
                    q[E, m, j, i] -= (ph[j, i] + qr[j, i]) * (change - own) / cell_mass[g, j, i]


@kernel
def contact_shares(part, parts, mesh_box, contact_columns, volume, pre, vof, own_share, size):
    """Fractions of the cell as it stands on the mesh, in contact-interface cells and three around them.

    What flows out of the next cell is worked out as well, from the interfaces in it, for which 5 x 5 fractions are read.

    The volume before a sweep is what both groups leave of the cell. Neither is stretched by what the other does: a line that
    follows that volume would move and turn without its body. In void the bodies fill no more than the cell. Both rules come in
    with the first OTHERS of what is not the one body, and of void.

    Reads    volume, pre [j, i], vof [m, j, i]
    Writes   own_share [m, j, i], the fractions; size [j, i] (m^3), the volume that they are of
    """
    j0, j1 = outer_rows(parts)
    for j in range(max(first_row(part, parts, 3), 0), min(past_row(part, parts, 3), vof.shape[1])):
        lo, hi = union(contact_columns, max(j - 3, j0), min(j + 4, j1))
        for i in range(max(lo - 3, 0), min(hi + 3, vof.shape[2])):
            total, largest = 0.0, 0.0
            for m in range(vof.shape[0]):
                total += vof[m, j, i]
                largest = max(largest, vof[m, j, i])
            scale = 1.0
            if mesh_box[0] <= j < mesh_box[1] and mesh_box[2] <= i < mesh_box[3] and 0.0 < total and largest < 1.0:
                scale += smoothstep((1.0 - largest) / OTHERS) * (pre[j, i] / volume[j, i] - 1.0)
                scale -= smoothstep((1.0 - total) / OTHERS) * max(scale - 1.0 / total, 0.0)
            for m in range(vof.shape[0]):
                own_share[m, j, i] = vof[m, j, i] * scale
            size[j, i] = pre[j, i] / scale


@apart
def take(g, more, dj, di, j, i, group, own_share, size, vof, flux_volume):
    """Adds `more` to the volume of group g through face (j, i); what the group cannot take.

    What flows the other way ends first, every body by the same share. Then the body that fills the most of the cell that the
    volume comes from gives up to all that it has there.
    """
    swept = 0.0
    for m in range(vof.shape[0]):
        swept += flux_volume[m, j, i] if group[m] == g else 0.0
    if swept * more < 0.0:
        keep = max((swept + more) / swept, 0.0)
        for m in range(vof.shape[0]):
            if group[m] == g:
                flux_volume[m, j, i] *= keep
        more = more + swept if keep == 0.0 else 0.0
    row, column = (j - dj, i - di) if more > 0.0 else (j, i)
    m = largest_of(g, row, column, group, vof)
    if m < 0 or more == 0.0:
        return more
    given = min(abs(more), max(own_share[m, row, column] * size[row, column] - abs(flux_volume[m, j, i]), 0.0))
    given = given if more > 0.0 else -given
    flux_volume[m, j, i] += given
    return more - given


@kernel
def contact_fluxes(dj, di, part, parts, mesh_box, dr, dz, hard_first, soft_first, group, gases, contact_columns, line, face,
                   own, own_share, size, vof, centroid, flux_volume, flux_place, strips):
    """Volume of every body through the faces of contact-interface cells, with the velocity of its group.

    In a cell the group with the flatter surface comes first among the nested interfaces, where void parts them each group for
    itself, by the weights of `contact_lines`. What the bodies together are short of, or beyond, the volume that the face
    sweeps, and the void of the cell that this comes from cannot make up for (void flows with the face, and no more than there
    is), the softer bodies take as far as they have it there, and the hard ones what is left (`take`). Where that cell has a
    gap, a full cell into which volume flows is short of nothing as long as there is more of its body: no void enters a body
    from its surface.

    Reads    face [j, i], own [b, j, i], what contact_shares wrote, vof [m, j, i], group [m], line [10, j, i];
             hard_first, soft_first [m], the bodies in the order in which their interfaces are nested
    Updates  flux_volume [m, j, i]; flux_place [2, m, j, i]
    Scratch  strips [j, 3, 4, m]
    """
    j0, j1 = outer_rows(parts)
    bodies = group.shape[0]
    for j in range(parts[part], past_row(part, parts, dj)):
        lo, hi = union(contact_columns, max(j - dj, j0), min(j + 1, j1))
        if lo >= hi:
            continue
        for i in range(lo, hi + di):
            if (di == 1 and (i == mesh_box[2] or i == mesh_box[3])) or (dj == 1 and (j == mesh_box[0] or j == mesh_box[1])):
                continue
            total = 0.0
            for m in range(bodies):
                swept = own[group[m], j, i]
                up = swept > 0.0
                row, column = (j - dj, i - di) if up else (j, i)
                volume = 0.0
                flux_place[0, m, j, i] = 0.0
                flux_place[1, m, j, i] = 0.0
                if vof[m, row, column] == 1.0:
                    volume = swept
                elif vof[m, row, column] > 0.0 and swept != 0.0:
                    width = min(abs(swept) / size[row, column], 1.0)
                    w, given, along, across = 1.0, 0.0, 0.0, 0.0
                    void = 1.0 - cumulative(row, column, bodies - 1, hard_first, vof)
                    w_low, w_high = (0.0, width) if up else (width, 0.0)
                    strip = strips[j, 1 if up else 0]
                    if contact_columns[row, 0] <= column < contact_columns[row, 1]:
                        w = line[HARD_FIRST if group[m] == 1 else SOFT_AFTER, row, column]
                    if w > 0.0:
                        fill_strips(row, column, m, dj == 1, w_low, w_high, 0.0, hard_first, own_share, void, group, gases,
                                    centroid, dr, dz, strips[j])
                        given, along, across = w * strip[SHARE, m], w * strip[ALONG, m], w * strip[ACROSS, m]
                    if w < 1.0:
                        fill_strips(row, column, m, dj == 1, w_low, w_high, 0.0, soft_first, own_share, void, group, gases,
                                    centroid, dr, dz, strips[j])
                        given += (1.0 - w) * strip[SHARE, m]
                        along += (1.0 - w) * strip[ALONG, m]
                        across += (1.0 - w) * strip[ACROSS, m]
                    if given > NOTHING:
                        flux_place[0, m, j, i] = along / given
                        flux_place[1, m, j, i] = across / given
                    volume = given * size[row, column] if up else -given * size[row, column]
                flux_volume[m, j, i] = volume
                total += volume
            rest = face[j, i] - total
            up = face[j, i] > 0.0
            row, column = (j - dj, i - di) if up else (j, i)
            to_row, to_column = (j, i) if up else (j - dj, i - di)
            void = 1.0 - cumulative(row, column, bodies - 1, hard_first, vof)
            gap = smoothstep(void / GAP - 0.5)
            if gap > 0.0 and (rest > 0.0) == up:
                for m in range(bodies):
                    full = smoothstep(1.0 - (1.0 - vof[m, to_row, to_column]) / OTHERS)
                    if full > 0.0:
                        swept = own[group[m], j, i] if up else -own[group[m], j, i]
                        most = min(swept, own_share[m, row, column] * size[row, column]) - abs(flux_volume[m, j, i])
                        more = gap * full * min(abs(rest), max(most, 0.0))
                        more = more if up else -more
                        flux_volume[m, j, i] += more
                        rest -= more
            room = min(void * size[row, column], abs(face[j, i])) if (rest > 0.0) == up else 0.0
            beyond = max(abs(rest) - room, 0.0)
            if beyond > 0.0:
                left = take(0, beyond if rest > 0.0 else -beyond, dj, di, j, i, group, own_share, size, vof, flux_volume)
                take(1, left, dj, di, j, i, group, own_share, size, vof, flux_volume)


@kernel
def limit_fluxes(dj, di, part, parts, mesh_box, contact_columns, pre, vof, flux_volume):
    """No cell gives more of a body through both of its faces than it has.

    Reads    pre [j, i], vof [m, j, i]
    Updates  flux_volume [m, j, i] of the faces around contact-interface cells
    """
    j0, j1 = outer_rows(parts)
    for j in range(parts[part], parts[part + 1]):
        lo, hi = union(contact_columns, max(j - dj, j0), min(j + dj + 1, j1))
        for i in range(max(lo - di, mesh_box[2]), min(hi + di, mesh_box[3])):
            for m in range(vof.shape[0]):
                low, high = max(-flux_volume[m, j, i], 0.0), max(flux_volume[m, j + dj, i + di], 0.0)
                there = vof[m, j, i] * pre[j, i]
                if low + high > there and vof[m, j, i] > 0.0:
                    keep = there / (low + high)
                    if low > 0.0:
                        flux_volume[m, j, i] = -keep * low
                    if high > 0.0:
                        flux_volume[m, j + dj, i + di] = keep * high
