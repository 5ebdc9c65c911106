"""Cells in which bodies meet each other or void: tearing, closure of pressure and volume, shared strength."""

from eos.dispatch import evaluate, zero_pressure_density
from hydro2d.jit import kernel, prange, rowwise
from hydro2d.kernels.spans import block_rows, mixed_row, number_of_blocks, spread
from hydro2d.kernels.thermodynamics import pressures_row, viscosity_row
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.closure import NO_VOID, split_volume
from hydro2d.physics.kinematics import hourglass_mode, velocity_gradient
from hydro2d.physics.stress import stress_scale, turn_and_strain, von_mises
from strength.dispatch import damage_increment, flow_stress, shear_modulus
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
def tear_mixed_row(j, smallest, max_opening, vol_r, dz, mixed_count, mixed, group, eos_model, eos_par, fracture_pressure, vof,
                   q, pm, p, solid, bulk, opened):
    """Opens void in mixed cells whose pressure falls below their fracture pressure, and frees them of stress.

    The threshold is the mean of the bodies' by volume fraction, or the smallest (explanation/fracture). Two groups hold
    together by nothing: they part at zero pressure, and each keeps its stress.

    Reads    mixed [j, k], group, fracture_pressure [m]
    Updates  vof, pm [m, j, i]; q (rho, deviators); p, solid, bulk [j, i]; opened [j]
    """
    bodies = vof.shape[0]
    for k in range(mixed_count[j]):
        i = mixed[j, k]
        mean, least = 0.0, 1e300
        low, high = 1, 0
        for m in range(bodies):
            f = vof[m, j, i]
            if f > 0.0:
                low, high = min(low, group[m]), max(high, group[m])
                limit = fracture_pressure[m] if q[DMG, m, j, i] < 1.0 else 0.0
                mean += f * limit
                least = min(least, limit)
        threshold = least * solid[j, i] if smallest else mean
        parts = low < high
        threshold = 0.0 if parts else threshold
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
                target = max(zero_pressure_density(eos_model[m], rho, e, eos_par[m]), rho)
                share = max(rho / target, 1.0 - max_opening)
                opened[j] += f * (1.0 - share) * vol_r[i] * dz[j]
                f *= share
                vof[m, j, i] = f
                q[RHO, m, j, i] = rho / share
                pm[m, j, i] = evaluate(eos_model[m], rho / share, e, eos_par[m])[0]
            if not parts:
                q[SRR, m, j, i] = 0.0
                q[SZZ, m, j, i] = 0.0
                q[SRZ, m, j, i] = 0.0
            total += f
            pressure += f * pm[m, j, i]
        p[j, i] = pressure
        solid[j, i] = total
        if total < 1.0 - NO_VOID:
            bulk[j, i] = 0.0


@kernel
def close_cells(j0, j1, max_opening, smallest_tension, linear, quadratic, courant, advective, mesh_speed, hourglass, face_r,
                az_in, az_out, vol_r, dr, dz, span, reach, mixed_count, mixed, group, eos_model, eos_par, strength_model,
                strength_par, damage_model, fracture_pressure, loose, u, v, vof, q, pm, km, tm, p, bulk, rhobar, solid, cl, qr,
                qz, weight, opened, row_step, bad, scratch):
    """Equation of state, void where a cell tears, artificial viscosity and the time step that every cell allows.

    Reads, updates and writes what pressures_row, tear_mixed_row and viscosity_row do, and the list of mixed cells
    Scratch  scratch [s, block, i]
    """
    blocks = number_of_blocks(j0, j1)
    for place in prange(blocks):
        b = spread(place, blocks)
        first_row, last_row = block_rows(b, blocks, j0, j1)
        for j in range(first_row, last_row):
            pressures_row(j, b, max_opening, vol_r, dz, span, reach, eos_model, eos_par, strength_model, strength_par,
                          damage_model, fracture_pressure, loose, vof, q, pm, km, tm, p, bulk, rhobar, solid, cl, scratch,
                          opened, bad)
            if opened[j] > 0.0:
                mixed_row(j, reach, vof, scratch[0], b, mixed_count, mixed)
            tear_mixed_row(j, smallest_tension, max_opening, vol_r, dz, mixed_count, mixed, group, eos_model, eos_par,
                           fracture_pressure, vof, q, pm, p, solid, bulk, opened)
            viscosity_row(j, b, linear, quadratic, courant, advective, mesh_speed, hourglass, dr, dz, vol_r, face_r, az_in,
                          az_out, reach, u, v, rhobar, bulk, cl, qr, qz, weight, row_step, bad, scratch)


@kernel
def deform_mixed(j0, j1, dt, relaxation, tipton, mode, hard, hard_threshold, face_r, hoop, az_in, az_out, vol_r,
                 mid_r, dz, mixed_count, mixed, group, cut, cell_mass, strength_model, strength_par, damage_model,
                 damage_par, factor, loose, u0, v0, u, v, fr, fz, ph, qr, qz, weight, solid, pm, km, tm, vof, q, mix, motion):
    """The Lagrangian step of the bodies in mixed cells.

    Volume: void first, then by compressibility, w_m = R_m/Rbar with R_m = f_m/K_m, then relaxation of the pressures,
    df_m = gamma R_m (p_m - pbar), with pbar = sum R_m p_m/Rbar, or 0 where void is left (explanation/mixed-cells).
    Energy: pressure work by w_m, viscous and hourglass work by volume fraction (the latter by mass where two groups meet),
    deviatoric work by what each body's stress did; in the hard zone the hard body's plastic heat is shared by f_m/Y_m among
    what is solid, as in layers under one stress.
    Strength: by mode, see STRENGTH_MODES; every body moves with its group. In the cut cells of a contact pressure and
    viscosity do the work of the one change of volume, and each body has its own strength where two groups meet.

    Reads    velocities, swept volumes, stresses as `deform`; ph, qr, qz, solid [j, i]; cut [j, 2]; cell_mass [b, j, i];
             group, hard, factor, loose [m]
    Updates  vof [m, j, i] (share of the volume after the step), q [k, m, j, i]
    Scratch  mix [j, 8, m], motion [j, b, 10]
    """
    bodies = vof.shape[0]
    groups = cell_mass.shape[0]
    blocks = number_of_blocks(j0, j1)
    for place in prange(blocks):
        b = spread(place, blocks)
        first_row, last_row = block_rows(b, blocks, j0, j1)
        for j in range(first_row, last_row):
            h = dz[j]
            part_v = mix[j, 0]
            share = mix[j, 1]
            yields = mix[j, 2]
            heat = mix[j, 3]
            s_rr = mix[j, 4]
            s_zz = mix[j, 5]
            s_rz = mix[j, 6]
            modulus = mix[j, 7]
            for k in range(mixed_count[j]):
                i = mixed[j, k]
                volume = vol_r[i] * h
                change = (fr[j, i + 1] - fr[j, i]) + (fz[j + 1, i] - fz[j, i])
                w = weight[j, i]
                work_q, work_p, held = 0.0, 0.0, 0
                for g in range(groups):
                    if cell_mass[g, j, i] == 0.0:
                        continue
                    held += 1
                    a_rr, a_tt, a_zz, a_rbz, a_zbr = velocity_gradient(
                        i, u0[g, j], u0[g, j + 1], v0[g, j], v0[g, j + 1], face_r, hoop, az_in, az_out, mid_r, h)
                    rr, tt, zz, rbz, zbr = velocity_gradient(
                        i, u[g, j], u[g, j + 1], v[g, j], v[g, j + 1], face_r, hoop, az_in, az_out, mid_r, h)
                    m_rr, m_tt, m_zz = 0.5 * (a_rr + rr), 0.5 * (a_tt + tt), 0.5 * (a_zz + zz)
                    h_u0, h_v0 = hourglass_mode(i, u0[g, j], u0[g, j + 1]), hourglass_mode(i, v0[g, j], v0[g, j + 1])
                    h_u, h_v = hourglass_mode(i, u[g, j], u[g, j + 1]), hourglass_mode(i, v[g, j], v[g, j + 1])
                    motion[j, g, RR] = rr
                    motion[j, g, TT] = tt
                    motion[j, g, ZZ] = zz
                    motion[j, g, RBZ] = rbz
                    motion[j, g, ZBR] = zbr
                    motion[j, g, MEAN_RR] = m_rr
                    motion[j, g, MEAN_TT] = m_tt
                    motion[j, g, MEAN_ZZ] = m_zz
                    motion[j, g, MEAN_RZ] = 0.5 * ((a_rbz + rbz) + (a_zbr + zbr))
                    motion[j, g, HOURGLASS] = 0.5 * dt * w * (h_u0 * (h_u0 + h_u) + h_v0 * (h_v0 + h_v))
                    work_q = -dt * (qr[j, i] * (m_rr + m_tt) + qz[j, i] * m_zz)
                    work_p = -ph[j, i] * dt * ((m_rr + m_tt) + m_zz)
                meet = held > 1
                if groups > 1 and cut[j, 0] <= i < cut[j, 1]:
                    work_q = -qr[j, i] * change
                    work_p = -ph[j, i] * change

                # which body's strength rules the cell, and what each body's stress did in the step
                total = solid[j, i]
                ruler = -1
                for m in range(bodies):
                    if hard[m] and vof[m, j, i] >= hard_threshold:
                        ruler = m
                compliance, mean_p, softness = 0.0, 0.0, 0.0
                for m in range(bodies):
                    f = vof[m, j, i]
                    part_v[m] = f / km[m, j, i] if f > 0.0 else 0.0
                    if not tipton:
                        part_v[m] = f
                    compliance += part_v[m]
                    mean_p += part_v[m] * pm[m, j, i]
                    heat[m] = 0.0
                inverse = 1.0 / compliance
                mean_p *= inverse
                for m in range(bodies):
                    f = vof[m, j, i]
                    if f == 0.0:
                        continue
                    part = total if m == ruler else 0.0
                    if ruler < 0:
                        part = f * stress_scale(mode == SOLID, total)
                    a = q[SRR, m, j, i]
                    b = q[SZZ, m, j, i]
                    c = q[SRZ, m, j, i]
                    g = group[m]
                    heat[m] = part * dt * ((a * motion[j, g, MEAN_RR] - (a + b) * motion[j, g, MEAN_TT])
                                           + (b * motion[j, g, MEAN_ZZ] + c * motion[j, g, MEAN_RZ]))

                # the new deviators, and the plastic heat of the hard zone
                rate = dt / volume
                shared_yield, largest_yield = 0.0, 0.0
                for m in range(bodies):
                    f = vof[m, j, i]
                    yields[m] = 0.0
                    if f == 0.0 or strength_model[m] == 0:
                        continue
                    par = strength_par[m]
                    rho = q[RHO, m, j, i]
                    p_m = pm[m, j, i]
                    t_m = tm[m, j, i]
                    modulus[m] = shear_modulus(strength_model[m], p_m, rho, t_m, par)
                    g = group[m]
                    strain_r, strain_z, strain_t = motion[j, g, RR] * rate, motion[j, g, ZZ] * rate, motion[j, g, TT] * rate
                    strain_s = 0.5 * (motion[j, g, RBZ] + motion[j, g, ZBR]) * rate
                    spin = 0.5 * (motion[j, g, RBZ] - motion[j, g, ZBR]) * rate
                    s_rr[m], s_zz[m], s_rz[m] = turn_and_strain(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i], spin,
                                                                2.0 * modulus[m], strain_r, strain_z, strain_t, strain_s)
                    yields[m] = factor[m] * flow_stress(strength_model[m], q[EP, m, j, i], 0.0, t_m, p_m, rho, par)
                    if q[DMG, m, j, i] >= 1.0 or rho <= loose[m]:
                        yields[m] = 0.0
                    shared_yield += f * yields[m]
                    largest_yield = max(largest_yield, yields[m])
                shared_yield /= total
                if mode == ZERO:
                    shared_yield = 0.0
                elif mode == MAX:
                    shared_yield = largest_yield
                own = mode == MATERIAL or ruler >= 0 or meet
                for m in range(bodies):
                    f = vof[m, j, i]
                    if f == 0.0 or strength_model[m] == 0:
                        continue
                    trial = von_mises(s_rr[m], s_zz[m], s_rz[m])
                    dep, final = 0.0, trial
                    rho = q[RHO, m, j, i]
                    p_m = pm[m, j, i]
                    t_m = tm[m, j, i]
                    if own:
                        dep, final = plastic_increment(strength_model[m], trial, q[EP, m, j, i], dt, t_m, p_m, rho, modulus[m],
                                                       factor[m], strength_par[m])
                    elif trial > shared_yield:
                        final = shared_yield
                        dep = (trial - final) / (3.0 * modulus[m]) if modulus[m] > 0.0 else 0.0
                    shrink = 1.0
                    if dep > 0.0:
                        shrink = final / trial
                        q[EP, m, j, i] += dep
                        q[DMG, m, j, i] += damage_increment(damage_model[m], dep, dep / dt, t_m, p_m, final, damage_par[m])
                    q[DMG, m, j, i] = min(q[DMG, m, j, i], 1.0)
                    if q[DMG, m, j, i] >= 1.0 or rho <= loose[m]:
                        shrink = 0.0
                    q[SRR, m, j, i] = shrink * s_rr[m]
                    q[SZZ, m, j, i] = shrink * s_zz[m]
                    q[SRZ, m, j, i] = shrink * s_rz[m]
                    if m == ruler and dep > 0.0 and yields[m] > 0.0:
                        plastic = dep * final * volume * total
                        for n in range(bodies):
                            share[n] = vof[n, j, i] / yields[n] if yields[n] > 0.0 else 0.0
                            softness += share[n]
                        for n in range(bodies):
                            heat[n] += plastic * share[n] / softness
                        heat[m] -= plastic

                # volumes: void first, then by compressibility, then relaxation
                void = max(1.0 - total, 0.0)
                taken, rest = split_volume(void, change, volume)
                void_left = void * volume + taken
                void_stays = void_left > NO_VOID * volume
                target = 0.0 if void_stays else mean_p
                bound, growth = 1.0, 0.0
                for m in range(bodies):
                    if vof[m, j, i] > 0.0 and tipton:
                        shift = relaxation * (pm[m, j, i] - target) / km[m, j, i]
                        growth += vof[m, j, i] * shift
                        bound = min(bound, 0.1 / max(abs(shift), 0.1))
                if void_stays and growth * volume * bound > void_left:
                    bound = void_left / (growth * volume)
                after = volume + change
                for m in range(bodies):
                    f = vof[m, j, i]
                    if f == 0.0:
                        continue
                    mass = q[RHO, m, j, i] * f * volume
                    shift = bound * f * relaxation * (pm[m, j, i] - target) / km[m, j, i] * volume if tipton else 0.0
                    filled = f * volume + part_v[m] * inverse * rest + shift
                    filled = max(filled, 0.5 * f * volume)
                    q[RHO, m, j, i] = mass / filled if filled != f * volume else q[RHO, m, j, i]
                    vof[m, j, i] = filled / after if filled != f * volume or change != 0.0 else f
                    filtered = motion[j, group[m], HOURGLASS]
                    if meet:  # the filter acts on each group by its share of the mass
                        rubbed = f / total * work_q + mass / (cell_mass[0, j, i] + cell_mass[1, j, i]) * filtered
                    else:
                        rubbed = f / total * (work_q + filtered)
                    gained = part_v[m] * inverse * work_p + rubbed + heat[m]
                    q[E, m, j, i] += (gained - target * shift) / mass
