"""What the bodies of a mixed cell share: volume, pressure, energy."""

from hydro2d.jit import point
from hydro2d.mesh.fields import RHO

NO_VOID = 1e-12


@point
def split_volume(void, change, volume):
    """Volume change of void and of the bodies: void takes all of it, and in compression only as much as there is."""
    if void <= NO_VOID:
        return 0.0, change
    taken = max(change, -void * volume)
    return taken, change - taken


@point
def common_pressure(j, i, vof, q, pm, km):
    """(pressure at which the bodies of a cell would meet, its volume given; density): means by compressibility f/K."""
    compliance, pressure, density = 0.0, 0.0, 0.0
    for m in range(vof.shape[0]):
        if vof[m, j, i] > 0.0:
            compliance += vof[m, j, i] / km[m, j, i]
            pressure += vof[m, j, i] / km[m, j, i] * pm[m, j, i]
            density += vof[m, j, i] / km[m, j, i] * q[RHO, m, j, i]
    return pressure / compliance, density / compliance
