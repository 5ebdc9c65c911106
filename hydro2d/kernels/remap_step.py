"""The phases of the remap along one direction as they run: the parts of the mesh in parallel, with barriers between kernels.

(dj, di) is (0, 1) along r and (1, 0) along z; `second` says whether it is the second sweep of the step.
"""

from hydro2d.jit import prange, threaded, wait
from hydro2d.kernels import (
    acceleration,
    boundaries,
    column_ranges,
    contact_motion,
    contact_volumes,
    interfaces,
    momentum,
    remap,
)


@threaded
def carry_bodies(parts, dj, di, second, i0, i1, leading, geometry, edges, bodies, fields, work, contact):
    """Volume of every body through every face, fluxes of what it carries, and the cells after the sweep.

    leading : the edge along z that goes ahead with a mesh that travels, 0 low, 1 high, -1 none: its ghost cells are filled
    """
    nr, nz, dr, dz, volume, mesh_box = geometry.nr, geometry.nz, geometry.dr, geometry.dz, geometry.volume, geometry.mesh_box
    low_r, high_r, low_z, high_z = edges.mirrors
    void_only, group, carried, rules, order = edges.void_only, bodies.group, bodies.carried, bodies.rules, bodies.order
    hard_first, soft_first = bodies.hard_first, bodies.soft_first
    vof, q, pre = fields.vof, fields.q, fields.pre
    body_range, body_ranges, active_range, group_ranges = work.body_range, work.body_ranges, work.active_range, work.group_ranges
    mixed_count, columns, scratch, gate, strips = work.mixed_count, work.mixed, work.scratch, work.gate, work.strips
    fr, fz, flux_volume, flux, flux_mass = work.fr, work.fz, work.flux_volume, work.flux, work.flux_mass
    edge_flux, cell_mass, contact_columns = work.edge_flux, work.cell_mass, work.contact_columns
    line, own_r, own_z, own_share, size = contact.line, contact.own_r, contact.own_z, contact.own_share, contact.size
    face, own = (fr, own_r) if di == 1 else (fz, own_z)
    along_r, along_z = di * q.shape[0], dj * q.shape[0]  # the other direction's interfaces need fractions
    for part in prange(parts.shape[0] - 1):
        boundaries.ghost_columns(part, parts, nr, low_r, high_r, along_r, rules, body_range, vof, q)
        boundaries.ghost_rows(part, parts, i0 - 2, i1 + 2, nz, low_z, high_z, leading, along_z, rules, vof, q)
        if not second:  # cells may have been filled by the Lagrangian step
            column_ranges.list_mixed(part, parts, active_range, vof, mixed_count, columns, scratch)
        wait(gate, parts)
        interfaces.donor_volumes(dj, di, part, parts, i0, i1, not second, void_only, volume, body_ranges, active_range, fr, fz,
                                 vof, pre, flux_volume)
        wait(gate, parts)
        interfaces.interface_volumes(dj, di, part, parts, dr, dz, order, mixed_count, columns, face, pre, vof, flux_volume,
                                     strips)
        if cell_mass.shape[0] > 1:
            contact_volumes.contact_shares(part, parts, mesh_box, contact_columns, volume, pre, vof, own_share, size)
            wait(gate, parts)
            contact_volumes.contact_fluxes(dj, di, part, parts, mesh_box, dr, dz, hard_first, soft_first, group,
                                           contact_columns, line, face, own, own_share, size, vof, flux_volume)
            wait(gate, parts)
            contact_volumes.limit_fluxes(dj, di, part, parts, mesh_box, contact_columns, pre, vof, flux_volume)
        wait(gate, parts)
        if dj == 1:
            remap.shared_fluxes(part, parts, i0, i1, carried, rules, body_ranges, pre, flux_volume, vof, q, scratch, flux)
            wait(gate, parts)
            remap.sweep_z(part, parts, i0, i1, carried, rules, group, mesh_box, body_ranges, group_ranges, face, pre, volume,
                          second, flux_volume, scratch, flux, flux_mass, edge_flux, vof, q, cell_mass, mixed_count, columns)
        else:
            remap.sweep_r(part, parts, i0, i1, carried, rules, group, mesh_box, body_ranges, group_ranges, face, pre, volume,
                          second, flux_volume, scratch, flux, flux_mass, edge_flux, vof, q, cell_mass, mixed_count, columns)


@threaded
def carry_momentum(parts, dj, di, second, i0, i1, opens_low, opens_high, geometry, edges, bodies, choices, fields, work):
    """Velocities after the sweep; then what is left over is tidied away, and the bodies are found anew.

    opens_low, opens_high : whether bodies flow through the edges of this direction that the active box has reached
    """
    nr, nz, metrics, volume, mesh_box = geometry.nr, geometry.nz, geometry.metrics, geometry.volume, geometry.mesh_box
    low_r, high_r, low_z, high_z = edges.mirrors
    constrained, held, group = edges.constrained, edges.velocity, bodies.group
    advection, ke_bound, cutoff = choices.advection, choices.ke_bound, choices.cutoff
    vof, q, pre, u, v, mass = fields.vof, fields.q, fields.pre, fields.u, fields.v, fields.mass
    velocity, velocity0 = fields.velocity, fields.velocity0
    body_ranges, active_range, group_ranges = work.body_ranges, work.active_range, work.group_ranges
    occupied, mixed_count, columns, gate = work.occupied, work.mixed_count, work.mixed, work.gate
    fr, fz, flux_mass, cell_mass, dual, edge_dual = work.fr, work.fz, work.flux_mass, work.cell_mass, work.dual, work.edge_dual
    deficit, sums, deposited, removed = work.deficit, work.momentum_sums, work.deposited, work.removed
    for part in prange(parts.shape[0] - 1):
        boundaries.close_mass_flux(part, parts, di, mesh_box, opens_low, opens_high, flux_mass)
        wait(gate, parts)
        momentum.sweep_momentum(dj, di, part, parts, i0, i1, advection, ke_bound, constrained, held, mesh_box, metrics,
                                group_ranges, cell_mass, flux_mass, mass, velocity0, velocity, dual, edge_dual, deficit, sums)
        boundaries.ghost_vertices_r(part, parts, nr, low_r, high_r, u, v)
        boundaries.ghost_vertices_z(part, parts, i0 - 2, i1 + 3, nz, low_z, high_z, u, v)
        wait(gate, parts)
        if advection == momentum.BOTH:
            momentum.deposit(part, parts, metrics, active_range, group, deficit, cell_mass, vof, q, deposited)
        remap.tidy(part, parts, cutoff, metrics, volume, group, mixed_count, columns, pre, dj, di, fr, fz, second, u, v, vof, q,
                   cell_mass, removed)
        wait(gate, parts)
        # by the ranges before: where nothing is left there is no mass either
        acceleration.vertex_masses(part, parts, i0, i1 + 1, metrics, group_ranges, cell_mass, mass)
        column_ranges.find_body_ranges(part, parts, i0, i1, False, group, vof, body_ranges, occupied)
        wait(gate, parts)
        column_ranges.find_active_ranges(part, parts, i0, i1, occupied, group_ranges)
        wait(gate, parts)
        column_ranges.widen_ranges(part, parts, body_ranges, group_ranges)
        if cell_mass.shape[0] > 1:
            contact_motion.keep_one(part, parts, i0, i1, group_ranges, mass, u, v)
