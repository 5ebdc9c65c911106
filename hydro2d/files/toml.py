"""Deck text: merges includes, applies overrides of the command line, and writes TOML."""

from __future__ import annotations

import copy
import filecmp
import json
import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from datetime import date, time
from pathlib import Path
from typing import Any

import tomli_w

from hydro2d.base import units
from hydro2d.base.errors import DeckError
from hydro2d.base.formats import in_toml
from hydro2d.files import checksums
from hydro2d.files.key_lines import Sources, entry_index
from hydro2d.files.shipped import shipped_file
from hydro2d.files.whole import read_text

#: value of `numbers` in a deck whose numbers without a unit are in SI
SI = "SI"
#: parts of a material that a model describes
PARTS = ("eos", "strength", "damage")
#: limits of a deck: characters, values, depth of nested tables or lists, and files
MOST_TEXT, MOST_VALUES, DEEPEST, MOST_FILES = 4_000_000, 100_000, 30, 100
#: largest number of characters in the key of an override
LONGEST_KEY = 1000
_TOO_DEEP = f"tables or lists are nested more than {DEEPEST} deep"
_TOO_LONG = "an integer has more than 18 digits; give a number with a decimal point"
#: a key with too many parts, which tomllib would take long to read
_DOTTED = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){40}""")
#: what tomllib says where a quotation mark is missing
ABOUT_QUOTES = ("invalid value", "expected newline", "illegal character")
#: curly quotation marks, words of TOML that are no texts, and the longest value that a hint repeats
CURLY, TOML_WORDS, LONGEST_HINT = "\u201c\u201d\u201e\u2018\u2019", ("true", "false", "inf", "nan"), 80
#: a key, and the beginning of a text, or of a number with a unit, without quotation marks
_KEY, _BARE = re.compile(r"[\w.-]+"), re.compile(rf"\[?\s*(?:[^\W\d]|[{CURLY}]|[+-]?[\d.]+\s*[^\W\d])")


def is_study(data: dict) -> bool:
    """Whether parsed TOML has axes, a sample, a transition to search or parts, which only a study has."""
    return any(key in data for key in ("axis", "sample", "transition", "part"))


def parse(text: str, name: str) -> dict:
    """TOML as a dict. Raises DeckError with file and line if the text is not valid TOML, or exceeds the limits of a deck."""
    if len(text) > MOST_TEXT:
        raise DeckError(f"{name}: has {len(text)} characters; at most {MOST_TEXT} are allowed")
    if _DOTTED.search(text):
        raise DeckError(f"{name}: {_TOO_DEEP}")
    try:
        return within_limits(tomllib.loads(text), name)
    except RecursionError:
        raise DeckError(f"{name}: {_TOO_DEEP}") from None
    except tomllib.TOMLDecodeError as problem:
        message = str(problem)
        position = re.search(r"\(at line (\d+), column (\d+)\)", message)
        line = position.group(1) if position else str(text.count("\n") + 1)
        what = message.split(" (at ")[0].lower()
        hint = _hint(text.split("\n")[int(line) - 1]) if what.startswith(ABOUT_QUOTES) else ""
        raise DeckError(f"{name}:{line}: not valid TOML: {hint or what}") from None
    except ValueError:
        raise DeckError(f"{name}: {_TOO_LONG}") from None


def _hint(line: str) -> str:
    """What is wrong with the quotation marks of a line that is not valid; empty if that is not its mistake."""
    key, _, rest = line.partition("=")
    key, value = key.strip(), rest.partition("#")[0].strip()
    if value[:1] in ("\"", "'") and value.count(value[0]) == 1:
        return f"{key}: the text has no closing quotation mark"
    inner = value.strip(CURLY)
    if not _KEY.fullmatch(key) or not _BARE.match(value) or inner in TOML_WORDS:
        return ""
    if len(inner) > LONGEST_HINT or '"' in inner or (inner[0] == "[" and "," in inner):
        return ""
    opened = "[" * inner.startswith("[")
    return f'a text needs quotation marks: {key} = {opened}"{inner.strip("[] ")}"{"]" * bool(opened)}'


def within_limits(data, name: str):
    """The data, unchanged. Raises DeckError for more values, deeper tables or longer integers than a deck can have."""
    waiting, number = [(data, 0)], 0
    while waiting:
        value, depth = waiting.pop()
        number += 1
        if depth > DEEPEST:
            raise DeckError(f"{name}: {_TOO_DEEP}")
        if number + len(waiting) > MOST_VALUES:
            raise DeckError(f"{name}: has more than {MOST_VALUES} values, the most that a deck can hold")
        if isinstance(value, int) and abs(value) >= 1 << 63:
            raise DeckError(f"{name}: {_TOO_LONG}")
        if isinstance(value, Mapping):
            waiting += [(entry, depth + 1) for entry in value.values()]
        elif isinstance(value, (list, tuple)):
            waiting += [(entry, depth + 1) for entry in value]
    return data


def read(path: Path, sources: Sources, chain: tuple[Path, ...] = ()) -> dict:
    """A deck file merged with the files that it includes; its own values take precedence."""
    path = Path(path)
    if path.resolve() in chain:
        circle = " -> ".join(entry.name for entry in (*chain[chain.index(path.resolve()) :], path))
        raise DeckError(f"{chain[-1]}: include: the files include each other in a circle: {circle}")
    if sources.number > MOST_FILES:
        raise DeckError(f"{path}: include: the deck includes more than {MOST_FILES} files, counting repeated ones each time")
    text = read_text(path, DeckError)
    return assemble(text, str(path), path.parent, sources, (*chain, path.resolve()))


def assemble(text: str, name: str, folder: Path, sources: Sources, chain: tuple[Path, ...] = ()) -> dict:
    """Deck text merged with its includes, which are looked up in its folder and among the shipped decks."""
    data = parse(text, name)
    if checksums.begins_with_one(text):  # a resolved deck, of any version
        data.setdefault("numbers", SI)
    sources.add(name, data, text)
    return with_included(data, folder, sources, chain)


def with_included(data: dict, folder: Path, sources: Sources, chain: tuple[Path, ...] = ()) -> dict:
    """The tables of a deck merged with its includes, which are looked up in a folder and among the shipped decks.

    A shipped deck has the name that the command line takes, such as "problems/perforation/sphere.toml". Numbers
    of a file that does not say numbers = "SI" are marked as bare.
    """
    included = data.get("include", [])
    included = [included] if isinstance(included, str) else included
    if not isinstance(included, list) or not all(isinstance(entry, str) for entry in included):
        raise DeckError(f"{sources.where(('include',), data)}: include must be a file name or a list of file names")
    base: dict = {}
    for entry in included:
        beside, shipped = folder / entry, shipped_file(Path(entry))
        wrong = ""
        if not beside.is_file() and shipped is None:
            wrong = f"there is no file {beside}, and no shipped deck of this name"
        elif beside.is_file() and shipped is not None and not filecmp.cmp(beside, shipped, shallow=False):
            wrong = f"{beside} and the shipped deck {shipped} differ: give the full path of the one that you mean"
        if wrong:
            raise DeckError(f"{sources.where(('include',), data)}: include: {wrong}")
        base = merge(base, read(beside if beside.is_file() else shipped, sources, chain))
    own = {key: value for key, value in placed(data, folder).items() if key != "include"}
    return merge(base, own if own.get("numbers") == SI else units.bare(own))


def model_tables(data: dict) -> Iterator[tuple[tuple, dict]]:
    """The tables of models in the materials of a deck, with their paths. The deck may contain any error."""
    waiting = [(("materials", name), table) for name, table in _table(data.get("materials")).items()]
    while waiting:
        path, table = waiting.pop(0)
        yield from (((*path, part), _table(table)[part]) for part in PARTS if isinstance(_table(table).get(part), dict))
        waiting += [((*path, "variants", name), entry) for name, entry in _table(_table(table).get("variants")).items()]


def result_tables(data: dict) -> Iterator[tuple[tuple, dict]]:
    """The tables of the files of results in a deck, with their paths. The deck may contain any error."""
    yield from ((("result", name), table) for name, table in _table(data.get("result")).items() if isinstance(table, dict))


def _table(value) -> dict:
    return value if isinstance(value, dict) else {}


def placed(data: dict, folder: Path) -> dict:
    """A deck in which the files of its models (code and tables) and results, relative to a folder, have full paths."""
    data = copy.deepcopy(data)
    for _, table in (*model_tables(data), *result_tables(data)):
        for key in ("file", "table"):
            if isinstance(table.get(key), str):
                table[key] = os.path.abspath(folder / table[key])
    return data


def placed_value(key: str, value, folder: Path):
    """The value of an override, with full paths of model files, as `placed` gives them."""
    parts = key_parts(key)
    nested = value
    for part in reversed(parts):
        nested = {part: nested}
    nested = placed(nested, folder) if parts else nested
    for part in parts:
        nested = nested[part]
    return nested


def _is_named(entries) -> bool:
    return isinstance(entries, list) and bool(entries) and all(isinstance(e, dict) and "name" in e for e in entries)


def merge(base: dict, over: dict) -> dict:
    """``base`` updated by ``over``: tables merge by key, arrays of named tables by name, and everything else is replaced."""
    result = copy.deepcopy(base)
    for key, value in over.items():
        old = result.get(key)
        if isinstance(old, dict) and isinstance(value, dict):
            result[key] = merge(old, value)
        elif _is_named(old) and _is_named(value):
            result[key] = _merge_entries(old, value)
        else:
            result[key] = copy.deepcopy(value)
    return result


def _merge_entries(old: list[dict], new: list[dict]) -> list[dict]:
    result = list(old)
    for entry in new:
        index = entry_index(result, entry["name"]) if isinstance(entry["name"], str) else None
        if index is None:
            result.append(copy.deepcopy(entry))
        else:
            result[index] = merge(result[index], entry)
    return result


def key_parts(key: str) -> list[str]:
    """The parts of a dotted key: body.rod.velocity, mesh.r[0].cells or mesh.r.0.cells, materials."a b".title."""
    return [part.strip('"') for part in re.findall(r'"[^"]*"|[^.\[\]\s]+', key)]


def assigned(key: str, value) -> str:
    """The override that sets a key to a value, or removes it if the value is None."""
    return f"{key}=" if value is None else f"{key}={inline(value)}"


def assignment(text: str) -> tuple[str, Any]:
    """Key and value of ``key=value``. The value is read as TOML, or as a plain string if it is not valid TOML.

    The value of ``key=``, which removes a key, is None.
    """
    key, equals, value_text = text.partition("=")
    if len(text) > MOST_TEXT or len(key) > LONGEST_KEY or _DOTTED.search(value_text):
        raise DeckError(f"--set {text}: has more characters or parts than an override can")
    if not equals or not key_parts(key):
        raise DeckError(f"--set {text}: expected key=value, such as numerics.advection=momentum")
    if not value_text.strip():
        return key.strip(), None
    try:
        return key.strip(), within_limits(tomllib.loads(f"value = {value_text}")["value"], f"--set {text}")
    except tomllib.TOMLDecodeError:
        return key.strip(), value_text.strip()
    except RecursionError:
        raise DeckError(f"--set {text}: {_TOO_DEEP}") from None
    except ValueError:
        raise DeckError(f"--set {text}: {_TOO_LONG}") from None


def override(data: dict, key: str, value, said: str, sources: Sources) -> dict:
    """Overrides a value of the deck. Entries of arrays are addressed by name, as in ``body.rod.velocity``, or by number from 0.

    said : name of the override in messages, such as "--set body.rod.velocity=1200 m/s"
    """
    keys = key_parts(key)
    if not keys:
        raise DeckError(f"{said}: the key is empty")
    if len(keys) > DEEPEST:
        raise DeckError(f"{said}: {_TOO_DEEP}")
    result = copy.deepcopy(data)
    sources.add_override(_override_path(_put(result, keys, value, said), result), said)
    return result


def value_of(data: dict, key: str) -> Any:
    """The value under a key, which addresses entries of arrays as `override` does; None if there is none."""
    place: Any = data
    for part in key_parts(key):
        if isinstance(place, list):
            index = entry_index(place, part)
            place = None if index is None else place[index]
        else:
            place = place.get(part) if isinstance(place, dict) else None
    return place


def removed(data: dict, key: str, said: str) -> dict:
    """The deck without a key, which then takes its default; an equal deck if it has no such key."""
    *keys, last = key_parts(key)
    result = copy.deepcopy(data)
    place: Any = result
    for part in keys:
        place = place[_index(place, part, said)] if isinstance(place, list) else place.get(part)
        if not isinstance(place, (dict, list)):
            return result
    if isinstance(place, list):
        del place[_index(place, last, said)]
    else:
        place.pop(last, None)
    return result


def _put(data: dict, keys: list[str], value, said: str) -> list:
    """Sets a value. Returns its path, with indices instead of names of entries."""
    place, path = data, []
    for depth, key in enumerate(keys):
        last = depth == len(keys) - 1
        if isinstance(place, list):
            key = _index(place, key, said)
        elif not isinstance(place, dict):
            raise DeckError(f"{said}: {'.'.join(keys[:depth])} is a value and has no key {key}")
        elif not last and key not in place:
            place[key] = {}
        path.append(key)
        if last:
            place[key] = value
        else:
            place = place[key]
    return path


def _index(entries: list, key: str, said: str) -> int:
    index = entry_index(entries, key)
    if index is None:
        names = [str(entry.get("name", n)) for n, entry in enumerate(entries) if isinstance(entry, dict)]
        raise DeckError(f"{said}: there is no entry {key}; there are {', '.join(names) or len(entries)}")
    return index


def _override_path(keys: list, data) -> tuple:
    """The path as Sources keeps it: names for named entries, integers for the others."""
    path: tuple = ()
    for key in keys:
        data = data[key]
        name = data.get("name") if isinstance(key, int) and isinstance(data, dict) else None
        path += (name if isinstance(name, str) else key,)
    return path


def inline(value) -> str:
    """A value as TOML writes it on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (date, time)):
        return value.isoformat()
    if isinstance(value, dict):
        inside = ", ".join(f"{in_toml(key)} = {inline(entry)}" for key, entry in value.items() if entry is not None)
        return f"{{ {inside} }}"
    return f"[{', '.join(inline(entry) for entry in value)}]"


def dumps(data: dict) -> str:
    """TOML of plain data. None is left out, because TOML cannot express it. Floats keep every bit."""
    return tomli_w.dumps(_without_none(data), multiline_strings=True)


def _without_none(value):
    if isinstance(value, dict):
        return {key: _without_none(entry) for key, entry in value.items() if entry is not None}
    return [_without_none(entry) for entry in value] if isinstance(value, (list, tuple)) else value
