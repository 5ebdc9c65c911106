"""What `penetrator.Penetrator` measures of a rod: names, meanings, and where they stand in a summary."""

from __future__ import annotations

#: what `Penetrator.measure` gives, and its meaning
QUANTITIES = {
    "penetration_depth_m": "from the target's original surface to the deepest rod material on or near the axis",
    "rod_length_m": "of the longest run of intact rod on the axis",
    "rod_initial_length_m": "the same at the start",
    "rod_mass_kg": "mass of the rod in the mesh",
    "rod_core_mass_kg": "mass of what is intact, hangs together from the axis outward and keeps up with the axis",
    "rod_failed_mass_kg": "mass of the rod that has failed by damage",
    "target_failed_mass_kg": "mass of the target that has failed by damage",
    "rod_max_radius_m": "largest radius of a solid section with the area of the rod in a row of cells",
    "rod_initial_radius_m": "radius of the rod in the deck",
    "rod_max_plastic_strain": "largest plastic strain of the cells that the rod fills by half",
    "rod_mean_velocity_m_s": "mean axial velocity of all of the rod",
    "rod_core_velocity_m_s": "the same of its core",
    "rod_nose_velocity_m_s": "axial velocity of the rod on the axis at its nose",
    "rod_tail_velocity_m_s": "the same at its tail",
    "rod_kinetic_energy_J": "kinetic energy of the rod, of the radial motion as well",
    "rod_residual_velocity_m_s": "axial velocity of the core of a rod that has perforated the target or left the mesh; of all "
    "that was left of a rod in pieces",
    "rod_residual_mass_kg": "mass of that",
    "rod_residual_length_m": "length of a rod that has perforated the target",
    "exit_time_s": "when the nose was the radius of the rod beyond the rear of the last target; null before",
    "regime": "rigid, deforming, eroding or left the mesh",
}

#: those that `bodies.QUANTITIES` has of every body: of the rod, and of the first target
OF_EVERY_BODY = {
    "rod_mass_kg": "mass_kg", "rod_mean_velocity_m_s": "velocity_m_s", "rod_kinetic_energy_J": "kinetic_energy_J",
    "rod_failed_mass_kg": "failed_mass_kg", "target_failed_mass_kg": "failed_mass_kg",
}  # fmt: skip
#: those that a projectile of any shape has in a summary, by their key there
PROJECTILE = {key: key.removeprefix("rod_") for key in QUANTITIES if key.startswith("rod_") and key not in OF_EVERY_BODY}

#: what `Penetrator.passages` gives of each target, and its meaning; null while the rod is not through it
PASSAGE = {
    "exit_time_s": "when the nose was the radius of the rod beyond the rear of this target",
    "exit_velocity_m_s": "axial velocity of the rod's core then, or of all that was left of a rod in pieces",
    "exit_mass_kg": "mass of that",
    "exit_length_m": "of the longest run of intact rod on the axis then",
}
