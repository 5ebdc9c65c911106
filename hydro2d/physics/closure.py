"""Shares of the bodies of a mixed cell in the change of its volume, and relaxation of their pressures."""

from hydro2d.jit import point
from hydro2d.mesh.fields import RHO

#: share of void below which a cell counts as full
NO_VOID = 1e-12


@point
def stiff_density(j, i, vof, q, km):
    """Density of a cell as the mean by compressibility f/K, in which a stiff body counts less (kg/m^3)."""
    compliance, density = 0.0, 0.0
    for m in range(vof.shape[0]):
        if vof[m, j, i] > 0.0:
            compliance += vof[m, j, i] / km[m, j, i]
            density += vof[m, j, i] / km[m, j, i] * q[RHO, m, j, i]
    return density / compliance


@point
def softness(f, modulus, tipton):
    """Share of a body in a change of volume, not yet over their sum: R = f/K, or f where all are strained alike.

    explanation/mixed-cells, equation 2. f is the volume fraction, K the adiabatic bulk modulus, Pa. The share of an absent body
    is 0 for any modulus.
    """
    if f == 0.0 or not tipton:
        return f
    return f / modulus


@point
def stiffness(modulus, pressure):
    """Adiabatic bulk modulus of a fluid, Pa, at least the pressure of its cell: at that pressure no gas is softer.

    explanation/mixed-cells, equation 2.
    """
    return max(modulus, pressure)


@point
def relaxation_strain(relaxation, p, target, modulus):
    """Relative change of a body's volume that moves its pressure towards the target by the share `relaxation`.

    explanation/mixed-cells, equation 3.
    """
    return relaxation * (p - target) / modulus


@point
def relaxation_bound(strain):
    """Factor that keeps a relative change of volume by relaxation within a tenth (explanation/mixed-cells, equation 4)."""
    return 0.1 / max(abs(strain), 0.1)


@point
def own_work(p, modulus, strain):
    """Work of a body's own pressure on a relative change of its volume, per its volume, J/m^3: p in the middle of the change.

    explanation/mixed-cells, equation 6.
    """
    return (p - 0.5 * modulus * strain) * strain
