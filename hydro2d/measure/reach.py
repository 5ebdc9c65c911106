"""The energy that a body can reach in a shot: that of its own stagnation state, compressed to the highest pressure of the shot.

The audit and the shares of `sanity` concern the whole: a light body may be a thousand times too hot without showing there. Its
own bounds follow from its equation of state (explanation/sanity).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from hydro2d.materials.starts import body_state, body_velocity, slot_of
from hydro2d.measure.audit import Totals
from hydro2d.mesh.boundary_conditions import BoundaryConditions
from hydro2d.mesh.edges.base import FREE

#: times the heat of the hottest state that a cell may show, for reflections, convergence and the dissipation of the method, and
#: share of it by which a cell may be colder than at the start
CELL_HOTTER, CELL_COLDER = 3.0, 0.25
#: share of the energy that a body can reach by which a cell may fall below a temperature of zero
CHILL = 1e-3
#: plastic strain beyond which no more heat of plastic work is accepted, and share of the shear modulus that no stress exceeds
MOST_STRAIN, IDEAL_STRENGTH = 10.0, 0.1
#: rate of strain, 1/s, and temperature, K, at which the largest flow stress is looked up
STRONGEST_RATE, ROOM = 1e6, 300.0
#: energy allowed to a body that nothing meets: share of the specific kinetic energy of the closing speed, and of c^2
AT_REST, OF_SOUND = 0.05, 1e-6
#: step in the logarithm of the density along an isentrope, and the longest ways in compression and expansion
STEP, FARTHEST, THINNEST = 0.005, 20.0, 6.9
#: rise of the energy over which a temperature is differenced, J/kg
DIFFERENCE = 1e4
#: greatest compression in which a shock is sought
MOST_COMPRESSION = 1e3


class Reach(NamedTuple):
    """Bounds of the specific internal energy of every body, J/kg, float64[m]: of its mean, and of a cell.

    lowest, highest : coldest and hottest state, which bound the mean;  cell_lowest, cell_highest : those of a cell
    worked : heat by plastic strain, J/kg, at the largest flow stress of the law;  plastic : that allowed in a cell
    friction_heating : heat of friction in a cell by time, W/kg
    shear : shear modulus, Pa, by which elastic energy counts;  chill : energy by which a cell may be colder than 0 K, J/kg
    gas : which bodies are gases;  warm : which begin above a temperature of zero; bool[m]
    speed : the closing speed, m/s;  pressure : the highest pressure of the shot, Pa
    stands : whether there is an edge across z that bodies can meet
    squeezed : heat of every body, J/kg, float64[m, k], if all are compressed to one pressure by given work
    work : that work, J per radian, float64[k], rising;  mass : of all bodies at the start, kg per radian
    """

    lowest: np.ndarray
    highest: np.ndarray
    cell_lowest: np.ndarray
    cell_highest: np.ndarray
    worked: np.ndarray
    plastic: np.ndarray
    friction_heating: np.ndarray
    shear: np.ndarray
    chill: np.ndarray
    gas: np.ndarray
    warm: np.ndarray
    speed: float
    pressure: float
    stands: bool
    squeezed: np.ndarray
    work: np.ndarray
    mass: float

    def given_by(self, work: float) -> np.ndarray:
        """Heat of every body, J/kg, float64[m], from this work of edges and sources, in J per radian.

        The work compresses all of them to one pressure, or is spread over their mass, as by shocks.
        """
        squeezed = np.array([np.interp(work, self.work, each) for each in self.squeezed])
        return np.maximum(squeezed, work / self.mass)


class Material(NamedTuple):
    """Equation of state of one body, with its internal variables, density, kg/m^3, and energy, J/kg."""

    model: int
    par: np.ndarray
    internal: np.ndarray
    rho: float
    e: float

    def evaluate(self, rho: float, e: float) -> tuple[float, float, float, float]:
        from eos.dispatch import evaluate

        return evaluate(self.model, rho, e, self.internal, self.par)


def of(deck, table, state, start) -> Reach:
    """The bounds of a shot.

    Parameters
    ----------
    deck, table : resolved
    state : State, as it is at the start
    start : Totals of it
    """
    materials = _hottest(deck, table)
    mass, free = start.mass, np.array([released(one) for one in materials])
    speed = closing_speed(deck, state.grid) + math.sqrt(2.0 * float(mass @ free) / max(float(mass.sum()), 1e-300))
    pressure = _highest(deck, [stagnation(one, speed)[2] for one in materials])
    highest = np.array([hottest(one, speed, pressure) for one in materials])
    lowest = np.array([min(coldest(one), one.e - given_away) for one, given_away in zip(materials, free, strict=True)])
    first, density = (np.array([getattr(one, name) for one in materials]) for name in ("e", "rho"))
    noise = AT_REST * 0.5 * speed**2 + OF_SOUND * table.sound_speeds() ** 2
    finest = min(state.grid.dr[state.grid.inside[1]].min(), state.grid.dz[state.grid.inside[0]].min())
    squeezed = _squeezed([compressed(one) for one in materials])
    return Reach(
        lowest=lowest, highest=highest,
        cell_lowest=np.minimum(first, 0.0) - CELL_COLDER * (highest - first) - noise,
        cell_highest=np.maximum(first, 0.0) + np.maximum(CELL_HOTTER * (highest - first), speed**2) + noise,
        worked=np.array([strongest(table, m, pressure) for m in range(len(table))]) / density,
        plastic=IDEAL_STRENGTH * table.shear / density,
        friction_heating=deck.sliding.friction * pressure * speed / (finest * density),
        shear=table.shear, chill=CHILL * (highest - lowest),
        gas=table.gases(), warm=np.array([one.evaluate(one.rho, one.e)[3] > 0.0 for one in materials]),
        speed=speed, pressure=pressure, stands=_stands(deck),
        squeezed=squeezed, work=mass @ squeezed, mass=max(float(mass.sum()), 1e-300))


def strongest(table, m: int, pressure: float) -> float:
    """Largest flow stress of body m at a pressure in Pa and room temperature, over strains to MOST_STRAIN, Pa."""
    strains = np.linspace(0.0, MOST_STRAIN, 101)
    return max(table.flow_stress(m, strain, STRONGEST_RATE, ROOM, p) for strain in strains for p in (0.0, pressure))


def _highest(deck, pressures: list[float]) -> float:
    """Highest pressure of a shot, Pa, from those at which each body stops: two that meet do not exceed the lower of theirs.

    A body that meets a wall, or itself in a flow, reaches its own.
    """
    alone = len(pressures) == 1 or any(body.flow for body in deck.body)
    stopped = alone or any(edge.constrains() and edge.name != "axis" for edge in _edges(deck))
    return sorted(pressures)[-1 if stopped else -2]


def _hottest(deck, table) -> list[Material]:
    """The materials of the slots, each in the state of its hottest body; explosives have burnt."""
    materials: dict[int, Material] = {}
    for body, m in zip(deck.body, slot_of(deck, table), strict=True):
        rho, e = body_state(body, table, m)
        if m not in materials or e > materials[m].e:
            materials[m] = Material(int(table.eos_model[m]), table.eos_par[m], table.spent(m), rho, e)
    return [materials[m] for m in range(len(table))]


def _edges(deck):
    """The edges of the mesh of a deck."""
    return BoundaryConditions.of(deck.boundaries.model_dump()).edges


def closing_speed(deck, grid) -> float:
    """Largest difference of two velocities that a deck gives, of parts of bodies and of edges that constrain or push, m/s.

    An edge meets bodies that move along its normal, and has no friction unless it is held: in a tube or along the axis, bodies
    may fly along z at any speed. Bodies that move as a whole meet nothing.
    """
    rows, columns = grid.inside
    r, z = np.meshgrid(grid.rc[columns], grid.zc[rows])
    given: list[tuple[float, float]] = []
    for body in deck.body:
        u, v = body_velocity(body, r, z) if body.flow else body.velocity
        given += [(x, y) for x in (np.min(u), np.max(u)) for y in (np.min(v), np.max(v))]
    along = [[velocity[n] for velocity in given] for n in range(2)]
    for n, edge in enumerate(_edges(deck)):
        along[1 - n // 2] += [] if edge.slide() is None else [edge.slide()]
        along[n // 2] += edge.speeds() or ((0.0,) if edge.traction() != FREE else ())
    between = [math.dist(one, other) for one, other in combinations(given, 2)]
    return float(max([*between, *(max(each) - min(each) for each in along if each)], default=0.0))


def speed_of_all(deck, table, grid) -> float:
    """The largest speed in a shot by its deck, m/s: the closing speed, and that of the body that expands fastest; infinite if
    sources or edges with a pressure give energy."""
    if deck.source or any(edge.presses() for edge in _edges(deck)):
        return math.inf
    return closing_speed(deck, grid) + math.sqrt(2.0 * max(released(one) for one in _hottest(deck, table)))


def _stands(deck) -> bool:
    """Whether there is an edge across z that bodies can meet: a wall, an anvil, dashpots, or one with its own velocity."""
    return any(edge.constrains() or edge.traction() != FREE for edge in _edges(deck)[2:])


def drift(start: Totals) -> float:
    """Kinetic energy of the motion of all bodies together along z, J per radian. `Totals` knows no radial momentum."""
    return 0.5 * start.momentum**2 / max(float(start.mass.sum()), 1e-300)


def hottest(material: Material, speed: float, pressure: float) -> float:
    """Energy of a material that is stopped from a speed and compressed to a pressure, J/kg; a slower stop may suffice."""
    rho, e, p = stagnation(material, speed)
    if p > pressure > stagnation(material, 0.0)[2]:
        return stagnation(material, brentq(lambda slower: stagnation(material, slower)[2] - pressure, 0.0, speed))[1]
    return e if p >= pressure else _along_isentrope(material, rho, e, STEP, lambda p: p >= pressure)


def released(material: Material) -> float:
    """Energy that a material loses on its isentrope to zero pressure, or to a thousandth of its density, J/kg."""
    if not material.evaluate(material.rho, material.e)[0] > 0.0:
        return 0.0
    return max(material.e - _along_isentrope(material, material.rho, material.e, -STEP, lambda p: p <= 0.0), 0.0)


def stagnation(material: Material, speed: float) -> tuple[float, float, float]:
    """(density, energy, pressure) behind a shock that brings a material to rest from a speed in m/s: its Hugoniot at that
    particle velocity. If there is none below MOST_COMPRESSION, that of an incompressible limit, rho0 v (c0 + 2 v)."""
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


def compressed(material: Material) -> tuple[np.ndarray, np.ndarray]:
    """(pressures, heats) of a material that is compressed along its isentrope from the start, Pa and J/kg, float64[k].

    As far as the pressure rises on the way.
    """
    along = [(p, e) for p, e in _isentrope(material, material.rho, material.e, STEP) if not math.isnan(p)]
    pressures, energies = np.array(along).reshape(-1, 2).T
    rises = int(np.argmax(np.append(np.diff(pressures) <= 0.0, True))) + 1
    return pressures[:rises], energies[:rises] - material.e


def _squeezed(curves: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Heat of every body at one pressure of all, at each of the pressures of `compressed`, J/kg, float64[m, k]."""
    together = np.unique(np.concatenate([pressures for pressures, _ in curves]))
    return np.array([np.interp(together, *curve) for curve in curves])


def _isentrope(material: Material, rho: float, e: float, step: float) -> Iterator[tuple[float, float]]:
    """(pressure, energy) on an isentrope, de = p/rho d(ln rho), in steps of the logarithm of density, Pa and J/kg.

    It also ends where a table ends, beyond which no run goes. The pressure of the last point is NaN.
    """
    farthest = FARTHEST if step > 0.0 else THINNEST
    for _ in range(round(farthest / abs(step))):
        p = material.evaluate(rho, e)[0]
        half = rho * math.exp(0.5 * step)
        in_middle = material.evaluate(half, e + 0.5 * step * p / rho)[0]
        if math.isnan(p + in_middle):
            break
        yield p, e
        e += step * in_middle / half
        rho *= math.exp(step)
    yield math.nan, e


def _along_isentrope(material: Material, rho: float, e: float, step: float, ends) -> float:
    """Energy where the pressure on an isentrope satisfies ``ends``, or where the isentrope itself ends, J/kg."""
    return next(now for p, now in _isentrope(material, rho, e, step) if ends(p) or math.isnan(p))


def coldest(material: Material) -> float:
    """Energy at the first density at which the temperature is zero, J/kg, if the equation of state has a temperature."""
    cold, warm = (material.evaluate(material.rho, material.e + step)[3] for step in (0.0, DIFFERENCE))
    return material.e - cold * DIFFERENCE / (warm - cold) if warm > cold else material.e
