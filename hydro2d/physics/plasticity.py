"""What deviators do, how they return to the yield surface, and when there are none."""

from hydro2d.jit import point
from hydro2d.materials.rows import DAMAGE, DAMAGE_AT, FACTOR, STRENGTH, STRENGTH_AT, TENSILE
from hydro2d.mesh.fields import DMG, EP, INTERNAL, RHO
from hydro2d.physics.fracture import damaged
from hydro2d.physics.stress import von_mises
from strength.dispatch import WITH_INTERNAL, back_stress, damage_increment, harden, kinematic_modulus
from strength.radial_return import plastic_increment


@point
def deviator_power(rr, zz, rz, d_rr, d_zz, d_tt, d_rz):
    """s : D of a deviator with the hoop component -(rr + zz), Pa times the unit of D.

    ``d_rz`` is the sum of both off-diagonal parts of the velocity gradient. Part of the work in explanation/lagrangian-step,
    equation 5.
    """
    return (rr * d_rr - (rr + zz) * d_tt) + (zz * d_zz + rz * d_rz)


@point
def carries_no_stress(damage, rho, cutoff_density):
    """Whether material has failed, or has the cutoff density (kg/m^3) or less: neither carries shear (explanation/fracture)."""
    return damage >= 1.0 or rho <= cutoff_density


@point
def take_internal(m, j, i, model, q, internal):
    """Copies the internal variables of body m in cell (j, i) into ``internal``, float64[n]."""
    if model in WITH_INTERNAL:
        for k in range(q.shape[0] - INTERNAL):
            internal[k] = q[INTERNAL + k, m, j, i]


@point
def keep_internal(m, j, i, model, internal, q):
    """The way back of `take_internal`."""
    if model in WITH_INTERNAL:
        for k in range(q.shape[0] - INTERNAL):
            q[INTERNAL + k, m, j, i] = internal[k]


@point
def from_centre(rr, zz, rz, model, internal):
    """Deviator (rr, zz, rz) measured from the centre of the yield surface, Pa: s - a (explanation/strength, equation 12)."""
    b_rr, b_zz, b_rz = back_stress(model, internal)
    return rr - b_rr, zz - b_zz, rz - b_rz


@point
def returned(rr, zz, rz, trial, dep, final, model, par, internal):
    """Deviator (rr, zz, rz) after the plastic strain ``dep``, of which the yield surface has moved along, Pa.

    The arguments of the same names are the elastic trial measured `from_centre`, of the von Mises norm ``trial``, which falls
    to ``final``, Pa (explanation/strength, equations 4 and 12).

    Updates  internal [k]
    """
    b_rr, b_zz, b_rz = back_stress(model, internal)
    share = (final + kinematic_modulus(model, par) * dep) / trial
    harden(model, dep, rr / trial, zz / trial, rz / trial, par, internal)
    return b_rr + share * rr, b_zz + share * zz, b_rz + share * rz


@point
def flow(m, j, i, dep, dt, final, models, materials, pm, tm, q):
    """Adds the plastic strain ``dep`` of the step to body m in cell (j, i), at the flow stress ``final`` (Pa), and its damage.

    Updates  q (plastic strain, damage) [k, m, j, i]
    """
    q[EP, m, j, i] += dep
    increment = damage_increment(models[m, DAMAGE], dep, dep / dt, tm[m, j, i], pm[m, j, i], final,
                                 materials[m, DAMAGE_AT:TENSILE])
    q[DMG, m, j, i] = damaged(q[DMG, m, j, i], increment)


@point
def return_to_surface(m, j, i, dt, rr, zz, rz, modulus, own, cell_yield, models, materials, pm, tm, q, internal):
    """(rr, zz, rz, dep, final): deviator of body m in cell (j, i) after its return, plastic strain, flow stress (Pa).

    ``own``: to the body's own yield surface; else to the flow stress ``cell_yield`` of its cell (Pa). The arguments rr, zz and
    rz are the elastic trial, ``modulus`` is its shear modulus, Pa (explanation/strength, equations 4 and 12).

    Updates  q (plastic strain, damage, internal variables) [k, m, j, i];  scratch internal [k]
    """
    model, par = models[m, STRENGTH], materials[m, STRENGTH_AT:DAMAGE_AT]
    take_internal(m, j, i, model, q, internal)
    x_rr, x_zz, x_rz = from_centre(rr, zz, rz, model, internal)
    trial = von_mises(x_rr, x_zz, x_rz)
    stiffness = modulus + kinematic_modulus(model, par) / 3.0
    dep, final = 0.0, trial
    if own:
        dep, final = plastic_increment(model, trial, q[EP, m, j, i], dt, tm[m, j, i], pm[m, j, i], q[RHO, m, j, i], stiffness,
                                       materials[m, FACTOR], par)
    elif trial > cell_yield:
        final = cell_yield
        dep = (trial - final) / (3.0 * stiffness) if modulus > 0.0 else 0.0
    if dep != 0.0:
        rr, zz, rz = returned(x_rr, x_zz, x_rz, trial, dep, final, model, par, internal)
        keep_internal(m, j, i, model, internal, q)
        flow(m, j, i, dep, dt, final, models, materials, pm, tm, q)
    return rr, zz, rz, dep, final
