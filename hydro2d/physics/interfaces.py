"""Piecewise-linear interfaces: Youngs' normal, the constant of the line, and the share of a donor strip.

All in the unit square of a cell with axes s = r^2/2 and z, in which areas are volumes of revolution, so that the planar
formulas are exact (explanation/interfaces). More than two materials are nested: the interface of the first k bodies of the
stated order bounds their cumulative fraction, void comes last.
"""

from math import sqrt

from hydro2d.jit import point

#: void below this share of a cell is round-off: its interface has no direction
FULL = 1e-12


@point
def line_constant(m1, m2, fraction):
    """alpha such that m1 x + m2 y <= alpha fills `fraction`, 0 to 1, of the unit square; m1, m2 >= 0 and m1 + m2 = 1.

    Scardovelli & Zaleski, J. Comput. Phys. 164 (2000) 228, in two dimensions.
    """
    small, large = min(m1, m2), max(m1, m2)
    f = min(fraction, 1.0 - fraction)
    if f * 2.0 * large < small:
        alpha = sqrt(2.0 * small * large * f)
    else:
        alpha = f * large + 0.5 * small
    return alpha if fraction <= 0.5 else 1.0 - alpha


@point
def area_below(m1, m2, alpha):
    """Share of the unit square with m1 x + m2 y <= alpha; m1, m2 >= 0, not both 0."""
    small, large = min(m1, m2), max(m1, m2)
    if small < 1e-7 * large:
        return min(max((alpha - 0.5 * small) / large, 0.0), 1.0)
    a = min(max(alpha, 0.0), small + large)
    b, c = max(a - small, 0.0), max(a - large, 0.0)
    return (a * a - b * b - c * c) / (2.0 * small * large)


@point
def strip_share(nx, ny, fraction, width, high):
    """Material in the strip of given width at the low or high x side of the unit square, as a share of the square.

    (nx, ny) is the outward normal of the material, |nx| + |ny| = 1 or 0 (spread evenly); fraction its share.
    """
    if fraction <= 0.0:
        return 0.0
    if fraction >= 1.0:
        return width
    m1, m2 = abs(nx), abs(ny)
    if m1 + m2 == 0.0:
        return width * fraction
    alpha = line_constant(m1, m2, fraction)
    if high == (nx > 0.0):  # the strip lies where the material ends, once x is turned along the normal
        alpha -= m1 * (1.0 - width)
    return width * area_below(m1 * width, m2, alpha)


@point
def line_centre(n1, n2, fraction):
    """Midpoint in the unit square of the line with outward normal (n1, n2) that cuts off `fraction`."""
    m1, m2 = abs(n1), abs(n2)
    alpha = line_constant(m1, m2, fraction)
    x0, y0 = (alpha / m1, 0.0) if alpha < m1 else (1.0, (alpha - m1) / max(m2, 1e-300))
    x1, y1 = (0.0, alpha / m2) if alpha < m2 else ((alpha - m2) / max(m1, 1e-300), 1.0)
    x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    return (1.0 - x if n1 < 0.0 else x), (1.0 - y if n2 < 0.0 else y)


@point
def cumulative(j, i, last, order, vof):
    """Fraction of a cell filled by the first bodies of the order, up to and with position `last`."""
    total = 0.0
    for k in range(last + 1):
        total += vof[order[k], j, i]
    return min(total, 1.0)


@point
def youngs_difference(sw, s, se, w, e, nw, n, ne):
    """Youngs' difference of a fraction over 3 x 3 cells of one size, downwards, along r and along z: 8 times the fall per cell.

    Sums in mirror pairs.

    D. L. Youngs in Numerical Methods for Fluid Dynamics (1982) 273.
    """
    return ((nw + sw) + 2.0 * w) - ((ne + se) + 2.0 * e), ((sw + se) + 2.0 * s) - ((nw + ne) + 2.0 * n)


@point
def youngs_gradient(j, i, sw, s, se, w, e, nw, n, ne, dr, dz):
    """`youngs_difference` around cell (j, i), neighbours of other widths weighted: 4 times the fall across the cell."""
    along_r, along_z = youngs_difference(sw, s, se, w, e, nw, n, ne)
    along_r *= dr[i] / (dr[i] + 0.5 * (dr[i - 1] + dr[i + 1]))
    along_z *= dz[j] / (dz[j] + 0.5 * (dz[j - 1] + dz[j + 1]))
    return along_r, along_z


@point
def youngs_normal(j, i, last, order, vof, dr, dz):
    """Outward normal of the nested interface in the unit square, |n_r| + |n_z| = 1: that of `youngs_gradient`.

    (0, 0) without a gradient.
    """
    along_r, along_z = youngs_gradient(
        j, i, cumulative(j - 1, i - 1, last, order, vof), cumulative(j - 1, i, last, order, vof),
        cumulative(j - 1, i + 1, last, order, vof), cumulative(j, i - 1, last, order, vof),
        cumulative(j, i + 1, last, order, vof), cumulative(j + 1, i - 1, last, order, vof),
        cumulative(j + 1, i, last, order, vof), cumulative(j + 1, i + 1, last, order, vof), dr, dz)
    size = abs(along_r) + abs(along_z)
    if size < 1e-14:
        return 0.0, 0.0
    return along_r / size, along_z / size
