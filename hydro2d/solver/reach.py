"""What energy a body can reach in a shot: that of its own stagnation state, compressed to the highest pressure of the shot.

The audit and the shares of `sanity` look at the whole: a light body may be a thousand times too hot and not show there. Its own
bounds follow from its equation of state (explanation/sanity).
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from hydro2d.mesh.boundary_conditions import EDGES
from hydro2d.solver.insertion import body_state, slot_of
from strength import SHEAR

#: edges that stop a body
WALLS = ("wall", "velocity")
#: times the heat of the hottest state that a cell may show, for reflections, convergence and the dissipation of the method, and
#: share of it by which a cell may be colder than at the start
CELL_HOTTER, CELL_COLDER = 3.0, 0.25
#: plastic strain beyond which no more heat of plastic work is believed, and share of the shear modulus that no stress exceeds
MOST_STRAIN, IDEAL_STRENGTH = 10.0, 0.1
#: what a body may show that nothing meets: share of the specific kinetic energy of the closing speed, and of c^2
AT_REST, OF_SOUND = 0.05, 1e-6
#: step in the logarithm of the density along an isentrope, and the longest way
STEP, FARTHEST = 0.02, 20.0
#: rise of the energy over which a temperature is differenced, J/kg
DIFFERENCE = 1e4
#: greatest compression in which a shock is sought
MOST_COMPRESSION = 1e3


class Reach(NamedTuple):
    """Bounds of the specific internal energy of every body, J/kg, float64[m]: of its mean, and of a cell.

    lowest, highest : coldest and hottest state, which bound the mean;  cell_lowest, cell_highest : those of a cell
    plastic : heat in a cell by plastic strain, J/kg;  rubbing : the same by time, of friction, W/kg
    gas : which bodies are gases;  warm : which begin above a temperature of zero; bool[m]
    speed : the closing speed, m/s;  pressure : the highest pressure of the shot, Pa
    """

    lowest: np.ndarray
    highest: np.ndarray
    cell_lowest: np.ndarray
    cell_highest: np.ndarray
    plastic: np.ndarray
    rubbing: np.ndarray
    gas: np.ndarray
    warm: np.ndarray
    speed: float
    pressure: float


class Material(NamedTuple):
    """Equation of state of one body, with its first density, kg/m^3, and energy, J/kg."""

    model: int
    par: np.ndarray
    rho: float
    e: float

    def evaluate(self, rho: float, e: float) -> tuple[float, float, float, float]:
        from eos.dispatch import evaluate

        return evaluate(self.model, rho, e, self.par)


def of(deck, table, state, start) -> Reach:
    """The bounds of a shot.

    Parameters
    ----------
    deck, table : resolved
    state : State, as it is at the start
    start : Totals of it
    """
    materials = _hottest(deck, table)
    speed = closing_speed(deck, state)
    mass = float(start.mass.sum())
    speed += math.sqrt(2.0 * float(np.maximum(start.internal_of, 0.0).sum()) / mass) if mass > 0.0 else 0.0
    shocked = [stagnation(material, speed) for material in materials]
    pressure = _highest(deck, [p for _, _, p in shocked])
    highest = np.array([compressed(one, rho, e, pressure) for one, (rho, e, _) in zip(materials, shocked, strict=True)])
    lowest = np.array([min(coldest(one), one.e) for one in materials])
    first, density = (np.array([getattr(one, name) for one in materials]) for name in ("e", "rho"))
    noise = AT_REST * 0.5 * speed**2 + OF_SOUND * table.sound_speeds() ** 2
    shear = np.where(table.strength_model > 0, table.strength_par[:, SHEAR], 0.0)
    finest = min(state.grid.dr[state.grid.inside[1]].min(), state.grid.dz[state.grid.inside[0]].min())
    return Reach(
        lowest=lowest, highest=highest,
        cell_lowest=np.minimum(first, 0.0) - CELL_COLDER * (highest - first) - noise,
        cell_highest=np.maximum(first, 0.0) + np.maximum(CELL_HOTTER * (highest - first), speed**2) + noise,
        plastic=IDEAL_STRENGTH * shear / density, rubbing=deck.sliding.friction * pressure * speed / (finest * density),
        gas=table.gases(), warm=np.array([one.evaluate(one.rho, one.e)[3] > 0.0 for one in materials]),
        speed=speed, pressure=pressure)  # fmt: skip


def _highest(deck, pressures: list[float]) -> float:
    """Highest pressure of a shot, Pa, from those at which each body stops: two that meet do not exceed the lower of theirs.

    A body that meets a wall, or itself in a flow, reaches its own.
    """
    alone = len(pressures) == 1 or any(body.flow for body in deck.body)
    stopped = alone or any(getattr(deck.boundaries, edge) in WALLS for edge in EDGES)
    return sorted(pressures)[-1 if stopped else -2]


def _hottest(deck, table) -> list[Material]:
    """The materials of the slots, each in the state of the hottest body that is in it."""
    found: dict[int, Material] = {}
    for body, m in zip(deck.body, slot_of(deck, table), strict=True):
        rho, e = body_state(body, table, m)
        if m not in found or e > found[m].e:
            found[m] = Material(int(table.eos_model[m]), table.eos_par[m], rho, e)
    return [found[m] for m in range(len(table))]


def closing_speed(deck, state) -> float:
    """Largest difference of two velocities that a deck gives, of bodies, edges and what is at rest, m/s; with a flow, whose
    parts may meet, at least twice the largest velocity."""
    given = [(0.0, 0.0), *(body.velocity for body in deck.body)]
    for edge in EDGES:
        velocity = getattr(deck.boundaries, f"{edge}_velocity") or 0.0
        given.append((velocity, 0.0) if edge.startswith("r") else (0.0, velocity))
    largest = max(math.dist(one, other) for one, other in combinations(given, 2))
    flows = any(body.flow for body in deck.body)
    return max(largest, 2.0 * float(np.sqrt(np.max(state.u**2 + state.v**2)))) if flows else largest


def stagnation(material: Material, speed: float) -> tuple[float, float, float]:
    """(density, energy, pressure) behind a shock that brings a material to rest from a speed in m/s: its Hugoniot at that
    particle velocity. Where there is none below MOST_COMPRESSION, that of an incompressible limit, rho0 v (c0 + 2 v)."""
    from eos.dispatch import sound_speed_squared

    rho0, e0 = material.rho, material.e
    p0, dpdrho, dpde, _ = material.evaluate(rho0, e0)
    if speed == 0.0:
        return rho0, e0, p0

    def state(rho: float) -> tuple[float, float]:
        squeezed = 1.0 - rho0 / rho
        return e0 + 0.5 * speed**2 + p0 * squeezed / rho0, p0 + rho0 * speed**2 / squeezed

    def error(rho: float) -> float:
        e, p = state(rho)
        return material.evaluate(rho, e)[0] - p

    densities = rho0 * (1.0 + np.geomspace(1e-9, MOST_COMPRESSION, 400))
    above = next((k for k, rho in enumerate(densities) if error(rho) >= 0.0), None)
    if above:
        rho = brentq(error, densities[above - 1], densities[above])
        return rho, *state(rho)
    sound = math.sqrt(sound_speed_squared(rho0, p0, dpdrho, dpde, 0.0))
    return rho0, e0 + 0.5 * speed**2, p0 + rho0 * speed * (sound + 2.0 * speed)


def compressed(material: Material, rho: float, e: float, pressure: float) -> float:
    """Energy after an isentropic compression to a pressure, de = p/rho d(ln rho), J/kg; e where that is reached already."""
    p = material.evaluate(rho, e)[0]
    for _ in range(round(FARTHEST / STEP)):
        if not p < pressure:
            break
        middle = e + 0.5 * STEP * p / rho
        half = rho * math.exp(0.5 * STEP)
        e += STEP * material.evaluate(half, middle)[0] / half
        rho *= math.exp(STEP)
        p = material.evaluate(rho, e)[0]
    return e


def coldest(material: Material) -> float:
    """Energy at the first density at which the temperature is zero, J/kg, if the equation of state tells a temperature."""
    cold, warm = (material.evaluate(material.rho, material.e + step)[3] for step in (0.0, DIFFERENCE))
    return material.e - cold * DIFFERENCE / (warm - cold) if warm > cold else material.e
