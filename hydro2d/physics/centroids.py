"""Place within a cell of bodies and void that are narrower than a cell, so that its neighbours do not give it.

A body has a centroid in every cell, (along r, along z) off the middle of the cell, in cells (the unit square of
`physics.interfaces`): 0 in the middle, -1/2 and 1/2 at the faces. That of void follows, since bodies and void make up the cell.
explanation/interfaces, thin bodies.
"""

from hydro2d.jit import point
from hydro2d.physics.interfaces import piece_of_surface
from hydro2d.physics.traction import smoothstep

#: a body that fills one of the cells around is placed by them in full; one that fills none by more than this, not at all
FILLED = 0.95
#: a fraction below this is a crumb, without length or outline
CRUMB = 0.01
#: growth of a fraction from one cell to the next from which the cell behind that counts in full (`reached`)
GROWING = 0.1


@point
def within(offset, fraction):
    """Offset of a centroid from the middle of the cell, limited so that the fraction of the cell fits around it.

    A fraction that is above 1 by round-off leaves no room on either side.
    """
    most = max(0.5 * (1.0 - fraction), 0.0)
    return min(max(offset, -most), most)


@point
def box_length(fraction, along, across, continues):
    """Length along x of the box of `box_piece`, in cells; (along, across) leave room for the fraction (`within`)."""
    longest, tallest = 1.0 - 2.0 * abs(along), 1.0 - 2.0 * abs(across)
    shortest = min(longest, fraction / max(tallest, fraction))
    return max(shortest + (longest - shortest) * continues, fraction)


@point
def box_piece(fraction, along, across, continues, strip, high):
    """Part of a box in the strip of given width at the low or high x side, as `line_piece` gives it.

    The box has the body's centroid, (along, across) off the middle, and lies in the cell. Along x it is as short as that allows
    where the body ends in the cell, and as long as that allows where it continues in the next one (continues 0 to 1).
    explanation/interfaces, equations 7 and 8.
    """
    along, across = within(along, fraction), within(across, fraction)
    if strip >= 1.0:
        return fraction, fraction * along, fraction * across
    length = box_length(fraction, along, across, continues)
    turned = along if high else -along  # as if the strip were at the high side
    beyond = min(max((0.5 - strip) - (turned - 0.5 * length), 0.0), length)  # part of the length outside the strip
    share = fraction * ((length - beyond) / length)
    off = (turned + 0.5 * beyond - (0.5 - 0.5 * strip)) / strip
    return share, share * (off if high else -off), share * across


@point
def goes_on(fraction, before, after):
    """Degree, 0 to 1, to which a body or void continues in one of the next cells.

    fraction, before, after : its fractions in a cell, before it and after it
    """
    return min(max(before, after) / fraction, 1.0)


@point
def box_ends(fraction, along, across, before, after):
    """Lower and upper end along x of the box of `box_piece`, off the middle of the cell, in cells.

    before, after : fractions of the body in the cells before and after this one along x
    """
    along, across = within(along, fraction), within(across, fraction)
    half = 0.5 * box_length(fraction, along, across, goes_on(fraction, before, after))
    return along - half, along + half


@point
def beside(f, along_z):
    """Fractions before and after the middle of 3 x 3 cells."""
    return (f[1], f[7]) if along_z else (f[3], f[5])


@point
def reached(here, near, far):
    """Part of the fraction of a cell two away that counts for the body in this one: all of it if the body grows towards it."""
    return far * smoothstep((near - here) / GROWING)


@point
def most_beside(f):
    """Largest fraction in the eight cells next to the middle one."""
    return max(max(max(f[0], f[1]), max(f[2], f[3])), max(max(f[5], f[6]), max(f[7], f[8])))


@point
def most_around(f):
    """Largest fraction in the cells around: of the eight next to it, and of those two away as far as they are `reached`."""
    most = most_beside(f)
    axes = max(max(reached(f[4], f[3], f[9]), reached(f[4], f[5], f[10])),
               max(reached(f[4], f[1], f[11]), reached(f[4], f[7], f[12])))
    corners = max(max(reached(f[4], f[0], f[13]), reached(f[4], f[2], f[14])),
                  max(reached(f[4], f[6], f[15]), reached(f[4], f[8], f[16])))
    return max(most, max(axes, corners))


@point
def rest_of(f):
    """Fractions of the 17 cells of `add_body` that are not filled."""
    return (1.0 - f[0], 1.0 - f[1], 1.0 - f[2], 1.0 - f[3], 1.0 - f[4], 1.0 - f[5], 1.0 - f[6], 1.0 - f[7], 1.0 - f[8],
            1.0 - f[9], 1.0 - f[10], 1.0 - f[11], 1.0 - f[12], 1.0 - f[13], 1.0 - f[14], 1.0 - f[15], 1.0 - f[16])


@point
def placed(f):
    """Degree, 0 to 1, to which the cells around place a body or void: in full where it fills one of them.

    f : its fractions in the 17 cells of `add_body`
    """
    near = most_beside(f)
    if near >= 1.0:
        return 1.0
    far = max(max(max(f[9], f[10]), max(f[11], f[12])), max(max(f[13], f[14]), max(f[15], f[16])))
    if max(near, far) <= FILLED:
        return 0.0
    return smoothstep((most_around(f) - FILLED) / (1.0 - FILLED))


@point
def forms(f, no_gap):
    """Weights of the line or the corner, of boxes of the bodies, and of a box of the rest of the cell (`piece`).

    f : the bodies' fractions in the 17 cells of `add_body`;  no_gap : weight with which void has no box, 0 to 1
    """
    own, other = placed(f), no_gap
    if other < 1.0:
        other = max(other, placed(rest_of(f)))
    by_line = own * other
    if by_line == 1.0:
        return 1.0, 0.0, 0.0
    by_box = (1.0 - by_line) * (1.0 - own) / ((1.0 - own) + (1.0 - other))
    return by_line, by_box, max((1.0 - by_line) - by_box, 0.0)


@point
def piece(f, along_z, along, across, form, bound, boxes, strip, high):
    """Part of the first bodies of the order in the strip of given width at the low or high side of a cell, as by `line_piece`.

    It follows the line or the corner where the cells around place both these bodies and the rest of the cell (`placed`); else,
    by weight, the boxes of the bodies or a box of the rest, whichever is thinner.

    f : the bodies' fractions in the 17 cells of `add_body`; along, across : their centroid, along the sweep and across;
    form : the weights, of `forms`;  bound : the surface, with the normal along the sweep first;
    boxes : the part of the strip in the bodies' boxes, in the same form
    """
    fraction = f[4]
    if fraction >= 1.0:
        return strip, 0.0, 0.0
    by_line, by_box, by_gap = form
    share, shift, lift = 0.0, 0.0, 0.0
    if by_line > 0.0:
        share, shift, lift = piece_of_surface(bound[0], bound[1], bound[2], bound[3], bound[4], fraction, strip, high)
        if by_line == 1.0:
            return share, shift, lift
    share, shift, lift = by_line * share, by_line * shift, by_line * lift
    if by_box > 0.0:
        share, shift, lift = share + by_box * boxes[0], shift + by_box * boxes[1], lift + by_box * boxes[2]
    if by_gap > 0.0:
        before, after = beside(f, along_z)
        gap = 1.0 - fraction
        continues = goes_on(gap, 1.0 - before, 1.0 - after)
        s, a, c = box_piece(gap, -along * fraction / gap, -across * fraction / gap, continues, strip, high)
        share, shift, lift = share + by_gap * (strip - s), shift - by_gap * a, lift - by_gap * c
    return share, shift, lift


@point
def side(own, other, fraction, fraction_other):
    """Side of another body or void on which a body lies along one axis, -1 to 1; growth of the other pushes it that way.

    own and other are the centroids' offsets, fraction and fraction_other the shares of the cell. Two slabs side by side push
    each other apart by half the growth of either, and one inside the other stays in place: explanation/interfaces, equation 9.
    """
    return min(max((own - other) / (0.5 * (fraction + fraction_other)), -1.0), 1.0)
