"""Small random decks of all kinds with their twins: the mirrored one, one in another order, one continued from a restart, one
on several threads, one in other units, and the same impact in three frames.

``python -m tests.trials.crowd 0 1000 FILE`` adds a line of JSON for each deck from 0 up to 1000 to FILE, then prints how many
there were by fault. Decks that already have a line are not run again. Threads are tried as far as numba has them
(NUMBA_NUM_THREADS).
"""

from __future__ import annotations

import collections
import sys
import tomllib

import numpy as np

from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.files import toml
from hydro2d.jit import max_threads, set_threads, threads
from hydro2d.materials import library
from hydro2d.mesh.fields import BODY, RHO, SRZ, E
from hydro2d.solver.simulation import Simulation
from tests import restarts
from tests.measure import audited
from tests.measure.test_audit import unexplained_by_sound
from tests.trials.campaign import judged, kept

CYCLES = 100
#: limits: of totals, and next to products of an explosive (tests/measure/test_audit.py); of sums of twins; of the deviation of
#: a body from its course, in cells; of the velocity of the rod in other frames, over the closing speed
CLOSES, CLOSES_BESIDE_PRODUCTS, TWINS, COURSE, FRAMES = 1e-12, 1e-9, 1e-9, 0.1, 0.1
#: size of the cells of a crowd, m: edges of their meshes are mirrored to the bit
CELL = 2.0**-10
#: threads of one cycle after the other, of every tenth deck: more threads than processors wait for one another for long
THREADS, TEAMS_EVERY = (2, 3, 5, 1), 10
#: cells of void that a deck gets below and above for its other frames
ROOM = 6
#: powers of length, time and mass in units
POWERS = {"1": (0, 0, 0), "K": (0, 0, 0), "1/K": (0, 0, 0), "m": (1, 0, 0), "s": (0, 1, 0), "1/s": (0, -1, 0),
          "m/s": (1, -1, 0), "m/s^2": (1, -2, 0), "kg/m^3": (-3, 0, 1), "Pa": (-1, -2, 1), "1/Pa": (1, 2, -1),
          "J/kg": (2, -2, 0), "J/(kg*K)": (2, -2, 0), "W/kg": (2, -3, 0)}
#: units of the keys of a deck, of its bodies and sources, and of what an edge has after its name
UNITS = {"to": "m", "r": "m", "z": "m", "velocity": "m/s", "density": "kg/m^3", "pressure": "Pa", "axial": "m/s^2",
         "power": "s, W/kg"}
EDGE_UNITS = {"velocity": "m/s", "axial": "m/s", "radial": "m/s", "piston": "s, m/s", "pressure": "s, Pa"}
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
    height = deck["mesh"].get("z_start", 0.0) + segment["to"]
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


def in_units(value, unit: str, powers: tuple[int, int, int]):
    """A number, or a list of them or of rows of a table, in units of length, time and mass that are 2^-power times as large."""
    if isinstance(value, list):
        units = unit.split(", ") if ", " in unit and not isinstance(value[0], list) else [unit] * len(value)
        return [in_units(each, of, powers) for each, of in zip(value, units, strict=True)]
    return value * 2.0 ** float(np.dot(POWERS[unit], powers))


def rescaled(text: str, powers: tuple[int, int, int]) -> str:
    """The deck with all lengths, times and masses times 2^power, those of its materials as well."""
    deck = tomllib.loads(text)
    deck["mesh"]["z_start"] = in_units(deck["mesh"]["z_start"], "m", powers)
    for table in (*deck["mesh"]["r"], *deck["mesh"]["z"], *deck["body"], *deck.get("source", ())):
        for key in table.keys() & UNITS.keys():
            table[key] = in_units(table[key], UNITS[key], powers)
    for key, value in deck["boundaries"].items():
        if (kind := key.split("_")[-1]) in EDGE_UNITS:
            deck["boundaries"][key] = in_units(value, EDGE_UNITS[kind], powers)
    deck["stop"]["time"] = in_units(deck["stop"]["time"], "s", powers)
    deck["materials"] = {}
    for body in deck["body"]:
        material = library.load(body["material"])
        table = material.as_deck()
        for part, values in table.items():
            if isinstance(values, dict):
                values |= {key: in_units(values[key], number.unit, powers)
                           for key in values if (number := material.number(part, key))}
            elif (number := material.number(part)):
                table[part] = in_units(values, number.unit, powers)
        body["material"] = f"own_{body['material']}"
        deck["materials"][body["material"]] = table
    return toml.dumps(deck)


def framed(text: str, common: float) -> str | None:
    """The rod and the target alone, void below and above them, with a common velocity along z; None where an edge forbids it.

    The edges along z are open, the mesh does not follow, and bodies end where the mesh did.
    """
    deck = tomllib.loads(text)
    (segment,), edges = deck["mesh"]["z"], deck["boundaries"]
    low, high = deck["mesh"]["z_start"], segment["to"]
    deck["mesh"] = {key: value for key, value in deck["mesh"].items() if key != "follow"}
    deck["mesh"]["z_start"] = low - ROOM * CELL
    deck["mesh"]["z"] = [{"to": high + ROOM * CELL, "cells": segment["cells"] + 2 * ROOM}]
    deck["body"] = deck["body"][:2]
    for body in deck["body"]:
        body["z"] = [min(max(z, low), high) for z in body["z"]]
        across, along = body["velocity"] if isinstance(body["velocity"], list) else (0.0, body["velocity"])
        body["velocity"] = [across, along + common]
    deck["boundaries"] = edges = {key: value for key, value in edges.items() if key[0] == "r"}
    held = [edge for edge, kind in edges.items() if kind == "held"]
    for edge in held if common else ():
        edges[f"{edge}_axial"] = edges.get(f"{edge}_axial", 0.0) + common
    return None if held and ("anvil" in edges.values() or "contact" in text) else toml.dumps(deck)


def text_of(number: int) -> str:
    """The deck of a number; after all choices the numbers continue with the next seed."""
    kinds = list(audited.all_choices())
    return on_a_mirrored_mesh(audited.deck(1000 + number // len(kinds), kinds[number % len(kinds)]))


def on_a_mirrored_mesh(text: str) -> str:
    """The deck with cells of CELL instead of a millimetre and z = 0 in the middle; places along z have few bits."""
    deck = tomllib.loads(text)
    ((across,), (along,)), size = (deck["mesh"][axis] for axis in "rz"), CELL / 1e-3
    half = 0.5 * along["cells"] * CELL

    def place(z: float) -> float:
        return round(z * size * 2.0**40) * 2.0**-40 - half

    deck["mesh"]["z_start"], along["to"], across["to"] = -half, half, across["cells"] * CELL
    for body in deck["body"]:
        body["z"] = [place(z) for z in body["z"]]
        body |= {"r": [r * size for r in body["r"]]} if "r" in body else {}
    for source in deck.get("source", ()):
        source |= {"points": [[r * size, place(z), t] for r, z, t in source["points"]]} if "points" in source else {}
    return toml.dumps(deck)


def wrong(number: int, apart_at_most: float = TWINS) -> tuple[str, dict[str, float | str] | None]:
    """The deck of a number, and its faults: {what: by how much, or the message}; None if it ends as unphysical.

    apart_at_most : largest relative difference of sums of the mirror image and of the other order of the bodies
    """
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
        if not apart[worst] < apart_at_most:
            faults[name] = f"{worst}: {apart[worst]:.3g}"
    again = restarted(text)
    if not all(np.array_equal(getattr(again.state, name), getattr(plain.state, name)) for name in ARRAYS):
        faults["restart"] = "other bits"
    return text, faults


def more_wrong(number: int) -> dict[str, float | str]:
    """Further faults of the deck of a number: by threads, units and frames, and of a whole run.

    In frames with more motion more energy is lost to the remap, and a run that says so is no fault.
    """
    text = text_of(number)
    faults: dict[str, float | str] = {}
    ended = judged(text + f"cycles = {CYCLES}\n")
    if ended["ended"] == "crash" or (ended["ended"] == "beyond" and "source" not in text):  # `Reach` knows of no sources
        faults[ended["ended"]] = ended.get("message", "")
    for name, twin in {"threads": by_threads, "mass": by_masses, "length and time": by_lengths, "frame": by_frames}.items():
        try:
            fault = twin(number, text)
        except UnphysicalState as error:
            fault = "" if ended["ended"] == "unphysical" or name == "frame" else str(error)
        if fault:
            faults[name] = fault
    return faults


def by_threads(number: int, text: str) -> str:
    """The first array that a run has other bits of with a team that changes from cycle to cycle, empty if there is none."""
    if number % TEAMS_EVERY:
        return ""
    alone, team, before = Simulation(decks.loads(text)), Simulation(decks.loads(text)), threads()
    for cycle in range(2 * len(THREADS)):
        set_threads(1)
        alone.step()
        set_threads(min(THREADS[cycle % len(THREADS)], max_threads()))
        team.step()
    set_threads(before)
    return next((name for name in ARRAYS if not np.array_equal(getattr(alone.state, name), getattr(team.state, name))), "")


def by_masses(number: int, text: str) -> str:
    """The fields that have other bits with another unit of mass, empty if there are none."""
    return other_bits(text, (0, 0, int(np.random.default_rng(number).integers(1, 6))))


def by_lengths(number: int, text: str) -> str:
    """The fields that have other bits with other units of length and time, empty if there are none.

    Velocities stay as they are: below SMALLEST_SPEED (kernels/vertex_forces) they are zero. An explosive has a time of its own,
    NEVER (eos/jwl).
    """
    power = int(np.random.default_rng(number).integers(1, 6))
    return "" if "detonation" in text else other_bits(text, (power, power, 3 * power))


def other_bits(text: str, powers: tuple[int, int, int]) -> str:
    """The fields that have other bits once lengths, times and masses are 2^power as large."""
    one, other = advanced(text), advanced(rescaled(text, powers))
    factors = [2.0 ** float(np.dot(POWERS[field.unit or "1"], powers)) for field in BODY]
    same = {"time": other.time == one.time * 2.0 ** powers[1]}
    same |= {name: np.array_equal(getattr(other.state, name), getattr(one.state, name))
             for name in ("vof", "u", "v", "centroid")}
    same |= {field.name: np.array_equal(row, factor * base) for field, factor, row, base in
             zip(BODY, factors, other.state.q, one.state.q, strict=False)}
    return ", ".join(name for name, is_same in same.items() if not is_same)


def by_frames(number: int, text: str) -> str:
    """By how much the rod's velocity in the frame differs between three frames, over the closing speed, if too much."""
    rod = tomllib.loads(text)["body"][0]["velocity"]
    if (still := framed(text, 0.0)) is None:
        return ""
    first = advanced(still)
    velocities = [first.mean_velocity(0)]
    for common in (-0.5 * rod, -rod):
        moving = Simulation(decks.loads(framed(text, common), [f"stop.time={first.time!r}"]))
        while moving.stop_reason() is None:
            moving.step()
        velocities.append(moving.mean_velocity(0) - common)
    apart = (max(velocities) - min(velocities)) / abs(rod)
    return f"{apart:.3g}" if not apart < FRAMES else ""


def main(first: str, last: str, file: str) -> None:
    """The command."""
    set_threads(1)
    count: collections.Counter = collections.Counter()
    with kept(first, last, file) as (numbers, note):
        for number in numbers:
            text, faults = wrong(number)
            further = more_wrong(number)
            if further:
                faults = (faults or {}) | further
            count.update(["unphysical"] if faults is None else list(faults) or ["sound"])
            note({"number": number, "wrong": faults} | ({"deck": text} if faults else {}))
    print(dict(count))


if __name__ == "__main__":
    main(*sys.argv[1:])
