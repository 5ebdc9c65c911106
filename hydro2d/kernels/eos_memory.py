"""Equations of state with memory: fields are kept at the start of a Lagrangian step, and variables updated at its end."""

from eos.dispatch import WITH_MEMORY, update
from hydro2d.jit import cell_rows, point
from hydro2d.kernels.column_ranges import columns
from hydro2d.materials.rows import DAMAGE_AT, EOS, EOS_AT, FACTOR, MEMORY, STRENGTH, STRENGTH_AT
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.stress import von_mises
from strength.dispatch import WEAKENS, flow_stress, shear_modulus, weakened

#: rows of `before`
DENSITY, STRAIN, DAMAGED = range(3)


@cell_rows
def remember(j, w):
    """Keeps the fields at the start of the step, for bodies whose equation of state has internal variables.

    Reads    q [k, m, j, i]
    Writes   before [3, m, j, i], rows DENSITY to DAMAGED
    """
    for m in range(w.before.shape[1]):
        if w.models[m, EOS] not in WITH_MEMORY:
            continue
        for i in range(w.body_range[m, j, 0], w.body_range[m, j, 1]):
            w.before[DENSITY, m, j, i] = w.q[RHO, m, j, i]
            w.before[STRAIN, m, j, i] = w.q[EP, m, j, i]
            w.before[DAMAGED, m, j, i] = w.q[DMG, m, j, i]


@point
def released(m, j, i, rate, w):
    """Elastic energy that growing damage has released, J/m^3: (Y^2(D_0) - Y^2(D_1))/(6 G) (explanation/strength, equation 15).

    rate : that of the plastic strain, 1/s
    """
    model, damage0, damage = w.models[m, STRENGTH], w.before[DAMAGED, m, j, i], w.q[DMG, m, j, i]
    if model not in WEAKENS or damage <= damage0:
        return 0.0
    par, p, T, rho = w.materials[m, STRENGTH_AT:DAMAGE_AT], w.pm[m, j, i], w.tm[m, j, i], w.q[RHO, m, j, i]
    intact, shear = flow_stress(model, w.q[EP, m, j, i], rate, T, p, rho, par), shear_modulus(model, p, rho, T, par)
    strong, weak = weakened(model, intact, rate, p, damage0, par), weakened(model, intact, rate, p, damage, par)
    factor = w.materials[m, FACTOR] * w.materials[m, FACTOR]
    return factor * (strong * strong - weak * weak) / (6.0 * shear) if shear > 0.0 else 0.0


@cell_rows
def update_memory(j, w):
    """Internal variables of equations of state at the end of the step (`eos.dispatch.update`).

    The plastic work is the strain increment times the stress to which the deviator has returned. time is that at the end.

    Reads    pm, tm, vof [m, j, i]; before [3, m, j, i]
    Updates  q (internal variables) [k, m, j, i]
    """
    for m in range(w.before.shape[1]):
        model, first_row = w.models[m, EOS], w.models[m, MEMORY]
        par = w.materials[m, EOS_AT:]
        if model not in WITH_MEMORY:
            continue
        first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        for x in range(n):
            i = first + x
            if w.vof[m, j, i] > 0.0:
                dep, damage0 = w.q[EP, m, j, i] - w.before[STRAIN, m, j, i], w.before[DAMAGED, m, j, i]
                work = dep * von_mises(w.q[SRR, m, j, i], w.q[SZZ, m, j, i], w.q[SRZ, m, j, i])
                update(model, w.before[DENSITY, m, j, i], w.q[RHO, m, j, i], w.q[E, m, j, i], dep, work, damage0,
                       w.q[DMG, m, j, i], released(m, j, i, dep / w.dt, w), w.time, w.dt, par,
                       w.q[first_row:, m, j, i])
