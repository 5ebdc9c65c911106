"""Artificial viscosity."""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.traction import smoothstep

#: largest courant^2 + 2 linear courant for a front that does not ring; above 1 a front that all cells damp is unstable
CARRIED = 0.75
#: a courant that carries any viscosity
SHORT = 1e-3
#: share of solids in a cell up to which void takes the compression, without a shock
OPEN = 0.99


@point
def smoothness(left, centre, right):
    """Christensen's limiter psi: 1 where the velocity slope is smooth, 0 at an extremum or next to zero slope.

    left, centre, right are the velocity differences over three neighbouring cells (explanation/lagrangian-step).
    """
    inverse = 1.0 / centre if centre != 0.0 else 0.0
    a, b = left * inverse, right * inverse
    return max(0.0, min(min(1.0, 0.5 * (a + b)), min(2.0 * a, 2.0 * b)))


@point
def linear_in_step(linear, courant):
    """Linear coefficient where sound crosses the share `courant` of a cell in a step: as much of `linear` as such a step
    carries. The viscosity is that at the beginning of the step, and with more a front rings (explanation/lagrangian-step,
    equation 10a)."""
    return min(linear, max(CARRIED - courant * courant, 0.0) / (2.0 * max(courant, SHORT)))


@point
def directional_viscosity(rho, c, du, psi, linear, quadratic):
    """q = (1 - psi) rho (c2 du^2 + c1 c |du|) against a compression du < 0; von Neumann-Richtmyer with Landshoff's term."""
    jump = max(-du, 0.0)
    return (1.0 - psi) * rho * jump * (quadratic * jump + linear * c)


@point
def strongest_compression(rr, zz, rz):
    """Least principal value of a rate of strain in the plane, 1/s, and its direction n: (value, n_r, n_z), n_r >= 0.

    rr, zz, rz are D_rr, D_zz and D_rz (explanation/lagrangian-step, equation 11a). Without shear, n is a direction of the mesh
    to the last bit.
    """
    mean, half = 0.5 * (rr + zz), 0.5 * (rr - zz)
    radius = sqrt(half * half + rz * rz)
    turned = half / radius if radius > 0.0 else 0.0
    n_r, n_z = sqrt(max(0.5 * (1.0 - turned), 0.0)), sqrt(max(0.5 * (1.0 + turned), 0.0))
    return mean - radius, n_r, n_z if rz <= 0.0 else -n_z


@point
def length_along(n_r, n_z, dr, dz):
    """Length of a cell along n, m: that of the ellipse with axes dr and dz, so that a shock along z does not see dr."""
    return dr * dz / sqrt((n_r * dz) * (n_r * dz) + (n_z * dr) * (n_z * dr))


@point
def shut(solids):
    """Share of the viscosity in a cell with void: all without void, none from a hundredth of void on, which closes first."""
    return smoothstep((solids - OPEN) / (1.0 - OPEN))
