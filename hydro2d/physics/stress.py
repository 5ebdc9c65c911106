"""Deviators: rotation, strain, norms, and their sum over the bodies of a cell."""

from math import sqrt

from hydro2d.jit import point
from hydro2d.mesh.fields import SRR, SRZ, SZZ
from strength.rotation import turned


@point
def turn_and_strain(rr, zz, rz, spin, g2, drr, dzz, dtt, drz):
    """Deviator rotated by the spin and strained by 2 G times the deviatoric strain increment (strength, equation 1).

    spin = W dt, g2 = 2 G, d.. = D dt.
    """
    rr, zz, rz = turned(rr, zz, rz, spin)
    mean = (drr + dzz + dtt) / 3.0
    return rr + g2 * (drr - mean), zz + g2 * (dzz - mean), rz + g2 * drz


@point
def von_mises(rr, zz, rz):
    """sqrt(3/2 s:s) of a deviator whose hoop component is -(rr + zz)."""
    return sqrt(3.0 * ((rr * rr + zz * zz) + (rr * zz + rz * rz)))


@point
def largest_principal(rr, zz, rz):
    """Largest principal value of a deviator whose hoop component is -(rr + zz)."""
    half = 0.5 * (rr - zz)
    return max(0.5 * (rr + zz) + sqrt(half * half + rz * rz), -(rr + zz))


@point
def least_pressure(j, i, sig_rr, sig_zz, sig_tt, sig_rz):
    """Least of the principal pressures of cell (j, i), Pa: minus its largest principal stress, the hoop stress included."""
    half = 0.5 * (sig_rr[j, i] - sig_zz[j, i])
    in_plane = 0.5 * (sig_rr[j, i] + sig_zz[j, i]) + sqrt(half * half + sig_rz[j, i] * sig_rz[j, i])
    return -max(in_plane, sig_tt[j, i])


@point
def stress_scale(solid_mode, solids):
    """Factor on sum f_m s_m of a mixed cell: 1, or in mode `solid` one over the share of solids.

    At most 2: a nearly empty cell with the stiffness of a full one would need a shorter time step than the one taken.
    """
    return 1.0 / max(solids, 0.5) if solid_mode else 1.0


@point
def normal_pressure(j, i, n_r, n_z, sig_rr, sig_zz, sig_rz):
    """-n . sigma . n of cell (j, i)."""
    return -(n_r * n_r * sig_rr[j, i] + 2.0 * n_r * n_z * sig_rz[j, i] + n_z * n_z * sig_zz[j, i])


@point
def release(m, j, i, q):
    """Sets the deviator of body m in cell (j, i) to zero.

    Updates  q (deviators) [k, m, j, i]
    """
    q[SRR, m, j, i] = 0.0
    q[SZZ, m, j, i] = 0.0
    q[SRZ, m, j, i] = 0.0
