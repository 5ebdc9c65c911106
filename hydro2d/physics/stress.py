"""Deviators: turned, strained, measured, and shared by the bodies of a cell."""

from math import sqrt

from hydro2d.jit import point


@point
def turn_and_strain(rr, zz, rz, spin, g2, drr, dzz, dtt, drz):
    """Deviator rotated by the spin and strained by 2 G times the deviatoric strain increment (strength, equation 1).

    spin = W dt, g2 = 2 G, d.. = D dt. The rotation (1 - a^2)/(1 + a^2), 2 a/(1 + a^2), a = spin/2 keeps the second invariant;
    its angle 2 atan(a) is the spin to second order.
    """
    a = 0.5 * spin
    norm = 1.0 / (1.0 + a * a)
    c, s = (1.0 - a * a) * norm, 2.0 * a * norm
    mean = (drr + dzz + dtt) / 3.0
    new_rr = c * c * rr + 2.0 * c * s * rz + s * s * zz + g2 * (drr - mean)
    new_zz = s * s * rr - 2.0 * c * s * rz + c * c * zz + g2 * (dzz - mean)
    new_rz = c * s * (zz - rr) + (c * c - s * s) * rz + g2 * drz
    return new_rr, new_zz, new_rz


@point
def von_mises(rr, zz, rz):
    """sqrt(3/2 s:s) of a deviator whose hoop component is -(rr + zz)."""
    return sqrt(3.0 * ((rr * rr + zz * zz) + (rr * zz + rz * rz)))


@point
def stress_scale(solid_mode, solids):
    """Factor on sum f_m s_m of a mixed cell: 1, or in mode `solid` one over the share of solids.

    Not more than 2: a thinly filled cell with the stiffness of a full one would outrun the time step.
    """
    return 1.0 / max(solids, 0.5) if solid_mode else 1.0


@point
def normal_pressure(j, i, n_r, n_z, sig_rr, sig_zz, sig_rz):
    """-n . sigma . n of cell (j, i)."""
    return -(n_r * n_r * sig_rr[j, i] + 2.0 * n_r * n_z * sig_rz[j, i] + n_z * n_z * sig_zz[j, i])
