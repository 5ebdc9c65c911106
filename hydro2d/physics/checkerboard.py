"""Checkerboards of a field of cells: what goes up and down from cell to cell (explanation/sliding, equation 10)."""

from hydro2d.jit import point

#: rows of `checkerboard`: weight of a vertex, and the checkerboards of the pressure and the deviators around it, Pa
COUNTS, OF_P, OF_RR, OF_ZZ, OF_RZ = range(5)


@point
def checkerboard_of(j, i, a):
    """(a00 - a01 + a11 - a10)/4 of the four cells around vertex (j, i): the size of a checkerboard."""
    return 0.25 * ((a[j - 1, i - 1] + a[j, i]) - (a[j - 1, i] + a[j, i - 1]))


@point
def least_of(a, b, c, d, of_a, of_b, of_c, of_d):
    """Least of four non-negative numbers, each counted by its weight; one without weight does not count."""
    most = max(max(of_a * a, of_b * b), max(of_c * c, of_d * d))
    a, b = of_a * a + (1.0 - of_a) * most, of_b * b + (1.0 - of_b) * most
    c, d = of_c * c + (1.0 - of_c) * most, of_d * d + (1.0 - of_d) * most
    return min(min(a, b), min(c, d))


@point
def cell_excess(of, j, i, checkerboard):
    """Excess of a cell over the cells around it (Pa): the least of the checkerboards at its vertices.

    0 where they are not of one sign, as in every field that the mesh resolves. Vertices count by their weights, and at least
    two must count.
    """
    of_a, of_b = checkerboard[COUNTS, j, i], checkerboard[COUNTS, j, i + 1]
    of_c, of_d = checkerboard[COUNTS, j + 1, i], checkerboard[COUNTS, j + 1, i + 1]
    second = max(min(max(of_a, of_b), max(of_c, of_d)), max(min(of_a, of_b), min(of_c, of_d)))
    if second == 0.0:
        return 0.0
    a, b = checkerboard[of, j, i], -checkerboard[of, j, i + 1]
    c, d = -checkerboard[of, j + 1, i], checkerboard[of, j + 1, i + 1]
    above = least_of(max(a, 0.0), max(b, 0.0), max(c, 0.0), max(d, 0.0), of_a, of_b, of_c, of_d)
    below = least_of(max(-a, 0.0), max(-b, 0.0), max(-c, 0.0), max(-d, 0.0), of_a, of_b, of_c, of_d)
    return second * (above - below)


@point
def left_face(m, j, i, vof, room):
    """Volume that the left face of cell (j, i) sweeps in addition, if both of its cells are full of body m."""
    return 0.125 * (room[j, i - 1] - room[j, i]) if vof[m, j, i - 1] == 1.0 and vof[m, j, i] == 1.0 else 0.0


@point
def lower_face(m, j, i, vof, room):
    """Volume that the lower face of cell (j, i) sweeps in addition, if both of its cells are full of body m."""
    return 0.125 * (room[j - 1, i] - room[j, i]) if vof[m, j - 1, i] == 1.0 and vof[m, j, i] == 1.0 else 0.0
