"""Decks, settings and studies with far too much in them: one message, or an answer within seconds."""

import math
import time

import pytest

import hydro2d
from hydro2d.base.errors import DeckError
from tests.cli.test_main import DECK
from tests.trials import spoil
from tests.trials.test_texts import SEARCH, STUDY

SECONDS = 10.0  # 5 on an idle machine
LONG = "1" + 4400 * "0"
UNITS = ("1 ((m))**9**9**9**9/s", "1 m*9**9**9", "1 m/9**9**9**9", "1 (9**9**9)*m", "9**9**9 m", "1e400 m", "1 m**1000000",
         "0 m**-1 * 9**99999999", "1 m*10**100000000", "1 ((((9*m)**9*m)**9*m)**9*m)**9", "1 " + 100_000 * "m",
         "1 " + 5000 * "(" + "m" + 5000 * ")", 10_000 * "1" + " m", "1 " + 3000 * "-" + "m",
         "1" + 100_000 * " " + "m")


def tip(value):
    return DECK.replace("tip = 0.0", f"tip = {value}")


def boxes(number, table='name = "b{0}"\nmaterial = "Al5083"\nshape = "box"\nr = [0.0, "1 mm"]\nz = ["{0} um", "{1} um"]'):
    return DECK + "".join(f"\n[[body]]\n{table.format(n, n + 1)}" for n in range(number))


SEGMENTS = ", ".join(f"{{to = {1e-8 * n}, cells = 1}}" for n in range(1, 99_999))
GAUGES = "".join(f'\n[[gauge]]\nname = "g{n}"\nr = 0.0\nz = 0.0\nz_end = "1 mm"\npoints = 10000' for n in range(500))
AXES = "".join(f'\n[[axis]]\nname = "a{n}"\nkey = "numerics.courant"\nvalues = {list(range(90))}' for n in range(9))


def polygon(number, turns=1):
    angles = [2 * math.pi * turns * n / number for n in range(number)]
    points = ", ".join(f"[{2e-3 + 1e-3 * math.cos(a)!r}, {-1e-2 + 1e-3 * math.sin(a)!r}]" for a in angles)
    return f'numbers = "SI"\n{DECK}\n[[body]]\nname = "round"\nmaterial = "Al5083"\nshape = "polygon"\npoints = [{points}]\n'


BOMBS = {
    "integer": tip(LONG), "hexadecimal": tip("0x" + 5000 * "f"), "cells": DECK.replace("cells = 12", f"cells = {LONG}"),
    **{f"nested {n}": f"{DECK}\n[x]\ny = {n * '{a = '}1{n * '}'}\n" for n in (40, 1000, 50_000)},
    **{f"list {n}": f"{DECK}\n[x]\ny = {n * '['}1{n * ']'}\n" for n in (40, 1000, 50_000)},
    **{f"dotted {n}": f"{DECK}\n[materials.{'.'.join(n * ['a'])}]\nx = 1\n" for n in (35, 1000, 50_000)},
    **{f"quoted {n}": f"{DECK}\n[q]\n{'.'.join(n * [chr(34) + 'a b' + chr(34)])} = 1\n" for n in (35, 50_000)},
    "text": f'title = "{10_000_000 * "x"}"\n{DECK}', "length": tip(f'"{1_000_000 * "1"} m"'),
    "name": DECK.replace('"plate"', f'"{1_000_000 * "p"}"', 1), "material": DECK.replace("W_alloy", 400_000 * "W_alloy"),
    "key": f"{DECK}\n[x]\n{1_000_000 * 'k'} = 1\n",
    "numbers": tip(f"[{','.join(1_000_000 * ['1'])}]"), "fields": f"{DECK}\n[output]\nfields = [{','.join(90_000 * ['0'])}]",
    "segments": DECK.replace('{to = "12 mm", cells = 12}', SEGMENTS), "gauges": DECK + GAUGES,
    "bodies": boxes(2000), "tables": boxes(100_000, ""), "mistakes": boxes(3000, 'name = "x"\nmaterial = "no"\nshape = "bux"'),
    "corners": polygon(30_000), "crossings": polygon(4999, turns=2499),
    **{unit[:40]: tip(f'"{unit}"') for unit in UNITS},
    **{f"{key} {value}": DECK.replace(f"{key} = ", f"{key} = {value} #", 1) for value in ("1e999", "-1e999", "nan", "inf")
       for key in ("tip", "radius", "length", "velocity", "z_front", "thickness", "time", "penetration", "z_start")},
}
SETTINGS = (f"stop.time={LONG}", f"x={5000 * '['}1{5000 * ']'}", f"{'.'.join(5000 * ['a'])}=1", f"{100_000 * 'k'}=1",
            *(f"body.rod.tip={unit}" for unit in UNITS))


def refused(arguments):
    """The message of a command that must soon refuse its input."""
    began = time.monotonic()
    status, said = spoil.judge(arguments, (2,))
    assert time.monotonic() - began < SECONDS
    assert status == 2
    assert len(said) < 60_000
    assert said.count("\n") <= 52
    return said


@pytest.mark.thorough
@pytest.mark.parametrize("name", BOMBS)
def test_decks(name, tmp_path):
    (tmp_path / "deck.toml").write_text(BOMBS[name])
    refused(["check", str(tmp_path / "deck.toml")])
    with pytest.raises(DeckError):
        hydro2d.Deck.from_toml(BOMBS[name])


@pytest.mark.parametrize("setting", SETTINGS, ids=lambda setting: setting[:40])
def test_settings(setting, tmp_path):
    (tmp_path / "deck.toml").write_text(DECK)
    refused(["check", str(tmp_path / "deck.toml"), "--set", setting])


@pytest.mark.parametrize("number", [100, 5000])
def test_a_polygon_of_thousands_of_corners_is_a_body(number, tmp_path):
    (tmp_path / "deck.toml").write_text(polygon(number))
    began = time.monotonic()
    assert spoil.judge(["check", str(tmp_path / "deck.toml")])[0] == 0
    assert time.monotonic() - began < 3 * SECONDS


def chains(folder):
    """Includes: a chain of 400, each file naming the next twice, and one file very often."""
    for n in range(400):
        (folder / f"chain{n}.toml").write_text(f'include = "chain{n + 1}.toml"\n')
        (folder / f"twice{n}.toml").write_text(f'include = ["twice{n + 1}.toml", "twice{n + 1}.toml"]\n')
    for name in ("chain400", "twice25", "once"):
        (folder / f"{name}.toml").write_text('title = "x"\n')
    often = ", ".join(20_000 * ['"once.toml"'])
    return ('include = "chain0.toml"\n', 'include = ["twice0.toml"]\n', f"include = [{often}]\n")


@pytest.mark.parametrize("number", range(3))
def test_includes(number, tmp_path):
    (tmp_path / "shot.toml").write_text(chains(tmp_path)[number] + DECK)
    assert "includes more than 100 files" in refused(["check", str(tmp_path / "shot.toml")])
    (tmp_path / "study.toml").write_text(STUDY)
    assert "includes more than 100 files" in refused(["sweep", str(tmp_path / "study.toml"), "--check"])


STUDIES = {
    "cases": STUDY.replace("count = 3", "count = 1000000000"),
    "product": STUDY + AXES,
    "integer": STUDY.replace("count = 3", f"count = {LONG}"), "value": STUDY.replace('"5 us"', LONG),
    "nested": STUDY.replace('"5 us"', 5000 * "[" + 5000 * "]"), "unit": STUDY.replace("5 us", UNITS[0]),
    "speeds": SEARCH.replace("100 m/s", "1e-300 m/s"), "tolerance": SEARCH.replace("100 m/s", UNITS[1]),
    "dotted": STUDY + f"\n[set.{'.'.join(5000 * ['a'])}]\nx = 1\n",
}


@pytest.mark.parametrize("name", STUDIES)
def test_studies(name, tmp_path):
    (tmp_path / "shot.toml").write_text(DECK)
    (tmp_path / "study.toml").write_text(STUDIES[name])
    refused(["transition" if "[transition]" in STUDIES[name] else "sweep", str(tmp_path / "study.toml"), "--check"])


def test_tables_of_a_program():
    deep = inner = {}
    for _ in range(5000):
        inner["a"] = inner = {}
    ring = {}
    ring["a"] = ring
    for wrong in (deep, ring, {"x": 10**5000}, {"x": [1] * 1_000_000}):
        with pytest.raises(DeckError):
            hydro2d.Deck.from_dict(wrong)
        with pytest.raises(DeckError):
            hydro2d.Deck.from_toml(DECK, {"title": wrong})
