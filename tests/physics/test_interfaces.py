"""Lines in the unit square, and normals from the cells around."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hydro2d.physics import interfaces
from tests.physics.continuity import changes_in_proportion, largest_jump

line_constant = interfaces.line_constant.py_func
area_below = interfaces.area_below.py_func
centroid_below = interfaces.centroid_below.py_func
line_piece = interfaces.line_piece.py_func
line_centre = interfaces.line_centre.py_func
cumulative = interfaces.cumulative.py_func
youngs_normal = interfaces.youngs_normal.py_func
add_body = interfaces.add_body.py_func
at_most_full = interfaces.at_most_full.py_func
line_misfit = interfaces.line_misfit.py_func
corner = interfaces.corner.py_func
relative_sizes = interfaces.relative_sizes.py_func
surface = interfaces.surface.py_func
corner_piece = interfaces.corner_piece.py_func
piece_of_surface = interfaces.piece_of_surface.py_func
turned = interfaces.turned.py_func
reversed_if = interfaces.reversed_if.py_func

#: components of a normal large enough for a fair comparison with polygons, and small ones
COMPONENT = st.floats(0.01, 0.99)
SIGN = st.sampled_from([-1.0, 1.0])
UNIT = st.floats(0.0, 1.0)
WIDTH = st.floats(1e-9, 1.0 - 1e-9)  # a strip of zero width never occurs


def cut(polygon, n1, n2, level):
    """(part of a convex polygon with n1 x + n2 y <= level, where its border meets the line)."""
    kept, crossings = [], []
    for (x0, y0), (x1, y1) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        d0, d1 = n1 * x0 + n2 * y0 - level, n1 * x1 + n2 * y1 - level
        if d0 <= 0.0:
            kept.append((x0, y0))
        if (d0 < 0.0 < d1) or (d1 < 0.0 < d0):
            t = d0 / (d0 - d1)
            crossings.append((x0 + t * (x1 - x0), y0 + t * (y1 - y0)))
            kept.append(crossings[-1])
    return kept, crossings


def area(polygon) -> float:
    ends = polygon[1:] + polygon[:1]
    return 0.5 * sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(polygon, ends, strict=True))


def moments(polygon):
    """(area, integrals of x and of y) of a polygon."""
    total = np.zeros(3)
    for (x0, y0), (x1, y1) in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        total += (x0 * y1 - x1 * y0) * np.array([0.5, (x0 + x1) / 6.0, (y0 + y1) / 6.0])
    return tuple(total)


def block(left, right):
    return [(left, 0.0), (right, 0.0), (right, 1.0), (left, 1.0)]


def signed_line(nx, up, place):
    """(nx, ny, level) of a line through the square at a share `place` of its way across."""
    ny = (1.0 - abs(nx)) * up
    return nx, ny, min(nx, 0.0) + min(ny, 0.0) + place


# ---------------------------------------------------------------------------------------------------- area and line


@given(COMPONENT, st.floats(-0.5, 1.5))
def test_the_area_below_a_line_is_that_of_the_polygon(m1, alpha):
    assert area_below(m1, 1.0 - m1, alpha) == pytest.approx(area(cut(block(0.0, 1.0), m1, 1.0 - m1, alpha)[0]), abs=1e-12)


def by_integration(m1, m2, alpha):
    """`centroid_below` by Gauss quadrature over y, between the heights at which the line meets the sides."""
    ends = sorted({0.0, 1.0, *(min(max((alpha - m1 * x) / m2, 0.0), 1.0) for x in (0.0, 1.0))})
    nodes, weights = np.polynomial.legendre.leggauss(4)
    total = np.zeros(3)
    for low, high in zip(ends, ends[1:], strict=False):
        y = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        x = np.clip((alpha - m2 * y) / m1, 0.0, 1.0)
        total += 0.5 * (high - low) * (np.stack([x, 0.5 * x**2, x * y]) @ weights)
    return total[0], total[1] - 0.5 * total[0], total[2] - 0.5 * total[0]


@given(COMPONENT, COMPONENT, st.floats(0.001, 0.999))
def test_the_centroid_below_a_line_is_that_of_an_integration(m1, m2, place):
    """Even for a normal of any length, as in a strip."""
    alpha = place * (m1 + m2)
    share, x, y = centroid_below(m1, m2, alpha)
    assert share == area_below(m1, m2, alpha)
    assert (share, share * x, share * y) == pytest.approx(by_integration(m1, m2, alpha), abs=1e-12)
    exchanged = centroid_below(m2, m1, alpha)
    assert exchanged == ((share, y, x) if m1 != m2 else pytest.approx((share, y, x), abs=1e-15))


@given(UNIT, st.floats(1e-9, 1.0 - 1e-9))
def test_the_area_below_the_line_of_a_fraction_is_the_fraction(m1, fraction):
    """To 1e-7, below which a line is treated as level."""
    assert area_below(m1, 1.0 - m1, line_constant(m1, 1.0 - m1, fraction)) == pytest.approx(fraction, abs=1e-7)


@given(UNIT, UNIT)
def test_the_line_is_the_same_from_either_side(m1, fraction):
    """Exchanged axes, and material and void exchanged."""
    alpha = line_constant(m1, 1.0 - m1, fraction)
    assert line_constant(1.0 - m1, m1, fraction) == alpha
    assert line_constant(m1, 1.0 - m1, 1.0 - fraction) == pytest.approx(1.0 - alpha, abs=1e-7)


# ---------------------------------------------------------------------------------------------------------- strips


def piece_of(polygon, width, high):
    """(share, moments) of a polygon in a strip as `line_piece` gives them; zero for no polygon."""
    if len(polygon) < 3:
        return 0.0, 0.0, 0.0
    share, moment_x, moment_y = moments(polygon)
    middle = 1.0 - 0.5 * width if high else 0.5 * width
    return share, (moment_x - share * middle) / width, moment_y - 0.5 * share


@given(COMPONENT, SIGN, SIGN, st.floats(0.02, 0.98), st.floats(0.01, 0.99), st.booleans())
def test_a_strip_holds_the_polygon_that_it_cuts_out(nx, side, up, place, width, high):
    """Its share, and where it lies."""
    nx, ny, level = signed_line(nx * side, up, place)
    fraction = area(cut(block(0.0, 1.0), nx, ny, level)[0])
    strip = block(1.0 - width, 1.0) if high else block(0.0, width)
    part = cut(strip, nx, ny, level)[0]
    share, along, across = line_piece(nx, ny, fraction, width, high)
    expected = piece_of(part, width, high)
    assert share == pytest.approx(area(part) if part else 0.0, abs=1e-12)
    assert (share, across) == pytest.approx((expected[0], expected[2]), abs=1e-12)
    assert along == pytest.approx(expected[1], abs=1e-12 / width)


def cancellation(m1, m2):
    """Accuracy of an area: differences of squares over the smaller component; below 1e-7 the line is level."""
    return 2e-15 + min(1e-7, 1e-15 / max(min(abs(m1), abs(m2)), 1e-300))


@given(st.floats(-1.0, 1.0), st.booleans(), UNIT, WIDTH)
def test_strips_add_up_to_the_cell(nx, up, fraction, width):
    """Their shares to its fraction, and their moments to that of all of it."""
    ny = (1.0 - abs(nx)) * (1.0 if up else -1.0)
    low, low_along, low_across = line_piece(nx, ny, fraction, width, False)
    high, high_along, high_across = line_piece(nx, ny, fraction, 1.0 - width, True)
    whole, along, across = line_piece(nx, ny, fraction, 1.0, True)
    small = cancellation(nx, ny)
    assert whole == pytest.approx(fraction, abs=small)
    assert low + high == pytest.approx(fraction, abs=2.0 * small)
    assert -small <= low <= width + small
    assert -small <= high <= 1.0 - width + small
    together = low_along * width + low * 0.5 * (width - 1.0) + high_along * (1.0 - width) + high * 0.5 * width
    assert together == pytest.approx(along, abs=4.0 * small)
    assert low_across + high_across == pytest.approx(across, abs=4.0 * small)


# ---------------------------------------------------------------------------------------------------------- centre


@given(COMPONENT, SIGN, SIGN, st.floats(0.02, 0.98))
def test_the_centre_of_a_line_is_halfway_between_its_ends(nx, side, up, place):
    nx, ny, level = signed_line(nx * side, up, place)
    part, ends = cut(block(0.0, 1.0), nx, ny, level)
    if len(ends) == 2:  # a line through a corner of the square meets it in a vertex
        assert line_centre(nx, ny, area(part)) == pytest.approx(tuple(np.mean(ends, axis=0)), abs=1e-11)


# ---------------------------------------------------------------------------------------------------------- nesting

ORDER = np.array([2, 0, 1])


def test_round_off_does_not_overfill_a_cell():
    vof = np.array([[[0.5]], [[0.5000001]], [[0.0]]])
    assert cumulative(0, 0, 2, ORDER, vof) == 1.0


# ---------------------------------------------------------------------------------------------------------- normals

#: sizes and centres of 5 by 5 cells
DR, DZ = np.array([9.0, 1.0, 2.0, 1.5, 9.0]), np.array([9.0, 0.5, 0.8, 2.0, 9.0])
RC, ZC = (np.cumsum(sizes) - 0.5 * sizes for sizes in (DR, DZ))


def plane(by_r, by_z):
    """A fraction that is linear in r and z, a half in cell (2, 2), unknown beyond the cells around it."""
    f = 0.5 + by_z * (ZC - ZC[2])[:, None] + by_r * (RC - RC[2])[None, :]
    f[[0, -1]] = np.nan
    f[:, [0, -1]] = np.nan
    return f


#: cells without anything
NOTHING = (0.0,) * 17


def sums_of(*bodies, j=2, i=2):
    """Fractions of bodies together in the cells around cell (j, i)."""
    f = NOTHING
    for m in range(len(bodies)):
        f = add_body(m, j, i, np.array(bodies), f)
    return at_most_full(f)


def normal_of(*bodies, dr=DR, dz=DZ):
    return youngs_normal(2, 2, sums_of(*bodies), dr, dz)


@pytest.mark.parametrize("n", range(17))
def test_no_cell_is_more_than_full(n):
    f = tuple(1.25 if k == n else 0.05 * k for k in range(17))
    assert at_most_full(f) == tuple(1.0 if k == n else 0.05 * k for k in range(17))


GRADIENT = st.floats(-0.1, 0.1).filter(lambda value: abs(value) > 1e-3)


@given(GRADIENT, GRADIENT)
def test_the_normal_of_a_linear_fraction_points_against_its_gradient_in_the_unit_cell(by_r, by_z):
    """Even where the cells differ in size: across cell (2, 2) it falls by 2 by_r and 0.8 by_z."""
    fall = np.array([-2.0 * by_r, -0.8 * by_z])
    np.testing.assert_allclose(normal_of(plane(by_r, by_z)), fall / np.abs(fall).sum(), rtol=1e-10)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_a_uniform_fraction_has_no_normal(share):
    assert normal_of(np.full((5, 5), share)) == (0.0, 0.0)


def test_mirrored_fractions_have_mirrored_normals_to_the_bit():
    f = np.random.default_rng(6).uniform(size=(5, 5))
    n_r, n_z = normal_of(f)
    assert normal_of(f[:, ::-1], dr=DR[::-1]) == (-n_r, n_z)
    assert normal_of(f[::-1], dz=DZ[::-1]) == (n_r, -n_z)


# --------------------------------------------------------------------------------------------------------- corners


def overlap(low, high, edges):
    """Share of each cell between edges that lies between low and high."""
    return np.clip(np.minimum(high, edges[1:]) - np.maximum(low, edges[:-1]), 0.0, None) / np.diff(edges)


def rectangle(r, z, sizes=(DR, DZ)):
    """Fractions of 5 x 5 cells that a rectangle from r[0] to r[1] and z[0] to z[1] fills; lengths from the low corner."""
    return np.outer(overlap(*z, np.append(0.0, np.cumsum(sizes[1]))), overlap(*r, np.append(0.0, np.cumsum(sizes[0]))))


def surface_of(f, dr=DR, dz=DZ, void=None):
    return surface(2, 2, sums_of(f), dr, dz, 1.0 - f[2, 2] if void is None else void)


#: beyond the cells on every side
FAR = 1e3


@given(COMPONENT, COMPONENT, SIGN, SIGN, st.booleans())
def test_a_corner_along_the_mesh_is_found_as_it_is(width, height, to_r, to_z, filled):
    """A rectangle that ends in the middle cell, away from (to_r, to_z); and its complement, where all else is filled."""
    start_r, start_z = DR[:2].sum(), DZ[:2].sum()
    r = (-FAR, start_r + width * DR[2]) if to_r > 0.0 else (start_r + (1.0 - width) * DR[2], FAR)
    z = (-FAR, start_z + height * DZ[2]) if to_z > 0.0 else (start_z + (1.0 - height) * DZ[2], FAR)
    f = rectangle(r, z) if filled else 1.0 - rectangle(r, z)
    n_r, n_z, *size, weight = surface_of(f)
    sign = 1.0 if filled else -1.0
    assert (np.sign(n_r), np.sign(n_z)) == (sign * to_r, sign * to_z)
    np.testing.assert_allclose(size, [sign * width, sign * height], rtol=1e-6)
    if all(0.2 <= side <= 0.9 for side in (width, height)):  # not all but full, and no line of almost the same fractions
        assert weight == 1.0


@given(COMPONENT, SIGN, SIGN, UNIT)
def test_a_slanted_line_stays_a_line(n1, to_r, to_z, place):
    n_r, n_z = to_r * n1, to_z * (1.0 - n1)
    level = min(n_r, 0.0) + min(n_z, 0.0) + place
    f = np.array([[area(cut([(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)], n_r, n_z, level)[0] or [(0.0, 0.0)] * 3)
                   for x in range(-2, 3)] for y in range(-2, 3)])
    assert surface_of(f, np.ones(5), np.ones(5))[4] == 0.0


def test_an_edge_that_is_not_straight_has_no_corner():
    f = rectangle((-FAR, DR[:2].sum() + 0.4 * DR[2]), (-FAR, DZ[:2].sum() + 0.5 * DZ[2]))
    assert surface_of(f)[4] == 1.0
    for change, weight in ((0.45, 1.0), (0.75, 0.5), (1.1, 0.0)):
        bent = f.copy()
        bent[0, 2] += change * interfaces.STRAIGHT
        assert surface_of(bent)[4] == pytest.approx(weight)


@given(COMPONENT, COMPONENT, SIGN, SIGN, st.floats(0.01, 0.99), st.booleans(), st.booleans())
def test_a_strip_has_its_part_of_the_corner(width, height, to_x, to_y, strip, high, filled):
    """A rectangle away from (to_x, to_y), or all but one that lies towards them."""
    left = 0.0 if (to_x > 0.0) == filled else 1.0 - width
    bottom = 0.0 if (to_y > 0.0) == filled else 1.0 - height
    part = [(left, bottom), (left + width, bottom), (left + width, bottom + height), (left, bottom + height)]
    part = cut(cut(part, -1.0, 0.0, strip - 1.0 if high else 0.0)[0], 1.0, 0.0, 1.0 if high else strip)[0]
    share, along, across = piece_of(part, strip, high)
    expected = (share, along, across) if filled else (strip - share, -along, -across)
    size = (width, height) if filled else (-width, -height)
    piece = corner_piece(to_x * 0.5, to_y * 0.5, *size, strip, high)
    assert piece == pytest.approx(expected, abs=1e-13)
    assert piece_of_surface(to_x * 0.5, to_y * 0.5, *size, 1.0, width * height, strip, high) == piece


@given(COMPONENT, SIGN, SIGN, UNIT)
def test_a_line_misses_its_own_fractions_by_nothing_also_where_sizes_differ(n1, to_r, to_z, place):
    assume(1e-6 < place < 1.0 - 1e-6)  # a corner of 1e-9 has the share 1e-18, which rounding loses: no line can follow from it
    n_r, n_z = to_r * n1, to_z * (1.0 - n1)
    level = min(n_r, 0.0) + min(n_z, 0.0) + place
    widths, heights = (0.5, 1.0, 1.3), (0.8, 1.0, 2.0)
    x, y = (-0.5, 0.0, 1.0, 2.3), (-0.8, 0.0, 1.0, 3.0)
    f = [area(cut([(x[k], y[row]), (x[k + 1], y[row]), (x[k + 1], y[row + 1]), (x[k], y[row + 1])], n_r, n_z, level)[0]
              or [(0.0, 0.0)] * 3) / (widths[k] * heights[row]) for row in range(3) for k in range(3)]
    assert line_misfit(n_r, n_z, f, widths, heights) < 1e-18
    f[0] += 0.1
    f[5] -= 0.2
    assert line_misfit(n_r, n_z, f, widths, heights) == pytest.approx(0.05)


def test_a_cell_without_a_slant_or_of_one_kind_has_no_corner():
    f = tuple(rectangle((-FAR, 3.0), (-FAR, 3.0), (np.ones(5), np.ones(5)))[1:4, 1:4].ravel())
    assert corner(0.5, 0.5, f, (1.0, 0.0, 1.0, 0.0), (1.0,) * 3, (1.0,) * 3) == (0.0, 0.0, 0.0)
    f = (1.0, 0.5, 0.0, 1.0, 0.25, 0.0, 0.0, 0.0, 0.0)
    assert corner(1.0, 0.0, f, (1.0, 0.0, 0.5, 0.0), (1.0,) * 3, (1.0,) * 3) == (0.0, 0.0, 0.0)


def test_fractions_are_turned_as_in_a_mirror():
    f = np.arange(9).reshape(3, 3)
    for back in (False, True):
        for down in (False, True):
            seen = f[:: -1 if down else 1, :: -1 if back else 1]
            assert turned(tuple(range(9)), back, down) == tuple(seen.ravel())
    assert reversed_if(True, (0.5, 1.0, 1.5)) == (1.5, 1.0, 0.5)
    assert reversed_if(False, (0.5, 1.0, 1.5)) == (0.5, 1.0, 1.5)


def test_sizes_are_relative_to_the_middle_one():
    assert relative_sizes(1, np.array([1.0, 2.0, 3.0])) == (0.5, 1.0, 1.5)


# ------------------------------------------------------------------------------------------------------- continuity

#: a corner in the middle of 5 x 5 cells of one size, of which 0.2 is filled
ANGLE = rectangle((-FAR, 2.4), (-FAR, 2.5), (np.ones(5), np.ones(5)))


def strips(f, void):
    """Contents of strips of a tenth of the middle cell at all of its sides."""
    n_r, n_z, width, height, weight = surface_of(f, np.ones(5), np.ones(5), void)
    return [piece_of_surface(*along, weight, f[2, 2], 0.1, high) for high in (False, True)
            for along in ((n_r, n_z, width, height), (n_z, n_r, height, width))]


@pytest.mark.parametrize("void", [0.0, 1e-12, interfaces.ROOM])
def test_a_corner_comes_in_with_the_void(void):
    """The strips of line and corner differ by 0.03; the smoothstep rises by at most 1.5 over ROOM."""
    changes_in_proportion(lambda share: strips(ANGLE, share), void, 1.5 / interfaces.ROOM * 0.03)
    assert largest_jump(lambda share: strips(ANGLE, share), -0.1, 0.5) < 1e-11


def slanted(level):
    """Fractions of 5 x 5 cells of one size below the line x + y = level."""
    squares = [[[(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)] for x in range(5)] for y in range(5)]
    return np.array([[area(cut(square, 1.0, 1.0, level)[0] or [(0.0, 0.0)] * 3) for square in row] for row in squares])


@settings(max_examples=200)
@given(st.integers(0, 10**6), st.sampled_from(["corners", "lines", "noise"]), st.sampled_from(["corners", "lines", "noise"]))
def test_strips_do_not_jump_as_the_fractions_change(seed, first, second):
    """Between two patterns, including corners at other places, and full and empty cells.

    The steepest slope is that of the weight, 4/ALIKE, which makes 4e-9 of round-off.
    """
    random = np.random.default_rng(seed)

    def pattern(kind):
        if kind == "noise":
            return random.uniform(size=(5, 5))
        if kind == "lines":
            f = slanted(random.uniform(3.5, 6.5))
        else:
            ends = [(0.0, 2.0 + random.uniform()) if random.uniform() < 0.5 else (2.0 + random.uniform(), 5.0) for _ in "rz"]
            f = rectangle(*ends, (np.ones(5), np.ones(5)))
        f = f if random.uniform() < 0.5 else 1.0 - f
        return 0.95 * f + 0.05 * random.uniform(size=(5, 5))  # no path leads through a cell without a gradient

    one, other = pattern(first), pattern(second)
    assert largest_jump(lambda share: strips((1.0 - share) * one + share * other, 0.5), 0.0, 1.0) < 1e-8


def test_nested_interfaces_keep_within_their_bounds():
    """The lower bound is that of the bodies before, the upper one the rest of the strip and of the cell."""
    nested = interfaces.nested.py_func
    assert nested(0.15, 0.1, 0.2, 0.5, 0.4) == 0.15  # no bound applies
    assert nested(0.05, 0.1, 0.2, 0.5, 0.4) == 0.1  # no less than the bodies before
    assert nested(0.39, 0.1, 0.2, 0.5, 0.4) == pytest.approx(0.3)  # no more than they and this body
    assert nested(0.45, 0.1, 0.9, 1.0, 0.4) == 0.4  # no more than the strip
    assert nested(0.1, 0.1, 0.5, 0.9, 0.4) == pytest.approx(0.3)  # only a tenth of the cell is left for later bodies
