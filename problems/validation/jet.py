"""Penetration velocity and stagnation pressure of a jet without strength, from run directories, against compressible Bernoulli.

    python -m problems.validation.jet RUN [RUN ...] [--first DIAMETERS] [--last DIAMETERS] [--json]

Everything is read on the axis. The volume fractions locate the interface between the last cell that holds jet alone and the
first that holds target alone. Near a stagnation point the pressure on either side is p0 - a x^2, where x is the distance from
the interface; p0 comes from a least-squares fit through cells of one material within 0.6 jet radii. Velocities are slopes of
fitted lines, and pressures are means, over windows of depth counted in jet diameters. Runs need not have ended.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import eos
import hydro2d
from eos.dispatch import evaluate

#: smallest volume fraction at which a cell counts as one material
PURE = 1.0 - 1e-4
#: distance from the interface within which pressures are used: in radii of the jet, but at least this many cells
REACH, CELLS = 0.6, 4
#: smallest number of dumps in a window
ROWS = 4
#: density of an isentrope's densest state over the reference density, and number of steps
DENSEST, STEPS = 1.7, 2000


def isentrope(material) -> tuple[np.ndarray, np.ndarray]:
    """Pressure (Pa) and enthalpy e + p/rho (J/kg) along an isentrope, de = p/rho^2 drho.

    The enthalpy equals w^2/2 for a stream of speed w that stagnates at that pressure.

    material : a material of a deck; its isentrope starts at the reference density with zero energy
    """
    model, start = eos.MODELS[material.eos.name], material.reference_density
    row = model.row(material.eos.values)

    def pressure(rho: float, e: float) -> float:
        return evaluate(model.ID, rho, e, np.zeros(0), row)[0]

    rho = np.linspace(start, DENSEST * start, STEPS + 1)

    def slope(rho: float, e: np.ndarray) -> list[float]:
        return [pressure(rho, e[0]) / rho**2]

    e = solve_ivp(slope, (rho[0], rho[-1]), [0.0], t_eval=rho, rtol=1e-10, atol=1e-3).y[0]
    p = np.array([pressure(*state) for state in zip(rho, e, strict=True)])
    return p, e + p / rho


def bernoulli(jet, target, velocity: float) -> tuple[float, float]:
    """Penetration velocity (m/s) and stagnation pressure (Pa) of a steady jet at an impact velocity in m/s.

    Both streams stagnate at the same pressure, and their speeds, v - u for the jet and u for the target, add up to v.
    """
    own, other = isentrope(jet), isentrope(target)
    p = np.linspace(0.0, 1.0, 20001) ** 2 * min(own[0][-1], other[0][-1])
    target_speed = np.sqrt(2.0 * np.interp(p, *other))
    sum_of_speeds = np.sqrt(2.0 * np.interp(p, *own)) + target_speed
    if velocity > sum_of_speeds[-1]:
        raise hydro2d.ResultsError(f"{velocity:g} m/s is beyond the range of the compressible Bernoulli table")
    pressure = float(np.interp(velocity, sum_of_speeds, p))
    return float(np.interp(pressure, p, target_speed)), pressure


@dataclass(frozen=True)
class Point:
    """The interface on the axis at one time (s): its position (m) and the pressures (Pa) there on the jet and target sides."""

    time: float
    position: float
    jet: float
    target: float


def stagnation(distance: np.ndarray, pressure: np.ndarray) -> float:
    """p0 of a least-squares fit p0 - a x^2 to pressures (Pa) at distances x (m) from the interface."""
    return float(np.linalg.lstsq(np.column_stack([np.ones_like(distance), distance**2]), pressure, rcond=None)[0][0])


def point(edges: np.ndarray, jet: np.ndarray, target: np.ndarray, pressures: tuple[np.ndarray, np.ndarray], reach: float,
          time: float) -> Point | None:
    """The interface, from the volume fractions of jet and target in the cells on the axis; None with too little of either.

    The jet lies below the target. Cells next to a mixed cell are left out.

    pressures : of both bodies in these cells, Pa;  reach : distance from the interface within which they are used, m
    """
    beyond = np.nonzero(target >= PURE)[0]
    before = np.nonzero(jet[: beyond[0]] >= PURE)[0] if len(beyond) else beyond
    if len(before) == 0:
        return None
    low, high = int(before[-1]) + 1, int(beyond[0])
    position = edges[low] + float(np.sum(jet[low:high] * np.diff(edges)[low:high]))
    x = 0.5 * (edges[1:] + edges[:-1]) - position
    near = np.abs(x) <= max(reach, CELLS * (edges[high] - edges[high - 1]))
    index = np.arange(len(x))
    sides = [near & (jet >= PURE) & (index < low - 1), near & (target >= PURE) & (index > high)]
    if any(np.count_nonzero(side) < 2 for side in sides):
        return None
    return Point(time, position, *(stagnation(x[side], p[side]) for side, p in zip(sides, pressures, strict=True)))


def read(run: hydro2d.Results, jet: str, target: str, reach: float) -> list[Point]:
    """The interface in every dump that has one. Raises hydro2d.Error."""
    names = [name for form in ("Volume Fraction for {}", "Pressure of {} [Pa]") for name in map(form.format, (jet, target))]
    points = []
    for time, file in run.dumps:
        dump = run.dump(time)
        if any(name not in dump.fields for name in names):
            raise hydro2d.ResultsError(f'{file} lacks one of {", ".join(names)}: add "body_pressure" to output.fields')
        columns = [dump.fields[name][:, 0].astype(float) for name in names]
        points.append(point(dump.z_edges, *columns[:2], tuple(columns[2:]), reach, dump.time))
    return [each for each in points if each is not None]


def mean(points: list[Point], low: float, high: float) -> dict | None:
    """Velocity (m/s), and mean pressures (Pa) with their scatter, while the interface lies between two positions (m)."""
    inside = [at for at in points if low <= at.position < high]
    if len(inside) < ROWS:
        return None
    keys = ("time", "position", "jet", "target")
    time, position, jet, target = (np.array([getattr(at, key) for at in inside]) for key in keys)
    return {"velocity": float(np.polyfit(time, position, 1)[0]), "dumps": len(inside),
            "jet": float(jet.mean()), "jet_scatter": float(jet.std()),
            "target": float(target.mean()), "target_scatter": float(target.std())}


def measure(directory: Path | str, first: float = 3.0, last: float = 10.0) -> dict:
    """Measurements over windows of one diameter, and over one window from ``first`` to ``last`` diameters; SI.

    Raises hydro2d.Error.
    """
    run = hydro2d.open_run(directory)
    deck = run.deck
    if deck.penetration is None or run.direction < 0:
        raise hydro2d.ResultsError(f"{directory} has no jet that flies towards +z: its deck has no [penetration] for one")
    jet, target = (deck.body_named(getattr(deck.penetration, key)) for key in ("rod", "target"))
    diameter = 2.0 * jet.rod_radius
    velocity = jet.velocity[1] - target.velocity[1]
    u, p = bernoulli(deck.materials[jet.material], deck.materials[target.material], velocity)
    points = read(run, jet.name, target.name, REACH * 0.5 * diameter)
    if not points:
        raise hydro2d.ResultsError(f"{directory} has no dump with jet and target side by side on the axis")
    surface = deck.penetration.surface
    deepest = int((points[-1].position - surface) / diameter)
    rows = [
        {"depth": k + 0.5, **window}
        for k in range(deepest + 1)
        if (window := mean(points, surface + k * diameter, surface + (k + 1) * diameter))
    ]
    return {
        "run": run.label, "ended": bool(run.summary), "velocity": velocity, "diameter": diameter,
        "advection": deck.numerics.advection, "exact": {"velocity": u, "pressure": p},
        "rows": rows, "first": first, "last": last,
        "steady": mean(points, surface + first * diameter, surface + last * diameter),
    }


def _cells(window: dict, exact: dict) -> str:
    """Three columns of the table: velocity and both pressures, each with its error."""
    cells = [f"{window['velocity']:.1f} ({100 * (window['velocity'] / exact['velocity'] - 1):+.2f} %)"]
    for side in ("jet", "target"):
        error, scatter = (100 * x / exact["pressure"] for x in (window[side] - exact["pressure"], window[f"{side}_scatter"]))
        cells.append(f"{window[side] * 1e-9:.3f} ({error:+.1f} %, scatter {scatter:.1f} %)")
    return " | ".join(cells)


def table(result: dict) -> str:
    """The measurements as Markdown."""
    exact = result["exact"]
    ended = "" if result["ended"] else ", not ended"
    lines = [f"**{result['run']}**, {result['velocity']:.0f} m/s, `{result['advection']}`{ended}; compressible Bernoulli: "
             f"{exact['velocity']:.2f} m/s, {exact['pressure'] * 1e-9:.3f} GPa", "",
             "| depth, diameters | velocity, m/s | pressure in the jet, GPa | pressure in the target, GPa |",
             "|---|---|---|---|"]
    lines += [f"| {row['depth']:.1f} | {_cells(row, exact)} |" for row in result["rows"]]
    if result["steady"]:
        lines.append(f"| {result['first']:g} to {result['last']:g} | {_cells(result['steady'], exact)} |")
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """The command. Returns 2 if a directory holds no run with a jet."""
    parser = argparse.ArgumentParser(prog="python -m problems.validation.jet", description=__doc__.splitlines()[0])
    parser.add_argument("run", nargs="+", type=Path, help="a run directory, finished or not")
    parser.add_argument("--first", type=float, default=3.0, help="where the last row begins, in diameters (3)")
    parser.add_argument("--last", type=float, default=10.0, help="where it ends, in diameters (10)")
    parser.add_argument("--json", action="store_true", help="print JSON, SI units")
    given = parser.parse_args(arguments)
    try:
        results = [measure(directory, given.first, given.last) for directory in given.run]
    except hydro2d.Error as error:
        print(error, file=sys.stderr)
        return 2
    print(json.dumps(results, indent=2) if given.json else "\n\n".join(map(table, results)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
