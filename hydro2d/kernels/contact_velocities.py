"""Velocities of two groups in contact: slave nodes move with their masters, groups that touch do not close, friction."""

from math import sqrt

from hydro2d.jit import apart, point, serial
from hydro2d.kernels.contact_geometry import EXTENDS, FREE, REACH, SHARE, TIED
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, HOOP
from hydro2d.physics.stress import normal_pressure

#: rounds in which the constraints at contact nodes are met one after another
PASSES = 6
#: rows of `impulse`, what the soft group gets from the hard one: along the normal, along the tangent; their sizes
PUSH_R, PUSH_Z, RUB_R, RUB_Z, PUSHED, RUBBED = range(6)


@point
def number_of_masters(code):
    """How many masters a slave has."""
    return 4 if code >= EXTENDS else 1


@point
def extended_cell(j, i, code):
    """(j, i) of the cell whose linear field a slave (j, i) takes, by its code from EXTENDS on."""
    return j + (code - EXTENDS) // (2 * REACH) - REACH, i + (code - EXTENDS) % (2 * REACH) - REACH


@point
def first_master(g, j, i, code):
    """(group, j, i) of the first master of the slave (j, i) of group g; `master` has the others."""
    if code >= EXTENDS:
        row, column = extended_cell(j, i, code)
        return g, row, column
    if code == TIED:
        return 1 - g, j, i
    return g, j + code // 5 - 2, i + code % 5 - 2


@point
def master(n, row, column, g, j, i, code, weights):
    """(j, i, weight) of the n-th master of the slave (j, i) of group g, the first of which is (row, column)."""
    return row + n // 2, column + n % 2, weights[n, g, j, i] if code >= EXTENDS else 1.0


@point
def weigh(g, j, i, code, r, z, weights):
    """Weights of the four vertices of the cell whose linear field a slave takes.

    They carry the cell's mean velocity and gradient to the vertex, so that a linear field is met exactly, and add up to 1
    (explanation/sliding, equation 5).
    """
    row, column = extended_cell(j, i, code)
    x = (r[i] - 0.5 * (r[column] + r[column + 1])) / (r[column + 1] - r[column])
    y = (z[j] - 0.5 * (z[row] + z[row + 1])) / (z[row + 1] - z[row])
    for n in range(4):
        weights[n, g, j, i] = 0.25 + 0.5 * ((x if n % 2 == 1 else -x) + (y if n // 2 == 1 else -y))


@point
def held(j, i, constrained):
    """Whether the axis or a wall holds a vertex along r, and along z."""
    return i == constrained[0] or i == constrained[1], j == constrained[2] or j == constrained[3]


@point
def give(g, j, i, push_r, push_z, constrained, mass, u, v, transfer):
    """An impulse to a vertex; the axis and walls take their component."""
    held_r, held_z = held(j, i, constrained)
    if not held_r:
        u[g, j, i] += push_r / mass[g, j, i]
    if held_z:
        transfer[4, j] += push_z
    else:
        v[g, j, i] += push_z / mass[g, j, i]


@apart
def masters_mobility(g, j, i, code, constrained, weights, mass):
    """Sum of w^2/m over the masters of a slave, along r and z (1/kg): its velocity per impulse on them."""
    along_r, along_z = 0.0, 0.0
    by, low, left = first_master(g, j, i, code)
    for n in range(number_of_masters(code)):
        row, column, weight = master(n, low, left, g, j, i, code, weights)
        held_r, held_z = held(row, column, constrained)
        part = weight * weight / mass[by, row, column]
        along_r += 0.0 if held_r else part
        along_z += 0.0 if held_z else part
    return along_r, along_z


@point
def give_to_masters(g, j, i, code, push_r, push_z, constrained, weights, mass, u, v, taken, transfer):
    """Gives the masters, by weight, an impulse that their slave loses; `taken` counts it."""
    taken[0, g, j, i] += push_r
    taken[1, g, j, i] += push_z
    by, low, left = first_master(g, j, i, code)
    for n in range(number_of_masters(code)):
        row, column, weight = master(n, low, left, g, j, i, code, weights)
        give(by, row, column, weight * push_r, weight * push_z, constrained, mass, u, v, transfer)


@point
def tie_to_masters(g, j, i, code, constrained, weights, mass, u, v, ease, taken, transfer):
    """Brings a slave to the velocity of its masters, by the least impulse that does."""
    want_r, want_z = 0.0, 0.0
    by, low, left = first_master(g, j, i, code)
    for n in range(number_of_masters(code)):
        row, column, weight = master(n, low, left, g, j, i, code, weights)
        held_r, held_z = held(row, column, constrained)
        want_r += 0.0 if held_r else weight * u[by, row, column]
        want_z += 0.0 if held_z else weight * v[by, row, column]
    m = mass[g, j, i]
    held_r, held_z = held(j, i, constrained)
    push_r = 0.0 if held_r else (u[g, j, i] - want_r) / (1.0 / m + ease[0, g, j, i])
    push_z = 0.0 if held_z else (v[g, j, i] - want_z) / (1.0 / m + ease[1, g, j, i])
    give_to_masters(g, j, i, code, push_r, push_z, constrained, weights, mass, u, v, taken, transfer)
    u[g, j, i] -= push_r / m
    v[g, j, i] -= push_z / m


@apart
def push_on(g, j, i, code, push_r, push_z, constrained, weights, mass, u, v, ease, taken, transfer):
    """An impulse on a vertex; a slave and its masters take it together, so that it goes on moving with them."""
    if code == FREE:
        give(g, j, i, push_r, push_z, constrained, mass, u, v, transfer)
        return
    m = mass[g, j, i]
    pass_r, pass_z = push_r / (1.0 + m * ease[0, g, j, i]), push_z / (1.0 + m * ease[1, g, j, i])
    give_to_masters(g, j, i, code, pass_r, pass_z, constrained, weights, mass, u, v, taken, transfer)
    give(g, j, i, push_r - pass_r, push_z - pass_z, constrained, mass, u, v, transfer)


@point
def mobility(g, j, i, code, mass, ease):
    """Velocity per impulse (1/kg) of a vertex, of a slave with its masters."""
    m = mass[g, j, i]
    if code == FREE:
        return 1.0 / m
    soft = max(ease[0, g, j, i], ease[1, g, j, i])
    return soft / (1.0 + m * soft)


@apart
def warm_up(g, j, i, code, made, mass, weights, heat):
    """Gives heat (J) to a vertex, or to the masters of a slave; in tied contact, to both groups."""
    if code == FREE:
        heat[g, j, i] += made / mass[g, j, i]
        return
    total = mass[g, j, i] if code == TIED else 0.0
    by, low, left = first_master(g, j, i, code)
    for n in range(number_of_masters(code)):
        row, column, _ = master(n, low, left, g, j, i, code, weights)
        total += mass[by, row, column]
    for n in range(number_of_masters(code)):
        row, column, _ = master(n, low, left, g, j, i, code, weights)
        heat[by, row, column] += made / total
    if code == TIED:
        heat[g, j, i] += made / total


@point
def pressed(j, i, n_r, n_z, contact_columns, metrics, dz, line, sig_rr, sig_zz, sig_rz):
    """Normal force (N, never negative) on the interface at vertex (j, i): its area there times the mean normal pressure."""
    area_r, area_z, pressure, cells = 0.0, 0.0, 0.0, 0.0
    for row in range(j - 1, j + 1):
        for column in range(i - 1, i + 1):
            if not contact_columns[row, 0] <= column < contact_columns[row, 1]:
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
def touch_and_rub(j, i, dt, friction, constrained, weights, metrics, dz, contact_columns, line, normal, masters, sig_rr, sig_zz,
                  sig_rz, mass, u, v, ease, taken, impulse, transfer):
    """Impulses between the two groups at a contact node at which they touch.

    Where they close by every normal, the impulse along that by which they close least gives them one normal velocity, unless
    one is a slave: then the pressure between them is enough. Along the tangent there is at most friction times the normal
    impulse, that one and that of the normal stress on the surface. So a slave has none without friction, and is not asked.
    """
    code_s, code_h = masters[0, j, i], masters[1, j, i]
    both = code_s == FREE and code_h == FREE
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
        force = pressed(j, i, n_r, n_z, contact_columns, metrics, dz, line, sig_rr, sig_zz, sig_rz)
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
    push_on(0, j, i, code_s, give_r, give_z, constrained, weights, mass, u, v, ease, taken, transfer)
    push_on(1, j, i, code_h, -give_r, -give_z, constrained, weights, mass, u, v, ease, taken, transfer)


@apart
def mismatch(g, j, i, code, constrained, weights, u0, v0, u, v):
    """Velocity of a slave less that of its masters, the mean over the step."""
    apart_r, apart_z = u0[g, j, i] + u[g, j, i], v0[g, j, i] + v[g, j, i]
    by, low, left = first_master(g, j, i, code)
    for n in range(number_of_masters(code)):
        row, column, weight = master(n, low, left, g, j, i, code, weights)
        held_r, held_z = held(row, column, constrained)
        apart_r -= 0.0 if held_r else weight * (u0[by, row, column] + u[by, row, column])
        apart_z -= 0.0 if held_z else weight * (v0[by, row, column] + v[by, row, column])
    return 0.5 * apart_r, 0.5 * apart_z


@serial
def settle(j0, j1, dt, friction, constrained, r, z, metrics, dz, contact_columns, line, count, contact_nodes, normal, touch,
           masters, sig_rr, sig_zz, sig_rz, mass, u0, v0, u, v, weights, ease, taken, impulse, heat, transfer):
    """Velocities of both groups at contact nodes, from those that the forces alone would give.

    Slave nodes move with masters of their group, and groups that touch do not close: each such condition is met by
    impulses that keep the momentum, one after another, by rows, and all of them PASSES times over. An impulse J between two
    velocities makes the heat J . (w0 + w1)/2, w their difference at either end of the step: that is what the work of the cells
    and the kinetic energy differ by (explanation/sliding, contact).

    Reads    masters, mass, u0, v0 [b, j, i]; normal [3, 2, j, i], touch; line, sig_.. [j, i]; r, z, the faces of the mesh
    Updates  u, v [b, j, i]; heat [b, j, i], J per kg of the group's mass at a vertex; adds to transfer[4, j]
    Writes   transfer[:4, j]: axial momentum that the soft group gains from the hard one, heat of contact, of friction and of
             under-filled nodes
    Scratch  weights [n, b, j, i], what `weigh` gives for slaves, and ease [c, b, j, i], what `masters_mobility` does; taken
             [c, b, j, i], impulses that they have given away; impulse [6, j, i]
    """
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i = contact_nodes[j, k]
            for part in range(6):
                impulse[part, j, i] = 0.0
            for g in range(2):
                taken[0, g, j, i] = 0.0
                taken[1, g, j, i] = 0.0
                if masters[g, j, i] >= EXTENDS:
                    weigh(g, j, i, masters[g, j, i], r, z, weights)
                if masters[g, j, i] != FREE:
                    ease[0, g, j, i], ease[1, g, j, i] = masters_mobility(g, j, i, masters[g, j, i], constrained, weights, mass)
    for _ in range(PASSES):
        for j in range(j0, j1 + 1):
            for k in range(count[j]):
                i = contact_nodes[j, k]
                for g in range(2):
                    if masters[g, j, i] != FREE:
                        tie_to_masters(g, j, i, masters[g, j, i], constrained, weights, mass, u, v, ease, taken, transfer)
        for j in range(j0, j1 + 1):
            for k in range(count[j]):
                i = contact_nodes[j, k]
                code_s, code_h = masters[0, j, i], masters[1, j, i]
                rubs = friction > 0.0 and code_s != TIED and code_h != TIED
                if touch[j, i] > 0.0 and (rubs or (code_s == FREE and code_h == FREE)):
                    touch_and_rub(j, i, dt, friction, constrained, weights, metrics, dz, contact_columns, line, normal, masters,
                                  sig_rr, sig_zz, sig_rz, mass, u, v, ease, taken, impulse, transfer)
    for j in range(j0, j1 + 1):
        for row in range(4):
            transfer[row, j] = 0.0
        for k in range(count[j]):
            i = contact_nodes[j, k]
            w_r = 0.5 * ((u0[1, j, i] - u0[0, j, i]) + (u[1, j, i] - u[0, j, i]))
            w_z = 0.5 * ((v0[1, j, i] - v0[0, j, i]) + (v[1, j, i] - v[0, j, i]))
            pushed = impulse[PUSH_R, j, i] * w_r + impulse[PUSH_Z, j, i] * w_z
            rubbed = impulse[RUB_R, j, i] * w_r + impulse[RUB_Z, j, i] * w_z
            if pushed != 0.0 or rubbed != 0.0:
                warm_up(0, j, i, masters[0, j, i], pushed + rubbed, mass, weights, heat)
            transfer[0, j] += impulse[PUSH_Z, j, i] + impulse[RUB_Z, j, i]
            transfer[1, j] += pushed
            transfer[2, j] += rubbed
            for g in range(2):
                code = masters[g, j, i]
                if code == FREE:
                    continue
                w_r, w_z = mismatch(g, j, i, code, constrained, weights, u0, v0, u, v)
                made = taken[0, g, j, i] * w_r + taken[1, g, j, i] * w_z
                warm_up(g, j, i, code, made, mass, weights, heat)
                transfer[3, j] += made
                if code == TIED:
                    transfer[0, j] += taken[1, g, j, i] if g == 1 else -taken[1, g, j, i]
