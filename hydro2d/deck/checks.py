"""Checks that involve several keys: unknown names, bodies outside the mesh, unsupported combinations."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator

import numpy as np

from hydro2d.base.errors import unknown
from hydro2d.deck import formulas
from hydro2d.deck.layout import axis_edges, extent, layout
from hydro2d.deck.mesh import MeshError, body, body_radius
from hydro2d.deck.sections import Deck, Sliding
from hydro2d.materials.material import Material
from hydro2d.measure.station_columns import Point
from hydro2d.mesh.edges.base import EDGES, PRESSURE, PUSH, Edge
from hydro2d.mesh.edges.registry import BY_NAME, KINDS, made
from hydro2d.mesh.sinks import SINKS
from hydro2d.sources.detonation import EXPLOSIVES

#: rod radii that a mesh should reach ahead of the rod that it follows; at this distance its edge no longer affects the rod
AHEAD = 20
#: where a body counts as lying at an edge, in cells from it
AT_EDGE = 1e-6
#: a radius that stands for the axis, m
BESIDE_AXIS = 1e-9

#: keys of `sliding` that have no meaning in a contact
OF_SLIP_LAYER = ("boundary_layer", "slip_layer", "threshold", "shear", "refresh")

#: most bodies, and most tracers and points of gauges
MOST_BODIES, MOST_STATIONS = 1000, 20_000


def inconsistencies(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Key and message of each mistake that involves several keys: unknown names, bodies outside the mesh, missing ends."""
    names = [entry.name for entry in deck.body]
    if too_many := list(_too_many(deck)):
        yield from too_many
        return
    written = [unicodedata.normalize("NFC", name) for name in names]
    for number, entry in enumerate(deck.body):
        if entry.name in names[:number]:
            yield ("body", number, "name"), f'the name "{entry.name}" is already used by an earlier body'
        elif written[number] in written[:number]:
            yield ("body", number, "name"), (f'the name "{entry.name}" looks like that of an earlier body, but its accents are '
                                             "other characters")
        if entry.join is not None:
            yield from _bad_join(deck, number)
    for kind, names_of in (("tracer", [[entry.name] for entry in deck.tracer]),
                           ("gauge", [[name for name, _ in entry.places()] for entry in deck.gauge]),
                           ("source", [[entry.name] for entry in deck.source])):
        used: set[str] = set()
        for number, own in enumerate(names_of):
            if twice := used.intersection(own):
                yield (kind, number, "name"), f'the name "{min(twice)}" is already used by an earlier {kind}'
            used.update(own)
    yield from _colliding_names(deck)
    yield from _bad_names(deck, names)
    yield from _bad_mesh(deck)
    if bad_edges := list(_bad_edges(deck)):
        yield from bad_edges
    else:
        yield from _closing_edges(deck)
    yield from _bad_sources(deck)
    if deck.stop.time is None and deck.stop.cycles is None:
        yield ("stop",), "needs time or cycles"
    if deck.sliding.method == "slip-layer" and not deck.sliding.hard:
        yield ("sliding", "hard"), "a slip layer needs the names of the hard bodies"
    yield from _bad_targets(deck)
    if deck.sliding.method == "contact":
        yield from _bad_contact(deck)
    elif deck.sliding.friction > 0 and deck.sliding.shear != "shear":
        yield ("sliding", "friction"), 'friction needs shear = "shear"; a fluid slip layer has no friction'


def _colliding_names(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Bodies, tracers and gauges of which a column of the history would have the name of another one's."""
    from hydro2d.measure.bodies import Body  # which loads numba

    named = [("body", number, "body", entry.name, Body.meanings()) for number, entry in enumerate(deck.body)]
    for kind, names_of in (("tracer", [[entry.name] for entry in deck.tracer]),
                           ("gauge", [[name for name, _ in entry.places()] for entry in deck.gauge])):
        named += [(kind, number, kind, name, Point.meanings()) for number, own in enumerate(names_of) for name in own]
    owners: dict[str, str] = {}
    for kind, number, prefix, name, keys in named:
        for column in (f"{prefix}_{name}_{key}" for key in keys):
            other = owners.setdefault(column, name)
            if other != name:
                yield (kind, number, "name"), (f'the history would have the column {column} for "{other}" and for "{name}"; '
                                               "give one of them another name")
                break


def _too_many(deck: Deck) -> Iterator[tuple[tuple, str]]:
    if len(deck.body) > MOST_BODIES:
        yield ("body",), f"there are {len(deck.body)} bodies; at most {MOST_BODIES} are allowed"
    if (stations := len(deck.tracer) + sum(entry.points for entry in deck.gauge)) > MOST_STATIONS:
        yield ("gauge",), f"there are {stations} tracers and points of gauges; at most {MOST_STATIONS} are allowed"


def _bad_join(deck: Deck, number: int) -> Iterator[tuple[tuple, str]]:
    entry = deck.body[number]
    earlier = {other.name: other for other in deck.body[:number] if other.join is None}
    path = ("body", number, "join")
    if entry.join not in earlier:
        yield path, unknown("earlier body", entry.join, earlier)
    elif earlier[entry.join].material != entry.material:
        yield path, f'"{entry.join}" is made of {earlier[entry.join].material}, not of {entry.material}'
    if entry.strength_factor is not None:
        yield ("body", number, "strength_factor"), f'belongs to "{entry.join}", which the body joins'


def _bad_contact(deck: Deck) -> Iterator[tuple[tuple, str]]:
    slide = deck.sliding
    if not slide.hard:
        yield ("sliding", "hard"), "a contact needs the names of the hard bodies"
    elif all(entry.name in slide.hard for entry in deck.body if entry.join is None):
        yield ("sliding", "hard"), "a contact needs a body that is not hard"
    if slide.yield_factor in ("radius", "printed"):
        word = slide.yield_factor
        yield ("sliding", "yield_factor"), f'"{word}" is for the slip layer only; a contact takes "off" or a number'
    for key in OF_SLIP_LAYER:
        if getattr(slide, key) != Sliding.model_fields[key].default:
            yield ("sliding", key), f'{key} is for the slip layer only and has no meaning with method = "contact"'


def _bad_names(deck: Deck, names: list[str]) -> Iterator[tuple[tuple, str]]:
    slot_names = [entry.name for entry in deck.body if entry.join is None]
    lists = ((("sliding", "hard"), deck.sliding.hard), (("numerics", "interface_order"), deck.numerics.interface_order))
    for path, given in lists:
        for number, name in enumerate(given):
            if name not in slot_names:
                yield (*path, number), unknown("body", name, slot_names)
    order = deck.numerics.interface_order
    if order and sorted(order) != sorted(slot_names) and set(order) <= set(slot_names):
        yield ("numerics", "interface_order"), f"must name every body once: {', '.join(slot_names)}"
    singles = [(("stop", "body"), deck.stop.body)]
    singles += [(("gauge", number, "surface"), gauge.surface) for number, gauge in enumerate(deck.gauge)]
    if deck.penetration:
        singles += [(("penetration", key), getattr(deck.penetration, key)) for key in ("rod", "target")]
        singles += [(("penetration", "targets", number), name) for number, name in enumerate(deck.penetration.targets)]
    for path, name in singles:
        if name is not None and name not in slot_names:
            yield path, unknown("body", name, slot_names)
    for axis in ("r", "z"):
        for number, segment in enumerate(getattr(deck.mesh, axis)):
            if segment.across is not None and segment.across not in names:
                yield ("mesh", axis, number, "across"), unknown("body", segment.across, names)


def _bad_targets(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Targets that cannot be penetrated in the given order."""
    shot, known = deck.penetration, {entry.name for entry in deck.body}
    if shot is None or not known.issuperset({shot.rod, *shot.targets}):
        return
    for number, name in enumerate(shot.targets):
        if name == shot.rod:
            yield ("penetration", "targets", number), f'"{name}" is the projectile'
        elif number > 0:
            before, sign = shot.targets[number - 1], heading(body(deck, shot.rod), body(deck, shot.targets[0]))
            if sign * (faces(deck, shot.rod, name)[0] - faces(deck, shot.rod, before)[0]) < 0.0:
                path = ("penetration", "targets", number)
                yield path, f'"{shot.rod}" reaches "{name}" before "{before}"; name them in that order'


def _bad_sources(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Sources without a body of their own or with the name of a sink."""
    bodies = [entry.name for entry in deck.body if entry.join is None]
    for number, entry in enumerate(deck.source):
        if entry.body not in bodies:
            yield ("source", number, "body"), unknown("body", entry.body, bodies)
        if entry.name in SINKS:
            yield ("source", number, "name"), f'the name "{entry.name}" is that of a sink of the audit: {SINKS[entry.name]}'


def _bad_edges(deck: Deck) -> Iterator[tuple[tuple, str]]:
    table = deck.boundaries.model_dump()
    for edge in EDGES:
        kind = BY_NAME.get(table[edge])
        own = {f"{edge}_{key.name}": key for key in kind.keys} if kind else {}
        for key, entry in sorted(own.items()):
            if table[key] is None and entry.required:
                yield ("boundaries", edge), f"{kind.in_words} needs {key}"
        moves = kind is not None and kind.constrains() and any(table[key] or entry.required for key, entry in own.items())
        if moves and deck.sliding.method == "contact":
            yield ("boundaries", edge), "a contact allows no edge with a velocity: each body group would need its own"
        for other in KINDS:
            for key in (f"{edge}_{each.name}" for each in other.keys if edge in other.edges):
                if key not in own and table[key] is not None:
                    yield ("boundaries", key), f'has no meaning without {edge} = "{other.name}"'


def mesh_edges(deck: Deck) -> dict[str, Edge]:
    """The edges of the mesh of a deck with all of their keys, by their names."""
    table = deck.boundaries.model_dump()
    return {name: made(name, table) for name in EDGES if table[name] is not None}


def _closing_edges(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Held edges that move what lies between them and the opposite edge into that edge, or along an anvil."""
    of = mesh_edges(deck)
    for name, edge in of.items():
        beside = [other for other, each in of.items() if other[0] != name[0] and each.traction() == PUSH]
        if edge.slide() and beside:
            yield ("boundaries", name), f"a held edge that moves along itself has no corner with an anvil, here {beside[0]}"
    for low, high in (("r_min", "r_max"), ("z_min", "z_max")):
        pair = {name: (sign, of.get(name)) for name, sign in ((low, 1.0), (high, -1.0))}  # r_min left out: an axis or a wall
        if not all(edge is None or edge.constrains() for _, edge in pair.values()):
            continue
        inward = {name: max((sign * speed for speed in edge.speeds()), default=0.0) if edge else 0.0
                  for name, (sign, edge) in pair.items()}
        held = [name for name, (_, edge) in pair.items() if edge and edge.slide() is not None and inward[name] > 0.0]
        if held and sum(inward.values()) > 0.0:
            yield ("boundaries", held[0]), (f"{low} and {high} move the bodies between them into each other, at "
                                            f'{sum(inward.values()):g} m/s; an edge with a "velocity" may compress them')


def share_filled(deck: Deck, edge: str) -> float:
    """Share of the length of an edge at which bodies lie, at the start."""
    axis, end = edge.split("_")
    across, along = (axis_edges(deck, name) for name in (axis, "z" if axis == "r" else "r"))
    line = across[:2] if end == "min" else across[:-3:-1]
    inside = line[0] + AT_EDGE * (line[1] - line[0])
    low, high, total = float(along[0]), float(along[-1]), 0.0
    outlines, reached = [placed.outline for placed in layout(deck).bodies], low
    for start, stop in sorted(chord for one in outlines for chord in one.chords("z" if axis == "r" else "r", inside)):
        total += max(min(stop, high) - max(start, reached), 0.0)
        reached = max(reached, min(stop, high))
    return total / (high - low)


def _idle_pressures(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Edges with a pressure at which no body lies."""
    for name, edge in mesh_edges(deck).items():
        if edge.traction() == PRESSURE and share_filled(deck, name) == 0.0:
            yield ("boundaries", name), "no body lies at this edge, and its pressure does not act across void"


def _bad_mesh(deck: Deck) -> Iterator[tuple[tuple, str]]:
    cylindrical = deck.mesh.geometry == "cylindrical"
    if cylindrical and deck.mesh.r_start < 0:
        yield ("mesh", "r_start"), f"a cylindrical mesh must start at r >= 0, not at {deck.mesh.r_start:g} m"
        return
    if deck.boundaries.r_min == "axis" and not (cylindrical and deck.mesh.r_start == 0):
        yield ("boundaries", "r_min"), "an axis needs a cylindrical mesh that starts at r = 0"
    if deck.boundaries.r_min not in ("axis", None) and cylindrical and deck.mesh.r_start == 0:
        yield ("boundaries", "r_min"), 'r = 0 of a cylindrical mesh is the axis; only "axis" is allowed there'
    try:
        r, z = axis_edges(deck, "r"), axis_edges(deck, "z")
    except MeshError as problem:
        yield problem.path, str(problem)
        return
    direction = 0.0
    if deck.mesh.follow is not None:
        problems = list(_bad_follow(deck, z))
        if problems:
            yield from problems
            return
        direction = travel(deck)
    for number, entry in enumerate(deck.body):
        path = ("body", number)
        low, high = extent(entry, deck, "z")
        if direction and _comes(low, high, z, direction):
            if entry.velocity != (0.0, 0.0) or entry.flow is not None:
                yield path, f'"{entry.name}" reaches beyond the end of the travelling mesh; a body there must be at rest'
        elif high <= z[0] or low >= z[-1]:
            yield path, _outside(entry.name, "z", low, high, z)
        elif entry.must_be_whole and (low < z[0] or high > z[-1]):
            yield path, _outside(entry.name, "z", low, high, z, "is cut off by")
        inner, outer = extent(entry, deck, "r")
        if outer <= r[0] or inner >= r[-1]:
            yield path, _outside(entry.name, "r", inner, outer, r)
        elif entry.must_be_whole and (outer > r[-1] or r[0] > 0):
            yield path, _outside(entry.name, "r", inner, outer, r, "is cut off by")
        elif cylindrical and entry.radial_key is not None and inner < 0:
            yield (*path, entry.radial_key), f"r is negative at {inner:g} m"
    for number, tracer in enumerate(deck.tracer):
        if not (r[0] <= tracer.r <= r[-1] and z[0] <= tracer.z <= z[-1]):
            yield ("tracer", number), f'"{tracer.name}" at r = {tracer.r:g} m, z = {tracer.z:g} m lies outside the mesh'
    for number, gauge in enumerate(deck.gauge):
        for name, (at_r, at_z) in gauge.places():
            if not r[0] <= at_r <= r[-1] or (deck.mesh.follow is None and not z[0] <= at_z <= z[-1]):
                yield ("gauge", number), f'"{name}" at r = {at_r:g} m, z = {at_z:g} m lies outside the mesh'
                break


def travel(deck: Deck) -> float:
    """The direction in which the mesh travels along z, +1 or -1; 0 if it does not move."""
    if deck.mesh.follow is None:
        return 0.0
    return float(np.sign(body(deck, deck.mesh.follow).velocity[1]))


def _comes(low: float, high: float, z: np.ndarray, direction: float) -> bool:
    """Whether something from low to high reaches beyond the leading edge of the mesh."""
    return high > z[-1] if direction > 0 else low < z[0]


def room(deck: Deck, z: np.ndarray) -> tuple[float, float]:
    """Distances in m that a mesh with edges z reaches ahead of the body that it follows, and behind it."""
    low, high = extent(body(deck, deck.mesh.follow), deck, "z")
    below, above = low - float(z[0]), float(z[-1]) - high
    return (above, below) if travel(deck) > 0 else (below, above)


def _bad_follow(deck: Deck, z: np.ndarray) -> Iterator[tuple[tuple, str]]:
    path, name = ("mesh", "follow"), deck.mesh.follow
    slot_names = [entry.name for entry in deck.body if entry.join is None]
    if name not in slot_names:
        yield path, unknown("body", name, slot_names)
        return
    direction = travel(deck)
    if direction == 0.0:
        yield path, f'"{name}" has no velocity along z for the mesh to follow'
        return
    for key in ("z_min", "z_max"):
        kind = getattr(deck.boundaries, key)
        if BY_NAME[kind].constrains() or BY_NAME[kind].traction() in (PUSH, PRESSURE):
            yield ("boundaries", key), (f'a mesh that follows "{name}" must have open ends along z; {BY_NAME[kind].in_words} '
                                        "cannot travel with it")
    ahead, behind = room(deck, z)
    radius = extent(body(deck, name), deck, "r")[1]
    if ahead < (radius if np.isfinite(radius) else 0.0):
        yield path, (f'the mesh is too short: it reaches {ahead:g} m ahead of "{name}"; at least the radius of the body, '
                     f"{radius:g} m, is needed, and {AHEAD} radii for an undisturbed flight")
    if behind <= 0.0:
        yield path, f'the mesh is too short: it ends {-behind:g} m before the tail of "{name}"'


def bars_to_follow(deck: Deck, name: str) -> list[str]:
    """Why the fixed mesh of a valid deck could not follow this body; empty if it could."""
    following = deck.model_copy(update={"mesh": deck.mesh.model_copy(update={"follow": name})})
    return [problem for _, problem in _bad_mesh(following)]


def _outside(name: str, axis: str, low: float, high: float, mesh: np.ndarray, how: str = "lies outside") -> str:
    return f'"{name}" {how} the mesh: {axis} from {low:g} to {high:g} m, the mesh from {mesh[0]:g} to {mesh[-1]:g} m'


def axial_length(deck: Deck, entry) -> float | None:
    """Length along the axis, m, of a rod or solid ball that lies on it alone and wholly in the mesh; None for all others.

    A body is not alone if another is joined to it, or if an earlier one overlaps it on the axis.
    """
    joined = entry.join or any(other.join == entry.name for other in deck.body)
    if not entry.lies_on_axis or joined or deck.mesh.r_start != 0.0:
        return None
    (low, high), z = extent(entry, deck, "z"), axis_edges(deck, "z")
    earlier = layout(deck).bodies[: deck.body.index(entry)]
    before = [chord for other in earlier for chord in other.outline.chords("z", BESIDE_AXIS)]
    alone = all(min(end, high) - max(start, low) <= BESIDE_AXIS for start, end in before)
    return high - low if alone and z[0] <= low and high <= z[-1] else None


def heading(rod, target=None) -> int:
    """1 for a penetrator that flies towards +z, -1 for -z; relative to its target if one is given."""
    own = rod.velocity[1] - (target.velocity[1] if target is not None else 0.0)
    return rod.nose_direction or (-1 if own < 0.0 else 1)


def faces(deck: Deck, rod: str, target: str) -> tuple[float, float]:
    """Axial positions of a target's front and rear face, as the rod meets them, m."""
    return extent(body(deck, target), deck, "z")[:: heading(body(deck, rod), body(deck, target))]


def unsupported(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Combinations that are impossible with the materials of the deck."""
    yield from _idle_pressures(deck)
    if deck.sliding.method == "slip-layer":
        for number, name in enumerate(deck.sliding.hard):
            material = deck.materials[body(deck, name).material]
            if not material.has_strength:
                yield (
                    ("sliding", "hard", number),
                    f'"{name}" is made of {material.name}, which has no strength; a hard body needs strength',
                )
        if deck.sliding.yield_factor in ("radius", "printed") and body_radius(deck, deck.sliding.hard[0]) is None:
            yield (
                ("sliding", "yield_factor"),
                f'"{deck.sliding.yield_factor}" needs a hard body with a radius; give a number or "off"',
            )
    for number, entry in enumerate(deck.body):
        given = [key for key in ("energy", "pressure", "temperature") if getattr(entry, key) is not None]
        if given and deck.materials[entry.material].eos.name in EXPLOSIVES:
            yield ("body", number, given[0]), "would replace the energy of the detonation; an explosive begins at rest"
        if entry.strength_factor is not None and (wrong := _unscaled(deck.materials[entry.material])):
            yield ("body", number, "strength_factor"), wrong
    for number, entry in enumerate(deck.source):
        if misfit := entry.misfit(deck.materials[body(deck, entry.body).material]):
            yield ("source", number, "body"), misfit
        if entry.kind == "detonation" and deck.mesh.follow is not None:
            yield ("source", number, "kind"), "a detonation lights what is in the mesh at the start; mesh.follow brings in more"
    if (deck.stop.speed_below is not None or deck.stop.rebound) and deck.stop.body is None:
        yield ("stop", "body"), "is missing: the name of the body whose speed is watched"
    if deck.stop.perforation and deck.penetration is None:
        yield ("stop", "perforation"), "needs a projectile and a target"
    yield from formulas.problems(deck)
    if deck.output.history_interval is None or deck.output.vtk_interval is None:
        yield ("output",), "without stop.time, history_interval and vtk_interval must be given"


def _unscaled(material: Material) -> str | None:
    """Why a factor cannot scale the strength of a material; None if it can, or if its model is not trusted and not run."""
    strength = material.strength
    if not material.has_strength:
        return f"{material.name} has no strength to scale"
    if strength.trusted and hasattr(strength.module("strength"), "back_stress"):
        return f"the back stress of {strength.name} would not be scaled; change the parameters of {material.name} instead"
    return None
