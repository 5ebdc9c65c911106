"""Warnings about a deck: choices that are allowed but seldom intended, one sentence each."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from hydro2d.deck.checks import AHEAD, AT_EDGE, mesh_edges, room, share_filled
from hydro2d.deck.layout import axis_edges, extent, layout
from hydro2d.deck.mesh import body, misfits
from hydro2d.deck.mistakes import mistakes
from hydro2d.deck.sections import Deck
from hydro2d.deck.shapes.outlines import shared_volume
from hydro2d.deck.thin import thin_things
from hydro2d.materials.material import FRACTURE, Material
from hydro2d.mesh.edges.base import DASHPOTS, PRESSURE, PUSH, Edge
from hydro2d.sources.detonation import EXPLOSIVES

#: a body whose density is below this share of the densest one's is a gas
GAS = 0.01
#: least share of the earlier of two bodies that overlaps, and that does not, for a warning
LEAST_SHARED = 1e-3
#: a rod needs at least this many cells across its radius to behave like one
CELLS_ACROSS_RADIUS = 5


def warnings(deck: Deck) -> list[str]:
    """Allowed but unwise choices, one sentence each, as `hydro2d check` and the start of a run show it."""
    return [*misfits(deck), *_coarse_rods(deck), *thin_things(deck), *_leaving(deck), *_stuck(deck),
            *_half_pressed(deck), *_jumps(deck), *_short_mesh(deck),
            *_overlaps(deck), *_yielding_rods(deck), *_no_failure(deck), *_gases(deck), *_duds(deck), *mistakes(deck)]


def _coarse_rods(deck: Deck) -> Iterator[str]:
    r = axis_edges(deck, "r")
    for entry in deck.body:
        if entry.is_slender:
            cells = entry.own_radius / float(np.diff(r)[r[:-1] < entry.own_radius].max())
            if cells < CELLS_ACROSS_RADIUS - 1e-9:
                yield (
                    f'body "{entry.name}": {cells:.1f} cells across the radius; with fewer than {CELLS_ACROSS_RADIUS} a rod '
                    "is poorly resolved"
                )


def _leaving(deck: Deck) -> Iterator[str]:
    """Bodies that fly out of the mesh before the end, with nothing in their way."""
    lines, of = axis_edges(deck, "z"), mesh_edges(deck)
    for entry in deck.body:
        speed = entry.velocity[1]
        if speed == 0.0 or deck.mesh.follow is not None or deck.stop.time is None or entry.join is not None:
            continue
        low, high = extent(entry, deck, "z")
        front, edge = (high, lines[-1]) if speed > 0.0 else (low, lines[0])
        others = [extent(other, deck, "z") for other in deck.body if other is not entry]
        ahead = any(end[1] > front if speed > 0.0 else end[0] < front for end in others)
        flight = (edge - front) / speed + 0.0  # never -0
        there = of["z_max" if speed > 0.0 else "z_min"]
        if not ahead and 0.0 <= flight < deck.stop.time and _lets_out(there, flight):
            yield f'body "{entry.name}": reaches the edge of the mesh after {flight * 1e6:.3g} us and leaves it before the end'


def _lets_out(edge: Edge, flight: float) -> bool:
    """Whether a body that reaches an edge after a flight, s, leaves through it: not one that an edge that transmits cuts."""
    at_rest = edge.constrains() and edge.constrain(0.0) == 0.0
    return bool(edge.flow()) and edge.traction() != PUSH and not at_rest and not (edge.traction() == DASHPOTS and flight == 0.0)


def _stuck(deck: Deck) -> Iterator[str]:
    """Bodies at a held edge that start with another velocity than it."""
    for name, edge in mesh_edges(deck).items():
        slide = edge.slide()
        if slide is None:
            continue
        across = edge.constrain(0.0) or 0.0
        given = (across, slide) if name.startswith("r") else (slide, across)
        at = axis_edges(deck, name[0])[-1 if name.endswith("max") else 0]
        for entry in deck.body:
            low, high = extent(entry, deck, name[0])
            near = AT_EDGE * abs(at) if at else AT_EDGE * (high - low)
            if entry.velocity != given and low <= at + near and high >= at - near:
                start, held = (f"[{u:g}, {v:g}] m/s" for u, v in (entry.velocity, given))
                yield (f'boundaries.{name} = "held": "{entry.name}" starts at {start}, and the edge at which it lies holds it '
                       f"at {held}: one part of it is pushed into the other")


def _half_pressed(deck: Deck) -> Iterator[str]:
    """Edges with a pressure at which there is void beside the bodies."""
    for name, edge in mesh_edges(deck).items():
        if edge.traction() == PRESSURE and (share := share_filled(deck, name)) < 1.0 - AT_EDGE:
            yield (f'boundaries.{name} = "pressure": void lies at {1.0 - share:.0%} of it; the pressure acts on the bodies '
                   "alone and drives them into the void beside them")


def _overlaps(deck: Deck) -> Iterator[str]:
    """Bodies that partly overlap an earlier one, which takes the space. Wholly overlapping an earlier one is intended."""
    placed = [(each.body, each.outline, *each.extent.values()) for each in layout(deck).bodies]
    r, z = ((float(edges[0]), float(edges[-1])) for edges in (axis_edges(deck, "r"), axis_edges(deck, "z")))
    planar = deck.mesh.geometry == "planar"
    for (other, first, *reach), (entry, second, *its) in combinations(placed, 2):
        disjoint = any(max(a[0], b[0]) >= min(a[1], b[1]) for a, b in zip(reach, its, strict=True))
        if disjoint or (entry.join or entry.name) == (other.join or other.name):
            continue
        both, whole = shared_volume(first, second, r, z, planar)
        if LEAST_SHARED * whole < both < (1.0 - LEAST_SHARED) * whole:
            size = f"{both * 1e6:.3g} mm^2" if planar else f"{both * 1e9:.3g} mm^3"
            yield (f'bodies "{other.name}" and "{entry.name}" overlap by {size}, which belong to "{other.name}", '
                   "the earlier one in the deck")


def _jumps(deck: Deck) -> Iterator[str]:
    for axis in ("r", "z"):
        sizes = np.diff(axis_edges(deck, axis))
        jump = float(np.max(np.maximum(sizes[1:] / sizes[:-1], sizes[:-1] / sizes[1:]), initial=1.0))
        if jump > 1.2 + 1e-9:
            yield f"mesh.{axis}: neighbouring cells differ by a factor of {jump:.2f}; above 1.2 shocks are reflected there"


def _short_mesh(deck: Deck) -> Iterator[str]:
    if deck.mesh.follow is not None:
        ahead = room(deck, axis_edges(deck, "z"))[0]
        radii = ahead / extent(body(deck, deck.mesh.follow), deck, "r")[1]
        if radii < AHEAD and not _whole_when_hit(deck, ahead):
            yield f'mesh.follow: the mesh ends {radii:.3g} radii ahead of "{deck.mesh.follow}"; below {AHEAD} its edge matters'


def _whole_when_hit(deck: Deck, ahead: float) -> bool:
    """Whether every target is wholly in the mesh when the body that this follows, ahead m behind its edge, reaches it."""
    named = deck.penetration.targets if deck.penetration else ()
    extents = [extent(body(deck, name), deck, "z") for name in named]
    return bool(extents) and all(high - low < ahead for low, high in extents)


def _yielding_rods(deck: Deck) -> Iterator[str]:
    if deck.sliding.method == "slip-layer" and deck.sliding.yield_factor == "off":
        yield 'sliding.yield_factor is "off": noise at the interface can make a rod yield that should stay rigid'


def _gases(deck: Deck) -> Iterator[str]:
    """Gases together with solids: bodies that are light, or have no cohesion where others have some."""
    materials = {entry.name: deck.materials[entry.material] for entry in deck.body}
    densest = max((material.reference_density for material in materials.values()), default=0.0)
    ideal = [name for name, material in materials.items() if material.eos.name == "ideal-gas"]
    consequence = ("a gas that is trapped between bodies in contact gets too hot" if deck.sliding.method == "contact" else
                   "a gas sticks to solids, so that a wedge in a stream acts four to five cells thicker")
    for name, material in materials.items():
        if material.reference_density < GAS * densest or (name in ideal and len(ideal) < len(materials)):
            yield f'body "{name}": {consequence}; leave the space empty unless the gas matters'


def _duds(deck: Deck) -> Iterator[str]:
    """Explosives that nothing lights, and detonations too weak because the remap discards kinetic energy."""
    lit = {entry.body for entry in deck.source if entry.kind == "detonation"}
    for entry in deck.body:
        name = deck.materials[entry.material].eos.name
        if name in EXPLOSIVES and entry.join is None and entry.name not in lit:
            yield f'body "{entry.name}": an explosive without a source of kind "detonation"; nothing lights it'
    if lit and deck.numerics.advection != "both":
        yield (f'numerics.advection is "{deck.numerics.advection}", which discards kinetic energy at the detonation: pressures '
               'behind it are too low; choose "both"')


def _bears_any_tension(material: Material) -> bool:
    """Whether a material without strength bears any tension by its equation of state alone: a liquid, not a gas."""
    return material.fracture_pressure is None and material.eos.name not in ("ideal-gas", *EXPLOSIVES)


def _melts_by_itself(material: Material) -> bool:
    """Whether the strength model of a material has a melting temperature of its own."""
    own = material.strength.numbers.get("melt_temperature")
    return own is not None and np.isfinite(own.value)


def _answer(name: str, material: Material, *keys: str) -> str:
    """The variants of a body's material that have what it lacks, and how to write the first; empty if none has it."""
    variants = material.variants_with(*keys)
    if not variants:
        return ""
    names = " and ".join(f'"{variant}"' for variant in variants)
    words = f"variants {names} have one" if variants[1:] else f"variant {names} has one"
    return f'; {words}: material = "{name}:{variants[0]}"'


def _no_failure(deck: Deck) -> Iterator[str]:
    """Bodies with strength that cannot fail in a way that the deck or their material provides for.

    There is no warning where the deck itself sets failure.damage to "none", or the material itself sets its damage model to
    "none". A resolved deck always sets both.
    """
    failure = deck.failure
    forgotten = failure.damage == "none" and "damage" not in failure.model_fields_set
    for entry in deck.body:
        material = deck.materials[entry.material]
        if entry.join is not None or not material.has_strength:
            if entry.join is None and _bears_any_tension(material) and failure.tensile == "material":
                yield (f'body "{entry.name}": {material.name} has no fracture_pressure and bears any tension; give it one, '
                       f"at which it cavitates{_answer(entry.material, material, *FRACTURE)}")
            continue
        if material.damage.name != "none" and forgotten:
            yield (
                f'body "{entry.name}": the {material.damage.name} damage model of {material.name} is off, because '
                'failure.damage is not given; "material" switches it on, "none" keeps it off'
            )
        if material.fracture_pressure is None is material.fracture_stress and failure.tensile == "material":
            yield (
                f'body "{entry.name}": {material.name} has no fracture_pressure and, with failure.tensile = "material", '
                f"never fractures in tension{_answer(entry.material, material, *FRACTURE)}"
            )
        if not material.melting and failure.melting == "material" and not _melts_by_itself(material):
            yield (
                f'body "{entry.name}": {material.name} has no melting line and, with failure.melting = "material", '
                f'never melts{_answer(entry.material, material, "melting")}'
            )
        if material.damage.name == "none" and failure.damage == "material" and not material.says_damage:
            yield (
                f'body "{entry.name}": {material.name} has no damage model and, with failure.damage = "material", '
                f'is never damaged{_answer(entry.material, material, "damage")}'
            )
