"""Shipped decks with changes that somebody might make: valid TOML with other values, other bodies, another method.

A mutant follows from a number: the number determines the deck, one to four changes, and every value. Decks of many cells are
first cut down to the surroundings of the impact, and their mesh is coarsened. ``python -m tests.trials.mutants NUMBER`` prints
the deck.
"""

from __future__ import annotations

import copy
import math
import random
import sys
from functools import cache

import numpy as np

from hydro2d.deck import deck as decks
from hydro2d.files import toml
from hydro2d.files.key_lines import Sources
from hydro2d.files.shipped import problems_folder
from tests.trials import changes

#: cells of a deck before it is changed, and cycles that it runs for
CELLS, CYCLES = 5000, 100
#: lengths kept of the rod's shank, behind its tail and ahead of its nose, in radii of the rod
SHANK, BEHIND, AHEAD = 4.0, 2.0, 8.0


@cache
def shipped() -> tuple[str, ...]:
    """The decks that hydro2d ships, without studies and materials, as paths within its problems."""
    folder = problems_folder()
    tables = {file: toml.read(file, Sources()) for file in sorted(folder.glob("*/*.toml"))}
    return tuple(str(file.relative_to(folder)) for file, data in tables.items() if "mesh" in data and not toml.is_study(data))


@cache
def _base(name: str) -> dict:
    """The tables of a shipped deck, on a mesh of about CELLS cells at most."""
    deck = decks.load(name)
    tables = {key: value for key, value in copy.deepcopy(deck._tables).items() if key not in ("experiment", "output", "name")}
    tables["stop"]["cycles"] = CYCLES
    r, z = decks.edges(deck)
    if "cells_across" in tables["mesh"]:  # the segments that these keys define, so that they can be changed
        made = "across", "cells_across", "reach", "fine"
        tables["mesh"] = {key: value for key, value in tables["mesh"].items() if key not in made}
        tables["mesh"] |= {"r_start": float(r[0]), "z_start": float(z[0]), "r": _segments(r), "z": _segments(z)}
    if (len(r) - 1) * (len(z) - 1) > CELLS:
        z = _cut(deck, tables, z)
        coarser = max(math.sqrt((len(r) - 1) * (len(z) - 1) / CELLS), 1.0)
        r, z = _coarsened(r, coarser), _coarsened(z, coarser)
        tables["mesh"] |= {"z_start": float(z[0]), "r": _segments(r), "z": _segments(z)}
    return tables


def _cut(deck, tables: dict, z: np.ndarray) -> np.ndarray:
    """Shortens the rod of a deck, and removes things far from it on the mesh; returns the remaining edges."""
    rods = [number for number, body in enumerate(deck.body) if body.shape == "rod"]
    if not rods or sum(body.velocity[1] != 0.0 for body in deck.body) > 1:  # bodies that fly with a rod would be cut off
        return z
    rod = deck.body[rods[0]]
    length = min(rod.length, rod.shaped_nose.length + SHANK * rod.rod_radius)
    tables["body"][rods[0]]["length"] = length
    ends = (rod.tip - rod.direction * (length + BEHIND * rod.rod_radius), rod.tip + rod.direction * AHEAD * rod.rod_radius)
    kept = z[(z >= min(ends)) & (z <= max(ends))]
    tables["tracer"], tables["gauge"] = [], []
    return kept


def _coarsened(edges: np.ndarray, factor: float) -> np.ndarray:
    """The edges with fewer cells over the same extent, whose sizes vary as before."""
    cells = max(round((len(edges) - 1) / factor), min(len(edges) - 1, 4))
    return np.interp(np.linspace(0, len(edges) - 1, cells + 1), np.arange(len(edges)), edges)


def _segments(edges: np.ndarray) -> list[dict]:
    """Segments of a mesh with these edges, one for each row of equal cells."""
    segments: list[dict] = []
    sizes = np.diff(edges)
    for number, size in enumerate(sizes):
        if number and abs(size - sizes[number - 1]) < 1e-6 * size:
            segments[-1] = {"to": float(edges[number + 1]), "cells": segments[-1]["cells"] + 1}
        else:
            segments.append({"to": float(edges[number + 1]), "cells": 1})
    return segments


def mutant(number: int) -> tuple[str, list[str], str]:
    """The name of the shipped deck, the changes, in words, and the text of the changed deck."""
    chance = random.Random(number)
    name = chance.choice(shipped())
    tables, words = copy.deepcopy(_base(name)), []
    for _ in range(chance.choice((1, 1, 2, 2, 3, 4))):
        change = chance.choice(changes.CHANGES)
        words.append(f"{change.__name__}: {change(tables, chance)}")
    return name, words, toml.dumps({"numbers": "SI", **tables})


def unchanged(name: str) -> str:
    """The text of a shipped deck before any change."""
    return toml.dumps({"numbers": "SI", **_base(name)})


if __name__ == "__main__":
    for each in sys.argv[1:]:
        deck_name, all_told, deck_text = mutant(int(each))
        print("\n".join(f"# {line}" for line in (deck_name, *all_told)), deck_text, sep="\n")
