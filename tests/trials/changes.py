"""Changes that somebody might make to a deck. Each takes the tables and a random.Random, and says in words what it did."""

from __future__ import annotations

import copy

from hydro2d.base import units
from hydro2d.deck.shapes.rod import NOSE_KEYS
from hydro2d.materials import library
from hydro2d.mesh.edges.base import EDGES
from hydro2d.mesh.edges.registry import words

FACTORS = (0.25, 0.5, 0.7, 0.9, 1.1, 1.5, 2.0)
SPEEDS = (-3000.0, -800.0, -50.0, 0.0, 5.0, 60.0, 300.0, 700.0, 1500.0, 2500.0, 4000.0, 7000.0)
#: keys of a body that are lengths, along r and along z
SIZES = ("radius", "diameter", "length", "thickness", "inner_radius", "nose_length")
#: numerics to vary: every value is allowed
NUMERICS = {
    "advection": ("ke", "momentum", "both"), "courant": (0.2, 0.4, 0.6, 0.8), "advective_courant": (0.1, 0.3, 0.5),
    "ramp_cycles": (0, 5, 20), "initial_dt_factor": (0.01, 0.5, 1.0), "max_growth": (1.05, 1.5, 2.0),
    "mixed_cell": ("tipton", "uniform"), "relaxation": (0.01, 0.1, 0.6, 1.0),
    "mixed_strength": ("volume", "solid", "zero", "max", "material"), "viscosity_linear": (0.0, 0.2, 1.0, 2.0),
    "viscosity_quadratic": (0.0, 0.7, 2.0, 4.0), "hourglass": (0.0, 0.02, 0.2, 1.0), "ke_bound": (1.0, 1.5, 10.0),
    "cutoff": (1e-12, 1e-5, 1e-3), "mass_floor": (1e-9, 1e-4, 1e-2), "active_region": (True, False),
    "clip_limit": (0.001, 0.2), "steepness": (1.0, 1.5),
}
FAILURE = {
    "tensile": ("material", "none"), "damage": ("material", "none"), "tension": ("mean", "min"),
    "max_opening": (0.01, 0.5, 1.0), "strength_cutoff": (0.0, 0.5, 0.99),
    "record": (True, False),
}


def _si(value, unit: str) -> float:
    return float(units.to_si(value, unit))


def _some(tables: dict, chance) -> dict:
    return chance.choice(tables["body"])


def _names(tables: dict) -> list[str]:
    """The bodies that others may join; all, if every one of them joins a body that is gone."""
    return [body["name"] for body in tables["body"] if "join" not in body] or [body["name"] for body in tables["body"]]


def _extent(tables: dict) -> tuple[float, float, float]:
    """Roughly the largest r of the mesh, and the ends of the mesh along z, m."""
    ends = []
    for axis, start in (("r", 0.0), ("z", _si(tables["mesh"].get("z_start", 0.0), "m"))):
        to = [_si(segment["to"], "m") for segment in tables["mesh"][axis] if "to" in segment]
        ends.append(max(to, default=start + 0.02))
    return ends[0], _si(tables["mesh"].get("z_start", 0.0), "m"), ends[1]


def speed(tables, chance):
    body = _some(tables, chance)
    old, body["velocity"] = body.get("velocity", 0.0), chance.choice(SPEEDS)
    if chance.random() < 0.15:
        body["velocity"] = [chance.choice((-200.0, 100.0, 800.0)), body["velocity"]]
    return f"{body['name']} from {old} to {body['velocity']}"


def faster(tables, chance):
    factor = chance.choice((-1.0, 0.3, 0.7, 1.3, 2.0, 4.0))
    for body in tables["body"]:
        value = body.get("velocity", 0.0)
        if not isinstance(value, list):
            body["velocity"] = factor * _si(value, "m/s")
    return f"all velocities times {factor}"


def material(tables, chance):
    body = _some(tables, chance)
    old, body["material"] = body["material"], chance.choice(library.names())
    return f"{body['name']} from {old} to {body['material']}"


def own_material(tables, chance):
    """A gas, a liquid, or a material of the library with another strength."""
    body, name = _some(tables, chance), f"own_{chance.randrange(100)}"
    kind = chance.choice(("gas", "liquid", "soft", "hard"))
    density = chance.choice((0.02, 1.2, 30.0))
    eos = {"gas": {"model": "ideal-gas", "adiabatic_index": chance.choice((1.2, 1.4, 1.667)), "reference_density": density,
                   "reference_energy": chance.choice((0.0, 2e5))},
           "liquid": {"model": "stiffened-gas", "reference_density": 1000.0, "sound_speed": 1480.0, "adiabatic_index": 2.4,
                      "specific_heat": 4180.0}}
    if kind in eos:
        table = {"eos": eos[kind]}
    else:
        base = chance.choice([each for each in library.names() if not each.startswith("gas")])
        table = {"based_on": base, "strength": {"model": "elastic-plastic", "shear_modulus": 3e10,
                                                "yield_stress": 1e7 if kind == "soft" else 3e9}}
    tables.setdefault("materials", {})[name] = table
    body["material"] = name
    return f"{body['name']} of {kind} {table}"


def size(tables, chance):
    body, factor = _some(tables, chance), chance.choice(FACTORS)
    keys = [key for key in SIZES if key in body] + [key for key in ("r", "z") if key in body and body["shape"] == "box"]
    if body["shape"] == "polygon":
        body["points"] = [[factor * _si(x, "m") for x in point] for point in body["points"]]
        return f"{body['name']} times {factor}"
    key = chance.choice(keys)
    if key in ("r", "z"):
        low, high = (_si(x, "m") for x in body[key])
        body[key] = [low, low + factor * (high - low)]
    else:
        body[key] = factor * _si(body[key], "m")
    return f"{body['name']}.{key} times {factor}"


def _shift(body: dict, along_r: float, along_z: float) -> None:
    """Moves a body in place."""
    for key in ("tip", "z_front"):
        if key in body:
            body[key] = _si(body[key], "m") + along_z
    if body["shape"] == "box":
        body["z"] = [_si(x, "m") + along_z for x in body["z"]]
        if "r" in body:
            body["r"] = [_si(x, "m") + along_r for x in body["r"]]
    if body["shape"] == "sphere":
        centre = body["centre"] if isinstance(body["centre"], list) else [0.0, body["centre"]]
        body["centre"] = [_si(centre[0], "m") + along_r, _si(centre[1], "m") + along_z]
    if body["shape"] == "polygon":
        body["points"] = [[_si(r, "m") + along_r, _si(z, "m") + along_z] for r, z in body["points"]]


def move(tables, chance):
    body, (width, low, high) = _some(tables, chance), _extent(tables)
    way = chance.choice((0.003, 0.01, 0.05, 0.2)) * chance.choice((-1, 1))
    along_r, along_z = chance.choice((0.0, 0.0, way * width)), way * (high - low)
    _shift(body, along_r, along_z)
    return f"{body['name']} by {along_r:.4g}, {along_z:.4g} m"


def remove(tables, chance):
    """Removes a body; mostly also where it is named."""
    if len(tables["body"]) < 2:
        return "nothing"
    gone = tables["body"].pop(chance.randrange(len(tables["body"])))["name"]
    if chance.random() < 0.9:
        _forget(tables, gone)
    return gone


def _forget(tables: dict, gone: str) -> None:
    """Removes the name of a body from all sections."""
    sliding = tables.get("sliding", {})
    if gone in sliding.get("hard", ()):
        sliding["hard"] = [name for name in sliding["hard"] if name != gone]
        if not sliding["hard"]:
            del tables["sliding"]
    shot = tables.get("penetration")
    if shot and gone in (shot.get("rod"), shot.get("target"), *shot.get("targets", ())):
        del tables["penetration"]
    if tables["mesh"].get("follow") == gone:
        del tables["mesh"]["follow"]
    if tables["stop"].get("body") == gone:
        del tables["stop"]["body"]
    tables.get("numerics", {}).pop("interface_order", None)


def another(tables, chance):
    """Adds a body, like another, elsewhere, of the same or another material, before or after the others in the deck."""
    body = copy.deepcopy(_some(tables, chance))
    body["name"] = f"{body['name']}_{chance.randrange(1000)}"
    _, low, high = _extent(tables)
    _shift(body, 0.0, chance.choice((-0.3, -0.05, 0.0, 0.02, 0.3)) * (high - low))
    if chance.random() < 0.5:
        body["material"] = chance.choice(library.names())
    if chance.random() < 0.4:
        body["velocity"] = chance.choice(SPEEDS)
    tables["body"].insert(chance.randrange(len(tables["body"]) + 1), body)
    if chance.random() < 0.5 and tables.get("sliding", {}).get("hard"):
        tables["sliding"]["hard"] = [*tables["sliding"]["hard"], body["name"]]
    return f"{body['name']} of {body['material']} at {body.get('velocity', 0.0)}"


def block(tables, chance):
    """Adds a small block anywhere, first in the deck, so that it displaces others."""
    width, low, high = _extent(tables)
    r, z = sorted(chance.uniform(0.0, 0.6 * width) for _ in range(2)), sorted(chance.uniform(low, high) for _ in range(2))
    body = {"name": "block", "shape": "box", "material": chance.choice(library.names()), "r": r, "z": z,
            "velocity": chance.choice((0.0, 0.0, *SPEEDS))}
    tables["body"].insert(chance.choice((0, len(tables["body"]))), body)
    return f"{body['material']} r {r} z {z} at {body['velocity']}"


def air(tables, chance):
    """Adds a gas wherever there is nothing else."""
    _, low, high = _extent(tables)
    gas = {"eos": {"model": "ideal-gas", "adiabatic_index": chance.choice((1.2, 1.4, 1.667)),
                   "reference_density": chance.choice((0.1, 1.2, 10.0))}}
    tables.setdefault("materials", {})["air_around"] = gas
    pressure = chance.choice((1e4, 1e5, 1e6, 1e8))
    tables["body"].append({"name": "air_around", "shape": "box", "material": "air_around", "z": [low, high],
                           "pressure": pressure})
    return f"{gas['eos']['reference_density']} kg/m^3, {pressure:g} Pa"


def order(tables, chance):
    chance.shuffle(tables["body"])
    return ", ".join(_names(tables))


def interfaces(tables, chance):
    names = _names(tables)
    chance.shuffle(names)
    tables.setdefault("numerics", {})["interface_order"] = names
    return ", ".join(names)


def cells(tables, chance):
    """A segment with more or fewer cells, another growth, or an end elsewhere."""
    axis = chance.choice(("r", "z"))
    segment, factor = chance.choice(tables["mesh"][axis]), chance.choice((0.5, 0.8, 1.3, 2.0))
    key = chance.choice([key for key in ("cells", "size", "cells_across", "ratio", "first", "last", "to") if key in segment])
    if key == "cells":
        segment[key] = max(round(segment[key] * factor), 1)
    elif key == "ratio":
        segment[key] = chance.choice((0.95, 1.02, 1.3, 1.6))
    elif key == "cells_across":
        segment[key] *= factor
    else:
        segment[key] = _si(segment[key], "m") * (factor if key != "to" else chance.choice((0.7, 0.95, 1.1)))
    return f"mesh.{axis} {key} {segment[key]}"


def start(tables, chance):
    mesh, (width, low, high) = tables["mesh"], _extent(tables)
    if chance.random() < 0.4:
        mesh["r_start"] = chance.choice((-0.2, 0.03, 0.2)) * width
        return f"r_start {mesh['r_start']:.4g}"
    mesh["z_start"] = low + chance.choice((-0.1, -0.02, 0.013, 0.1)) * (high - low)
    return f"z_start {mesh['z_start']:.4g}"


def geometry(tables, chance):
    mesh = tables["mesh"]
    mesh["geometry"] = "planar" if mesh.get("geometry", "cylindrical") == "cylindrical" else "cylindrical"
    if chance.random() < 0.8:
        tables.get("boundaries", {}).pop("r_min", None)
    return mesh["geometry"]


def boundary(tables, chance):
    edge = chance.choice(EDGES)
    section = tables.setdefault("boundaries", {})
    section[edge] = chance.choice(words(edge))
    if section[edge] == "velocity":
        section[f"{edge}_velocity"] = chance.choice((-1000.0, -100.0, 20.0, 500.0))
    else:
        section.pop(f"{edge}_velocity", None)
    section.pop(f"{edge}_piston", None)
    if section[edge] == "piston":
        section[f"{edge}_piston"] = [[0.0, 0.0], [1e-6, chance.choice((-500.0, 20.0, 500.0))]]
    return f"{edge} {section[edge]} {section.get(f'{edge}_velocity', '')}"


def follow(tables, chance):
    mesh = tables["mesh"]
    mesh["follow"] = chance.choice((*_names(tables), "none"))
    return mesh["follow"]


def sliding(tables, chance):
    method, names = chance.choice(("none", "contact", "contact", "slip-layer")), _names(tables)
    section = {"method": method}
    if method != "none":
        section["hard"] = chance.sample(names, chance.choice((1, 1, max(len(names) - 1, 1))))
        section["yield_factor"] = chance.choice(("off", "off", 2.0, "radius"))
    if method == "contact" and chance.random() < 0.5:
        section["friction"] = chance.choice((0.02, 0.2, 1.0))
    tables["sliding"] = section
    return str(section)


def numerics(tables, chance):
    key = chance.choice(list(NUMERICS))
    value = tables.setdefault("numerics", {})[key] = chance.choice(NUMERICS[key])
    return f"{key} {value}"


def failure(tables, chance):
    key = chance.choice(list(FAILURE))
    value = tables.setdefault("failure", {})[key] = chance.choice(FAILURE[key])
    return f"{key} {value}"


def thermal(tables, chance):
    """Another initial pressure, energy, temperature or density of a body."""
    body = _some(tables, chance)
    for key in ("pressure", "energy", "temperature"):
        body.pop(key, None)
    key = chance.choice(("pressure", "pressure", "energy", "temperature", "density"))
    values = {"pressure": (-1e9, 1e5, 1e8, 1e9, 1e10), "energy": (-1e4, 1e5, 1e6), "temperature": (80.0, 600.0, 3000.0)}
    if key == "density":
        density = library.load(body["material"]).reference_density if body["material"] in library.names() else 1000.0
        body[key] = density * chance.choice((0.5, 0.97, 0.99, 1.02, 1.2))
    else:
        body[key] = chance.choice(values[key])
    return f"{body['name']}.{key} {body[key]}"


def flow(tables, chance):
    body, (width, low, high) = _some(tables, chance), _extent(tables)
    body["flow"] = {"pattern": chance.choice(("spherical", "cylindrical")), "speed": chance.choice((-500.0, -50.0, 200.0)),
                    "centre": chance.uniform(low, high), "radius": 0.3 * width}
    return f"{body['name']} {body['flow']}"


def nose(tables, chance):
    rods = [body for body in tables["body"] if body["shape"] == "rod"]
    if not rods:
        return "nothing"
    body = chance.choice(rods)
    for key in NOSE_KEYS:
        body.pop(key, None)
    body["nose"] = chance.choice(("flat", "hemispherical", "ogival", "conical"))
    if body["nose"] == "ogival":
        body["crh"] = chance.choice((0.5, 1.0, 3.0))
    if body["nose"] == "conical":
        body["half_angle"] = chance.choice(("20 deg", "60 deg", "85 deg"))
    return f"{body['name']} {body['nose']}"


def stations(tables, chance):
    width, low, high = _extent(tables)
    place = {"r": chance.uniform(0.0, 1.02 * width), "z": chance.uniform(low, high)}
    if chance.random() < 0.5:
        tables.setdefault("tracer", []).append({"name": f"t{chance.randrange(1000)}", **place})
        return f"tracer {place}"
    tables.setdefault("gauge", []).append({"name": f"g{chance.randrange(1000)}", **place, "z_end": high, "points": 5})
    return f"gauge {place}"


def stop(tables, chance):
    section = tables["stop"]
    key = chance.choice(("speed_below", "rebound", "perforation", "body", "cycles"))
    section[key] = {"speed_below": chance.choice((1.0, 500.0)), "rebound": True, "perforation": chance.choice((True, "tail")),
                    "body": chance.choice(_names(tables)), "cycles": chance.choice((1, 7, 100))}[key]
    return f"{key} {section[key]}"


CHANGES = (speed, speed, faster, faster, material, material, own_material, size, size, move, move, remove, another, another,
           block, block, air, air, order, interfaces, cells, cells, start, geometry, boundary, boundary, follow, sliding,
           sliding, numerics, numerics, numerics, failure, thermal, thermal, flow, nose, stations, stop)
