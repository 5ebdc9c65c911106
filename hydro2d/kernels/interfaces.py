"""Piecewise-linear interfaces: Youngs' normal, the constant of the line, and the share of a donor strip.

Everything is in the unit square of a cell with axes s = r^2/2 and z, in which areas are volumes of revolution, so that the
planar formulas are exact (explanation/interfaces). Several bodies are nested: the interface of the first k bodies of the stated
order bounds their cumulative fraction; void comes last.
"""


from hydro2d.jit import cell_rows, kernel, not_inlined, point, rowwise
from hydro2d.kernels.column_ranges import columns, past_row
from hydro2d.physics.centroids import beside, box_piece, forms, goes_on, piece, placed, within
from hydro2d.physics.interfaces import add_body, at_most_full, cumulative, nested, surface
from hydro2d.physics.traction import smoothstep

#: rows of a strip: shares of the cell; shares times the centroids' offsets along the sweep and across; thinness of the bodies
SHARE, ALONG, ACROSS, THIN = range(4)
#: zero fractions in the cells of `add_body`
NO_BODY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
#: no normal and no corner (`surface`)
NO_SURFACE = (0.0, 0.0, 0.0, 0.0, 0.0)
#: value of `last` for which `nest` includes all bodies
ALL = -1
#: a share of a cell below this has no place
NOTHING = 1e-14
#: share of a gas in a cell, or of both groups of a contact around it, from which their rules apply in full (`keeps_order`)
MEETING = 1e-6
#: share of void from which bodies of a contact do not keep their order in a cell
PARTING = 0.1
#: share of a cell that leaves it from which its interfaces determine the centroids in full; below, in proportion
SWEPT = 0.1


@rowwise
def report_row(j, w):
    """Records the first cell of row j with a body in it and no volume left (`sweep_volumes`)."""
    first, number = columns(w.active_range[j, 0], w.active_range[j, 1])
    for x in range(number):
        i = first + number - 1 - x
        most = 0.0
        for m in range(w.vof.shape[0]):
            if not w.pre_sweep_volume[j, i] > 0.0 and abs(w.vof[m, j, i]) > most:
                most = abs(w.vof[m, j, i])
                w.turned[j, 0], w.turned[j, 1] = i, m


@cell_rows
def sweep_volumes(j, w):
    """Volume of cells before a sweep: V + dF_r + dF_z for the first sweep, V + dF of its own direction for the second.

    Reads    volume [j, i], fr, fz [j, i], vof [m, j, i]
    Writes   pre_sweep_volume [j, i]; turned [j, 2], column of the first cell with a body in it that was turned inside out, -1
             for none, and the body that fills the most of it
    """
    lo, n = columns(w.active_range[j, 0], w.active_range[j, 1])
    fr_j = w.fr[j]
    fz_b = w.fz[j]
    fz_t = w.fz[j + 1]
    volume_j = w.volume[j]
    out = w.pre_sweep_volume[j]
    wrong = 0
    for x in range(n):
        i = lo + x
        along_r = fr_j[i + 1] - fr_j[i]
        along_z = fz_t[i] - fz_b[i]
        out[i] = volume_j[i] + (w.dj * along_z + w.di * along_r if w.second else along_r + along_z)
        wrong += 0 if out[i] > 0.0 else 1
    w.turned[j, 0] = -1
    if wrong > 0:
        report_row(j, w)


@point
def flux_range(dj, m, j, w):
    """Faces of row j through which body m may flow within the active columns: one beyond its own; empty is (0, 0)."""
    lo, hi = max(w.body_ranges[2 * dj, m, j, 0] - 1, w.i0), min(w.body_ranges[2 * dj, m, j, 1] + 2, w.i1 + 1 - dj)
    return (lo, hi) if lo < hi else (0, 0)


@kernel
def donor_volumes(part, w):
    """Volume of each body through each face, as if the donor cell were filled evenly: exact where it is pure.

    Nothing but void flows in through the faces of the mesh's edge (void_only).

    Reads    face [j, i], vof [m, j, i]
    Writes   flux_volume [m, j, i]
    """
    dj, di = w.dj, w.di
    edges = w.void_only
    for j in range(w.parts[part], past_row(part, w.parts, dj)):
        for m in range(w.vof.shape[0]):
            lo, hi = flux_range(dj, m, j, w)
            if lo >= hi:
                continue
            swept = w.face[j, lo:hi]
            given = w.flux_volume[m, j, lo:hi]
            here = w.vof[m, j, lo:hi]
            before = w.vof[m, j - dj, lo - di:hi - di]
            for x in range(hi - lo):
                given[x] = max(swept[x], 0.0) * before[x] + min(swept[x], 0.0) * here[x]
            swept = w.face[j]
            out = w.flux_volume[m, j]
            if dj == 1:
                for i in range(lo, hi):
                    if (j == edges[0] and swept[i] > 0.0) or (j == edges[1] and swept[i] < 0.0):
                        out[i] = 0.0
            else:
                if lo <= edges[2] < hi and swept[edges[2]] > 0.0:
                    out[edges[2]] = 0.0
                if lo <= edges[3] < hi and swept[edges[3]] < 0.0:
                    out[edges[3]] = 0.0


@point
def most_of(m, j, i, share):
    """Largest fraction of a body in 3 x 3 cells."""
    most = 0.0
    for row in range(j - 1, j + 2):
        for column in range(i - 1, i + 2):
            most = max(most, share[m, row, column])
    return most


@point
def thinnest_body(j, i, in_order, order, share, thin):
    """Thinness of the thinnest body of cell (j, i), 0 to 1 (1 minus `placed`), as far as bodies do not keep their order.

    0 where only one body is in the cell and around it.

    Writes   thin [m], that of each body, where any is above 0
    """
    if in_order == 1.0:
        return 0.0
    near = 0
    for m in range(order.shape[0]):
        near += 1 if most_of(m, j, i, share) > 0.0 else 0
    if near < 2:
        return 0.0
    thinnest = 0.0
    for m in range(order.shape[0]):
        thin[m] = 0.0
        if share[m, j, i] > 0.0:
            thin[m] = (1.0 - in_order) * (1.0 - placed(add_body(m, j, i, share, NO_BODY)))
            thinnest = max(thinnest, thin[m])
    return thinnest


@point
def keeps_order(j, i, group, gases, share, void):
    """Weights, 0 to 1, with which the bodies of a cell keep their order, and with which void has no box in it.

    Both are 1 where the cell contains a gas, and where the groups of a contact meet in 3 x 3 cells; but there the bodies keep
    their order only as far as no void lies between them. void : the share of the cell that is empty
    """
    gas, hard, soft, hards = 0.0, 0.0, 0.0, 0
    for m in range(group.shape[0]):
        gas += share[m, j, i] if gases[m] else 0.0
        hards += group[m]
    if hards > 0 and hards < group.shape[0]:
        for m in range(group.shape[0]):
            hard = max(hard, share[m, j, i] if group[m] == 1 else 0.0)
            soft = max(soft, 0.0 if group[m] == 1 else share[m, j, i])
        if min(hard, soft) < MEETING:
            for m in range(group.shape[0]):
                most = most_of(m, j, i, share)
                hard = max(hard, most if group[m] == 1 else 0.0)
                soft = max(soft, 0.0 if group[m] == 1 else most)
    of_gas, of_contact = smoothstep(gas / MEETING), smoothstep(min(hard, soft) / MEETING)
    return max(of_gas, of_contact * (1.0 - smoothstep(void / PARTING))), max(of_gas, of_contact)


@point
def own_box(place, width, high):
    """Part of a body's box in a strip, as `line_piece` gives it; place : fraction, centroid, how far it continues, if boxed."""
    fraction, along, across, continues, boxed = place
    return box_piece(fraction, along, across, continues, width, high) if boxed else (0.0, 0.0, 0.0)


@point
def beyond(below, box):
    """Part of a strip within the interface of the previous bodies (`next_body`) plus the part in the box of the next one."""
    return below[1] + box[0], below[2] + box[1], below[3] + box[2]


@not_inlined
def next_body(m, f, thin, box, whole, total, side, width, weight, below, strip):
    """Adds the part of a strip that body m fills, the next of the nested ones, times a weight; returns `below` for the next.

    f is the body's fraction, total that of all up to it; thin its thinness if it comes first for that, else 0. box is the part
    of the strip in its box, whole the part that all bodies up to it fill, as `line_piece` gives them; side is its centroid's
    offset across the sweep.
    below : share of the strip that the previous bodies fill; then their share by their interface, with its moments

    Updates  strip [SHARE, ALONG, ACROSS; m]
    """
    given, along, across = whole[0] - below[1], whole[1] - below[2], whole[2] - below[3]
    up_to = whole[0] + (below[0] - below[1])
    if thin > 0.0:
        given = thin * box[0] + (1.0 - thin) * given
        along = thin * box[1] + (1.0 - thin) * along
        across = thin * box[2] + (1.0 - thin) * across
        up_to = below[0] + given
    up_to = nested(up_to, below[0], f, total, width)
    kept = up_to - below[0]
    place = 0.0
    if given > NOTHING:
        place, side = along / given, across / given
    strip[SHARE, m] += weight * kept
    strip[ALONG, m] += weight * kept * min(max(place, -0.5), 0.5)
    strip[ACROSS, m] += weight * kept * min(max(side, -0.5), 0.5)
    return up_to, whole[0], whole[1], whole[2]


@not_inlined
def nest(j, i, last, widths, thin_first, weight, order, share, void, no_gap, strips, w):
    """Adds the parts of the strips of cell (j, i) that every body fills by the nested interfaces, times a weight.

    The bodies come in their order, or thin ones first (strips [0, THIN, m]), each by its own box; those after body `last` are
    left out (ALL: none). A strip of zero width is left out. no_gap : weight with which void has no box (`keeps_order`)

    Updates  strips [3, SHARE to ACROSS, m]: of the strips at the low and at the high side, and of the whole cell
    """
    along_z = w.dj == 1
    w_low, w_high, w_whole = widths
    around = NO_BODY
    moment_along, moment_across = 0.0, 0.0
    low, high, whole = (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    for turn in range(2 if thin_first else 1):
        for k in range(order.shape[0]):
            m = order[k]
            f = share[m, j, i]
            thin = strips[0, THIN, m] if thin_first else 0.0
            if thin_first and (thin > 0.0) != (turn == 0):
                continue
            around = add_body(m, j, i, share, around)  # also where it is only in the cells around
            if f == 0.0:
                continue
            full = at_most_full(around)
            along, across = w.centroid[0, m, j, i], w.centroid[1, m, j, i]
            bound = surface(j, i, full, w.dr, w.dz, void) if full[4] < 1.0 else NO_SURFACE
            if along_z:
                along, across = across, along
                bound = bound[1], bound[0], bound[3], bound[2], bound[4]
            moment_along += f * along
            moment_across += f * across
            total = full[4]
            middle_along, middle_across = moment_along / total, moment_across / total
            form = forms(full, no_gap)
            boxed = thin > 0.0 or form[1] > 0.0
            continues = goes_on(f, *beside(add_body(m, j, i, share, NO_BODY), along_z)) if boxed else 0.0
            place = f, along, across, continues, boxed
            if w_low > 0.0:
                box = own_box(place, w_low, False)
                all_of_it = piece(full, along_z, middle_along, middle_across, form, bound, beyond(low, box), w_low, False)
                low = next_body(m, f, thin, box, all_of_it, total, across, w_low, weight, low, strips[0])
            if w_high > 0.0:
                box = own_box(place, w_high, True)
                all_of_it = piece(full, along_z, middle_along, middle_across, form, bound, beyond(high, box), w_high, True)
                high = next_body(m, f, thin, box, all_of_it, total, across, w_high, weight, high, strips[1])
            if w_whole > 0.0:
                box = own_box(place, w_whole, True)
                all_of_it = piece(full, along_z, middle_along, middle_across, form, bound, beyond(whole, box), w_whole, True)
                whole = next_body(m, f, thin, box, all_of_it, total, across, w_whole, weight, whole, strips[2])
            if m == last:
                return


@not_inlined
def fill_strips(j, i, last, widths, order, share, void, strips, w):
    """Shares and centroids of every body in the strips at the low and the high side of cell (j, i), and in the whole cell.

    Interfaces are nested in the order of the bodies. Where several bodies of one group meet, none of them a gas, a body
    narrower than a cell, which its neighbours do not place, comes first in spite of the order (explanation/interfaces, thin
    bodies).

    last : the last body that is wanted, those after it are left out; ALL for all of them
    widths : widths of the three strips as shares of the cell, 0 for one that is left out and stays as it is

    Reads    share [m, j, i], the fractions; void, the share of the cell that is empty; centroid [2, m, j, i]
    Writes   strips [3, 4, m]: shares of the cell; shares times the offsets of the centroids from the middle of the strip, along
             the sweep in widths of the strip, and across; thinness of the bodies
    """
    for n, width in enumerate(widths):
        if width > 0.0:
            for m in range(order.shape[0]):
                strips[n, SHARE, m] = 0.0
                strips[n, ALONG, m] = 0.0
                strips[n, ACROSS, m] = 0.0
    ordered, no_gap = keeps_order(j, i, w.group, w.gases, share, void)
    thinnest = thinnest_body(j, i, ordered, order, share, strips[0, THIN])
    if thinnest < 1.0:
        nest(j, i, last, widths, False, 1.0 - thinnest, order, share, void, no_gap, strips, w)
    if thinnest > 0.0:
        nest(j, i, last, widths, True, thinnest, order, share, void, no_gap, strips, w)


@point
def place_of(strip, m):
    """Offset of the centroid of body m's part of a strip from its middle: along the sweep, in widths of the strip; across."""
    given = strip[SHARE, m]
    if given < NOTHING:
        return 0.0, 0.0
    return strip[ALONG, m] / given, strip[ACROSS, m] / given


@point
def by_contact(j, i, w):
    """Whether `contact_fluxes` computes the flux out of cell (j, i) through either face: not at the edge of the mesh."""
    inside = w.mesh_box[2] < i < w.mesh_box[3] - 1 if w.di == 1 else w.mesh_box[0] < j < w.mesh_box[1] - 1
    return inside and w.contact_columns[j, 0] <= i < w.contact_columns[j, 1]


@cell_rows
def interface_volumes(j, w):
    """Volume of each body out of each mixed cell, from the nested interfaces, and its place in the strips that leave.

    For contact-interface cells only the centroids are computed (`by_contact`). The cumulative volumes of a strip are kept
    monotone, each body gives no more than it has, and the excess that two opposite strips take together is passed on to the
    next body.

    Reads    mixed [j, k], interface_order [k], face, pre_sweep_volume [j, i], vof [m, j, i]
    Updates  flux_volume [m, j, i] and flux_place [2, m, j, i] at the faces through which mixed cells lose volume;
             centroid [2, m, j, i] of these cells: that of the part that the interfaces enclose, in full where SWEPT of the cell
             leaves
    Scratch  strips [j, 3, 4, m]
    """
    dj, di = w.dj, w.di
    left = w.strips[j, 0]
    right = w.strips[j, 1]
    whole = w.strips[j, 2]
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        out_low = max(-w.face[j, i], 0.0)
        out_high = max(w.face[j + dj, i + di], 0.0)
        if out_low == 0.0 and out_high == 0.0:
            continue
        size = w.pre_sweep_volume[j, i]
        w_low, w_high = out_low / size, out_high / size
        swept_weight = min((w_low + w_high) / SWEPT, 1.0)
        if by_contact(j, i, w):
            w_low, w_high = 0.0, 0.0
        void = 1.0 - cumulative(j, i, w.interface_order.shape[0] - 1, w.interface_order, w.vof)
        fill_strips(j, i, ALL, (w_low, w_high, 1.0), w.interface_order, w.vof, void, w.strips[j], w)
        for m in range(w.interface_order.shape[0]):
            f = w.vof[m, j, i]
            if f == 0.0:
                continue
            if w_low > 0.0:
                w.flux_place[0, m, j, i], w.flux_place[1, m, j, i] = place_of(left, m)
            if w_high > 0.0:
                w.flux_place[0, m, j + dj, i + di], w.flux_place[1, m, j + dj, i + di] = place_of(right, m)
            along, across = place_of(whole, m)
            w.centroid[di, m, j, i] = within(w.centroid[di, m, j, i] + swept_weight * (across - w.centroid[di, m, j, i]), f)
            w.centroid[dj, m, j, i] = within(w.centroid[dj, m, j, i] + swept_weight * (along - w.centroid[dj, m, j, i]), f)
        # two strips together may not take more of a body than there is; the excess moves on to the next body
        if w_low > 0.0 and w_high > 0.0:
            excess = 0.0
            for n in range(w.interface_order.shape[0]):
                m = w.interface_order[n]
                right[SHARE, m] += excess
                kept = min(right[SHARE, m], max(w.vof[m, j, i] - left[SHARE, m], 0.0))
                excess = right[SHARE, m] - kept
                right[SHARE, m] = kept
        for m in range(w.interface_order.shape[0]):
            if w_low > 0.0:
                w.flux_volume[m, j, i] = -left[SHARE, m] * size
            if w_high > 0.0:
                w.flux_volume[m, j + dj, i + di] = right[SHARE, m] * size
