"""The page of deck keys, from the JSON schema: type, unit, default, an example and meaning of every key."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator

from _pages.markdown import NOTE, prose, table

#: examples of the keys of [materials.NAME] that are no numbers; those of numbers are the library's own
MATERIAL = {
    "based_on": "W_alloy", "variant": "strain-failure", "title": "tungsten alloy of my tests", "fracture_pressure": "1.5 GPa",
    "fracture_stress": "1.2 GPa",
    "note": "yield stress of our own tests", "source": "J. Doe, private communication", "confidence": "found",
    "variants": {"soft": {"strength": {"yield_stress": "1.0 GPa"}}}, "eos": {"grueneisen": 1.8},
    "strength": {"yield_stress": "1.3 GPa"}, "damage": {"model": "none"}, "melting": {"melt_temperature": "2300 K"},
}


#: titles of the tables of a material that have numbers
TABLES = ("Eos", "Strength", "Damage", "Melting")


class Schema:
    """Walks the JSON schema of a deck."""

    def __init__(self, schema: dict):
        self.schema = schema

    def resolved(self, part: dict) -> dict:
        """The definition that a reference points to, or the part itself."""
        if "$ref" in part:
            return self.schema["$defs"][part["$ref"].rsplit("/", 1)[-1]]
        if len(part.get("allOf", ())) == 1:
            return self.resolved(part["allOf"][0])
        choices = [choice for choice in part.get("anyOf", ()) if choice.get("type") != "null"]
        if len(choices) == 1 and "anyOf" in part:
            return {**self.resolved(choices[0]), **{k: v for k, v in part.items() if k != "anyOf"}}
        return part

    def shown(self, part: dict) -> str:
        """The values that are allowed, in words."""
        part = self.resolved(part)
        if "const" in part or "enum" in part:
            return ", ".join(f"`{json.dumps(value)}`" for value in part.get("enum", [part.get("const")]))
        unit = part.get("x-unit")
        if part.get("type") == "array" and not unit:
            return f"list of {self.shown(part.get('items', {}))}"
        if unit:
            pair = part.get("type") == "array" or any(choice.get("type") == "array" for choice in part.get("anyOf", ()))
            alone = any(choice.get("type") == "number" for choice in part.get("anyOf", ()))
            kind = "number" if unit == "1" else "quantity"
            return " or ".join([kind] * (alone or not pair) + [f"[{kind}, {kind}]"] * pair)
        choices = [self.shown(choice) for choice in part.get("anyOf", part.get("oneOf", ())) if choice.get("type") != "null"]
        words = {"integer": "whole number", "object": "table", "boolean": "`true`, `false`", "string": "text"}
        return " or ".join(dict.fromkeys(choices)) or words.get(part.get("type", ""), part.get("type", "any"))

    def unit(self, part: dict) -> str:
        """The SI unit of a quantity, or of each entry of a list; nothing for all else."""
        part = self.resolved(part)
        unit = part.get("x-unit", self.unit(part["items"]) if isinstance(part.get("items"), dict) else "")
        return "" if unit == "1" else unit

    def is_list(self, part: dict) -> bool:
        """Whether the value is an array, written as [[key]] where it holds tables."""
        return self.resolved(part).get("type") == "array"

    def tables(self, part: dict) -> Iterator[dict]:
        """The tables that a value, or an entry of a list, may be; none for plain values."""
        part = self.resolved(part)
        if part.get("type") == "array":
            part = self.resolved(part.get("items", {}))
        if isinstance(part.get("additionalProperties"), dict):
            part = self.resolved(part["additionalProperties"])
        for choice in part.get("oneOf", [part]):
            choice = self.resolved(choice)
            if "properties" in choice:
                yield choice

    def example(self, section: dict, key: str, part: dict):
        """A value that the key may have: declared beside it, of the material library, or another word than the default."""
        entry, title = self.resolved(part), section["title"]
        if title in TABLES and (value := library_values(title.lower()).get(key)) is not None:
            return value
        if title in ("Material", *TABLES) and key in MATERIAL:
            return MATERIAL[key]
        if declared := part.get("examples", entry.get("examples")):
            return declared[0]
        words = entry.get("enum", [entry["const"]] if "const" in entry else [])
        words = [True, False] if entry.get("type") == "boolean" else words
        other = [word for word in words if word != part.get("default")]
        return (other or words or [None])[0]

    def section(self, heading: str, section: dict) -> str:
        """A heading, what the table is for, and its keys."""
        rows = table(("key", "type", "unit", "default", "example", "meaning"), self.rows(section))
        return "\n\n".join(part for part in (f"## {heading}", prose(section.get("description", "")), rows) if part)

    def rows(self, section: dict) -> Iterator[tuple[str, ...]]:
        """Key, type, unit, default, example and meaning of every key of a table."""
        for key, part in section.get("properties", {}).items():
            example = self.example(section, key, part)
            yield (
                f"`{key}`", self.shown(part), self.unit(part),
                "required" if key in section.get("required", ()) else _default(part.get("default")),
                "" if example is None else f"`{assignment(key, example)}`", prose(part.get("description", "")),
            )


def assignment(key: str, value) -> str:
    """A line of a deck."""
    from hydro2d.files import toml

    return f"{key} = {toml.inline(value)}"


def _default(value) -> str:
    return "" if value is None else f"`{json.dumps(value)}`"


@functools.cache
def library_values(part: str) -> dict[str, float | str]:
    """A number for every parameter of a table: of the first material of the library that has it, its example or its default."""
    import eos
    import strength
    from hydro2d.materials import library
    from strength import melting

    models = {"eos": eos.MODELS, "strength": strength.STRENGTH_MODELS, "damage": strength.DAMAGE_MODELS,
              "melting": {melting.NAME: melting}}[part]
    found = {entry.name: entry.default if entry.example is None else entry.example
             for model in models.values() for entry in model.PARAMETERS if not entry.required}
    for name in reversed(library.names()):
        for variant in (*library.load(name).variants, None):
            material = library.load(name, variant)
            numbers = material.melting if part == "melting" else getattr(material, part).numbers
            found |= {key: _readable(number) for key, number in numbers.items() if number.confidence != "default"}
    return found


def _readable(number) -> float | str:
    """A number as a person would write it in a deck."""
    return f"{number.value / 1e9:g} GPa" if number.unit == "Pa" else number.value


def page() -> str:
    """Every key of a deck."""
    from hydro2d.deck import deck

    schema = Schema(deck.schema())
    sections, nested = [], {}
    for key, part in schema.schema["properties"].items():
        for section in schema.tables(part):
            name = f"[[{key}]]" if schema.is_list(part) else f"[{key}.NAME]" if "additionalProperties" in part else f"[{key}]"
            shape = section["properties"].get("shape", {}).get("const")
            sections.append(schema.section(f"`{name}`" + (f' with `shape = "{shape}"`' if shape else ""), section))
            for inner_key, inner_part in section["properties"].items():
                for inner in schema.tables(inner_part):
                    nested.setdefault(inner["title"], (inner, {}))[1][f"`{key}.{inner_key}`"] = None
    for title, (section, places) in nested.items():
        sections.append(schema.section(f"{title}: a table of {' and '.join(places)}", section))
    plain = {key: part for key, part in schema.schema["properties"].items() if not list(schema.tables(part))}
    top = {"properties": plain, "required": schema.schema["required"], "title": "Deck"}
    lead = (
        f"{NOTE} `hydro2d info KEY` prints the same of one key. A quantity is a number in the unit of its row or a string with "
        'a unit, such as `"8.12 mm"`. A key without a default may be left out unless it is required. Each example is a valid '
        "line, not a recommendation."
    )
    return "\n\n".join([f"# Deck keys\n\n{lead}", schema.section("Top level", top), *sections, boundary_conditions()])


def boundary_conditions() -> str:
    """The table of boundary conditions."""
    from hydro2d.mesh.edges.base import EDGES
    from hydro2d.mesh.edges.registry import KINDS

    rows = (
        (f"`{b.name}`", "every edge" if b.edges == EDGES else ", ".join(f"`{edge}`" for edge in b.edges),
         b.ghost(), "given" if b.constrains() else "free", ", ".join(f"`EDGE_{key.name}`" for key in b.keys) or "none",
         f"`{b.sink}`", prose(b.meaning))
        for b in KINDS
    )
    heads = ("condition", "where", "cells beyond", "normal velocity", "keys of its own", "sink", "meaning")
    return "## Boundary conditions\n\n" + table(heads, rows)
