"""The remap of body fields: fluxes through faces, update of cells, and the tidying of what is left over.

One body of code serves both directions by the offsets (dj, di): (0, 1) along r, (1, 0) along z.
"""

from hydro2d.fields import BODY_FIELDS, CARRIED_SOLID, DMG, EP, RHO, E
from hydro2d.jit import kernel, point, prange
from hydro2d.kernels.acceleration import TINY
from hydro2d.kernels.interfaces import face_range
from hydro2d.kernels.spans import columns, union


@point
def limited_difference(a, b):
    """Monotonized central difference from those to both neighbours (van Leer, J. Comput. Phys. 23 (1977) 276)."""
    size = min(min(2.0 * abs(a), 2.0 * abs(b)), 0.5 * abs(a + b))
    size = size if a * b > 0.0 else 0.0
    return size if a > 0.0 else -size


@point
def upwind(up, ll, l, r, rr):
    """(donor, limited difference towards the other side of the face) of a face between l and r that l feeds where ``up``.

    Differences first: a choice between two values in memory is a slow gather, one between two numbers is not.
    """
    across = r - l
    behind = l - ll if up else r - rr
    return l if up else r, limited_difference(behind, across if up else -across)


@kernel
def clear_mass_flux(j0, j1, i0, i1, reach, flux_mass):
    """Sets the total mass flux to zero wherever the dual fluxes of this sweep will read it."""
    for j in prange(j0 - 1, j1 + 2):
        lo, hi = union(reach, j - 3, j + 3)
        for i in range(max(lo - 2, i0 - 2), min(hi + 3, i1 + 3)):
            flux_mass[j, i] = 0.0


@kernel
def body_fluxes(dj, di, j0, j1, i0, i1, m, carried, span, f_face, pre, flux_volume, vof, q, half, flux, flux_mass):
    """Fluxes of mass, energy, deviators, plastic strain and damage of body m through the faces.

    Second order, monotone, in cells whose neighbours are full of the same body; the donor's own value in and next to mixed
    cells. Specific quantities in the mass coordinate, deviators in the volume coordinate (explanation/remap, equation 4).

    Reads    f_face, pre [j, i]; flux_volume, vof [m, j, i]; q [k, m, j, i]
    Writes   flux [k, j, i];  updates flux_mass [j, i], the sum over bodies
    Scratch  half [2, j, i], the weights of the slopes by volume and by mass
    """
    for j in prange(j0, j1 + dj):
        lo, hi = face_range(dj, m, j, span)
        if lo >= hi:
            continue
        lo, hi = max(lo, i0), min(hi, i1 + di)
        n = hi - lo
        if n <= 0:
            continue
        swept = flux_volume[m, j, lo:hi]
        f_ll = vof[m, j - 2 * dj, lo - 2 * di:hi - 2 * di]
        f_l = vof[m, j - dj, lo - di:hi - di]
        f_r = vof[m, j, lo:hi]
        f_rr = vof[m, j + dj, lo + di:hi + di]
        pre_l = pre[j - dj, lo - di:hi - di]
        pre_r = pre[j, lo:hi]
        r_ll = q[RHO, m, j - 2 * dj, lo - 2 * di:hi - 2 * di]
        r_l = q[RHO, m, j - dj, lo - di:hi - di]
        r_r = q[RHO, m, j, lo:hi]
        r_rr = q[RHO, m, j + dj, lo + di:hi + di]
        mass = flux[RHO, j, lo:hi]
        total = flux_mass[j, lo:hi]
        half_v = half[0, j, lo:hi]
        half_m = half[1, j, lo:hi]
        for x in range(n):
            up = swept[x] > 0.0
            least = min(min(f_l[x], f_r[x]), f_ll[x] if up else f_rr[x])
            clean = 0.5 if least == 1.0 else 0.0
            donor, slope = upwind(up, r_ll[x], r_l[x], r_r[x], r_rr[x])
            volume = pre_l[x] if up else pre_r[x]
            half_v[x] = clean * (1.0 - abs(swept[x]) / volume)
            flow = swept[x] * (donor + half_v[x] * slope)
            half_m[x] = clean * (1.0 - abs(flow) / max(volume * donor, TINY))
            mass[x] = flow
            total[x] += flow
        for k in range(1, carried):
            a_ll = q[k, m, j - 2 * dj, lo - 2 * di:hi - 2 * di]
            a_l = q[k, m, j - dj, lo - di:hi - di]
            a_r = q[k, m, j, lo:hi]
            a_rr = q[k, m, j + dj, lo + di:hi + di]
            out = flux[k, j, lo:hi]
            by_mass = k == E or k >= EP
            carrier = flux[RHO, j, lo:hi] if by_mass else flux_volume[m, j, lo:hi]
            weight = half[1 if by_mass else 0, j, lo:hi]
            for x in range(n):
                donor, slope = upwind(swept[x] > 0.0, a_ll[x], a_l[x], a_r[x], a_rr[x])
                out[x] = carrier[x] * (donor + weight[x] * slope)


@kernel
def body_update(dj, di, j0, j1, i0, i1, m, carried, span, f_face, pre, flux_volume, flux, vof, q):
    """Body m after the sweep: volume, mass and what it carries, from the fluxes. A cell without flux keeps its bits.

    Reads    f_face, pre [j, i]; flux_volume [m, j, i]; flux [k, j, i]
    Updates  vof [m, j, i] (share of the volume after the sweep), q [k, m, j, i]
    """
    for j in prange(j0, j1):
        lo, hi = 1 << 30, 0
        for row in range(max(j - dj, 0), min(j + dj + 1, span.shape[1])):
            lo = min(lo, span[m, row, 0])
            hi = max(hi, span[m, row, 1])
        if lo >= hi:
            continue
        lo, hi = max(lo - di, i0), min(hi + di, i1)
        n = hi - lo
        if n <= 0:
            continue
        v_in = flux_volume[m, j, lo:hi]
        v_out = flux_volume[m, j + dj, lo + di:hi + di]
        s_in = f_face[j, lo:hi]
        s_out = f_face[j + dj, lo + di:hi + di]
        m_in = flux[RHO, j, lo:hi]
        m_out = flux[RHO, j + dj, lo + di:hi + di]
        f_j = vof[m, j, lo:hi]
        r_j = q[RHO, m, j, lo:hi]
        pre_j = pre[j, lo:hi]
        for k in range(1, carried):
            a_j = q[k, m, j, lo:hi]
            a_in = flux[k, j, lo:hi]
            a_out = flux[k, j + dj, lo + di:hi + di]
            by_mass = k == E or k >= EP
            for x in range(n):
                old = f_j[x] * pre_j[x]
                new = old + (v_in[x] - v_out[x])
                old = old * r_j[x] if by_mass else old
                new = old + (m_in[x] - m_out[x]) if by_mass else new
                same = v_in[x] == 0.0 and v_out[x] == 0.0
                value = (a_j[x] * old + (a_in[x] - a_out[x])) / new if new > 0.0 else 0.0
                a_j[x] = a_j[x] if same else value
        for x in range(n):
            old = f_j[x] * pre_j[x]
            new = old + (v_in[x] - v_out[x])
            post = pre_j[x] - (s_out[x] - s_in[x])
            same = v_in[x] == 0.0 and v_out[x] == 0.0 and s_in[x] == 0.0 and s_out[x] == 0.0
            density = (r_j[x] * old + (m_in[x] - m_out[x])) / new if new > 0.0 else 0.0
            r_j[x] = r_j[x] if same else density
            f_j[x] = f_j[x] if same else max(new / post, 0.0)


@kernel
def sum_cell_mass(j0, j1, reach, pre, dj, di, fr, fz, second, volume, vof, q, cell_mass):
    """Mass of every cell in the volume that it has after the sweep.

    Reads    pre, fr, fz, volume [j, i]; vof [m, j, i]; q [k, m, j, i]
    Writes   cell_mass [j, i]
    """
    bodies = vof.shape[0]
    for j in prange(j0, j1):
        lo, n = columns(reach[j, 0], reach[j, 1])
        out = cell_mass[j]
        for x in range(n):
            out[lo + x] = 0.0
        for m in range(bodies):
            f_j = vof[m, j]
            rho_j = q[RHO, m, j]
            for x in range(n):
                i = lo + x
                out[i] += f_j[i] * rho_j[i]
        fr_j = fr[j]
        fz_b = fz[j]
        fz_t = fz[j + 1]
        pre_j = pre[j]
        volume_j = volume[j]
        for x in range(n):
            i = lo + x
            swept = dj * (fz_t[i] - fz_b[i]) + di * (fr_j[i + 1] - fr_j[i])
            out[i] *= volume_j[i] if second else pre_j[i] - swept


@kernel
def tidy(j0, j1, trace, cm_in, cm_out, volume, mixed_count, mixed, pre, dj, di, fr, fz, second, u, v, vof, q, cell_mass,
         booked):
    """Removes traces of bodies and of void, makes fractions that should be 1 exactly 1, and books what was removed.

    A body below the trace fraction is removed with its mass, internal energy, momentum and kinetic energy; void below it is
    closed by scaling the bodies' volumes at constant mass. A negative density or volume counts as a trace.

    Reads    u, v [b, j, i]; mixed [j, k], in which the cells that are not full of one body are listed
    Updates  vof [m, j, i], q [k, m, j, i], cell_mass [j, i]
    Writes   booked [4 + m, j]: internal energy, kinetic energy, axial momentum, volume closed; then mass of each body
    """
    bodies = vof.shape[0]
    for j in prange(j0, j1):
        for row in range(4 + bodies):
            booked[row, j] = 0.0
        for k in range(mixed_count[j]):
            i = mixed[j, k]
            post = volume[j, i]
            if not second:
                post = pre[j, i] - (dj * (fz[j + 1, i] - fz[j, i]) + di * (fr[j, i + 1] - fr[j, i]))
            total = 0.0
            for m in range(bodies):
                f = vof[m, j, i]
                rho = q[RHO, m, j, i]
                if f > 0.0 and (f < trace or not rho > 0.0):
                    mass = f * rho * post
                    inner, outer = cm_in[i] * mass, cm_out[i] * mass
                    v_in, v_out = v[0, j, i] + v[0, j + 1, i], v[0, j, i + 1] + v[0, j + 1, i + 1]
                    k_in = (v[0, j, i] ** 2 + v[0, j + 1, i] ** 2) + (u[0, j, i] ** 2 + u[0, j + 1, i] ** 2)
                    k_out = (v[0, j, i + 1] ** 2 + v[0, j + 1, i + 1] ** 2) + (u[0, j, i + 1] ** 2 + u[0, j + 1, i + 1] ** 2)
                    booked[0, j] += mass * q[E, m, j, i]
                    booked[1, j] += 0.5 * (inner * k_in + outer * k_out)
                    booked[2, j] += inner * v_in + outer * v_out
                    booked[4 + m, j] += mass
                    f = 0.0
                    vof[m, j, i] = 0.0
                if f == 0.0:
                    for field in range(BODY_FIELDS):
                        q[field, m, j, i] = 0.0
                total += f
            if total > 1.0 - trace and total != 1.0:
                booked[3, j] += max(1.0 - total, 0.0) * post
                scale = 1.0 / total
                for m in range(bodies):
                    if vof[m, j, i] > 0.0:
                        f = vof[m, j, i] * scale
                        f = 1.0 if f > 1.0 - trace else f
                        q[RHO, m, j, i] *= vof[m, j, i] / f
                        vof[m, j, i] = f
            mass = 0.0
            for m in range(bodies):
                mass += vof[m, j, i] * q[RHO, m, j, i]
            cell_mass[j, i] = mass * post


@kernel
def bound_history(j0, j1, m, span, carried, q):
    """After the remap plastic strain is not negative and damage lies between 0 and 1.

    Updates  q [k, m, j, i]
    """
    for j in prange(j0, j1):
        if carried < CARRIED_SOLID:
            continue
        ep = q[EP, m, j]
        damage = q[DMG, m, j]
        for i in range(span[m, j, 0], span[m, j, 1]):
            ep[i] = max(ep[i], 0.0)
            damage[i] = min(max(damage[i], 0.0), 1.0)
