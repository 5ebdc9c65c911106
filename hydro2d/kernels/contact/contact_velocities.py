"""Velocities of two groups in contact: slave nodes move with their masters, and friction.

The ties are linear and have one solution, the impulses that change the kinetic energy least: (E/M_s + N M^-1 N^T) J = mismatch,
with the weights N of the masters and a compliance E for slaves that are barely under-filled. Conjugate gradients find it to
TOLERANCE, so the order of nodes does not matter (explanation/sliding, equation 6).
"""

from math import sqrt

from hydro2d.jit import not_inlined, point, serial
from hydro2d.kernels.column_ranges import outer_rows
from hydro2d.kernels.contact.contact_geometry import REACH, SHARE
from hydro2d.kernels.contact.extension import SPAN, TIED
from hydro2d.physics.corner import corner
from hydro2d.physics.edges import is_constrained
from hydro2d.physics.stress import normal_pressure

#: share of the mismatch down to which the ties are solved, and the largest number of steps
TOLERANCE, STEPS = 1e-11, 200
#: number of rounds in which friction and the ties are solved in turn
ROUNDS = 3
#: rows of `friction_impulse`: friction impulse on the soft group from the hard one, and its size
FRICTION_R, FRICTION_Z, FRICTION_SIZE = range(3)
#: rows of `nodes`: slot, group, row and column of a slave
SLOT, GROUP, ROW, COLUMN = range(4)
#: columns of `impulses`, two for the components of each: impulse, residual, the ties' matrix times the search direction,
#: inverse of the diagonal
IMPULSE, RESIDUAL, IMAGE, DIAGONAL = 0, 2, 4, 6


@point
def master(n, g, j, i, x, where):
    """(group, j, i) of the n-th master of the slave (j, i) of group g in slot x."""
    place = where[x, g, n]
    if place == TIED:
        return 1 - g, j, i
    return g, j + place // SPAN - REACH, i + place % SPAN - REACH


@point
def apply_impulse(g, j, i, push_r, push_z, w):
    """Applies an impulse to a vertex; the axis and walls take their component."""
    constrained_r, constrained_z = is_constrained(j, i, w.constrained)
    if not constrained_r:
        w.u[g, j, i] += push_r / w.mass[g, j, i]
    if constrained_z:
        w.transfer[4, j] += push_z
    else:
        w.v[g, j, i] += push_z / w.mass[g, j, i]


@point
def masters_mobility(g, j, i, x, w):
    """Sum of w^2/m over the masters of a slave, along r and z (1/kg): their mean velocity at the slave per impulse on them."""
    along_r, along_z = 0.0, 0.0
    for n in range(w.masters[x, g]):
        by, row, column = master(n, g, j, i, x, w.where)
        constrained_r, constrained_z = is_constrained(row, column, w.constrained)
        part = w.weights[x, g, n] * w.weights[x, g, n] / w.mass[by, row, column]
        along_r += 0.0 if constrained_r else part
        along_z += 0.0 if constrained_z else part
    return along_r, along_z


@point
def apply_tie_impulse(g, j, i, x, push_r, push_z, w):
    """Takes an impulse from a slave and gives it to its masters, by weight."""
    apply_impulse(g, j, i, -push_r, -push_z, w)
    for n in range(w.masters[x, g]):
        by, row, column = master(n, g, j, i, x, w.where)
        apply_impulse(by, row, column, w.weights[x, g, n] * push_r, w.weights[x, g, n] * push_z, w)


@point
def number_entry(e, vertices, w):
    """Gives the vertex of entry e its number and N over its mass; returns the count of numbered vertices.

    Updates  places [b, j, i], number of a vertex, from 1 on;  writes entries [3, e], portions [e, 2:]
    """
    g, j, i = w.entries[0, e], w.entries[1, e], w.entries[2, e]
    new = w.places[g, j, i] == 0
    if new:
        w.places[g, j, i] = vertices + 1
    w.entries[3, e] = w.places[g, j, i] - 1
    w.portions[e, 2], w.portions[e, 3] = w.portions[e, 0] / w.mass[g, j, i], w.portions[e, 1] / w.mass[g, j, i]
    return vertices + 1 if new else vertices


@not_inlined
def list_ties(w):
    """Number of tied slaves, all of them listed with their vertices: their own and those of their masters.

    Writes   nodes [4, t]: slot, group, row and column of a slave; starts [t + 1], its first entry; entries [4, e]: group, row,
             column and number of a vertex, the slave's own first; portions [e, 4]: N, along r and z, 1 for its own and minus
             the weight for a master, 0 where the axis or a wall constrains either of them; and N over the mass
    Scratch  places [b, j, i], 0 before and after
    """
    j0, j1 = outer_rows(w.parts)
    tied, e, vertices = 0, 0, 0
    for j in range(j0, j1 + 1):
        for k in range(w.contact_node_count[j]):
            i, x = w.contact_nodes[j, k], w.first_slot[j] + k
            for g in range(2):
                if w.strength[x, g] == 0.0:
                    continue
                constrained_r, constrained_z = is_constrained(j, i, w.constrained)
                w.nodes[SLOT, tied], w.nodes[GROUP, tied], w.nodes[ROW, tied], w.nodes[COLUMN, tied] = x, g, j, i
                w.starts[tied] = e
                w.entries[0, e], w.entries[1, e], w.entries[2, e] = g, j, i
                w.portions[e, 0], w.portions[e, 1] = 0.0 if constrained_r else 1.0, 0.0 if constrained_z else 1.0
                vertices = number_entry(e, vertices, w)
                for n in range(w.masters[x, g]):
                    e += 1
                    w.entries[0, e], w.entries[1, e], w.entries[2, e] = master(n, g, j, i, x, w.where)
                    master_constrained_r, master_constrained_z = is_constrained(w.entries[1, e], w.entries[2, e], w.constrained)
                    w.portions[e, 0] = 0.0 if constrained_r or master_constrained_r else -w.weights[x, g, n]
                    w.portions[e, 1] = 0.0 if constrained_z or master_constrained_z else -w.weights[x, g, n]
                    vertices = number_entry(e, vertices, w)
                e += 1
                tied += 1
                w.starts[tied] = e
    for n in range(e):
        w.places[w.entries[0, n], w.entries[1, n], w.entries[2, n]] = 0
    return tied


@point
def mismatch(t, u, v, w):
    """Velocity of the t-th slave minus that of its masters, along r and z; 0 where the axis or a wall constrains it."""
    mismatch_r, mismatch_z = 0.0, 0.0
    for e in range(w.starts[t], w.starts[t + 1]):
        mismatch_r += w.portions[e, 0] * u[w.entries[0, e], w.entries[1, e], w.entries[2, e]]
        mismatch_z += w.portions[e, 1] * v[w.entries[0, e], w.entries[1, e], w.entries[2, e]]
    return mismatch_r, mismatch_z


@not_inlined
def assemble(tied, w):
    """Matrix of the ties, N M^-1 N^T plus the compliance, row by row; two ties have an element where they share a vertex.

    Writes   lines [t + 1], the first element of a row; columns [n]; matrix [n, c]
    Scratch  firsts [v + 1] and sharing [2, e], the ties of a vertex; elements [t]
    """
    entries = w.starts[tied]  # at least as many as vertices
    for n in range(entries + 1):
        w.firsts[n] = 0
    for e in range(entries):
        w.firsts[w.entries[3, e] + 1] += 1
    for n in range(entries):
        w.firsts[n + 1] += w.firsts[n]
    for t in range(tied):
        w.elements[t] = -1
        for e in range(w.starts[t], w.starts[t + 1]):
            n = w.entries[3, e]
            w.sharing[0, w.firsts[n]], w.sharing[1, w.firsts[n]] = t, e
            w.firsts[n] += 1  # finally the start of the next vertex's ties
    end = 0
    for t in range(tied):
        w.lines[t] = end
        for e in range(w.starts[t], w.starts[t + 1]):
            n = w.entries[3, e]
            for k in range(w.firsts[n - 1] if n > 0 else 0, w.firsts[n]):
                other, f = w.sharing[0, k], w.sharing[1, k]
                at = w.elements[other]
                if at < w.lines[t]:
                    at = end
                    w.elements[other], w.columns[at], w.matrix[at, 0], w.matrix[at, 1] = at, other, 0.0, 0.0
                    end += 1
                w.matrix[at, 0] += w.portions[e, 0] * w.portions[f, 2]
                w.matrix[at, 1] += w.portions[e, 1] * w.portions[f, 3]
        strength = w.strength[w.nodes[SLOT, t], w.nodes[GROUP, t]]
        compliance = (1.0 / strength - 1.0) / w.mass[w.nodes[GROUP, t], w.nodes[ROW, t], w.nodes[COLUMN, t]]
        for c in range(2):
            own = w.matrix[w.elements[t], c]
            w.matrix[w.elements[t], c] += compliance
            w.impulses[t, DIAGONAL + c] = 1.0 / (own + compliance) if own > 0.0 else 0.0
    w.lines[tied] = end


@not_inlined
def image_of_search(tied, w):
    """Product of the ties' matrix and the search direction; returns search . image, along r and z.

    Reads    search [t, c], and the matrix;  writes impulses [t, IMAGE]
    """
    along_r, along_z = 0.0, 0.0
    for t in range(tied):
        a_r, a_z = 0.0, 0.0
        for n in range(w.lines[t], w.lines[t + 1]):
            a_r += w.matrix[n, 0] * w.search[w.columns[n], 0]
            a_z += w.matrix[n, 1] * w.search[w.columns[n], 1]
        w.impulses[t, IMAGE] = a_r
        w.impulses[t, IMAGE + 1] = a_z
        along_r += w.search[t, 0] * a_r
        along_z += w.search[t, 1] * a_z
    return along_r, along_z


@not_inlined
def solve_ties(tied, w):
    """Brings all slaves to the velocities of their masters together, by conjugate gradients that start from zero.

    Reads    the arrays that list_ties and assemble wrote
    Updates  u, v [b, j, i]; passed_impulse [c, x, b], which slaves have given away
    Scratch  impulses [t, 8], search [t, c]
    """
    old_r, old_z = 0.0, 0.0
    for t in range(tied):
        tie, search = w.impulses[t], w.search[t]
        tie[RESIDUAL], tie[RESIDUAL + 1] = mismatch(t, w.u, w.v, w)
        for c in range(2):
            tie[IMPULSE + c] = 0.0
            search[c] = tie[DIAGONAL + c] * tie[RESIDUAL + c]
        old_r += search[0] * tie[RESIDUAL]
        old_z += search[1] * tie[RESIDUAL + 1]
    enough_r, enough_z = TOLERANCE * TOLERANCE * old_r, TOLERANCE * TOLERANCE * old_z
    for _ in range(STEPS):
        if old_r <= enough_r and old_z <= enough_z:
            break
        along_r, along_z = image_of_search(tied, w)
        step_r = old_r / along_r if old_r > enough_r else 0.0
        step_z = old_z / along_z if old_z > enough_z else 0.0
        new_r, new_z = 0.0, 0.0
        for t in range(tied):
            tie, search = w.impulses[t], w.search[t]
            tie[IMPULSE] += step_r * search[0]
            tie[IMPULSE + 1] += step_z * search[1]
            tie[RESIDUAL] -= step_r * tie[IMAGE]
            tie[RESIDUAL + 1] -= step_z * tie[IMAGE + 1]
            new_r += tie[DIAGONAL] * tie[RESIDUAL] * tie[RESIDUAL]
            new_z += tie[DIAGONAL + 1] * tie[RESIDUAL + 1] * tie[RESIDUAL + 1]
        beta_r = new_r / old_r if old_r > enough_r else 0.0
        beta_z = new_z / old_z if old_z > enough_z else 0.0
        for t in range(tied):
            tie, search = w.impulses[t], w.search[t]
            search[0] = tie[DIAGONAL] * tie[RESIDUAL] + beta_r * search[0]
            search[1] = tie[DIAGONAL + 1] * tie[RESIDUAL + 1] + beta_z * search[1]
        old_r, old_z = new_r, new_z
    for t in range(tied):
        x, g, j, i = w.nodes[SLOT, t], w.nodes[GROUP, t], w.nodes[ROW, t], w.nodes[COLUMN, t]
        push_r, push_z = w.impulses[t, IMPULSE], w.impulses[t, IMPULSE + 1]
        apply_tie_impulse(g, j, i, x, push_r, push_z, w)
        w.passed_impulse[0, x, g] += push_r
        w.passed_impulse[1, x, g] += push_z


@point
def normal_force(j, i, n_r, n_z, w):
    """Normal force (N, never negative) on the interface at vertex (j, i): its area there times the mean normal pressure."""
    area_r, area_z, pressure, cells = 0.0, 0.0, 0.0, 0.0
    for row in range(j - 1, j + 1):
        for column in range(i - 1, i + 1):
            if not w.contact_columns[row, 0] <= column < w.contact_columns[row, 1]:
                continue
            share = w.line[SHARE, row, column]
            if share < 0.0:
                continue
            across, _, c_z, _ = corner(column, column < i, row < j, w.metrics, w.dz[row])
            area_r += share * across
            area_z += share * c_z
            pressure += normal_pressure(row, column, n_r, n_z, w.sig_rr, w.sig_zz, w.sig_rz)
            cells += 1.0
    return max(pressure / cells, 0.0) * abs(n_r * area_r + n_z * area_z) if cells > 0.0 else 0.0


@point
def mobility(g, j, i, x, w):
    """Velocity per impulse (1/kg) of a vertex; a slave moves with its masters as far as it is tied to them."""
    m = w.mass[g, j, i]
    if w.strength[x, g] == 0.0:
        return 1.0 / m
    along_r, along_z = masters_mobility(g, j, i, x, w)
    master_mobility = max(along_r, along_z)
    return w.strength[x, g] * master_mobility / (1.0 + m * master_mobility) + (1.0 - w.strength[x, g]) / m


@not_inlined
def apply_friction_impulse(g, j, i, x, push_r, push_z, w):
    """Applies an impulse to a vertex; a slave passes on to its masters the part that keeps it moving with them."""
    apply_impulse(g, j, i, push_r, push_z, w)
    if w.strength[x, g] > 0.0:
        m = w.mass[g, j, i]
        along_r, along_z = masters_mobility(g, j, i, x, w)
        pass_r, pass_z = w.strength[x, g] * push_r / (1.0 + m * along_r), w.strength[x, g] * push_z / (1.0 + m * along_z)
        apply_tie_impulse(g, j, i, x, pass_r, pass_z, w)
        w.passed_impulse[0, x, g] += pass_r
        w.passed_impulse[1, x, g] += pass_z


@not_inlined
def apply_friction(j, i, x, w):
    """Friction between the two groups at a contact node at which they touch.

    It acts along the tangent to the normal by which they close least, and is at most `friction` times the normal force.
    """
    w_r, w_z = w.u[1, j, i] - w.u[0, j, i], w.v[1, j, i] - w.v[0, j, i]
    way, closing = 0, 1e300
    for other in range(3):
        speed = w.contact_normal[other, 0, j, i] * w_r + w.contact_normal[other, 1, j, i] * w_z
        way = other if speed < closing else way
        closing = min(closing, speed)
    n_r, n_z = w.contact_normal[way, 0, j, i], w.contact_normal[way, 1, j, i]
    along_r, along_z = w_r - closing * n_r, w_z - closing * n_z
    slip = sqrt(along_r * along_r + along_z * along_z)
    if slip == 0.0:
        return
    reduced = 1.0 / (mobility(0, j, i, x, w)
                     + mobility(1, j, i, x, w))
    force = normal_force(j, i, n_r, n_z, w)
    drag = min(reduced * slip, max(w.friction * force * w.dt - w.friction_impulse[FRICTION_SIZE, x], 0.0))
    drag_r, drag_z = drag * along_r / slip, drag * along_z / slip
    w.friction_impulse[FRICTION_SIZE, x] += drag
    w.friction_impulse[FRICTION_R, x] += drag_r
    w.friction_impulse[FRICTION_Z, x] += drag_z
    apply_friction_impulse(0, j, i, x, drag_r, drag_z, w)
    apply_friction_impulse(1, j, i, x, -drag_r, -drag_z, w)


@not_inlined
def deposit_heat(g, j, i, x, heat, w):
    """Gives heat (J) to a vertex and, if it is a slave, to its masters, by their masses times the sizes of the weights."""
    total = w.mass[g, j, i]
    for n in range(w.masters[x, g]):
        by, row, column = master(n, g, j, i, x, w.where)
        total += abs(w.weights[x, g, n]) * w.mass[by, row, column]
    w.heat[g, j, i] += heat / total
    for n in range(w.masters[x, g]):
        by, row, column = master(n, g, j, i, x, w.where)
        w.heat[by, row, column] += heat * abs(w.weights[x, g, n]) / total


@serial
def resolve_contact(w):
    """Velocities of both groups at contact nodes, after ties and friction act on the velocities from the forces alone.

    Slave nodes move with masters of their group, and friction acts between groups that touch. Both are impulses that keep the
    momentum.

    Reads    the arrays that find_extensions wrote; mass [b, j, i]; contact_normal [3, 2, j, i], touch; line, sig_.. [j, i]
    Updates  u, v [b, j, i]; adds to transfer[4, j]
    Writes   passed_impulse [c, x, b], which slaves have given away; friction_impulse [3, x]; the arrays of list_ties
    Scratch  the arrays of assemble; impulses [t, 8], search [t, c]
    """
    # Step 1: no impulse has been passed on yet
    j0, j1 = outer_rows(w.parts)
    for x in range(w.first_slot[j1 + 1]):
        for c in range(2):
            for g in range(2):
                w.passed_impulse[c, x, g] = 0.0
        for c in range(3):
            w.friction_impulse[c, x] = 0.0
    # Step 2: impulses that tie slaves to their masters
    tied = list_ties(w)
    assemble(tied, w)
    solve_ties(tied, w)
    # Step 3: friction at the nodes that touch, and the ties once more, in turn
    for _ in range(ROUNDS if w.friction > 0.0 else 0):
        for j in range(j0, j1 + 1):
            for k in range(w.contact_node_count[j]):
                if w.touch[j, w.contact_nodes[j, k]] > 0.0:
                    apply_friction(j, w.contact_nodes[j, k], w.first_slot[j] + k, w)
        solve_ties(tied, w)


@serial
def heat_contact_nodes(w):
    """Heat of the impulses at contact nodes.

    An impulse J between two velocities makes the heat J . (w0 + w1)/2, w their difference at either end of the step: the
    difference between the work of the cells and the kinetic energy (explanation/sliding, contact). The velocities at the end
    are those after everything has acted, dashpots of an edge on which masters lie included.

    Reads    the arrays that find_extensions and resolve_contact wrote; mass, u0, v0, u, v [b, j, i]
    Updates  heat [b, j, i], J per kg of the group's mass at a vertex
    Writes   transfer[:4, j]: axial momentum that the soft group gains from the hard one, heat of the ties to the other group,
             of friction, and of under-filled nodes
    """
    j0, j1 = outer_rows(w.parts)
    t = 0
    for j in range(j0, j1 + 1):
        for row in range(4):
            w.transfer[row, j] = 0.0
        for k in range(w.contact_node_count[j]):
            i, x = w.contact_nodes[j, k], w.first_slot[j] + k
            w_r = 0.5 * ((w.u0[1, j, i] - w.u0[0, j, i]) + (w.u[1, j, i] - w.u[0, j, i]))
            w_z = 0.5 * ((w.v0[1, j, i] - w.v0[0, j, i]) + (w.v[1, j, i] - w.v[0, j, i]))
            heat = w.friction_impulse[FRICTION_R, x] * w_r + w.friction_impulse[FRICTION_Z, x] * w_z
            if heat != 0.0:
                deposit_heat(0, j, i, x, heat, w)
            w.transfer[0, j] += w.friction_impulse[FRICTION_Z, x]
            w.transfer[2, j] += heat
            for g in range(2):
                if w.strength[x, g] == 0.0:
                    continue
                before_r, before_z = mismatch(t, w.u0, w.v0, w)
                after_r, after_z = mismatch(t, w.u, w.v, w)
                t += 1
                heat = 0.5 * (w.passed_impulse[0, x, g] * (before_r + after_r)
                              + w.passed_impulse[1, x, g] * (before_z + after_z))
                deposit_heat(g, j, i, x, heat, w)
                tied = w.weights[x, g, w.masters[x, g] - 1] if w.where[x, g, w.masters[x, g] - 1] == TIED else 0.0
                w.transfer[0, j] += tied * (w.passed_impulse[1, x, g] if g == 1 else -w.passed_impulse[1, x, g])
                w.transfer[1, j] += tied * heat
                w.transfer[3, j] += (1.0 - tied) * heat
