"""What deviators do, and when there are none."""

from hydro2d.jit import point


@point
def deviator_power(rr, zz, rz, d_rr, d_zz, d_tt, d_rz):
    """s : D of a deviator with the hoop component -(rr + zz), Pa times the unit of D.

    ``d_rz`` is the sum of both off-diagonal parts of the velocity gradient. Part of the work in explanation/lagrangian-step,
    equation 5.
    """
    return (rr * d_rr - (rr + zz) * d_tt) + (zz * d_zz + rz * d_rz)


@point
def carries_no_stress(damage, rho, loose):
    """Whether material has failed, or is as thin as `loose` kg/m^3 and less: neither carries shear (explanation/fracture)."""
    return damage >= 1.0 or rho <= loose
