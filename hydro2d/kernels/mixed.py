"""Cells in which bodies meet each other or void: void insertion, closure of pressure and volume, shared strength."""

from eos.dispatch import evaluate, zero_pressure_density
from hydro2d.jit import kernel, point, rowwise
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
    firm_share,
    is_beside_gas,
    normal_deviator,
    tied_work,
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
    SOLID,
    dominant_body,
    return_deviators,
    strain_bodies_across,
    strain_deviators,
    work_of_deviators,
)
from hydro2d.kernels.thermodynamics import compression_viscosity_row, pressures_row, steps_row, viscosity_row
from hydro2d.materials.rows import EOS, EOS_AT, FADES, MEMORY, TENSILE
from hydro2d.mesh.fields import DMG, RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import VOL_R
from hydro2d.physics.closure import NO_VOID, relaxation_bound, relaxation_strain, softness
from hydro2d.physics.fracture import share_that_stays, tension_limit
from hydro2d.physics.kinematics import hourglass_mode, velocity_gradient
from hydro2d.physics.stress import stress_scale

#: mixed-cell closure by name
CLOSURES = ("uniform", "tipton")
#: tensile threshold of a mixed cell by name
TENSIONS = ("mean", "min")


@rowwise
def insert_void_mixed_row(j, smallest, max_opening, metrics, dz, mixed_count, mixed, models, materials, skin, vof, q, pm, km, p,
                          solid, bulk, opened):
    """Opens void in mixed cells whose pressure falls below their fracture pressure, and frees them of stress.

    The threshold is the mean of the bodies' by volume fraction, or the smallest (explanation/fracture). Two groups hold
    together by nothing and part by themselves (`meet_traction`).

    Reads    mixed [j, k], skin [3, j, i]
    Updates  vof, pm [m, j, i]; q (rho, deviators); p, solid, bulk [j, i]; opened [j]
    """
    bodies = vof.shape[0]
    for k in range(mixed_count[j]):
        i = mixed[j, k]
        mean, least = 0.0, 1e300
        if skin[KIND, j, i] == INTERFACE:
            continue
        for m in range(bodies):
            f = vof[m, j, i]
            if f > 0.0:
                limit = tension_limit(materials[m, TENSILE], materials[m, FADES], q[DMG, m, j, i])
                mean += f * limit
                least = min(least, limit)
        threshold = least * solid[j, i] if smallest else mean
        if not p[j, i] < -threshold:
            continue
        total, pressure = 0.0, 0.0
        for m in range(bodies):
            f = vof[m, j, i]
            if f == 0.0:
                continue
            if pm[m, j, i] < 0.0:
                rho = q[RHO, m, j, i]
                e = q[E, m, j, i]
                model, par = models[m, EOS], materials[m, EOS_AT:]
                internal = q[models[m, MEMORY]:, m, j, i]
                share = share_that_stays(rho, zero_pressure_density(model, rho, e, internal, par), max_opening)
                opened[j] += f * (1.0 - share) * metrics[VOL_R, i] * dz[j]
                f *= share
                vof[m, j, i] = f
                q[RHO, m, j, i] = rho / share
                pm[m, j, i] = evaluate(model, rho / share, e, internal, par)[0]
            q[SRR, m, j, i] = 0.0
            q[SZZ, m, j, i] = 0.0
            q[SRZ, m, j, i] = 0.0
            total += f
            pressure += f * pm[m, j, i]
        p[j, i] = pressure
        solid[j, i] = total
        if total < 1.0 - NO_VOID:
            skin[KIND, j, i] = FREE_SURFACE
        if skin[KIND, j, i] != WHOLE:
            p[j, i], bulk[j, i] = common_traction(j, i, skin, vof, q, pm, km)


@kernel
def close_cells(part, parts, max_opening, smallest_tension, along_compression, viscosity_linear, viscosity_quadratic, courant,
                advective_courant, mesh_speed, hourglass, metrics, dr, dz, body_range, active_range, mixed_count, mixed, models,
                materials, u, v, vof, q, pm, km, tm, skin, p, bulk, rhobar, solid, cl, qr, qz, qt, qrz, hg_coefficient, opened,
                row_step, bad, scratch):
    """Equation of state, void where a cell fractures, artificial viscosity and the time step that every cell allows.

    The viscosity takes the directions of the mesh, or along_compression that of the strongest compression.

    Reads, updates and writes what pressures_row, insert_void_mixed_row, viscosity_row or compression_viscosity_row, and
             steps_row do, and the list of mixed cells
    Scratch  scratch [s, part, i]
    """
    for j in range(parts[part], parts[part + 1]):
        pressures_row(j, part, max_opening, metrics, dz, body_range, active_range, models, materials, vof, q, pm, km, tm, p,
                      bulk, rhobar, solid, cl, scratch, opened, bad)
        if opened[j] > 0.0:
            mixed_row(j, active_range, vof, scratch[0], part, mixed_count, mixed)
        for k in range(mixed_count[j]):
            i = mixed[j, k]
            if skin[KIND, j, i] == WHOLE and 0.0 < solid[j, i] < 1.0 - NO_VOID:  # a pure cell that has fractured
                skin[KIND, j, i] = FREE_SURFACE
            if skin[KIND, j, i] != WHOLE:
                p[j, i], bulk[j, i] = common_traction(j, i, skin, vof, q, pm, km)
        insert_void_mixed_row(j, smallest_tension, max_opening, metrics, dz, mixed_count, mixed, models, materials, skin,
                              vof, q, pm, km, p, solid, bulk, opened)
        if along_compression:
            compression_viscosity_row(j, viscosity_linear, viscosity_quadratic, dr, dz, metrics, active_range, u, v, rhobar,
                                      bulk, solid, cl, qr, qz, qt, qrz)
        else:
            viscosity_row(j, viscosity_linear, viscosity_quadratic, dr, dz, metrics, active_range, u, v, rhobar, bulk, solid,
                          cl, qr, qz, qt)
        steps_row(j, part, courant, advective_courant, mesh_speed, hourglass, dr, dz, metrics, active_range, u, v, rhobar, cl,
                  qr, qz, hg_coefficient, row_step, bad, scratch)


@point
def cell_motion(j, i, g, dt, h, metrics, hg_coefficient, u0, v0, u, v, motion):
    """Volume times the velocity gradients of group g in cell (j, i), and the work of its hourglass filter.

    Writes   motion [j, g, RR to HOURGLASS]
    """
    a_rr, a_tt, a_zz, a_rbz, a_zbr = velocity_gradient(
        i, u0[g, j], u0[g, j + 1], v0[g, j], v0[g, j + 1], metrics, h)
    rr, tt, zz, rbz, zbr = velocity_gradient(
        i, u[g, j], u[g, j + 1], v[g, j], v[g, j + 1], metrics, h)
    h_u0, h_v0 = hourglass_mode(i, u0[g, j], u0[g, j + 1]), hourglass_mode(i, v0[g, j], v0[g, j + 1])
    h_u, h_v = hourglass_mode(i, u[g, j], u[g, j + 1]), hourglass_mode(i, v[g, j], v[g, j + 1])
    motion[j, g, RR] = rr
    motion[j, g, TT] = tt
    motion[j, g, ZZ] = zz
    motion[j, g, RBZ] = rbz
    motion[j, g, ZBR] = zbr
    motion[j, g, MEAN_RR] = 0.5 * (a_rr + rr)
    motion[j, g, MEAN_TT] = 0.5 * (a_tt + tt)
    motion[j, g, MEAN_ZZ] = 0.5 * (a_zz + zz)
    motion[j, g, MEAN_RZ] = 0.5 * ((a_rbz + rbz) + (a_zbr + zbr))
    motion[j, g, HOURGLASS] = 0.5 * dt * hg_coefficient[j, i] * (h_u0 * (h_u0 + h_u) + h_v0 * (h_v0 + h_v))


@point
def heat_of_ties(j, i, g, h, metrics, gases, skin, vof, q, u0, v0, u, v, mix):
    """Gives what the ties of a cell beside a gas take of the motion to its bodies that are none, by mass (`ties`).

    Updates  mix [j, HEAT, m]
    """
    by_r, by_z = ties(j, i, metrics, h, skin, gases, vof, q)
    if by_r + by_z == 0.0:
        return
    work = tied_work(i, by_r, by_z, u0[g, j], u0[g, j + 1], u[g, j], u[g, j + 1]) + tied_work(
        i, by_r, by_z, v0[g, j], v0[g, j + 1], v[g, j], v[g, j + 1])
    mass = firm_density(j, i, gases, vof, q)
    for m in range(vof.shape[0]):
        if vof[m, j, i] > 0.0 and not gases[m]:
            mix[j, HEAT, m] += work * q[RHO, m, j, i] * vof[m, j, i] / mass


@point
def soften(j, i, tipton, vof, pm, km, mix):
    """(1 over the sum of the bodies' shares in a change of volume, their mean pressure) (explanation/mixed-cells, equation 2).

    Writes   mix [j, SOFT, m], a body's share, not yet over their sum
    """
    compliance, mean_p = 0.0, 0.0
    for m in range(vof.shape[0]):
        mix[j, SOFT, m] = softness(vof[m, j, i], km[m, j, i], tipton)
        compliance += mix[j, SOFT, m]
        mean_p += mix[j, SOFT, m] * pm[m, j, i]
    inverse = 1.0 / compliance
    return inverse, mean_p * inverse


@point
def filter_work(j, i, motion, cell_mass):
    """Work of the hourglass filter on a cell, by the groups' shares of its mass."""
    work, mass = 0.0, 0.0
    for g in range(cell_mass.shape[0]):
        if cell_mass[g, j, i] > 0.0:
            mass += cell_mass[g, j, i]
            work += cell_mass[g, j, i] * motion[j, g, HOURGLASS]
    return work / mass


@point
def pressure_rise(j, i, middle, vof, pm):
    """What the pressure of a cell rises by until the middle of the step, in which it is `middle`."""
    before = 0.0
    for m in range(vof.shape[0]):
        before += vof[m, j, i] * pm[m, j, i] if vof[m, j, i] > 0.0 else 0.0
    return middle - before


@point
def work_beside_gas(j, i, volume, change, inverse, work, rise, target, relaxed, pm, km, vof, q, mix):
    """Work in a cell that a gas shares with stiffer bodies: each body's own pressure on its own change of volume, the remainder
    by mass (explanation/mixed-cells, equation 6).

    change is that of the volume, work that of pressure, viscosity and hourglass filter on the cell, rise what its pressure
    rises by to the middle of the step, and relaxed the share of its excess of pressure over the target that a body loses.

    Reads    mix [j, SOFT, m]
    Updates  mix [j, HEAT, m], which then has all of the work on a body
    """
    bodies = vof.shape[0]
    mass, left = 0.0, work
    for m in range(bodies):
        f = vof[m, j, i]
        if f > 0.0:
            mass += q[RHO, m, j, i] * f * volume
            own = (pm[m, j, i] + rise) * mix[j, SOFT, m] * inverse * change
            excess = pm[m, j, i] - target
            own += (pm[m, j, i] - 0.5 * relaxed * excess) * relaxed * f * volume * excess / km[m, j, i]
            mix[j, HEAT, m] -= own
            left += own
    for m in range(bodies):
        if vof[m, j, i] > 0.0:
            mix[j, HEAT, m] += q[RHO, m, j, i] * vof[m, j, i] * volume / mass * left


@point
def fill_cell(j, i, change, volume, total, inverse, mean_p, work_p, work_q, middle, relaxation, tipton, group, motion,
              cell_mass, gases, pm, km, vof, q, mix):
    """Volumes, densities and energies after the step in a cell that bodies of one group fill: by compressibility, then
    relaxation of the pressures.

    middle is the pressure of the cell in the middle of the step, Pa.

    Reads    mix [j, SOFT, m], mix [j, HEAT, m]
    Updates  vof [m, j, i] (share of the volume after the step), q (rho, e) [k, m, j, i]
    """
    bodies = vof.shape[0]
    bound = 1.0
    for m in range(bodies):
        if vof[m, j, i] > 0.0 and tipton:
            bound = min(bound, relaxation_bound(relaxation_strain(relaxation, pm[m, j, i], mean_p, km[m, j, i])))
    gas = is_beside_gas(j, i, gases, vof)
    if gas:
        work = work_p + work_q + filter_work(j, i, motion, cell_mass)
        relaxed = bound * relaxation if tipton else 0.0
        rise = pressure_rise(j, i, middle, vof, pm)
        work_beside_gas(j, i, volume, change, inverse, work, rise, mean_p, relaxed, pm, km, vof, q, mix)
    after = volume + change
    for m in range(bodies):
        f = vof[m, j, i]
        if f == 0.0:
            continue
        mass = q[RHO, m, j, i] * f * volume
        shift = bound * f * relaxation * (pm[m, j, i] - mean_p) / km[m, j, i] * volume if tipton else 0.0
        filled = f * volume + mix[j, SOFT, m] * inverse * change + shift
        filled = max(filled, 0.5 * f * volume)
        q[RHO, m, j, i] = mass / filled if filled != f * volume else q[RHO, m, j, i]
        vof[m, j, i] = filled / after if filled != f * volume or change != 0.0 else f
        if gas:
            q[E, m, j, i] += mix[j, HEAT, m] / mass
            continue
        rubbed = f / total * (work_q + motion[j, group[m], HOURGLASS])
        gained = mix[j, SOFT, m] * inverse * work_p + rubbed + mix[j, HEAT, m]
        q[E, m, j, i] += (gained - mean_p * shift) / mass


@kernel
def deform_mixed(part, parts, dt, relaxation, tipton, strength_mode, hard_bodies, hard_threshold, metrics, dz, mixed_count,
                 mixed, group, contact_columns, cell_mass, models, materials, gases, u0, v0, u, v, fr, fz, ph, qr, qz, qt, qrz,
                 hg_coefficient, skin, p, bulk, solid, pm, km, tm, vof, q, mix, motion, internal, centroid):
    """The Lagrangian step of the bodies in mixed cells.

    Where fluids fill a cell together, by compressibility: w_m = R_m/Rbar with R_m = f_m/K_m, then relaxation of the
    pressures, df_m = gamma R_m (p_m - pbar), with pbar = sum R_m p_m/Rbar; pressure work by w_m, viscous and hourglass work by
    volume fraction, deviatoric work by what each body's stress did; beside a gas as work_beside_gas has it (explanation/
    mixed-cells). So do all bodies with `uniform`, and in the hard zone of a slip layer. In cut cells by the traction:
    `strain_bodies_across`, `fill_cut_cell`.
    Strength: by strength_mode, see STRENGTH_MODES; every body moves with its group. In contact-interface cells pressure and
    viscosity do the work of the one change of volume, and each body has its own strength where two groups meet.

    Reads    velocities, swept volumes, stresses as `deform`; ph, qr, qz, qt, qrz, solid [j, i]; contact_columns [j, 2];
             cell_mass [b, j, i]; group, hard_bodies, gases [m]
    Updates  vof [m, j, i] (share of the volume after the step), q [k, m, j, i], centroid [2, m, j, i]
    Scratch  mix [j, 17, m] (rows SOFT to SHIFT_Z), motion [j, b, 10], internal [j, k]
    """
    groups = cell_mass.shape[0]
    for j in range(parts[part], parts[part + 1]):
        for k in range(mixed_count[j]):
            i = mixed[j, k]
            volume = metrics[VOL_R, i] * dz[j]
            change = (fr[j, i + 1] - fr[j, i]) + (fz[j + 1, i] - fz[j, i])
            work_q, work_p, held = 0.0, 0.0, 0
            for g in range(groups):
                if cell_mass[g, j, i] > 0.0:
                    held += 1
                    cell_motion(j, i, g, dt, dz[j], metrics, hg_coefficient, u0, v0, u, v, motion)
                    across = motion[j, g, MEAN_RR] + motion[j, g, MEAN_TT]
                    work_q = -dt * ((qr[j, i] * across + qz[j, i] * motion[j, g, MEAN_ZZ])
                                    + ((qt[j, i] - qr[j, i]) * motion[j, g, MEAN_TT] + qrz[j, i] * motion[j, g, MEAN_RZ]))
                    work_p = -ph[j, i] * dt * (across + motion[j, g, MEAN_ZZ])
            if groups > 1 and contact_columns[j, 0] <= i < contact_columns[j, 1]:
                work_q = -qr[j, i] * change
                work_p = -ph[j, i] * change
            total, meet = solid[j, i], held > 1
            dominant = dominant_body(j, i, hard_bodies, hard_threshold, vof)
            for m in range(vof.shape[0]):
                mix[j, BEFORE, m] = vof[m, j, i]
                mix[j, NORMAL, m] = normal_deviator(m, j, i, skin, q) if vof[m, j, i] > 0.0 else 0.0
            cut, own = skin[KIND, j, i] != WHOLE, strength_mode == MATERIAL or dominant >= 0 or meet
            target = 0.0
            work_of_deviators(j, i, dt, dominant, total, stress_scale(strength_mode == SOLID, total), group, motion, vof, q,
                              mix)
            for g in range(groups):
                if cell_mass[g, j, i] > 0.0:
                    heat_of_ties(j, i, g, dz[j], metrics, gases, skin, vof, q, u0, v0, u, v, mix)
            firm = firm_share(j, i, total, gases, vof)
            cell_yield = strain_deviators(j, i, dt / volume, strength_mode, firm, skin, group, models, materials, pm, tm,
                                          motion, vof, q, mix, internal)
            if cut:
                target = strain_bodies_across(j, i, own, cell_yield, change / volume, max(1.0 - total, 0.0), skin, p, bulk,
                                              models, vof, pm, km, q, mix)
            return_deviators(j, i, dt, own, cell_yield, dominant, volume, total, models, materials, pm, tm, vof, q, mix,
                             internal)
            if cut:
                fill_cut_cell(j, i, change, volume, target, work_p + work_q + filter_work(j, i, motion, cell_mass), vof,
                              pm, q, mix)
            else:
                inverse, mean_p = soften(j, i, tipton, vof, pm, km, mix)
                fill_cell(j, i, change, volume, total, inverse, mean_p, work_p, work_q, ph[j, i], relaxation, tipton, group,
                          motion, cell_mass, gases, pm, km, vof, q, mix)
            push_bodies(j, i, vof, centroid, mix)
