"""Equations of state with memory: what a Lagrangian step begins with is kept; at its end the models update their variables."""

from eos.dispatch import WITH_MEMORY, update
from hydro2d.jit import kernel, point
from hydro2d.kernels.column_ranges import columns
from hydro2d.materials.rows import DAMAGE_AT, EOS, EOS_AT, FACTOR, MEMORY, STRENGTH, STRENGTH_AT
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.stress import von_mises
from strength.dispatch import WEAKENS, flow_stress, shear_modulus, weakened

#: rows of `before`
DENSITY, STRAIN, DAMAGED = range(3)


@kernel
def remember(part, parts, body_range, models, q, before):
    """Keeps what the step begins with, of bodies whose equation of state has internal variables.

    Reads    q [k, m, j, i]
    Writes   before [3, m, j, i], rows DENSITY to DAMAGED
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(before.shape[1]):
            if models[m, EOS] not in WITH_MEMORY:
                continue
            for i in range(body_range[m, j, 0], body_range[m, j, 1]):
                before[DENSITY, m, j, i] = q[RHO, m, j, i]
                before[STRAIN, m, j, i] = q[EP, m, j, i]
                before[DAMAGED, m, j, i] = q[DMG, m, j, i]


@point
def released(m, j, i, rate, damage0, models, materials, pm, tm, q):
    """Elastic energy that growing damage has released, J/m^3: (Y^2(D_0) - Y^2(D_1))/(6 G) (explanation/strength, equation 15).

    rate : that of the plastic strain, 1/s;  damage0 : D_0, before the step
    """
    model, damage = models[m, STRENGTH], q[DMG, m, j, i]
    if model not in WEAKENS or damage <= damage0:
        return 0.0
    par, p, T, rho = materials[m, STRENGTH_AT:DAMAGE_AT], pm[m, j, i], tm[m, j, i], q[RHO, m, j, i]
    intact, shear = flow_stress(model, q[EP, m, j, i], rate, T, p, rho, par), shear_modulus(model, p, rho, T, par)
    strong, weak = weakened(model, intact, rate, p, damage0, par), weakened(model, intact, rate, p, damage, par)
    factor = materials[m, FACTOR] * materials[m, FACTOR]
    return factor * (strong * strong - weak * weak) / (6.0 * shear) if shear > 0.0 else 0.0


@kernel
def update_memory(part, parts, time, dt, body_range, models, materials, pm, tm, before, vof, q):
    """The internal variables of equations of state at the end of the step (`eos.dispatch.update`).

    The plastic work is the strain increment at the stress to which the deviator has returned. time is that at the end.

    Reads    pm, tm, vof [m, j, i]; before [3, m, j, i]
    Updates  q (internal variables) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(before.shape[1]):
            model, first_row = models[m, EOS], models[m, MEMORY]
            par = materials[m, EOS_AT:]
            if model not in WITH_MEMORY:
                continue
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            for x in range(n):
                i = first + x
                if vof[m, j, i] > 0.0:
                    dep, damage0 = q[EP, m, j, i] - before[STRAIN, m, j, i], before[DAMAGED, m, j, i]
                    work = dep * von_mises(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i])
                    update(model, before[DENSITY, m, j, i], q[RHO, m, j, i], q[E, m, j, i], dep, work, damage0,
                           q[DMG, m, j, i], released(m, j, i, dep / dt, damage0, models, materials, pm, tm, q), time, dt, par,
                           q[first_row:, m, j, i])
