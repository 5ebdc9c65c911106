"""The input deck: reads strict TOML and gives a frozen, validated Deck in SI units.

``load`` and ``loads`` read a deck with its includes and overrides. Every mistake raises a DeckError that names the file, the
line, the key and what is allowed. ``edges``, ``slots``, ``body_groups``, ``sliding_widths``, ``yield_factor``, ``surface`` and
``impact_velocity`` derive further values from a deck. ``warnings`` lists allowed but unwise choices.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import PrivateAttr, ValidationError, ValidationInfo, model_validator

from hydro2d.base import units
from hydro2d.base.errors import MOST_LINES, DeckError, unknown
from hydro2d.deck import formulas, key_messages, sections
from hydro2d.deck.checks import axial_length, bars_to_follow, faces, heading, inconsistencies, room, travel, unsupported
from hydro2d.deck.generated_mesh import as_segments, with_segments
from hydro2d.deck.layout import body_groups, edges, extent, layout, slots
from hydro2d.deck.mesh import MeshError, body, body_radius, cells_between
from hydro2d.deck.warnings import warnings
from hydro2d.files import shipped, toml
from hydro2d.files.key_lines import Sources, spelled
from hydro2d.files.whole import plain
from hydro2d.materials import from_files, library
from hydro2d.mesh.edges.base import EDGES
from hydro2d.mesh.edges.registry import BY_NAME

if TYPE_CHECKING:
    from hydro2d.deck.shapes.registry import AnyBody

__all__ = [
    "Deck",
    "DeckError",
    "axial_length",
    "bars_to_follow",
    "body",
    "body_groups",
    "cells_between",
    "edges",
    "extent",
    "find",
    "impact_velocity",
    "layout",
    "load",
    "loads",
    "of_tables",
    "room",
    "schema",
    "sliding_widths",
    "slots",
    "strength_factors",
    "surface",
    "travel",
    "warnings",
    "written_segments",
    "yield_factor",
]

#: overrides of a deck: "key=value" of a command line, or values by their dotted keys
Overrides = Sequence[str] | Mapping[str, Any]

#: the context in which a Deck may be validated: its defaults are resolved afterwards
_RESOLVING = {"resolving": True}


class Deck(sections.Deck):
    """An input deck: validated, with every default written out and all numbers in SI units. It never changes.

    `from_file`, `from_toml` and `from_dict` make one. Sections are attributes: ``deck.numerics.courant``,
    ``deck.body[0].velocity``.
    """

    #: the tables of the deck before its defaults were written out
    _tables: dict[str, Any] = PrivateAttr(default_factory=dict)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Deck) and dict(self) == dict(other)

    def __repr__(self) -> str:
        return f"<Deck {self.name}: {self.title or 'without title'}; bodies {', '.join(entry.name for entry in self.body)}>"

    @model_validator(mode="before")
    @classmethod
    def _is_resolved(cls, data: Any, info: ValidationInfo) -> Any:
        """Refuses a Deck made by its class, whose defaults would not be resolved and whose consistency would not be checked."""
        if info.context is not _RESOLVING:
            raise DeckError("use Deck.from_file, Deck.from_toml or Deck.from_dict to make a Deck, not its class")
        return data

    @classmethod
    def from_file(cls, path: str | Path, overrides: Overrides = ()) -> Deck:
        """Reads a deck file.

        Parameters
        ----------
        path : str or Path
            A TOML file, or the path of a deck that hydro2d ships, such as ``problems/perforation/sphere.toml``.
        overrides : dict or list of str
            Values by dotted key that replace those of the deck: ``{"body.rod.velocity": "1200 m/s", "stop.time": 50e-6}``. A
            list has ``"key=value"``, as for the option ``--set`` of the command line. A number of a quantity with a unit must
            be text that names it, unless the deck or the overrides have ``numbers = "SI"``.

        Raises
        ------
        DeckError
            The file or its contents are wrong. The message has one line for each mistake, with file, line, key and what is
            allowed.
        """
        return load(path, overrides)

    @classmethod
    def from_toml(cls, text: str, overrides: Overrides = (), *, name: str = "deck",
                  folder: str | Path = ".") -> Deck:
        """Reads a deck from TOML text.

        name : name of the run and of its directory
        folder : folder of the files that the text names: included decks, and models of your own
        overrides : as in `from_file`

        Raises DeckError.
        """
        return loads(text, overrides, name, folder)

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], overrides: Overrides = (), *, name: str = "deck",
                  folder: str | Path = ".") -> Deck:
        """Makes a deck from nested dicts and lists with the contents of a TOML file.

        tables : with ``"numbers": "SI"`` numbers without a unit are in SI units; without it, quantities are text with a unit
        name, folder, overrides : as in `from_toml`

        Raises DeckError.
        """
        return of_tables(tables, overrides, name, folder)

    def edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Edges of the cells along r and along z, m, shapes (nr + 1,) and (nz + 1,)."""
        return edges(self)

    @property
    def setup(self) -> str:
        """A hash of everything that can change the results: two runs with the same one are the same run."""
        from hydro2d.deck import identity

        return identity.setup(self)

    @property
    def cells_across(self) -> float | None:
        """Number of cells across the radius of the projectile, or of the first body that has one; None without such a body."""
        from hydro2d.deck import identity

        return identity.cells_across(self)

    def body_named(self, name: str) -> AnyBody:
        """The entry of ``body`` with this name. Raises KeyError if there is none."""
        return body(self, name)


def find(path: str | Path) -> Path:
    """The deck file: as given, or among the decks that hydro2d ships. Raises DeckError if there is none."""
    path = Path(path)
    if path.is_file():
        return path
    if (file := shipped.shipped_file(path)) is not None:
        return file
    problems = shipped.problems_folder()
    folder = path.parent if path.parent.is_dir() else problems
    decks = [str(file.relative_to(folder)) for file in folder.glob("*.toml" if folder != problems else "*/*.toml")]
    raise DeckError(f"{path}: there is no such file; {unknown('deck', path.name, decks)}")


def load(path: str | Path, overrides: Overrides = (), *, trust: bool = True) -> Deck:
    """Reads a deck file.

    Parameters
    ----------
    path : str or Path
        A file, or the path of a shipped deck below ``problems``.
    overrides : list of str, or dict
        ``key=value`` with dotted keys, applied to the deck in order: ``body.rod.velocity=1200 m/s``; or values by such keys.
        ``key=``, or the value None, removes a key, which then has its default.
    trust : bool
        Whether the code of models that the deck carries or names may be run; a deck that is only read seldom needs it.

    Raises
    ------
    DeckError
        The deck is wrong; the message has one line for each mistake found.
    """
    file = find(path)
    sources = Sources()
    data = toml.read(file, sources)
    if toml.is_study(data) and "mesh" not in data:
        raise DeckError(f"{file}: is a study, not a deck; run it with `hydro2d sweep` or `hydro2d transition`")
    return _resolve(data, file.stem, overrides, sources, trust)


def written(path: str | Path, overrides: Overrides = ()) -> dict:
    """The tables of a deck file with overrides, as they are written: without defaults, unchecked. Raises DeckError."""
    sources = Sources()
    return _laid_over(toml.read(find(path), sources), overrides, sources)


def loads(text: str, overrides: Overrides = (), name: str = "deck", folder: str | Path = ".", *, trust: bool = True) -> Deck:
    """Reads a deck from a string; its includes and models are in ``folder``. ``trust`` and DeckError as for ``load``."""
    sources = Sources()
    data = toml.assemble(text, f"{name}.toml", Path(folder), sources)
    return _resolve(data, name, overrides, sources, trust)


def of_tables(tables: Mapping[str, Any], overrides: Overrides = (), name: str = "deck", folder: str | Path = ".") -> Deck:
    """Makes a deck from nested dicts and lists, as a TOML file would give them. Raises DeckError as ``load`` does."""
    sources = Sources()
    sources.add(name, {}, "")
    data = toml.with_included(plain(toml.within_limits(tables, name)), Path(folder), sources)
    return _resolve(data, name, overrides, sources, True)


def _laid_over(data: dict, overrides: Overrides, sources: Sources) -> dict:
    """The deck with overrides applied; their numbers are in SI units if the deck or one of them says so."""
    if isinstance(overrides, str):
        raise DeckError(f'overrides must be a list of "key=value" or a dict of values by key, not the text "{overrides}"')
    if isinstance(overrides, Mapping):
        toml.within_limits(overrides, "overrides")
        entries = [(key, value, f"override {key} = {value!r}") for key, value in plain(overrides).items()]
    else:
        entries = [(*toml.assignment(text), f"--set {text}") for text in overrides]
    in_si = toml.SI in (data.get("numbers"), *(value for key, value, _ in entries if key == "numbers"))
    for key, value, said in entries:
        if value is None:
            if wrong := key_messages.key_problem(data, key):
                raise DeckError(f"{said}: {wrong}")
            data = toml.removed(data, key, said)
            continue
        placed = toml.placed_value(key, value, Path())
        data = toml.override(data, key, placed if in_si else units.bare(placed), said, sources)
    return data


def _resolve(data: dict, name: str, overrides: Overrides, sources: Sources, trust: bool) -> Deck:
    data = {"name": name, **_laid_over(data, overrides, sources)}
    problems: list[str] = []

    def complaint(path: tuple, message: str) -> DeckError:
        return DeckError(f"{sources.where(path, data)}: {spelled(path)}: {message}")

    data = from_files.read(data, complaint, trust)
    try:
        deck = Deck.model_validate(data, context=_RESOLVING)
        deck._tables = data
    except ValidationError as error:
        mistakes = key_messages.causes(error.errors())
        problems = [str(complaint(*key_messages.explained(entry, data))) for entry in mistakes[:MOST_LINES]]
        problems += [str(complaint(path, message)) for path, message in islice(_unknown_materials(data), MOST_LINES)]
        problems += [f"{len(mistakes) - MOST_LINES} further mistakes"] if len(mistakes) > MOST_LINES else []
        raise DeckError("\n".join(dict.fromkeys(problems))) from None
    try:
        deck = with_segments(deck)
    except MeshError as error:
        raise complaint(error.path, str(error)) from None
    wrong_together = islice(chain(inconsistencies(deck), _unknown_materials(data)), MOST_LINES)
    problems += [str(complaint(path, message)) for path, message in wrong_together]
    own, wrong = _own_materials(deck, complaint, trust)
    problems += wrong
    if problems:
        raise DeckError("\n".join(problems))
    deck = deck.model_copy(update={"materials": _materials(deck, own, complaint, trust)})
    deck = _with_defaults(deck)
    problems = [str(complaint(path, message)) for path, message in unsupported(deck)]
    problems += [str(complaint(*wrong)) for wrong in formulas.trusted_results(deck)] if trust and not problems else []
    if problems:
        raise DeckError("\n".join(problems))
    deck._tables = data
    return deck


def _own_materials(deck: Deck, complaint, trust: bool) -> tuple[dict[str, library.Material], list[str]]:
    """The materials that the deck defines, and their mistakes."""

    def fail(path: tuple, message: str) -> DeckError:
        return complaint(("materials", *path), message)

    own, problems = {}, []
    for name in deck.materials:
        try:
            own[name] = library.from_deck(name, deck.materials, fail, trust)
        except DeckError as error:
            problems.append(str(error))
    return own, list(dict.fromkeys(problems))


def _materials(deck: Deck, own: dict[str, library.Material], complaint, trust: bool) -> dict[str, library.Material]:
    """The materials that bodies use, and those that the deck defines."""
    chosen = dict(own)
    for number, entry in enumerate(deck.body):
        def fail(path: tuple, message: str, number=number, name=entry.material) -> DeckError:
            return complaint(("body", number, "material"), f"{name}: {message}")

        if entry.material not in chosen:
            chosen[entry.material] = library.from_deck(entry.material, deck.materials, fail, trust)
    return chosen


def _unknown_materials(data: dict) -> Iterator[tuple[tuple, str]]:
    """Bodies with an unknown material, in a deck as it was read, which may be wrong in other ways."""
    bodies, own = data.get("body"), data.get("materials")
    for number, entry in enumerate(bodies if isinstance(bodies, list) else ()):
        material = entry.get("material") if isinstance(entry, dict) else None
        wrong = library.problem(material, own if isinstance(own, dict) else {}) if isinstance(material, str) else None
        if wrong:
            yield ("body", number, "material"), wrong


def _with_defaults(deck: Deck) -> Deck:
    """The deck with the defaults that follow from other keys."""
    update: dict[str, Any] = {"numbers": toml.SI}
    data = copy.deepcopy(deck.model_dump(exclude={"materials"}))
    if deck.boundaries.r_min is None:
        axis = deck.mesh.geometry == "cylindrical" and deck.mesh.r_start == 0
        data["boundaries"]["r_min"] = "axis" if axis else "wall"
    for edge in EDGES:
        for key in BY_NAME[data["boundaries"][edge]].keys:
            if data["boundaries"][f"{edge}_{key.name}"] is None:
                data["boundaries"][f"{edge}_{key.name}"] = key.default
    alone = [entry for entry in deck.body if entry.join is None]
    plates = [entry for entry in alone if entry.is_target]
    rod = max(alone, key=lambda entry: entry.projectile_rank, default=None)
    if deck.penetration is None and rod is not None and rod.projectile_rank > 0 and plates:
        data["penetration"] = {"rod": rod.name, "targets": _in_the_way(deck, rod, plates)}
    if shot := data["penetration"]:
        shot["targets"] = shot["targets"] or [shot["target"]]
        shot["target"] = shot["targets"][0]
        if shot.get("surface") is None:
            shot["surface"] = faces(deck, shot["rod"], shot["target"])[0]
    watched = deck.stop.speed_below is not None or deck.stop.rebound
    if watched and deck.stop.body is None and data["penetration"]:
        data["stop"]["body"] = data["penetration"]["rod"]
    if deck.output.directory is None:
        data["output"]["directory"] = f"runs/{deck.name}"
    for key, share in (("history_interval", 1000), ("vtk_interval", 50)):
        if data["output"][key] is None and deck.stop.time is not None:
            data["output"][key] = deck.stop.time / share
    if not deck.numerics.interface_order:
        names, group = slots(deck), body_groups(deck)
        data["numerics"]["interface_order"] = sorted(names, key=lambda name: -group[names.index(name)])
    for section in ("boundaries", "penetration", "stop", "output", "numerics"):
        if data[section] is not None:
            kind = key_messages.section_of(Deck, section)
            update[section] = kind.model_validate(data[section])
    deck = deck.model_copy(update=update)
    return deck if _is_the_shot(deck) else deck.model_copy(update={"experiment": None})


def _is_the_shot(deck: Deck) -> bool:
    """Whether the experiment of the deck matches its velocity and its target."""
    shot = deck.experiment
    if shot is None or deck.penetration is None:
        return True
    if shot.velocity is not None and abs(impact_velocity(deck) - shot.velocity) > 0.01 * shot.velocity:
        return False
    return shot.target is None or body(deck, deck.penetration.target).material == shot.target


def impact_velocity(deck: Deck) -> float:
    """Axial speed of the rod relative to its target, m/s; the deck must have both."""
    rod, target = (body(deck, getattr(deck.penetration, key)) for key in ("rod", "target"))
    return abs(rod.velocity[1] - target.velocity[1])


def _in_the_way(deck: Deck, rod, plates: list) -> list[str]:
    """Names of the plates and boxes ahead of a rod on its axis, in the order it reaches them; if none, the first one."""
    here = sum(extent(rod, deck, "z"))
    across = [entry for entry in plates if extent(entry, deck, "r")[0] <= deck.mesh.r_start]
    ahead = [entry for entry in across if heading(rod, entry) * (sum(extent(entry, deck, "z")) - here) > 0.0]
    ahead.sort(key=lambda entry: heading(rod, entry) * faces(deck, rod.name, entry.name)[0])
    return [entry.name for entry in ahead or plates[:1]]


def written_segments(deck: Deck) -> dict[str, Any]:
    """Overrides by key that write out the segments of a mesh described by cells_across and reach; empty for other meshes."""
    return as_segments(deck, deck._tables)


def sliding_widths(deck: Deck) -> tuple[float, float]:
    """Widths of the boundary layer and of the slip layer in m; plain numbers in the deck count cells of the finest size."""
    finest = min(float(np.diff(axis).min()) for axis in edges(deck))
    finest = float(f"{finest:.12g}")  # edges carry round-off
    given = (deck.sliding.boundary_layer, deck.sliding.slip_layer)
    boundary, slip = (units.to_si(w, "m") if isinstance(w, str) else w * finest for w in given)
    return boundary, slip


def yield_factor(deck: Deck) -> float:
    """The factor on the yield stress of hard bodies.

    "radius" is ((R + w)/R)^2 with the radius of the first hard body and the width w of the boundary layer: the load is
    carried over the area out to R + w. "printed" is the same with the density of the hard body in g/cm^3 in place of R and w
    in cm, as Scheffler prints it.
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


def strength_factors(deck: Deck) -> np.ndarray:
    """The factor on the flow stress of the material of every slot, float64[m]; 1 by default."""
    return np.array([entry.strength_factor or 1.0 for entry in deck.body if entry.join is None])


def surface(deck: Deck) -> float | None:
    """Axial position from which the penetration depth is measured, m; None for a deck without rod and target."""
    return deck.penetration.surface if deck.penetration else None


def schema() -> dict:
    """The JSON schema of a deck, for editors."""
    from hydro2d.materials import schema as materials

    result = Deck.model_json_schema()
    result["title"] = "hydro2d input deck"
    result["$defs"] |= materials.definitions()
    result["properties"]["materials"]["additionalProperties"] = {"$ref": "#/$defs/Material"}
    result["properties"]["include"] = {
        "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}],
        "description": "decks on which this one is based, next to this file or shipped; values of this deck replace theirs",
        "examples": ["hemi_5083_1086.toml", "problems/perforation/sphere.toml"],
    }
    return result
