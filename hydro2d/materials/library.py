"""Named materials: the library, and the materials of a deck.

A material is an equation of state, a strength model, a damage model, a melting line and a fracture pressure. Every number of
the library has its source and a confidence. Doubtful printed values are kept as variants of the default.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping

from hydro2d.base.errors import DeckError, unknown
from hydro2d.files.key_lines import Sources
from hydro2d.files.shipped import problems_folder
from hydro2d.files.toml import PARTS, merge, parse
from hydro2d.materials.building import ABOUT, CHOICE, TABLES, Fail, build
from hydro2d.materials.material import CONFIDENCE, FRACTURE, Material, Model, Number
from hydro2d.materials.slots import MaterialTable, resolve

__all__ = [
    "CONFIDENCE",
    "Material",
    "MaterialTable",
    "Model",
    "Number",
    "describe",
    "from_deck",
    "load",
    "names",
    "resolve",
]

#: how the names of the materials of a metal begin that is no material itself; those of others begin with its name and "_"
FAMILIES = {
    "aluminium": "Al", "aluminum": "Al", "al": "Al", "copper": ("copper_", "Cu_"), "cu": ("copper_", "Cu_"),
    "iron": ("iron_", "Fe_"), "fe": ("iron_", "Fe_"), "titanium": "Ti_",
}


@functools.cache
def _library() -> tuple[dict[str, dict], Sources]:
    """Raw tables of the library by name, and the places of their keys."""
    tables: dict[str, dict] = {}
    sources = Sources()
    for file in sorted((problems_folder() / "materials").glob("*.toml")):
        text = file.read_text(encoding="utf-8")
        data = parse(text, str(file))
        twice = sorted(set(data) & set(tables))
        if twice:
            raise DeckError(f"{file}: material {twice[0]} is defined in another file as well")
        sources.add(str(file), data, text)
        tables.update({name: _sourced(table, "chosen") for name, table in data.items()})
    return tables, sources


def _sourced(table: dict, confidence: str, about: dict | None = None) -> dict:
    """The table with source and confidence added to every number, so that it can be merged with another."""
    about = {"source": "", "confidence": confidence, **(about or {}), **_about(table), "note": ""}
    result = {key: value for key, value in table.items() if key not in ("source", "confidence")}
    for part in TABLES:
        if isinstance(table.get(part), dict):
            own = {**about, **_about(table[part])}
            rest = {key: value for key, value in table[part].items() if key not in ABOUT}
            result[part] = {key: value if key in CHOICE else _with(value, own) for key, value in rest.items()}
    result |= {key: _with(table[key], about) for key in FRACTURE if key in table}
    if "variants" in table:
        result["variants"] = {key: _sourced(entry, confidence, about) for key, entry in table["variants"].items()}
    return result


def _about(table: dict) -> dict:
    return {key: table[key] for key in ("source", "confidence") if key in table}


def _with(number, about: dict) -> dict:
    return {**about, **number} if isinstance(number, dict) else {**about, "value": number}


def names() -> list[str]:
    """The materials of the library."""
    return sorted(_library()[0])


def _no_material(name: str, allowed: Iterable[str]) -> str:
    """The message for an unknown material: the materials of its family, if it is the name of one, else the nearest names."""
    begins = FAMILIES.get(name.lower())
    family = sorted(each for each in allowed
                    if (each.startswith(begins) if begins else each.lower().startswith(f"{name.lower()}_")))
    if family:
        return f'unknown material "{name}"; of this kind are {", ".join(family)}'
    return unknown("material", name, allowed)


def parted(text: str) -> tuple[str, list[str]]:
    """Name and variants of NAME:VARIANT, or of NAME:VARIANT:VARIANT; without a colon there are none."""
    name, *variants = text.split(":")
    return name, variants


def load(text: str, variant: str | None = None) -> Material:
    """A material of the library by NAME or NAME:VARIANT, which becomes its name. Raises DeckError if there is none."""
    tables, sources = _library()
    name, named = parted(text)

    def fail(path: tuple, message: str) -> DeckError:
        return DeckError(f"{sources.where((name, *path), tables)}: material {name}: {message}")

    if name not in tables:
        raise DeckError(_no_material(name, tables))
    return build(text, _varied(tables[name], named or variant, fail), fail, True)


def origin(material: Material) -> str:
    """Name of the library's material on which a material is based, by its title; else its own name, without variants."""
    return _names_by_title().get(material.title, parted(material.name)[0])


@functools.cache
def _names_by_title() -> dict[str, str]:
    return {str(table.get("title", "")): name for name, table in _library()[0].items()}


def problem(text: str, own: Mapping[str, object]) -> str | None:
    """Why a body cannot be of a material NAME or NAME:VARIANT of the library or of a deck's own tables; None if it can."""
    name, variants = parted(text)
    if text in own or name in own:
        return None  # a deck's own tables are checked separately
    if name not in names():
        return _no_material(name, {*own, *names()})
    known = _library()[0][name].get("variants", {})
    return next((f"{name}: {unknown('variant', variant, known)}" for variant in variants if variant not in known), None)


def from_deck(name: str, tables: Mapping[str, dict], fail: Fail, trust: bool = True) -> Material:
    """The material ``name`` of a deck, or NAME:VARIANT: one of its own tables, or one of the library.

    ``fail(path, message)`` makes the error for a key of [materials]; it is raised here. Without ``trust`` no code of the deck
    is run, unless this process has run it before.
    """
    base, variants = (name, []) if name in tables else parted(name)
    if base not in tables:
        return load(name)

    def fail_at(path: tuple, text: str) -> Exception:
        return fail((base, *path), text)

    return build(name, _varied(_based(base, tables, fail, ()), variants, fail_at), fail_at, trust)


def _based(name: str, tables: Mapping[str, dict], fail: Fail, chain: tuple[str, ...]) -> dict:
    """The raw table of a material of a deck, merged with the material on which it is based."""
    if not isinstance(tables[name], dict):
        raise fail((name,), "a material must be a table")
    variants = tables[name].get("variants", {})
    if not isinstance(variants, dict) or not all(isinstance(entry, dict) for entry in variants.values()):
        raise fail((name, "variants"), "must contain a table for each variant")
    own = _sourced(tables[name], "deck")
    base = own.get("based_on")
    if base is None:
        if "eos" not in own:
            hint = f'; to change a material of the library, write based_on = "{name}"' if name in names() else ""
            raise fail((name,), f"has no eos{hint}")
        raw = own
    elif not isinstance(base, str):
        raise fail((name, "based_on"), "must be the name of a material")
    elif base in tables and base != name:
        if base in chain:
            raise fail((name, "based_on"), f"are based on each other in a circle: {' -> '.join((*chain, name, base))}")
        raw = _overlaid(_based(base, tables, fail, (*chain, name)), own)
    elif parted(base)[0] in names():
        of_library, variants = parted(base)
        raw = _varied(_library()[0][of_library], variants, lambda path, text: fail((name, "based_on"), text))
        raw = _overlaid(raw, own)
    else:
        raise fail((name, "based_on"), _no_material(str(base), {*names(), *tables} - {name}))
    return _varied(raw, own.get("variant"), lambda path, text: fail((name, *path), text), own)


def _overlaid(base: dict, over: dict) -> dict:
    """``over`` on ``base``; a part that names another model replaces the whole part.

    Another equation of state removes the melting line, which depends on its density and its Grueneisen coefficient.
    """
    base = dict(base)
    for part in PARTS:
        old, new = base.get(part), over.get(part)
        tables = isinstance(old, dict) and isinstance(new, dict)
        if tables and any(new.get(key, old.get(key)) != old.get(key) for key in ("model", "code", "solid")
                          if key != "solid" or key in old):
            del base[part]
            if part == "eos":
                base.pop("melting", None)
    return merge(base, {key: value for key, value in over.items() if key not in ("based_on", "variant")})


def _varied(raw: dict, variant, fail: Fail, own: dict | None = None) -> dict:
    """The table with one or several of its variants applied, then the numbers of the deck itself."""
    chosen = [] if variant is None else [variant] if isinstance(variant, str) else variant
    known = raw.get("variants", {})
    if not isinstance(chosen, list):
        raise fail(("variant",), "must be the name of a variant or a list of names")
    for name in chosen:
        if str(name) not in known:
            raise fail(("variant",), unknown("variant", str(name), known))
        raw = _overlaid(raw, {key: value for key, value in known[name].items() if key != "title"})
    return _overlaid(raw, own) if own and chosen else raw


def describe(text: str) -> str:
    """The page of a material, NAME or NAME:VARIANT, for ``hydro2d info``: every number with unit, source and confidence."""
    material = load(text)
    lines = [f"{material.name}: {material.title}"] + ([material.note] if material.note else [])
    parts: list[tuple[str, Mapping[str, Number]]] = [
        (f"{part}: {getattr(material, part).title}", getattr(material, part).numbers) for part in PARTS
    ]
    if material.melting:
        parts.append(("melting line", material.melting))
    if fracture := {key: number for key in FRACTURE if (number := getattr(material, key)) is not None}:
        parts.append(("failure", fracture))
    for heading, numbers in parts:
        lines += ["", heading] + [_line(key, number) for key, number in numbers.items()]
    if material.variants:
        lines += ["", "variants"] + [f"  {key}: {title}" for key, title in material.variants.items()]
    used = {number.confidence for _, numbers in parts for number in numbers.values()}
    lines += ["", "confidence"] + [f"  {key}: {CONFIDENCE[key]}" for key in CONFIDENCE if key in used]
    return "\n".join(lines) + "\n"


def _line(key: str, number: Number) -> str:
    unit = "" if number.unit == "1" else number.unit
    about = "; ".join(part for part in (number.source, number.note) if part)
    return f"  {key:<24}{number.value:>12.6g} {unit:<10} {number.confidence:<9} {about}".rstrip()
