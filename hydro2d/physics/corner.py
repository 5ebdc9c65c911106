"""The force of a cell on its four corners, and the work of these forces (explanation/lagrangian-step, equations 1 and 4 to 6).

A cell has the stress sigma and the volume V. One set of vectors, the gradients of its volume and of its strain rates with
respect to the velocities of its vertices, gives both the forces and the rates, so that the forces do exactly the work of the
stress: sum f . u = -V sigma : D.

    vertices of cell i            the cells around vertex (j, i), which belong to rows j-1 (b, below) and j (t, above)

        3 ------- 2                        :           :
        |         |                        :  t[i-1]   :   t[i]
        |    i    |                ........:...........o............   z
        |         |                        :  b[i-1]   :   b[i]        ^
        0 ------- 1                        :           :               '--> r

The force on a vertex is a sum of terms: of the normal stress, of the hoop stress, of the shear stress, and of the filter of the
hourglass mode. `corner` is one corner of one cell, for cells whose stress differs by group; `radial_force`, `axial_force` and
`hourglass_force` are the sums over the four cells around a vertex, in an order that a mirror image leaves alone.
"""

from hydro2d.jit import point
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, HOOP, MID_R
from hydro2d.physics.kinematics import hourglass_mode


@point
def corner(i, outer, upper, metrics, h):
    """Vectors of a corner of a cell in column i: (c_r - A/4, A/4, c_z, g), m^2 per radian (equation 1).

    outer, upper : which of the four corners;  h : height of the cell, m
    """
    hoop = metrics[HOOP, i] * h
    area = metrics[AZ_OUT, i] if outer else metrics[AZ_IN, i]
    along = metrics[MID_R, i] * h
    half = 0.5 * (metrics[FACE_R, i + 1] if outer else metrics[FACE_R, i])
    across = h * (half - metrics[HOOP, i]) if outer else -h * (half + metrics[HOOP, i])
    return across, hoop, area if upper else -area, along if outer else -along


@point
def corner_force(rr, zz, tt, rz, c_rr, c_tt, c_z, g):
    """(f_r, f_z) on a corner with the vectors of `corner`, N per radian: of a stress in Pa (equation 4)."""
    return -(c_rr * rr + c_tt * tt + c_z * rz), -(c_z * zz + g * rz)


@point
def radial_force(j, i, rr, tt, rz, metrics, dz):
    """Radial force of the stresses of the four cells around vertex (j, i), N per radian (equation 4).

    rr, tt, rz : sigma_rr, sigma_tt and sigma_rz [j, i], Pa;  dz : heights of rows [j], m
    """
    b, k, h_b, h_t = j - 1, i - 1, dz[j - 1], dz[j]
    half, hoop_k, hoop_i = 0.5 * metrics[FACE_R, i], metrics[HOOP, k], metrics[HOOP, i]
    normal = (half - hoop_k) * (h_b * rr[b, k] + h_t * rr[j, k]) - (half + hoop_i) * (h_b * rr[b, i] + h_t * rr[j, i])
    hoop = hoop_k * (h_b * tt[b, k] + h_t * tt[j, k]) + hoop_i * (h_b * tt[b, i] + h_t * tt[j, i])
    shear = metrics[AZ_OUT, k] * (rz[b, k] - rz[j, k]) + metrics[AZ_IN, i] * (rz[b, i] - rz[j, i])
    return -(normal + hoop + shear)


@point
def axial_force(j, i, zz, rz, metrics, dz):
    """Axial force of the stresses of the four cells around vertex (j, i), N per radian (equation 4)."""
    b, k, h_b, h_t = j - 1, i - 1, dz[j - 1], dz[j]
    normal = metrics[AZ_OUT, k] * (zz[b, k] - zz[j, k]) + metrics[AZ_IN, i] * (zz[b, i] - zz[j, i])
    shear = metrics[MID_R, k] * (h_b * rz[b, k] + h_t * rz[j, k]) - metrics[MID_R, i] * (h_b * rz[b, i] + h_t * rz[j, i])
    return -(normal + shear)


@point
def hourglass_force(j, i, pushes):
    """Force of the hourglass filters of the four cells around vertex (j, i), N per radian (equation 6).

    pushes : what the filter of a cell pushes with along r or z [j, i], N per radian
    """
    return (pushes[j, i - 1] - pushes[j - 1, i - 1]) + (pushes[j - 1, i] - pushes[j, i])


@point
def stress_power(rr, tt, zz, rz, before, after):
    """V sigma : (D + D') of a cell, W per radian: for a stress in Pa, twice the power that its corner forces take from motion.

    before, after : `velocity_gradient` of the cell with the velocities at the start and at the end of a step
    """
    b_rr, b_tt, b_zz, b_rbz, b_zbr = before
    a_rr, a_tt, a_zz, a_rbz, a_zbr = after
    return (rr * (b_rr + a_rr) + tt * (b_tt + a_tt)) + (zz * (b_zz + a_zz) + rz * ((b_rbz + a_rbz) + (b_zbr + a_zbr)))


@point
def filter_power(i, push_r, push_z, u0_b, u0_t, v0_b, v0_t, u_b, u_t, v_b, v_t):
    """Twice the power that the hourglass filter of cell i takes from the motion, W per radian.

    push_r, push_z : what it pushes with, N per radian; velocities at the start and at the end of a step, m/s
    """
    h_u0, h_v0 = hourglass_mode(i, u0_b, u0_t), hourglass_mode(i, v0_b, v0_t)
    h_u, h_v = hourglass_mode(i, u_b, u_t), hourglass_mode(i, v_b, v_t)
    return push_r * (h_u0 + h_u) + push_z * (h_v0 + h_v)
