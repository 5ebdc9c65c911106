"""Pressure, sound speed, artificial viscosity and the local time step, in one pass over the rows."""

from math import inf, sqrt

from eos.dispatch import (
    WITH_MEMORY,
    evaluate,
    pressure_row,
    pressure_row_with_memory,
    sound_speed_squared,
    temperature_row,
    temperature_row_with_memory,
    zero_pressure_density,
)
from hydro2d.jit import cell_rows, not_inlined, point, rowwise, serial
from hydro2d.kernels.cell_viscosity import limit_of_sound, viscosity
from hydro2d.kernels.column_ranges import columns, outer_rows
from hydro2d.materials.rows import (
    CUTOFF_DENSITY,
    DAMAGE,
    DAMAGE_AT,
    EOS,
    EOS_AT,
    FADES,
    MELTING_AT,
    MEMORY,
    MOST_STRESS,
    RECORD,
    STRENGTH,
    STRENGTH_AT,
    TENSILE,
)
from hydro2d.mesh.fields import BY_TENSION, DMG, EP, FAILED, RHO, SRR, SRZ, SZZ, E
from hydro2d.mesh.grid import VOL_R
from hydro2d.physics.fracture import open_void, share_that_stays, tension_limit
from hydro2d.physics.kinematics import divergence
from hydro2d.physics.stress import largest_principal, release, von_mises
from hydro2d.physics.viscosity import (
    length_along,
    smoothness,
    strongest_compression,
)
from hydro2d.physics.waves import crossing_step, volume_step
from strength.dispatch import end_at_melt, feels_temperature, modulus_row

#: least square of the speed of sound in an elastic energy, (m/s)^2
SOUND_FLOOR = 1.0


@not_inlined
def insert_void_row(m, j, w):
    """Inserts void in the cells of row j that body m fills and that fracture; returns its volume.

    Void opens until p(rho*, e) = 0, at most max_opening of the cell in a cycle; the deviator is set to zero (explanation/
    fracture).

    Updates  vof [m, j, i], q (rho, deviators and failure record) [k, m, j, i]
    """
    model, par, memory = w.models[m, EOS], w.materials[m, EOS_AT:], w.models[m, MEMORY]
    tensile, fades = w.materials[m, TENSILE], w.materials[m, FADES]
    first, number = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    opened = 0.0
    for x in range(number):
        i = first + x
        rho, e = w.q[RHO, m, j, i], w.q[E, m, j, i]
        internal = w.q[memory:, m, j, i]
        p = evaluate(model, rho, e, internal, par)[0]
        if w.vof[m, j, i] == 1.0 and p < -tension_limit(tensile, fades, w.q[DMG, m, j, i]):
            share = share_that_stays(rho, zero_pressure_density(model, rho, e, internal, par), w.max_opening)
            opened += (1.0 - share) * w.metrics[VOL_R, i] * w.dz[j]
            open_void(m, j, i, share, w.vof, w.q)
            release(m, j, i, w.q)
            if w.models[m, RECORD] > 0 and w.q[DMG, m, j, i] < 1.0:
                w.q[w.models[m, RECORD], m, j, i] = BY_TENSION
    return opened


@not_inlined
def fail_row(m, j, w):
    """Makes body m fail in the cells of row j in which its largest principal stress exceeds its fracture stress.

    Failed material never has a deviator or carries tension again (explanation/fracture).

    Reads    vof, pm [m, j, i];  updates  q (damage, deviators, failure record) [k, m, j, i]
    """
    most_stress = w.materials[m, MOST_STRESS]
    first, number = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    for x in range(number):
        i = first + x
        if not (w.vof[m, j, i] > 0.0 and w.q[DMG, m, j, i] < 1.0):
            continue
        stress = largest_principal(w.q[SRR, m, j, i], w.q[SZZ, m, j, i], w.q[SRZ, m, j, i]) - w.pm[m, j, i]
        if stress > most_stress:
            w.q[DMG, m, j, i] = FAILED
            release(m, j, i, w.q)
            if w.models[m, RECORD] > 0:
                w.q[w.models[m, RECORD], m, j, i] = BY_TENSION


@not_inlined
def report_row(m, j, w):
    """Counts the cells of row j in which body m is not finite.

    Updates  bad [j, :3]: their number, the column and body of the first
    """
    first, number = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    for x in range(number):
        i = first + x
        good = w.q[RHO, m, j, i] > 0.0 and abs(w.pm[m, j, i]) < 1e300 and abs(w.q[EP, m, j, i]) < 1e300
        if w.vof[m, j, i] > 0.0 and not good:
            w.bad[j, 1] = i if w.bad[j, 0] == 0 else w.bad[j, 1]
            w.bad[j, 2] = m if w.bad[j, 0] == 0 else w.bad[j, 2]
            w.bad[j, 0] += 1


@rowwise
def add_row(m, j, b, w):
    """Adds body m's part of pressure, compressibility, density and fraction to the cells of row j, and its wave speed squared.

    Reads    vof, pm [m, j, i]; q (rho) [k, m, j, i]; scratch [0, b, i], shear modulus, ignored at or below the cutoff density
    Updates  km [m, j, i], the square of the sound speed and then the bulk modulus; p, bulk (1/K), rhobar, solid,
             cl (squared) [j, i]
    """
    cutoff_density = w.materials[m, CUTOFF_DENSITY]
    first, number = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
    f_j = w.vof[m, j]
    r_j = w.q[RHO, m, j]
    pm_j = w.pm[m, j]
    km_j = w.km[m, j]
    p_j = w.p[j]
    bulk_j = w.bulk[j]
    rhobar_j = w.rhobar[j]
    solid_j = w.solid[j]
    cl_j = w.cl[j]
    shear_j = w.scratch[0, b]
    for x in range(number):
        i = first + x
        f = f_j[i]
        there = f > 0.0
        rho = r_j[i] if there else 1.0
        c2 = km_j[i]
        modulus = shear_j[i] if rho > cutoff_density else 0.0
        stiffness = rho * c2
        km_j[i] = stiffness
        p_j[i] += f * pm_j[i]
        bulk_j[i] += f / stiffness if there else 0.0
        rhobar_j[i] += f * rho
        solid_j[i] += f
        cl_j[i] = max(cl_j[i], c2 + 4.0 / 3.0 * modulus / rho if there else 0.0)


@rowwise
def pressures_row(j, b, w):
    """Equation of state of every body, void inserted in pure cells that fracture, and the sums over a cell.

    p = sum f_m p_m;  rhobar = sum f_m rho_m;  1/bulk = sum f_m / K_m (explanation/equation-of-state, mixed-cells);
    A body at or below its cutoff density, or one that has melted, is not a solid and has no shear modulus.
    cl = max over bodies of sqrt((K + 4 G/3)/rho), for the time step.
    A pure cell below its fracture pressure is given void (`insert_void_row`); one above its fracture stress fails.

    Reads    q (rho, e, damage) [k, m, j, i], body_range [m, j, 2]
    Updates  vof [m, j, i], q (rho, deviators, damage and failure record where a cell fractures)
    Writes   pm, km, tm [m, j, i] (tm of bodies whose models use temperature); p, bulk, rhobar, solid, cl [j, i]; opened [j]
             volume of new void; bad [j, :3] count of cells that are not finite, the column and body of the first
    Scratch  scratch [s, b, i]
    """
    lo, n = columns(w.active_range[j, 0], w.active_range[j, 1])
    p_j = w.p[j]
    bulk_j = w.bulk[j]
    rhobar_j = w.rhobar[j]
    solid_j = w.solid[j]
    cl_j = w.cl[j]
    shear_j = w.scratch[0, b]
    for x in range(n):
        i = lo + x
        p_j[i] = 0.0
        bulk_j[i] = 0.0
        rhobar_j[i] = 0.0
        solid_j[i] = 0.0
        cl_j[i] = 0.0
    new_void = 0.0
    w.bad[j, 0] = 0
    for m in range(w.vof.shape[0]):
        model = w.models[m, EOS]
        memory = w.models[m, MEMORY]
        par = w.materials[m, EOS_AT:]
        tensile, fades = w.materials[m, TENSILE], w.materials[m, FADES]
        f_j = w.vof[m, j]
        r_j = w.q[RHO, m, j]
        e_j = w.q[E, m, j]
        d_j = w.q[DMG, m, j]
        ep_j = w.q[EP, m, j]
        pm_j = w.pm[m, j]
        km_j = w.km[m, j]
        tm_j = w.tm[m, j]
        # Step 1: pressure and bulk modulus of the body, and fracture; again where a cell has fractured
        first, number = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        for attempt in range(2):
            if model in WITH_MEMORY:
                pressure_row_with_memory(model, par, w.sound_floor, m, j, memory, first, number, w.vof, w.q, w.pm, w.km)
            else:
                pressure_row(model, par, w.sound_floor, first, number, f_j, r_j, e_j, d_j, pm_j, km_j)
            if attempt == 0 and w.materials[m, MOST_STRESS] < inf:
                fail_row(m, j, w)
            fractured = 0
            wrong = 0
            for x in range(number):
                i = first + x
                fractures = f_j[i] == 1.0 and (pm_j[i] < -tension_limit(tensile, fades, d_j[i]) or d_j[i] >= 1.0)
                good = r_j[i] > 0.0 and abs(pm_j[i]) < 1e300 and abs(ep_j[i]) < 1e300
                fractured += 1 if fractures else 0
                wrong += 0 if good or f_j[i] == 0.0 else 1
            if fractured == 0 or attempt == 1:
                break
            new_void += insert_void_row(m, j, w)
        if wrong > 0:
            report_row(m, j, w)
        # Step 2: temperature, and the shear modulus at that temperature
        line = w.materials[m, MELTING_AT:EOS_AT]
        if feels_temperature(w.models[m, STRENGTH], w.models[m, DAMAGE], line):
            if model in WITH_MEMORY:
                temperature_row_with_memory(model, par, m, j, memory, first, number, w.vof, w.q, w.tm)
            else:
                temperature_row(model, par, first, number, f_j, r_j, e_j, tm_j)
        modulus_row(w.models[m, STRENGTH], w.materials[m, STRENGTH_AT:DAMAGE_AT], first, number, pm_j, r_j, tm_j, shear_j)
        end_at_melt(line, first, number, r_j, tm_j, shear_j)
        # Step 3: the share of the body in the sums over a cell
        add_row(m, j, b, w)
    # Step 4: bulk modulus of full cells, 0 where there is void, and the longitudinal wave speed
    for x in range(n):
        i = lo + x
        full = solid_j[i] > 1.0 - 1e-12
        bulk_j[i] = 1.0 / bulk_j[i] if full and bulk_j[i] > 0.0 else 0.0
        cl_j[i] = sqrt(cl_j[i])
    w.opened[j] = new_void


@point
def row_minimum(a, first, number):
    """Least of a[first:first + number], 1e300 where there is none; a NaN is ignored. In four lanes, for speed."""
    a0, a1, a2, a3 = 1e300, 1e300, 1e300, 1e300
    whole = number // 4
    for x in range(whole):
        i = first + 4 * x
        a0, a1 = min(a[i], a0), min(a[i + 1], a1)
        a2, a3 = min(a[i + 2], a2), min(a[i + 3], a3)
    for x in range(4 * whole, number):
        a0 = min(a[first + x], a0)
    return min(min(a0, a1), min(a2, a3))


@rowwise
def viscosity_row(j, w):
    """Artificial viscosity along the direction n of the strongest compression in the plane: the stress q n n, no hoop stress.

    q depends on the difference of the velocity along n over the cell, at most on the loss of volume times its length. It is
    switched off where the velocity along n is smooth along r and z, each by its share of n. A shock oblique to the mesh is as
    wide as one along it, and a converging front heats no material that it has not reached (explanation/lagrangian-step,
    equation 11a).

    Reads    u, v [b, j, i]; rhobar, bulk, solid, cl [j, i]; dt, the last step
    Writes   qr, qz, qt, qrz [j, i]
    """
    lo, n = columns(w.active_range[j, 0], w.active_range[j, 1])
    ubb = w.u[0, j - 1]
    ub = w.u[0, j]
    ut = w.u[0, j + 1]
    utt = w.u[0, j + 2]
    vbb = w.v[0, j - 1]
    vb = w.v[0, j]
    vt = w.v[0, j + 1]
    vtt = w.v[0, j + 2]
    qr_j = w.qr[j]
    qz_j = w.qz[j]
    qt_j = w.qt[j]
    qrz_j = w.qrz[j]
    rho_j = w.rhobar[j]
    cl_j = w.cl[j]
    bulk_j = w.bulk[j]
    solid_j = w.solid[j]
    h = w.dz[j]
    for x in range(n):
        i = lo + x
        void = rho_j[i] == 0.0
        rho = 1.0 if void else rho_j[i]
        du = 0.5 * ((ub[i + 1] - ub[i]) + (ut[i + 1] - ut[i]))
        du_l = 0.5 * ((ub[i] - ub[i - 1]) + (ut[i] - ut[i - 1]))
        du_r = 0.5 * ((ub[i + 2] - ub[i + 1]) + (ut[i + 2] - ut[i + 1]))
        dv = 0.5 * ((vt[i] - vb[i]) + (vt[i + 1] - vb[i + 1]))
        dv_b = 0.5 * ((vb[i] - vbb[i]) + (vb[i + 1] - vbb[i + 1]))
        dv_t = 0.5 * ((vtt[i] - vt[i]) + (vtt[i + 1] - vt[i + 1]))
        # change of the other component: u along z, v along r
        su = 0.5 * ((ut[i] - ub[i]) + (ut[i + 1] - ub[i + 1]))
        su_b = 0.5 * ((ub[i] - ubb[i]) + (ub[i + 1] - ubb[i + 1]))
        su_t = 0.5 * ((utt[i] - ut[i]) + (utt[i + 1] - ut[i + 1]))
        sv = 0.5 * ((vb[i + 1] - vb[i]) + (vt[i + 1] - vt[i]))
        sv_l = 0.5 * ((vb[i] - vb[i - 1]) + (vt[i] - vt[i - 1]))
        sv_r = 0.5 * ((vb[i + 2] - vb[i + 1]) + (vt[i + 2] - vt[i + 1]))
        rate, n_r, n_z = strongest_compression(du / w.dr[i], dv / h, 0.5 * (su / h + sv / w.dr[i]))
        loss = -divergence(i, ub, ut, vb, vt, w.metrics, w.dz[j])
        length = length_along(n_r, n_z, w.dr[i], w.dz[j])
        jump = max(rate, -max(loss, 0.0)) * length
        psi_r = smoothness(n_r * du_l + n_z * sv_l, n_r * du + n_z * sv, n_r * du_r + n_z * sv_r)
        psi_z = smoothness(n_r * su_b + n_z * dv_b, n_r * su + n_z * dv, n_r * su_t + n_z * dv_t)
        psi = n_r * n_r * psi_r + n_z * n_z * psi_z
        q = 0.0 if void else viscosity(rho, bulk_j[i], cl_j[i], solid_j[i], jump, length, psi, w)
        qr_j[i] = q * (n_r * n_r)
        qz_j[i] = q * (n_z * n_z)
        qrz_j[i] = q * (n_r * n_z)
        qt_j[i] = 0.0


@point
def step_limits(j, i, w):
    """Four bounds of the time step in cell (j, i), s, in the order of CAUSES (explanation/lagrangian-step).

    Axial velocities count relative to the mesh, which travels at mesh_speed (explanation/following-mesh).
    """
    ub = w.u[0, j]
    ut = w.u[0, j + 1]
    vb = w.v[0, j]
    vt = w.v[0, j + 1]
    rho = w.rhobar[j, i] if w.rhobar[j, i] != 0.0 else 1.0
    sound = limit_of_sound(j, i, rho, max(w.qr[j, i], w.qz[j, i]), w)
    radial = crossing_step(w.advective_courant, w.dr[i], ub[i], ub[i + 1], ut[i], ut[i + 1])
    axial = crossing_step(w.advective_courant, w.dz[j], vb[i] - w.mesh_speed, vb[i + 1] - w.mesh_speed,
                          vt[i] - w.mesh_speed, vt[i + 1] - w.mesh_speed)
    return sound, radial, axial, volume_step(-divergence(i, ub, ut, vb, vt, w.metrics, w.dz[j]))


@cell_rows
def limit_step(j, part, w):
    """Time step that every cell allows, and the coefficient of its hourglass filter.

    dt <= courant min(dr, dz)/sqrt(c_l^2 + 2 q/rho), less in a shock, and at most a share of the largest stable step
    (`sound_step`);
    |u| dt <= advective_courant dx, |div u| dt <= 0.2 in compression
    (explanation/lagrangian-step).

    Reads    u, v [b, j, i]; rhobar, cl, qr, qz [j, i]
    Writes   hg_coefficient [j, i], coefficient of the hourglass filter, kg/s; row_step [j], the least of a row;
             bad [j, 3] velocities that are not finite
    Scratch  scratch [s, b, i]
    """
    lo, n = columns(w.active_range[j, 0], w.active_range[j, 1])
    ub = w.u[0, j]
    ut = w.u[0, j + 1]
    vb = w.v[0, j]
    vt = w.v[0, j + 1]
    rho_j = w.rhobar[j]
    cl_j = w.cl[j]
    step_j = w.scratch[1, part]
    hg_j = w.hg_coefficient[j]
    wrong = 0
    for x in range(n):
        i = lo + x
        void = rho_j[i] == 0.0
        du = (ub[i + 1] - ub[i]) + (ut[i + 1] - ut[i])
        dv = (vt[i] - vb[i]) + (vt[i + 1] - vb[i + 1])
        sound, radial, axial, volume = step_limits(j, i, w)
        hg_j[i] = 0.25 * w.hourglass * rho_j[i] * cl_j[i] * w.metrics[VOL_R, i] * w.dz[j] / max(w.dr[i], w.dz[j])
        step_j[i] = 1e300 if void else min(min(sound, radial), min(axial, volume))
        wrong += 0 if void or (abs(du) < 1e300 and abs(dv) < 1e300) else 1
    w.row_step[j] = min(w.row_step[j], row_minimum(step_j, lo, n))
    w.bad[j, 3] = wrong


@serial
def least_step(w):
    """Row of the least time step, and the first rows with cells and with velocities that are not finite, -1 for none.

    Reads    row_step [j], bad [j, 4]
    Writes   least_row [3]
    """
    j0, j1 = outer_rows(w.parts)
    w.least_row[0], w.least_row[1], w.least_row[2] = j0, -1, -1
    for j in range(j1 - 1, j0 - 1, -1):
        w.least_row[0] = j if w.row_step[j] <= w.row_step[w.least_row[0]] else w.least_row[0]
        w.least_row[1] = j if w.bad[j, 0] > 0 else w.least_row[1]
        w.least_row[2] = j if w.bad[j, 3] > 0 else w.least_row[2]


@serial
def step_cause(w):
    """Cell that sets the least time step, in the row of that step, and the bound that sets it.

    Reads    as limit_step; least_row [3]
    Writes   cause [2]: index into CAUSES, column
    """
    j = w.least_row[0]
    best = 1e300
    for i in range(w.active_range[j, 0], w.active_range[j, 1]):
        if w.rhobar[j, i] > 0.0:
            limits = step_limits(j, i, w)
            for k in range(4):
                if limits[k] < best:
                    best = limits[k]
                    w.cause[0] = k
                    w.cause[1] = i


@point
def elastic_energy(m, j, i, shear, model, memory, par, q):
    """Elastic energy of body m in cell (j, i), J/kg: p^2/(2 K rho) + q^2/(6 G rho), with the von Mises stress q."""
    rho = q[RHO, m, j, i]
    p, dpdrho, dpde, _ = evaluate(model, rho, q[E, m, j, i], q[memory:, m, j, i], par)
    modulus = rho * sound_speed_squared(rho, p, dpdrho, dpde, SOUND_FLOOR)
    mises = von_mises(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i])
    return (0.5 * p * p / modulus + (mises * mises / (6.0 * shear) if shear > 0.0 else 0.0)) / rho


@serial
def worst_energies(g, nz, nr, m, sliver, lowest, highest, plastic, most_strain, shear, warm, chill, model, memory, par, volume,
                   vof, q, worst):
    """Cells in which the energy of body m is farthest above and below the range that it can reach there, those at 0 K included,
    and how much lies beyond the range in all cells.

    Cells filled by less than `sliver` do not count. The elastic energy of a cell's own stress, with the shear modulus `shear`
    in Pa, does not count as heat. A body that begins `warm` may be `chill` J/kg below 0 K; any other may be at 0 K.

    Reads    volume [j, i]; vof [m, j, i]; q [k, m, j, i]
    Writes   worst [2, 5], of the hottest and the coldest: J/kg beyond the range (0 or less within it), row, column; of all
             cells beyond it that energy, J per radian, and the mass of the body in them, kg per radian
    """
    for side in range(2):
        worst[side, 0] = -1e300
        worst[side, 3] = 0.0
        worst[side, 4] = 0.0
    for j in range(g, g + nz):
        for i in range(g, g + nr):
            if vof[m, j, i] < sliver:
                continue
            e = q[E, m, j, i]
            cold = lowest - e
            if warm and e < -chill and evaluate(model, q[RHO, m, j, i], e, q[memory:, m, j, i], par)[3] <= 0.0:
                cold = max(cold, -e)
            hot = e - (highest + plastic * min(q[EP, m, j, i], most_strain))
            if hot > 0.0:
                hot -= elastic_energy(m, j, i, shear, model, memory, par, q)
            for side in range(2):
                beyond = cold if side else hot
                beyond = beyond if beyond == beyond else 1e300
                if beyond > 0.0:
                    mass = q[RHO, m, j, i] * vof[m, j, i] * volume[j, i]
                    worst[side, 3] += beyond * mass
                    worst[side, 4] += mass
                if beyond > worst[side, 0]:
                    worst[side, 0] = beyond
                    worst[side, 1] = j
                    worst[side, 2] = i
