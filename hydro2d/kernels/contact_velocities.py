"""Velocities of two groups in contact: light vertices move with their bodies, groups that touch do not close, friction."""

from math import sqrt

from hydro2d.jit import apart, point, serial
from hydro2d.kernels.contact import EXTENDS, HEAVY, REACH, SHARE, STUCK
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, HOOP
from hydro2d.physics.stress import normal_pressure

#: rounds in which the constraints at shared vertices are met one after another
PASSES = 6
#: rows of `impulse`, what the soft group gets from the hard one: along the normal, along the tangent; their sizes
PUSH_R, PUSH_Z, RUB_R, RUB_Z, PUSHED, RUBBED = range(6)


@point
def leaders(code):
    """How many vertices a light one moves with."""
    return 4 if code >= EXTENDS else 1


@point
def extended_cell(j, i, code):
    """(j, i) of the cell whose linear field a light vertex (j, i) takes, by its code from EXTENDS on."""
    return j + (code - EXTENDS) // (2 * REACH) - REACH, i + (code - EXTENDS) % (2 * REACH) - REACH


@point
def leader(n, g, j, i, code, weights):
    """(group, j, i, weight) of the n-th vertex that vertex (j, i) of group g moves with; `weigh` has set the weights."""
    if code >= EXTENDS:
        row, column = extended_cell(j, i, code)
        return g, row + n // 2, column + n % 2, weights[n, g, j, i]
    if code == STUCK:
        return 1 - g, j, i, 1.0
    return g, j + code // 5 - 2, i + code % 5 - 2, 1.0


@point
def weigh(g, j, i, code, r, z, weights):
    """Weights of the four vertices of the cell whose linear field a light vertex takes.

    They carry the cell's mean velocity and gradient to the vertex, so that a linear field is met exactly, and add up to 1
    (explanation/sliding, equation 5).
    """
    row, column = extended_cell(j, i, code)
    x = (r[i] - 0.5 * (r[column] + r[column + 1])) / (r[column + 1] - r[column])
    y = (z[j] - 0.5 * (z[row] + z[row + 1])) / (z[row + 1] - z[row])
    for n in range(4):
        weights[n, g, j, i] = 0.25 + 0.5 * ((x if n % 2 == 1 else -x) + (y if n // 2 == 1 else -y))


@point
def held(j, i, still):
    """Whether the axis or a wall holds a vertex along r, and along z."""
    return i == still[0] or i == still[1], j == still[2] or j == still[3]


@point
def give(g, j, i, push_r, push_z, still, mass, u, v, exchange):
    """An impulse to a vertex; the axis and walls take their component."""
    held_r, held_z = held(j, i, still)
    if not held_r:
        u[g, j, i] += push_r / mass[g, j, i]
    if held_z:
        exchange[4, j] += push_z
    else:
        v[g, j, i] += push_z / mass[g, j, i]


@apart
def yielding(g, j, i, code, still, weights, mass):
    """Sum of w^2/m over the vertices that a light one moves with, along r and z (1/kg): its velocity per impulse on them."""
    along_r, along_z = 0.0, 0.0
    for n in range(leaders(code)):
        by, row, column, weight = leader(n, g, j, i, code, weights)
        held_r, held_z = held(row, column, still)
        part = weight * weight / mass[by, row, column]
        along_r += 0.0 if held_r else part
        along_z += 0.0 if held_z else part
    return along_r, along_z


@apart
def hand_over(g, j, i, code, push_r, push_z, still, weights, mass, u, v, taken, exchange):
    """Gives the vertices that a light one moves with, by weight, an impulse that it loses; `taken` counts it."""
    taken[0, g, j, i] += push_r
    taken[1, g, j, i] += push_z
    for n in range(leaders(code)):
        by, row, column, weight = leader(n, g, j, i, code, weights)
        give(by, row, column, weight * push_r, weight * push_z, still, mass, u, v, exchange)


@apart
def fall_in(g, j, i, code, still, weights, mass, u, v, ease, taken, exchange):
    """Brings a light vertex to the velocity of those it moves with, by the least impulse that does."""
    want_r, want_z = 0.0, 0.0
    for n in range(leaders(code)):
        by, row, column, weight = leader(n, g, j, i, code, weights)
        held_r, held_z = held(row, column, still)
        want_r += 0.0 if held_r else weight * u[by, row, column]
        want_z += 0.0 if held_z else weight * v[by, row, column]
    m = mass[g, j, i]
    held_r, held_z = held(j, i, still)
    push_r = 0.0 if held_r else (u[g, j, i] - want_r) / (1.0 / m + ease[0, g, j, i])
    push_z = 0.0 if held_z else (v[g, j, i] - want_z) / (1.0 / m + ease[1, g, j, i])
    hand_over(g, j, i, code, push_r, push_z, still, weights, mass, u, v, taken, exchange)
    u[g, j, i] -= push_r / m
    v[g, j, i] -= push_z / m


@apart
def push_on(g, j, i, code, push_r, push_z, still, weights, mass, u, v, ease, taken, exchange):
    """An impulse on a vertex; a light one and those it moves with take it together, so that it goes on moving with them."""
    if code == HEAVY:
        give(g, j, i, push_r, push_z, still, mass, u, v, exchange)
        return
    m = mass[g, j, i]
    pass_r, pass_z = push_r / (1.0 + m * ease[0, g, j, i]), push_z / (1.0 + m * ease[1, g, j, i])
    hand_over(g, j, i, code, pass_r, pass_z, still, weights, mass, u, v, taken, exchange)
    give(g, j, i, push_r - pass_r, push_z - pass_z, still, mass, u, v, exchange)


@point
def mobility(g, j, i, code, mass, ease):
    """Velocity per impulse (1/kg) of a vertex, of a light one with those it moves with."""
    m = mass[g, j, i]
    if code == HEAVY:
        return 1.0 / m
    soft = max(ease[0, g, j, i], ease[1, g, j, i])
    return soft / (1.0 + m * soft)


@apart
def warm_up(g, j, i, code, made, mass, weights, heat):
    """Gives heat (J) to a vertex, or where it is light to those that it moves with; where it sticks, to both groups."""
    if code == HEAVY:
        heat[g, j, i] += made / mass[g, j, i]
        return
    total = mass[g, j, i] if code == STUCK else 0.0
    for n in range(leaders(code)):
        by, row, column, _ = leader(n, g, j, i, code, weights)
        total += mass[by, row, column]
    for n in range(leaders(code)):
        by, row, column, _ = leader(n, g, j, i, code, weights)
        heat[by, row, column] += made / total
    if code == STUCK:
        heat[g, j, i] += made / total


@point
def pressed(j, i, n_r, n_z, cut, metrics, dz, line, sig_rr, sig_zz, sig_rz):
    """Normal force (N, never negative) on the interface at vertex (j, i): its area there times the mean normal pressure."""
    area_r, area_z, pressure, cells = 0.0, 0.0, 0.0, 0.0
    for row in range(j - 1, j + 1):
        for column in range(i - 1, i + 1):
            if not cut[row, 0] <= column < cut[row, 1]:
                continue
            share = line[SHARE, row, column]
            if share < 0.0:
                continue
            left, low = column < i, row < j
            half = 0.5 * metrics[FACE_R, i] * dz[row]
            area = metrics[AZ_OUT, column] if left else metrics[AZ_IN, column]
            area_r += share * ((half - metrics[HOOP, column] * dz[row]) if left else -(half + metrics[HOOP, column] * dz[row]))
            area_z += share * (area if low else -area)
            pressure += normal_pressure(row, column, n_r, n_z, sig_rr, sig_zz, sig_rz)
            cells += 1.0
    return max(pressure / cells, 0.0) * abs(n_r * area_r + n_z * area_z) if cells > 0.0 else 0.0


@apart
def touch_and_rub(j, i, dt, friction, still, weights, metrics, dz, cut, line, normal, link, sig_rr, sig_zz, sig_rz, mass, u, v,
                  ease, taken, impulse, exchange):
    """Impulses between the two groups at a shared vertex at which they touch.

    Where they close by every normal, the impulse along that by which they close least gives them one normal velocity, unless
    one is light: then the pressure between them is enough. Along the tangent there is at most friction times the normal
    impulse, that one and that of the normal stress on the surface.
    """
    code_s, code_h = link[0, j, i], link[1, j, i]
    both = code_s == HEAVY and code_h == HEAVY
    if not both and friction == 0.0:
        return
    w_r, w_z = u[1, j, i] - u[0, j, i], v[1, j, i] - v[0, j, i]
    way, closing = 0, 1e300
    for other in range(3):
        w = normal[other, 0, j, i] * w_r + normal[other, 1, j, i] * w_z
        way = other if w < closing else way
        closing = min(closing, w)
    n_r, n_z = normal[way, 0, j, i], normal[way, 1, j, i]
    along_r, along_z = w_r - closing * n_r, w_z - closing * n_z
    slip = sqrt(along_r * along_r + along_z * along_z)
    reduced = 1.0 / (mobility(0, j, i, code_s, mass, ease) + mobility(1, j, i, code_h, mass, ease))
    push, drag = reduced * max(closing, 0.0) if both else 0.0, 0.0
    impulse[PUSHED, j, i] += push
    if friction > 0.0 and slip > 0.0:
        force = pressed(j, i, n_r, n_z, cut, metrics, dz, line, sig_rr, sig_zz, sig_rz)
        limit = friction * (impulse[PUSHED, j, i] + force * dt) - impulse[RUBBED, j, i]
        drag = min(reduced * slip, max(limit, 0.0))
        impulse[RUBBED, j, i] += drag
    t_r = along_r / slip if slip > 0.0 else 0.0
    t_z = along_z / slip if slip > 0.0 else 0.0
    impulse[PUSH_R, j, i] += push * n_r
    impulse[PUSH_Z, j, i] += push * n_z
    impulse[RUB_R, j, i] += drag * t_r
    impulse[RUB_Z, j, i] += drag * t_z
    give_r, give_z = push * n_r + drag * t_r, push * n_z + drag * t_z
    push_on(0, j, i, code_s, give_r, give_z, still, weights, mass, u, v, ease, taken, exchange)
    push_on(1, j, i, code_h, -give_r, -give_z, still, weights, mass, u, v, ease, taken, exchange)


@apart
def mismatch(g, j, i, code, still, weights, u0, v0, u, v):
    """Velocity of a light vertex less that of those it moves with, the mean over the step."""
    apart_r, apart_z = u0[g, j, i] + u[g, j, i], v0[g, j, i] + v[g, j, i]
    for n in range(leaders(code)):
        by, row, column, weight = leader(n, g, j, i, code, weights)
        held_r, held_z = held(row, column, still)
        apart_r -= 0.0 if held_r else weight * (u0[by, row, column] + u[by, row, column])
        apart_z -= 0.0 if held_z else weight * (v0[by, row, column] + v[by, row, column])
    return 0.5 * apart_r, 0.5 * apart_z


@serial
def settle(j0, j1, dt, friction, still, r, z, metrics, dz, cut, line, count, shared, normal, touch, link, sig_rr, sig_zz,
           sig_rz, mass, u0, v0, u, v, weights, ease, taken, impulse, heat, exchange):
    """Velocities of both groups at shared vertices, from those that the forces alone would give.

    Light vertices move with others of their group, and groups that touch do not close: each such condition is met by
    impulses that keep the momentum, one after another, by rows, and all of them PASSES times over. An impulse J between two
    velocities makes the heat J . (w0 + w1)/2, w their difference at either end of the step: that is what the work of the cells
    and the kinetic energy differ by (explanation/sliding, contact).

    Reads    link, mass, u0, v0 [b, j, i]; normal [3, 2, j, i], touch; line, sig_.. [j, i]; r, z, the faces of the mesh
    Updates  u, v [b, j, i]; heat [b, j, i], J per kg of the group's mass at a vertex; adds to exchange[4, j]
    Writes   exchange[:4, j]: axial momentum that the rest gains from the hard group, heat of contact, of friction and of light
             vertices
    Scratch  weights [n, b, j, i], what `weigh` gives for light vertices, and ease [c, b, j, i], what `yielding` does; taken
             [c, b, j, i], impulses that they have given away; impulse [6, j, i]
    """
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = shared[j, k]
            for part in range(6):
                impulse[part, j, i] = 0.0
            for g in range(2):
                taken[0, g, j, i] = 0.0
                taken[1, g, j, i] = 0.0
                if link[g, j, i] >= EXTENDS:
                    weigh(g, j, i, link[g, j, i], r, z, weights)
                if link[g, j, i] != HEAVY:
                    ease[0, g, j, i], ease[1, g, j, i] = yielding(g, j, i, link[g, j, i], still, weights, mass)
    for _ in range(PASSES):
        for j in range(j0, j1 + 1):
            for k in range(count[j]):
                i = shared[j, k]
                for g in range(2):
                    if link[g, j, i] != HEAVY:
                        fall_in(g, j, i, link[g, j, i], still, weights, mass, u, v, ease, taken, exchange)
        for j in range(j0, j1 + 1):
            for k in range(count[j]):
                i = shared[j, k]
                if touch[j, i] > 0.0 and link[0, j, i] != STUCK and link[1, j, i] != STUCK:
                    touch_and_rub(j, i, dt, friction, still, weights, metrics, dz, cut, line, normal, link, sig_rr, sig_zz,
                                  sig_rz, mass, u, v, ease, taken, impulse, exchange)
    for j in range(j0, j1 + 1):
        for row in range(4):
            exchange[row, j] = 0.0
        for k in range(count[j]):
            i = shared[j, k]
            w_r = 0.5 * ((u0[1, j, i] - u0[0, j, i]) + (u[1, j, i] - u[0, j, i]))
            w_z = 0.5 * ((v0[1, j, i] - v0[0, j, i]) + (v[1, j, i] - v[0, j, i]))
            pushed = impulse[PUSH_R, j, i] * w_r + impulse[PUSH_Z, j, i] * w_z
            rubbed = impulse[RUB_R, j, i] * w_r + impulse[RUB_Z, j, i] * w_z
            if pushed != 0.0 or rubbed != 0.0:
                warm_up(0, j, i, link[0, j, i], pushed + rubbed, mass, weights, heat)
            exchange[0, j] += impulse[PUSH_Z, j, i] + impulse[RUB_Z, j, i]
            exchange[1, j] += pushed
            exchange[2, j] += rubbed
            for g in range(2):
                code = link[g, j, i]
                if code == HEAVY:
                    continue
                w_r, w_z = mismatch(g, j, i, code, still, weights, u0, v0, u, v)
                made = taken[0, g, j, i] * w_r + taken[1, g, j, i] * w_z
                warm_up(g, j, i, code, made, mass, weights, heat)
                exchange[3, j] += made
                if code == STUCK:
                    exchange[0, j] += taken[1, g, j, i] if g == 1 else -taken[1, g, j, i]
