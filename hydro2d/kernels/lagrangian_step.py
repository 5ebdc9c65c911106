"""The phases of the Lagrangian step as they run: the parts of the mesh in parallel, kernel after kernel, barriers between.

Between two kernels stands a barrier wherever the second reads what the first writes in rows of other parts, or writes what the
first reads there.
"""

from hydro2d.jit import prange, threaded, wait
from hydro2d.kernels import (
    acceleration,
    boundaries,
    contact_checkerboard,
    contact_geometry,
    contact_motion,
    contact_velocities,
    contact_volumes,
    cut_cells,
    deformation,
    extension,
    following,
    mixed,
    momentum,
    sliding,
    thermodynamics,
)


@threaded
def close_cells(parts, i0, i1, mesh_speed, geometry, edges, bodies, choices, fields, work, contact):
    """Pressure, sound speed, artificial viscosity and allowed step of every cell, void where a cell fractures; contact nodes.

    Without contact, least_row says where the step is least; with it, first_slot how many slots the nodes need.

    parts : int64[n + 1], first row of every part and one past the last;  i0, i1 : columns of the active box
    """
    nr, nz, dr, dz, metrics, mesh_box = geometry.nr, geometry.nz, geometry.dr, geometry.dz, geometry.metrics, geometry.mesh_box
    low_r, high_r, low_z, high_z = edges.mirrors
    group, models, materials, hard_bodies = bodies.group, bodies.models, bodies.materials, bodies.hard
    u, v, vof, q, pm, km, tm = fields.u, fields.v, fields.vof, fields.q, fields.pm, fields.km, fields.tm
    p, bulk, rhobar, solid, cl = fields.p, fields.bulk, fields.rhobar, fields.solid, fields.cl
    qr, qz, hg_coefficient, hard, mass = fields.qr, fields.qz, fields.hg_coefficient, fields.hard, fields.mass
    body_range, active_range, group_ranges = work.body_range, work.active_range, work.group_ranges
    mixed_count, columns, skin, scratch, gate = work.mixed_count, work.mixed, work.skin, work.scratch, work.gate
    opened, row_step, bad, least_row = work.opened, work.row_step, work.bad, work.least_row
    count, contact_nodes, soft, heat = contact.contact_node_count, contact.contact_nodes, contact.soft, contact.heat
    warmed, first_slot = contact.warmed, contact.first_slot
    max_opening, smallest_tension, threshold = choices.max_opening, choices.smallest_tension, choices.threshold
    linear, quadratic = choices.viscosity_linear, choices.viscosity_quadratic
    courant, advective, hourglass = choices.courant, choices.advective_courant, choices.hourglass
    for part in prange(parts.shape[0] - 1):
        boundaries.ghost_vertices_r(part, parts, nr, low_r, high_r, u, v)
        boundaries.ghost_vertices_z(part, parts, i0 - 2, i1 + 3, nz, low_z, high_z, u, v)
        cut_cells.find_surfaces(part, parts, i0, i1, mesh_box, dr, dz, group, hard_bodies, threshold, mixed_count, columns, vof,
                                skin)
        wait(gate, parts)
        mixed.close_cells(part, parts, max_opening, smallest_tension, linear, quadratic, courant, advective, mesh_speed,
                          hourglass, metrics, dr, dz, body_range, active_range, mixed_count, columns, models, materials, u, v,
                          vof, q, pm, km, tm, skin, p, bulk, rhobar, solid, cl, qr, qz, hg_coefficient, opened, row_step, bad,
                          scratch)
        wait(gate, parts)
        if mass.shape[0] > 1:
            contact_geometry.find_contact_nodes(part, parts, mesh_box, group_ranges, mass, group, vof, count, contact_nodes,
                                                hard, soft, heat, warmed)
            wait(gate, parts)
            if part == 0:
                contact_geometry.number_nodes(parts, count, first_slot)
        elif part == 0:
            thermodynamics.least_step(parts, row_step, bad, least_row)


@threaded
def find_contact(parts, i0, i1, geometry, edges, bodies, choices, fields, work, contact, ties):
    """Where two groups meet: face apertures, normals, slave nodes; volume rate and viscosity of contact-interface cells."""
    r, z, dr, dz, metrics, volume = geometry.r, geometry.z, geometry.dr, geometry.dz, geometry.metrics, geometry.volume
    mesh_box, constrained, group = geometry.mesh_box, edges.constrained, bodies.group
    linear, quadratic, courant = choices.viscosity_linear, choices.viscosity_quadratic, choices.courant
    most_squares = choices.most_squares
    u, v, vof, q, km, mass, dmg = fields.u, fields.v, fields.vof, fields.q, fields.km, fields.mass, fields.dmg
    hard, cl, rhobar, p, solid, bulk = fields.hard, fields.cl, fields.rhobar, fields.p, fields.solid, fields.bulk
    qr, qz = fields.qr, fields.qz
    group_ranges, skin, gate = work.group_ranges, work.skin, work.gate
    row_step, mixed_count, columns, bad, least_row = work.row_step, work.mixed_count, work.mixed, work.bad, work.least_row
    count, contact_nodes, first_slot = contact.contact_node_count, contact.contact_nodes, contact.first_slot
    soft, contact_columns, line, rate, kinds = contact.soft, work.contact_columns, contact.line, contact.rate, contact.kinds
    aperture_r, aperture_z, filled = contact.aperture_r, contact.aperture_z, contact.filled
    normal, touch = contact.contact_normal, contact.touch
    strength, masters, where, weights = ties.strength, ties.masters, ties.where, ties.weights
    for part in prange(parts.shape[0] - 1):
        contact_geometry.contact_lines(part, parts, i0, i1, mesh_box, dr, dz, count, contact_nodes, hard, soft, contact_columns,
                                       line)
        wait(gate, parts)
        contact_geometry.face_apertures(part, parts, mesh_box, constrained, contact_columns, line, hard, soft, mass, count,
                                        contact_nodes, aperture_r, aperture_z, normal, touch)
        extension.find_filled(part, parts, mesh_box, volume, metrics, count, contact_nodes, hard, soft, mass, filled)
        wait(gate, parts)
        extension.find_extensions(part, parts, mesh_box, most_squares, r, z, count, contact_nodes, first_slot, normal, hard,
                                  soft, filled, group, vof, dmg, strength, masters, where, weights)
        wait(gate, parts)
        contact_motion.contact_viscosity(
            part, parts, mesh_box, linear, quadratic, courant, dr, dz, metrics, contact_columns, line, group_ranges, normal,
            aperture_r, aperture_z, hard, soft, u, v, cl, rhobar, vof, q, km, skin, p, solid, bulk, qr, qz, rate, row_step,
            mixed_count, columns, kinds)
        wait(gate, parts)
        if part == 0:
            thermodynamics.least_step(parts, row_step, bad, least_row)


@threaded
def accelerate(parts, i0, i1, dt, geometry, edges, bodies, choices, fields, work, contact, ties):
    """Total stress at half the step, and the velocities at its end: forces, contact, friction, edges."""
    nr, nz, dz, metrics = geometry.nr, geometry.nz, geometry.dz, geometry.metrics
    low_r, high_r, low_z, high_z = edges.mirrors
    constrained, velocity, transmitting = edges.constrained, edges.velocity, edges.transmitting
    group, hard_bodies, by_what_is_solid = bodies.group, bodies.hard, choices.by_what_is_solid
    threshold, friction = choices.threshold, choices.friction
    speed_limit, underfilled_density = choices.speed_limit, choices.underfilled_density
    u, v, u0, v0, mass, vof, q = fields.u, fields.v, fields.u0, fields.v0, fields.mass, fields.vof, fields.q
    p, ph, bulk, solid, qr, qz = fields.p, fields.ph, fields.bulk, fields.solid, fields.qr, fields.qz
    sig_rr, sig_zz, sig_tt, sig_rz = fields.sig_rr, fields.sig_zz, fields.sig_tt, fields.sig_rz
    rhobar, cl, hg_coefficient, hard = fields.rhobar, fields.cl, fields.hg_coefficient, fields.hard
    contact_pressure = fields.contact_pressure
    body_range, active_range, group_ranges, occupied = work.body_range, work.active_range, work.group_ranges, work.occupied
    mixed_count, columns, skin, cell_mass, gate = work.mixed_count, work.mixed, work.skin, work.cell_mass, work.gate
    limited, held_back, walls = work.limited, work.held_back, work.walls
    count, contact_nodes, first_slot = contact.contact_node_count, contact.contact_nodes, contact.first_slot
    soft, contact_columns, line, rate, places = contact.soft, work.contact_columns, contact.line, contact.rate, contact.places
    aperture_r, aperture_z, heat, transfer = contact.aperture_r, contact.aperture_z, contact.heat, contact.transfer
    normal, touch = contact.contact_normal, contact.touch
    strength, masters, where, weights = ties.strength, ties.masters, ties.where, ties.weights
    nodes, starts, entries, portions = ties.nodes, ties.starts, ties.entries, ties.portions
    impulses, gain, taken, rubbing = ties.impulses, ties.gain, ties.taken, ties.rubbing
    for part in prange(parts.shape[0] - 1):
        acceleration.total_stress(part, parts, dt, metrics, dz, body_range, active_range, mixed_count, columns,
                                  by_what_is_solid, hard_bodies, threshold, u0, v0, vof, q, skin, p, bulk, solid, qr, qz, ph,
                                  sig_rr, sig_zz, sig_tt, sig_rz)
        if mass.shape[0] > 1:
            contact_motion.contact_stress(part, parts, dt, contact_columns, group_ranges, line, hard, soft, rate, skin, p, bulk,
                                          solid, ph, sig_rr, sig_zz, sig_tt, sig_rz, contact_pressure)
        wait(gate, parts)
        acceleration.accelerate(part, parts, i0, i1 + 1, dt, speed_limit, underfilled_density, metrics, dz, occupied, mass,
                                hg_coefficient, sig_rr, sig_zz, sig_tt, sig_rz, u0, v0, u, v, limited)
        if mass.shape[0] > 1:
            contact_motion.contact_node_forces(
                part, parts, dt, group, by_what_is_solid, metrics, dz, constrained, count, contact_nodes, aperture_r, aperture_z,
                ph, qr, solid, skin, vof, q, hg_coefficient, cell_mass, mass, u0, v0, u, v, transfer)
            wait(gate, parts)
            if part == 0:
                contact_velocities.settle(
                    parts, dt, friction, constrained, metrics, dz, contact_columns, line, count, contact_nodes, first_slot, normal,
                    touch, strength, masters, where, weights, sig_rr, sig_zz, sig_rz, mass, u0, v0, u, v, nodes, starts, entries,
                    portions, places, impulses, gain, taken, rubbing, heat, transfer)
        wait(gate, parts)
        if part == 0:
            boundaries.transmit_edges(parts, i0, i1, transmitting, constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u0, v0,
                                      u, v, held_back)
        wait(gate, parts)
        boundaries.constrain(part, parts, constrained, velocity, mass, u0, v0, u, v, walls)
        if mass.shape[0] > 1:
            contact_motion.keep_one(part, parts, i0, i1, group_ranges, mass, u, v)
        boundaries.ghost_vertices_r(part, parts, nr, low_r, high_r, u, v)
        boundaries.ghost_vertices_z(part, parts, i0 - 2, i1 + 3, nz, low_z, high_z, u, v)


@threaded
def deform(parts, i0, i1, dt, travels, advance, geometry, bodies, choices, fields, work, contact):
    """Volumes that faces sweep, work, and strain of every body; what faces sweep relative to a mesh that advances.

    travels, advance : whether the mesh does, and by how much in the step, m
    """
    dz, metrics, volume, mesh_box = geometry.dz, geometry.metrics, geometry.volume, geometry.mesh_box
    group, models, materials, carried, hard_bodies = bodies.group, bodies.models, bodies.materials, bodies.carried, bodies.hard
    relaxation, tipton, mixed_strength, threshold = choices.relaxation, choices.tipton, choices.mixed_strength, choices.threshold
    slip_layer, shear, friction = choices.slip_layer, choices.shear, choices.friction
    u, v, u0, v0, vof, q = fields.u, fields.v, fields.u0, fields.v0, fields.vof, fields.q
    pm, km, tm, p, ph, bulk, solid = fields.pm, fields.km, fields.tm, fields.p, fields.ph, fields.bulk, fields.solid
    qr, qz, hg_coefficient = fields.qr, fields.qz, fields.hg_coefficient
    sig_rr, sig_zz, sig_tt, sig_rz = fields.sig_rr, fields.sig_zz, fields.sig_tt, fields.sig_rz
    body_range, group_ranges, occupied, cell_mass = work.body_range, work.group_ranges, work.occupied, work.cell_mass
    mixed_count, columns, skin, gate, scratch = work.mixed_count, work.mixed, work.skin, work.gate, work.scratch
    fr, fz, mix, motion, internal, deposited = work.fr, work.fz, work.mix, work.motion, work.internal, work.deposited
    contact_columns, zone, normal = work.contact_columns, work.zone, work.normal
    aperture_r, aperture_z, own_r, own_z = contact.aperture_r, contact.aperture_z, contact.own_r, contact.own_z
    even_r, even_z, inside, checkerboard = contact.even_r, contact.even_z, contact.inside, contact.checkerboard
    room, heat, warmed = contact.room, contact.heat, contact.warmed
    for part in prange(parts.shape[0] - 1):
        acceleration.swept_volumes(part, parts, i0, i1, dt, metrics, dz, group_ranges, u0, v0, u, v, fr, fz)
        if cell_mass.shape[0] > 1:
            contact_volumes.even_out(part, parts, contact_columns, volume, skin, bulk, ph, qr, even_r, even_z)
            contact_checkerboard.find_insides(part, parts, mesh_box[2], mesh_box[3], group, group_ranges, vof, inside)
            wait(gate, parts)
            contact_volumes.warm_evened(part, parts, contact_columns, volume, ph, qr, even_r, even_z, vof, q)
            contact_volumes.contact_swept_volumes(part, parts, dt, metrics, dz, contact_columns, aperture_r, aperture_z, u0, v0,
                                                  u, v, even_r, even_z, fr, fz, own_r, own_z)
            contact_checkerboard.find_checkerboards(part, parts, mesh_box[2], mesh_box[3], group, group_ranges, vof, q, pm,
                                                    inside, checkerboard)
            wait(gate, parts)
            contact_volumes.contact_work(part, parts, dt, metrics, dz, contact_columns, group, aperture_r, aperture_z, ph, qr,
                                         u0, v0, u, v, fr, fz, cell_mass, vof, q)
            contact_checkerboard.fade_deviators(part, parts, dt, group, group_ranges, volume, hg_coefficient, cell_mass, inside,
                                                checkerboard, vof, km, q, room)
            wait(gate, parts)
            contact_checkerboard.fade_pressures(part, parts, mesh_box[2], mesh_box[3], group, group_ranges, contact_columns,
                                                cell_mass, room, vof, pm, fr, fz, own_r, own_z, q)
        wait(gate, parts)
        deformation.deform(part, parts, dt, metrics, dz, body_range, group, models, materials, u0, v0, u, v, fr, fz, sig_rr,
                           sig_zz, sig_tt, sig_rz, hg_coefficient, vof, pm, tm, scratch, q, internal)
        mixed.deform_mixed(part, parts, dt, relaxation, tipton, mixed_strength, hard_bodies, threshold, metrics, dz,
                           mixed_count, columns, group, contact_columns, cell_mass, models, materials, u0, v0, u, v, fr, fz, ph,
                           qr, qz, hg_coefficient, skin, p, bulk, solid, pm, km, tm, vof, q, mix, motion, internal)
        if cell_mass.shape[0] > 1:
            momentum.deposit(part, parts, metrics, warmed, group, heat, cell_mass, vof, q, deposited)
        if slip_layer:
            sliding.cut_shear(part, parts, shear, friction, occupied[0], zone, normal, hard_bodies, vof, pm, q)
        if travels:
            wait(gate, parts)
            following.leave(part, parts, advance, metrics, group_ranges[0], fz)
            if cell_mass.shape[0] > 1:
                following.leave_contact(part, parts, advance, metrics, contact_columns, own_z)
            following.silence(part, parts, carried, body_range, q)


