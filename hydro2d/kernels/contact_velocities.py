"""Velocities of two groups in contact: slave nodes move with their masters, and friction.

The ties are linear and have one solution, the impulses that change the kinetic energy least: (E/M_s + N M^-1 N^T) J = mismatch,
with the weights N of the masters and a compliance E for slaves that are hardly under-filled. Conjugate gradients find it to
TOLERANCE, so that no order of nodes matters (explanation/sliding, equation 6).
"""

from math import sqrt

from hydro2d.jit import apart, point, serial
from hydro2d.kernels.column_ranges import outer_rows
from hydro2d.kernels.contact_geometry import REACH, SHARE
from hydro2d.kernels.extension import SPAN, TIED
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, HOOP
from hydro2d.physics.stress import normal_pressure

#: to what share of the mismatch the ties are met, and in how many steps at most
TOLERANCE, STEPS = 1e-11, 200
#: how often friction and the ties are met in turn
ROUNDS = 3
#: rows of `rubbing`: impulse that the soft group gets from the hard one, and its size
RUB_R, RUB_Z, RUBBED = range(3)
#: rows of `nodes`: slot, group, row and column of a slave, what holds it, and the number of its vertex
SLOT, GROUP, ROW, COLUMN, HELD, VERTEX = range(6)
#: columns of `ties`, two for the components of each: impulse, residual, search direction, what the ties make of that, inverse
#: of the diagonal; then the mass of the slave and the compliance of its tie
IMPULSE, RESIDUAL, SEARCH, IMAGE, DIAGONAL, MASS, COMPLIANCE = 0, 2, 4, 6, 8, 10, 11


@point
def master(n, g, j, i, x, where):
    """(group, j, i) of the n-th master of the slave (j, i) of group g in slot x."""
    place = where[x, g, n]
    if place == TIED:
        return 1 - g, j, i
    return g, j + place // SPAN - REACH, i + place % SPAN - REACH


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


@point
def masters_mobility(g, j, i, x, constrained, number, where, weights, mass):
    """Sum of w^2/m over the masters of a slave, along r and z (1/kg): their velocity, as it feels it, per impulse on them."""
    along_r, along_z = 0.0, 0.0
    for n in range(number[x, g]):
        by, row, column = master(n, g, j, i, x, where)
        held_r, held_z = held(row, column, constrained)
        part = weights[x, g, n] * weights[x, g, n] / mass[by, row, column]
        along_r += 0.0 if held_r else part
        along_z += 0.0 if held_z else part
    return along_r, along_z


@point
def give_tie(g, j, i, x, push_r, push_z, constrained, number, where, weights, mass, u, v, transfer):
    """Takes an impulse from a slave and gives it to its masters, by weight."""
    give(g, j, i, -push_r, -push_z, constrained, mass, u, v, transfer)
    for n in range(number[x, g]):
        by, row, column = master(n, g, j, i, x, where)
        give(by, row, column, weights[x, g, n] * push_r, weights[x, g, n] * push_z, constrained, mass, u, v, transfer)


@apart
def list_ties(j0, j1, constrained, count, contact_nodes, first, strength, number, where, weights, mass, nodes, starts, entries,
              portions, places):
    """(number of tied slaves, number of vertices), all slaves listed with their masters one after another.

    Writes   nodes [6, t]: slot, group, row and column of a slave, what holds it (1 along r, 2 along z, 3 both), and the number
             of its vertex in the list; starts [t + 1], its first master; entries [4, e]: group, row, column and number of a
             master; portions [e, 4]: its weight along r and z, 0 where it is held, and the same over its mass
    Scratch  places [b, j, i], 0 before and after
    """
    tied, e, vertices = 0, 0, 0
    for j in range(j0, j1 + 1):
        for k in range(count[j]):
            i, x = contact_nodes[j, k], first[j] + k
            for g in range(2):
                if strength[x, g] == 0.0:
                    continue
                held_r, held_z = held(j, i, constrained)
                nodes[SLOT, tied], nodes[GROUP, tied], nodes[ROW, tied], nodes[COLUMN, tied] = x, g, j, i
                nodes[HELD, tied] = (1 if held_r else 0) + (2 if held_z else 0)
                if places[g, j, i] == 0:
                    vertices += 1
                    places[g, j, i] = vertices
                nodes[VERTEX, tied] = places[g, j, i] - 1
                starts[tied] = e
                for n in range(number[x, g]):
                    by, row, column = master(n, g, j, i, x, where)
                    held_r, held_z = held(row, column, constrained)
                    w = weights[x, g, n]
                    if places[by, row, column] == 0:
                        vertices += 1
                        places[by, row, column] = vertices
                    entries[0, e], entries[1, e], entries[2, e] = by, row, column
                    entries[3, e] = places[by, row, column] - 1
                    portions[e, 0] = 0.0 if held_r else w
                    portions[e, 1] = 0.0 if held_z else w
                    portions[e, 2] = 0.0 if held_r else w / mass[by, row, column]
                    portions[e, 3] = 0.0 if held_z else w / mass[by, row, column]
                    e += 1
                tied += 1
                starts[tied] = e
    for t in range(tied):
        places[nodes[GROUP, t], nodes[ROW, t], nodes[COLUMN, t]] = 0
    for n in range(e):
        places[entries[0, n], entries[1, n], entries[2, n]] = 0
    return tied, vertices


@point
def mismatch(t, nodes, starts, entries, portions, u, v):
    """Velocity of the t-th slave less that of its masters, along r and z; 0 along what the axis or a wall holds."""
    g, j, i, still = nodes[GROUP, t], nodes[ROW, t], nodes[COLUMN, t], nodes[HELD, t]
    apart_r, apart_z = u[g, j, i], v[g, j, i]
    for e in range(starts[t], starts[t + 1]):
        apart_r -= portions[e, 0] * u[entries[0, e], entries[1, e], entries[2, e]]
        apart_z -= portions[e, 1] * v[entries[0, e], entries[1, e], entries[2, e]]
    return 0.0 if still % 2 == 1 else apart_r, 0.0 if still >= 2 else apart_z


@apart
def image_of_search(tied, vertices, nodes, starts, entries, portions, ties, gain):
    """What the search direction, as impulses, does to the mismatch: N M^-1 N^T p and the compliance; returns p . image.

    Reads    ties [t, SEARCH]
    Writes   ties [t, IMAGE];  scratch gain [n, c], velocities of the listed vertices
    """
    for n in range(vertices):
        gain[n, 0] = 0.0
        gain[n, 1] = 0.0
    for t in range(tied):
        own = nodes[VERTEX, t]
        p_r, p_z = ties[t, SEARCH], ties[t, SEARCH + 1]
        gain[own, 0] += p_r / ties[t, MASS]
        gain[own, 1] += p_z / ties[t, MASS]
        for e in range(starts[t], starts[t + 1]):
            gain[entries[3, e], 0] -= portions[e, 2] * p_r
            gain[entries[3, e], 1] -= portions[e, 3] * p_z
    along_r, along_z = 0.0, 0.0
    for t in range(tied):
        own = nodes[VERTEX, t]
        a_r, a_z = gain[own, 0], gain[own, 1]
        for e in range(starts[t], starts[t + 1]):
            a_r -= portions[e, 0] * gain[entries[3, e], 0]
            a_z -= portions[e, 1] * gain[entries[3, e], 1]
        a_r = 0.0 if nodes[HELD, t] % 2 == 1 else a_r
        a_z = 0.0 if nodes[HELD, t] >= 2 else a_z
        a_r += ties[t, COMPLIANCE] * ties[t, SEARCH]
        a_z += ties[t, COMPLIANCE] * ties[t, SEARCH + 1]
        ties[t, IMAGE] = a_r
        ties[t, IMAGE + 1] = a_z
        along_r += ties[t, SEARCH] * a_r
        along_z += ties[t, SEARCH + 1] * a_z
    return along_r, along_z


@apart
def meet_ties(tied, vertices, constrained, strength, number, where, weights, mass, u, v, nodes, starts, entries, portions, ties,
              gain, taken, transfer):
    """Brings all slaves to the velocities of their masters at once, by conjugate gradients from nothing.

    Updates  u, v [b, j, i]; taken [c, x, b], impulses that slaves have given away;  scratch ties [t, 12], gain [n, c]
    """
    old_r, old_z = 0.0, 0.0
    for t in range(tied):
        x, g, j, i = nodes[SLOT, t], nodes[GROUP, t], nodes[ROW, t], nodes[COLUMN, t]
        ease_r, ease_z = masters_mobility(g, j, i, x, constrained, number, where, weights, mass)
        m = mass[g, j, i]
        own = 1.0 / (strength[x, g] * m)
        ties[t, MASS] = m
        ties[t, COMPLIANCE] = (1.0 / strength[x, g] - 1.0) / m
        r_r, r_z = mismatch(t, nodes, starts, entries, portions, u, v)
        for c in range(2):
            ties[t, IMPULSE + c] = 0.0
            ties[t, DIAGONAL + c] = 1.0 / (own + (ease_r if c == 0 else ease_z))
            ties[t, RESIDUAL + c] = r_r if c == 0 else r_z
            ties[t, SEARCH + c] = ties[t, DIAGONAL + c] * ties[t, RESIDUAL + c]
        old_r += ties[t, SEARCH] * r_r
        old_z += ties[t, SEARCH + 1] * r_z
    enough_r, enough_z = TOLERANCE * TOLERANCE * old_r, TOLERANCE * TOLERANCE * old_z
    for _ in range(STEPS):
        if old_r <= enough_r and old_z <= enough_z:
            break
        along_r, along_z = image_of_search(tied, vertices, nodes, starts, entries, portions, ties, gain)
        step_r = old_r / along_r if old_r > enough_r else 0.0
        step_z = old_z / along_z if old_z > enough_z else 0.0
        new_r, new_z = 0.0, 0.0
        for t in range(tied):
            ties[t, IMPULSE] += step_r * ties[t, SEARCH]
            ties[t, IMPULSE + 1] += step_z * ties[t, SEARCH + 1]
            ties[t, RESIDUAL] -= step_r * ties[t, IMAGE]
            ties[t, RESIDUAL + 1] -= step_z * ties[t, IMAGE + 1]
            new_r += ties[t, DIAGONAL] * ties[t, RESIDUAL] * ties[t, RESIDUAL]
            new_z += ties[t, DIAGONAL + 1] * ties[t, RESIDUAL + 1] * ties[t, RESIDUAL + 1]
        again_r = new_r / old_r if old_r > enough_r else 0.0
        again_z = new_z / old_z if old_z > enough_z else 0.0
        for t in range(tied):
            ties[t, SEARCH] = ties[t, DIAGONAL] * ties[t, RESIDUAL] + again_r * ties[t, SEARCH]
            ties[t, SEARCH + 1] = ties[t, DIAGONAL + 1] * ties[t, RESIDUAL + 1] + again_z * ties[t, SEARCH + 1]
        old_r, old_z = new_r, new_z
    for t in range(tied):
        x, g, j, i = nodes[SLOT, t], nodes[GROUP, t], nodes[ROW, t], nodes[COLUMN, t]
        push_r, push_z = ties[t, IMPULSE], ties[t, IMPULSE + 1]
        give_tie(g, j, i, x, push_r, push_z, constrained, number, where, weights, mass, u, v, transfer)
        taken[0, x, g] += push_r
        taken[1, x, g] += push_z


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


@point
def mobility(g, j, i, x, constrained, strength, number, where, weights, mass):
    """Velocity per impulse (1/kg) of a vertex, of a slave with its masters as far as it is tied to them."""
    m = mass[g, j, i]
    if strength[x, g] == 0.0:
        return 1.0 / m
    along_r, along_z = masters_mobility(g, j, i, x, constrained, number, where, weights, mass)
    ease = max(along_r, along_z)
    return strength[x, g] * ease / (1.0 + m * ease) + (1.0 - strength[x, g]) / m


@apart
def rub_on(g, j, i, x, push_r, push_z, constrained, strength, number, where, weights, mass, u, v, taken, transfer):
    """An impulse on a vertex; a slave passes on to its masters what keeps it moving with them."""
    give(g, j, i, push_r, push_z, constrained, mass, u, v, transfer)
    if strength[x, g] > 0.0:
        m = mass[g, j, i]
        along_r, along_z = masters_mobility(g, j, i, x, constrained, number, where, weights, mass)
        pass_r, pass_z = strength[x, g] * push_r / (1.0 + m * along_r), strength[x, g] * push_z / (1.0 + m * along_z)
        give_tie(g, j, i, x, pass_r, pass_z, constrained, number, where, weights, mass, u, v, transfer)
        taken[0, x, g] += pass_r
        taken[1, x, g] += pass_z


@apart
def rub(j, i, x, dt, friction, constrained, strength, number, where, weights, metrics, dz, contact_columns, line, normal,
        sig_rr, sig_zz, sig_rz, mass, u, v, taken, rubbing, transfer):
    """Friction between the two groups at a contact node at which they touch.

    Along the tangent to the normal by which they close least there is at most friction times the normal force on the surface.
    """
    w_r, w_z = u[1, j, i] - u[0, j, i], v[1, j, i] - v[0, j, i]
    way, closing = 0, 1e300
    for other in range(3):
        w = normal[other, 0, j, i] * w_r + normal[other, 1, j, i] * w_z
        way = other if w < closing else way
        closing = min(closing, w)
    n_r, n_z = normal[way, 0, j, i], normal[way, 1, j, i]
    along_r, along_z = w_r - closing * n_r, w_z - closing * n_z
    slip = sqrt(along_r * along_r + along_z * along_z)
    if slip == 0.0:
        return
    reduced = 1.0 / (mobility(0, j, i, x, constrained, strength, number, where, weights, mass)
                     + mobility(1, j, i, x, constrained, strength, number, where, weights, mass))
    force = pressed(j, i, n_r, n_z, contact_columns, metrics, dz, line, sig_rr, sig_zz, sig_rz)
    drag = min(reduced * slip, max(friction * force * dt - rubbing[RUBBED, x], 0.0))
    drag_r, drag_z = drag * along_r / slip, drag * along_z / slip
    rubbing[RUBBED, x] += drag
    rubbing[RUB_R, x] += drag_r
    rubbing[RUB_Z, x] += drag_z
    rub_on(0, j, i, x, drag_r, drag_z, constrained, strength, number, where, weights, mass, u, v, taken, transfer)
    rub_on(1, j, i, x, -drag_r, -drag_z, constrained, strength, number, where, weights, mass, u, v, taken, transfer)


@apart
def warm_up(g, j, i, x, made, number, where, weights, mass, heat):
    """Gives heat (J) to a vertex and the masters of it, if it is a slave, by their masses times the sizes of the weights."""
    total = mass[g, j, i]
    for n in range(number[x, g]):
        by, row, column = master(n, g, j, i, x, where)
        total += abs(weights[x, g, n]) * mass[by, row, column]
    heat[g, j, i] += made / total
    for n in range(number[x, g]):
        by, row, column = master(n, g, j, i, x, where)
        heat[by, row, column] += made * abs(weights[x, g, n]) / total


@serial
def settle(parts, dt, friction, constrained, metrics, dz, contact_columns, line, contact_node_count, contact_nodes, first_slot,
           contact_normal, touch, strength, masters, where, weights, sig_rr, sig_zz, sig_rz, mass, u, v, nodes, starts, entries,
           portions, places, impulses, gain, taken, rubbing, transfer):
    """Velocities of both groups at contact nodes, from those that the forces alone would give.

    Slave nodes move with masters of their group, and groups that touch rub: impulses that keep the momentum.

    Reads    what find_extensions wrote; mass [b, j, i]; contact_normal [3, 2, j, i], touch; line, sig_.. [j, i]
    Updates  u, v [b, j, i]; adds to transfer[4, j]
    Writes   taken [c, x, b], impulses that slaves have given away; rubbing [3, x]; what list_ties writes
    Scratch  impulses [t, 12], gain [n, c]
    """
    j0, j1 = outer_rows(parts)
    for x in range(first_slot[j1 + 1]):
        for c in range(2):
            for g in range(2):
                taken[c, x, g] = 0.0
        for c in range(3):
            rubbing[c, x] = 0.0
    tied, vertices = list_ties(j0, j1, constrained, contact_node_count, contact_nodes, first_slot, strength, masters, where,
                               weights, mass, nodes, starts, entries, portions, places)
    meet_ties(tied, vertices, constrained, strength, masters, where, weights, mass, u, v, nodes, starts, entries, portions,
              impulses, gain, taken, transfer)
    for _ in range(ROUNDS if friction > 0.0 else 0):
        for j in range(j0, j1 + 1):
            for k in range(contact_node_count[j]):
                if touch[j, contact_nodes[j, k]] > 0.0:
                    rub(j, contact_nodes[j, k], first_slot[j] + k, dt, friction, constrained, strength, masters, where, weights,
                        metrics, dz, contact_columns, line, contact_normal, sig_rr, sig_zz, sig_rz, mass, u, v, taken, rubbing,
                        transfer)
        meet_ties(tied, vertices, constrained, strength, masters, where, weights, mass, u, v, nodes, starts, entries, portions,
                  impulses, gain, taken, transfer)


@serial
def warm_contact(parts, contact_node_count, contact_nodes, first_slot, strength, masters, where, weights, mass, u0, v0, u, v,
                 nodes, starts, entries, portions, taken, rubbing, heat, transfer):
    """Heat of the impulses at contact nodes.

    An impulse J between two velocities makes the heat J . (w0 + w1)/2, w their difference at either end of the step: that is
    what the work of the cells and the kinetic energy differ by (explanation/sliding, contact). At the end all has acted, as
    the dashpots of an edge on which masters lie.

    Reads    what find_extensions and settle wrote; mass, u0, v0, u, v [b, j, i]
    Updates  heat [b, j, i], J per kg of the group's mass at a vertex
    Writes   transfer[:4, j]: axial momentum that the soft group gains from the hard one, heat of the ties to the other group,
             of friction, and of under-filled nodes
    """
    j0, j1 = outer_rows(parts)
    t = 0
    for j in range(j0, j1 + 1):
        for row in range(4):
            transfer[row, j] = 0.0
        for k in range(contact_node_count[j]):
            i, x = contact_nodes[j, k], first_slot[j] + k
            w_r = 0.5 * ((u0[1, j, i] - u0[0, j, i]) + (u[1, j, i] - u[0, j, i]))
            w_z = 0.5 * ((v0[1, j, i] - v0[0, j, i]) + (v[1, j, i] - v[0, j, i]))
            made = rubbing[RUB_R, x] * w_r + rubbing[RUB_Z, x] * w_z
            if made != 0.0:
                warm_up(0, j, i, x, made, masters, where, weights, mass, heat)
            transfer[0, j] += rubbing[RUB_Z, x]
            transfer[2, j] += made
            for g in range(2):
                if strength[x, g] == 0.0:
                    continue
                before_r, before_z = mismatch(t, nodes, starts, entries, portions, u0, v0)
                after_r, after_z = mismatch(t, nodes, starts, entries, portions, u, v)
                t += 1
                made = 0.5 * (taken[0, x, g] * (before_r + after_r) + taken[1, x, g] * (before_z + after_z))
                warm_up(g, j, i, x, made, masters, where, weights, mass, heat)
                tied = weights[x, g, masters[x, g] - 1] if where[x, g, masters[x, g] - 1] == TIED else 0.0
                transfer[0, j] += tied * (taken[1, x, g] if g == 1 else -taken[1, x, g])
                transfer[1, j] += tied * made
                transfer[3, j] += (1.0 - tied) * made
