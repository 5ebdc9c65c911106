"""Spoiled texts and files, identical for the same seed; and the judge of a command's reaction to them."""

from __future__ import annotations

import contextlib
import io
import random
import re
import shutil
from pathlib import Path

from hydro2d.cli.main import call

#: TOML values that (almost) no key accepts
ABSURD = (
    "0", "-1", "1", "7.5", "1e30", "-1e30", "1e-300", "1e300", "nan", "inf", "-inf", "true", "false", '""', '"x"', '"1 m"',
    '"-3 km/s"', '"1e308 us"', '"1e-3 furlong"', '"../x"', '"a/b"', '"/"', '"\\u0000"', '"\\u202e"', '"é"', "[]", "{}",
    "[1, 2, 3]", "[[]]", "[{}]", "{ a = 1 }", '["x"]', '"' + 5000 * "x" + '"', "1979-05-27", "0x10", 30 * "9", "'''\n'''",
    '"none"', '"rod"', '"hydro2d"',
)
#: characters that have a meaning in TOML, or none anywhere
CHARACTERS = "[]{}=\"'#,.\\\n\t -_0e\x00\x07\x7f\ufeffé\u202e𝛼"
#: JSON values in place of those in a summary or a study's record
JSON = ("null", "true", "-1", "1e300", '""', '"x"', "[]", "{}", "[1]", '{"a": 1}', '"NaN"', '"=cmd|calc"')


def text(original: str, chance: random.Random) -> str:
    """A deck or study with one to three faults."""
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        original = chance.choice(EDITS)(original, chance)
    return original


def _value(original: str, chance: random.Random) -> str:
    """Another value for a key, of a line or within an inline table."""
    places = list(re.finditer(r"(?<==)\s*(\"[^\"\n]*\"|[^\s,{}\[\]]+)", original))
    if not places:
        return original
    place = chance.choice(places)
    return f"{original[: place.start(1)]}{chance.choice(ABSURD)}{original[place.end(1) :]}"


def _key(original: str, chance: random.Random) -> str:
    """A key with a letter missing, a letter too many, or from another table."""
    keys = list(re.finditer(r"[A-Za-z_][A-Za-z0-9_]*(?=\s*=)", original))
    if not keys:
        return original
    key, at = chance.choice(keys), chance.randrange(4)
    word = key.group()
    others = (word[1:], word + "s", chance.choice(keys).group(), f"{word}.{chance.choice(keys).group()}")
    return original[: key.start()] + others[at] + original[key.end() :]


def _line(original: str, chance: random.Random) -> str:
    """A line removed, repeated, or moved."""
    lines = original.split("\n")
    line = lines.pop(chance.randrange(len(lines)))
    for _ in range(chance.choice((0, 1, 2))):
        lines.insert(chance.randrange(len(lines) + 1), line)
    return "\n".join(lines)


def _header(original: str, chance: random.Random) -> str:
    """Another kind of table, or another name."""
    headers = list(re.finditer(r"^\[+([^\[\]\n]+)\]+", original, re.M))
    if not headers:
        return original
    header, name = chance.choice(headers), chance.choice(headers).group(1)
    new = chance.choice((f"[{name}]", f"[[{name}]]", f"[{name}.{name}]", "[x]", f"[[{header.group(1)}.x]]", "[]"))
    return original[: header.start()] + new + original[header.end() :]


def _character(original: str, chance: random.Random) -> str:
    """A character missing, or one too many."""
    at = chance.randrange(len(original) + 1)
    return original[:at] + chance.choice(CHARACTERS) + original[at + chance.choice((0, 1)) :]


def _cut(original: str, chance: random.Random) -> str:
    """Only the beginning, or only the end."""
    at = chance.randrange(len(original) + 1)
    return chance.choice((original[:at], original[at:]))


def _size(original: str, chance: random.Random) -> str:
    """A number that is too large, too small or of the other sign."""
    places = list(re.finditer(r"(?<![A-Za-z_0-9.])-?[0-9][0-9_]*(\.[0-9]+)?(e-?[0-9]+)?", original))
    if not places:
        return original
    place, factor = chance.choice(places), chance.choice((-1.0, 0.0, 0.1, 0.5, 0.999999, 1.000001, 2.0, 10.0, 1e3, 1e6, 1e-6))
    return f"{original[: place.start()]}{float(place.group().replace('_', '')) * factor:.12g}{original[place.end() :]}"


EDITS = (_value, _value, _value, _value, _size, _size, _size, _size, _key, _key, _line, _header, _character, _cut)


def file(path: Path, chance: random.Random, others: list[Path]) -> str:
    """Spoils a file in place; returns how."""
    how = chance.choice(("gone", "empty", "cut", "flipped", "another", "folder", "nonsense", "value", "value"))
    data = path.read_bytes()
    if how == "value" and path.suffix in (".json", ".toml", ".pvd", ".txt"):
        path.write_text(_value_of_json(data.decode(errors="replace"), chance), encoding="utf-8")
        return how
    path.unlink()
    if how == "empty":
        path.write_bytes(b"")
    elif how == "cut":
        path.write_bytes(data[: chance.randrange(len(data) + 1)])
    elif how in ("flipped", "value"):
        spoiled = bytearray(data)
        for _ in range(chance.choice((1, 10, 1000)) if spoiled else 0):
            spoiled[chance.randrange(len(spoiled))] = chance.randrange(256)
        path.write_bytes(bytes(spoiled))
    elif how == "another":
        shutil.copyfile(chance.choice([other for other in others if other.is_file()] or [Path(__file__)]), path)
    elif how == "folder":
        path.mkdir()
    elif how == "nonsense":
        path.write_bytes(chance.randbytes(chance.choice((1, 64, 5000))))
    return how


def _value_of_json(original: str, chance: random.Random) -> str:
    places = list(re.finditer(r'(?<=[:=])\s*("[^"\n]*"|[^\s,{}\[\]]+)', original))
    if not places:
        return ""
    place = chance.choice(places)
    return original[: place.start(1)] + chance.choice(JSON) + original[place.end(1) :]


def judge(arguments: list[str], allowed: tuple[int, ...] = (0, 2, 4)) -> tuple[int, str]:
    """Runs a command in this process and returns its status and its output on stderr.

    AssertionError for a status that is not documented, or no message with one that is not 0. Any other exception is a fault of
    hydro2d and propagates.
    """
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = call(arguments)
    said = err.getvalue()
    assert status in allowed, (status, said)
    assert "Traceback" not in said
    assert status == 0 or said.strip() or out.getvalue().strip(), f"status {status} without a word"
    return status, said
