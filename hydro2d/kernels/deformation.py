"""The Lagrangian step in pure cells after the velocities: work, volume, rotation and strain of the deviators, radial return."""


from hydro2d.jit import cell_rows, rowwise
from hydro2d.kernels.column_ranges import columns
from hydro2d.kernels.plastic_return import flow, return_to_surface
from hydro2d.materials.rows import CUTOFF_DENSITY, DAMAGE_AT, EOS_AT, FACTOR, MELTING_AT, STRENGTH, STRENGTH_AT
from hydro2d.mesh.fields import DMG, EP, LANES, RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import VOL_R
from hydro2d.physics.corner import filter_power, stress_power
from hydro2d.physics.kinematics import velocity_gradient
from hydro2d.physics.plasticity import forget, is_fluid, keep_internal, take_internal
from hydro2d.physics.stress import turn_and_strain, von_mises
from strength.dispatch import WEAKENS, WITH_INTERNAL, end_at_melt, modulus_row, turn, yield_floor
from strength.lanes import COLUMN, DENSITY, HEAT, INCREMENT, PRESSURE, STIFFNESS, STRAIN, STRESS, TRIAL, WIDTH
from strength.radial_return import return_together


@rowwise
def strain_row(m, j, b, w):
    """Energy and elastic trial deviators of body m in the cells of row j that it fills.

    Reads    u0, v0, u, v, filter_r, filter_z [b, j, i]; sig_.. [j, i]; vof [m, j, i]; scratch [0, b, i], shear modulus
    Updates  q (energy, deviators) [k, m, j, i]
    Writes   scratch [1, b, i], von Mises norm of the trial: negative up to the cutoff density, 0 where the body fills no
             cell, and without a shear modulus; scratch [2, b, i], spin
    """
    g, h, cutoff_density = w.group[m], w.dz[j], w.materials[m, CUTOFF_DENSITY]
    first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    rr_j = w.sig_rr[j]
    zz_j = w.sig_zz[j]
    tt_j = w.sig_tt[j]
    rz_j = w.sig_rz[j]
    push_r = w.filter_r[g, j]
    push_z = w.filter_z[g, j]
    shear_j = w.scratch[0, b]
    trial_j = w.scratch[1, b]
    spin_j = w.scratch[2, b]
    ub = w.u[g, j]
    ut = w.u[g, j + 1]
    vb = w.v[g, j]
    vt = w.v[g, j + 1]
    ub0 = w.u0[g, j]
    ut0 = w.u0[g, j + 1]
    vb0 = w.v0[g, j]
    vt0 = w.v0[g, j + 1]
    f_j = w.vof[m, j]
    rho_j = w.q[RHO, m, j]
    e_j = w.q[E, m, j]
    srr_j = w.q[SRR, m, j]
    szz_j = w.q[SZZ, m, j]
    srz_j = w.q[SRZ, m, j]
    for x in range(n):
        i = first + x
        pure = f_j[i] == 1.0
        volume = w.metrics[VOL_R, i] * h
        before = velocity_gradient(i, ub0, ut0, vb0, vt0, w.metrics, h)
        after = velocity_gradient(i, ub, ut, vb, vt, w.metrics, h)
        rr, tt, zz, rbz, zbr = after
        work = 0.5 * w.dt * (
            stress_power(rr_j[i], tt_j[i], zz_j[i], rz_j[i], before, after)
            + filter_power(i, push_r[i], push_z[i], ub0, ut0, vb0, vt0, ub, ut, vb, vt))
        rho = rho_j[i]
        gain = work / (rho * volume)
        e_j[i] += gain if pure else 0.0
        rate = 1.0 / volume
        drr, dzz, dtt, drz = rr * rate, zz * rate, tt * rate, 0.5 * (rbz + zbr) * rate
        spin = 0.5 * (rbz - zbr) * rate * w.dt
        srr, szz, srz = turn_and_strain(
            srr_j[i], szz_j[i], srz_j[i], spin, 2.0 * shear_j[i], drr * w.dt, dzz * w.dt, dtt * w.dt, drz * w.dt)
        srr_j[i] = srr if pure else srr_j[i]
        szz_j[i] = szz if pure else szz_j[i]
        srz_j[i] = srz if pure else srz_j[i]
        size = von_mises(srr, szz, srz)
        size = -size if rho <= cutoff_density or is_fluid(shear_j[i]) else size
        trial_j[i] = size if pure else 0.0
        spin_j[i] = spin


@rowwise
def yield_row(m, j, b, w):
    """Return of body m's deviators to its yield surface in row j, where their elastic trial lies outside it.

    Cells that may yield are gathered and solved together, up to `LANES` at a time (strength/radial_return.py).

    Reads    scratch [0 and 1, b, i], shear modulus and trial stress; pm, tm [m, j, i]
    Updates  q (deviators, plastic strain, damage) [k, m, j, i]
    Scratch  lanes [b, k]
    """
    model = w.models[m, STRENGTH]
    par = w.materials[m, STRENGTH_AT:DAMAGE_AT]
    scale = w.materials[m, FACTOR]
    first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    floor = scale * yield_floor(model, par)  # no flow stress is needed below it
    p_j = w.pm[m, j]
    t_j = w.tm[m, j]
    shear_j = w.scratch[0, b]
    trial_j = w.scratch[1, b]
    rho_j = w.q[RHO, m, j]
    ep_j = w.q[EP, m, j]
    srr_j = w.q[SRR, m, j]
    szz_j = w.q[SZZ, m, j]
    srz_j = w.q[SRZ, m, j]
    lane = w.lanes[b]
    candidates = 0
    for x in range(n):
        candidates += 0 if abs(trial_j[first + x]) <= floor else 1  # a NaN counts as one
    x = 0 if candidates > 0 else n
    while x < n:
        gathered = 0
        while x < n and gathered < LANES:
            i = first + x
            lane[COLUMN + gathered] = i
            gathered += 0 if abs(trial_j[i]) <= floor else 1
            x += 1
        number = (gathered + WIDTH - 1) // WIDTH * WIDTH
        for k in range(number):
            i = int(lane[COLUMN + min(k, gathered - 1)])  # lanes left over copy the last
            lane[TRIAL + k] = abs(trial_j[i])
            lane[STRAIN + k] = ep_j[i]
            lane[HEAT + k] = t_j[i]
            lane[PRESSURE + k] = p_j[i]
            lane[DENSITY + k] = rho_j[i]
            lane[STIFFNESS + k] = 3.0 * shear_j[i]
        if number > 0:
            return_together(model, number, w.dt, scale, par, lane)
        for k in range(gathered):
            dep = lane[INCREMENT + k]
            if dep != 0.0:
                i = int(lane[COLUMN + k])
                yield_stress = lane[STRESS + k]
                shrink = yield_stress / lane[TRIAL + k]
                srr_j[i] *= shrink
                szz_j[i] *= shrink
                srz_j[i] *= shrink
                flow(m, j, i, dep, yield_stress, w)


@rowwise
def internal_row(m, j, b, w):
    """Return to the yield surface cell by cell, for a model that damage weakens or whose internal variables turn and harden.

    Reads    vof, pm, tm [m, j, i]; scratch [0 to 2, b, i], shear modulus, trial stress and spin
    Updates  q (deviators, plastic strain, damage, internal variables) [k, m, j, i]; scratch internal [j, k]
    """
    model = w.models[m, STRENGTH]
    first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    for x in range(n):
        i = first + x
        if w.vof[m, j, i] == 1.0 and is_fluid(w.scratch[0, b, i]):
            forget(m, j, i, model, w.q, w.internal[j])
            continue
        if w.vof[m, j, i] != 1.0 or w.scratch[1, b, i] < 0.0:
            continue
        take_internal(m, j, i, model, w.q, w.internal[j])
        turn(model, w.scratch[2, b, i], w.internal[j])
        keep_internal(m, j, i, model, w.internal[j], w.q)
        rr, zz, rz, _, _ = return_to_surface(
            m, j, i, w.q[SRR, m, j, i], w.q[SZZ, m, j, i], w.q[SRZ, m, j, i], w.scratch[0, b, i], True, 0.0, w)
        w.q[SRR, m, j, i] = rr
        w.q[SZZ, m, j, i] = zz
        w.q[SRZ, m, j, i] = rz


@rowwise
def expand_row(m, j, b, w):
    """Density of body m in the cells of row j that it fills, at constant mass.

    The deviator is zero where the body has failed or melted, or is at or below the cutoff density.

    Reads    fr, fz [j, i]; vof [m, j, i]; scratch [1, b, i], negative up to the cutoff density and in melts
    Updates  q (density, deviators) [k, m, j, i]
    """
    h = w.dz[j]
    first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    fr_j = w.fr[j]
    fz_b = w.fz[j]
    fz_t = w.fz[j + 1]
    trial_j = w.scratch[1, b]
    f_j = w.vof[m, j]
    rho_j = w.q[RHO, m, j]
    d_j = w.q[DMG, m, j]
    srr_j = w.q[SRR, m, j]
    szz_j = w.q[SZZ, m, j]
    srz_j = w.q[SRZ, m, j]
    for x in range(n):
        i = first + x
        pure = f_j[i] == 1.0
        volume = w.metrics[VOL_R, i] * h
        change = (fr_j[i + 1] - fr_j[i]) + (fz_t[i] - fz_b[i])
        rho_j[i] = rho_j[i] * (volume / (volume + change)) if pure else rho_j[i]
        gone = pure and (d_j[i] >= 1.0 or trial_j[i] < 0.0)
        srr_j[i] = 0.0 if gone else srr_j[i]
        szz_j[i] = 0.0 if gone else szz_j[i]
        srz_j[i] = 0.0 if gone else srz_j[i]


@cell_rows
def deform(j, part, w):
    """Energy, density, deviator, plastic strain and damage of every body in the cells that it fills, over one Lagrangian step.

    de = V dt sigma : D(u mid-step) / m, the work of the same corner forces that moved the vertices; rho V is constant;
    the deviators are strained with the velocities at the end of the step (explanation/lagrangian-step, equations 5 and
    7). Failed and molten material and material at or below its cutoff density carries no deviator.

    Reads    group [m]; u0, v0, u, v, filter_r, filter_z [b, j, i]; fr, fz, sig_.. [j, i]; vof, pm, tm [m, j, i]
    Updates  q [k, m, j, i]
    Scratch  scratch [s, part, i], shear modulus, trial stress and spin; internal [j, k]; lanes [part, k]
    """
    for m in range(w.vof.shape[0]):
        model = w.models[m, STRENGTH]
        par = w.materials[m, STRENGTH_AT:DAMAGE_AT]
        first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        modulus_row(model, par, first, n, w.pm[m, j], w.q[RHO, m, j], w.tm[m, j], w.scratch[0, part])
        end_at_melt(w.materials[m, MELTING_AT:EOS_AT], first, n, w.q[RHO, m, j], w.tm[m, j], w.scratch[0, part])
        strain_row(m, j, part, w)
        if model in WITH_INTERNAL or model in WEAKENS:
            internal_row(m, j, part, w)
        elif model > 0:
            yield_row(m, j, part, w)
        expand_row(m, j, part, w)
