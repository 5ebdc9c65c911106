"""The motion of a cell from that of its vertices."""

from hydro2d.jit import point
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, HOOP, MID_R, VOL_R


@point
def velocity_gradient(i, ub, ut, vb, vt, metrics, h):
    """Volume times the velocity gradient of cell i: (D_rr, D_tt, D_zz, du_r/dz, du_z/dr) (lagrangian-step, equation 2)."""
    outer, inner = ub[i + 1] + ut[i + 1], ub[i] + ut[i]
    tt = h * metrics[HOOP, i] * (outer + inner)
    rr = 0.5 * h * (metrics[FACE_R, i + 1] * outer - metrics[FACE_R, i] * inner) - tt
    zz = metrics[AZ_IN, i] * (vt[i] - vb[i]) + metrics[AZ_OUT, i] * (vt[i + 1] - vb[i + 1])
    r_by_z = metrics[AZ_IN, i] * (ut[i] - ub[i]) + metrics[AZ_OUT, i] * (ut[i + 1] - ub[i + 1])
    z_by_r = metrics[MID_R, i] * h * ((vb[i + 1] + vt[i + 1]) - (vb[i] + vt[i]))
    return rr, tt, zz, r_by_z, z_by_r


@point
def hourglass_mode(i, b, t):
    """u0 - u1 + u2 - u3 of cell i from the vertex rows below and above it."""
    return (b[i] - b[i + 1]) + (t[i + 1] - t[i])


@point
def divergence(i, ub, ut, vb, vt, metrics, h):
    """Rate of volume change per volume of cell i from its four vertices (explanation/lagrangian-step, equation 2)."""
    radial = 0.5 * h * (metrics[FACE_R, i + 1] * (ub[i + 1] + ut[i + 1]) - metrics[FACE_R, i] * (ub[i] + ut[i]))
    axial = metrics[AZ_IN, i] * (vt[i] - vb[i]) + metrics[AZ_OUT, i] * (vt[i + 1] - vb[i + 1])
    return (radial + axial) / (metrics[VOL_R, i] * h)
