"""The phases of the remap along one direction as they run: the parts of the mesh in parallel, with barriers between kernels.

(dj, di) is (0, 1) along r and (1, 0) along z; `second` says whether it is the second sweep of the step.
"""

from numpy import int64

from hydro2d.jit import phase, prange, wait
from hydro2d.kernels import (
    acceleration,
    boundaries,
    centroids,
    column_ranges,
    contact_motion,
    contact_volumes,
    edge_sums,
    interfaces,
    momentum,
    remap,
)


@phase
def carry_bodies(parts, i0, i1, dj, di, second, leading, fr, own_r, fz, own_z, q, nr, mirror_r_min, mirror_r_max, rules,
                 body_range, vof, nz, mirror_z_min, mirror_z_max, active_range, mixed_count, mixed_columns, scratch, gate,
                 void_only, volume, body_ranges, pre, flux_volume, dr, dz, interface_order, strips, cell_mass, mesh_box,
                 contact_columns, own_share, size, hard_first, soft_first, group, line, carried, flux, group_ranges, flux_mass,
                 steepness, edge_flux, outflow, gases, centroid, flux_place, turned):
    """Volume of every body through every face, fluxes of what it carries, and the cells after the sweep.

    leading : the edge along z that goes ahead with a mesh that travels, 0 low, 1 high, -1 none: its ghost cells are filled
    """
    face, own = (fr, own_r) if di == 1 else (fz, own_z)
    along_r, along_z = di * q.shape[0], dj * q.shape[0]  # the other direction's interfaces need fractions
    for place in prange(parts.shape[0] - 1):
        part = int64(place)  # numba counts without a sign, for which every kernel would be compiled a second time
        boundaries.ghost_columns(part, parts, nr, mirror_r_min, mirror_r_max, along_r, rules, body_range, vof, q,
                                 centroid)
        boundaries.ghost_rows(part, parts, i0 - 2, i1 + 2, nz, mirror_z_min, mirror_z_max, leading, along_z, rules, vof, q,
                              centroid)
        if not second:  # cells may have been filled by the Lagrangian step
            column_ranges.list_mixed(part, parts, active_range, vof, mixed_count, mixed_columns, scratch)
        wait(gate, parts)
        interfaces.donor_volumes(dj, di, part, parts, i0, i1, not second, void_only, volume, body_ranges, active_range, fr, fz,
                                 vof, pre, flux_volume, turned)
        wait(gate, parts)
        interfaces.interface_volumes(dj, di, part, parts, mesh_box, contact_columns, dr, dz, interface_order, group, gases,
                                     mixed_count, mixed_columns, face, pre, vof, centroid, flux_volume, flux_place, strips)
        if cell_mass.shape[0] > 1:
            contact_volumes.contact_shares(part, parts, mesh_box, contact_columns, volume, pre, vof, own_share, size)
            wait(gate, parts)
            contact_volumes.contact_fluxes(dj, di, part, parts, mesh_box, dr, dz, hard_first, soft_first, group, gases,
                                           contact_columns, line, face, own, own_share, size, vof, centroid, flux_volume,
                                           flux_place, strips)
            wait(gate, parts)
            contact_volumes.limit_fluxes(dj, di, part, parts, mesh_box, contact_columns, pre, vof, flux_volume)
        wait(gate, parts)
        if dj == 1:
            remap.shared_fluxes(part, parts, i0, i1, carried, rules, body_ranges, pre, flux_volume, steepness, vof, q, scratch,
                                flux)
            wait(gate, parts)
            remap.sweep_z(part, parts, i0, i1, carried, rules, group, mesh_box, body_ranges, group_ranges, face, pre, volume,
                          second, flux_volume, steepness, scratch, flux, flux_mass, edge_flux, vof, q, cell_mass, mixed_count,
                          mixed_columns, centroid)
        else:
            remap.sweep_r(part, parts, i0, i1, carried, rules, group, mesh_box, body_ranges, group_ranges, face, pre, volume,
                          second, flux_volume, steepness, scratch, flux, flux_mass, edge_flux, vof, q, cell_mass, mixed_count,
                          mixed_columns, centroid)
        wait(gate, parts)
        centroids.carry_centroids(dj, di, part, parts, second, mesh_box, group, contact_columns, mixed_count, mixed_columns,
                                  face, own, volume, pre, vof, flux_volume, flux_place, centroid)
        if part == 0:
            edge_sums.sum_outflow(di, parts, i0, i1, edge_flux, outflow)


@phase
def carry_momentum(parts, i0, i1, dj, di, second, opens_low, opens_high, mesh_box, flux_mass, steepness, gate, advection,
                   ke_bound, constrained, pushing, edge_velocity, metrics, group_ranges, cell_mass, mass, velocity0, velocity,
                   dual, edge_dual, deficit, momentum_sums, nr, mirror_r_min, mirror_r_max, u, v, nz, mirror_z_min,
                   mirror_z_max, active_range, group, vof, q, deposited, cutoff, volume, mixed_count, mixed_columns, pre, fr,
                   fz, removed, body_ranges, occupied, kinetic_outflow, centroid):
    """Velocities after the sweep; then what is left over is tidied away, and the bodies are found anew.

    opens_low, opens_high : whether bodies flow through the edges of this direction that the active box has reached
    """
    for place in prange(parts.shape[0] - 1):
        part = int64(place)  # numba counts without a sign, for which every kernel would be compiled a second time
        boundaries.close_mass_flux(part, parts, di, mesh_box, opens_low, opens_high, flux_mass)
        wait(gate, parts)
        momentum.sweep_momentum(dj, di, part, parts, i0, i1, advection, ke_bound, constrained, pushing, edge_velocity, mesh_box,
                                metrics, group_ranges, cell_mass, flux_mass, steepness, mass, velocity0, velocity, dual,
                                edge_dual, deficit, momentum_sums)
        boundaries.ghost_vertices_r(part, parts, nr, mirror_r_min, mirror_r_max, u, v)
        boundaries.ghost_vertices_z(part, parts, i0 - 2, i1 + 3, nz, mirror_z_min, mirror_z_max, u, v)
        wait(gate, parts)
        if advection == momentum.BOTH:
            momentum.deposit(part, parts, metrics, active_range, group, deficit, cell_mass, vof, q, deposited)
        remap.tidy(part, parts, cutoff, metrics, volume, group, mixed_count, mixed_columns, pre, dj, di, fr, fz, second, u, v,
                   vof, q, cell_mass, removed, centroid)
        wait(gate, parts)
        if part == 0:
            edge_sums.sum_kinetic_outflow(di, parts, i0, i1, edge_dual, kinetic_outflow)
        # by the ranges before: where nothing is left there is no mass either
        acceleration.vertex_masses(part, parts, i0, i1 + 1, metrics, group_ranges, cell_mass, mass)
        column_ranges.find_body_ranges(part, parts, i0, i1, False, group, vof, body_ranges, occupied)
        wait(gate, parts)
        column_ranges.find_active_ranges(part, parts, i0, i1, occupied, group_ranges)
        wait(gate, parts)
        column_ranges.widen_ranges(part, parts, body_ranges, group_ranges)
        if cell_mass.shape[0] > 1:
            contact_motion.keep_one(part, parts, i0, i1, group_ranges, mass, u, v)
