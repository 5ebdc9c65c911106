"""Piecewise-linear interfaces: Youngs' normal, the constant of the line, corners, and the share of a donor strip.

Everything is in the unit square of a cell with axes s = r^2/2 and z, in which areas are volumes of revolution, so that the
planar formulas are exact (explanation/interfaces). More than two materials are nested: the interface of the first k bodies of
the stated order bounds their cumulative fraction; void comes last.
"""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.traction import smoothstep

#: an edge is straight along the mesh if its fraction changes by less than this from cell to cell, in full up to half of it
STRAIGHT = 0.1
#: share of void from which a cell may have a corner in full
ROOM = 0.02
#: components of the normal, and fractions of the neighbouring cells, from which a corner counts in full
SLANT, THIN = 0.1, 0.01
#: misfits that differ by less than this are alike
ALIKE = 1e-6


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
    """Share of the unit square with m1 x + m2 y <= alpha; m1, m2 >= 0, not both 0.

    A triangle, a trapezium, or all but a triangle.
    """
    small, large = min(m1, m2), max(m1, m2)
    a = min(max(alpha, 0.0), small + large)
    if a < small:
        return 0.5 * (a / small) * (a / large)
    if a <= large:
        return (a - 0.5 * small) / large
    rest = small + large - a
    return 1.0 - 0.5 * (rest / small) * (rest / large)


@point
def centroid_below(m1, m2, alpha):
    """(share of the unit square with m1 x + m2 y <= alpha, x - 1/2 and y - 1/2 of its centroid); m1, m2 >= 0, not both 0."""
    small, large = min(m1, m2), max(m1, m2)
    a = min(max(alpha, 0.0), small + large)
    if a < small:
        return 0.5 * (a / small) * (a / large), a / (3.0 * m1) - 0.5, a / (3.0 * m2) - 0.5
    if a <= large:
        share = (a - 0.5 * small) / large
        if share <= 0.0:
            return 0.0, 0.0, 0.0
        steep = 0.5 * (share + (small / large) ** 2 / (12.0 * share)) - 0.5
        flat = -small / (12.0 * large * share)
        return share, (steep if m1 >= m2 else flat), (flat if m1 >= m2 else steep)
    rest = small + large - a
    empty = 0.5 * (rest / small) * (rest / large)
    share = 1.0 - empty
    return share, -empty * (0.5 - rest / (3.0 * m1)) / share, -empty * (0.5 - rest / (3.0 * m2)) / share


@point
def line_piece(nx, ny, fraction, width, high):
    """Material in the strip of given width at the low or high x side of the unit square, and its moments.

    (nx, ny) is the outward normal of the material, |nx| + |ny| = 1 or 0 (spread evenly); fraction its share. Returns its share
    of the square in the strip, and that share times the offset of its centroid from the middle of the strip: along x in widths
    of the strip, and along y.
    """
    if fraction <= 0.0:
        return 0.0, 0.0, 0.0
    if fraction >= 1.0:
        return width, 0.0, 0.0
    m1, m2 = abs(nx), abs(ny)
    if m1 + m2 == 0.0:
        return width * fraction, 0.0, 0.0
    alpha = line_constant(m1, m2, fraction)
    if high == (nx > 0.0):  # the strip lies where the material ends, once x is turned along the normal
        alpha -= m1 * (1.0 - width)
    share, x, y = centroid_below(m1 * width, m2, alpha)
    share *= width
    return share, share * (x if nx >= 0.0 else -x), share * (y if ny >= 0.0 else -y)


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
def nested(share, below, fraction, total, width):
    """Share of a strip that the first bodies fill, kept within bounds; the bodies before fill ``below`` of it.

    It is no less than ``below``, no more than ``below`` plus this body (``fraction`` of the cell), and leaves room in the strip
    of ``width`` for no more than the rest of the cell beyond ``total``. All are shares of the cell.
    """
    return min(max(share, max(below, width - (1.0 - total))), min(below + fraction, width))


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
def add_body(m, j, i, vof, f):
    """Sums of fractions in the 3 x 3 cells around cell (j, i), row by row upwards, and in those two away, with body m added.

    The cells two away are at lower and higher r, at lower and higher z, then the corners of 5 x 5 cells, row by row upwards.
    """
    v = vof[m]
    return (f[0] + v[j - 1, i - 1], f[1] + v[j - 1, i], f[2] + v[j - 1, i + 1], f[3] + v[j, i - 1], f[4] + v[j, i],
            f[5] + v[j, i + 1], f[6] + v[j + 1, i - 1], f[7] + v[j + 1, i], f[8] + v[j + 1, i + 1],
            f[9] + v[j, i - 2], f[10] + v[j, i + 2], f[11] + v[j - 2, i], f[12] + v[j + 2, i],
            f[13] + v[j - 2, i - 2], f[14] + v[j - 2, i + 2], f[15] + v[j + 2, i - 2], f[16] + v[j + 2, i + 2])


@point
def at_most_full(f):
    """Sums of fractions in 17 cells, no more than 1 in any."""
    return (min(f[0], 1.0), min(f[1], 1.0), min(f[2], 1.0), min(f[3], 1.0), min(f[4], 1.0), min(f[5], 1.0), min(f[6], 1.0),
            min(f[7], 1.0), min(f[8], 1.0), min(f[9], 1.0), min(f[10], 1.0), min(f[11], 1.0), min(f[12], 1.0),
            min(f[13], 1.0), min(f[14], 1.0), min(f[15], 1.0), min(f[16], 1.0))


@point
def youngs_normal(j, i, f, dr, dz):
    """Outward normal of the interface in the unit square, |n_r| + |n_z| = 1: that of `youngs_gradient`.

    f are the fractions around cell (j, i); (0, 0) without a gradient.
    """
    along_r, along_z = youngs_gradient(j, i, f[0], f[1], f[2], f[3], f[5], f[6], f[7], f[8], dr, dz)
    size = abs(along_r) + abs(along_z)
    if size < 1e-14:
        return 0.0, 0.0
    return along_r / size, along_z / size


@point
def line_misfit(n_r, n_z, f, widths, heights):
    """Misfit of the line in a cell to the eight cells around it: the sum of the squared errors in their fractions.

    (n_r, n_z) is the outward normal in the unit square of the middle cell, whose fraction the line keeps; f the fractions of
    3 x 3 cells, row by row upwards; widths and heights those of the columns and rows, over those of the middle ones.
    """
    level = line_constant(abs(n_r), abs(n_z), f[4]) + min(n_r, 0.0) + min(n_z, 0.0)
    total = 0.0
    for row in range(3):
        y = -heights[0] if row == 0 else row - 1.0
        b = n_z * heights[row]
        for column in range(3):
            x = -widths[0] if column == 0 else column - 1.0
            a = n_r * widths[column]
            off = f[3 * row + column] - area_below(abs(a), abs(b), level - n_r * x - n_z * y - min(a, 0.0) - min(b, 0.0))
            total += off * off
    return total


@point
def corner_size(share, beside_r, beside_z):
    """(width, height) of a rectangle that covers `share` of the unit square, in the proportion of the neighbouring fractions.

    beside_r and beside_z, above 0, are the fractions of the cells in which the rectangle continues along r and along z: its
    height and its width if it were alone there.
    """
    width = min(max(sqrt(share * beside_z / beside_r), share), 1.0)
    return width, share / width


@point
def turned(f, back, down):
    """Fractions of 3 x 3 cells, row by row upwards, as a mirror shows them: with r turned around, with z turned around."""
    if back:
        f = (f[2], f[1], f[0], f[5], f[4], f[3], f[8], f[7], f[6])
    if down:
        f = (f[6], f[7], f[8], f[3], f[4], f[5], f[0], f[1], f[2])
    return f


@point
def reversed_if(turn, sizes):
    """Three sizes, from the last to the first where they are to be turned."""
    return (sizes[2], sizes[1], sizes[0]) if turn else (sizes[0], sizes[1], sizes[2])


@point
def corner(n_r, n_z, f, beyond, widths, heights):
    """(width, height) of the corner of a rectangle along the mesh, and its weight, 0 to 1, against the line.

    The weight is above 0 where the corner fits the cells around better than the line does, and 0 wherever another corner would
    take its place, so it changes with all fractions without a jump.

    (n_r, n_z) is the line's normal, f, widths and heights are as in `line_misfit`; beyond has the fractions of the cells two
    away: at lower and higher r, at lower and higher z. Both edges of the corner continue straight up to these cells. The
    rectangle lies in the corner of the middle cell opposite to the signs of the normal. With width and height below 0 the
    rectangle is empty, lies towards those signs, and the bodies surround it.
    """
    if n_r == 0.0 or n_z == 0.0 or f[4] <= 0.0 or f[4] >= 1.0:
        return 0.0, 0.0, 0.0
    back, down = n_r < 0.0, n_z < 0.0
    f = turned(f, back, down)  # mirror images are added up in the same order: their weights have the same bits
    total = 0.0
    for k in range(9):
        total += f[k]
    empty = 0.0 if total < 4.5 else 1.0  # a rectangle fills at most four cells of the nine
    low = empty == 0.0
    along_r, along_z, between = (3, 1, 0) if low else (5, 7, 8)
    beside_r, beside_z = abs(empty - f[along_r]), abs(empty - f[along_z])
    off_r = abs(empty - beyond[0 if low != back else 1]) - beside_r
    off_z = abs(empty - beyond[2 if low != down else 3]) - beside_z
    weight = smoothstep(2.0 - 2.0 * abs(off_r) / STRAIGHT) * smoothstep(2.0 - 2.0 * abs(off_z) / STRAIGHT)
    weight *= smoothstep(beside_r / THIN) * smoothstep(beside_z / THIN)
    weight *= smoothstep(min(abs(n_r), abs(n_z)) / SLANT) * smoothstep(abs(2.0 * total - 9.0))
    if weight == 0.0:
        return 0.0, 0.0, 0.0
    width, height = corner_size(abs(empty - f[4]), beside_r, beside_z)
    misfit = (width - beside_z) ** 2 + (height - beside_r) ** 2 + (1.0 - abs(empty - f[between])) ** 2
    for k in range(9):
        if k != 4 and k != along_r and k != along_z and k != between:
            misfit += (empty - f[k]) ** 2
    line = line_misfit(abs(n_r), abs(n_z), f, reversed_if(back, widths), reversed_if(down, heights))
    weight *= smoothstep(4.0 * (line - misfit) / (line + misfit + ALIKE))
    return (width, height, weight) if empty == 0.0 else (-width, -height, weight)


@point
def relative_sizes(n, sizes):
    """Sizes of column or row n and of its neighbours, over its own."""
    return sizes[n - 1] / sizes[n], 1.0, sizes[n + 1] / sizes[n]


@point
def surface(j, i, f, dr, dz, void):
    """(n_r, n_z, width, height, weight) of the surface that bounds the first bodies of the order.

    It is a line with Youngs' outward normal (n_r, n_z) and a `corner`, which has no weight in cells without void; void is the
    share of a mixed cell without bodies. f : fractions in the 17 cells of `add_body`
    """
    n_r, n_z = youngs_normal(j, i, f, dr, dz)
    room = smoothstep(void / ROOM)
    if room == 0.0:
        return n_r, n_z, 0.0, 0.0, 0.0
    beyond = f[9], f[10], f[11], f[12]
    around = f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]
    width, height, weight = corner(n_r, n_z, around, beyond, relative_sizes(i, dr), relative_sizes(j, dz))
    return n_r, n_z, width, height, weight * room


@point
def covered(strip, width, same):
    """Length that two strips of the unit square have in common, at the same or at opposite sides of it."""
    return min(strip, width) if same else max(width - (1.0 - strip), 0.0)


@point
def corner_piece(n_x, n_y, width, height, strip, high):
    """Part of a `corner` in the strip of given width at the low or high x side, as `line_piece` gives it."""
    full = width > 0.0
    near = high == (n_x < 0.0 if full else n_x > 0.0)  # the rectangle lies at the side of the strip
    length = covered(strip, abs(width), near)
    share = abs(height) * length
    off = 0.5 * (strip - length) / strip
    along = share * (off if near == high else -off)
    up = n_y < 0.0 if full else n_y > 0.0
    across = share * 0.5 * (1.0 - abs(height)) * (1.0 if up else -1.0)
    if full:
        return share, along, across
    return strip - share, -along, -across


@point
def piece_of_surface(n_x, n_y, width, height, weight, fraction, strip, high):
    """Material in the strip of given width at the low or high x side, by the weight of a corner and of a line.

    It is in the form of `line_piece`.
    """
    share, along, across = line_piece(n_x, n_y, fraction, strip, high)
    if weight == 0.0:
        return share, along, across
    cut, cut_along, cut_across = corner_piece(n_x, n_y, width, height, strip, high)
    return (weight * cut + (1.0 - weight) * share, weight * cut_along + (1.0 - weight) * along,
            weight * cut_across + (1.0 - weight) * across)
