"""Equations of state with memory: what a Lagrangian step begins with is kept; at its end the models update their variables."""

from eos.dispatch import WITH_MEMORY, update
from hydro2d.jit import kernel, point
from hydro2d.kernels.column_ranges import columns
from hydro2d.materials.rows import DAMAGE_AT, EOS, EOS_AT, MEMORY, STRENGTH, STRENGTH_AT
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.stress import von_mises
from strength.dispatch import modulus_row

#: rows of `before`
DENSITY, STRAIN, DAMAGED, ELASTIC = range(4)


@point
def elastic_energy(stress, shear):
    """Elastic energy of a deviator of this von Mises norm, J/m^3: stress^2/(6 G), both in Pa; none without a modulus."""
    return stress * stress / (6.0 * shear) if shear > 0.0 else 0.0


@kernel
def remember(part, parts, body_range, models, materials, pm, tm, q, scratch, before):
    """Keeps what the step begins with, of bodies whose equation of state has internal variables.

    Reads    pm, tm [m, j, i]; q [k, m, j, i]
    Writes   before [4, m, j, i], rows DENSITY to ELASTIC
    Scratch  scratch [0, part, i], shear modulus
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(before.shape[1]):
            if models[m, EOS] not in WITH_MEMORY:
                continue
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            modulus_row(models[m, STRENGTH], materials[m, STRENGTH_AT:DAMAGE_AT], first, n, pm[m, j], q[RHO, m, j], tm[m, j],
                        scratch[0, part])
            for x in range(n):
                i = first + x
                before[DENSITY, m, j, i] = q[RHO, m, j, i]
                before[STRAIN, m, j, i] = q[EP, m, j, i]
                before[DAMAGED, m, j, i] = q[DMG, m, j, i]
                before[ELASTIC, m, j, i] = elastic_energy(von_mises(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i]),
                                                          scratch[0, part, i])


@kernel
def update_memory(part, parts, time, dt, body_range, models, materials, pm, tm, before, vof, q, scratch):
    """The internal variables of equations of state at the end of the step (`eos.dispatch.update`).

    The plastic work is the strain increment at the stress to which the deviator has returned. time is that at the end.

    Reads    pm, tm, vof [m, j, i]; before [4, m, j, i]
    Updates  q (internal variables) [k, m, j, i]
    Scratch  scratch [0, part, i], shear modulus
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(before.shape[1]):
            model, first_row = models[m, EOS], models[m, MEMORY]
            par = materials[m, EOS_AT:]
            if model not in WITH_MEMORY:
                continue
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            modulus_row(models[m, STRENGTH], materials[m, STRENGTH_AT:DAMAGE_AT], first, n, pm[m, j], q[RHO, m, j], tm[m, j],
                        scratch[0, part])
            for x in range(n):
                i = first + x
                if vof[m, j, i] > 0.0:
                    stress = von_mises(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i])
                    dep = q[EP, m, j, i] - before[STRAIN, m, j, i]
                    internal = q[first_row:, m, j, i]
                    update(model, before[DENSITY, m, j, i], q[RHO, m, j, i], q[E, m, j, i], dep, stress * dep,
                           before[DAMAGED, m, j, i], q[DMG, m, j, i], before[ELASTIC, m, j, i],
                           elastic_energy(stress, scratch[0, part, i]), time, dt, par, internal)
