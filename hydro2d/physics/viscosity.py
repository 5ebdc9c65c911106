"""Artificial viscosity."""

from hydro2d.jit import point
from hydro2d.physics.traction import smoothstep

#: share of solids in a cell up to which void takes the compression, and nothing is shocked
OPEN = 0.99


@point
def smoothness(left, centre, right):
    """Christensen's limiter psi: 1 where the velocity slope is smooth, 0 at an extremum or beside no slope.

    left, centre, right are the velocity differences over three neighbouring cells (explanation/lagrangian-step).
    """
    inverse = 1.0 / centre if centre != 0.0 else 0.0
    a, b = left * inverse, right * inverse
    return max(0.0, min(min(1.0, 0.5 * (a + b)), min(2.0 * a, 2.0 * b)))


@point
def directional_viscosity(rho, c, du, psi, linear, quadratic):
    """q = (1 - psi) rho (c2 du^2 + c1 c |du|) against a compression du < 0; von Neumann-Richtmyer with Landshoff's term."""
    jump = max(-du, 0.0)
    return (1.0 - psi) * rho * jump * (quadratic * jump + linear * c)


@point
def shut(solids):
    """Share of the viscosity that a cell with void has: all without, none from a hundredth of void on, which shuts first."""
    return smoothstep((solids - OPEN) / (1.0 - OPEN))
