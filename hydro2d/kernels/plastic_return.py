"""Return of one body's deviator to its yield surface in one cell, with the resulting plastic strain and damage."""

from hydro2d.jit import point
from hydro2d.materials.rows import DAMAGE, DAMAGE_AT, FACTOR, RECORD, STRENGTH, STRENGTH_AT, TENSILE
from hydro2d.mesh.fields import BY_DAMAGE, DMG, EP, RHO
from hydro2d.physics.fracture import crushed, damaged
from hydro2d.physics.plasticity import from_centre, keep_internal, returned, take_internal
from hydro2d.physics.stress import von_mises
from strength.dispatch import WEAKENS, damage_increment, flow_stress, kinematic_modulus, size_factor, weakened
from strength.radial_return import plastic_increment


@point
def flow(m, j, i, dep, final, w):
    """Adds the plastic strain ``dep`` of the step to body m in cell (j, i), at the flow stress ``final`` (Pa), and its damage.

    Updates  q (plastic strain, damage, failure record) [k, m, j, i]
    """
    w.q[EP, m, j, i] += dep
    increment = damage_increment(w.models[m, DAMAGE], dep, dep / w.dt, w.tm[m, j, i], w.pm[m, j, i], final,
                                 w.materials[m, DAMAGE_AT:TENSILE])
    increment *= size_factor(w.models[m, DAMAGE], w.dr[i] * w.dz[j], w.materials[m, DAMAGE_AT:TENSILE])
    before = w.q[DMG, m, j, i]
    if w.models[m, STRENGTH] in WEAKENS:
        w.q[DMG, m, j, i] = crushed(w.q[DMG, m, j, i], increment)
    else:
        w.q[DMG, m, j, i] = damaged(w.q[DMG, m, j, i], increment)
    if w.models[m, RECORD] > 0 and before < 1.0 <= w.q[DMG, m, j, i]:
        w.q[w.models[m, RECORD], m, j, i] = BY_DAMAGE


@point
def weaken(m, j, i, dep, final, stiffness, w):
    """(dep, final) of `plastic_increment` for body m in cell (j, i), weakened by the damage of the step as well.

    The stress falls to the flow stress at the damage that the strain ``dep`` makes, so that the elastic energy is lost in the
    step in which damage grows (explanation/strength, equation 15).

    Updates  q (plastic strain, damage) [k, m, j, i]
    """
    model, par = w.models[m, STRENGTH], w.materials[m, STRENGTH_AT:DAMAGE_AT]
    flow(m, j, i, dep, final, w)
    intact = flow_stress(model, w.q[EP, m, j, i], dep / w.dt, w.tm[m, j, i], w.pm[m, j, i], w.q[RHO, m, j, i], par)
    weak = w.materials[m, FACTOR] * weakened(model, intact, dep / w.dt, w.pm[m, j, i], w.q[DMG, m, j, i], par)
    further = max(final - weak, 0.0) / (3.0 * stiffness)
    w.q[EP, m, j, i] += further
    return dep + further, min(final, weak)


@point
def return_to_surface(m, j, i, rr, zz, rz, modulus, own, cell_yield, w):
    """(rr, zz, rz, dep, final): deviator of body m in cell (j, i) after its return, plastic strain, flow stress (Pa).

    ``own``: to the body's own yield surface; else to the flow stress ``cell_yield`` of its cell (Pa). The arguments rr, zz and
    rz are the elastic trial, ``modulus`` is its shear modulus, Pa (explanation/strength, equations 4 and 12).

    Updates  q (plastic strain, damage, internal variables) [k, m, j, i];  scratch internal [j, k]
    """
    model, par = w.models[m, STRENGTH], w.materials[m, STRENGTH_AT:DAMAGE_AT]
    internal = w.internal[j]
    take_internal(m, j, i, model, w.q, internal)
    x_rr, x_zz, x_rz = from_centre(rr, zz, rz, model, internal)
    trial = von_mises(x_rr, x_zz, x_rz)
    stiffness = modulus + kinematic_modulus(model, par) / 3.0
    dep, final = 0.0, trial
    if own:
        dep, final = plastic_increment(model, trial, w.q[EP, m, j, i], w.dt, w.tm[m, j, i], w.pm[m, j, i], w.q[RHO, m, j, i],
                                       stiffness, w.materials[m, FACTOR], par, w.q[DMG, m, j, i])
    elif trial > cell_yield:
        final = cell_yield
        dep = (trial - final) / (3.0 * stiffness) if modulus > 0.0 else 0.0
    if dep == 0.0:
        return rr, zz, rz, dep, final
    weakens = own and model in WEAKENS
    if weakens:
        dep, final = weaken(m, j, i, dep, final, stiffness, w)
    rr, zz, rz = returned(x_rr, x_zz, x_rz, trial, dep, final, model, par, internal)
    keep_internal(m, j, i, model, internal, w.q)
    if not weakens:
        flow(m, j, i, dep, final, w)
    return rr, zz, rz, dep, final
