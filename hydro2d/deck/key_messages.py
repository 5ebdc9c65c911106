"""Keys of a deck: which exist, what those of older versions are called now, and the messages for wrong keys and values."""

from __future__ import annotations

from typing import Any

from hydro2d.base.errors import in_words, unknown
from hydro2d.base.keys import Section
from hydro2d.deck.sections import Deck
from hydro2d.deck.shapes import registry as shapes
from hydro2d.files import toml
from hydro2d.files.key_lines import entry_index, spelled
from hydro2d.sources.registry import KINDS

#: the key that selects the kind of a table that may be one of several, and the sections that its words stand for
TAGS = {"shape": shapes.KINDS, "kind": KINDS}
#: these words
_TAGGED = {word: section for sections in TAGS.values() for word, section in sections.items()}

#: keys of decks of older versions, and their present names
RENAMED = {"numerics.trace": "numerics.cutoff", "failure.loose": "failure.strength_cutoff"}
#: noses of decks of older versions, and their present names
RENAMED_NOSES = {"ogive": "ogival"}


def causes(errors: list[dict]) -> list[dict]:
    """Pydantic's errors, without "too few entries" for a list whose entries themselves are wrong."""
    places = [entry["loc"] for entry in errors]
    return [entry for entry in errors if entry["type"] != "too_short"
            or not any(place[: len(entry["loc"])] == entry["loc"] and place != entry["loc"] for place in places)]


def explained(entry: dict, data: dict) -> tuple[tuple, str]:
    """The deck key and hydro2d's message for one of pydantic's errors."""
    path, kind = _key_path(entry["loc"], data), entry["type"]
    if kind == "extra_forbidden":
        return path, _no_such_key(path, _allowed_keys(path[:-1], data))
    if kind == "union_tag_not_found":
        tag = _tag(entry)
        return (*path, tag), f"is missing (allowed: {', '.join(TAGS[tag])})"
    if kind == "union_tag_invalid":
        tag = _tag(entry)
        return (*path, tag), unknown(tag, str(entry["ctx"]["tag"]), TAGS[tag])
    return path, in_words(entry)


def _tag(entry: dict) -> str:
    """The key of TAGS that one of pydantic's errors is about."""
    return str(entry["ctx"]["discriminator"]).strip("'")


def _key_path(loc: tuple, data: Any) -> tuple:
    """Pydantic's location without the tags of unions, as a path in the deck."""
    path: tuple = ()
    for depth, part in enumerate(loc):
        last = depth == len(loc) - 1
        if isinstance(data, dict) and part not in data and not last and part in _TAGGED:
            continue
        path += (part,)
        if isinstance(data, dict):
            data = data.get(part)
        elif isinstance(data, (list, tuple)) and isinstance(part, int) and part < len(data):
            data = data[part]
        else:
            data = None
    return path


def renewed(data: dict) -> dict:
    """The tables of the deck of a run, which an older version may have written, with present keys; numbers are in SI."""
    data.setdefault("numbers", toml.SI)
    for old, new in RENAMED.items():
        (section, key), (place, name) = old.split("."), new.split(".")
        if isinstance(data.get(section), dict) and key in data[section]:
            data.setdefault(place, {})[name] = data[section].pop(key)
    bodies = data.get("body")
    for entry in bodies if isinstance(bodies, list) else ():
        if isinstance(entry, dict) and entry.get("nose") in RENAMED_NOSES:
            entry["nose"] = RENAMED_NOSES[entry["nose"]]
    return data


def _no_such_key(path: tuple, allowed: list[str]) -> str:
    """The message for an unknown key: its present name if it was renamed, else the keys that are allowed."""
    now = RENAMED.get(spelled(path))
    return f"is now called {now}" if now else unknown("key", str(path[-1]), allowed)


def _allowed_keys(path: tuple, data: dict) -> list[str]:
    """Keys of the table at ``path``."""
    model: Any = Deck
    for part in path:
        if isinstance(part, int):
            data = data[part]
            model = model or next((_TAGGED[data[tag]] for tag in TAGS if data.get(tag) in _TAGGED), None)
        else:
            data, model = (data or {}).get(part), section_of(model, part)
    keys = list(model.model_fields) if model else []
    return [*keys, "include"] if model is Deck else keys


def key_problem(data: dict, key: str) -> str | None:
    """The mistake in the key of an override for a deck of these merged tables; None if the deck has such a key."""
    path, place = (), data
    for part in toml.key_parts(key):
        if isinstance(place, list):
            index = entry_index(place, part)
            if index is None:
                names = [str(entry.get("name", n)) for n, entry in enumerate(place) if isinstance(entry, dict)]
                return f"{spelled(path)}: {unknown('entry', part, names)}"
            path, place = (*path, index), place[index]
            continue
        if path and place is not None and not isinstance(place, dict):
            return f"{spelled(path)} is a value and has no key {part}"
        allowed = _allowed_keys(path, data)
        if allowed and part not in allowed:
            problem = _no_such_key((*path, part), allowed)
            return f"{spelled(path)}: {problem}" if path else problem
        path, place = (*path, part), place.get(part) if isinstance(place, dict) else None
    return None


def no_such_key(decks: list[dict], key: str) -> str:
    """The message for a key of overrides that none of these decks has; empty if one of them has it, or there is no deck."""
    problems = [key_problem(data, key) for data in decks]
    return f"no deck has the key {key}: {problems[0]}" if problems and all(problems) else ""


def section_of(model: Any, key: str) -> Any:
    """The section under a key of a section; None for a table that may be one of several."""
    field = model.model_fields.get(key) if model else None
    return _first_section(field.annotation) if field else None


def _first_section(annotation: Any) -> Any:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return annotation
    inner = [_first_section(part) for part in getattr(annotation, "__args__", ())]
    sections = [section for section in inner if section is not None]
    return sections[0] if len(sections) == 1 else None
