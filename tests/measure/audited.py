"""Small random decks of every kind of edge with every choice that changes a velocity, for tests of the audit."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple, get_args

import numpy as np

from hydro2d.deck.sections import Sliding
from hydro2d.kernels.momentum import ADVECTIONS
from hydro2d.mesh.edges import registry as edges
from hydro2d.mesh.edges.base import EDGES
from hydro2d.sources import registry as sources
from tests.decks import box, entry, mesh, stop, table

SLIDING = get_args(Sliding.model_fields["method"].annotation)
SOURCES = ("none", *sources.KINDS)
EDGE_KINDS = edges.words("r_max")
#: the kinds of edges that prescribe a velocity other than zero
DRIVEN = ("velocity", "piston")
#: the kind at which a body must lie
PRESSING = "pressure"

#: their names in the library
METALS, GAS, EXPLOSIVE = ("Al5083", "copper_OFHC", "lead", "steel_4340"), "gas_7_5", "TNT"


class Choices(NamedTuple):
    """The choices of a deck; edge : the kind of some of its edges."""

    edge: str
    sliding: str
    advection: str
    source: str
    following: bool


def all_choices() -> Iterator[Choices]:
    """All combinations that decks allow: no driven edges with a contact, no mesh that follows a detonation."""
    for each in itertools.product(EDGE_KINDS, SLIDING, ADVECTIONS, SOURCES, (False, True)):
        choices = Choices(*each)
        if choices.sliding == "contact" and choices.edge in DRIVEN:
            continue
        if not (choices.following and choices.source == "detonation"):
            yield choices


def _edges(random: np.random.Generator, choices: Choices, geometry: str) -> dict:
    """The table of boundaries: the chosen kind at one edge that allows it and at others by chance."""
    kinds = [kind for kind in EDGE_KINDS if choices.sliding != "contact" or kind not in DRIVEN]
    free = [edge for edge in EDGES if geometry == "planar" or edge != "r_min"]
    open_ended = [kind for kind in kinds if kind in ("outflow", "transmit")]
    sure = random.choice([edge for edge in free
                          if not choices.following or edge[0] == "r" or choices.edge in open_ended])
    edges = {} if geometry == "planar" else {"r_min": "axis"}
    for edge in free:
        allowed = open_ended if choices.following and edge[0] == "z" else kinds
        if any(edges.get(f"{each}_{key}") for each in EDGES for key in ("axial", "radial")):
            allowed = [kind for kind in allowed if kind != "anvil"]
        kind = edges[edge] = choices.edge if edge == sure else str(random.choice(allowed))
        speed = float(random.uniform(-200.0, 200.0))
        if kind == "velocity":
            edges[f"{edge}_velocity"] = speed
        if kind == "piston":
            edges[f"{edge}_piston"] = [[0.0, 0.0], [2e-7, speed], [8e-7, speed], [1e-6, -speed]]
        if kind == "held" and choices.sliding != "contact" and "anvil" not in (*edges.values(), choices.edge):
            edges[f"{edge}_{'axial' if edge[0] == 'r' else 'radial'}"] = speed
        if kind == PRESSING:
            edges[f"{edge}_pressure"] = [[0.0, 1e6 * speed], [1e-6, 1e8]]
    return edges


def _source(random: np.random.Generator, kind: str, place: list[float]) -> str:
    """Any source that acts on the target; place : (r, z) within it."""
    if kind == "heating":
        return entry("source", name="given", kind=kind, body="target", power=[[0.0, 1e11], [1e-6, 0.0]])
    if kind == "acceleration":
        return entry("source", name="given", kind=kind, body="target", axial=float(random.uniform(-1e8, 1e8)))
    if kind == "detonation":
        return entry("source", name="given", kind=kind, body="target", points=[[*place, 0.0]])
    assert kind == "none", f"no deck of this test has a source of the kind {kind}"
    return ""


def deck(seed: int, choices: Choices) -> str:
    """A metal that flies into a layer of another one, or of an explosive, on 8 by 16 to 12 by 24 cells.

    By chance there is a gas next to them; in a contact and next to an explosive gases are not computed well enough.
    """
    random = np.random.default_rng([seed, *map(ord, str(choices))])
    geometry = str(random.choice(["planar", "cylindrical"]))
    nr, nz, h = int(random.integers(8, 13)), int(random.integers(16, 25)), 1e-3
    hard, soft = (str(name) for name in random.choice(METALS, 2, replace=False))
    soft = EXPLOSIVE if choices.source == "detonation" else soft
    middle = nz // 2 * h + float(random.uniform(-0.5, 0.5)) * h
    text = mesh((nr * h, nr), (nz * h, nz), geometry=geometry,
                **({"follow": "rod"} if choices.following else {}))
    radius = float(random.uniform(2.5, 6.0)) * h
    gap = float(random.choice([0.0, random.uniform(0.0, 2.0)])) * h
    back = float(random.choice([-1.0 if choices.following is False else 1.0, random.uniform(0.5, 3.0)])) * h
    velocity = float(random.uniform(20.0, 600.0))
    across = float(random.uniform(-50.0, 50.0)) if geometry == "planar" else 0.0
    wide, deep = (float(random.choice([n + 2, n - less])) * h for n, less in ((nr, 1.5), (nz, 3.3)))
    motion = [0.0, 0.0] if choices.following else [across, float(random.uniform(-50.0, 50.0))]
    gas = ""
    if choices.sliding != "contact" and choices.source != "detonation" and random.random() < 0.5:
        gas = box("gas", GAS, z=[0.0, nz * h], density=float(random.choice([1.2, 100.0])), pressure=1e7)
    edges = _edges(random, choices, geometry)
    back = -1.0 * h if edges["z_min"] == PRESSING else back
    wide = (nr + 2) * h if edges["r_max"] == PRESSING else wide
    deep = (nz + 2) * h if edges["z_max"] == PRESSING else deep
    text += box("rod", hard, r=[0.0, radius], z=[back, middle - gap], velocity=velocity)
    text += box("target", soft, r=[0.0, wide], z=[middle, deep], velocity=motion) + gas + table("boundaries", **edges)
    if choices.sliding != "none":
        text += table("sliding", method=choices.sliding, hard=["rod"],
                      **({"friction": 0.1} if choices.sliding == "contact" and random.random() < 0.5 else {}))
    text += table("numerics", advection=choices.advection, ramp_cycles=int(random.choice([0, 20])))
    return text + _source(random, choices.source, [0.5 * h, middle + h]) + stop(1e-3)
