"""The input deck: strict TOML in, a frozen and validated Deck in SI units out.

``load`` and ``loads`` read a deck with its includes and overrides; every mistake is a DeckError that names file, line,
key and what is allowed. ``edges``, ``slots``, ``sliding_widths``, ``yield_factor`` and ``surface`` answer what follows
from a deck; ``warnings`` lists what is allowed but unwise.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from hydro2d import deck_toml, materials, units
from hydro2d.deck_base import Section
from hydro2d.deck_bodies import SHAPES
from hydro2d.deck_errors import DeckError, Sources, spelled, unknown
from hydro2d.deck_mesh import SegmentError, axis_edges, body_radius
from hydro2d.deck_models import Deck

__all__ = [
    "Deck",
    "DeckError",
    "body",
    "edges",
    "find",
    "load",
    "loads",
    "schema",
    "sliding_widths",
    "slots",
    "surface",
    "warnings",
    "yield_factor",
]

#: a rod needs at least this many cells across its radius to behave like one
CELLS_ACROSS_RADIUS = 5


def find(path: str | Path) -> Path:
    """The deck file: as given, or among the decks that hydro2d ships; DeckError where there is none."""
    path = Path(path)
    if path.is_file():
        return path
    shipped = materials.problems_folder()
    parts = path.parts[1:] if path.parts[:1] == ("problems",) else path.parts
    if not path.is_absolute() and shipped.joinpath(*parts).is_file():
        return shipped.joinpath(*parts)
    folder = path.parent if path.parent.is_dir() else shipped
    decks = [str(file.relative_to(folder)) for file in folder.glob("*.toml" if folder != shipped else "*/*.toml")]
    raise DeckError(f"{path}: there is no such file; {unknown('deck', path.name, decks)}")


def load(path: str | Path, overrides: Sequence[str] = ()) -> Deck:
    """Reads a deck file.

    Parameters
    ----------
    path : str or Path
        A file, or the path of a shipped deck below ``problems``.
    overrides : list of str
        ``key=value`` with dotted keys, laid over the deck in order: ``body.rod.velocity=1200 m/s``.

    Raises
    ------
    DeckError
        The deck is wrong; the message has one line for each mistake found.
    """
    file = find(path)
    sources = Sources()
    return _resolve(deck_toml.read(file, sources), file.stem, overrides, sources)


def loads(text: str, overrides: Sequence[str] = (), name: str = "deck", folder: str | Path = ".") -> Deck:
    """Reads a deck from a string; includes are looked for in ``folder``. Raises DeckError as ``load`` does."""
    sources = Sources()
    data = deck_toml.assemble(text, f"{name}.toml", Path(folder), sources)
    return _resolve(data, name, overrides, sources)


def _resolve(data: dict, name: str, overrides: Sequence[str], sources: Sources) -> Deck:
    for text in overrides:
        data = deck_toml.override(data, text, sources)
    data = {"name": name, **data}
    problems: list[str] = []

    def complaint(path: tuple, message: str) -> DeckError:
        return DeckError(f"{sources.where(path, data)}: {spelled(path)}: {message}")

    try:
        deck = Deck.model_validate(data)
    except ValidationError as error:
        problems = [str(complaint(*_explained(entry, data))) for entry in error.errors()]
        raise DeckError("\n".join(dict.fromkeys(problems))) from None
    problems += [str(complaint(path, message)) for path, message in _inconsistencies(deck)]
    if problems:
        raise DeckError("\n".join(problems))
    deck = deck.model_copy(update={"materials": _materials(deck, complaint)})
    deck = _with_defaults(deck)
    problems = [str(complaint(path, message)) for path, message in _unsupported(deck)]
    if problems:
        raise DeckError("\n".join(problems))
    return deck


def _explained(entry: dict, data: dict) -> tuple[tuple, str]:
    """The key of the deck and our words for one of pydantic's errors."""
    path, kind = _key_path(entry["loc"], data), entry["type"]
    context = entry.get("ctx", {})
    if kind == "extra_forbidden":
        return path, unknown("key", str(path[-1]), _allowed_keys(path[:-1], data))
    if kind == "missing":
        return path, "is missing"
    if kind == "value_error":
        return path, str(context["error"])
    if kind == "literal_error":
        allowed = context["expected"].replace("'", '"').replace(" or ", ", ")
        return path, unknown("value", str(entry["input"]), [word.strip('" ') for word in allowed.split(",")])
    if kind == "union_tag_not_found":
        return (*path, "shape"), f"is missing (allowed: {', '.join(SHAPES)})"
    if kind == "union_tag_invalid":
        return (*path, "shape"), unknown("shape", str(context["tag"]), SHAPES)
    message = entry["msg"][0].lower() + entry["msg"][1:]
    return path, f"{message.replace('input ', '')}, is {entry['input']!r}"


def _key_path(loc: tuple, data: Any) -> tuple:
    """pydantic's location without the tags of unions: what can be followed in the deck."""
    path: tuple = ()
    for depth, part in enumerate(loc):
        last = depth == len(loc) - 1
        if isinstance(data, dict) and part not in data and not last and part in SHAPES:
            continue
        path += (part,)
        if isinstance(data, dict):
            data = data.get(part)
        elif isinstance(data, (list, tuple)) and isinstance(part, int) and part < len(data):
            data = data[part]
        else:
            data = None
    return path


def _allowed_keys(path: tuple, data: dict) -> list[str]:
    """Keys of the table at ``path``."""
    model: Any = Deck
    for part in path:
        if isinstance(part, int):
            data = data[part]
            model = model or SHAPES.get(data.get("shape"))
        else:
            data, model = data.get(part), _section(model, part)
    keys = list(model.model_fields) if model else []
    return [*keys, "include"] if model is Deck else keys


def _section(model: Any, key: str) -> Any:
    """The section that a key of a section holds; None for bodies, which their shape decides."""
    field = model.model_fields.get(key) if model else None
    return _first_section(field.annotation) if field else None


def _first_section(annotation: Any) -> Any:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return annotation
    inner = [_first_section(part) for part in getattr(annotation, "__args__", ())]
    found = [section for section in inner if section is not None]
    return found[0] if len(found) == 1 else None


def _inconsistencies(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """What single keys cannot show: names that point nowhere, bodies outside the mesh, ends that cannot be."""
    names = [entry.name for entry in deck.body]
    for number, entry in enumerate(deck.body):
        if entry.name in names[:number]:
            yield ("body", number, "name"), f'the name "{entry.name}" is taken by an earlier body'
        if entry.join is not None:
            yield from _bad_join(deck, number)
    yield from _bad_names(deck, names)
    yield from _bad_mesh(deck)
    if deck.stop.time is None and deck.stop.cycles is None:
        yield ("stop",), "needs a time or a number of cycles"
    if deck.sliding.method == "slip-layer" and not deck.sliding.hard:
        yield ("sliding", "hard"), "a slip layer needs the names of the hard bodies"
    if deck.sliding.friction > 0 and deck.sliding.shear != "shear":
        yield ("sliding", "friction"), 'friction acts only with shear = "shear"; a fluid slip layer has none'


def _bad_join(deck: Deck, number: int) -> Iterator[tuple[tuple, str]]:
    entry = deck.body[number]
    earlier = {other.name: other for other in deck.body[:number] if other.join is None}
    path = ("body", number, "join")
    if entry.join not in earlier:
        yield path, unknown("earlier body", entry.join, earlier)
    elif earlier[entry.join].material != entry.material:
        yield path, f'"{entry.join}" is made of {earlier[entry.join].material}, not of {entry.material}'


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
    if deck.penetration:
        singles += [(("penetration", key), getattr(deck.penetration, key)) for key in ("rod", "target")]
    for path, name in singles:
        if name is not None and name not in slot_names:
            yield path, unknown("body", name, slot_names)
    for axis in ("r", "z"):
        for number, segment in enumerate(getattr(deck.mesh, axis)):
            if segment.across is not None and segment.across not in names:
                yield ("mesh", axis, number, "across"), unknown("body", segment.across, names)


def _bad_mesh(deck: Deck) -> Iterator[tuple[tuple, str]]:
    cylindrical = deck.mesh.geometry == "cylindrical"
    if cylindrical and deck.mesh.r_start < 0:
        yield ("mesh", "r_start"), f"a cylindrical mesh starts at r >= 0, not at {deck.mesh.r_start:g} m"
        return
    if deck.boundaries.r_min == "axis" and not (cylindrical and deck.mesh.r_start == 0):
        yield ("boundaries", "r_min"), "an axis needs a cylindrical mesh that starts at r = 0"
    if deck.boundaries.r_min in ("wall", "outflow") and cylindrical and deck.mesh.r_start == 0:
        yield ("boundaries", "r_min"), "r = 0 of a cylindrical mesh is the axis"
    try:
        r, z = axis_edges(deck, "r"), axis_edges(deck, "z")
    except SegmentError as problem:
        yield problem.path, str(problem)
        return
    for number, entry in enumerate(deck.body):
        path = ("body", number)
        low, high = _extent(entry, deck, "z")
        if high <= z[0] or low >= z[-1]:
            yield path, _outside(entry.name, "z", low, high, z)
        elif entry.shape == "rod" and (low < z[0] or high > z[-1]):
            yield path, _outside(entry.name, "z", low, high, z, "is cut off by")
        inner, outer = _extent(entry, deck, "r")
        if outer <= r[0] or inner >= r[-1]:
            yield path, _outside(entry.name, "r", inner, outer, r)
        elif entry.shape == "rod" and (outer > r[-1] or r[0] > 0):
            yield path, _outside(entry.name, "r", inner, outer, r, "is cut off by")
        elif cylindrical and entry.shape == "box" and inner < 0:
            yield (*path, "r"), f"r is negative at {inner:g} m"
    for number, tracer in enumerate(deck.tracer):
        if not (r[0] <= tracer.r <= r[-1] and z[0] <= tracer.z <= z[-1]):
            yield ("tracer", number), f'"{tracer.name}" at r = {tracer.r:g} m, z = {tracer.z:g} m lies outside the mesh'


def _outside(name: str, axis: str, low: float, high: float, mesh: np.ndarray, how: str = "lies outside") -> str:
    return f'"{name}" {how} the mesh: {axis} from {low:g} to {high:g} m, the mesh from {mesh[0]:g} to {mesh[-1]:g} m'


def _extent(entry, deck: Deck, axis: str) -> tuple[float, float]:
    """Smallest and largest coordinate of a body along an axis."""
    from hydro2d.shapes import outline

    return outline(entry, deck.mesh.r_start).extent(axis)


def _materials(deck: Deck, complaint) -> dict[str, materials.Material]:
    """The materials that bodies use, resolved, and those that the deck defines, checked."""

    def fail(path: tuple, message: str) -> DeckError:
        return complaint(("materials", *path), message)

    chosen = {name: materials.from_deck(name, deck.materials, fail) for name in deck.materials}
    for number, entry in enumerate(deck.body):
        if entry.material not in chosen:
            known = {*deck.materials, *materials.names()}
            if entry.material not in known:
                raise complaint(("body", number, "material"), unknown("material", entry.material, known))
            chosen[entry.material] = materials.load(entry.material)
    return chosen


def _with_defaults(deck: Deck) -> Deck:
    """The deck with the defaults written in that follow from other keys."""
    update: dict[str, Any] = {}
    data = copy.deepcopy(deck.model_dump(exclude={"materials"}))
    if deck.boundaries.r_min is None:
        axis = deck.mesh.geometry == "cylindrical" and deck.mesh.r_start == 0
        data["boundaries"]["r_min"] = "axis" if axis else "wall"
    rods = [entry for entry in deck.body if entry.shape == "rod" and entry.join is None]
    targets = [entry for entry in deck.body if entry.shape in ("plate", "box") and entry.join is None]
    if deck.penetration is None and rods and targets:
        data["penetration"] = {"rod": rods[0].name, "target": targets[0].name}
    if data["penetration"] and data["penetration"].get("surface") is None:
        data["penetration"]["surface"] = _face(deck, data["penetration"]["rod"], data["penetration"]["target"])
    watched = deck.stop.speed_below is not None or deck.stop.rebound
    if watched and deck.stop.body is None and data["penetration"]:
        data["stop"]["body"] = data["penetration"]["rod"]
    if deck.output.directory is None:
        data["output"]["directory"] = f"runs/{deck.name}"
    for key, share in (("history_interval", 1000), ("vtk_interval", 50)):
        if data["output"][key] is None and deck.stop.time is not None:
            data["output"][key] = deck.stop.time / share
    if not deck.numerics.interface_order:
        data["numerics"]["interface_order"] = [entry.name for entry in deck.body if entry.join is None]
    for section in ("boundaries", "penetration", "stop", "output", "numerics"):
        if data[section] is not None:
            kind = _section(Deck, section)
            update[section] = kind.model_validate(data[section])
    return deck.model_copy(update=update)


def _face(deck: Deck, rod: str, target: str) -> float:
    """The face of the target that looks at the rod."""
    low, high = _extent(body(deck, target), deck, "z")
    moving = body(deck, rod)
    return high if moving.shape == "rod" and moving.direction < 0 else low


def _unsupported(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """What the materials make impossible."""
    if deck.sliding.method == "slip-layer":
        for number, name in enumerate(deck.sliding.hard):
            material = deck.materials[body(deck, name).material]
            if not material.has_strength:
                yield (
                    ("sliding", "hard", number),
                    f'"{name}" is made of {material.name}, which has no strength; a hard body needs one',
                )
        if deck.sliding.yield_factor in ("radius", "printed") and body_radius(deck, deck.sliding.hard[0]) is None:
            yield (
                ("sliding", "yield_factor"),
                f'"{deck.sliding.yield_factor}" needs a hard body with a radius; give a number or "off"',
            )
    if (deck.stop.speed_below is not None or deck.stop.rebound) and deck.stop.body is None:
        yield ("stop", "body"), "the name of the body whose speed is watched is missing"
    if deck.output.history_interval is None or deck.output.vtk_interval is None:
        yield ("output",), "without stop.time, history_interval and vtk_interval must be given"


def body(deck: Deck, name: str):
    """The body of this name; KeyError where there is none."""
    for entry in deck.body:
        if entry.name == name:
            return entry
    raise KeyError(name)


def slots(deck: Deck) -> list[str]:
    """Names of the bodies that have a place of their own in the arrays, in the order of index m."""
    return [entry.name for entry in deck.body if entry.join is None]


def edges(deck: Deck) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the cells in m without ghosts: float64[nr + 1] in r, float64[nz + 1] in z."""
    return axis_edges(deck, "r"), axis_edges(deck, "z")


def sliding_widths(deck: Deck) -> tuple[float, float]:
    """Width of the boundary layer and of the slip layer in m; numbers of the deck count cells of the finest size."""
    finest = min(float(np.diff(axis).min()) for axis in edges(deck))
    finest = float(f"{finest:.12g}")  # edges carry round-off
    given = (deck.sliding.boundary_layer, deck.sliding.slip_layer)
    boundary, slip = (units.to_si(w, "m") if isinstance(w, str) else w * finest for w in given)
    return boundary, slip


def yield_factor(deck: Deck) -> float:
    """The factor on the yield stress of hard bodies.

    "radius" is ((R + w)/R)^2 with the radius of the first hard body and the width w of the boundary layer: the load is
    carried over the area out to R + w. "printed" is the same with the hard body's density in g/cm^3 and w in cm in the
    place of R, as Scheffler prints it.
    """
    factor = deck.sliding.yield_factor
    if deck.sliding.method == "none" or factor == "off":
        return 1.0
    if not isinstance(factor, str):
        return factor
    width = sliding_widths(deck)[0]
    hard = body(deck, deck.sliding.hard[0])
    if factor == "radius":
        return (1 + width / body_radius(deck, hard.name)) ** 2
    return (1 + (width * 100) / (deck.materials[hard.material].reference_density / 1000)) ** 2


def surface(deck: Deck) -> float | None:
    """Axial position that the penetration depth is measured from, m; None for a deck without rod and target."""
    return deck.penetration.surface if deck.penetration else None


def warnings(deck: Deck) -> list[str]:
    """What is allowed but unwise, one sentence each."""
    found = []
    r, z = edges(deck)
    for entry in deck.body:
        if entry.shape == "rod":
            cells = entry.rod_radius / float(np.diff(r)[r[:-1] < entry.rod_radius].max())
            if cells < CELLS_ACROSS_RADIUS - 1e-9:
                found.append(
                    f'body "{entry.name}": {cells:.1f} cells across the radius; below {CELLS_ACROSS_RADIUS} a rod is '
                    "neither rigid nor round"
                )
    for axis, sizes in (("r", np.diff(r)), ("z", np.diff(z))):
        jump = float(np.max(np.maximum(sizes[1:] / sizes[:-1], sizes[:-1] / sizes[1:]), initial=1.0))
        if jump > 1.25:
            found.append(f"mesh.{axis}: neighbouring cells differ by a factor of {jump:.2f}; shocks reflect beyond 1.2")
    if deck.sliding.method == "slip-layer" and deck.sliding.yield_factor == "off":
        found.append('sliding.yield_factor is "off": noise at the interface can yield a rod that should stay rigid')
    return found


def schema() -> dict:
    """The JSON schema of a deck, for editors."""
    result = Deck.model_json_schema()
    result["title"] = "hydro2d input deck"
    result["properties"]["include"] = {
        "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
        "description": "decks that this one is laid over, relative to this file",
    }
    return result
