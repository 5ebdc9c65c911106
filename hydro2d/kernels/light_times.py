"""Light times of an explosive: arrival of a detonation of constant speed, straight or around cells without explosive."""

from math import sqrt

from hydro2d.jit import point, serial

#: share of a body that a cell needs for the detonation to pass through it
PASSABLE = 0.5
#: rows of `w.front`: the point from which the detonation comes straight to the cell, and the time at which it was there
R, Z, TIME = range(3)
#: relative difference of two paths, or of two times, below which they count as equal
_SAME = 1e-12


@point
def sees(j, i, r, z, w):
    """Whether the straight line from the centre of cell (j, i) to the point (r, z) lies in cells with at least PASSABLE.

    The cell itself does not count. A line through a corner needs one of the two cells next to it.
    """
    from_r, from_z = w.rc[i], w.zc[j]
    along_r, along_z = r - from_r, z - from_z
    step_i, step_j = 1 if along_r > 0.0 else -1, 1 if along_z > 0.0 else -1
    done, clear = 0.0, True
    while clear and done < 1.0:
        to_r = (w.r[i + 1 if step_i > 0 else i] - from_r) / along_r if along_r != 0.0 else 2.0
        to_z = (w.z[j + 1 if step_j > 0 else j] - from_z) / along_z if along_z != 0.0 else 2.0
        done = min(to_r, to_z)
        if done >= 1.0 - _SAME:
            break
        if abs(to_r - to_z) < _SAME:
            clear = w.share[j + step_j, i] >= PASSABLE or w.share[j, i + step_i] >= PASSABLE
            i += step_i
            j += step_j
        elif to_r < to_z:
            i += step_i
        else:
            j += step_j
        clear = clear and w.share[j, i] >= PASSABLE
    return clear


@point
def offer(j, i, r, z, time, w):
    """Whether the detonation from (r, z) at ``time`` reaches cell (j, i) earlier than any known so far, and in a straight line.

    Updates  light [j, i], front [3, j, i]
    """
    a, b = w.rc[i] - r, w.zc[j] - z
    arrival = time + sqrt(a * a + b * b) / w.speed
    if arrival >= w.light[j, i] * (1.0 - _SAME) or not sees(j, i, r, z, w):
        return False
    w.light[j, i] = arrival
    w.front[R, j, i], w.front[Z, j, i], w.front[TIME, j, i] = r, z, time
    return True


@serial
def light_points(w):
    """Arrival times in the cells that see one of the detonation points.

    Reads    points [n, 3] (r, z, time); r, rc [i], z, zc [j]; share [j, i]
    Updates  light [j, i], front [3, j, i]
    """
    for n in range(w.points.shape[0]):
        for j in range(w.share.shape[0]):
            for i in range(w.share.shape[1]):
                if w.share[j, i] > 0.0:
                    offer(j, i, w.points[n, R], w.points[n, Z], w.points[n, TIME], w)


@serial
def bend_around(w):
    """Arrival times after one sweep in each of four orders: a cell is lit from its neighbour's point, or from the neighbour.

    The fixed point is that of Theta* (Nash, Daniel, Koenig & Felner, AAAI 2007). explanation/explosives

    Reads    r, rc [i], z, zc [j]; share [j, i]
    Updates  light [j, i], front [3, j, i]
    Returns  the number of cells that are lit earlier than before
    """
    rows, columns = w.share.shape
    earlier = 0
    for order in range(4):
        for y in range(rows):
            j = y if order < 2 else rows - 1 - y
            for x in range(columns):
                i = x if order % 2 == 0 else columns - 1 - x
                if w.share[j, i] <= 0.0:
                    continue
                for dj in range(-1, 2):
                    for di in range(-1, 2):
                        jn, at = j + dj, i + di
                        if not (0 <= jn and jn < rows and 0 <= at and at < columns) or w.share[jn, at] < PASSABLE:
                            continue
                        if w.light[jn, at] >= w.light[j, i]:
                            continue
                        if offer(j, i, w.front[R, jn, at], w.front[Z, jn, at], w.front[TIME, jn, at], w):
                            earlier += 1
                        if offer(j, i, w.rc[at], w.zc[jn], w.light[jn, at], w):
                            earlier += 1
    return earlier
