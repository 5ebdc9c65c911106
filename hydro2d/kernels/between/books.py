"""The losses of a step enter the books: sinks of the audit, ways of the bodies' centres of mass, ejecta.

A row of sinks is momentum, energy, and mass of every body (`hydro2d.measure.audit`).
"""

from hydro2d.jit import control, point
from hydro2d.mesh.grid import FACE_R, GHOSTS, VOL_R
from hydro2d.mesh.sinks import SINKS
from hydro2d.mesh.sums import edge_course, edge_ejecta

CUTOFF, ADVECTION, KE_BOUND, OUTFLOW, INFLOW, WALLS, SPEED_LIMIT = (
    list(SINKS).index(name) for name in ("cutoff", "advection", "ke_bound", "outflow", "inflow", "walls", "speed_limit"))


@point
def book(sinks, row, momentum, energy):
    """Adds momentum and energy to a sink."""
    sinks[row, 0] += momentum
    sinks[row, 1] += energy


@point
def book_edges(sinks, edge_sinks, amounts):
    """Adds what each edge has taken, amounts [edge, 2]: momentum and energy."""
    for edge in range(4):
        if amounts[edge, 0] != 0.0 or amounts[edge, 1] != 0.0:
            book(sinks, edge_sinks[edge], amounts[edge, 0], amounts[edge, 1])


@control
def book_acceleration(w):
    """Losses and gains by the speed limit, contact, tractions and velocities of edges.

    Reads    limited_sum [3]; with two groups, transfer_sum [5]; loaded, edge_sinks [edge]; taken, walls_sum [edge, 2]
    Updates  sinks [s, 2 + m]; transfers [3, 2]
    """
    if w.limited_sum[2] != 0.0:
        book(w.sinks, SPEED_LIMIT, w.limited_sum[0], w.limited_sum[1])
    if w.contact:
        book(w.sinks, WALLS, w.transfer_sum[4], 0.0)
        w.transfers[0, 0] += w.transfer_sum[0]
        for kind in range(3):
            w.transfers[kind, 1] += w.transfer_sum[1 + kind]
    if max(w.loaded[0], w.loaded[1], w.loaded[2], w.loaded[3]) >= 0:
        book_edges(w.sinks, w.edge_sinks, w.taken)
    book_edges(w.sinks, w.edge_sinks, w.walls_sum)


@control
def aim(w):
    """Whether bodies flow through the low and the high edge of a sweep's direction: open ones that the active box has reached.

    Reads    box, mesh_box [4]; edges_open [edge]
    """
    low, edge = (2, 0) if w.di == 1 else (0, 2)
    w.opens_low = w.edges_open[edge] and w.box[low] == w.mesh_box[low]
    w.opens_high = w.edges_open[edge + 1] and w.box[low + 1] == w.mesh_box[low + 1]


@control
def book_outflow(w):
    """What went out and in through the edges of a sweep; asks for help with a cell that the step has turned inside out.

    Reads    box [4]; outflow [side, way, 1 + m]; edge_flux [side, k, m, j or i]; r, z, zc, dz; metrics [8, i]; fr, fz [j, i];
             course_columns [i]; ejecta [t, 4]; ejecta_bodies [t, 2]; group [m]; v [b, j-1/2, i-1/2]; first_turned [3]
    Updates  sinks [s, 2 + m]; course_moved [m, 2]; course_whole [m]; ejecta_gone [t, 3]
    """
    if w.first_turned[0] >= 0:
        w.asks = 1
        return
    first, last = (w.box[0], w.box[1]) if w.di == 1 else (w.box[2], w.box[3])
    size = w.nr if w.di == 1 else w.nz
    for side in range(2):
        if not (w.opens_high if side == 1 else w.opens_low):
            continue
        at = GHOSTS + size * side
        edge_course(w.di, first, last, at, -1.0 if side == 1 else 1.0, w.advance, w.course_columns, w.r, w.z, w.zc, w.dz,
                    w.metrics[FACE_R], w.metrics[VOL_R], w.fr, w.fz, w.edge_flux[side, 0], w.course_moved, w.course_whole)
        for target in range(w.ejecta.shape[0]):
            surface = w.ejecta[target, 1] + w.ejecta[target, 3] * w.reached
            for k in range(2):
                m = w.ejecta_bodies[target, k]
                edge_ejecta(w.di, first, last, at - side, 1.0 if side == 1 else -1.0, w.ejecta[target, 0], surface,
                            w.ejecta[target, 2], w.ejecta[target, 3], k == 0, w.zc, w.v[w.group[m]],
                            w.edge_flux[side, 0, m], w.ejecta_gone[target])
        for way in range(2):
            some = w.outflow[side, way, 0] != 0.0
            for m in range(w.group.shape[0]):
                some = some or w.outflow[side, way, 1 + m] != 0.0
            if some:
                row = OUTFLOW if way == 0 else INFLOW
                w.sinks[row, 1] += w.outflow[side, way, 0]
                for m in range(w.group.shape[0]):
                    w.sinks[row, 2 + m] += w.outflow[side, way, 1 + m]


@control
def book_momentum(w):
    """What the advection of momentum discarded and the tidying removed, and what edges took.

    Reads    kinetic_outflow [side, way, 2]; momentum_sum [5]; deposited_sum [1]; momentum_sums [5, j]; removed_sum [4 + m];
             box [4]; edge_sinks [edge]; holding_rows [2]
    Updates  sinks [s, 2 + m]
    """
    left = 0.0
    for side in range(2):
        if w.opens_high if side == 1 else w.opens_low:
            for way in range(2):
                energy = w.kinetic_outflow[side, way, 1]
                if energy != 0.0:
                    book(w.sinks, OUTFLOW if way == 0 else INFLOW, w.kinetic_outflow[side, way, 0], energy)
                    left += energy
    lost = w.momentum_sum[0] - w.momentum_sum[1] - left - w.deposited_sum[0]
    cut, taken = w.momentum_sum[3], w.momentum_sum[4]
    book(w.sinks, ADVECTION, -w.momentum_sum[2], lost - cut)
    if cut != 0.0:
        book(w.sinks, KE_BOUND, 0.0, cut)
    for k in range(2):
        j = w.holding_rows[k]
        if w.box[0] <= j <= w.box[1]:
            book(w.sinks, w.edge_sinks[2 + k], w.momentum_sums[4, j], 0.0)
            taken -= w.momentum_sums[4, j]
    if w.held_column >= 0:  # two of them have one sink
        book(w.sinks, w.held_column, taken, 0.0)
    some = w.removed_sum[0] + w.removed_sum[1] != 0.0 or w.removed_sum[2] != 0.0
    for m in range(w.group.shape[0]):
        some = some or w.removed_sum[4 + m] != 0.0
    if some:
        book(w.sinks, CUTOFF, w.removed_sum[2], w.removed_sum[0] + w.removed_sum[1])
        for m in range(w.group.shape[0]):
            w.sinks[CUTOFF, 2 + m] += w.removed_sum[4 + m]
