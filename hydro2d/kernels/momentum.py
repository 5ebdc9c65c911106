"""The remap of momentum on dual cells, and of kinetic energy by the three advection choices."""

from hydro2d.jit import cell_rows, kernel, not_inlined, plus, point, rowwise
from hydro2d.kernels.column_ranges import copy_beside, past_row
from hydro2d.mesh.fields import E
from hydro2d.mesh.grid import CM_IN, CM_OUT, GHOSTS
from hydro2d.physics.advection import TINY
from hydro2d.physics.edges import edge_normal_velocity
from hydro2d.physics.momentum import (
    carried,
    corner_mean,
    corner_sum,
    energy_missing,
    slope_weight,
    velocity_of_energy,
    velocity_of_momentum,
)

#: advection by name, in the order of the integer that the kernels take
ADVECTIONS = ("momentum", "ke", "both")
MOMENTUM, KE, BOTH = range(3)


@point
def dual_range(j, group_ranges, w):
    """Range of vertices of row j from which mass may flow within the active columns."""
    return max(group_ranges[1 + w.dj, j, 0], w.i0) - w.di, min(group_ranges[1 + w.dj, j, 1] + 1, w.i1 + 1)


@rowwise
def dual_row(g, j, slot, w):
    """Mass, momentum and kinetic energy of group g that flow between the vertices of row j and those at higher r or z.

    r-sweep: Phi = cm_out (F_left) + cm_in (F_right) of the column between, summed over the two rows next to the vertex;
    z-sweep: the column's share of the vertex times (F_bottom + F_top). With these the dual masses after the sweep are again
    the corner sums of the cell masses (explanation/remap, equation 6). Second order where no vertex is nearly massless.

    No slope is larger than steepness times the smaller difference to a neighbour.

    Reads    flux_mass, mass [b, j, i], velocity0 [c, b, j, i]
    Writes   dual [k, slot, i]: mass, radial and axial momentum, and kinetic energy of each component
    """
    dj, di = w.dj, w.di
    lo, hi = dual_range(j, w.group_ranges[g], w)
    n = hi - lo
    if n > 0:
        flow = w.dual[0, slot, lo:hi]
        half = w.dual[5, slot, lo:hi]
        here = w.flux_mass[g, j, lo - 1:hi + 1]
        inner = w.metrics[CM_IN, lo:hi]
        outer = w.metrics[CM_OUT, lo - dj:hi]
        if di == 1:
            below = w.flux_mass[g, j - 1, lo:hi + 1]
            for x in range(n):
                flow[x] = corner_sum(inner[x], outer[x], below[x], here[x + 1], below[x + 1], here[x + 2])
        else:
            above = w.flux_mass[g, j + 1, lo - 1:hi]
            for x in range(n):
                flow[x] = corner_sum(inner[x], outer[x], here[x], above[x], here[x + 1], above[x + 1])
        m_ll = w.mass[g, j - dj, lo - di:hi - di]
        m_l = w.mass[g, j, lo:hi]
        m_r = w.mass[g, j + dj, lo + di:hi + di]
        m_rr = w.mass[g, j + 2 * dj, lo + 2 * di:hi + 2 * di]
        for x in range(n):
            half[x] = slope_weight(flow[x], m_ll[x], m_l[x], m_r[x], m_rr[x])
        for c in range(2):
            a_ll = w.velocity0[c, g, j - dj, lo - di:hi - di]
            a_l = w.velocity0[c, g, j, lo:hi]
            a_r = w.velocity0[c, g, j + dj, lo + di:hi + di]
            a_rr = w.velocity0[c, g, j + 2 * dj, lo + 2 * di:hi + 2 * di]
            carried_p = w.dual[1 + c, slot, lo:hi]
            carried_k = w.dual[3 + c, slot, lo:hi]
            for x in range(n):
                carried_p[x] = carried(flow[x], half[x], a_ll[x], a_l[x], a_r[x], a_rr[x], w.steepness)
                carried_k[x] = carried(flow[x], half[x], 0.5 * a_ll[x] * a_ll[x], 0.5 * a_l[x] * a_l[x],
                                       0.5 * a_r[x] * a_r[x], 0.5 * a_rr[x] * a_rr[x], w.steepness)


@not_inlined
def rest_on_anvil(edge, g, j, lo, hi, new_j, left, w):
    """Sets the normal velocity to 0 at vertices that rest on an edge that only pushes, or would go beyond it.

    Reads    new_j [x], masses of the columns from lo;  velocity0 [c, b, j, i]
    Updates  velocity [c, b, j, i]; left [x], energy given to cells, per mass; momentum_sums [5, j] as in vertex_row
    """
    c, at = edge // 2, w.pushing[edge]
    if c == 1 and j != at:
        return
    for i in range(max(at, lo) if c == 0 else lo, min(at + 1, hi) if c == 0 else hi):
        after = w.velocity[c, g, j, i]
        if after == 0.0 or (w.velocity0[c, g, j, i] != 0.0 and edge_normal_velocity(edge, True, 0.0, after) != 0.0):
            continue
        w.velocity[c, g, j, i] = 0.0
        left[i - lo] += 0.5 * after * after
        w.momentum_sums[1, j] -= 0.5 * new_j[i - lo] * after * after
        if c == 1:
            w.momentum_sums[4, j] += new_j[i - lo] * after


@rowwise
def vertex_row(g, j, below, above, w):
    """Velocities of group g in row j after the sweep, by the kind of advection (explanation/remap, equations 7 to 9).

    momentum   u = P/M
    ke         u = sign(P) sqrt(2 K/M) per component, |u| <= ke_bound |P/M|
    both       u = P/M, and the deficit K - M u^2/2 is left in `deficit` for `deposit` to give to the cells
    P/M is kept within the velocities of the three vertices that it comes from. This removes round-off, and makes up for the
    half of a cell that a vertex at an open edge lacks when the whole cell leaves. The normal velocity on the axis, on walls and
    on edges with a velocity is prescribed, and on held edges that along them: constrained has the columns (2) and rows (2) of
    both, -1 for none, edge_velocity gives it. One across an edge goes before one along another.
    On edges that only push, likewise in `pushing`, it stays 0 where it is 0, and is 0 where it would go beyond.

    Reads    cell_mass [b, j, i] after the sweep, dual [k, slot, i] in the slots `below` and `above`;
             velocity0 [c, b, j, i] and mass [b, j, i] before it
    Writes   velocity [c, b, j, i] for the whole row; deficit [b, j, i]
    Updates  momentum_sums [5, j]: kinetic energy before and after; axial momentum after less P; kinetic energy cut by the
             bound; axial momentum given to walls
    """
    dj, di = w.dj, w.di
    lo, hi = max(w.group_ranges[g, 1, j, 0], w.i0), min(w.group_ranges[g, 1, j, 1] + 1, w.i1 + 1)
    n = hi - lo
    for c in range(2):
        copy_beside(w.velocity0[c, g, j], w.velocity[c, g, j], w.i0 - GHOSTS, lo, hi, w.i1 + 1 + GHOSTS)
    if n > 0:
        low = w.cell_mass[g, j - 1, lo - 1:hi]
        high = w.cell_mass[g, j, lo - 1:hi]
        inner = w.metrics[CM_IN, lo:hi]
        outer = w.metrics[CM_OUT, lo - 1:hi]
        m_j = w.mass[g, j, lo:hi]
        left = w.deficit[g, j, lo:hi]
        f_in = w.dual[0, below, lo - di:hi - di]
        f_out = w.dual[0, above, lo:hi]
        new_j = w.dual[5, below, lo:hi]  # in place of weights that are no longer needed
        # Step 1: masses after the sweep, corner sums of the cells (explanation/remap, equation 6)
        for x in range(n):
            left[x] = 0.0
            new_j[x] = corner_sum(inner[x], outer[x], low[x], high[x], low[x + 1], high[x + 1])
        for c in range(2):
            p_in = w.dual[1 + c, below, lo - di:hi - di]
            p_out = w.dual[1 + c, above, lo:hi]
            k_in = w.dual[3 + c, below, lo - di:hi - di]
            k_out = w.dual[3 + c, above, lo:hi]
            a_j = w.velocity0[c, g, j, lo:hi]
            a_low = w.velocity0[c, g, j - dj, lo - di:hi - di]
            a_high = w.velocity0[c, g, j + dj, lo + di:hi + di]
            out = w.velocity[c, g, j, lo:hi]
            k_before, k_after, k_cut, p_gained, p_wall = 0.0, 0.0, 0.0, 0.0, 0.0
            wall_row = j == w.constrained[6 - 4 * c] or j == w.constrained[7 - 4 * c]
            of_row = w.edge_velocity[6 - 4 * c] if j == w.constrained[6 - 4 * c] else w.edge_velocity[7 - 4 * c]
            axis, outside = w.constrained[4 * c], w.constrained[4 * c + 1]
            given, given_outside = w.edge_velocity[4 * c], w.edge_velocity[4 * c + 1]
            row_first = wall_row and c == 1
            # Step 2: momentum and kinetic energy of this component, and the velocity by the kind of advection (7 to 9)
            for x in range(n):
                a = a_j[x]
                old = m_j[x]
                new = new_j[x]
                resting = f_in[x] == 0.0 and f_out[x] == 0.0  # without flow not a bit may change
                of_column = lo + x == axis or lo + x == outside
                wall = wall_row or of_column
                fixed = given_outside if lo + x == outside else given
                fixed = of_row if row_first or (wall_row and not of_column) else fixed
                over = 1.0 / max(new, TINY)
                momentum = old * a + (p_in[x] - p_out[x])
                mean = velocity_of_momentum(momentum, over, a, a_low[x], a_high[x])
                mean = fixed if wall else mean
                kinetic = max(0.5 * old * a * a + (k_in[x] - k_out[x]), 0.0)
                after = velocity_of_energy(kinetic, over, w.ke_bound, mean) if w.advection == KE else mean
                after = fixed if wall else after
                after = a if resting else after
                after = after if new > 0.0 else 0.0
                out[x] = after
                # Step 3: sums for the conservation audit
                k_before = plus(k_before, 0.5 * old * a * a)
                k_after = plus(k_after, 0.5 * new * after * after)
                if w.advection == KE:
                    moves = not resting and new > 0.0
                    k_cut = plus(k_cut, max(energy_missing(kinetic, new, w.ke_bound * mean), 0.0) if moves else 0.0)
                gained = new * (after - momentum * over) if new > 0.0 else -momentum
                p_gained = plus(p_gained, 0.0 if resting or wall else gained)
                if w.advection == BOTH:
                    left[x] += 0.0 if resting else energy_missing(kinetic, new, mean) * over
                p_wall = plus(p_wall, momentum - new * fixed if wall and not resting else 0.0)
            w.momentum_sums[0, j] += k_before
            w.momentum_sums[1, j] += k_after
            w.momentum_sums[3, j] += k_cut
            if c == 1:
                w.momentum_sums[2, j] += p_gained
                w.momentum_sums[4, j] += p_wall
        # Step 4: vertices at rest on edges that only push
        for edge in range(4):
            if w.pushing[edge] >= 0:
                rest_on_anvil(edge, g, j, lo, hi, new_j, left, w)


@kernel
def sweep_momentum(part, w):
    """Carries the momentum of vertices along one direction.

    Reads    as dual_row and vertex_row; mesh_box (j0, j1, i0, i1 of the mesh)
    Writes   velocity [c, b, j, i]; deficit [b, j, i], momentum_sums [5, j]; edge_dual [b, side, k, j or i],
             flows over the mesh's edges
    Scratch  dual [k, slot, i], two slots per part; in z they alternate
    """
    dj, di = w.dj, w.di
    first, last = w.parts[part], past_row(part, w.parts, 1)
    for g in range(w.mass.shape[0]):
        for j in range(first - dj, last):
            slot = 2 * part + dj * (j % 2)
            dual_row(g, j, slot, w)
            lo, hi = dual_range(j, w.group_ranges[g], w)
            for side in range(2):
                at = w.mesh_box[2 * di + side] + side - 1  # the edge from a ghost vertex to the mesh, or from the mesh to one
                for k in range(5):
                    if di == 1:
                        w.edge_dual[g, side, k, j] = w.dual[k, slot, at] if lo <= at < hi else 0.0
                    elif j == at and (j >= first or part == 0):
                        for i in range(w.i0, w.i1 + 1):
                            w.edge_dual[g, side, k, i] = w.dual[k, slot, i] if lo <= i < hi else 0.0
            if j >= first:
                below = 2 * part + dj * ((j - 1) % 2)
                for row in range(5):
                    w.momentum_sums[row, j] = 0.0 if g == 0 else w.momentum_sums[row, j]
                vertex_row(g, j, below, slot, w)


@cell_rows
def deposit(j, ranges, deficit, w):
    """Gives energy of vertices (the deficit of `both`, the heat of a contact) to the cells around, by the group's mass.

    Reads    ranges [j, 2], columns; deficit [b, j, i] per vertex mass, cell_mass [b, j, i], vof [m, j, i], group [m]
    Updates  q (e) [k, m, j, i];  writes deposited [j], the energy given
    """
    given = 0.0
    for g in range(deficit.shape[0]):
        low = deficit[g, j]
        high = deficit[g, j + 1]
        for i in range(ranges[j, 0], ranges[j, 1]):
            gain = corner_mean(w.metrics[CM_IN, i], w.metrics[CM_OUT, i], low[i], high[i], low[i + 1], high[i + 1])
            given += gain * w.cell_mass[g, j, i]
            for m in range(w.vof.shape[0]):
                if w.group[m] == g and w.vof[m, j, i] > 0.0:
                    w.q[E, m, j, i] += gain
    w.deposited[j] = given
