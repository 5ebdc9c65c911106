"""Cells in which bodies meet each other or void: void insertion, closure of pressure and volume, shared strength."""

from eos.dispatch import evaluate, zero_pressure_density
from hydro2d.jit import cell_rows, point, rowwise
from hydro2d.kernels.centroids import push_bodies
from hydro2d.kernels.column_ranges import mixed_row
from hydro2d.kernels.cut_cells import (
    FREE_SURFACE,
    INTERFACE,
    KIND,
    WHOLE,
    common_traction,
    fill_cut_cell,
    firm_density,
    ties,
)
from hydro2d.kernels.mixed_scratch import (
    BEFORE,
    HEAT,
    HOURGLASS,
    MEAN_RR,
    MEAN_RZ,
    MEAN_TT,
    MEAN_ZZ,
    NORMAL,
    RBZ,
    RR,
    SOFT,
    TT,
    ZBR,
    ZZ,
)
from hydro2d.kernels.mixed_strength import (
    MATERIAL,
    return_deviators,
    strain_bodies_across,
    strain_deviators,
    work_of_deviators,
)
from hydro2d.kernels.outer_vertices import heat_of_holding
from hydro2d.kernels.thermodynamics import pressures_row, viscosity_row
from hydro2d.materials.rows import EOS, EOS_AT, FADES, MEMORY, RECORD, TENSILE
from hydro2d.mesh.fields import BY_TENSION, DMG, RHO, E
from hydro2d.mesh.grid import VOL_R
from hydro2d.physics.closure import NO_VOID, own_work, relaxation_bound, relaxation_strain, softness, stiffness
from hydro2d.physics.contents import dominant_body, normal_deviator
from hydro2d.physics.corner import filter_power
from hydro2d.physics.fracture import open_void, share_that_stays, tension_limit
from hydro2d.physics.kinematics import velocity_gradient
from hydro2d.physics.stress import release
from hydro2d.physics.traction import tied_work

#: mixed-cell closure by name
CLOSURES = ("uniform", "tipton")
#: tensile threshold of a mixed cell by name
TENSIONS = ("mean", "min")


@rowwise
def insert_void_mixed_row(j, w):
    """Opens void in mixed cells whose pressure falls below their fracture pressure, and frees them of stress.

    The threshold is the mean of the bodies' by volume fraction, or with smallest_tension the least (explanation/fracture).
    Two groups do not stick together, and separate without this (`traction_of_change`).

    Reads    mixed [j, k], skin [3, j, i]
    Updates  vof, pm [m, j, i]; q (rho, deviators, failure record); p, solid, bulk [j, i]; opened [j]
    """
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        mean, least = 0.0, 1e300
        if w.skin[KIND, j, i] == INTERFACE:
            continue
        for m in range(w.vof.shape[0]):
            f = w.vof[m, j, i]
            if f > 0.0:
                limit = tension_limit(w.materials[m, TENSILE], w.materials[m, FADES], w.q[DMG, m, j, i])
                mean += f * limit
                least = min(least, limit)
        threshold = least * w.solid[j, i] if w.smallest_tension else mean
        if not w.p[j, i] < -threshold:
            continue
        total, pressure = 0.0, 0.0
        for m in range(w.vof.shape[0]):
            f = w.vof[m, j, i]
            if f == 0.0:
                continue
            if w.pm[m, j, i] < 0.0:
                rho = w.q[RHO, m, j, i]
                e = w.q[E, m, j, i]
                model, par = w.models[m, EOS], w.materials[m, EOS_AT:]
                internal = w.q[w.models[m, MEMORY]:, m, j, i]
                share = share_that_stays(rho, zero_pressure_density(model, rho, e, internal, par), w.max_opening)
                w.opened[j] += f * (1.0 - share) * w.metrics[VOL_R, i] * w.dz[j]
                open_void(m, j, i, share, w.vof, w.q)
                w.pm[m, j, i] = evaluate(model, rho / share, e, internal, par)[0]
                if w.models[m, RECORD] > 0 and w.q[DMG, m, j, i] < 1.0:
                    w.q[w.models[m, RECORD], m, j, i] = BY_TENSION
            release(m, j, i, w.q)
            total += w.vof[m, j, i]
            pressure += w.vof[m, j, i] * w.pm[m, j, i]
        w.p[j, i] = pressure
        w.solid[j, i] = total
        if total < 1.0 - NO_VOID:
            w.skin[KIND, j, i] = FREE_SURFACE
        if w.skin[KIND, j, i] != WHOLE:
            w.p[j, i], w.bulk[j, i] = common_traction(j, i, w)


@cell_rows
def close_cells(j, part, w):
    """Equation of state, void where a cell fractures, and artificial viscosity.

    Reads, updates and writes as pressures_row, insert_void_mixed_row, and viscosity_row, and the list of mixed cells; writes
             row_step [j], no limit yet
    Scratch  scratch [s, part, i]
    """
    pressures_row(j, part, w)
    if w.opened[j] > 0.0:
        mixed_row(j, w.active_range, w.scratch[0, part], w)
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        if w.skin[KIND, j, i] == WHOLE and 0.0 < w.solid[j, i] < 1.0 - NO_VOID:  # a pure cell that has fractured
            w.skin[KIND, j, i] = FREE_SURFACE
        if w.skin[KIND, j, i] != WHOLE:
            w.p[j, i], w.bulk[j, i] = common_traction(j, i, w)
    insert_void_mixed_row(j, w)
    viscosity_row(j, w)
    w.row_step[j] = 1e300


@point
def cell_motion(j, i, g, w):
    """Volume times the velocity gradients of group g in cell (j, i), and the work of its hourglass filter.

    Writes   motion [j, g, RR to HOURGLASS]
    """
    a_rr, a_tt, a_zz, a_rbz, a_zbr = velocity_gradient(
        i, w.u0[g, j], w.u0[g, j + 1], w.v0[g, j], w.v0[g, j + 1], w.metrics, w.dz[j])
    rr, tt, zz, rbz, zbr = velocity_gradient(
        i, w.u[g, j], w.u[g, j + 1], w.v[g, j], w.v[g, j + 1], w.metrics, w.dz[j])
    w.motion[j, g, RR] = rr
    w.motion[j, g, TT] = tt
    w.motion[j, g, ZZ] = zz
    w.motion[j, g, RBZ] = rbz
    w.motion[j, g, ZBR] = zbr
    w.motion[j, g, MEAN_RR] = 0.5 * (a_rr + rr)
    w.motion[j, g, MEAN_TT] = 0.5 * (a_tt + tt)
    w.motion[j, g, MEAN_ZZ] = 0.5 * (a_zz + zz)
    w.motion[j, g, MEAN_RZ] = 0.5 * ((a_rbz + rbz) + (a_zbr + zbr))
    w.motion[j, g, HOURGLASS] = 0.5 * w.dt * filter_power(
        i, w.filter_r[g, j, i], w.filter_z[g, j, i],
        w.u0[g, j], w.u0[g, j + 1], w.v0[g, j], w.v0[g, j + 1], w.u[g, j], w.u[g, j + 1], w.v[g, j], w.v[g, j + 1])


@point
def heat_of_ties(j, i, g, w):
    """Gives the energy that the ties in a cell with a gas take from the motion to its other bodies, by mass (`ties`).

    Updates  mix [j, HEAT, m]
    """
    by_r, by_z = ties(j, i, w)
    if by_r + by_z == 0.0:
        return
    work = tied_work(i, by_r, by_z, w.u0[g, j], w.u0[g, j + 1], w.u[g, j], w.u[g, j + 1]) + tied_work(
        i, by_r, by_z, w.v0[g, j], w.v0[g, j + 1], w.v[g, j], w.v[g, j + 1])
    mass = firm_density(j, i, w)
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0 and not w.gases[m]:
            w.mix[j, HEAT, m] += work * w.q[RHO, m, j, i] * w.vof[m, j, i] / mass


@point
def mean_pressure(j, i, w):
    """Pressure of a cell, the mean of its bodies' by volume (explanation/mixed-cells, equation 7), before the step, Pa."""
    pressure = 0.0
    for m in range(w.vof.shape[0]):
        pressure += w.vof[m, j, i] * w.pm[m, j, i] if w.vof[m, j, i] > 0.0 else 0.0
    return pressure


@point
def soften(j, i, pressure, w):
    """(1 over the sum of the bodies' shares in a change of volume, the pressure to which they relax) (explanation/mixed-cells,
    equation 2).

    pressure : of the cell, Pa

    Writes   mix [j, SOFT, m], a body's share, not yet over their sum
    """
    compliance, target = 0.0, 0.0
    for m in range(w.vof.shape[0]):
        w.mix[j, SOFT, m] = softness(w.vof[m, j, i], stiffness(w.km[m, j, i], pressure), w.tipton)
        compliance += w.mix[j, SOFT, m]
        target += w.mix[j, SOFT, m] * w.pm[m, j, i]
    inverse = 1.0 / compliance
    return inverse, target * inverse


@point
def heat_of_filter(j, i, w):
    """Gives each group's bodies, by mass, the work of the hourglass filter on the motion of that group.

    The filter acts on a group by the group's share of the mass of the cell (`group_force`).

    Updates  mix [j, HEAT, m], J per radian
    """
    mass = 0.0
    for m in range(w.vof.shape[0]):
        mass += w.vof[m, j, i] * w.q[RHO, m, j, i] if w.vof[m, j, i] > 0.0 else 0.0
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0:
            w.mix[j, HEAT, m] += w.vof[m, j, i] * w.q[RHO, m, j, i] / mass * w.motion[j, w.group[m], HOURGLASS]


@point
def fill_cell(j, i, change, volume, work, w):
    """Volumes, densities and energies after the step in a cell that fluids of one group fill: changes by compressibility, then
    relaxation of the pressures.

    Each body takes the work of its own pressure on its own change of volume, and the rest of the cell's work (`work`, of
    pressure and viscosity) is shared by mass (explanation/mixed-cells, equation 6).

    Reads    mix [j, HEAT, m]
    Updates  vof [m, j, i] (share of the volume after the step), q (rho, e) [k, m, j, i]
    """
    # Step 1: the shares in the change of volume, and the pressure to which all relax
    pressure = mean_pressure(j, i, w)
    inverse, target = soften(j, i, pressure, w)
    relaxation = w.relaxation if w.tipton else 0.0
    bound = 1.0
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0:
            modulus = stiffness(w.km[m, j, i], pressure)
            bound = min(bound, relaxation_bound(relaxation_strain(relaxation, w.pm[m, j, i], target, modulus)))
    # Step 2: volumes, and the work of each body on its own
    after = volume + change
    mass, left = 0.0, work
    for m in range(w.vof.shape[0]):
        f = w.vof[m, j, i]
        if f == 0.0:
            continue
        modulus = stiffness(w.km[m, j, i], pressure)
        shared = w.mix[j, SOFT, m] * inverse * change / (f * volume)
        relaxed = relaxation_strain(bound * relaxation, w.pm[m, j, i], target, modulus)
        strain = max(shared + relaxed, -0.5)
        own_mass = w.q[RHO, m, j, i] * f * volume
        done = own_work(w.pm[m, j, i], w.km[m, j, i], strain) * f * volume
        mass += own_mass
        left += done
        w.mix[j, HEAT, m] -= done
        filled = (1.0 + strain) * f * volume
        w.q[RHO, m, j, i] = own_mass / filled if strain != 0.0 else w.q[RHO, m, j, i]
        w.vof[m, j, i] = filled / after if strain != 0.0 or change != 0.0 else f
    # Step 3: energies; the mass of a body has not changed
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0:
            own_mass = w.q[RHO, m, j, i] * w.vof[m, j, i] * after
            w.q[E, m, j, i] += w.mix[j, HEAT, m] / own_mass + left / mass


@cell_rows
def deform_mixed(j, w):
    """The Lagrangian step of the bodies in mixed cells.

    Fluids that fill a cell together share its change of volume by compressibility, w_m = R_m/Rbar with R_m = f_m/K_m. Their
    pressures then relax, df_m = gamma R_m (p_m - pbar), with pbar = sum R_m p_m/Rbar. Each body takes the work of its own
    pressure; the rest of the work of pressure, viscosity and the hourglass filter is shared by mass, and deviatoric work goes
    to the body whose stress did it (`fill_cell`, explanation/mixed-cells). All bodies are treated so with `uniform`, and in the
    hard zone of a slip layer. Cut cells follow from the traction: `strain_bodies_across`, `fill_cut_cell`.
    Strength is by strength_mode, see STRENGTH_MODES; every body moves with its group. In contact-interface cells pressure and
    viscosity do the work of the common change of volume, and each body has its own strength where two groups meet.

    Reads    velocities, swept volumes, stresses as `deform`; ph, qr, qz, qt, qrz, solid [j, i]; contact_columns [j, 2];
             cell_mass [b, j, i]; group, hard_bodies, gases [m]
    Updates  vof [m, j, i] (share of the volume after the step), q [k, m, j, i], centroid [2, m, j, i]
    Scratch  mix [j, 17, m] (rows SOFT to SHIFT_Z), motion [j, b, 10], internal [j, k]
    """
    groups = w.cell_mass.shape[0]
    for k in range(w.mixed_count[j]):
        i = w.mixed[j, k]
        volume = w.metrics[VOL_R, i] * w.dz[j]
        change = (w.fr[j, i + 1] - w.fr[j, i]) + (w.fz[j + 1, i] - w.fz[j, i])
        work_q, work_p, groups_present = 0.0, 0.0, 0
        for g in range(groups):
            if w.cell_mass[g, j, i] > 0.0:
                groups_present += 1
                cell_motion(j, i, g, w)
                across = w.motion[j, g, MEAN_RR] + w.motion[j, g, MEAN_TT]
                work_q = -w.dt * ((w.qr[j, i] * across + w.qz[j, i] * w.motion[j, g, MEAN_ZZ])
                                + ((w.qt[j, i] - w.qr[j, i]) * w.motion[j, g, MEAN_TT] + w.qrz[j, i] * w.motion[j, g, MEAN_RZ]))
                work_p = -w.ph[j, i] * w.dt * (across + w.motion[j, g, MEAN_ZZ])
        if groups > 1 and w.contact_columns[j, 0] <= i < w.contact_columns[j, 1]:
            work_q = -w.qr[j, i] * change
            work_p = -w.ph[j, i] * change
        meet = groups_present > 1
        dominant = dominant_body(j, i, w.hard_bodies, w.threshold, w.vof)
        for m in range(w.vof.shape[0]):
            w.mix[j, BEFORE, m] = w.vof[m, j, i]
            w.mix[j, NORMAL, m] = normal_deviator(m, j, i, w.skin, w.q) if w.vof[m, j, i] > 0.0 else 0.0
        cut, own = w.skin[KIND, j, i] != WHOLE, w.strength_mode == MATERIAL or dominant >= 0 or meet
        target = 0.0
        work_of_deviators(j, i, dominant, w)
        for g in range(groups):
            if w.cell_mass[g, j, i] > 0.0:
                heat_of_ties(j, i, g, w)
        heat_of_holding(j, i, w)
        heat_of_filter(j, i, w)
        cell_yield = strain_deviators(j, i, w.dt / volume, w)
        if cut:
            target = strain_bodies_across(j, i, own, cell_yield, change / volume, w)
        return_deviators(j, i, own, cell_yield, dominant, w)
        if cut:
            fill_cut_cell(j, i, change, volume, target, work_p + work_q, w)
        else:
            fill_cell(j, i, change, volume, work_p + work_q, w)
        push_bodies(j, i, w)
