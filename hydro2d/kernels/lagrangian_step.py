"""The phases of the Lagrangian step as lists: kernel after kernel, for all parts of the mesh at the same time.

There is a barrier between two kernels wherever the second reads rows of other parts that the first writes, or writes rows of
other parts that the first reads.
"""

from hydro2d.jit import WAIT, Phase, alone, given, unless, when
from hydro2d.kernels import (
    audit_sums,
    boundaries,
    cracks,
    cut_cells,
    deformation,
    eos_memory,
    mesh_motion,
    mixed,
    momentum,
    outer_vertices,
    sliding,
    thermodynamics,
    vertex_forces,
)
from hydro2d.kernels.contact import (
    contact_checkerboard,
    contact_geometry,
    contact_motion,
    contact_velocities,
    contact_volumes,
    dividing_lines,
    extension,
    surface_volumes,
)

slip_zones = Phase(
    "slip_zones",
    "Distance to the hard bodies of a slip layer and the zones beside them, if they are found anew.",
    when("finds_zones", alone(sliding.slip_zones)),
)

close_cells = Phase(
    "close_cells",
    """Pressure, sound speed, artificial viscosity and allowed step of every cell, void where a cell fractures; contact nodes.

    Without contact, least_row and cause say where and why the step is least; with it, first_slot how many slots the nodes need.
    """,
    boundaries.ghost_vertices_r,
    boundaries.ghost_vertices_z,
    cut_cells.find_surfaces,
    WAIT,
    mixed.close_cells,
    when("slip_layer", sliding.cut_viscosity),
    WAIT,
    when("contact",
         contact_geometry.find_contact_nodes,
         WAIT,
         alone(contact_geometry.number_nodes)),
    unless("contact",
           thermodynamics.limit_step,
           WAIT,
           alone(thermodynamics.least_step),
           alone(thermodynamics.step_cause)),
)

find_contact = Phase(
    "find_contact",
    """Where two groups meet: face apertures, normals, slave nodes; volume rate and viscosity of contact-interface cells.

    Then, as in `close_cells` without contact, where and why the step is least.
    """,
    dividing_lines.contact_lines,
    WAIT,
    contact_geometry.face_apertures,
    extension.find_filled,
    WAIT,
    extension.find_extensions,
    WAIT,
    contact_motion.contact_viscosity,
    thermodynamics.limit_step,
    WAIT,
    alone(thermodynamics.least_step),
    alone(thermodynamics.step_cause),
)

accelerate = Phase(
    "accelerate",
    "Total stress at half the step, and the velocities at its end: forces, contact, friction, edges.",
    unless("contact", outer_vertices.bear),
    vertex_forces.total_stress,
    when("contact", contact_motion.contact_stress),
    WAIT,
    vertex_forces.accelerate,
    unless("contact", outer_vertices.find_held),
    when("contact", contact_motion.contact_node_forces),
    WAIT,
    unless("contact", alone(outer_vertices.hold_vertices)),
    when("contact", alone(contact_velocities.resolve_contact)),
    alone(boundaries.load_edges),
    WAIT,
    vertex_forces.limit_speed,
    boundaries.constrain,
    when("contact", contact_motion.keep_one),
    boundaries.ghost_vertices_r,
    boundaries.ghost_vertices_z,
    WAIT,
    when("contact", alone(contact_velocities.heat_contact_nodes)),
    alone(boundaries.sum_drag),
    alone(audit_sums.sum_acceleration),
)

deform = Phase(
    "deform",
    "Volumes that faces sweep; in pure cells, work, volume and strain of the body that fills them.",
    when("remembers", eos_memory.remember),
    vertex_forces.swept_volumes,
    unless("contact", outer_vertices.heat_held_vertices),
    when("contact",
         surface_volumes.even_out,
         contact_checkerboard.find_insides,
         WAIT,
         surface_volumes.heat_evened_cells,
         contact_volumes.contact_swept_volumes,
         contact_checkerboard.find_checkerboards,
         WAIT,
         contact_volumes.contact_work,
         contact_checkerboard.damp_deviators,
         WAIT,
         contact_checkerboard.damp_pressures),
    WAIT,
    deformation.deform,
)

deform_mixed = Phase(
    "deform_mixed",
    """In mixed cells, work, volume and strain of every body; contact heat; shear in a slip layer; internal variables, cracks.

    On a travelling mesh, the volumes that faces sweep relative to it, and tiny values set to zero.
    """,
    mixed.deform_mixed,
    when("contact", given(momentum.deposit, ranges="heated_columns", deficit="heat")),
    when("slip_layer", sliding.cut_shear),
    when("remembers",
         eos_memory.update_memory,
         cracks.open_cracks,
         WAIT,
         cracks.damage_by_cracks),
    when("travels",
         WAIT,
         mesh_motion.subtract_mesh_motion,
         when("contact", mesh_motion.subtract_mesh_motion_of_groups),
         mesh_motion.flush_tiny_values),
)
