"""The remap of body fields: fluxes through faces, update of cells, and removal of remnants.

The same code serves both directions by the offsets (dj, di): (0, 1) along r, (1, 0) along z. Fluxes are kept in a few rows of a
buffer, ``flux[k, m, slot, i]``: a cell is updated as soon as nothing needs its old values any more, while they are still in the
processor's cache (explanation/remap, parts of the rows).
"""

from math import inf

from hydro2d.jit import cell_rows, kernel, point, rowwise
from hydro2d.kernels.column_ranges import columns, mixed_row, outer_rows
from hydro2d.kernels.interfaces import flux_range
from hydro2d.mesh.fields import DMG, LEAST, MOST, PER_MASS, RHO, SRR, SRZ, E
from hydro2d.mesh.grid import CM_IN, CM_OUT
from hydro2d.physics.advection import TINY, steepness_at, upwind
from hydro2d.physics.traction import smoothstep

#: share of its upper bound from which a field counts as at it: round-off in the mean of ones must not heal failed material
FULL = 1.0 - 1e-6
#: a body's slopes count in full where it fills the cells around, not at all where it fills less than this of one of them
FILLED = 0.9


@rowwise
def flux_row(dj, j, m, slot, b, w):
    """Fluxes through the faces of row j of the fields that body m carries.

    Second order and monotone in cells whose neighbours are full of the same body. The slope fades out towards cells filled by
    less than FILLED; in and next to these the donor's own value is taken. No slope is larger than the steepness times the
    smaller difference to a neighbour (`steepness_at`). Specific quantities use the mass coordinate, deviators the volume
    coordinate (explanation/remap, equation 4), both of the body alone: no cell loses more of the body than it has.

    Reads    carried [m, n], how many rows of q the body carries in addition to its density, and which;
             pre_sweep_volume [j, i]; flux_volume, vof [m, j, i]; q [k, m, j, i]
    Writes   flux [k, m, slot, i]
    """
    di = 1 - dj
    lo, hi = flux_range(dj, m, j, w)
    n = hi - lo
    if n > 0:
        swept = w.flux_volume[m, j, lo:hi]
        f_ll = w.vof[m, j - 2 * dj, lo - 2 * di:hi - 2 * di]
        f_l = w.vof[m, j - dj, lo - di:hi - di]
        f_r = w.vof[m, j, lo:hi]
        f_rr = w.vof[m, j + dj, lo + di:hi + di]
        size_l = w.pre_sweep_volume[j - dj, lo - di:hi - di]
        size_r = w.pre_sweep_volume[j, lo:hi]
        r_ll = w.q[RHO, m, j - 2 * dj, lo - 2 * di:hi - 2 * di]
        r_l = w.q[RHO, m, j - dj, lo - di:hi - di]
        r_r = w.q[RHO, m, j, lo:hi]
        r_rr = w.q[RHO, m, j + dj, lo + di:hi + di]
        mass = w.flux[RHO, m, slot, lo:hi]
        half_v = w.scratch[0, b, lo:hi]
        half_m = w.scratch[1, b, lo:hi]
        steep = w.scratch[2, b, lo:hi]
        for x in range(n):
            up = swept[x] > 0.0
            left, right = f_ll[x], f_rr[x]  # read before the choice, which would otherwise be a gather
            volume_l, volume_r = f_l[x] * size_l[x], f_r[x] * size_r[x]
            least = min(min(f_l[x], f_r[x]), left if up else right)
            clean = 0.5 * smoothstep((least - FILLED) / (1.0 - FILLED))
            steep[x] = steepness_at(up, r_ll[x], r_l[x], r_r[x], r_rr[x], w.steepness)
            donor, slope = upwind(up, r_ll[x], r_l[x], r_r[x], r_rr[x], steep[x])
            volume = max(volume_l if up else volume_r, TINY)
            half_v[x] = clean * (1.0 - abs(swept[x]) / volume)
            flow = swept[x] * (donor + half_v[x] * slope)
            half_m[x] = clean * (1.0 - abs(flow) / max(volume * donor, TINY))
            mass[x] = flow
        for place in range(1, w.carried[m, 0] + 1):
            k = w.carried[m, place]
            a_ll = w.q[k, m, j - 2 * dj, lo - 2 * di:hi - 2 * di]
            a_l = w.q[k, m, j - dj, lo - di:hi - di]
            a_r = w.q[k, m, j, lo:hi]
            a_rr = w.q[k, m, j + dj, lo + di:hi + di]
            out = w.flux[k, m, slot, lo:hi]
            by_mass = w.rules[m, k, PER_MASS] > 0.0
            carrier = w.flux[RHO, m, slot, lo:hi] if by_mass else w.flux_volume[m, j, lo:hi]
            weight = w.scratch[1 if by_mass else 0, b, lo:hi]
            for x in range(n):
                donor, slope = upwind(swept[x] > 0.0, a_ll[x], a_l[x], a_r[x], a_rr[x], steep[x])
                out[x] = carrier[x] * (donor + weight[x] * slope)


@rowwise
def update_row(dj, j, m, below, above, b, w):
    """Body m in row j after the sweep: volume, mass and carried fields. A cell without flux keeps its bits.

    Fields stay within the bounds of the table; failed material stays failed, to the last bit, and has no deviator.

    Reads    carried [m, n] as flux_row; face, pre_sweep_volume [j, i]; flux_volume [m, j, i];
             flux [k, m, slot, i] in the slots `below` and `above`
    Updates  vof [m, j, i] (share of the volume after the sweep), q [k, m, j, i]
    """
    di = 1 - dj
    lo, hi = max(w.body_ranges[dj, m, j, 0] - di, w.i0), min(w.body_ranges[dj, m, j, 1] + di, w.i1)
    n = hi - lo
    if n > 0:
        v_in = w.flux_volume[m, j, lo:hi]
        v_out = w.flux_volume[m, j + dj, lo + di:hi + di]
        s_in = w.face[j, lo:hi]
        s_out = w.face[j + dj, lo + di:hi + di]
        m_in = w.flux[RHO, m, below, lo:hi]
        m_out = w.flux[RHO, m, above, lo + di:hi + di]
        f_j = w.vof[m, j, lo:hi]
        r_j = w.q[RHO, m, j, lo:hi]
        size_j = w.pre_sweep_volume[j, lo:hi]
        old_v = w.scratch[0, b, lo:hi]
        old_m = w.scratch[1, b, lo:hi]
        new_v = w.scratch[2, b, lo:hi]
        new_m = w.scratch[3, b, lo:hi]
        # Step 1: volume and mass of the body before the sweep and after it (explanation/remap, equation 1)
        for x in range(n):
            f, rho, into, out = f_j[x], r_j[x], v_in[x], v_out[x]
            swept = s_out[x] - s_in[x]
            volume = f * size_j[x]
            mass = volume * rho
            after = volume + (into - out)
            mass_after = mass + (m_in[x] - m_out[x])
            same = into == 0.0 and out == 0.0
            unchanged = same and s_in[x] == 0.0 and s_out[x] == 0.0
            # divisions come before choices: a division inside a choice would keep the loop from being vectorised
            divisor, mass_divisor = after if after > TINY else TINY, mass_after if mass_after > TINY else TINY
            density, over_v, over_m = mass_after / divisor, 1.0 / divisor, 1.0 / mass_divisor
            fraction = max(after / (size_j[x] - swept), 0.0)
            density = density if after > 0.0 else 0.0
            over_v, over_m = over_v if after > TINY else 0.0, over_m if mass_after > TINY else 0.0
            r_j[x] = rho if unchanged else density
            f_j[x] = f if unchanged else fraction
            # a cell without flux is multiplied and divided by one
            old_v[x] = 1.0 if same else volume
            old_m[x] = 1.0 if same else mass
            new_v[x] = 1.0 if same else over_v
            new_m[x] = 1.0 if same else over_m
        # Step 2: every field that the body carries, by volume or by mass, within its bounds
        for place in range(1, w.carried[m, 0] + 1):
            k = w.carried[m, place]
            a_j = w.q[k, m, j, lo:hi]
            a_in = w.flux[k, m, below, lo:hi]
            a_out = w.flux[k, m, above, lo + di:hi + di]
            by_mass = w.rules[m, k, PER_MASS] > 0.0
            before = w.scratch[1 if by_mass else 0, b, lo:hi]
            inverse = w.scratch[3 if by_mass else 2, b, lo:hi]
            for x in range(n):
                a_j[x] = (a_j[x] * before[x] + (a_in[x] - a_out[x])) * inverse[x]
            least, most = w.rules[m, k, LEAST], w.rules[m, k, MOST]
            if least > -inf or most < inf:
                full = FULL * most
                for x in range(n):
                    a_j[x] = most if a_j[x] > full else max(a_j[x], least)
            # Step 3: failed material has no deviator
            if k == DMG:
                for component in range(SRR, SRZ + 1):
                    s_j = w.q[component, m, j, lo:hi]
                    for x in range(n):
                        s_j[x] = s_j[x] if a_j[x] < 1.0 else 0.0


@rowwise
def mass_flux_row(dj, j, slot, w):
    """Mass flux of each group through the faces of row j, zero wherever the dual fluxes read it and nothing flows.

    Reads    group [m]; flux [k, m, slot, i];  writes flux_mass [b, j, i]
    """
    for g in range(w.flux_mass.shape[0]):
        lo, n = columns(max(w.group_ranges[g, 3, j, 0] - 2, w.i0 - 2), min(w.group_ranges[g, 3, j, 1] + 3, w.i1 + 3))
        total = w.flux_mass[g, j]
        for x in range(n):
            total[lo + x] = 0.0
    for m in range(w.body_ranges.shape[1]):
        lo, hi = flux_range(dj, m, j, w)
        lo, n = columns(lo, hi)
        mass = w.flux[RHO, m, slot]
        total = w.flux_mass[w.group[m], j]
        for x in range(n):
            total[lo + x] += mass[lo + x]


@rowwise
def cell_mass_row(dj, di, j, pre_sweep_volume, face, second, w):
    """Mass of each group in the cells of row j, in the volume that they have after the sweep.

    Reads    group [m]; pre_sweep_volume, face, volume [j, i]; vof [m, j, i]; q [k, m, j, i]
    Writes   cell_mass [b, j, i]
    """
    for g in range(w.cell_mass.shape[0]):
        lo, n = columns(w.group_ranges[g, 0, j, 0], w.group_ranges[g, 0, j, 1])
        out = w.cell_mass[g, j]
        for x in range(n):
            out[lo + x] = 0.0
        for m in range(w.vof.shape[0]):
            if w.group[m] == g:
                f_j = w.vof[m, j]
                rho_j = w.q[RHO, m, j]
                for x in range(n):
                    i = lo + x
                    out[i] += f_j[i] * rho_j[i]
        if second:
            volume_j = w.volume[j]
            for x in range(n):
                out[lo + x] *= volume_j[lo + x]
        else:
            s_in = face[j]
            s_out = face[j + dj]
            size_j = pre_sweep_volume[j]
            for x in range(n):
                i = lo + x
                out[i] *= size_j[i] - (s_out[i + di] - s_in[i])


@cell_rows
def sum_cell_mass(j, w):
    """Mass of each group in every cell, without a sweep.

    Reads    group [m]; volume [j, i]; vof [m, j, i]; q [k, m, j, i]
    Writes   cell_mass [b, j, i]
    """
    cell_mass_row(0, 0, j, w.volume, w.volume, True, w)


@point
def forget_centroids(j, i, vof, centroid):
    """Sets the centroids to the middle in a cell that one body fills, or for bodies that are not in it.

    Updates  centroid [2, m, j, i]
    """
    for m in range(vof.shape[0]):
        if not 0.0 < vof[m, j, i] < 1.0:
            centroid[0, m, j, i] = 0.0
            centroid[1, m, j, i] = 0.0


@rowwise
def sweep_row(dj, j, below, above, b, w):
    """Row j after the sweep: every body, the mass of the cells and the list of mixed cells.

    Centroids are reset in cells that are no longer mixed.
    """
    for m in range(w.body_ranges.shape[1]):
        update_row(dj, j, m, below, above, b, w)
    cell_mass_row(dj, 1 - dj, j, w.pre_sweep_volume, w.face, w.second, w)
    for k in range(w.mixed_count[j]):
        forget_centroids(j, w.mixed[j, k], w.vof, w.centroid)
    mixed_row(j, w.group_ranges[0, 0], w.scratch[0, b], w)


@cell_rows
def sweep_r(j, part, w):
    """Carries every body along r: fluxes and update row by row.

    Reads    carried [m, n]; group [m]; rules [m, k, 4]; mesh_box (j0, j1, i0, i1 of the mesh), body_ranges, group_ranges; face,
             pre_sweep_volume, volume [j, i]; flux_volume [m, j, i]
    Updates  vof [m, j, i], q [k, m, j, i]
    Writes   flux_mass, cell_mass [b, j, i]; edge_flux [side, k, m, j] of mass and energy; mixed_count [j], mixed [j, k]
    Scratch  scratch [s, part, i], flux [k, m, slot, i]
    """
    slot = 6 * part + 3
    for m in range(w.body_ranges.shape[1]):
        flux_row(0, j, m, slot, part, w)
        lo, hi = flux_range(0, m, j, w)
        for side in range(2):
            i = w.mesh_box[2 + side]
            w.edge_flux[side, RHO, m, j] = w.flux[RHO, m, slot, i] if lo <= i < hi else 0.0
            w.edge_flux[side, E, m, j] = w.flux[E, m, slot, i] if lo <= i < hi else 0.0
    mass_flux_row(0, j, slot, w)
    sweep_row(0, j, slot, slot, part, w)


@point
def shared_slot(f, part, parts):
    """Slot of face f if its flux needs rows of two parts, then owned by the part above; -1 for the other faces.

    A row is updated two faces after it was below one, so three faces are shared.
    """
    if part > 0 and f <= parts[part] + 1:
        return 6 * part + f - parts[part] + 1
    if part < parts.shape[0] - 2 and f >= parts[part + 1] - 1:
        return 6 * (part + 1) + f - parts[part + 1] + 1
    return -1


@point
def slot_of(f, part, parts):
    """Slot of face f of a part: its own for a face that two parts share, one of three used in turn for the others."""
    shared = shared_slot(f, part, parts)
    return shared if shared >= 0 else 6 * part + 3 + f % 3


@kernel
def shared_fluxes(part, w):
    """Fluxes along z through the faces that a part shares with the part below, before either changes.

    Reads    as sweep_z;  writes flux [k, m, slot, i];  scratch [s, part, i]
    """
    if part > 0:
        for f in range(w.parts[part] - 1, w.parts[part] + 2):
            for m in range(w.body_ranges.shape[1]):
                flux_row(1, f, m, slot_of(f, part, w.parts), part, w)


@kernel
def sweep_z(part, w):
    """Carries every body along z: a row is updated as soon as the fluxes of the faces that need it are known.

    Reads    flux of the faces that two parts share (shared_fluxes), and as sweep_r
    Updates, writes and scratch as sweep_r; edge_flux [side, k, m, i]
    """
    _, end = outer_rows(w.parts)
    first, last = w.parts[part], w.parts[part + 1]
    for f in range(first, last + 2):
        if f <= last:
            slot = slot_of(f, part, w.parts)
            if shared_slot(f, part, w.parts) < 0:
                for m in range(w.body_ranges.shape[1]):
                    flux_row(1, f, m, slot, part, w)
            if f < last or last == end:
                mass_flux_row(1, f, slot, w)
            for side in range(2):
                if f == w.mesh_box[side]:
                    for m in range(w.body_ranges.shape[1]):
                        lo, hi = flux_range(1, m, f, w)
                        for k in range(2):
                            for i in range(w.i0, w.i1):
                                w.edge_flux[side, k, m, i] = w.flux[k, m, slot, i] if lo <= i < hi else 0.0
        j = f - 2 if f <= last else last - 1
        if j >= first and (f > last or j < last - 1):
            below = slot_of(j, part, w.parts)
            above = slot_of(j + 1, part, w.parts)
            sweep_row(1, j, below, above, part, w)


#: shares of a cell that are round-off
ROUND_OFF = 1e-14


@point
def kept_share(share, cutoff):
    """Part of a small share of a cell that is kept: all from twice the cutoff on, none below the cutoff or below ROUND_OFF.

    A body that shares its cell with less than that would seem to fill it.
    """
    left = share * smoothstep(share / cutoff - 1.0) if share > cutoff else 0.0
    return left if left > ROUND_OFF else 0.0


@cell_rows
def tidy(j, w):
    """Removes sub-cutoff fractions of bodies and void, makes fractions that should be 1 exactly 1, and sums all removals.

    A body below the cutoff is removed with its mass, internal energy, momentum and kinetic energy; void below it is
    closed by scaling the bodies' volumes at constant mass. Between the cutoff and twice the cutoff a part is removed, so that
    round-off decides nothing (`kept_share`). A negative density or volume counts as sub-cutoff.

    Reads    group [m]; u, v [b, j, i]
    Updates  mixed_count [j], mixed [j, k], the list of cells that are not full of one body; vof [m, j, i], q [k, m, j, i],
             cell_mass [b, j, i]; centroid [2, m, j, i]
    Writes   removed [4 + m, j]: internal energy, kinetic energy, axial momentum, volume closed; then mass of each body
    """
    for row in range(4 + w.vof.shape[0]):
        w.removed[row, j] = 0.0
    count = 0
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        post = w.volume[j, i]
        if not w.second:
            post = w.pre_sweep_volume[j, i] - (w.dj * (w.fz[j + 1, i] - w.fz[j, i]) + w.di * (w.fr[j, i + 1] - w.fr[j, i]))
        total, present, ended = 0.0, 0, False
        for m in range(w.vof.shape[0]):
            f = w.vof[m, j, i]
            rho = w.q[RHO, m, j, i]
            if f > 0.0 and (f < 2.0 * w.cutoff or not rho > 0.0):
                kept = kept_share(f, w.cutoff) if rho > 0.0 else 0.0
                mass = (f - kept) * rho * post
                inner, outer = w.metrics[CM_IN, i] * mass, w.metrics[CM_OUT, i] * mass
                g = w.group[m]
                ub = w.u[g, j]
                ut = w.u[g, j + 1]
                vb = w.v[g, j]
                vt = w.v[g, j + 1]
                v_in, v_out = vb[i] + vt[i], vb[i + 1] + vt[i + 1]
                k_in = (vb[i] ** 2 + vt[i] ** 2) + (ub[i] ** 2 + ut[i] ** 2)
                k_out = (vb[i + 1] ** 2 + vt[i + 1] ** 2) + (ub[i + 1] ** 2 + ut[i + 1] ** 2)
                w.removed[0, j] += mass * w.q[E, m, j, i]
                w.removed[1, j] += 0.5 * (inner * k_in + outer * k_out)
                w.removed[2, j] += inner * v_in + outer * v_out
                w.removed[4 + m, j] += mass
                f = kept
                w.vof[m, j, i] = f
                ended = True
            if f == 0.0:
                for field in range(w.q.shape[0]):
                    w.q[field, m, j, i] = 0.0
            total += f
            present += 1 if f > 0.0 else 0
        if total > 1.0 - 2.0 * w.cutoff and total != 1.0:
            void = kept_share(1.0 - total, w.cutoff)
            w.removed[3, j] += (max(1.0 - total, 0.0) - void) * post
            scale = (1.0 - void) / total
            for m in range(w.vof.shape[0]):
                if w.vof[m, j, i] > 0.0:
                    f = w.vof[m, j, i] * scale
                    f = 1.0 if present == 1 and void == 0.0 else f  # with any of a second body it is not full
                    w.q[RHO, m, j, i] *= w.vof[m, j, i] / f
                    w.vof[m, j, i] = f
            ended = True
        if ended:
            forget_centroids(j, i, w.vof, w.centroid)
        for g in range(w.cell_mass.shape[0]):
            mass = 0.0
            for m in range(w.vof.shape[0]):
                if w.group[m] == g:
                    mass += w.vof[m, j, i] * w.q[RHO, m, j, i]
            w.cell_mass[g, j, i] = mass * post
        kind = 0.0
        for m in range(w.vof.shape[0]):
            kind += (1000.0 if w.vof[m, j, i] == 1.0 else 0.0) + (1.0 if w.vof[m, j, i] > 0.0 else 0.0)
        w.mixed[j, count] = i
        count += 0 if kind == 0.0 or kind == 1001.0 else 1
    w.mixed_count[j] = count
