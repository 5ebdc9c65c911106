"""`hydro2d info`: explains a material, a model, a field, a deck key or a word that people use."""

from __future__ import annotations

import difflib

from hydro2d.base.errors import DeckError, nearest
from hydro2d.cli import words
from hydro2d.materials import quantities

#: largest number of suggestions for an unknown name, and of its characters that are compared
MOST_NEAR, LONGEST_NAME = 6, 200


def deck_keys() -> dict[str, dict]:
    """Every deck key by its dotted name, with its JSON schema; keys of bodies are body.SHAPE.KEY."""
    from hydro2d.deck import deck as decks

    schema = decks.schema()
    definitions, keys = schema["$defs"], {}

    def target(entry: dict) -> list[dict]:
        """The tables that a value can be."""
        if "$ref" in entry:
            return [definitions[entry["$ref"].rsplit("/", 1)[-1]]]
        parts = [*entry.get("anyOf", []), *entry.get("oneOf", [])]
        if isinstance(entry.get("items"), dict):
            parts.append(entry["items"])
        if isinstance(entry.get("additionalProperties"), dict):
            parts.append(entry["additionalProperties"])
        return [table for part in parts for table in target(part)]

    def walk(prefix: str, table: dict) -> None:
        for key, entry in table.get("properties", {}).items():
            name = f"{prefix}{key}"
            inner = target(entry)
            keys[name] = {"description": inner[0].get("description", ""), **entry} if len(inner) == 1 else entry
            for each in inner:
                shape = each.get("properties", {}).get("shape", {}).get("const")
                if shape is not None:
                    keys[f"{name}.{shape}"] = each
                named = isinstance(entry.get("additionalProperties"), dict)
                walk(f"{name}.{shape}." if shape else f"{name}.NAME." if named else f"{name}.", each)

    walk("", schema)
    return keys


def _type(entry: dict) -> str:
    """The allowed values, in words."""
    if "x-unit" in entry:
        unit = entry["x-unit"]
        return "number" if unit == "1" else f'number in {unit}, or a string with a unit such as "1 {unit}"'
    if "enum" in entry:
        return "one of " + ", ".join(map(str, entry["enum"]))
    if "const" in entry:
        return repr(entry["const"])
    if "anyOf" in entry:
        return " or ".join(dict.fromkeys(_type(part) for part in entry["anyOf"] if part.get("type") != "null"))
    kind = entry.get("type", "object")
    return {"array": "list", "object": "table", "boolean": "true or false"}.get(kind, kind)


def _key_page(name: str, entry: dict, others: list[str]) -> str:
    lines = [f"{name} (deck key): {entry.get('description', '')}".rstrip(": "), f"  takes    {_type(entry)}"]
    if others:
        lines.append(f"  also in  {', '.join(others)}")
    if entry.get("default") is not None:
        lines.append(f"  default  {entry['default']}")
    inner = [key for key in deck_keys() if key.startswith(f"{name}.") and key.count(".") == name.count(".") + 1]
    if inner:
        lines += ["", *_table([(key.rsplit(".", 1)[-1], deck_keys()[key].get("description", "")) for key in inner])]
    return "\n".join(lines)


def _field_page(quantity: quantities.Quantity) -> str:
    return f'{quantity.key} (field): {quantity.meaning}\n  in files as "{quantity.name("NAME")}"'


def _table(rows: list[tuple[str, str]]) -> list[str]:
    width = max(len(name) for name, _ in rows)
    return [f"  {name:<{width}}  {meaning.splitlines()[0] if meaning else ''}".rstrip() for name, meaning in rows]


def page(name: str) -> str:
    """The pages of everything with this name or common name; if there is nothing, of the one name that differs in capitals.

    Raises DeckError with the nearest names if there is none either.
    """
    from hydro2d.analytic import catalogue, model_text
    from hydro2d.base.parameters import described
    from hydro2d.materials import library, outside
    from strength import melting

    packaged = [each for part in outside.KINDS if (each := outside.from_package(part, name))]
    pages = [said] if (said := words.page(name)) else []
    pages += [str(described(each.module, each.kind.title)) for each in packaged]
    if library.parted(name)[0] in library.names():
        pages.append(library.describe(name))
    pages += [str(described(kind.models[name], kind.title)) for kind in outside.KINDS.values() if name in kind.models]
    if name == melting.NAME:
        pages.append(str(described(melting, "melting line of a material")))
    if name in catalogue.MODELS:
        pages.append(model_text.page(catalogue.MODELS[name]))
    if name in quantities.BY_KEY:
        pages.append(_field_page(quantities.BY_KEY[name]))
    keys = deck_keys()
    groups = {name: []} if name in keys else _same_last(keys, name)
    pages += [_key_page(key, keys[key], others) for key, others in groups.items()]
    if not pages:
        others = {other for part in outside.KINDS for other in outside.in_packages(part)}
        models = {model for kind in outside.KINDS.values() for model in kind.models}
        known = {*others, *library.names(), *models, *catalogue.MODELS, *quantities.BY_KEY, *keys,
                 *(key.rsplit(".", 1)[-1] for key in keys)}
        alike = [each for each in known if each != name and each.lower() == name.lower()]
        if len(alike) == 1:
            return page(alike[0])
        raise DeckError(_unknown(name, {*known, *words.WORDS, *words.ALSO}))
    return "\n\n".join(text.rstrip() for text in pages)


def _unknown(name: str, known: set[str]) -> str:
    """The message for an unknown name: the one that is probably meant, and others near it."""
    lower = {each.lower(): each for each in sorted(known)}
    near = [lower[each] for each in difflib.get_close_matches(name.lower()[:LONGEST_NAME], lower, n=MOST_NEAR)]
    likely = [f'"{each}"' for each in dict.fromkeys([*filter(None, [nearest(name, known)]), *near])]
    *most, last = likely or [""]
    either = f"{', '.join(most)} or {last}" if most else last
    hint = f"did you mean {either}? " if likely else ""
    return f'unknown name "{name}"; {hint}`hydro2d info` lists all names'


def _same_last(keys: dict[str, dict], name: str) -> dict[str, list[str]]:
    """Keys that end in a name, each with the other keys of the same section and meaning."""
    groups: dict[tuple, list[str]] = {}
    for key in keys:
        if key.rsplit(".", 1)[-1] == name:
            groups.setdefault((key.split(".")[0], keys[key].get("description")), []).append(key)
    return {first: others for first, *others in groups.values()}


def overview() -> str:
    """All names, by kind."""
    from hydro2d.analytic import catalogue
    from hydro2d.materials import library, outside

    models = [(name, kind.title) for kind in outside.KINDS.values() for name in kind.models]
    models += [(name, f"{kind.title} from the package {entry.dist.name}")
               for part, kind in outside.KINDS.items() for name, entry in outside.in_packages(part).items()]
    keys = deck_keys()
    parts = (
        ("materials", [(name, library.load(name).title) for name in library.names()]),
        ("models", models),
        ("penetration models", [(model.name, model.title) for model in catalogue.MODELS.values()]),
        ("fields", [(entry.key, entry.meaning) for entry in quantities.TABLE]),
        ("sections of a deck", [(key, keys[key].get("description", "")) for key in keys if "." not in key]),
        ("words with another name here", [(word, entry.said) for word, entry in words.WORDS.items()]),
    )
    lines = []
    for heading, rows in parts:
        lines += [heading, *_table(rows), ""]
    return "\n".join([*lines, "`hydro2d info NAME` explains each of these names, and every deck key."])
