"""Small random decks of all kinds with their twins: the mirrored one, one in another order, one continued from a restart.

``python -m tests.trials.crowd 0 1000 FILE`` adds a line of JSON for each deck from 0 up to 1000 to FILE, then prints how many
there were by fault. Decks that already have a line are not run again.
"""

from __future__ import annotations

import collections
import sys
import tomllib

import numpy as np

from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.files import toml
from hydro2d.mesh.fields import RHO, SRZ, E
from hydro2d.solver.simulation import Simulation
from tests import restarts
from tests.measure import audited
from tests.measure.test_audit import unexplained_by_sound
from tests.trials.campaign import kept

CYCLES = 100
#: limits: of totals, and next to products of an explosive (tests/measure/test_audit.py); of sums of twins, in which round-off
#: decides what is tidied away; of the deviation of a body from its course, in cells
CLOSES, CLOSES_BESIDE_PRODUCTS, TWINS, COURSE = 1e-12, 1e-9, 1e-3, 0.1
#: arrays of a state that a restart gives back to the bit
ARRAYS = ("q", "vof", "u", "v", "centroid")


def advanced(text: str | Simulation, cycles: int = CYCLES) -> Simulation:
    """The simulation, or that of a deck, after some cycles."""
    simulation = Simulation(decks.loads(text)) if isinstance(text, str) else text
    for _ in range(cycles):
        simulation.step()
    return simulation


def mirrored(text: str) -> str:
    """The deck with z turned around within its mesh."""
    deck = tomllib.loads(text)
    (segment,) = deck["mesh"]["z"]
    height = segment["to"]
    for body in deck["body"]:
        body["z"] = [height - z for z in reversed(body["z"])]
        v = body.get("velocity", 0.0)
        body["velocity"] = [v[0], -v[1]] if isinstance(v, list) else -v
    edges = dict(deck["boundaries"])
    for low, high in (("z_min", "z_max"), ("z_max", "z_min")):
        for key in [key for key in edges if key.startswith(low)]:
            deck["boundaries"].pop(key, None)
        for key, value in edges.items():
            if key.startswith(high):
                turned = [[t, -v] for t, v in value] if key.endswith("piston") else value
                turned = -value if key.endswith("velocity") else turned
                deck["boundaries"][low + key.removeprefix(high)] = turned
    for key in [key for key in deck["boundaries"] if key.endswith("_axial")]:
        deck["boundaries"][key] *= -1.0
    for source in deck.get("source", ()):
        if "axial" in source:
            source["axial"] *= -1.0
        if "points" in source:
            source["points"] = [[r, height - z, t] for r, z, t in source["points"]]
    return toml.dumps(deck)


def reordered(text: str) -> str:
    """The deck with its first two bodies, which do not overlap, in the other order, but with the same interface order."""
    deck = tomllib.loads(text)
    deck["numerics"]["interface_order"] = [body["name"] for body in deck["body"]]
    deck["body"][:2] = deck["body"][1::-1]
    return toml.dumps(deck)


def image(text: str, of: Simulation) -> Simulation:
    """The mirrored deck's simulation before its first cycle, with the other's bits, which the deck would round differently."""
    twin = Simulation(decks.loads(mirrored(text)))
    for name in ("vof", "q", "centroid"):
        here, there = (one.grid.interior(getattr(one.state, name)) for one in (twin, of))
        here[...] = there[..., ::-1, :]
    twin.state.q[SRZ] *= -1.0
    twin.state.centroid[1] *= -1.0
    for name, sign in (("u", 1.0), ("v", -1.0)):
        here, there = (one.grid.interior_vertices(getattr(one.state, name)) for one in (twin, of))
        here[...] = sign * there[..., ::-1, :]
    twin.engine.audit = None
    twin.engine.prepare()
    return twin


def sums(simulation: Simulation) -> dict[str, float]:
    """Sums over cells and vertices, from the arrays of the state only: of every body by its name."""
    s, grid = simulation.state, simulation.grid
    mass = s.vof * s.q[RHO] * grid.volume
    inside = (slice(None), *grid.inside)
    totals = {}
    for m, name in enumerate(simulation.table.names):
        of_body = mass[m][grid.inside]
        totals[f"mass {name}"] = float(of_body.sum())
        totals[f"internal energy {name}"] = float((of_body * s.q[E, m][grid.inside]).sum())
        totals[f"volume {name}"] = float((s.vof[m] * grid.volume)[grid.inside].sum())
    vertices = grid.interior_vertices(s.mass)
    u, v = grid.interior_vertices(s.u), grid.interior_vertices(s.v)
    assert np.isfinite(s.q[:, s.vof > 0.0]).all()
    assert mass[inside].min() >= 0.0
    return totals | {"kinetic energy": float(0.5 * (vertices * (u**2 + v**2)).sum()), "momentum": float((vertices * v).sum()),
                     "radial momentum": float((vertices * u).sum())}


def restarted(text: str) -> Simulation:
    """The simulation of a deck stored halfway, as JSON where a restart file uses it, and continued from there."""
    second = restarts.restarted(advanced(text, CYCLES // 2))
    while second.cycle < CYCLES:
        second.step()
    return second


def text_of(number: int) -> str:
    """The deck of a number; after all choices the numbers continue with the next seed."""
    kinds = list(audited.all_choices())
    return audited.deck(1000 + number // len(kinds), kinds[number % len(kinds)])


def wrong(number: int) -> tuple[str, dict[str, float | str] | None]:
    """The deck of a number, and its faults: {what: by how much, or the message}; None if it ends as unphysical."""
    text = text_of(number)
    try:
        plain = advanced(text)
    except UnphysicalState:
        return text, None
    faults: dict[str, float | str] = {}
    missed = unexplained_by_sound(plain)
    if not missed < (CLOSES_BESIDE_PRODUCTS if "detonation" in text else CLOSES):
        faults["audit"] = missed
    now, audit = sums(plain), plain.audit
    start, sinks = audit.start, audit.sinks.values()
    for m, name in enumerate(plain.table.names):
        lost = now[f"mass {name}"] + sum(sink.mass[m] for sink in sinks) - start.mass[m]
        if not abs(lost) <= 1e-11 * start.mass[m]:
            faults["independent mass"] = float(lost / start.mass[m])
    energy = now["kinetic energy"] + sum(now[f"internal energy {name}"] for name in plain.table.names)
    lost = energy + sum(sink.energy for sink in sinks) - start.energy
    if not abs(lost) <= 1e-9 * audit.scale:
        faults["independent energy"] = float(lost / audit.scale)
    off = {name: cells for name, cells in plain.conservation()["off_course_cells"].items() if cells > COURSE}
    if off and plain.engine.courses.parted(plain.table.names):
        faults["course"] = max(off.values())
    scale = {key: max(abs(value), 1e-300) for key, value in now.items()}
    size = (2.0 * start.mass.sum() * audit.scale) ** 0.5
    for key in scale:
        if "momentum" in key:
            scale[key] = size
        if "energy" in key:
            scale[key] = audit.scale
    twins: dict[str, str | Simulation] = {"mirror": image(text, Simulation(decks.loads(text)))}
    if "gas" not in plain.table.names:
        twins["order"] = reordered(text)
    for name, other in twins.items():
        try:
            twin = sums(advanced(other))
        except UnphysicalState as error:
            faults[name] = str(error)
            continue
        if name == "mirror":
            twin["momentum"] *= -1.0
        apart = {key: abs(now[key] - twin[key]) / scale[key] for key in now}
        worst = max(apart, key=apart.get)
        if not apart[worst] < TWINS:
            faults[name] = f"{worst}: {apart[worst]:.3g}"
    again = restarted(text)
    if not all(np.array_equal(getattr(again.state, name), getattr(plain.state, name)) for name in ARRAYS):
        faults["restart"] = "other bits"
    return text, faults


def main(first: str, last: str, file: str) -> None:
    """The command."""
    count: collections.Counter = collections.Counter()
    with kept(first, last, file) as (numbers, note):
        for number in numbers:
            text, faults = wrong(number)
            count.update(["unphysical"] if faults is None else list(faults) or ["sound"])
            note({"number": number, "wrong": faults} | ({"deck": text} if faults else {}))
    print(dict(count))


if __name__ == "__main__":
    main(*sys.argv[1:])
