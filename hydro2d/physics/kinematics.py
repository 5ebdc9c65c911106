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
def alternating_mode(j, i, u, mass):
    """Part of the hourglass mode of cell (j, i) that alternates from cell to cell: minmod(h, (h - h_mean)/2).

    h_mean is the mean of the neighbours', a neighbour with less mass than the cell counting less. A smooth field has nearly the
    same mode in them, the shortest wave the opposite one (explanation/lagrangian-step, equation 6).

    u : one component of the velocity [j, i], m/s;  mass : of the cells [j, i], kg
    """
    here, own = hourglass_mode(i, u[j], u[j + 1]), mass[j, i]
    left, right = min(mass[j, i - 1], own), min(mass[j, i + 1], own)
    below, above = min(mass[j - 1, i], own), min(mass[j + 1, i], own)
    around = (left * hourglass_mode(i - 1, u[j], u[j + 1]) + right * hourglass_mode(i + 1, u[j], u[j + 1])) + (
        below * hourglass_mode(i, u[j - 1], u[j]) + above * hourglass_mode(i, u[j + 1], u[j + 2]))
    total = (left + right) + (below + above)
    excess = 0.5 * (here - (around / total if total > 0.0 else -here))
    size = min(abs(here), abs(excess)) if here * excess > 0.0 else 0.0
    return size if here > 0.0 else -size


@point
def divergence(i, ub, ut, vb, vt, metrics, h):
    """Rate of volume change per volume of cell i from its four vertices (explanation/lagrangian-step, equation 2)."""
    radial = 0.5 * h * (metrics[FACE_R, i + 1] * (ub[i + 1] + ut[i + 1]) - metrics[FACE_R, i] * (ub[i] + ut[i]))
    axial = metrics[AZ_IN, i] * (vt[i] - vb[i]) + metrics[AZ_OUT, i] * (vt[i + 1] - vb[i + 1])
    return (radial + axial) / (metrics[VOL_R, i] * h)
