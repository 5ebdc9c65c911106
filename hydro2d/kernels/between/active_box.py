"""The active box grows ahead of all motion, and is cut into parts, one for each thread (explanation/speed).

Data that a thread has written stay in its processor's cache until it reads them again, so every kernel of a step uses the same
parts. No result depends on them.
"""

from hydro2d.jit import control, serial

#: cells that the active box leads the moving vertices by; one cycle spreads a signal by fewer
MARGIN = 6
#: fewest rows of a part: the sweep along z shares three faces with each neighbour
FEWEST = 4
#: cycles between two cuts: expensive cells move by less than a cell in that time
RECUT = 10
#: cost of a cell full of one body, of a mixed cell, and of an empty one
FULL, MIXED, EMPTY = 10, 200, 1


@serial
def cut(costs, first, last, bounds):
    """First row of each part and one past the last, with about equal sums of costs.

    Reads    costs [j], positive, from row first to last - 1
    Writes   bounds [n + 1]
    """
    number, total, reached, row = bounds.shape[0] - 1, 0, 0, first
    for j in range(first, last):
        total += costs[j]
    bounds[0], bounds[number] = first, last
    for k in range(1, number):
        share = int(total * k / number)
        while row < last and reached + costs[row] <= share:
            reached += costs[row]
            row += 1
        bounds[k] = row
    for k in range(1, number):  # each part has enough rows, and leaves enough for those after it
        bounds[k] = min(max(bounds[k], bounds[k - 1] + FEWEST), last - FEWEST * (number - k))


@control
def grow_box(w):
    """Grows the active box ahead of the moving vertices; sets whether it has grown, and whether it can grow further.

    Reads    moving [4]; mesh_box [4]
    Updates  box [4]
    """
    w.anew = False
    if w.grows and w.moving[0] < w.moving[1]:
        for low in range(0, 4, 2):
            first, last = (w.moving[0] - 1, w.moving[1]) if low == 0 else (w.moving[2] - 1, w.moving[3])
            first, last = max(first - MARGIN, w.mesh_box[low]), min(last + MARGIN, w.mesh_box[low + 1])
            if first < w.box[low] or last > w.box[low + 1]:
                w.box[low], w.box[low + 1], w.anew = min(w.box[low], first), max(w.box[low + 1], last), True
        w.grows = False
        for k in range(4):
            w.grows = w.grows or w.box[k] != w.mesh_box[k]
    w.i0, w.i1 = w.box[2], w.box[3]


@control
def cut_parts(w):
    """Cuts the active box into parts, anew once it has grown and every few cycles; asks for another number of them.

    Reads    box [4]; active_range [j, 2]; mixed_count [j]
    Writes   row_costs [j]; parts [n + 1]
    """
    first, last = w.box[0], w.box[1]
    number = max(min(w.most_parts, (last - first) // FEWEST), 1)
    if number != w.parts.shape[0] - 1:
        w.asks = 1
        return
    w.age += 1
    if number == 1:
        w.parts[0], w.parts[1] = first, last
    elif w.age >= RECUT or w.anew or w.parts[0] != first or w.parts[number] != last:
        for j in range(first, last):
            filled = max(w.active_range[j, 1] - w.active_range[j, 0], 0)
            w.row_costs[j] = FULL * filled + MIXED * w.mixed_count[j] + EMPTY * (w.i1 - w.i0)
        cut(w.row_costs, first, last, w.parts)
        w.age = 0
