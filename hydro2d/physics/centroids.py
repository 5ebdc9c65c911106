"""Where in its cell something lies that its neighbours do not place: bodies and void that are narrower than a cell.

A body has in every cell a centroid, (along r, along z) off the middle of the cell, in cells (the unit square of
`physics.interfaces`): 0 in the middle, -1/2 and 1/2 at the faces. That of void follows, since both together are the cell.
explanation/interfaces, thin bodies.
"""

from hydro2d.jit import point
from hydro2d.physics.interfaces import piece_of_surface
from hydro2d.physics.traction import smoothstep

#: what fills one of the cells around is placed by them in full, and what fills none of them by more than this not at all
FILLED = 0.95


@point
def within(offset, fraction):
    """Offset of a centroid from the middle of the cell, such that the fraction of the cell fits in around it."""
    most = 0.5 * (1.0 - fraction)
    return min(max(offset, -most), most)


@point
def box_piece(fraction, along, across, continues, strip, high):
    """What lies of a box in the strip of given width at the low or high x side, as `line_piece` gives it.

    The box has the body's centroid, (along, across) off the middle, and lies in the cell. It is as short along x as that
    allows where the body ends in the cell, and as long where it goes on in the next one (continues 0 to 1).
    explanation/interfaces, equations 7 and 8.
    """
    along, across = within(along, fraction), within(across, fraction)
    longest, tallest = 1.0 - 2.0 * abs(along), 1.0 - 2.0 * abs(across)
    shortest = min(longest, fraction / max(tallest, fraction))
    length = shortest + (longest - shortest) * continues
    first, last = along - 0.5 * length, along + 0.5 * length
    middle = 0.5 - 0.5 * strip
    if high:
        first = max(first, 0.5 - strip)
    else:
        last = min(last, strip - 0.5)
        middle = -middle
    share = fraction / length * max(last - first, 0.0)
    return share, share * (0.5 * (first + last) - middle) / strip, share * across


@point
def goes_on(fraction, before, after):
    """How far something goes on in one of the next cells, 0 to 1.

    fraction, before, after : of it in a cell, before that and after it
    """
    return min(max(before, after) / fraction, 1.0)


@point
def beside(f, along_z):
    """The fractions before and after the middle of 3 x 3 cells."""
    return (f[1], f[7]) if along_z else (f[3], f[5])


@point
def placed(f):
    """How far the cells around place something, and how far they place what is beside it, each 0 to 1.

    f : its fractions in 3 x 3 cells, row by row upwards; the middle one does not count
    """
    most = max(max(max(f[0], f[1]), max(f[2], f[3])), max(max(f[5], f[6]), max(f[7], f[8])))
    least = min(min(min(f[0], f[1]), min(f[2], f[3])), min(min(f[5], f[6]), min(f[7], f[8])))
    return smoothstep((most - FILLED) / (1.0 - FILLED)), smoothstep((1.0 - least - FILLED) / (1.0 - FILLED))


@point
def piece(f, along_z, along, across, bound, strip, high):
    """What lies of something in the strip of given width at the low or high side of a cell, as `line_piece` gives it.

    By the line or the corner where the cells around place both it and what is beside it (`placed`); else by weight by a box of
    it or by a box of what is beside it, whichever is thinner.

    f : its fractions in 3 x 3 cells, row by row upwards; along, across : its centroid, along the sweep and across;
    bound : the surface, with the normal along the sweep first
    """
    fraction = f[4]
    if fraction >= 1.0:
        return strip, 0.0, 0.0
    own, other = placed(f)
    by_line = own * other
    share, shift, lift = 0.0, 0.0, 0.0
    if by_line > 0.0:
        share, shift, lift = piece_of_surface(bound[0], bound[1], bound[2], bound[3], bound[4], fraction, strip, high)
        if by_line == 1.0:
            return share, shift, lift
    before, after = beside(f, along_z)
    by_box = (1.0 - by_line) * (1.0 - own) / ((1.0 - own) + (1.0 - other))
    by_gap = (1.0 - by_line) - by_box
    share, shift, lift = by_line * share, by_line * shift, by_line * lift
    if by_box > 0.0:
        s, a, c = box_piece(fraction, along, across, goes_on(fraction, before, after), strip, high)
        share, shift, lift = share + by_box * s, shift + by_box * a, lift + by_box * c
    if by_gap > 0.0:
        gap = 1.0 - fraction
        s, a, c = box_piece(gap, -along * fraction / gap, -across * fraction / gap, goes_on(gap, 1.0 - before, 1.0 - after),
                            strip, high)
        share, shift, lift = share + by_gap * (strip - s), shift - by_gap * a, lift - by_gap * c
    return share, shift, lift


@point
def pushed(own, other, fraction, fraction_other, change):
    """What an offset of a centroid changes by as something else in the cell grows by `change` of the cell.

    own and other are the centroids' offsets, fraction and fraction_other the shares of the cell. Two slabs that lie side by
    side push each other apart, and one that lies in the midst of the other stays where it is: explanation/interfaces,
    equation 9.
    """
    side = (own - other) / (0.5 * (fraction + fraction_other))
    return 0.5 * change * min(max(side, -1.0), 1.0)
