"""Quantities that the volume or mass crossing a face carries with it."""

from hydro2d.jit import point
from hydro2d.physics.traction import smoothstep

#: keeps a quotient of two zeros finite
TINY = 1e-300
#: change of density from cell to cell, as a share of the donor's, from which a front begins to be unresolved, and in full
RESOLVED, UNRESOLVED = 0.05, 0.3


@point
def limited_difference(a, b, steepness):
    """Central difference from the differences to both neighbours, no larger than steepness times the smaller of them.

    steepness 2 is the monotonized central difference (van Leer, J. Comput. Phys. 23 (1977) 276), 1 the smaller of the two
    ("minmod", Roe 1986).
    """
    size = min(min(steepness * abs(a), steepness * abs(b)), 0.5 * abs(a + b))
    size = size if a * b > 0.0 else 0.0
    return size if a > 0.0 else -size


@point
def steepness_at(up, ll, l, r, rr, steepness):
    """Steepness of the slopes of the donor of a face, from the densities in the order of the face: 1 in an unresolved front.

    Slopes of twice the smaller difference keep a front sharp that begins along a mesh line, while one that is oblique to the
    mesh smears: a blast remembers the steps of its source (explanation/lagrangian-step).
    """
    across, before, after = abs(r - l), abs(l - ll), abs(rr - r)
    most = max(across, before if up else after)
    change = most / max(l if up else r, TINY)
    return steepness - (steepness - 1.0) * smoothstep((change - RESOLVED) / (UNRESOLVED - RESOLVED))


@point
def upwind(up, ll, l, r, rr, steepness):
    """(donor, limited difference towards the other side of the face) of a face between l and r that l feeds where ``up``.

    The differences come first: a choice between two values in memory is a slow gather, one between two numbers is not.
    """
    across = r - l
    behind = l - ll if up else r - rr
    return l if up else r, limited_difference(behind, across if up else -across, steepness)
