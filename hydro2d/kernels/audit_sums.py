"""Sums for the audit: of what the rows have lost in a phase, and of what went through the edges of the mesh in a sweep."""

from hydro2d.jit import plus, point, serial
from hydro2d.kernels.column_ranges import outer_rows


@point
def row_sum(amounts):
    """Sum over all rows; those beyond the active box have never lost anything."""
    total = 0.0
    for j in range(amounts.shape[0]):
        total = plus(total, amounts[j])
    return total


@point
def sum_rows(amounts, sums):
    """Writes into sums [k] the `row_sum` of each of amounts [k, j]."""
    for k in range(sums.shape[0]):
        sums[k] = row_sum(amounts[k])


@serial
def sum_acceleration(w):
    """Losses to the speed limit, the edges and the contact while the velocities change, summed over all rows of vertices.

    Reads    limited [3, j]; walls [edge, 2, j]; with two groups, transfer [5, j]
    Writes   limited_sum [3]; walls_sum [edge, 2]; transfer_sum [5]
    """
    sum_rows(w.limited, w.limited_sum)
    for edge in range(4):
        sum_rows(w.walls[edge], w.walls_sum[edge])
    if w.contact:
        sum_rows(w.transfer, w.transfer_sum)


@serial
def find_turned(w):
    """The first cell that the step turned inside out.

    Reads    turned [j, 2]
    Writes   first_turned [3]: row, -1 for none, column, body
    """
    j0, j1 = outer_rows(w.parts)
    w.first_turned[0] = -1
    for j in range(j1 - 1, j0 - 1, -1):
        if w.turned[j, 0] >= 0:
            w.first_turned[0], w.first_turned[1], w.first_turned[2] = j, w.turned[j, 0], w.turned[j, 1]


@serial
def sum_momentum(w):
    """Losses in the advection of momentum and the tidying of a sweep, summed over all rows.

    Reads    momentum_sums [5, j]; removed [4 + m, j]; with both, deposited [j]
    Writes   momentum_sum [5]; removed_sum [4 + m]; deposited_sum [1]
    """
    sum_rows(w.momentum_sums, w.momentum_sum)
    sum_rows(w.removed, w.removed_sum)
    w.deposited_sum[0] = row_sum(w.deposited) if w.both else 0.0


@serial
def sum_outflow(w):
    """Energy and mass that went through either edge of a sweep, out and in.

    Reads    edge_flux [side, k, m, j or i], towards higher r or z
    Writes   outflow [side, way, 1 + m]: energy, and mass of every body; way 0 out, 1 in
    """
    j0, j1 = outer_rows(w.parts)
    first, last = (j0, j1) if w.di == 1 else (w.i0, w.i1)
    for side in range(2):
        for k in range(w.outflow.shape[2]):
            w.outflow[side, 0, k], w.outflow[side, 1, k] = 0.0, 0.0
        for m in range(w.edge_flux.shape[2]):
            for place in range(first, last):
                mass = w.edge_flux[side, 0, m, place] if side == 1 else -w.edge_flux[side, 0, m, place]
                if mass != 0.0:
                    way = 0 if mass > 0.0 else 1
                    w.outflow[side, way, 1 + m] += mass
                    w.outflow[side, way, 0] += w.edge_flux[side, 1, m, place] if side == 1 else -w.edge_flux[side, 1, m, place]


@serial
def sum_kinetic_outflow(w):
    """Momentum and kinetic energy that went through either edge of a sweep, out and in.

    Reads    edge_dual [b, side, k, j or i], towards higher r or z
    Writes   kinetic_outflow [side, way, 2]: axial momentum and kinetic energy; way 0 out, 1 in
    """
    j0, j1 = outer_rows(w.parts)
    first, last = (j0, j1 + 1) if w.di == 1 else (w.i0, w.i1 + 1)
    for side in range(2):
        sign = 1.0 if side == 1 else -1.0
        for way in range(2):
            w.kinetic_outflow[side, way, 0], w.kinetic_outflow[side, way, 1] = 0.0, 0.0
        for g in range(w.edge_dual.shape[0]):
            for place in range(first, last):
                mass = sign * w.edge_dual[g, side, 0, place]
                if mass != 0.0:
                    way = 0 if mass > 0.0 else 1
                    w.kinetic_outflow[side, way, 0] += sign * w.edge_dual[g, side, 2, place]
                    w.kinetic_outflow[side, way, 1] += sign * (w.edge_dual[g, side, 3, place] + w.edge_dual[g, side, 4, place])
