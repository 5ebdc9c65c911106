"""Work of deviators, their return to the yield surface, and conditions under which they are zero."""

from hydro2d.jit import point
from hydro2d.mesh.fields import INTERNAL
from strength.dispatch import WITH_INTERNAL, back_stress, harden, kinematic_modulus, melted


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
def is_fluid(modulus):
    """Whether the shear ``modulus`` has fallen to zero, as in a melt, which carries no deviator; False for a NaN."""
    return modulus <= 0.0


@point
def forget(m, j, i, model, q, internal):
    """Sets the internal variables of body m in cell (j, i), which has melted, to those of a melt.

    Updates  q (internal variables) [k, m, j, i]; scratch internal [k]
    """
    take_internal(m, j, i, model, q, internal)
    melted(model, internal)
    keep_internal(m, j, i, model, internal, q)


@point
def take_internal(m, j, i, model, q, internal):
    """Copies the internal variables of body m in cell (j, i) into ``internal``, float64[n]."""
    if model in WITH_INTERNAL:
        for k in range(q.shape[0] - INTERNAL):
            internal[k] = q[INTERNAL + k, m, j, i]


@point
def keep_internal(m, j, i, model, internal, q):
    """Copies ``internal`` back into the internal variables of body m in cell (j, i), the inverse of `take_internal`."""
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
    """Deviator (rr, zz, rz) after the plastic strain ``dep``, with which the yield surface has moved, Pa.

    The arguments of the same names are the elastic trial measured `from_centre`, with the von Mises norm ``trial``, which falls
    to ``final``, Pa (explanation/strength, equations 4 and 12).

    Updates  internal [k]
    """
    b_rr, b_zz, b_rz = back_stress(model, internal)
    share = (final + kinematic_modulus(model, par) * dep) / trial
    harden(model, dep, rr / trial, zz / trial, rz / trial, par, internal)
    return b_rr + share * rr, b_zz + share * zz, b_rz + share * rz
