"""Cells in which bodies meet each other or void: void insertion, closure of pressure and volume, shared strength."""

from eos.dispatch import evaluate, zero_pressure_density
from hydro2d.jit import kernel, point, prange, rowwise
from hydro2d.kernels.column_ranges import block_rows, mixed_row, number_of_blocks, spread
from hydro2d.kernels.cut_cells import (
    ACROSS,
    ALONG,
    BESIDE,
    BONDED,
    FLOW,
    FREE_SURFACE,
    HEAT,
    INTERFACE,
    KIND,
    MODULUS,
    NORMAL,
    NORMAL_R,
    NORMAL_Z,
    SIZE,
    SOFT,
    TRIAL_RR,
    TRIAL_RZ,
    TRIAL_ZZ,
    YIELD,
    common_traction,
    fill_cut_cell,
    meet_traction,
    normal_deviator,
    surface_weight,
)
from hydro2d.kernels.thermodynamics import pressures_row, viscosity_row
from hydro2d.materials.rows import CUTOFF_DENSITY, DAMAGE, DAMAGE_AT, EOS, EOS_AT, FACTOR, GAS, STRENGTH, STRENGTH_AT, TENSILE
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import VOL_R
from hydro2d.physics.closure import NO_VOID, relaxation_bound, relaxation_strain, softness, split_volume
from hydro2d.physics.fracture import damaged, share_that_stays, tension_limit
from hydro2d.physics.kinematics import hourglass_mode, velocity_gradient
from hydro2d.physics.plasticity import carries_no_stress, deviator_power, from_centre, keep_internal, returned, take_internal
from hydro2d.physics.stress import stress_scale, turn_and_strain, von_mises
from hydro2d.physics.traction import along_normal
from strength.dispatch import damage_increment, flow_stress, kinematic_modulus, shear_modulus, turn
from strength.radial_return import plastic_increment

#: mixed-cell strength by name, in the order of the integer that the kernels take
STRENGTH_MODES = ("volume", "solid", "zero", "max", "material")
VOLUME, SOLID, ZERO, MAX, MATERIAL = range(5)
#: mixed-cell closure by name
CLOSURES = ("uniform", "tipton")
#: tensile threshold of a mixed cell by name
TENSIONS = ("mean", "min")


#: columns of the scratch `motion`: volume times the velocity gradient at the end of the step (du_r/dz, du_z/dr apart) and at
#: its middle, and the work of the hourglass filter
RR, TT, ZZ, RBZ, ZBR, MEAN_RR, MEAN_TT, MEAN_ZZ, MEAN_RZ, HOURGLASS = range(10)


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
                limit = tension_limit(materials[m, TENSILE], q[DMG, m, j, i])
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
                model, par = models[m, EOS], materials[m, EOS_AT:STRENGTH_AT]
                share = share_that_stays(rho, zero_pressure_density(model, rho, e, par), max_opening)
                opened[j] += f * (1.0 - share) * metrics[VOL_R, i] * dz[j]
                f *= share
                vof[m, j, i] = f
                q[RHO, m, j, i] = rho / share
                pm[m, j, i] = evaluate(model, rho / share, e, par)[0]
            q[SRR, m, j, i] = 0.0
            q[SZZ, m, j, i] = 0.0
            q[SRZ, m, j, i] = 0.0
            total += f
            pressure += f * pm[m, j, i]
        p[j, i] = pressure
        solid[j, i] = total
        if total < 1.0 - NO_VOID and skin[KIND, j, i] == BONDED:
            skin[KIND, j, i] = FREE_SURFACE
        if skin[KIND, j, i] == FREE_SURFACE:
            p[j, i], bulk[j, i] = common_traction(j, i, skin, vof, q, pm, km)


@kernel
def close_cells(j0, j1, max_opening, smallest_tension, linear, quadratic, courant, advective, mesh_speed, hourglass, metrics,
                dr, dz, body_range, active_range, mixed_count, mixed, models, materials, u, v, vof, q, pm, km, tm, skin, p,
                bulk, rhobar, solid, cl, qr, qz, hg_coefficient, opened, row_step, bad, scratch):
    """Equation of state, void where a cell fractures, artificial viscosity and the time step that every cell allows.

    Reads, updates and writes what pressures_row, insert_void_mixed_row and viscosity_row do, and the list of mixed cells
    Scratch  scratch [s, block, i]
    """
    blocks = number_of_blocks(j0, j1)
    for place in prange(blocks):
        b = spread(place, blocks)
        first_row, last_row = block_rows(b, blocks, j0, j1)
        for j in range(first_row, last_row):
            pressures_row(j, b, max_opening, metrics, dz, body_range, active_range, models, materials, vof, q, pm, km, tm, p,
                          bulk, rhobar, solid, cl, scratch, opened, bad)
            if opened[j] > 0.0:
                mixed_row(j, active_range, vof, scratch[0], b, mixed_count, mixed)
            for k in range(mixed_count[j]):
                i = mixed[j, k]
                if skin[KIND, j, i] == BONDED and 0.0 < solid[j, i] < 1.0 - NO_VOID:  # a pure cell that has fractured
                    skin[KIND, j, i] = FREE_SURFACE
                if skin[KIND, j, i] != BONDED:
                    p[j, i], bulk[j, i] = common_traction(j, i, skin, vof, q, pm, km)
            insert_void_mixed_row(j, smallest_tension, max_opening, metrics, dz, mixed_count, mixed, models, materials, skin,
                                  vof, q, pm, km, p, solid, bulk, opened)
            viscosity_row(j, b, linear, quadratic, courant, advective, mesh_speed, hourglass, dr, dz, metrics, active_range, u,
                          v, rhobar, bulk, solid, cl, qr, qz, hg_coefficient, row_step, bad, scratch)


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
def dominant_body(j, i, hard, hard_threshold, vof):
    """The body whose strength dominates in a cell of the hard zone, -1 outside of it."""
    dominant = -1
    for m in range(vof.shape[0]):
        if hard[m] and vof[m, j, i] >= hard_threshold:
            dominant = m
    return dominant


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
def work_of_deviators(j, i, dt, dominant, total, scale, group, motion, vof, q, mix):
    """What the deviators of every body do in the step: its own, or in the hard zone the dominant body's alone.

    In a cut cell the part across the surface is none of theirs: mix [j, NORMAL, m].

    Writes   mix [j, HEAT, m], J per radian
    """
    for m in range(vof.shape[0]):
        f = vof[m, j, i]
        mix[j, HEAT, m] = 0.0
        if f == 0.0:
            continue
        part = total if m == dominant else 0.0
        if dominant < 0:
            part = f * scale
        g = group[m]
        power = deviator_power(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i], motion[j, g, MEAN_RR],
                               motion[j, g, MEAN_ZZ], motion[j, g, MEAN_TT], motion[j, g, MEAN_RZ])
        power -= mix[j, NORMAL, m] * (motion[j, g, MEAN_RR] + motion[j, g, MEAN_ZZ] + motion[j, g, MEAN_TT])
        mix[j, HEAT, m] = part * dt * power


@point
def strain_deviators(j, i, rate, mode, total, skin, group, models, materials, pm, tm, motion, vof, q, mix, internal):
    """Elastic trial of every body; returns the yield stress of the cell by mode (explanation/mixed-cells, equation 8).

    rate is the time step over the volume of the cell. Internal variables that are tensors turn with the material. In a cut cell
    the strain across the surface is left out, by the weight of that: `meet_traction` finds it, `strain_across` adds it.

    Updates  q (internal variables) [k, m, j, i]; scratch internal [j, k]
    Writes   mix [j, TRIAL_RR to TRIAL_RZ, m], deviators; mix [j, MODULUS, m], mix [j, YIELD, m], 0 without strength, all in Pa
    """
    cell_yield, largest_yield = 0.0, 0.0
    n_r, n_z, weight = skin[NORMAL_R, j, i], skin[NORMAL_Z, j, i], surface_weight(j, i, skin)
    inverse = 1.0 / weight if weight > 0.0 else 0.0
    for m in range(vof.shape[0]):
        f = vof[m, j, i]
        mix[j, YIELD, m] = 0.0
        mix[j, MODULUS, m] = 0.0
        mix[j, SIZE, m] = 0.0
        mix[j, ALONG, m] = 0.0
        mix[j, BESIDE, m] = 0.0
        if f == 0.0 or models[m, STRENGTH] == 0:
            continue
        g, model, par, rho = group[m], models[m, STRENGTH], materials[m, STRENGTH_AT:DAMAGE_AT], q[RHO, m, j, i]
        modulus = shear_modulus(model, pm[m, j, i], rho, tm[m, j, i], par)
        strain_r, strain_z, strain_t = motion[j, g, RR] * rate, motion[j, g, ZZ] * rate, motion[j, g, TT] * rate
        strain_s = 0.5 * (motion[j, g, RBZ] + motion[j, g, ZBR]) * rate
        spin = 0.5 * (motion[j, g, RBZ] - motion[j, g, ZBR]) * rate
        across = along_normal(n_r, n_z, strain_r, strain_z, strain_s) * inverse
        strain_r -= across * n_r * n_r
        strain_z -= across * n_z * n_z
        strain_s -= across * n_r * n_z
        mix[j, BESIDE, m] = strain_r + strain_z + strain_t
        rr, zz, rz = turn_and_strain(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i], spin, 2.0 * modulus, strain_r,
                                     strain_z, strain_t, strain_s)
        take_internal(m, j, i, model, q, internal[j])
        turn(model, spin, internal[j])
        keep_internal(m, j, i, model, internal[j], q)
        mix[j, TRIAL_RR, m] = rr
        mix[j, TRIAL_ZZ, m] = zz
        mix[j, TRIAL_RZ, m] = rz
        mix[j, MODULUS, m] = modulus
        mix[j, SIZE, m] = 2.0 * (rr * rr + zz * zz + rr * zz + rz * rz)
        mix[j, ALONG, m] = along_normal(n_r, n_z, rr, zz, rz) * inverse
        if not carries_no_stress(q[DMG, m, j, i], rho, materials[m, CUTOFF_DENSITY]):
            flow = flow_stress(model, q[EP, m, j, i], 0.0, tm[m, j, i], pm[m, j, i], rho, par)
            mix[j, YIELD, m] = materials[m, FACTOR] * flow
        cell_yield += f * mix[j, YIELD, m]
        largest_yield = max(largest_yield, mix[j, YIELD, m])
    if mode == ZERO:
        return 0.0
    return largest_yield if mode == MAX else cell_yield / total


@point
def strain_bodies_across(j, i, own, cell_yield, change, void, skin, p, bulk, models, vof, pm, km, q, mix):
    """Strains the bodies of a cut cell across its surface; returns p_c at the end of the step, Pa (`meet_traction`).

    A body that flows does so at the stress that it has, which may be above its yield stress by its rate.

    Updates  mix [j, TRIAL_RR to TRIAL_RZ, m]
    """
    for m in range(vof.shape[0]):
        flow = mix[j, YIELD, m] if own else cell_yield
        if flow > 0.0:
            flow = max(flow, von_mises(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i]))
        mix[j, FLOW, m] = flow
    target = meet_traction(j, i, change, void, skin, p, bulk, vof, pm, km, mix)
    n_r, n_z, weight = skin[NORMAL_R, j, i], skin[NORMAL_Z, j, i], surface_weight(j, i, skin)
    for m in range(vof.shape[0]):
        if vof[m, j, i] > 0.0 and models[m, STRENGTH] != 0:
            strained = 2.0 * mix[j, MODULUS, m] * mix[j, ACROSS, m]
            mix[j, TRIAL_RR, m] += strained * (n_r * n_r - weight / 3.0)
            mix[j, TRIAL_ZZ, m] += strained * (n_z * n_z - weight / 3.0)
            mix[j, TRIAL_RZ, m] += strained * n_r * n_z
    return target


@point
def return_deviators(j, i, dt, own, cell_yield, dominant, volume, total, models, materials, pm, tm, vof, q, mix, internal):
    """Brings the trial deviators back to the yield surface: each body's own, or the one of the cell.

    In the hard zone the plastic heat of the dominant body is shared by f_m/Y_m among what is solid, as in layers under one
    stress.

    Reads    what strain_deviators wrote
    Updates  q (deviators, plastic strain, damage, internal variables) [k, m, j, i]; mix [j, HEAT, m]; scratch internal [j, k]
    """
    bodies = vof.shape[0]
    for m in range(bodies):
        model, par = models[m, STRENGTH], materials[m, STRENGTH_AT:DAMAGE_AT]
        if vof[m, j, i] == 0.0 or model == 0:
            continue
        rr, zz, rz, modulus = mix[j, TRIAL_RR, m], mix[j, TRIAL_ZZ, m], mix[j, TRIAL_RZ, m], mix[j, MODULUS, m]
        rho, p_m, t_m = q[RHO, m, j, i], pm[m, j, i], tm[m, j, i]
        take_internal(m, j, i, model, q, internal[j])
        x_rr, x_zz, x_rz = from_centre(rr, zz, rz, model, internal[j])
        trial = von_mises(x_rr, x_zz, x_rz)
        stiffness = modulus + kinematic_modulus(model, par) / 3.0
        dep, final = 0.0, trial
        if own:
            dep, final = plastic_increment(model, trial, q[EP, m, j, i], dt, t_m, p_m, rho, stiffness, materials[m, FACTOR],
                                           par)
        elif trial > cell_yield:
            final = cell_yield
            dep = (trial - final) / (3.0 * stiffness) if modulus > 0.0 else 0.0
        if dep > 0.0:
            rr, zz, rz = returned(x_rr, x_zz, x_rz, trial, dep, final, model, par, internal[j])
            keep_internal(m, j, i, model, internal[j], q)
            q[EP, m, j, i] += dep
            damage_par = materials[m, DAMAGE_AT:TENSILE]
            increment = damage_increment(models[m, DAMAGE], dep, dep / dt, t_m, p_m, final, damage_par)
            q[DMG, m, j, i] = damaged(q[DMG, m, j, i], increment)
        gone = carries_no_stress(q[DMG, m, j, i], rho, materials[m, CUTOFF_DENSITY])
        q[SRR, m, j, i] = 0.0 if gone else rr
        q[SZZ, m, j, i] = 0.0 if gone else zz
        q[SRZ, m, j, i] = 0.0 if gone else rz
        if m == dominant and dep > 0.0 and mix[j, YIELD, m] > 0.0:
            share_plastic_heat(j, i, m, dep * final * volume * total, vof, mix)


@point
def share_plastic_heat(j, i, dominant, plastic, vof, mix):
    """Gives the plastic work of the dominant body to all that is solid, by f_m/Y_m.

    Updates  mix [j, HEAT, m]
    """
    whole = 0.0
    for m in range(vof.shape[0]):
        whole += vof[m, j, i] / mix[j, YIELD, m] if mix[j, YIELD, m] > 0.0 else 0.0
    for m in range(vof.shape[0]):
        share = vof[m, j, i] / mix[j, YIELD, m] if mix[j, YIELD, m] > 0.0 else 0.0
        mix[j, HEAT, m] += plastic * share / whole
    mix[j, HEAT, dominant] -= plastic


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
def pressure_rise(j, i, void, middle, vof, pm):
    """What the pressure of a cell without void rises by until the middle of the step, in which it is `middle`."""
    before = 0.0
    for m in range(vof.shape[0]):
        before += vof[m, j, i] * pm[m, j, i] if vof[m, j, i] > 0.0 else 0.0
    return middle - before if void <= NO_VOID else 0.0


@point
def is_beside_gas(j, i, materials, vof):
    """Whether a gas is in a cell."""
    found = False
    for m in range(vof.shape[0]):
        found = found or (vof[m, j, i] > 0.0 and materials[m, GAS] > 0.0)
    return found


@point
def work_beside_gas(j, i, volume, opened, rest, inverse, work, rise, target, relaxed, void_stays, pm, km, vof, q, mix):
    """Work in a cell that a gas shares with stiffer bodies: each body's own pressure on its own change of volume, the remainder
    by mass (explanation/mixed-cells, equation 6).

    opened and rest are the changes of volume of void and of the bodies, work that of pressure, viscosity and hourglass filter
    on the cell, rise what its pressure rises by to the middle of the step, and relaxed the share of its excess of pressure over
    the target that a body loses.

    Reads    mix [j, SOFT, m]
    Updates  mix [j, HEAT, m], which then has all of the work on a body
    """
    bodies = vof.shape[0]
    mass, left = 0.0, work
    for m in range(bodies):
        f = vof[m, j, i]
        if f > 0.0:
            mass += q[RHO, m, j, i] * f * volume
            own = (pm[m, j, i] + rise) * mix[j, SOFT, m] * inverse * rest + f * pm[m, j, i] * opened
            if not void_stays:
                excess = pm[m, j, i] - target
                own += (pm[m, j, i] - 0.5 * relaxed * excess) * relaxed * f * volume * excess / km[m, j, i]
            mix[j, HEAT, m] -= own
            left += own
    for m in range(bodies):
        if vof[m, j, i] > 0.0:
            mix[j, HEAT, m] += q[RHO, m, j, i] * vof[m, j, i] * volume / mass * left


@point
def fill_cell(j, i, change, volume, total, inverse, mean_p, work_p, work_q, rise, relaxation, tipton, meet, group, motion,
              cell_mass, materials, pm, km, vof, q, mix):
    """Volumes, densities and energies after the step: void first, then by compressibility, then relaxation of the pressures.

    Reads    mix [j, SOFT, m], mix [j, HEAT, m]
    Updates  vof [m, j, i] (share of the volume after the step), q (rho, e) [k, m, j, i]
    """
    bodies = vof.shape[0]
    void = max(1.0 - total, 0.0)
    taken, rest = split_volume(void, change, volume)
    void_left = void * volume + taken
    void_stays = void_left > NO_VOID * volume
    target = 0.0 if void_stays else mean_p
    bound, growth = 1.0, 0.0
    for m in range(bodies):
        if vof[m, j, i] > 0.0 and tipton:
            shift = relaxation_strain(relaxation, pm[m, j, i], target, km[m, j, i])
            growth += vof[m, j, i] * shift
            bound = min(bound, relaxation_bound(shift))
    if void_stays and growth * volume * bound > void_left:
        bound = void_left / (growth * volume)
    gas = is_beside_gas(j, i, materials, vof)
    if gas:
        work = work_p + work_q + filter_work(j, i, motion, cell_mass)
        relaxed = bound * relaxation if tipton else 0.0
        work_beside_gas(j, i, volume, taken, rest, inverse, work, rise, target, relaxed, void_stays, pm, km, vof, q, mix)
    after = volume + change
    for m in range(bodies):
        f = vof[m, j, i]
        if f == 0.0:
            continue
        mass = q[RHO, m, j, i] * f * volume
        shift = bound * f * relaxation * (pm[m, j, i] - target) / km[m, j, i] * volume if tipton else 0.0
        filled = f * volume + mix[j, SOFT, m] * inverse * rest + shift
        filled = max(filled, 0.5 * f * volume)
        q[RHO, m, j, i] = mass / filled if filled != f * volume else q[RHO, m, j, i]
        vof[m, j, i] = filled / after if filled != f * volume or change != 0.0 else f
        filtered = motion[j, group[m], HOURGLASS]
        if gas:
            q[E, m, j, i] += mix[j, HEAT, m] / mass
            continue
        if meet:  # the filter acts on each group by its share of the mass
            rubbed = f / total * work_q + mass / (cell_mass[0, j, i] + cell_mass[1, j, i]) * filtered
        else:
            rubbed = f / total * (work_q + filtered)
        gained = mix[j, SOFT, m] * inverse * work_p + rubbed + mix[j, HEAT, m]
        q[E, m, j, i] += (gained - target * shift) / mass


@kernel
def deform_mixed(j0, j1, dt, relaxation, tipton, mode, hard, hard_threshold, metrics, dz, mixed_count, mixed, group,
                 contact_columns, cell_mass, models, materials, u0, v0, u, v, fr, fz, ph, qr, qz, hg_coefficient, skin, p, bulk,
                 solid, pm, km, tm, vof, q, mix, motion, internal):
    """The Lagrangian step of the bodies in mixed cells.

    Volume: void first, then by compressibility, w_m = R_m/Rbar with R_m = f_m/K_m, then relaxation of the pressures,
    df_m = gamma R_m (p_m - pbar), with pbar = sum R_m p_m/Rbar, or 0 where void is left (explanation/mixed-cells).
    Energy: pressure work by w_m, viscous and hourglass work by volume fraction (the latter by mass where two groups meet),
    deviatoric work by what each body's stress did; beside a gas as work_beside_gas has it.
    Strength: by mode, see STRENGTH_MODES; every body moves with its group. In contact-interface cells pressure and
    viscosity do the work of the one change of volume, and each body has its own strength where two groups meet.

    Reads    velocities, swept volumes, stresses as `deform`; ph, qr, qz, solid [j, i]; contact_columns [j, 2];
             cell_mass [b, j, i]; group, hard [m]
    Updates  vof [m, j, i] (share of the volume after the step), q [k, m, j, i]
    Scratch  mix [j, 14, m] (rows SOFT to NORMAL), motion [j, b, 10], internal [j, k]
    """
    groups = cell_mass.shape[0]
    blocks = number_of_blocks(j0, j1)
    for place in prange(blocks):
        first_row, last_row = block_rows(spread(place, blocks), blocks, j0, j1)
        for j in range(first_row, last_row):
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
                        work_q = -dt * (qr[j, i] * across + qz[j, i] * motion[j, g, MEAN_ZZ])
                        work_p = -ph[j, i] * dt * (across + motion[j, g, MEAN_ZZ])
                if groups > 1 and contact_columns[j, 0] <= i < contact_columns[j, 1]:
                    work_q = -qr[j, i] * change
                    work_p = -ph[j, i] * change
                total, meet = solid[j, i], held > 1
                dominant = dominant_body(j, i, hard, hard_threshold, vof)
                inverse, mean_p = soften(j, i, tipton, vof, pm, km, mix)
                for m in range(vof.shape[0]):
                    mix[j, NORMAL, m] = normal_deviator(m, j, i, skin, q) if vof[m, j, i] > 0.0 else 0.0
                cut, own = skin[KIND, j, i] != BONDED, mode == MATERIAL or dominant >= 0 or meet
                target = 0.0
                work_of_deviators(j, i, dt, dominant, total, stress_scale(mode == SOLID, total), group, motion, vof, q, mix)
                cell_yield = strain_deviators(j, i, dt / volume, mode, total, skin, group, models, materials, pm, tm, motion,
                                              vof, q, mix, internal)
                if cut:
                    target = strain_bodies_across(j, i, own, cell_yield, change / volume, max(1.0 - total, 0.0), skin, p, bulk,
                                                  models, vof, pm, km, q, mix)
                return_deviators(j, i, dt, own, cell_yield, dominant, volume, total, models, materials, pm, tm, vof, q, mix,
                                 internal)
                if cut:
                    fill_cut_cell(j, i, change, volume, target, work_p + work_q + filter_work(j, i, motion, cell_mass), vof,
                                  pm, q, mix)
                    continue
                rise = 0.0 if meet else pressure_rise(j, i, 1.0 - total, ph[j, i], vof, pm)
                fill_cell(j, i, change, volume, total, inverse, mean_p, work_p, work_q, rise, relaxation, tipton, meet, group,
                          motion, cell_mass, materials, pm, km, vof, q, mix)
