"""Damage, tension limits, and the void inserted where material fractures (explanation/fracture)."""

from hydro2d.jit import point
from hydro2d.mesh.fields import CRUSHED, FAILED, RHO


@point
def damaged(before, increment):
    """Damage after an increment of plastic strain: `FAILED` once it reaches 1 (explanation/fracture, equation 6)."""
    if before >= 1.0:
        return before
    return before + increment if before + increment < 1.0 else FAILED


@point
def crushed(before, increment):
    """Damage after an increment of plastic strain of material that keeps some strength: `CRUSHED` at most, never failed."""
    return min(before + increment, CRUSHED)


@point
def tension_limit(fracture_pressure, fades, damage):
    """Tension that material carries, Pa: its fracture pressure, 0 once it has failed.

    fades : 1 where it falls with the damage, as in brittle material that is crushed; else 0
    """
    return fracture_pressure * (1.0 - fades * damage) if damage < 1.0 else 0.0


@point
def open_void(m, j, i, share, vof, q):
    """Leaves body m this share of its volume in cell (j, i); the rest is void.

    Updates  vof [m, j, i]; q (density) [k, m, j, i]
    """
    vof[m, j, i] *= share
    q[RHO, m, j, i] /= share


@point
def crack_opening(vof, rho, cracks, size):
    """Volume of the cracks of a cell per area of the cell across its length ``size``, m: explanation/fracture, (11).

    cracks : their volume per mass, m^3/kg
    """
    return vof * rho * cracks * size


@point
def share_that_stays(rho, relaxed, max_opening):
    """Share of its volume that a fractured body keeps, so that the rest is void.

    ``relaxed`` is the density at zero pressure with the same energy, kg/m^3: at rho/relaxed the tension is gone. No more than
    ``max_opening`` of the volume opens in one cycle (explanation/fracture, equation 3).
    """
    return max(rho / max(relaxed, rho), 1.0 - max_opening)
