"""The phases of the Lagrangian step as they run: the parts of the mesh in parallel, kernel after kernel, barriers between.

Between two kernels stands a barrier wherever the second reads what the first writes in rows of other parts, or writes what the
first reads there.
"""

from numpy import int64

from hydro2d.jit import phase, prange, wait
from hydro2d.kernels import (
    acceleration,
    boundaries,
    contact_checkerboard,
    contact_geometry,
    contact_motion,
    contact_velocities,
    contact_volumes,
    cracks,
    cut_cells,
    deformation,
    extension,
    following,
    memory,
    mixed,
    momentum,
    sliding,
    thermodynamics,
)


@phase
def close_cells(parts, i0, i1, mesh_speed, nr, mirror_r_min, mirror_r_max, u, v, nz, mirror_z_min, mirror_z_max, mesh_box, dr,
                dz, tipton, group, hard_bodies, threshold, mixed_count, mixed_columns, vof, skin, gate, max_opening,
                smallest_tension, along_compression, viscosity_linear, viscosity_quadratic, courant, advective_courant,
                hourglass, metrics, body_range, active_range, models, materials, strong, gases, q, pm, km, tm, p, bulk, rhobar,
                solid, cl, qr, qz, qt, qrz, hg_coefficient, opened, row_step, bad, scratch, mass, group_ranges,
                contact_node_count, contact_nodes, hard, soft, heat, warmed, first_slot, least_row):
    """Pressure, sound speed, artificial viscosity and allowed step of every cell, void where a cell fractures; contact nodes.

    Without contact, least_row says where the step is least; with it, first_slot how many slots the nodes need.

    parts : int64[n + 1], first row of every part and one past the last;  i0, i1 : columns of the active box
    """
    for place in prange(parts.shape[0] - 1):
        part = int64(place)  # numba counts without a sign, for which every kernel would be compiled a second time
        boundaries.ghost_vertices_r(part, parts, nr, mirror_r_min, mirror_r_max, u, v)
        boundaries.ghost_vertices_z(part, parts, i0 - 2, i1 + 3, nz, mirror_z_min, mirror_z_max, u, v)
        cut_cells.find_surfaces(part, parts, i0, i1, mesh_box, dr, dz, tipton, group, hard_bodies, threshold, strong, gases,
                                mixed_count, mixed_columns, vof, skin)
        wait(gate, parts)
        mixed.close_cells(part, parts, max_opening, smallest_tension, along_compression, viscosity_linear, viscosity_quadratic,
                          courant, advective_courant, mesh_speed, hourglass, metrics, dr, dz, body_range, active_range,
                          mixed_count, mixed_columns, models, materials, u, v, vof, q, pm, km, tm, skin, p, bulk, rhobar, solid,
                          cl, qr, qz, qt, qrz, hg_coefficient, opened, row_step, bad, scratch)
        wait(gate, parts)
        if mass.shape[0] > 1:
            contact_geometry.find_contact_nodes(part, parts, mesh_box, group_ranges, mass, group, vof, contact_node_count,
                                                contact_nodes, hard, soft, heat, warmed)
            wait(gate, parts)
            if part == 0:
                contact_geometry.number_nodes(parts, contact_node_count, first_slot)
        elif part == 0:
            thermodynamics.least_step(parts, row_step, bad, least_row)


@phase
def find_contact(parts, i0, i1, mesh_box, dr, dz, contact_node_count, contact_nodes, hard, soft, contact_columns, line, gate,
                 constrained, mass, aperture_r, aperture_z, contact_normal, touch, volume, metrics, filled, most_squares, r, z,
                 first_slot, group, vof, dmg, strength, masters, where, weights, viscosity_linear, viscosity_quadratic, courant,
                 group_ranges, u, v, cl, rhobar, q, km, skin, p, solid, bulk, qr, qz, qt, qrz, rate, row_step,
                 mixed_count, mixed_columns, kinds, bad, least_row):
    """Where two groups meet: face apertures, normals, slave nodes; volume rate and viscosity of contact-interface cells."""
    for place in prange(parts.shape[0] - 1):
        part = int64(place)  # numba counts without a sign, for which every kernel would be compiled a second time
        contact_geometry.contact_lines(part, parts, i0, i1, mesh_box, dr, dz, contact_node_count, contact_nodes, hard, soft,
                                       contact_columns, line)
        wait(gate, parts)
        contact_geometry.face_apertures(part, parts, mesh_box, constrained, contact_columns, line, hard, soft, mass,
                                        contact_node_count, contact_nodes, aperture_r, aperture_z, contact_normal, touch)
        extension.find_filled(part, parts, mesh_box, volume, metrics, contact_node_count, contact_nodes, hard, soft, mass,
                              filled)
        wait(gate, parts)
        extension.find_extensions(part, parts, mesh_box, most_squares, r, z, contact_node_count, contact_nodes, first_slot,
                                  contact_normal, hard, soft, filled, group, vof, dmg, strength, masters, where, weights)
        wait(gate, parts)
        contact_motion.contact_viscosity(
            part, parts, mesh_box, viscosity_linear, viscosity_quadratic, courant, dr, dz, metrics, contact_columns, line,
            group_ranges, contact_normal, aperture_r, aperture_z, hard, soft, u, v, cl, rhobar, vof, q, km, skin, p, solid,
            bulk, qr, qz, qt, qrz, rate, row_step, mixed_count, mixed_columns, kinds)
        wait(gate, parts)
        if part == 0:
            thermodynamics.least_step(parts, row_step, bad, least_row)


@phase
def accelerate(parts, i0, i1, dt, metrics, dz, body_range, active_range, mixed_count, mixed_columns, by_what_is_solid,
               hard_bodies, threshold, u0, v0, vof, q, skin, p, bulk, solid, qr, qz, qt, qrz, ph, sig_rr, sig_zz, sig_tt,
               sig_rz, mass, contact_columns, group_ranges, line, hard, soft, rate, contact_pressure, gate, speed_limit,
               underfilled_density, occupied, hg_coefficient, u, v, limited, group, gases, constrained, contact_node_count,
               contact_nodes, aperture_r, aperture_z, cell_mass, transfer, friction, first_slot, contact_normal, touch,
               strength, masters, where, weights, nodes, starts, entries, portions, places, impulses, gain, taken, rubbing,
               heat, transmitting, rhobar, cl, drag, held_back, pushed, pushing, edge_velocity, walls, nr, mirror_r_min,
               mirror_r_max, nz, mirror_z_min, mirror_z_max):
    """Total stress at half the step, and the velocities at its end: forces, contact, friction, edges."""
    for place in prange(parts.shape[0] - 1):
        part = int64(place)  # numba counts without a sign, for which every kernel would be compiled a second time
        acceleration.total_stress(part, parts, dt, metrics, dz, body_range, active_range, mixed_count, mixed_columns,
                                  by_what_is_solid, hard_bodies, threshold, u0, v0, vof, q, skin, p, bulk, solid, qr, qz, qt,
                                  qrz, ph, sig_rr, sig_zz, sig_tt, sig_rz)
        if mass.shape[0] > 1:
            contact_motion.contact_stress(part, parts, dt, contact_columns, group_ranges, line, hard, soft, rate, skin, p, bulk,
                                          solid, ph, sig_rr, sig_zz, sig_tt, sig_rz, contact_pressure)
        wait(gate, parts)
        acceleration.accelerate(part, parts, i0, i1 + 1, dt, metrics, dz, occupied, mass, hg_coefficient, sig_rr, sig_zz,
                                sig_tt, sig_rz, mixed_count, mixed_columns, group, gases, skin, vof, q, pushed, u0,
                                v0, u, v)
        if mass.shape[0] > 1:
            contact_motion.contact_node_forces(
                part, parts, dt, group, gases, by_what_is_solid, metrics, dz, constrained, contact_node_count,
                contact_nodes, aperture_r, aperture_z, ph, qr, solid, skin, vof, q, hg_coefficient, cell_mass, mass, pushed, u0,
                v0, u, v, transfer)
        wait(gate, parts)
        if part == 0:
            if mass.shape[0] > 1:
                contact_velocities.settle(
                    parts, dt, friction, constrained, metrics, dz, contact_columns, line, contact_node_count, contact_nodes,
                    first_slot, contact_normal, touch, strength, masters, where, weights, sig_rr, sig_zz, sig_rz, mass, u, v,
                    nodes, starts, entries, portions, places, impulses, gain, taken, rubbing, transfer)
            boundaries.transmit_edges(parts, i0, i1, transmitting, constrained, dt, metrics, dz, rhobar, cl, bulk, mass, u, v,
                                      drag)
        wait(gate, parts)
        acceleration.limit_speed(part, parts, i0, i1 + 1, speed_limit, underfilled_density, metrics, dz, occupied, constrained,
                                 pushing, edge_velocity, mass, u0, v0, u, v, limited)
        boundaries.constrain(part, parts, constrained, pushing, edge_velocity, mass, u0, v0, u, v, walls)
        if mass.shape[0] > 1:
            contact_motion.keep_one(part, parts, i0, i1, group_ranges, mass, u, v)
        boundaries.ghost_vertices_r(part, parts, nr, mirror_r_min, mirror_r_max, u, v)
        boundaries.ghost_vertices_z(part, parts, i0 - 2, i1 + 3, nz, mirror_z_min, mirror_z_max, u, v)
        wait(gate, parts)
        if part == 0:
            if mass.shape[0] > 1:
                contact_velocities.warm_contact(
                    parts, contact_node_count, contact_nodes, first_slot, strength, masters, where, weights, mass, u0, v0, u, v,
                    nodes, starts, entries, portions, taken, rubbing, heat, transfer)
            boundaries.sum_drag(parts, i0, i1, transmitting, drag, u0, v0, u, v, held_back)


@phase
def deform(parts, i0, i1, time, dt, travels, advance, metrics, dr, dz, group_ranges, u0, v0, u, v, fr, fz, cell_mass,
           contact_columns, volume, skin, bulk, ph, qr, even_r, even_z, mesh_box, group, vof, inside, gate, q, aperture_r,
           aperture_z, own_r, own_z, pm, checkerboard, hg_coefficient, km, room, body_range, models, materials, gases, sig_rr,
           sig_zz, sig_tt, sig_rz, tm, scratch, internal, relaxation, tipton, mixed_strength, hard_bodies, threshold,
           mixed_count, mixed_columns, qz, qt, qrz, p, solid, mix, motion, warmed, heat, deposited, slip_layer, shear,
           friction, occupied, zone, normal, carried, lanes, before, centroid):
    """Volumes that faces sweep, work, and strain of every body; what faces sweep relative to a mesh that advances.

    time : at the end of the step, s;  travels, advance : whether the mesh does, and by how much in the step, m
    """
    for place in prange(parts.shape[0] - 1):
        part = int64(place)  # numba counts without a sign, for which every kernel would be compiled a second time
        if before.shape[1] > 0:
            memory.remember(part, parts, body_range, models, q, before)
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
                           sig_zz, sig_tt, sig_rz, hg_coefficient, vof, pm, tm, scratch, q, internal, lanes)
        mixed.deform_mixed(part, parts, dt, relaxation, tipton, mixed_strength, hard_bodies, threshold, metrics, dz,
                           mixed_count, mixed_columns, group, contact_columns, cell_mass, models, materials, gases, u0, v0, u,
                           v, fr, fz, ph, qr, qz, qt, qrz, hg_coefficient, skin, p, bulk, solid, pm, km, tm, vof, q, mix,
                           motion, internal, centroid)
        if cell_mass.shape[0] > 1:
            momentum.deposit(part, parts, metrics, warmed, group, heat, cell_mass, vof, q, deposited)
        if slip_layer:
            sliding.cut_shear(part, parts, shear, friction, occupied[0], zone, normal, hard_bodies, vof, pm, q)
        if before.shape[1] > 0:
            memory.update_memory(part, parts, time, dt, body_range, models, materials, pm, tm, before, vof, q)
            cracks.open_cracks(part, parts, body_range, models, materials, vof, q)
            wait(gate, parts)
            cracks.damage_by_cracks(part, parts, mesh_box, dr, dz, group, body_range, models, materials, u, v, vof, q)
        if travels:
            wait(gate, parts)
            following.leave(part, parts, advance, metrics, group_ranges[0], fz)
            if cell_mass.shape[0] > 1:
                following.leave_contact(part, parts, advance, metrics, contact_columns, own_z)
            following.silence(part, parts, carried, body_range, q)


