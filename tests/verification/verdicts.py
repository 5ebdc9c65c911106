"""Small runs with exactly known answers, with the error of one number of each, and the verdict on them.

A row is wrong if its error is beyond the bound of its family, which is stated with it: the accuracy that the row's mesh allows.
``python -m tests.verification.verdicts`` prints the rows with their results, and the table of the page explanation/sanity.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.measure.penetrator import WATCH_EVERY
from hydro2d.solver.simulation import Simulation
from problems.verification.exact import impact, riemann
from problems.verification.exact.detonation import mader
from problems.verification.exact.elastic_plastic import ALUMINIUM, piston
from problems.verification.exact.noh import Noh
from tests.decks import body, box, entry, material, mesh, stop, table, walls
from tests.verification.running import ADVECTION, Line, between, crossing

Measure = Callable[[Simulation], float]


class Row(NamedTuple):
    """A run, the quantity measured, and the result.

    error : at the end, relative or in the unit given by the family;  bound : error from which the answer counts as wrong
    right : whether the answer is right;  missed : why the verdict is not as it should be, otherwise empty
    """

    family: str
    name: str
    text: str
    error: Measure
    bound: float
    right: bool = True
    missed: str = ""

    @property
    def trusted(self) -> bool:
        """The verdict of the run."""
        return self.right != bool(self.missed)


class Verdict(NamedTuple):
    """The error of a run, infinite if it did not reach its end, and the objections to it."""

    error: float
    said: tuple[str, ...]


def judged(row: Row) -> Verdict:
    """Runs a row to its end, and collects the faults that would end a run with the deck's own settings."""
    simulation = Simulation(decks.loads(row.text, ["numerics.clip_limit=1"]))
    said: list[str] = []
    try:
        while simulation.stop_reason() is None:
            simulation.step()
            if simulation.cycle % WATCH_EVERY == 0 and not said:
                said = simulation.faults()
        simulation.refuse_nonsense()
    except UnphysicalState as problem:
        return Verdict(math.inf, (str(problem),))
    return Verdict(abs(row.error(simulation)), (*(said or simulation.faults()), *simulation.doubts()))


# ------------------------------------------------------------------------------------------------------- parts of decks


def tube(cells: int, start: float, end: float, *edges: str, **others) -> str:
    """A mesh along z in which nothing depends on r, in m, and its walls."""
    size = (end - start) / cells
    return mesh((2 * size, 2), (start, end, cells), geometry="planar") + walls("r_max", *edges, **others)


def gas(name: str, low: float, high: float, rho: float, material: str = "gas_7_5", **keys) -> str:
    """A part of a tube that is filled with gas."""
    return box(name, material, z=[low, high], density=rho, **keys)


def numerics(choice: str, **keys) -> str:
    return table("numerics", advection=choice, **keys)


NO_FRACTURE = table("failure", tensile="none")

# ------------------------------------------------------------------------------------------------------- strong shocks

#: Sedov's blast of gamma 1.4 in gas of 1 kg/m^3: energy and radius at 1 s by dimension, for the plane on one side of it
#: (Kamm & Timmes, LA-UR-07-2849, 2007)
SEDOV = {1: (0.0673185, 0.5), 2: (0.311357, 0.75), 3: (0.851072, 1.0)}


def sedov(j: int, choice: str, cells: int | None = None) -> Row:
    """The radius of the shock, at half of the highest pressure, within 5 %."""
    energy, radius = SEDOV[j]
    name = ("plane", "cylindrical", "r-z")[j - 1]
    n, end = (30, 1.2) if j == 3 else (60, 1.4 * radius)
    n = cells or n
    size = end / n
    hot = 2.5 * size if j == 3 else 2 * size
    specific = energy / (hot, math.pi * hot**2, 4 / 3 * math.pi * hot**3)[j - 1]
    state = {"density": 1.0, "material": "gas_7_5"}
    if j == 1:
        text = tube(n, 0.0, end, "z_min") + box("hot", z=[0.0, hot], energy=specific, **state)
        cold = {"z": [0.0, end]}
    elif j == 2:
        text = mesh((end, n), (2 * size, 2)) + walls("z_min", "z_max")
        text += box("hot", r=[0.0, hot], z=[0.0, 2 * size], energy=specific, **state)
        cold = {"r": [0.0, end], "z": [0.0, 2 * size]}
    else:
        text = mesh((end, n), (end, n)) + walls("z_min")
        text += body("hot", shape="sphere", centre=0.0, radius=hot, energy=specific, **state)
        cold = {"r": [0.0, end], "z": [0.0, end]}
    text += box("cold", energy=1e-9, join="hot", **cold, **state) + numerics(choice) + stop(1.0)

    def error(simulation: Simulation) -> float:
        grid, ends = simulation.grid, []
        p = grid.interior(simulation.state.p)
        if j != 2:
            ends.append((grid.zc[grid.inside[0]], p[:, 0]))
        if j != 1:
            ends.append((grid.rc[grid.inside[1]], p[0]))
        radii = [crossing(x, line, 0.5 * line[x > 0.3 * radius].max()) for x, line in ends]
        return np.mean(radii) / (radius * simulation.time ** (2 / (j + 2))) - 1.0

    return Row("Sedov's blast", f"{name}, {choice}", text, error, 0.05)


def blast_energy(j: int) -> Row:
    """The blast by `momentum`: its energy, within 2 %."""
    row = sedov(j, "momentum")

    def error(simulation: Simulation) -> float:
        balance = simulation.conservation()
        depth = (2 * simulation.grid.dr[4], 2 * simulation.grid.dz[4], 0.5)[j - 1]  # of r-z one half
        return (balance["internal_energy_J"] + balance["kinetic_energy_J"]) / (SEDOV[j][0] * depth) - 1.0

    return row._replace(name=f"{row.name}, energy", error=error, bound=0.02)


def noh(j: int, choice: str, n: int = 60) -> Row:
    """The density behind the shock, away from the wall and from the front, within 4 %."""
    exact, name = Noh(j), ("plane", "cylindrical")[j - 1]
    size = 0.9 / n
    text = (mesh((0.9, n), (2 * size, 2), geometry="planar" if j == 1 else "cylindrical") + walls("z_min", "z_max")
            + box("gas", "gas_5_3", r=[0.0, 0.9], z=[0.0, 2 * size], density=1.0, energy=0.0, velocity=[-1.0, 0.0])
            + numerics(choice) + stop(0.6))

    def error(simulation: Simulation) -> float:
        line = Line(simulation, "r")
        return line.body("rho")[between(line.x, 0.05, exact.shock_speed * simulation.time, 0.2)].mean() / exact.rho - 1.0

    return Row("Noh's problem", f"{name}, {choice}", text, error, 0.04)


def streams(frame: float, choice: str) -> Row:
    """Two streams of gas meet in a tube, as in Noh's plane problem on both sides: the density between the shocks within 4 %."""
    exact, end = Noh(1), 0.6
    sides = [gas(side, *reach, 1.0, "gas_5_3", energy=0.0, velocity=frame + own, **more) for side, reach, own, more in (
        ("left", (-0.9, 0.0), 1.0, {}), ("right", (0.0, 0.9), -1.0, {"join": "left"}))]
    text = tube(round((1.8 + end * frame) / 0.015), -0.9, 0.9 + end * frame) + "".join(sides) + numerics(choice) + stop(end)

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        x = np.abs(line.x - frame * simulation.time)
        return line.body("rho")[between(x, 0.05, exact.shock_speed * simulation.time, 0.2)].mean() / exact.rho - 1.0

    return Row("Noh's problem", f"two streams, {frame:g} m/s more, {choice}", text, error, 0.04)


# ------------------------------------------------------------------------------------------------------- tubes of gas

RIEMANN = {
    "Sod's tube": (riemann.Gas(1.0, 0.0, 1.0, 1.4), riemann.Gas(0.125, 0.0, 0.1, 1.4), 0.2),
    "two rarefactions": (riemann.Gas(1.0, -1.0, 0.4, 1.4), riemann.Gas(1.0, 1.0, 0.4, 1.4), 0.15),
    "far apart": (riemann.Gas(1.0, -2.0, 0.4, 1.4), riemann.Gas(1.0, 2.0, 0.4, 1.4), 0.15),
    "a strong shock": (riemann.Gas(1.0, 0.0, 1000.0, 1.4), riemann.Gas(1.0, 0.0, 0.01, 1.4), 0.012),
}


def shock_tube(name: str, choice: str, cells: int = 100) -> Row:
    """The density everywhere: the mean of its error within 2 % of the greatest density."""
    left, right, time = RIEMANN[name]
    exact = riemann.solve(left, right)
    sides = [gas(side, *reach, each.rho, pressure=each.p, velocity=[0.0, each.u], **more) for side, reach, each, more in (
        ("left", (0.0, 0.5), left, {}), ("right", (0.5, 1.0), right, {"join": "left"}))]
    ends = () if left.u else ("z_min", "z_max")
    text = tube(cells, 0.0, 1.0, *ends) + "".join(sides) + numerics(choice) + stop(time)

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        rho, _, _ = exact.sample((line.x - 0.5) / simulation.time)
        return np.abs(line.body("rho") - rho).mean() / rho.max()

    return Row("tubes of gas", f"{name}, {choice}", text, error, 0.02)


def middle(choice: str) -> Row:
    """The energy in the middle of two rarefactions, where the gas is coldest, within a quarter."""
    row = shock_tube("far apart", choice)
    left, right, _ = RIEMANN["far apart"]
    exact = riemann.solve(left, right)

    def error(simulation: Simulation) -> float:
        e = Line(simulation).body("e")
        return e[len(e) // 2 - 1:len(e) // 2 + 1].mean() / (exact.p / 0.4 / exact.rho_left) - 1.0

    return row._replace(name=f"energy between two rarefactions, {choice}", error=error, bound=0.25)


def expansion(choice: str) -> Row:
    """Gas that expands into the void: its kinetic energy, by the fan u = 2 (x/t + c)/(gamma + 1), within 5 %."""
    time, c = 0.2, math.sqrt(1.4)
    y = np.linspace(-c, 5.0 * c, 20001)
    u = 2.0 / 2.4 * (y + c)
    rho = np.maximum(1.0 - 0.2 * u / c, 0.0) ** 5
    exact = np.trapezoid(0.5 * rho * u**2, y) * time
    text = tube(100, 0.0, 2.0, "z_min") + gas("gas", 0.0, 0.5, 1.0, pressure=1.0) + numerics(choice) + stop(time)

    def error(simulation: Simulation) -> float:
        energy = simulation.conservation()["kinetic_energy_J"] / (2 * simulation.grid.dr[4])
        return energy / (exact * simulation.time / time) - 1.0

    return Row("tubes of gas", f"into the void, {choice}", text, error, 0.05)


def limited(pressure: float = 2e7) -> Row:
    """The expansion next to tungsten, far away, which counts for the speed limit: the kinetic energy within 5 %."""
    rho, length = 1.2, 0.1
    c = math.sqrt(1.4 * pressure / rho)
    time = 0.3 * length / c
    y = np.linspace(-1.0, 5.0, 20001)
    u = 2.0 / 2.4 * (y + 1.0)
    share = np.trapezoid(0.5 * np.maximum(1.0 - 0.2 * u, 0.0) ** 5 * u**2, y)
    text = (tube(100, 0.0, 3 * length, "z_min") + gas("gas", 0.0, length, rho, pressure=pressure)
            + box("block", "W_alloy", z=[2.7 * length, 2.9 * length]) + stop(time))

    def error(simulation: Simulation) -> float:
        energy = simulation.conservation()["kinetic_energy_J"] / (2 * simulation.grid.dr[4])
        return energy / (share * rho * c**3 * simulation.time) - 1.0

    return Row("tubes of gas", "into the void, beside tungsten", text, error, 0.05)


# ------------------------------------------------------------------------------------- work of walls, pistons and sources


def pressed_gas(by: float, cells: int = 20) -> Row:
    """A piston feeds a tube of gas slowly: e = e0 (rho/rho0)^(gamma - 1), within 2 %."""
    speed = 0.05
    text = (tube(cells, 0.0, 1.0, "z_min", z_max="velocity", z_max_velocity=-speed)
            + gas("gas", 0.0, 2.0, 1.0, pressure=1.0) + stop(math.log(by) / speed))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        e, rho = line.body("e").mean(), line.body("rho").mean()
        return e / (2.5 * rho**0.4) - 1.0

    return Row("work of edges", f"gas pressed to {by:g} times its density", text, error, 0.02)


def pressed_gas_and_plug(by: float) -> Row:
    """A piston pushes steel into a tube of gas, slowly: the gas has e = e0 (rho/rho0)^(gamma - 1), within 5 %."""
    speed, length = 50.0, 0.1
    text = (tube(20, 0.0, 2 * length, "z_min", z_max="velocity", z_max_velocity=-speed)
            + gas("gas", 0.0, length, 1.2, pressure=1e5) + box("plug", "steel_4340", z=[length, 4 * length])
            + NO_FRACTURE + stop(length * (1.0 - 1.0 / by) / speed))

    def error(simulation: Simulation) -> float:
        e, rho = mean_state(simulation, 0)
        return e / (1e5 / 1.2 / 0.4 * (rho / 1.2) ** 0.4) - 1.0

    return Row("work of edges", f"gas that a plug presses to {by:g} times its density", text, error, 0.05)


def pressed_gases(by: float) -> Row:
    """A piston presses two gases slowly, of which one is a thousand times as dense: the light one's energy within 5 %."""
    speed, low, high = 40.0, 0.1, 100.0
    text = (tube(8, 0.0, 1.0, "z_min", z_max="velocity", z_max_velocity=-speed) + gas("light", 0.0, 0.5, low, pressure=1e5)
            + gas("heavy", 0.5, 2.0, high, pressure=1e5) + stop(math.log(by) / speed))

    def error(simulation: Simulation) -> float:
        e, rho = mean_state(simulation, 0)
        return e / (1e5 / low / 0.4 * (rho / low) ** 0.4) - 1.0

    return Row("work of edges", f"light gas beside heavy gas, {by:g} times as much in the tube", text, error, 0.05)


def mean_state(simulation: Simulation, m: int) -> tuple[float, float]:
    """Energy, J/kg, and density of a body in a tube as a whole."""
    g, s = simulation.grid, simulation.state
    share = g.interior(s.vof[m])
    mass = share * g.interior(s.rho[m])
    return float(np.sum(mass * g.interior(s.e[m])) / mass.sum()), float(mass.sum() / share.sum())


#: steel that does not yield: kg/m^3, m/s, -, -, Pa
STEEL = impact.Solid(7850.0, 4570.0, 1.49, 1.93)
SHEAR = 80e9
LONGITUDINAL = math.sqrt(STEEL.c0**2 + 4.0 / 3.0 * SHEAR / STEEL.rho0)


def elastic(name: str = "elastic", yield_stress: str = "50 GPa") -> str:
    """This steel as a material of a deck."""
    return table(f"materials.{name}", eos={
        "model": "mie-grueneisen", "reference_density": "7850 kg/m^3", "sound_speed": "4570 m/s", "hugoniot_slope": 1.49,
        "grueneisen": 1.93, "specific_heat": "450 J/kg/K"}, strength={
        "model": "elastic-plastic", "shear_modulus": "80 GPa", "yield_stress": yield_stress})


def strained(strain: float) -> float:
    """Energy of this steel at a strain ln(rho/rho0) in one direction, J/kg: de = (p + 4/3 G strain) d(strain)/rho."""
    e, n = 0.0, 2000
    for k in range(n):
        now = strain * (k + 0.5) / n
        rho = STEEL.rho0 * math.exp(now)
        e += strain / n * (STEEL.pressure(rho, e) + 4.0 / 3.0 * SHEAR * now) / rho
    return e


def pressed_bar(strain: float) -> Row:
    """Steel that does not yield between a wall and a piston: its energy within 2 %."""
    length, speed = 20e-3, 20.0
    ramp = 10e-6
    end = strain * length / speed + 0.5 * ramp
    text = (tube(20, 0.0, length, "z_min", z_max="piston", z_max_piston=[[0.0, 0.0], [ramp, -speed], [1.0, -speed]])
            + box("bar", "elastic", z=[0.0, "60 mm"]) + elastic() + NO_FRACTURE + stop(end))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        return line.body("e").mean() / strained(math.log(line.body("rho").mean() / STEEL.rho0)) - 1.0

    return Row("work of edges", f"an elastic bar pressed by {strain:g}", text, error, 0.02)


def heated(where: str, energy: float) -> Row:
    """Gas at rest that a source heats at once: everywhere in a closed tube the energy in every cell, within 1 %.

    In the first cells before a wall, Sedov's plane blast: the radius of the shock within 5 %.
    """
    blast, radius = SEDOV[1]
    size = 0.7 / 60
    if where == "everywhere":
        reach, given, pulse, end = [0.0, 0.7], energy, 0.1, 0.2
    else:
        reach, given, pulse, end = [0.0, 2 * size], blast / (2 * size), 1e-4, 1.0
    text = (tube(60, 0.0, 0.7, "z_min", "z_max") + gas("gas", 0.0, 0.7, 1.0, energy=1.0 if where == "everywhere" else 1e-9)
            + entry("source", name="beam", kind="heating", body="gas", z=reach,
                    power=[[0.0, given / pulse], [pulse, given / pulse]])
            + stop(end))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        if where == "everywhere":
            return np.abs(line.body("e") / (1.0 + energy) - 1.0).max()
        peak = line.pressure[line.x > 0.3 * radius].max()
        return crossing(line.x, line.pressure, 0.5 * peak) / radius - 1.0

    return Row("sources", f"gas heated {where}, {given:.3g} J/kg", text, error, 0.01 if where == "everywhere" else 0.05)


def heated_neighbour(times: float, low: float) -> Row:
    """A gas that is heated presses another one in a closed tube: the other's energy, on its isentrope, within 5 %.

    So slowly that the heat E grows by a factor of e in the time in which sound crosses half of the tube ten times:
    dE/dt = E c/(5 m), with the solution E = E0/(1 - t/T)^2.
    """
    first = 1.0 / 0.4
    whole = 2.0 * 5.0 / math.sqrt(1.4)
    end = whole * (1.0 - times**-0.5)
    power = [[t, 2.0 * first / whole / (1.0 - t / whole) ** 3] for t in np.linspace(0.0, end, 80).tolist()]
    text = (tube(50, 0.0, 1.0, "z_min", "z_max") + gas("gas", 0.0, 0.5, 1.0, pressure=1.0)
            + gas("other", 0.5, 1.0, low, pressure=1.0)
            + entry("source", name="beam", kind="heating", body="gas", power=power) + stop(end))

    def error(simulation: Simulation) -> float:
        e, rho = mean_state(simulation, 1)
        return e / (1.0 / 0.4 / low * (rho / low) ** 0.4) - 1.0

    return Row("sources", f"gas of {low:g} kg/m^3 pressed by one that is heated {times:g} times", text, error, 0.05)


def accelerated(rate: float, cells: int = 40) -> Row:
    """A plate in a field of force has a velocity of a t, within 1e-3."""
    text = (tube(cells, 0.0, 40e-3) + box("plate", "Al5083", z=["5 mm", "15 mm"])
            + entry("source", name="field", kind="acceleration", body="plate", axial=f"{rate:g} m/s^2") + stop("20 us"))
    return Row("sources", f"a plate accelerated by {rate:g} m/s^2", text,
               lambda simulation: (simulation.mean_velocity(0) or 0.0) / (rate * simulation.time) - 1.0, 1e-3)


# ------------------------------------------------------------------------------------------------- solids at rest, in flight


def at_rest(temperature: float) -> Row:
    """A bar that is warm and free stays at rest: its kinetic energy within 1e-6 of its heat."""
    text = (mesh(("6 mm", 12), ("24 mm", 48)) + box("bar", "copper", r=[0.0, "3 mm"], z=["6 mm", "18 mm"],
                                                  temperature=f"{temperature} K")
            + material("copper", "copper_OFHC", variant="johnson-cook") + NO_FRACTURE + stop("3 us"))
    heat = 383.0 * abs(temperature - 298.0)

    def error(simulation: Simulation) -> float:
        mass = simulation.audit.start.mass[0] * 2 * math.pi
        return simulation.conservation()["kinetic_energy_J"] / (mass * max(heat, 1.0))

    return Row("at rest and in flight", f"a bar of {temperature:g} K at rest", text, error, 1e-6)


def in_flight(thickness: float, speed: float, choice: str = "both") -> Row:
    """A plate of so many cells of 0.1 mm flies over ten cells, in the void: the place of its mass within a tenth of a cell."""
    end = 1e-3 / max(speed, 300.0)
    low = 1.03e-3
    text = (mesh(("0.4 mm", 4), ("4 mm", 40)) + walls("r_max")
            + box("plate", "Al5083", z=[low, low + thickness * 1e-4], velocity=speed) + numerics(choice) + NO_FRACTURE
            + stop(end))

    def error(simulation: Simulation) -> float:
        s, g = simulation.state, simulation.grid
        mass = g.interior(s.vof[0] * s.rho[0] * g.volume)
        place = g.zc[g.inside[0]][:, None] + g.interior(s.centroid_z)[0] * g.dz[g.inside[0]][:, None]
        return ((mass * place).sum() / mass.sum() - low - 0.5e-4 * thickness - speed * simulation.time) / 1e-4

    return Row("at rest and in flight", f"a plate of {thickness:g} cells at {speed:g} m/s, {choice}", text, error, 0.1)


# --------------------------------------------------------------------------------------------------------- plane impact


def plane_impact(speed: float, frame: float, choice: str = "both", geometry: str = "planar", cells: int = 120) -> Row:
    """Aluminium on itself without strength, all of it faster by `frame`: the pressure behind the shocks within 2 %."""
    exact = impact.impact(impact.AL_5083, impact.AL_5083, speed)
    time = 0.35e-6
    text = (mesh(("0.2 mm", 4), ("-3 mm", "6 mm", 2 * cells), geometry=geometry) + walls("r_max")
            + box("flyer", "fluid", z=["-2.5 mm", 0.0], velocity=speed + frame)
            + box("target", "fluid", z=[0.0, "2.5 mm"], velocity=frame)
            + material("fluid", "Al5083", strength={"model": "hydrodynamic"}) + numerics(choice) + NO_FRACTURE + stop(time))

    def error(simulation: Simulation) -> float:
        line, time = Line(simulation), simulation.time
        middle = (exact.u + frame) * time
        half = (exact.target.speed - exact.u) * time
        return line.pressure[between(line.x, middle - half, middle + half, 0.2)].mean() / exact.p - 1.0

    return Row("plane impact", f"{speed:g} m/s, {frame:g} m/s more, {choice}, {geometry}", text, error, 0.02)


def precursor(choice: str, speed: float = 400.0, cells: int = 100) -> Row:
    """Wilkins' aluminium before a piston: the stress behind the plastic shock within 2 %."""
    exact = piston(*ALUMINIUM, speed)
    time = 2e-6
    text = (tube(cells, 0.0, 15e-3, z_min="velocity", z_min_velocity=speed) + box("bar", "aluminium", z=["-5 mm", "30 mm"])
            + table("materials.aluminium", eos={
                "model": "mie-grueneisen", "reference_density": "2785 kg/m^3", "sound_speed": "5328 m/s",
                "hugoniot_slope": 1.338, "grueneisen": 2.0, "specific_heat": "863 J/kg/K"}, strength={
                "model": "elastic-plastic", "shear_modulus": "27.6 GPa", "yield_stress": "0.3 GPa"})
            + numerics(choice) + NO_FRACTURE + stop(time))

    def error(simulation: Simulation) -> float:
        line, time = Line(simulation), simulation.time
        return line.axial_stress[between(line.x, speed * time, exact.plastic.speed * time)].mean() / exact.plastic.sigma - 1.0

    return Row("elastic waves", f"precursor and plastic shock, {choice}", text, error, 0.02)


def rebound(speed: float, choice: str = "both", cells: int = 120) -> Row:
    """A slab of steel that does not yield leaves an anvil as fast as it came, within 5 %."""
    text = (tube(cells, 0.0, 30e-3, z_min="anvil") + box("slab", "elastic", z=[0.0, "20 mm"], velocity=-speed) + elastic()
            + numerics(choice) + NO_FRACTURE + stop(1.3 * 40e-3 / LONGITUDINAL))
    return Row("elastic waves", f"a slab rebounds at {speed:g} m/s, {cells} cells, {choice}", text,
               lambda simulation: (simulation.mean_velocity(0) or 0.0) / speed - 1.0, 0.05)


def ball(speed: float, cells: int = 8) -> Row:
    """A ball of steel that does not yield leaves an anvil as fast as it came, except for 1 % left as vibration, within 5 %.

    cells : across the radius
    """
    text = (mesh(("6 mm", 3 * cells // 2), ("12 mm", 3 * cells)) + table("boundaries", z_min="anvil")
            + body("ball", "elastic", "sphere", centre="4.0 mm", radius="4 mm", velocity=-speed) + elastic()
            + NO_FRACTURE + stop("60 us"))
    return Row("elastic waves", f"a ball meets an anvil at {speed:g} m/s", text,
               lambda simulation: (simulation.mean_velocity(0) or 0.0) / speed - 1.0, 0.05)


# --------------------------------------------------------------------------------------------------- gas between metals


def crushed(speed: float, gamma: float, rho: float, until: float) -> float:
    """Energy of a film of gas that two plates crush to a pressure, J/kg: by successive shocks, each of which stops it."""
    p, e = 1e5, 1e5 / rho / (gamma - 1.0)
    while p < until:
        c2, half = gamma * p / rho, 0.25 * (gamma + 1.0) * speed
        shock = half + math.sqrt(half**2 + c2)
        behind = p + rho * shock * speed
        e, p, rho = e + 0.5 * speed**2 + p * speed / (rho * shock), behind, rho * shock / (shock - speed)
    return e * (until / p) ** ((gamma - 1.0) / gamma)


def film(speed: float, gap: float, time: str, frame: float = 0.0, geometry: str = "planar") -> Row:
    """Air before a flyer of aluminium, or crushed between it and a plate: its mean energy within a factor of 1.5."""
    gamma = 1.4
    text = (mesh(("1 mm", 4), ("-6 mm", "12 mm", "0.25 mm"), geometry=geometry) + walls("r_max")
            + box("flyer", "Al5083", z=["-5.9 mm", f"{0.1 - gap} mm"], velocity=speed + frame)
            + box("plate", "Al5083", z=["0.1 mm", "6.1 mm"], velocity=frame)
            + box("air", "air", z=[f"{0.1 - gap} mm", "0.1 mm"], pressure="0.1 MPa", velocity=frame)
            + table("materials.air", eos={"model": "ideal-gas", "adiabatic_index": gamma, "reference_density": "1.2 kg/m^3"})
            + stop(time))
    first = 1e5 / 1.2 / (gamma - 1.0)
    half = 0.25 * (gamma + 1.0) * speed
    shock = half + math.sqrt(half**2 + gamma * 1e5 / 1.2)

    def error(simulation: Simulation) -> float:
        mass = simulation.audit.start.mass[2]
        masses = simulation.grid.interior(simulation.state.vof[2] * simulation.state.rho[2] * simulation.state.e[2]
                                          * simulation.grid.volume).sum() / mass
        if shock * simulation.time < gap * 1e-3:
            passed = shock * simulation.time / (gap * 1e-3)
            exact = first + passed * (0.5 * speed**2 + 1e5 * speed / (1.2 * shock))
        else:
            exact = crushed(speed, gamma, 1.2, impact.impact(impact.AL_5083, impact.AL_5083, speed).p)
        return math.exp(abs(math.log(masses / exact))) - 1.0

    return Row("gas beside metal", f"{gap:g} mm of air before a flyer, {speed:g} m/s, {time}, {frame:g} m/s more, {geometry}",
               text, error, 0.5)


# --------------------------------------------------------------------------------------------------------- explosives

CHARGE = table("materials.charge", eos={
    "model": "jwl", "reference_density": "1875 kg/m^3", "A": "1 Pa", "B": "1 Pa", "R1": 1.0, "R2": 1.0, "omega": 2.0,
    "detonation_energy": "7.5 GPa", "detonation_velocity": "8000 m/s", "cj_pressure": "30 GPa"})


def fuse(size: float, columns: int, z: float = 0.0) -> str:
    return entry("source", name="fuse", kind="detonation", body="charge",
                 points=[[(column + 0.5) * size, z, 0.0] for column in range(columns)])


def detonation(choice: str, cells: int = 200) -> Row:
    """Products of gamma = 3, lit at a wall: the pressure near the front within 2 %."""
    length = 50e-3
    text = (tube(cells, 0.0, length, "z_min", "z_max") + box("charge", "charge", z=[0.0, length]) + CHARGE
            + fuse(length / cells, 2) + numerics(choice) + stop("5.5 us"))

    def error(simulation: Simulation) -> float:
        line, front = Line(simulation), 8000.0 * simulation.time
        near = (line.x > 0.92 * front) & (line.x < 0.96 * front)
        return (line.pressure[near] / mader(line.x[near], simulation.time)[2]).mean() - 1.0

    return Row("explosives", f"detonation, {choice}", text, error, 0.02)


def driven(plate_mass: float, start: float, time: float) -> tuple[float, float]:
    """(velocity, place) of a rigid plate of so many kg/m^2 driven by a charge of gamma = 3, lit a length `start` from it.

    Along u + c = x/t the flow is that of the incoming wave, so that at the plate c = x/t - v and p = P_CJ (c/(3 D/4))^3 (Aziz,
    Hurwitz & Sternberg, Physics of Fluids 4 (1961) 380), while x/t is above D/2.
    """
    speed, cj = 8000.0, 30e9
    now, x, v = start / speed, start, 0.0
    n = 20000
    dt = (time - now) / n
    for _ in range(n):
        push = [0.0, 0.0]
        for k, (at, place, rate) in enumerate(((now, x, v), (now + 0.5 * dt, x + 0.5 * dt * v, 0.0))):
            rate = v if k == 0 else v + 0.5 * dt * push[0]
            push[k] = cj * ((place / at - rate) / (0.75 * speed)) ** 3 / plate_mass
        x, v, now = x + dt * (v + 0.5 * dt * push[0]), v + dt * push[1], now + dt
    assert x / now > 0.5 * speed
    return v, x


def plate_push(thickness: float, cells_per_mm: float, choice: str = "both") -> Row:
    """A charge of 25 mm, lit at a wall, drives a plate of copper: its velocity within 3 %."""
    length, time = 25e-3, 6e-6
    size = 1e-3 / cells_per_mm
    text = (tube(round(60 * cells_per_mm), 0.0, 60e-3, "z_min") + box("charge", "charge", z=[0.0, length])
            + box("plate", "copper_OFHC", z=[length, length + thickness * 1e-3]) + CHARGE + fuse(size, 2) + numerics(choice)
            + NO_FRACTURE + stop(time))

    def error(simulation: Simulation) -> float:
        exact, _ = driven(8930.0 * thickness * 1e-3, length, simulation.time)
        return (simulation.mean_velocity(1) or 0.0) / exact - 1.0

    return Row("explosives", f"a plate of {thickness:g} mm on cells of {1 / cells_per_mm:g} mm, {choice}", text, error, 0.03)


# --------------------------------------------------------------------------------------------------------- open edges


def leaves(what: str) -> Row:
    """A bar of 4 mm leaves through an open edge at 1 km/s, half of it by the end: its mass within 1 %."""
    time = 3e-6
    text = (tube(60, 0.0, 6e-3) + box("bar", what, z=["1 mm", "5 mm"], velocity=1000.0) + NO_FRACTURE + stop(time))

    def error(simulation: Simulation) -> float:
        left = simulation.body_sums(0)[0].sum() / simulation.audit.start.mass[0]
        return left / ((5e-3 - 1000.0 * simulation.time) / 4e-3) - 1.0

    return Row("open edges", f"a bar of {what} leaves", text, error, 0.01)


def gas_leaves(choice: str) -> Row:
    """Gas flows out through an open edge at twice its speed of sound: the remaining mass within 1 %."""
    time = 0.2
    text = (tube(50, 0.0, 1.0) + gas("gas", 0.0, 1.0, 1.0, pressure=1.0 / 1.4, velocity=2.0)
            + numerics(choice) + stop(time))

    def error(simulation: Simulation) -> float:
        left = simulation.body_sums(0)[0].sum() / simulation.audit.start.mass[0]
        return left / (1.0 - 2.0 * simulation.time) - 1.0

    return Row("open edges", f"a stream of gas, {choice}", text, error, 0.01)


# --------------------------------------------------------------------------------------------------------- the rows

#: why a verdict is not as it should be
MESH = "the error is that of the mesh and falls with its cells, which no bound on an energy shows"
DISCARDS = "`momentum` has discarded 2 to 10 % of the energy, of which 2 % are allowed, and is within its bound"
GAINS = "`ke` gains momentum where the shock is: along r without a total of it, along z booked but not judged"
THIN = ("what the speed limit takes of the first, thin cells of a front is 0.4 % of the energy, but it dams up what follows; "
        "a share of the energy that rests says nothing of the motion")
LOST = "the course of a gas that weighs next to nothing is off by more than a tenth of a cell, while its energy is right"
WEAK = "what `momentum` discards, 1.4 % of an energy that is chemical for the most part, is missing in the front alone"
TOUCHES = ("an elastic energy of 44 v^2/2 passes through the cell that touches first, and what the viscosity keeps of it, 4 K, "
           "is more than the deck can reach; the cell does not know what it has borne")


def wrong(row: Row, missed: str = "") -> Row:
    """A row whose answer is wrong, and why it is trusted, if it is."""
    return row._replace(right=False, missed=missed)


ROWS = [
    sedov(1, "ke"), sedov(1, "both"), sedov(2, "ke"), sedov(2, "both"), sedov(3, "ke"),
    sedov(3, "both"), *(wrong(blast_energy(j)) for j in (1, 2, 3)),
    wrong(noh(1, "ke"), GAINS), wrong(noh(1, "momentum")), noh(1, "both"), wrong(noh(2, "ke"), GAINS),
    noh(2, "momentum")._replace(missed=DISCARDS), wrong(noh(2, "both"), MESH), wrong(streams(0.0, "momentum")),
    streams(3.0, "momentum")._replace(missed=DISCARDS), *(streams(frame, "both") for frame in (0.0, 3.0)),
    *(wrong(streams(frame, "ke"), GAINS) for frame in (0.0, 3.0)),
    *(shock_tube(name, choice) for name, choice in itertools.product(("Sod's tube", "two rarefactions"), ADVECTION)),
    wrong(shock_tube("a strong shock", "ke"), GAINS), shock_tube("a strong shock", "momentum"),
    shock_tube("a strong shock", "both"), middle("ke"), middle("momentum"), middle("both"),
    *(expansion(choice) for choice in ADVECTION), wrong(limited(), THIN),
    *(pressed_gas(by) for by in (1.5, 3.0, 10.0)), pressed_gas_and_plug(1.5), pressed_gases(10.0),
    *(pressed_bar(strain) for strain in (0.005, 0.02)),
    heated("everywhere", 10.0), heated("everywhere", 100.0), heated("in two cells", 0.0),
    heated_neighbour(10.0, 0.05), heated_neighbour(50.0, 1.0), accelerated(1e6), accelerated(1e8),
    at_rest(298.0), at_rest(718.0), in_flight(10.0, 0.0), in_flight(10.0, 3000.0), in_flight(0.9, 3000.0),
    *(in_flight(0.3, 1000.0, choice) for choice in ADVECTION),
    *(plane_impact(1000.0, frame) for frame in (0.0, 1000.0, 3000.0)),
    *(plane_impact(1000.0, frame, geometry="cylindrical") for frame in (0.0, 3000.0)),
    *(precursor(choice) for choice in ADVECTION), rebound(20.0), rebound(200.0), wrong(rebound(20.0, cells=60), MESH),
    ball(20.0)._replace(missed=TOUCHES), wrong(ball(100.0)),
    wrong(film(1000.0, 1.0, "0.45 us"), MESH), film(1000.0, 3.0, "2 us"), film(1000.0, 2.0, "1.3 us"),
    *(each._replace(missed=LOST) for each in (film(1000.0, 1.0, "1.2 us", 0.0), film(300.0, 1.0, "3.6 us"))),
    *(film(1000.0, 1.0, "1.2 us", frame) for frame in (1000.0, 3000.0)), film(1000.0, 1.0, "1.2 us", 3000.0, "cylindrical"),
    detonation("ke"), wrong(detonation("momentum"), WEAK), detonation("both"),
    plate_push(4.0, 4.0), plate_push(4.0, 1.0), wrong(plate_push(0.4, 1.0)), plate_push(4.0, 4.0, "momentum"),
    leaves("Al5083"), leaves("W_alloy"), gas_leaves("both"), gas_leaves("momentum"),
]


def table_of(rows: list[Row]) -> str:
    """The rows by family, as Markdown: how many are right or wrong, and trusted or not."""
    lines = ["| family | runs | right and trusted | right but not trusted | wrong and caught | wrong and trusted |",
             "|---|---|---|---|---|---|"]
    for family in [*dict.fromkeys(row.family for row in rows), "all"]:
        own = [row for row in rows if family in (row.family, "all")]
        counts = [sum((row.right, row.trusted) == kind for row in own)
                  for kind in ((True, True), (True, False), (False, False), (False, True))]
        lines.append(f"| {' | '.join(map(str, (family, len(own), *counts)))} |")
    return "\n".join(lines) + "\n"


def print_results(rows: list[Row]) -> None:
    """The rows with their results, and their table."""
    for row in rows:
        found = judged(row)
        verdict = "not trusted" if found.said else "trusted"
        print(f"| {row.family} | {row.name} | {found.error:.2g} | {row.bound:g} | {verdict} |", flush=True)
    print(table_of(rows))


if __name__ == "__main__":
    print_results(ROWS)
