"""Pressure, sound speed, artificial viscosity and the local time step, in one pass over the rows."""

from math import sqrt

from eos.dispatch import evaluate, sound_speed_squared, zero_pressure_density
from hydro2d.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.jit import kernel, point, prange
from strength.dispatch import shear_modulus

#: what set the time step, in the order of the codes that `pressures` writes
CAUSES = ("sound", "radial velocity", "axial velocity", "volume change")

SOUND_FLOOR = 1.0  # (1 m/s)^2


@point
def smoothness(left, centre, right):
    """Christensen's limiter psi: 1 where the velocity slope is smooth, 0 at an extremum or beside no slope.

    left, centre, right are the velocity differences over three neighbouring cells (explanation/lagrangian-step).
    """
    inverse = 1.0 / centre if centre != 0.0 else 0.0
    a, b = left * inverse, right * inverse
    return max(0.0, min(min(1.0, 0.5 * (a + b)), min(2.0 * a, 2.0 * b)))


@point
def directional_viscosity(rho, c, du, psi, linear, quadratic):
    """q = (1 - psi) rho (c2 du^2 + c1 c |du|) against a compression du < 0; von Neumann-Richtmyer with Landshoff's term."""
    jump = max(-du, 0.0)
    return (1.0 - psi) * rho * jump * (quadratic * jump + linear * c)


@kernel
def pressures(j0, j1, max_opening, vol_r, dz, span, reach, eos_model, eos_par, strength_model, strength_par,
              fracture_pressure, loose, vof, q, pm, km, tm, p, bulk, rhobar, solid, cl, opened, bad):
    """Equation of state of every body, void opened in pure cells that tear, and the sums over a cell.

    p = sum f_m p_m;  rhobar = sum f_m rho_m;  1/bulk = sum f_m / K_m (explanation/equation-of-state, mixed-cells);
    Below its density loose[m] a body is no solid any more and has no shear modulus.
    cl = max over bodies of sqrt((K + 4 G/3)/rho), for the time step.
    A pure cell below its fracture pressure is given void until p(rho*, e) = 0, at most max_opening of it in a cycle,
    and its deviator is set to zero (explanation/fracture).

    Reads    q (rho, e, damage) [k, m, j, i], span [m, j, 2], fracture_pressure, loose [m]
    Updates  vof [m, j, i], q (rho and deviators where a cell tears)
    Writes   pm, km, tm [m, j, i]; p, bulk, rhobar, solid, cl [j, i]; opened [j] volume of new void; bad [j, 3] count of
             cells that are not finite, the column and body of the first
    """
    bodies = vof.shape[0]
    for j in prange(j0, j1):
        lo = reach[j, 0]
        hi = reach[j, 1]
        p_j = p[j]
        bulk_j = bulk[j]
        rho_j = rhobar[j]
        solid_j = solid[j]
        cl_j = cl[j]
        for i in range(lo, hi):
            p_j[i] = 0.0
            bulk_j[i] = 0.0
            rho_j[i] = 0.0
            solid_j[i] = 0.0
            cl_j[i] = 0.0
        new_void = 0.0
        wrong = 0
        wrong_i = 0
        wrong_m = 0
        for m in range(bodies):
            model = eos_model[m]
            par = eos_par[m]
            smodel = strength_model[m]
            spar = strength_par[m]
            f_j = vof[m, j]
            r_j = q[RHO, m, j]
            e_j = q[E, m, j]
            d_j = q[DMG, m, j]
            pm_j = pm[m, j]
            km_j = km[m, j]
            tm_j = tm[m, j]
            for i in range(span[m, j, 0], span[m, j, 1]):
                f = f_j[i]
                rho = r_j[i]
                e = e_j[i]
                if f == 0.0:
                    continue
                pressure, dpdrho, dpde, temperature = evaluate(model, rho, e, par)
                threshold = fracture_pressure[m] if d_j[i] < 1.0 else 0.0
                if f == 1.0 and pressure < -threshold:
                    target = max(zero_pressure_density(model, rho, e, par), rho)
                    f = max(rho / target, 1.0 - max_opening)
                    rho = rho / f
                    new_void += (1.0 - f) * vol_r[i] * dz[j]
                    f_j[i] = f
                    r_j[i] = rho
                    q[SRR, m, j, i] = 0.0
                    q[SZZ, m, j, i] = 0.0
                    q[SRZ, m, j, i] = 0.0
                    pressure, dpdrho, dpde, temperature = evaluate(model, rho, e, par)
                if d_j[i] >= 1.0:
                    pressure = max(pressure, 0.0)
                c2 = sound_speed_squared(rho, pressure, dpdrho, dpde, SOUND_FLOOR)
                if not (rho > 0.0 and abs(pressure) < 1e300 and abs(q[EP, m, j, i]) < 1e300):
                    wrong_i = i if wrong == 0 else wrong_i
                    wrong_m = m if wrong == 0 else wrong_m
                    wrong += 1
                modulus = shear_modulus(smodel, pressure, rho, temperature, spar) if rho > loose[m] else 0.0
                pm_j[i] = pressure
                km_j[i] = rho * c2
                tm_j[i] = temperature
                p_j[i] += f * pressure
                bulk_j[i] += f / (rho * c2)
                rho_j[i] += f * rho
                solid_j[i] += f
                cl_j[i] = max(cl_j[i], c2 + 4.0 / 3.0 * modulus / rho)
        for i in range(lo, hi):
            full = solid_j[i] > 1.0 - 1e-12
            bulk_j[i] = 1.0 / bulk_j[i] if full and bulk_j[i] > 0.0 else 0.0
            cl_j[i] = sqrt(cl_j[i])
        opened[j] = new_void
        bad[j, 0] = wrong
        bad[j, 1] = wrong_i
        bad[j, 2] = wrong_m


@kernel
def viscosity_and_step(j0, j1, linear, quadratic, courant, advective, dr, dz, vol_r, face_r, az_in, az_out, reach, u, v,
                       rhobar, bulk, cl, qr, qz, row_dt, row_cause, row_bad):
    """Artificial viscosity direction by direction, and the smallest time step of each row.

    q_r answers only to the radial difference du, q_z only to the axial one (a shock along z must not see dr), and neither to
    more than the loss of volume, |div u| dx: at a stagnation point, where one direction gives what the other takes, there is
    no shock and no q. Christensen's limiter switches both off where the velocity is smooth. dt <= courant min(dr,
    dz)/sqrt(c_l^2 + 2 q/rho),
    |u| dt <= advective dx, |div u| dt <= 0.2 in compression (explanation/lagrangian-step).

    Reads    u, v [b, j, i]; rhobar, bulk, cl [j, i]
    Writes   qr, qz [j, i]; row_dt [j], row_cause [j, 2] (cause, column); row_bad [j] velocities that are not finite
    """
    for j in prange(j0, j1):
        lo = reach[j, 0]
        hi = reach[j, 1]
        ub = u[0, j]
        ut = u[0, j + 1]
        vbb = v[0, j - 1]
        vb = v[0, j]
        vt = v[0, j + 1]
        vtt = v[0, j + 2]
        qr_j = qr[j]
        qz_j = qz[j]
        rho_j = rhobar[j]
        cl_j = cl[j]
        bulk_j = bulk[j]
        h = dz[j]
        best = 1e300
        cause = 0
        where = lo
        wrong = 0
        for i in range(lo, hi):
            rho = rho_j[i]
            if rho == 0.0:
                qr_j[i] = 0.0
                qz_j[i] = 0.0
                continue
            du = 0.5 * ((ub[i + 1] - ub[i]) + (ut[i + 1] - ut[i]))
            du_l = 0.5 * ((ub[i] - ub[i - 1]) + (ut[i] - ut[i - 1]))
            du_r = 0.5 * ((ub[i + 2] - ub[i + 1]) + (ut[i + 2] - ut[i + 1]))
            dv = 0.5 * ((vt[i] - vb[i]) + (vt[i + 1] - vb[i + 1]))
            dv_b = 0.5 * ((vb[i] - vbb[i]) + (vb[i + 1] - vbb[i + 1]))
            dv_t = 0.5 * ((vtt[i] - vt[i]) + (vtt[i + 1] - vt[i + 1]))
            inward = face_r[i + 1] * (ub[i + 1] + ut[i + 1]) - face_r[i] * (ub[i] + ut[i])
            c = bulk_j[i] / rho
            c = sqrt(c) if c > 0.0 else cl_j[i]
            shrink = -(0.5 * inward * h + az_in[i] * (vt[i] - vb[i]) + az_out[i] * (vt[i + 1] - vb[i + 1])) / (vol_r[i] * h)
            du_q = max(du, -max(shrink, 0.0) * dr[i])
            dv_q = max(dv, -max(shrink, 0.0) * h)
            qr_j[i] = directional_viscosity(rho, c, du_q, smoothness(du_l, du, du_r), linear, quadratic)
            qz_j[i] = directional_viscosity(rho, c, dv_q, smoothness(dv_b, dv, dv_t), linear, quadratic)
            speed = sqrt(cl_j[i] * cl_j[i] + 2.0 * max(qr_j[i], qz_j[i]) / rho)
            t = courant * min(dr[i], h) / speed
            if t < best:
                best, cause, where = t, 0, i
            fastest = max(max(abs(ub[i]), abs(ub[i + 1])), max(abs(ut[i]), abs(ut[i + 1])))
            if advective * dr[i] < best * fastest:
                best, cause, where = advective * dr[i] / fastest, 1, i
            fastest = max(max(abs(vb[i]), abs(vb[i + 1])), max(abs(vt[i]), abs(vt[i + 1])))
            if advective * h < best * fastest:
                best, cause, where = advective * h / fastest, 2, i
            if 0.2 < best * shrink:
                best, cause, where = 0.2 / shrink, 3, i
            if not (abs(du) < 1e300 and abs(dv) < 1e300):
                wrong += 1
        row_dt[j] = best
        row_cause[j, 0] = cause
        row_cause[j, 1] = where
        row_bad[j] = wrong
