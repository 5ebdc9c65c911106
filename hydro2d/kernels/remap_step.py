"""The phases of the remap along one direction as lists, and those that find the ranges of bodies.

(dj, di) is (0, 1) along r and (1, 0) along z.
"""

from hydro2d.jit import WAIT, Phase, alone, given, unless, when
from hydro2d.kernels import audit_sums, boundaries, centroids, column_ranges, interfaces, momentum, remap, vertex_forces
from hydro2d.kernels.contact import contact_motion, contact_volumes

carry_bodies = Phase(
    "carry_bodies",
    "Volume of every body through every face, fluxes of what it carries, and the cells after the sweep.",
    boundaries.ghost_columns,
    boundaries.ghost_rows,
    unless("second", column_ranges.list_mixed),  # cells may have been filled by the Lagrangian step
    WAIT,
    interfaces.sweep_volumes,
    interfaces.donor_volumes,
    WAIT,
    interfaces.interface_volumes,
    when("contact",
         contact_volumes.contact_shares,
         WAIT,
         contact_volumes.contact_fluxes,
         WAIT,
         contact_volumes.limit_fluxes),
    WAIT,
    when("dj",
         remap.shared_fluxes,
         WAIT,
         remap.sweep_z),
    unless("dj", remap.sweep_r),
    WAIT,
    centroids.carry_centroids,
    alone(audit_sums.sum_outflow),
    alone(audit_sums.find_turned),
)

carry_momentum = Phase(
    "carry_momentum",
    "Velocities after the sweep; fractions below the cutoff removed; vertex masses and the columns of every body recomputed.",
    boundaries.close_mass_flux,
    WAIT,
    momentum.sweep_momentum,
    boundaries.ghost_vertices_r,
    boundaries.ghost_vertices_z,
    WAIT,
    when("both", given(momentum.deposit, ranges="active_range")),
    remap.tidy,
    WAIT,
    alone(audit_sums.sum_kinetic_outflow),
    alone(audit_sums.sum_momentum),
    vertex_forces.vertex_masses,  # by the old ranges: cells that bodies have left have no mass
    column_ranges.find_body_ranges,
    WAIT,
    column_ranges.find_active_ranges,
    WAIT,
    column_ranges.widen_ranges,
    when("contact", contact_motion.keep_one),
)

find_moving = Phase(
    "find_moving",
    "Rows and columns of the vertices that move, if the active box may grow.",
    when("grows",
         column_ranges.moving_columns,
         WAIT,
         alone(column_ranges.moving_box)),
)

find_bodies = Phase(
    "find_bodies",
    "The columns in which each body lies, looked for in all of them, and the cells that are not full of one body.",
    when("anew",
         column_ranges.find_body_ranges,
         WAIT,
         column_ranges.find_active_ranges,
         WAIT,
         column_ranges.widen_ranges,
         WAIT,
         column_ranges.list_mixed),
)

find_masses = Phase(
    "find_masses",
    "Mass of every group in cells and at vertices, and one velocity where one group has no mass.",
    remap.sum_cell_mass,
    WAIT,
    vertex_forces.vertex_masses,
    when("contact", contact_motion.keep_one),
)
