"""The remap of momentum on dual cells, and what the three advection choices make of the kinetic energy."""

from math import sqrt

from hydro2d.fields import E
from hydro2d.jit import kernel, prange
from hydro2d.kernels.acceleration import TINY
from hydro2d.kernels.remap import limited_difference
from hydro2d.kernels.spans import union

#: advection by name, in the order of the integer that the kernels take
CHOICES = ("momentum", "ke", "both")
MOMENTUM, KE, BOTH = range(3)


@kernel
def dual_fluxes(dj, di, j0, j1, i0, i1, cm_in, cm_out, reach, flux_mass, mass, u, v, dual):
    """Mass, momentum and kinetic energy that flow between neighbouring vertices, stored at the lower vertex of the edge.

    r-sweep: Phi = cm_out (F_left) + cm_in (F_right) of the column between, summed over the two rows beside the vertex;
    z-sweep: the column's share of the vertex times (F_bottom + F_top). With these the dual masses after the sweep are again
    the corner sums of the cell masses (explanation/remap, equation 6).

    Reads    flux_mass [j, i]; mass, u, v [b, j, i]
    Writes   dual [k, j, i]: mass, radial and axial momentum, and kinetic energy of each component
    """
    for j in prange(j0 - dj, j1 + 1):
        lo, hi = union(reach, j - 1 - dj, j + 1 + dj)
        lo, hi = max(lo, i0) - di, min(hi + 1, i1 + 1)
        if lo >= hi:
            continue
        d0 = dual[0, j]
        d1 = dual[1, j]
        d2 = dual[2, j]
        d3 = dual[3, j]
        d4 = dual[4, j]
        below = flux_mass[j - di]
        here = flux_mass[j]
        above = flux_mass[j + dj]
        m_l = mass[0, j]
        m_r = mass[0, j + dj]
        u_ll = u[0, j - dj]
        u_l = u[0, j]
        u_r = u[0, j + dj]
        u_rr = u[0, j + 2 * dj]
        v_ll = v[0, j - dj]
        v_l = v[0, j]
        v_r = v[0, j + dj]
        v_rr = v[0, j + 2 * dj]
        if di == 1:
            for i in range(lo, hi):
                d0[i] = cm_out[i] * (below[i] + here[i]) + cm_in[i] * (below[i + 1] + here[i + 1])
        else:
            for i in range(lo, hi):
                d0[i] = cm_in[i] * (here[i] + above[i]) + cm_out[i - 1] * (here[i - 1] + above[i - 1])
        for i in range(lo, hi):
            flow = d0[i]
            up = flow > 0.0
            whole = m_l[i] if up else m_r[i + di]
            half = 0.5 * (1.0 - min(abs(flow) / max(whole, TINY), 1.0))
            a = u_l[i] if up else u_r[i + di]
            b = u_r[i + di] if up else u_l[i]
            z = u_ll[i - di] if up else u_rr[i + 2 * di]
            d1[i] = flow * (a + half * limited_difference(z, a, b))
            d3[i] = flow * (0.5 * a * a + half * limited_difference(0.5 * z * z, 0.5 * a * a, 0.5 * b * b))
            a = v_l[i] if up else v_r[i + di]
            b = v_r[i + di] if up else v_l[i]
            z = v_ll[i - di] if up else v_rr[i + 2 * di]
            d2[i] = flow * (a + half * limited_difference(z, a, b))
            d4[i] = flow * (0.5 * a * a + half * limited_difference(0.5 * z * z, 0.5 * a * a, 0.5 * b * b))


@kernel
def vertex_update(dj, di, j0, j1, i0, i1, choice, bound, still, cm_in, cm_out, reach, cell_mass, dual, w_old, w, mass, deficit,
                  sums):
    """Velocities after the sweep, by the advection choice (explanation/remap, equations 7 to 9).

    momentum   u = P/M
    ke         u = sign(P) sqrt(2 K/M) per component, |u| <= bound |P/M|
    both       u = P/M, and the deficit K - M u^2/2 is left in `deficit` for `deposit` to give to the cells
    P/M is kept within the velocities of the three vertices that it comes from, which removes round-off only. The normal
    velocity on the axis and on walls is zero: still holds the columns (2) and the rows (2) of those, -1 for none.

    Reads    cell_mass [j, i] after the sweep, dual [k, j, i]; w_old = (u, v) [c, b, j, i] and mass [b, j, i] before it
    Writes   w = (u, v) [c, b, j, i], mass [b, j, i]; deficit [j, i]
    Writes   sums [5, j]: kinetic energy before and after; axial momentum after less P; kinetic energy cut by the bound;
             axial momentum given to walls
    """
    for j in prange(j0, j1):
        lo, hi = union(reach, j - 1, j + 1)
        lo, hi = max(lo, i0), min(hi + 1, i1)
        below = cell_mass[j - 1]
        above = cell_mass[j]
        m_j = mass[0, j]
        k_before, k_after, p_error, k_cut, p_wall = 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(lo, hi):
            old = m_j[i]
            new = cm_out[i - 1] * (below[i - 1] + above[i - 1]) + cm_in[i] * (below[i] + above[i])
            left = 0.0
            m_j[i] = new
            k_before += 0.5 * old * (w_old[0, 0, j, i] ** 2 + w_old[1, 0, j, i] ** 2)
            if new <= 0.0:
                w[0, 0, j, i] = 0.0
                w[1, 0, j, i] = 0.0
                deficit[j, i] = 0.0
                continue
            for c in range(2):
                a = w_old[c, 0, j, i]
                if dual[0, j, i] == 0.0 and dual[0, j - dj, i - di] == 0.0:
                    w[c, 0, j, i] = a
                    k_after += 0.5 * new * a * a
                    continue
                momentum = old * a + (dual[1 + c, j - dj, i - di] - dual[1 + c, j, i])
                least = min(a, min(w_old[c, 0, j - dj, i - di], w_old[c, 0, j + dj, i + di]))
                most = max(a, max(w_old[c, 0, j - dj, i - di], w_old[c, 0, j + dj, i + di]))
                mean = min(max(momentum / new, least), most)
                if (i == still[0] or i == still[1]) if c == 0 else (j == still[2] or j == still[3]):
                    p_wall += momentum if c == 1 else 0.0
                    mean = 0.0
                if choice != MOMENTUM:
                    kinetic = max(0.5 * old * a * a + (dual[3 + c, j - dj, i - di] - dual[3 + c, j, i]), 0.0)
                    if choice == KE:
                        speed = sqrt(2.0 * kinetic / new)
                        k_cut += max(kinetic - 0.5 * new * (bound * mean) ** 2, 0.0)
                        speed = min(speed, bound * abs(mean))
                        p_error += (new * speed - new * abs(mean)) * (1.0 if mean > 0.0 else -1.0) if c == 1 else 0.0
                        mean = speed if mean > 0.0 else -speed
                    else:
                        left += kinetic - 0.5 * new * mean * mean
                w[c, 0, j, i] = mean
                k_after += 0.5 * new * mean * mean
            deficit[j, i] = left / new
        sums[0, j] = k_before
        sums[1, j] = k_after
        sums[2, j] = p_error
        sums[3, j] = k_cut
        sums[4, j] = p_wall


@kernel
def deposit(j0, j1, cm_in, cm_out, reach, deficit, cell_mass, vof, q, sums):
    """Gives the kinetic energy that `both` found missing to the cells around each vertex, by corner mass, then by body mass.

    Reads    deficit [j, i] per vertex mass, cell_mass [j, i], vof [m, j, i]
    Updates  q (e) [k, m, j, i];  writes sums [j], the energy given
    """
    bodies = vof.shape[0]
    for j in prange(j0, j1):
        given = 0.0
        for i in range(reach[j, 0], reach[j, 1]):
            gain = cm_in[i] * (deficit[j, i] + deficit[j + 1, i]) + cm_out[i] * (deficit[j, i + 1] + deficit[j + 1, i + 1])
            given += gain * cell_mass[j, i]
            for m in range(bodies):
                if vof[m, j, i] > 0.0:
                    q[E, m, j, i] += gain
        sums[j] = given
