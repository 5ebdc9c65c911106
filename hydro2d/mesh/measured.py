"""Names and meanings of the numbers in a history and a summary. `solver/` computes them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from hydro2d.mesh.station_columns import QUANTITIES as OF_STATIONS

#: unit by ending of the name, the longest first
UNITS = {
    "_m3_J": "m3/J", "_kg_m3": "kg/m3", "_J_kg": "J/kg", "_J_m2": "J/m2", "_m_s2": "m/s2", "_m_s": "m/s", "_N_s": "N s",
    "_Pa_s": "Pa s", "_rad": "rad", "_1_s": "1/s", "_kg": "kg", "_Pa": "Pa", "_m2": "m2", "_m3": "m3", "_K": "K", "_J": "J",
    "_N": "N", "_W": "W", "_s": "s", "_m": "m",
}  # fmt: skip


def unit(name: str) -> str:
    """Unit of a quantity, from the end of its name; "1" if it has none."""
    if name in ("time", "dt"):
        return "s"
    return next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "1")


def in_file(name: str) -> str:
    """The name of a quantity among the datasets of history.h5, where / would start a group."""
    return name.replace("/", "_per_")


#: results of `penetrator.Penetrator.measure` for a projectile, and their meanings; the names say rod for any shape
QUANTITIES = {
    "penetration_depth_m": "largest depth so far, from the target's original surface to the projectile's deepest part near the "
    "axis",
    "nose_depth_m": "present depth, less than the largest once a projectile has rebounded; in a summary, at the end",
    "penetration_over_length": "the largest depth over the projectile's length at the start: P/L",
    "interface_velocity_m_s": "axial velocity on the axis at the nose: u of the theory of penetration, whose v is of the tail",
    "rod_length_m": "length of the longest run of intact material on the axis, in proportion to its length at the start",
    "rod_initial_length_m": "length in the deck of a rod or ball that lies wholly in the mesh; else its length at the start",
    "rod_mass_kg": "mass of the projectile in the mesh",
    "rod_initial_mass_kg": "mass of the projectile in the mesh at the start",
    "rod_initial_kinetic_energy_J": "kinetic energy of the projectile at the start",
    "rod_core_mass_kg": "mass of intact material that is connected to the axis and keeps up with it",
    "rod_failed_mass_kg": "mass of the projectile that has failed by damage",
    "target_failed_mass_kg": "mass of the target that has failed by damage",
    "rod_max_radius_m": "largest radius of a solid section with the area of the projectile in a row of cells",
    "rod_initial_radius_m": "radius of the projectile in the deck",
    "rod_max_plastic_strain": "largest plastic strain of the cells that the projectile fills by half",
    "rod_mean_velocity_m_s": "mean axial velocity of the whole projectile",
    "rod_core_velocity_m_s": "mean axial velocity of its core",
    "rod_nose_velocity_m_s": "axial velocity of the projectile on the axis at its leading end",
    "rod_tail_velocity_m_s": "axial velocity of the projectile on the axis at its tail",
    "rod_kinetic_energy_J": "kinetic energy of the projectile, including the radial motion",
    "rod_residual_velocity_m_s": "axial velocity of the core of a projectile that has perforated the target or left the mesh; "
    "of all that was left if it was in pieces",
    "rod_residual_mass_kg": "mass that has this velocity",
    "rod_residual_length_m": "length of a projectile that has perforated the target",
    "exit_time_s": "time at which its leading end was its radius beyond the rear of the last target; null before",
    "regime": "rigid, deforming, eroding or left the mesh",
}

#: those that `BODY` has for every body: for the projectile, and for the first target
OF_EVERY_BODY = {
    "rod_mass_kg": "mass_kg", "rod_mean_velocity_m_s": "velocity_m_s", "rod_kinetic_energy_J": "kinetic_energy_J",
    "rod_failed_mass_kg": "failed_mass_kg", "target_failed_mass_kg": "failed_mass_kg",
}  # fmt: skip
#: those that a projectile of any shape has in a summary, by their key there
PROJECTILE = {key: key.removeprefix("rod_") for key in QUANTITIES if key.startswith("rod_") and key not in OF_EVERY_BODY}

#: results of `Penetrator.passages` for each target, and their meanings; null until the projectile is through it
PASSAGE = {
    "exit_time_s": "time at which the projectile's leading end was its radius beyond the rear of this target",
    "exit_velocity_m_s": "axial velocity of its core then, or of all that was left if it was in pieces",
    "exit_mass_kg": "mass that had this velocity",
    "exit_length_m": "length of the longest run of intact material on the axis then",
}

#: results of `body_measurements.measure` for every body, and their meanings; for material in the mesh unless stated otherwise
BODY = {
    "mass_kg": "mass",
    "momentum_N_s": "axial momentum",
    "velocity_m_s": "mean axial velocity, by mass; null if none of it is in the mesh",
    "kinetic_energy_J": "kinetic energy, including the radial motion",
    "failed_mass_kg": "mass that has failed by damage",
    "outflow_kg": "mass that has left through open edges of the mesh since the start",
    "inflow_kg": "mass that has entered a travelling mesh since the start",
    "r_min_m": "least radius that it reaches; null if it fills less than a hundredth of any cell",
    "r_max_m": "largest radius that it reaches",
    "z_min_m": "lowest axial position that it reaches",
    "z_max_m": "highest axial position that it reaches",
    "length_m": "its extent along the axis",
    "initial_length_m": "its extent along the axis at the start",
    "radius_at_z_min_m": "radius of its lowest row of cells: the foot of a bar standing there",
    "radius_at_z_max_m": "radius of its highest row of cells",
}

#: results of `crater.Crater.measure` for the hole in a target, corrected for its bending, and their meanings
CRATER = {
    "entrance_diameter_m": "in the first row below the surface from which the wall is steeper than 45 degrees; null if there "
    "is no hole, if its entrance has closed, or if no wall of it is left",
    "exit_diameter_m": "in the last such row, also beyond the rear face; null while the hole is not open at its end",
    "hole_diameter_m": "in the narrowest such row of a hole that is open right through, whether the projectile went through or "
    "not; null while it is closed",
    "mean_diameter_m": "of the cylinder with the volume and depth of the hole; null if there is no hole",
    "volume_m3": "of the hole, the whole circumference; in planar geometry of the meshed half, per metre",
    "volume_per_energy_m3_J": "that volume over the kinetic energy of the projectile at the start",
    "efficiency": "mass of the target that initially filled that volume, over the projectile's mass at the start: pi_V of the "
    "scaling of craters",
    "depth_m": "from the surface to the bottom on the axis, or the loss of thickness there if the target has bent; its whole "
    "thickness if it is perforated",
    "ejected_mass_kg": "mass of the target beyond its rear face that is no longer connected to it: plug and debris",
    "ejected_velocity_m_s": "mean axial velocity of that mass; null if there is none",
}

#: the damage of a target as that of a wall, the worst first
PERFORATED, DETACHED_SPALL, ATTACHED_SPALL, NO_DAMAGE = "perforated", "detached spall", "attached spall", "none"
#: result of `wall_damage.classify` for each target, and its meaning
WALL = {
    "damage_class": "perforated: its hole is open right through; detached spall: a piece of four cells or more flies from its "
    "rear; attached spall: such a piece does not fly, void within is half a cell wide, or the rear bulges by half of the "
    "thickness; none; null while its rear is beyond the mesh, and where no hole is open but a hundredth of the projectile's "
    "mass of it has left the mesh behind it",
}

#: results of `ejecta.measure` for what flies back from each target, and their meanings
EJECTA = {
    "mass_kg": "mass of target and projectile before its original front face that moves away from it, or has left the mesh so",
    "momentum_N_s": "axial momentum of that mass, against the flight of the projectile and relative to the undisturbed target",
    "velocity_m_s": "mean axial velocity, in the same sense; null if there are no ejecta",
    "momentum_multiplication": "beta: 1 + this momentum over that of the projectile at the start, relative to the target; null "
    "before the impact, for later targets, with a hole or detached spall, where debris behind has over a hundredth of the "
    "projectile's momentum, and once a travelling mesh has left the face behind",
}

#: results of `debris.measure` for everything that flies behind a target, including the projectile, and their meanings
DEBRIS = {
    "mass_kg": "mass of all bodies",
    "momentum_N_s": "axial momentum along the flight of the projectile, relative to the undisturbed target, as all below",
    "kinetic_energy_J": "kinetic energy, including the radial motion",
    "velocity_m_s": "mean axial velocity, by mass; null if there is no debris",
    "leading_velocity_m_s": "axial velocity that a hundredth of the mass exceeds",
    "cone_angle_rad": "angle to the axis within which nine tenths of the mass fly",
    "fragments": "number of pieces, each of connected cells that are filled by half, or by less if it is narrower "
                 "than a cell; one off the axis is a ring",
    "largest_fragment_kg": "mass of the heaviest of them",
    "dust_kg": "mass in none of them: in cells next to them that are filled by less than half, and crumbs",
}

#: results for each fragment with their units, and for the mass by axial speed and by angle
FRAGMENTS = ("mass_kg", "r_m", "z_m", "velocity_r_m_s", "velocity_z_m_s")

PLACES = {"r_m": "radial position", "z_m": "axial position"}

#: short names for expressions in a deck, and the columns for which they stand
SHORT = {
    "depth": "penetration_depth_m", "length": "rod_length_m", "length0": "rod_initial_length_m", "radius": "rod_max_radius_m",
    "radius0": "rod_initial_radius_m", "mass": "rod_mass_kg", "mass0": "rod_initial_mass_kg", "core_mass": "rod_core_mass_kg",
    "energy": "rod_kinetic_energy_J", "energy0": "rod_initial_kinetic_energy_J", "velocity": "rod_mean_velocity_m_s",
    "u": "interface_velocity_m_s", "v": "rod_tail_velocity_m_s",
}  # fmt: skip
#: columns that are words
WORDS = ("regime",)


def names(bodies: Iterable[str], stations: Iterable[str], penetrates: bool) -> list[str]:
    """Names that an expression in a deck can use: columns of its history, and with ``penetrates`` SHORT, `crater_KEY` and
    `ejecta_KEY`.

    bodies : of the deck;  stations : `tracer_NAME` and `gauge_NAME`;  penetrates : whether it has a projectile and a target
    """
    columns = ["time", "dt", "internal_energy_J", "kinetic_energy_J"]
    columns += [f"body_{body}_{key}" for body in bodies for key in BODY]
    columns += [f"{station}_{key}" for station in stations for key in (*PLACES, *OF_STATIONS)]
    if penetrates:
        columns += [name for name in QUANTITIES if name not in WORDS]
        columns += [f"crater_{key}" for key in CRATER] + [f"ejecta_{key}" for key in EJECTA]
    return columns


class Debris(NamedTuple):
    """Debris behind a target. Arrays by body have a column for each name in ``bodies``; SI, whole circumference.

    bodies : those that it is made of
    speeds, by_speed : edges of the bins of axial speed along the flight (n + 1,), and the mass in them (n, bodies)
    angles, by_angle : edges of the bins of the angle to the axis, rad (n + 1,), and the mass in them (n, bodies)
    fragments : FRAGMENTS of each, (k, 5), the heaviest first;  kinds : number in ``bodies`` of the main body of each, (k,)
    totals : DEBRIS by name
    """

    bodies: list[str]
    speeds: np.ndarray
    by_speed: np.ndarray
    angles: np.ndarray
    by_angle: np.ndarray
    fragments: np.ndarray
    kinds: np.ndarray
    totals: dict[str, float | int | None]

    @property
    def momentum(self) -> float:
        """Axial momentum along the flight, N s, whole circumference."""
        return float(self.totals["momentum_N_s"] or 0.0)


def passed(summary: dict) -> list[str]:
    """Names of the targets if the projectile has perforated all of them, else none."""
    targets = summary.get("targets") or {}
    return [] if any(target.get("exit_time_s") is None for target in targets.values()) else list(targets)
