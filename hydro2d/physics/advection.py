"""What flows through a face with the volume or mass that crosses it."""

from hydro2d.jit import point

#: keeps a quotient of two zeros finite
TINY = 1e-300


@point
def limited_difference(a, b):
    """Monotonized central difference from those to both neighbours (van Leer, J. Comput. Phys. 23 (1977) 276)."""
    size = min(min(2.0 * abs(a), 2.0 * abs(b)), 0.5 * abs(a + b))
    size = size if a * b > 0.0 else 0.0
    return size if a > 0.0 else -size


@point
def upwind(up, ll, l, r, rr):
    """(donor, limited difference towards the other side of the face) of a face between l and r that l feeds where ``up``.

    Differences first: a choice between two values in memory is a slow gather, one between two numbers is not.
    """
    across = r - l
    behind = l - ll if up else r - rr
    return l if up else r, limited_difference(behind, across if up else -across)
