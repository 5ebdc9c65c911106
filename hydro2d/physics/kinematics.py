"""The motion of a cell from that of its vertices."""

from hydro2d.jit import point


@point
def velocity_gradient(i, ub, ut, vb, vt, face_r, hoop, az_in, az_out, mid_r, h):
    """Volume times the velocity gradient of cell i: (D_rr, D_tt, D_zz, du_r/dz, du_z/dr) (lagrangian-step, equation 2)."""
    outer, inner = ub[i + 1] + ut[i + 1], ub[i] + ut[i]
    tt = h * hoop[i] * (outer + inner)
    rr = 0.5 * h * (face_r[i + 1] * outer - face_r[i] * inner) - tt
    zz = az_in[i] * (vt[i] - vb[i]) + az_out[i] * (vt[i + 1] - vb[i + 1])
    r_by_z = az_in[i] * (ut[i] - ub[i]) + az_out[i] * (ut[i + 1] - ub[i + 1])
    z_by_r = mid_r[i] * h * ((vb[i + 1] + vt[i + 1]) - (vb[i] + vt[i]))
    return rr, tt, zz, r_by_z, z_by_r


@point
def hourglass_mode(i, b, t):
    """u0 - u1 + u2 - u3 of cell i from the vertex rows below and above it."""
    return (b[i] - b[i + 1]) + (t[i + 1] - t[i])


@point
def divergence(i, ub, ut, vb, vt, face_r, az_in, az_out, vol_r, h):
    """Rate of volume change per volume of cell i from its four vertices (explanation/lagrangian-step, equation 2)."""
    radial = 0.5 * h * (face_r[i + 1] * (ub[i + 1] + ut[i + 1]) - face_r[i] * (ub[i] + ut[i]))
    axial = az_in[i] * (vt[i] - vb[i]) + az_out[i] * (vt[i + 1] - vb[i + 1])
    return (radial + axial) / (vol_r[i] * h)


@point
def volume_loss(i, ub, ut, vb, vt, face_r, az_in, az_out, vol_r, h):
    """Rate at which cell i loses its volume, 1/s."""
    inward = face_r[i + 1] * (ub[i + 1] + ut[i + 1]) - face_r[i] * (ub[i] + ut[i])
    return -(0.5 * inward * h + az_in[i] * (vt[i] - vb[i]) + az_out[i] * (vt[i + 1] - vb[i + 1])) / (vol_r[i] * h)
