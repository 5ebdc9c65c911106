"""Cells cut by a surface between bodies, or between a body and void, in which the traction is common instead of the pressure.

Every body of a cut cell has the normal stress -p_c, and the strain across the surface follows from that
(explanation/mixed-cells, equations 9 to 13). Cells that fluids fill together are treated in `mixed`.
"""

from math import sqrt

from hydro2d.jit import cell_rows, not_inlined, point
from hydro2d.kernels.mixed_scratch import ACROSS, ALONG, BESIDE, FLOW, GROWTH, HEAT, MODULUS, NORMAL, SIZE
from hydro2d.mesh.fields import RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import CM_IN, CM_OUT, VOL_R
from hydro2d.physics.closure import NO_VOID
from hydro2d.physics.contents import (
    fullest,
    is_beside_gas,
    joins_solids,
    normal_deviator,
    pull_of,
    side_of_joint,
    surface_weight,
)
from hydro2d.physics.interfaces import youngs_gradient
from hydro2d.physics.stress import stress_scale
from hydro2d.physics.traction import (
    BESIDE_GAS,
    FREE_SURFACE,
    INTERFACE,
    JOINT,
    KIND,
    NORMAL_R,
    NORMAL_Z,
    STEEP,
    WHOLE,
    film_heat,
    gas_growth,
    gas_work,
    half_pressure,
    smoothstep,
    strain_across,
)

#: modulus of a gas over its pressure from which it is that of the least sound speed, and the pressure counts for nothing
STIFFEST = 10.0
#: share of the velocity difference across the surface that a step removes from a body's mass at a vertex in the gas
MOST_TIED = 0.5


@point
def firm_share(j, i, w):
    """Share of a cell that is neither void nor gas; the share of all its bodies where all are gases."""
    total, gas = w.solid[j, i], 0.0
    for m in range(w.vof.shape[0]):
        gas += w.vof[m, j, i] if w.vof[m, j, i] > 0.0 and w.gases[m] else 0.0
    return total - gas if gas < total else total


@cell_rows
def find_surfaces(j, w):
    """Normals of the surfaces in mixed cells, with the square root of their weight as length.

    The normal is Youngs', of the hard group's fraction minus the soft one's where a cell contains both, else of its one group
    against void, and of `side_of_joint` where bodies of one group fill the cell. It has its full weight from a fall of STEEP
    across the cell on, so that a bubble or a crumb has none, and no weight in the hard zone of a slip layer. Where void or a
    group vanishes, a cut cell behaves as a full one.

    Reads    vof [m, j, i], group, hard_bodies, strong, gases [m], the list of mixed cells
    Writes   skin [3, j, i]
    """
    for i in range(w.i0, w.i1):
        w.skin[NORMAL_R, j, i] = 0.0
        w.skin[NORMAL_Z, j, i] = 0.0
        w.skin[KIND, j, i] = WHOLE
    below, above = max(j - 1, w.mesh_box[0]), min(j + 1, w.mesh_box[1] - 1)
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        left, right = max(i - 1, w.mesh_box[2]), min(i + 1, w.mesh_box[3] - 1)
        own, other, zone = 0.0, 0.0, False
        for m in range(w.vof.shape[0]):
            if w.vof[m, j, i] > 0.0:
                own += w.vof[m, j, i] if w.group[m] == 1 else 0.0
                other += w.vof[m, j, i] if w.group[m] != 1 else 0.0
                zone = zone or (w.hard_bodies[m] and w.vof[m, j, i] >= w.threshold)
        void = 1.0 - (own + other)
        meet, full = own > 0.0 and other > 0.0, void <= NO_VOID
        if own + other == 0.0 or (full and not meet and (zone or not w.tipton or not joins_solids(j, i, w.strong, w.vof))):
            continue
        joint, first, gas = full and not meet, fullest(j, i, w.vof), is_beside_gas(j, i, w.gases, w.vof)
        w.skin[KIND, j, i] = INTERFACE if meet else FREE_SURFACE
        if joint:
            w.skin[KIND, j, i] = BESIDE_GAS if gas else JOINT
        if zone:
            continue
        sw, south, se, west, east, nw, north, ne = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for m in range(w.vof.shape[0]):
            of_hard = w.group[m] == 1
            sign = 1.0 if of_hard == (own > 0.0) else (-1.0 if meet else 0.0)
            if joint:
                sign = side_of_joint(m, j, i, first, gas, w.gases, w.vof)
            sw += sign * w.vof[m, below, left]
            south += sign * w.vof[m, below, i]
            se += sign * w.vof[m, below, right]
            west += sign * w.vof[m, j, left]
            east += sign * w.vof[m, j, right]
            nw += sign * w.vof[m, above, left]
            north += sign * w.vof[m, above, i]
            ne += sign * w.vof[m, above, right]
        n_r, n_z = youngs_gradient(j, i, sw, south, se, west, east, nw, north, ne, w.dr, w.dz)
        weight = smoothstep(0.25 * sqrt(n_r * n_r + n_z * n_z) / STEEP)
        n_r /= w.dr[i]
        n_z /= w.dz[j]
        size = sqrt(n_r * n_r + n_z * n_z)
        if size > 0.0:
            w.skin[NORMAL_R, j, i] = n_r / size * sqrt(weight)
            w.skin[NORMAL_Z, j, i] = n_z / size * sqrt(weight)


@point
def firm_density(j, i, w):
    """Mass of the bodies of a cell other than gases, per volume of the cell, kg/m^3."""
    mass = 0.0
    for m in range(w.vof.shape[0]):
        mass += w.q[RHO, m, j, i] * w.vof[m, j, i] if w.vof[m, j, i] > 0.0 and not w.gases[m] else 0.0
    return mass


@point
def ties(j, i, w):
    """Masses by which the vertices of a cell with a gas are tied: of every pair along r, and of every pair along z, kg.

    The mass that a body has at vertices in the gas moves with the body. A pair of vertices on either side of the surface loses
    the share MOST_TIED of its velocity difference in every step, by the body's mass at a vertex (explanation/mixed-cells,
    equation 13). 0 in other cells.
    """
    if w.skin[KIND, j, i] != BESIDE_GAS:
        return 0.0, 0.0
    mass = firm_density(j, i, w)
    mass *= MOST_TIED * w.metrics[VOL_R, i] * w.dz[j] * min(w.metrics[CM_IN, i], w.metrics[CM_OUT, i])
    return mass * w.skin[NORMAL_R, j, i] * w.skin[NORMAL_R, j, i], mass * w.skin[NORMAL_Z, j, i] * w.skin[NORMAL_Z, j, i]


@point
def pull_of_ties(g, j, i, row, column, by_r, by_z, w):
    """(radial, axial) momentum that vertex (j, i) of group g gains from the ties of cell (row, column) in a step."""
    u, v = w.u0[g, j, i], w.v0[g, j, i]
    beside, across = 2 * column + 1 - i, 2 * row + 1 - j
    pull_r = by_r * (w.u0[g, j, beside] - u) + by_z * (w.u0[g, across, i] - u)
    pull_z = by_r * (w.v0[g, j, beside] - v) + by_z * (w.v0[g, across, i] - v)
    return pull_r, pull_z


@point
def common_traction(j, i, w):
    """(common p_c of the bodies of a cut cell without change of volume, their modulus): means by compressibility f/K, Pa."""
    compliance, pressure = 0.0, 0.0
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0:
            compliance += w.vof[m, j, i] / w.km[m, j, i]
            pressure += w.vof[m, j, i] / w.km[m, j, i] * (w.pm[m, j, i] - normal_deviator(m, j, i, w.skin, w.q))
    return pressure / compliance, 1.0 / compliance


@point
def bodies_stress(g, j, i, w):
    """(rr, zz, tt, rz) of the stress of a cell without p_c, Pa: s - (n . s . n) I of its bodies by their shares.

    g : group whose bodies count; all for g < 0
    """
    scale = stress_scale(w.by_what_is_solid, w.solid[j, i])
    rr, zz, tt, rz = 0.0, 0.0, 0.0, 0.0
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0 and (g < 0 or w.group[m] == g):
            part = w.vof[m, j, i] * scale
            across = normal_deviator(m, j, i, w.skin, w.q)
            rr += part * (w.q[SRR, m, j, i] - across)
            zz += part * (w.q[SZZ, m, j, i] - across)
            tt -= part * (w.q[SRR, m, j, i] + w.q[SZZ, m, j, i] + across)
            rz += part * w.q[SRZ, m, j, i]
    return rr, zz, tt, rz


@point
def cut_pressure(j, i, rate, w):
    """p_c of a cut cell at half the step, for the cell's relative rate of volume (1/s)."""
    void = max(1.0 - w.solid[j, i], 0.0)
    pressure = half_pressure(w.p[j, i], w.bulk[j, i], 0.5 * w.dt * rate, void, pull_of(j, i, void, w.skin))
    borne = w.borne[j, i]
    return max(pressure, w.solid[j, i] * borne) if borne > 0.0 else pressure


@point
def is_free_gas(m, j, i, w):
    """Whether body m of a cut cell is a gas under pressure that nothing else resists: its volume is no straight line."""
    return w.gases[m] and w.mix[j, MODULUS, m] == 0.0 and w.pm[m, j, i] < w.km[m, j, i] < STIFFEST * w.pm[m, j, i]


@point
def gas_exponent(m, j, i, w):
    """Exponent n of p v^n of a gas in a cut cell: K/p along its isentrope, and 1 in a film at constant temperature."""
    return 1.0 + film_heat(w.vof[m, j, i]) * (w.km[m, j, i] / w.pm[m, j, i] - 1.0)


@point
def growth_at(j, i, target, w):
    """(growth of the bodies of a cut cell at p_c = target, as a share of the cell; its decrease with target, 1/Pa).

    Reads    mix [j, MODULUS to BESIDE, m]
    Writes   mix [j, ACROSS, m], the strain of a body across the surface; mix [j, GROWTH, m], the growth of its volume
    """
    weight = surface_weight(j, i, w.skin)
    total, compliance = 0.0, 0.0
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] == 0.0:
            continue
        if is_free_gas(m, j, i, w):
            w.mix[j, GROWTH, m], body_compliance = gas_growth(w.pm[m, j, i], target, gas_exponent(m, j, i, w))
            w.mix[j, ACROSS, m] = w.mix[j, GROWTH, m]
        else:
            w.mix[j, ACROSS, m], w.mix[j, GROWTH, m], body_compliance = strain_across(
                w.pm[m, j, i], target, w.km[m, j, i], w.mix[j, MODULUS, m], w.mix[j, FLOW, m], w.mix[j, SIZE, m],
                w.mix[j, ALONG, m], w.mix[j, BESIDE, m], weight)
        total += w.vof[m, j, i] * w.mix[j, GROWTH, m]
        compliance += w.vof[m, j, i] * body_compliance
    return total, compliance


@not_inlined
def pressure_for_growth(j, i, room, start, w):
    """Pressure p_c (Pa) at which the bodies of a cell grow by `room`, a share of the cell, by Newton's rule from `start`.

    Writes   as `growth_at`
    """
    target = start
    for _ in range(10):
        total, compliance = growth_at(j, i, target, w)
        if abs(total - room) < 1e-14:
            break
        target += (total - room) / compliance
    return target


@not_inlined
def pressure_with_gas(j, i, room, start, w):
    """`pressure_for_growth` where the growth is no straight line: within bounds that close in, for a room that p_c = 0 exceeds.

    Writes   as `growth_at`
    """
    low, high, target = 0.0, 1e300, max(start, 1e-3 * w.p[j, i])
    for _ in range(60):
        total, compliance = growth_at(j, i, target, w)
        if abs(total - room) < 1e-14:
            break
        if total > room:
            low = target
        else:
            high = target
        target += (total - room) / compliance
        if not low < target < high:
            target = 0.5 * (low + high)
    return target


@not_inlined
def traction_of_change(j, i, change, w):
    """p_c of a cut cell (Pa) at the end of a step in which its volume changes by `change`, a share of the cell.

    Void opens at p_c = 0 and closes before p_c rises; a crack inside a group carries the less tension the wider it is
    (explanation/mixed-cells, equation 12).

    Writes   as `growth_at`
    """
    void = max(1.0 - w.solid[j, i], 0.0)
    borne = w.borne[j, i]
    total, _ = growth_at(j, i, borne, w)
    if total > change + void:
        start = max(w.p[j, i] - w.bulk[j, i] * (change + void), borne)
        if is_beside_gas(j, i, w.gases, w.vof):
            return pressure_with_gas(j, i, change + void, start, w)
        return pressure_for_growth(j, i, change + void, start, w)
    pull = pull_of(j, i, void, w.skin)
    if pull == 0.0 or total >= change or borne > 0.0:
        return borne
    target = pressure_for_growth(j, i, change, min(w.p[j, i] - w.bulk[j, i] * change, 0.0), w)
    target = min(target * pull, 0.0)
    growth_at(j, i, target, w)
    return target


@point
def fill_cut_cell(j, i, change, volume, target, work, w):
    """Volumes, densities and energies of the bodies of a cut cell after the step.

    Each body takes the work of its own normal stress, the mean over the step, on the growth of its volume; a gas that along
    its isentrope, and in a film less (`film_heat`). The rest of the cell's work (pressure and viscosity, J per radian) is
    shared by mass.

    Reads    mix [j, GROWTH, m]; mix [j, NORMAL, m], its normal deviator before the step; mix [j, HEAT, m], the work of its
             deviators, of ties and of the hourglass filter
    Updates  vof [m, j, i] (share of the volume after the step), q (rho, e) [k, m, j, i]
    """
    # Step 1: the work of each body on its own change of volume, and the rest, which all share
    after = volume + change
    mass, left, filled = 0.0, work, 0.0
    for m in range(w.vof.shape[0]):
        f = w.vof[m, j, i]
        if f == 0.0:
            continue
        grown = w.mix[j, GROWTH, m] * f * volume
        filled += f * volume + grown
        mass += w.q[RHO, m, j, i] * f * volume
        done = 0.5 * (w.pm[m, j, i] - w.mix[j, NORMAL, m] + target) * grown
        if is_free_gas(m, j, i, w):
            done = gas_work(w.pm[m, j, i], w.mix[j, GROWTH, m], gas_exponent(m, j, i, w)) * f * volume * film_heat(f)
        w.mix[j, HEAT, m] -= done
        left += done
    # Step 2: the volumes fill the cell; under tension the gap stays void
    squeeze = after / filled if target > w.borne[j, i] else min(1.0, after / filled)
    for m in range(w.vof.shape[0]):
        f = w.vof[m, j, i]
        if f == 0.0:
            continue
        own = w.q[RHO, m, j, i] * f * volume
        space = squeeze * (1.0 + w.mix[j, GROWTH, m]) * f * volume
        w.q[E, m, j, i] += w.mix[j, HEAT, m] / own + left / mass
        w.q[RHO, m, j, i] = own / space
        w.vof[m, j, i] = space / after
