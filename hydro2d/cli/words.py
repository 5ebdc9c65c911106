"""Common words for things that hydro2d names differently or does not have, for `hydro2d info`."""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Word:
    """The meaning of a word in hydro2d.

    said : an answer in one or two sentences
    names : names that `hydro2d info` explains further
    pages : pages of the documentation, below docs
    command : to type, if there is one
    """

    said: str
    names: tuple[str, ...] = ()
    pages: tuple[str, ...] = ()
    command: str = ""


WORDS = {
    "anvil": Word(
        "A rigid wall that only pushes: a body that touches it may leave it again. It is a kind of edge of the mesh, as in "
        '[boundaries] z_min = "anvil". A body cannot leave an edge "wall", but slides along it; "held" clamps it.',
        ("boundaries.z_min", "boundaries"), ("how-to/write-a-deck.md#choose-the-edges",), "hydro2d new taylor"),
    "ballistic limit": Word(
        'The velocity at which half of the shots perforate. A search with of = "perforation" in its [transition] finds it.',
        ("stop.perforation",), ("how-to/find-a-transition.md", "how-to/perforate-a-plate.md")),
    "blint": Word(
        "CTH's boundary layer interface. Here it is sliding.method = \"slip-layer\", with the widths of its two layers; "
        '"contact" is the other way to let bodies slide.',
        ("sliding.method", "sliding.boundary_layer", "sliding.slip_layer"), ("explanation/sliding.md#the-slip-layer",)),
    "cavitation": Word(
        'Void that opens where tension exceeds the fracture_pressure of a material, with failure.tensile = "material". Water '
        "of the library has a fracture_pressure of 8.7 MPa. The models of an expanding cavity are unrelated.",
        ("failure.tensile", "fracture_pressure", "water", "water_tillotson", "cavity"), ("explanation/fracture.md",)),
    "clamp": Word(
        'An edge of the mesh that holds the rim of a plate: [boundaries] r_max = "held". A "wall" is smooth and lets the plate '
        "slide.",
        ("boundaries.r_max", "boundaries"), ("how-to/write-a-deck.md#choose-the-edges",)),
    "cfl": Word(
        "numerics.courant is the ratio of the time step to the time in which a wave crosses a cell.",
        ("numerics.courant", "numerics.shock_courant", "numerics.advective_courant")),
    "concrete": Word(
        "There is no material and no strength model for concrete, and no shot into concrete has been compared. The models of "
        "ceramics are not a substitute. A model of your own is a Python file; for a rigid projectile there is a formula whose "
        "constants are fitted to measured depths.",
        ("poncelet",), ("how-to/add-a-model.md",)),
    "debris": Word(
        "Material that flies off behind a plate: targets.NAME.debris in summary.json has its mass, momentum, energy, "
        "velocities, cone and fragments.", ("penetration.targets",), ("how-to/results.md#debris-behind-a-plate",),
        "hydro2d plot RUN -o debris.png --kind debris"),
    "detonator": Word(
        "A [[source]] of kind = \"detonation\" whose points light an explosive, each [r, z, time].",
        ("source", "jwl", "TNT"), ("explanation/explosives.md",), "hydro2d new cylinder-test"),
    "ejecta": Word(
        "Material that flies off a hit surface. targets.NAME in summary.json has under ejecta the mass and momentum of what "
        "flies back from the front face, with the momentum multiplication (beta), and under debris what flies behind a plate.",
        ("penetration.targets",), ("how-to/results.md#ejecta-in-front-of-a-target",)),
    "erosion": Word(
        "No cell is ever deleted: material flows through the mesh, and a rod becomes shorter as its head is consumed. "
        '`regime` in summary.json says whether it was eroding; a search with of = "erosion" finds the velocity of the change.',
        ("sliding.method", "failure"), ("how-to/find-a-transition.md", "explanation/rigid-rod.md")),
    "gap": Word(
        "Space that no body covers is void, so a gap is the distance that the deck leaves between bodies. It may close, and it "
        "opens again where the tension exceeds fracture_pressure. `hydro2d check` warns of gaps of less than a cell.",
        ("body", "failure.tensile", "penetration.targets"), ("how-to/perforate-a-plate.md", "how-to/hypervelocity.md")),
    "gravity": Word(
        'There is no gravity by default. A [[source]] of kind = "acceleration" with axial = "-9.81 m/s^2" gives it to a body.',
        ("source",), ("how-to/write-a-deck.md",)),
    "hole": Word(
        "What a projectile leaves in a target: targets.NAME in summary.json has the diameters of its hole or crater at the "
        "entrance and the exit, the narrowest and the mean one, its depth and its volume, and the damage_class of the wall.",
        ("penetration.targets",), ("how-to/perforate-a-plate.md#results",)),
    "plexiglas": Word("PMMA in the library, with its Hugoniot and no strength.", ("PMMA",)),
    "polycarbonate": Word(
        "Lexan in the library, with its Hugoniot and no strength; polycarbonate_tillotson vaporises as well.",
        ("Lexan", "polycarbonate_tillotson")),
    "principal": Word(
        "fracture_stress is the largest principal stress that a material bears; beyond it the material fails for good.",
        ("fracture_stress", "failure.tensile"), ("explanation/fracture.md#the-largest-principal-stress",)),
    "restitution": Word(
        "There is no coefficient to set: the speed of rebound follows from the materials. stop.rebound ends a run at "
        "the rebound; for the ratio of the velocities give a formula, such as [derived] restitution = "
        "\"abs(velocity) / '300 m/s'\".",
        ("stop.rebound", "derived"), ("how-to/results.md",)),
    "rigid": Word(
        "No body can be declared rigid; a high yield_stress comes near it. `regime` in summary.json says whether a rod stayed "
        "rigid. A rigid wall is an edge of the mesh, \"wall\" or \"anvil\". Analytic models have rigid rods.",
        ("yield_stress", "boundaries", "rigid-axial", "forrestal", "chen-li"),
        ("reference/words.md", "explanation/rigid-rod.md", "how-to/find-a-transition.md")),
    "segmented": Word(
        "Each segment of a rod is a [[body]], one behind the other, with the velocity of the rod; `join` makes segments of one "
        "material a single body.",
        ("body.rod", "join", "body.box"), ("how-to/write-a-deck.md",)),
    "spall": Word(
        'Tensile failure: fracture_pressure of the material with failure.tensile = "material", or cochran-banner, whose cracks '
        "take energy to open.",
        ("fracture_pressure", "failure.tensile", "cochran-banner"), ("how-to/spall.md", "explanation/fracture.md"),
        "hydro2d new spall"),
    "units": Word(
        'A quantity of a deck names its unit: "8.12 mm", "17.6 g/cm^3". Numbers alone are refused, except 0, unless the deck '
        'has numbers = "SI" at its top. Results are in SI units, which end the names of their columns.',
        ("numbers",), ("reference/units.md",)),
    "us-up": Word(
        "Us = c0 + s up, the straight line between shock and particle velocity, is the equation of state mie-grueneisen: c0 is "
        "sound_speed, s is hugoniot_slope.",
        ("mie-grueneisen", "sound_speed", "hugoniot_slope", "hugoniot_slope_2"), ("explanation/equation-of-state.md",)),
    "titanium": Word("The library has the alloy Ti-6Al-4V.", ("Ti_6Al_4V",)),
    "tungsten carbide": Word("WC in the library.", ("WC",)),
    "visar": Word(
        "An interferometer of velocities. The velocity of a free surface is that of a [[gauge]] with `surface`, and behind a "
        "window (LiF, sapphire, PMMA) that of a [[tracer]] at the interface; its refractive index is not corrected for.",
        ("gauge.surface", "tracer", "LiF", "sapphire", "PMMA"), ("how-to/free-surface-velocity.md",)),
}

#: other forms of these words
ALSO = {
    "clamped": "clamp", "held": "clamp", "no slip": "clamp", "fixed": "clamp",
    "bounce": "restitution", "rebound velocity": "restitution", "coefficient of restitution": "restitution",
    "v50": "ballistic limit", "slip line": "blint", "eroding": "erosion", "eroded": "erosion", "fragment": "debris",
    "fragments": "debris", "igniter": "detonator", "primer": "detonator", "gaps": "gap", "standoff": "gap",
    "principal stress": "principal", "rigid body": "rigid", "rigid wall": "anvil", "segments": "segmented",
    "crater": "hole", "ejection": "ejecta", "pdv": "visar", "interferometer": "visar", "free surface velocity": "visar",
    "free-surface velocity": "visar", "perspex": "plexiglas", "lucite": "plexiglas", "acrylic": "plexiglas",
    "ti-6al-4v": "titanium", "segmented rod": "segmented", "spallation": "spall", "scabbing": "spall", "unit": "units",
    "hugoniot": "us-up", "usup": "us-up", "shock velocity": "us-up", "time step": "cfl", "courant number": "cfl",
}


def plain(name: str) -> str:
    """A word in the form that is looked up: lower case, one blank or hyphen between its parts."""
    word = re.sub(r"[\s_]+", " ", name.strip().lower())
    return word if word in WORDS or word in ALSO else word.replace("-", " ")


def page(name: str) -> str | None:
    """The meaning of a word here, and where to read on; None for an unknown word."""
    key = plain(name)
    key = key if key in WORDS else ALSO.get(key) or key.replace(" ", "-")
    word = WORDS.get(key)
    if word is None:
        return None
    lines = [f"{name} (a word): {word.said}"]
    if word.names:
        lines.append(f"  info     {', '.join(word.names)}")
    if word.pages:
        lines.append(f"  read     {', '.join(f'docs/{page}' for page in word.pages)}")
    if word.command:
        lines.append(f"  try      {word.command}")
    return "\n".join(lines)
