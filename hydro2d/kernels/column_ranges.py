"""Ranges of columns that each body fills in a row, the list of mixed cells, and the active region.

A range (lo, hi) means lo <= i < hi; an empty range is (2**30, 0), so that the union of ranges is a min and a max. Every
other kernel loops over these ranges: a row of void costs nothing, and a pure cell costs only the one body in it.
"""

from hydro2d.jit import cell_rows, kernel, point, rowwise, serial, vertex_rows

NOTHING = 1 << 30


@point
def union(ranges, j0, j1):
    """Smallest range that contains ranges[j0:j1], rows outside the array left out."""
    lo, hi = NOTHING, 0
    for j in range(max(j0, 0), min(j1, ranges.shape[0])):
        lo = min(lo, ranges[j, 0])
        hi = max(hi, ranges[j, 1])
    return lo, hi


@point
def columns(lo, hi):
    """(first column, number of columns) of a range, for loops that the compiler can vectorise.

    It does so where it knows that no index is negative: x is in range(number), i = first + x, and first >= 2, since every mesh
    has two columns of ghosts.
    """
    first = max(lo, 2)
    return first, hi - first


@point
def outer_rows(parts):
    """First row and one past the last of all parts: those of the active box."""
    return parts[0], parts[parts.shape[0] - 1]


@point
def first_row(part, parts, more):
    """First row of a part; the first part has some more rows below the active box."""
    return parts[part] - (more if part == 0 else 0)


@point
def past_row(part, parts, more):
    """One past the last row of a part; the last part has some more rows above the active box, such as its last vertices."""
    return parts[part + 1] + (more if part == parts.shape[0] - 2 else 0)


@point
def copy_beside(old, new, first, lo, hi, last):
    """Copies old[first:last] to new, except lo:hi."""
    for i in range(first, min(lo, last)):
        new[i] = old[i]
    for i in range(max(hi, first), last):
        new[i] = old[i]


@cell_rows
def find_body_ranges(j, w):
    """First column and one past the last in which each body lies, for the rows and columns of the active box.

    A body moves by no more than a cell, so unless `anew` it is looked for around the columns body_ranges[1] that it was in.

    Reads    vof [m, j, i], group [m]
    Updates  body_ranges [n, m, j, 2], of which body_ranges[0] is body_range
    Writes   occupied [b, j, 2], the union over the bodies: for b = 0 all of them, for b = 1 those of group 1
    """
    for b in range(w.occupied.shape[0]):
        w.occupied[b, j, 0] = NOTHING
        w.occupied[b, j, 1] = 0
    for m in range(w.vof.shape[0]):
        row = w.vof[m, j]
        lo = w.i0 if w.anew else max(w.body_ranges[1, m, j, 0] - 1, w.i0)
        end = w.i1 if w.anew else min(w.body_ranges[1, m, j, 1] + 1, w.i1)
        while lo < end and row[lo] == 0.0:
            lo += 1
        hi = max(end, lo)
        while hi > lo and row[hi - 1] == 0.0:
            hi -= 1
        if lo == hi:
            lo, hi = NOTHING, 0
        w.body_ranges[0, m, j, 0] = lo
        w.body_ranges[0, m, j, 1] = hi
        for b in range(w.group[m] + 1):
            w.occupied[b, j, 0] = min(w.occupied[b, j, 0], lo)
            w.occupied[b, j, 1] = max(w.occupied[b, j, 1], hi)


@cell_rows
def find_active_ranges(j, w):
    """Columns that a body can touch within one cycle: those occupied in rows j-2 to j+2, and two more on either side.

    Reads    occupied [b, j, 2]
    Writes   group_ranges[b, 0], the active range [j, 2]
    """
    for b in range(w.occupied.shape[0]):
        lo, hi = union(w.occupied[b], j - 2, j + 3)
        if lo < hi:
            lo = max(lo - 2, w.i0)
            hi = min(hi + 2, w.i1)
        w.group_ranges[b, 0, j, 0] = lo
        w.group_ranges[b, 0, j, 1] = hi


@kernel
def widen_ranges(part, w):
    """Ranges of a row joined with those of its neighbours, for rows j0 - 1 to j1.

    Reads    body_ranges[0], the range of each body, group_ranges[b, 0], the active range
    Writes   body_ranges[1, m, j] joined over rows j-1 to j+1, the cells that a sweep along z can change;
             body_ranges[2, m, j] over j-2 to j+1, the faces through which it flows;
             group_ranges[b, n, j] over the n rows below face or vertex j and the n above
    """
    for j in range(first_row(part, w.parts, 1), past_row(part, w.parts, 1)):
        for m in range(w.body_ranges.shape[1]):
            for n in range(1, 3):
                lo, hi = union(w.body_ranges[0, m], j - n, j + 2)
                w.body_ranges[n, m, j, 0] = lo
                w.body_ranges[n, m, j, 1] = hi
        for b in range(w.group_ranges.shape[0]):
            for n in range(1, w.group_ranges.shape[1]):
                lo, hi = union(w.group_ranges[b, 0], j - n, j + n)
                w.group_ranges[b, n, j, 0] = lo
                w.group_ranges[b, n, j, 1] = hi


@rowwise
def mixed_row(j, active_range, kind, w):
    """Lists the cells of row j in which a body and something else (another body or void) meet.

    Reads    vof [m, j, i], active_range [j, 2]
    Writes   mixed_count [j], mixed [j, k] (columns, ascending)
    Scratch  kind [i]: a thousand per body that fills the cell, one per body in it
    """
    first, n = columns(active_range[j, 0], active_range[j, 1])
    for x in range(n):
        kind[first + x] = 0.0
    for m in range(w.vof.shape[0]):
        f_j = w.vof[m, j]
        for x in range(n):
            i = first + x
            kind[i] += (1000.0 if f_j[i] == 1.0 else 0.0) + (1.0 if f_j[i] > 0.0 else 0.0)
    out = w.mixed[j]
    count = 0
    for x in range(n):
        i = first + x
        out[count] = i
        count += 0 if kind[i] == 0.0 or kind[i] == 1001.0 else 1
    w.mixed_count[j] = count


@cell_rows
def list_mixed(j, part, w):
    """Lists the mixed cells of every row (`mixed_row`).

    Reads    vof [m, j, i], active_range [j, 2]
    Writes   mixed_count [j], mixed [j, k]
    Scratch  scratch [s, part, i]
    """
    mixed_row(j, w.active_range, w.scratch[0, part], w)


@vertex_rows
def moving_columns(j, w):
    """First and one past the last vertex of each row that moves; vertices of a second group follow those of the first.

    Reads    u, v [b, j, i]
    Writes   row_moving [j, 2]
    """
    first = w.i0
    while first <= w.i1 and w.u[0, j, first] == 0.0 and w.v[0, j, first] == 0.0:
        first += 1
    last = w.i1 + 1
    while last > first and w.u[0, j, last - 1] == 0.0 and w.v[0, j, last - 1] == 0.0:
        last -= 1
    w.row_moving[j, 0] = first if first < last else NOTHING
    w.row_moving[j, 1] = last if first < last else 0


@serial
def moving_box(w):
    """Rows and columns of the vertices that move: the ranges of moving_columns joined over the rows.

    Reads    row_moving [j, 2]
    Writes   moving [4]: first row and one past the last, first column and one past the last; the rows are equal if none moves
    """
    j0, last = outer_rows(w.parts)
    j1 = last + 1  # vertices
    w.moving[0], w.moving[1], w.moving[2], w.moving[3] = j1, j1, NOTHING, 0
    for j in range(j0, j1):
        if w.row_moving[j, 1] > 0:
            w.moving[0] = min(w.moving[0], j)
            w.moving[1] = j + 1
            w.moving[2] = min(w.moving[2], w.row_moving[j, 0])
            w.moving[3] = max(w.moving[3], w.row_moving[j, 1])
    w.moving[1] = max(w.moving[1], w.moving[0])
