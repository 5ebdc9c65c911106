"""Light times of an explosive: when a detonation that runs at one speed arrives, straight or around what is no explosive."""

from math import sqrt

from hydro2d.jit import point, serial

#: share of a body that a cell needs for the detonation to pass through it
PASSABLE = 0.5
#: rows of `front`: the point from which the detonation comes straight to the cell, and the time at which it was there
R, Z, TIME = range(3)
#: share of the way, and of a time, below which two are the same
_SAME = 1e-12


@point
def sees(j, i, r, z, r_edges, z_edges, rc, zc, share):
    """Whether the straight way from the centre of cell (j, i) to the point (r, z) lies in cells with at least PASSABLE.

    The cell itself does not count. A way through a corner needs one of the two cells beside it.
    """
    from_r, from_z = rc[i], zc[j]
    along_r, along_z = r - from_r, z - from_z
    step_i, step_j = 1 if along_r > 0.0 else -1, 1 if along_z > 0.0 else -1
    done, clear = 0.0, True
    while clear and done < 1.0:
        to_r = (r_edges[i + 1 if step_i > 0 else i] - from_r) / along_r if along_r != 0.0 else 2.0
        to_z = (z_edges[j + 1 if step_j > 0 else j] - from_z) / along_z if along_z != 0.0 else 2.0
        done = min(to_r, to_z)
        if done >= 1.0 - _SAME:
            break
        if abs(to_r - to_z) < _SAME:
            clear = share[j + step_j, i] >= PASSABLE or share[j, i + step_i] >= PASSABLE
            i += step_i
            j += step_j
        elif to_r < to_z:
            i += step_i
        else:
            j += step_j
        clear = clear and share[j, i] >= PASSABLE
    return clear


@point
def offer(j, i, r, z, time, speed, r_edges, z_edges, rc, zc, share, light, front):
    """Whether the detonation that was at (r, z) at ``time`` arrives at the cell (j, i) before all others known, and is seen.

    Updates  light [j, i], front [3, j, i]
    """
    a, b = rc[i] - r, zc[j] - z
    arrival = time + sqrt(a * a + b * b) / speed
    if arrival >= light[j, i] * (1.0 - _SAME) or not sees(j, i, r, z, r_edges, z_edges, rc, zc, share):
        return False
    light[j, i] = arrival
    front[R, j, i], front[Z, j, i], front[TIME, j, i] = r, z, time
    return True


@serial
def light_points(points, speed, r_edges, z_edges, rc, zc, share, light, front):
    """Arrival from the detonation points in the cells that see one of them.

    Reads    points [n, 3] (r, z, time); r_edges, rc [i], z_edges, zc [j]; share of the body [j, i]
    Updates  light [j, i], front [3, j, i]
    """
    for n in range(points.shape[0]):
        for j in range(share.shape[0]):
            for i in range(share.shape[1]):
                if share[j, i] > 0.0:
                    offer(j, i, points[n, R], points[n, Z], points[n, TIME], speed, r_edges, z_edges, rc, zc, share, light,
                          front)


@serial
def bend_around(speed, r_edges, z_edges, rc, zc, share, light, front):
    """One sweep in each of four orders: a cell takes over the point from which a neighbour was lit, or the neighbour itself.

    The fixed point is that of Theta* (Nash, Daniel, Koenig & Felner, AAAI 2007). explanation/explosives

    Reads    r_edges, rc [i], z_edges, zc [j]; share of the body [j, i]
    Updates  light [j, i], front [3, j, i]
    Returns  the number of cells that are lit earlier than before
    """
    rows, columns = share.shape
    earlier = 0
    for order in range(4):
        for y in range(rows):
            j = y if order < 2 else rows - 1 - y
            for x in range(columns):
                i = x if order % 2 == 0 else columns - 1 - x
                if share[j, i] <= 0.0:
                    continue
                for dj in range(-1, 2):
                    for di in range(-1, 2):
                        jn, at = j + dj, i + di
                        if not (0 <= jn and jn < rows and 0 <= at and at < columns) or share[jn, at] < PASSABLE:
                            continue
                        if light[jn, at] >= light[j, i]:
                            continue
                        if offer(j, i, front[R, jn, at], front[Z, jn, at], front[TIME, jn, at], speed, r_edges, z_edges, rc, zc,
                                 share, light, front):
                            earlier += 1
                        if offer(j, i, rc[at], zc[jn], light[jn, at], speed, r_edges, z_edges, rc, zc, share, light, front):
                            earlier += 1
    return earlier
