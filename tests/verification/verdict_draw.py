"""Runs drawn before any of them had run, of kinds that users do: 60 whose answer should be right, 30 whose answer should not.

Each has an exact answer and a bound, as in `verdicts`. A row is declared as it came out, not as it was drawn.
Edges of the gases and the places where plates are read were corrected after the first run (explanation/sanity).
``python -m tests.verification.verdict_draw`` prints them with their results, and the table of the page explanation/sanity.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from hydro2d.solver.simulation import Simulation
from problems.verification.exact import impact, oblique, riemann
from problems.verification.exact.collapse import Collapse
from problems.verification.exact.escape import Escape
from problems.verification.exact.gun import Gun
from problems.verification.exact.impact import AL_5083, TUNGSTEN, Solid
from problems.verification.exact.noh import Noh
from problems.verification.exact.noh_solid import NohSolid
from tests.decks import body, box, contact, material, mesh, stop, table, walls
from tests.verification.running import Line, between, crossing
from tests.verification.verdicts import (
    CHARGE,
    DISCARDS,
    GAINS,
    LONGITUDINAL,
    MESH,
    NO_FRACTURE,
    STEEL,
    THIN,
    Row,
    ball,
    elastic,
    fuse,
    gas,
    in_flight,
    limited,
    mean_state,
    noh,
    numerics,
    plate_push,
    precursor,
    print_results,
    sedov,
    shock_tube,
    tube,
    wrong,
)

COPPER = Solid(8930.0, 3940.0, 1.489, 2.02)
WATER = Solid(998.0, 1483.0, 1.75, 0.5)
PLASTIC = Solid(1186.0, 2600.0, 1.52, 1.0)
NAMES = {AL_5083: "aluminium", TUNGSTEN: "tungsten", COPPER: "copper", WATER: "water", PLASTIC: "plastic"}


def fluid(solid: Solid, name: str = "") -> str:
    """A solid or a liquid without strength as a material of a deck."""
    return table(f"materials.{name or NAMES[solid]}", eos={
        "model": "mie-grueneisen", "reference_density": solid.rho0, "sound_speed": solid.c0, "hugoniot_slope": solid.s,
        "grueneisen": solid.gamma0, "specific_heat": 900.0}, strength={"model": "hydrodynamic"})


def ideal(name: str, gamma: float) -> str:
    """A gas as a material of a deck."""
    return table(f"materials.{name}", eos={"model": "ideal-gas", "adiabatic_index": gamma, "reference_density": 1.0})


# ------------------------------------------------------------------------------------------------------- shocks of metals


def collide(flyer: Solid, target: Solid, speed: float, choice: str = "both", what: str = "pressure", cells: int = 100,
            hard: bool = False, **keys) -> Row:
    """Two bodies without strength meet: pressure within 2 %, greatest pressure or energy of the target within 10 %."""
    exact, length = impact.impact(flyer, target, speed), 5e-3
    time = 0.5 * length / max(exact.target.speed, exact.flyer.speed - speed, speed)
    materials = "".join(fluid(each) for each in dict.fromkeys((flyer, target)))
    text = (tube(2 * cells, -length, length) + box("flyer", NAMES[flyer], z=[-0.8 * length, 0.0], velocity=speed)
            + box("target", NAMES[target], z=[0.0, 0.8 * length]) + materials + numerics(choice, **keys)
            + (contact("flyer") if hard else "") + NO_FRACTURE + stop(time))

    def error(simulation: Simulation) -> float:
        line, time = Line(simulation), simulation.time
        inner = between(line.x, (speed - exact.flyer.speed) * time, exact.target.speed * time, 0.2)
        if what == "greatest pressure":
            return line.pressure.max() / exact.p - 1.0
        if what == "energy":
            heated = between(line.x, exact.u * time, exact.target.speed * time, 0.2)
            return line.body("e", 1)[heated].mean() / exact.target.e - 1.0
        return line.pressure[inner].mean() / exact.p - 1.0

    changed = "".join(f", {key} {value:g}" for key, value in keys.items())
    name = (f"{NAMES[flyer]} on {NAMES[target]}, {speed:g} m/s, {choice}, {cells} cells{', contact' if hard else ''}{changed}: "
            f"{what}")
    return Row("shocks of metals and liquids", name, text, error, 0.02 if what == "pressure" else 0.1)


def interface_energy(speed: float) -> Row:
    """The energy of the first cell of the target next to the flyer, within 10 %: the start of a shock overheats it."""
    row = collide(AL_5083, AL_5083, speed)
    exact = impact.impact(AL_5083, AL_5083, speed)

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        first = np.nonzero(line.body("vof", 1) > 0.999)[0][0]
        return line.body("e", 1)[first] / exact.target.e - 1.0

    return row._replace(name=f"aluminium on aluminium, {speed:g} m/s: energy at the interface", error=error, bound=0.1)


class Tillotson(NamedTuple):
    """Constants of the compressed state: kg/m^3, -, -, Pa, Pa, J/kg (Melosh, Impact Cratering (1989), appendix II)."""

    rho0: float
    a: float
    b: float
    bulk: float
    second: float
    energy: float

    def shock(self, u: float) -> tuple[float, float]:
        """Pressure and speed of the shock that sets the metal moving at u: p = rho0 U u, e = u^2/2."""

        def pressure(rho: float) -> float:
            x, e = rho / self.rho0, 0.5 * u**2
            heat = (self.a + self.b / (e / (self.energy * x**2) + 1.0)) * rho * e
            return heat + self.bulk * (x - 1.0) + self.second * (x - 1.0) ** 2

        def jump(rho: float) -> float:
            return self.rho0 * u**2 * rho / (rho - self.rho0)

        rho = brentq(lambda rho: pressure(rho) - jump(rho), 1.001 * self.rho0, 5.0 * self.rho0)
        return pressure(rho), u * rho / (rho - self.rho0)


TILLOTSON = {"Al_tillotson": Tillotson(2700.0, 0.5, 1.63, 75.2e9, 65e9, 5e6),
             "Fe_tillotson": Tillotson(7800.0, 0.5, 1.5, 128e9, 105e9, 9.5e6),
             "Cu_tillotson": Tillotson(8900.0, 0.5, 1.5, 139e9, 110e9, 32.5e6)}


def vaporising(what: str, speed: float, choice: str = "both") -> Row:
    """A metal of Tillotson's on itself: the pressure within 2 %."""
    p, shock = TILLOTSON[what].shock(0.5 * speed)
    length = 5e-3
    text = (tube(200, -length, length) + box("flyer", what, z=[-0.8 * length, 0.0], velocity=speed)
            + box("target", what, z=[0.0, 0.8 * length]) + numerics(choice) + NO_FRACTURE
            + stop(0.5 * length / max(shock, speed)))

    def error(simulation: Simulation) -> float:
        line, time = Line(simulation), simulation.time
        return line.pressure[between(line.x, (speed - shock) * time, shock * time, 0.2)].mean() / p - 1.0

    return Row("shocks of metals and liquids", f"{what} on itself, {speed:g} m/s, {choice}", text, error, 0.02)


def free_surface(solid: Solid, speed: float, cells: int = 40) -> Row:
    """The velocity of the rear of a plate that its own metal has hit, within 3 %; cells : across the plate"""
    exact, thick = impact.impact(solid, solid, speed), 2e-3
    arrives, gained = thick / exact.target.speed, impact.free_surface_velocity(solid, exact.target)
    size = thick / cells
    text = (tube(6 * cells, -3 * thick, 3 * thick) + box("flyer", NAMES[solid], z=[-2.5 * thick, 0.0], velocity=speed)
            + box("target", NAMES[solid], z=[0.0, thick]) + fluid(solid) + NO_FRACTURE + stop(1.5 * arrives))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        rear = thick + gained * (simulation.time - arrives)
        near = (line.xv > rear - 0.2 * thick) & (line.xv < rear - size)
        return line.velocity[near].mean() / gained - 1.0

    return Row("shocks of metals and liquids", f"rear of {NAMES[solid]} after {speed:g} m/s, {cells} cells", text, error, 0.03)


def water_hammer(speed: float, choice: str, cells: int = 100) -> Row:
    """A column of water stops at a wall: the pressure rho (c + s u) u within 2 %."""
    exact = impact.shock(WATER, speed)
    text = (tube(cells, 0.0, 1.0, "z_min") + box("column", "water", z=[0.0, 0.9], velocity=-speed) + fluid(WATER)
            + numerics(choice) + NO_FRACTURE + stop(0.5 / exact.speed))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        return line.pressure[between(line.x, 0.0, (exact.speed - speed) * simulation.time, 0.2)].mean() / exact.p - 1.0

    return Row("shocks of metals and liquids", f"water hammer, {speed:g} m/s, {choice}", text, error, 0.02)


def noh_metal(j: int, speed: float, choice: str = "both") -> Row:
    """Noh's problem of copper: the pressure behind the shock within 4 %."""
    exact, n, end = NohSolid(j, COPPER, speed), 60, 20e-3
    time = 0.25 * end / exact.shock_speed
    size = end / n
    flow = {"velocity": [-speed, 0.0]} if j == 1 else {"flow": {"pattern": "cylindrical", "speed": -speed}}
    text = (mesh((end, n), (2 * size, 2), geometry="planar" if j == 1 else "cylindrical") + walls("z_min", "z_max")
            + box("metal", "copper", r=[0.0, end], z=[0.0, 2 * size], **flow) + fluid(COPPER) + numerics(choice) + NO_FRACTURE
            + stop(time))

    def error(simulation: Simulation) -> float:
        line = Line(simulation, "r")
        inner = between(line.x, 0.0, exact.shock_speed * simulation.time, 0.2)
        return line.pressure[inner].mean() / exact.behind[1] - 1.0

    return Row("shocks of metals and liquids", f"Noh's problem of copper, j = {j}, {speed:g} m/s, {choice}", text, error, 0.04)


# ------------------------------------------------------------------------------------------------------------------ gases


def two_fluids(name: str, left: riemann.Gas, right: riemann.Gas, time: float, choice: str = "both", cells: int = 100) -> Row:
    """The Riemann problem of two fluids, a liquid if it has p_inf: the mean error of the density within 2 % of the greatest."""
    exact = riemann.solve(left, right)
    text = tube(cells, 0.0, 1.0, z_min="transmit", z_max="transmit")
    for side, reach, each in (("left", [0.0, 0.5], left), ("right", [0.5, 1.0], right)):
        text += gas(side, *reach, each.rho, side, pressure=each.p, velocity=[0.0, each.u])
        text += ideal(side, each.gamma) if each.p_inf == 0.0 else table(f"materials.{side}", eos={
            "model": "noble-abel-stiffened-gas", "reference_density": each.rho, "covolume": 0.0, "specific_heat": 1000.0,
            "adiabatic_index": each.gamma, "sound_speed": math.sqrt(each.gamma * each.p_inf / each.rho)})
    text += numerics(choice) + NO_FRACTURE + stop(time)

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        rho, _, _ = exact.sample((line.x - 0.5) / simulation.time)
        density = np.sum([line.body("vof", m) * line.body("rho", m) for m in (0, 1)], axis=0)
        return np.abs(density - rho).mean() / rho.max()

    return Row("gases", f"{name}, {choice}, {cells} cells", text, error, 0.02)


def against_a_wall(gamma: float, speed: float, choice: str, what: str = "pressure", cells: int = 100) -> Row:
    """Gas of 1 kg/m^3 and 1 Pa runs against a wall: the pressure behind its shock within 3 %, energy of the first cell 10 %."""
    first = riemann.Gas(1.0, 0.0, 1.0, gamma)
    p = brentq(lambda p: first.velocity_change(p) - speed, 1.0, 10.0 * (1.0 + speed) ** 2 * (gamma + 1.0))
    rho = first.density_behind(p)
    shock = speed / (rho - 1.0)
    text = (tube(cells, 0.0, 1.0, "z_min", z_max="velocity", z_max_velocity=-speed)
            + gas("gas", 0.0, 2.0, 1.0, "own", pressure=1.0, velocity=-speed) + ideal("own", gamma) + numerics(choice)
            + stop(0.4 / shock))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        if what == "energy at the wall":
            return line.body("e")[0] / (p / (gamma - 1.0) / rho) - 1.0
        return line.pressure[between(line.x, 0.0, shock * simulation.time, 0.2)].mean() / p - 1.0

    mach = speed / first.c
    return Row("gases", f"gamma {gamma:g} at Mach {mach:.2g} against a wall, {choice}: {what}", text, error,
               0.03 if what == "pressure" else 0.1)


def reflected(mach: float, choice: str, cells: int = 100) -> Row:
    """A shock of this Mach number, which a piston drives, is reflected by a wall: the pressure there within 3 %."""
    first = riemann.Gas(1.0, 0.0, 1.0, 1.4)
    speed = mach * first.c
    p = (2.8 * mach**2 - 0.4) / 2.4
    rho = first.density_behind(p)
    u = speed * (1.0 - 1.0 / rho)
    again = riemann.Gas(rho, u, p, 1.4)
    second = brentq(lambda each: again.velocity_change(each) - u, p, 100.0 * p)
    back = u * rho / (again.density_behind(second) - rho)
    time = 0.5 / speed + 0.25 / (u + back)
    text = (tube(cells, 0.0, 1.0, "z_max", z_min="velocity", z_min_velocity=u)
            + gas("behind", 0.0, 0.5, rho, pressure=p, velocity=u) + gas("ahead", 0.5, 1.0, 1.0, pressure=1.0, join="behind")
            + numerics(choice) + stop(time))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        reach = back * (simulation.time - 0.5 / speed)
        return line.pressure[between(line.x, 1.0 - reach, 1.0, 0.25)].mean() / second - 1.0

    return Row("gases", f"shock of Mach {mach:g} reflected by a wall, {choice}", text, error, 0.03)


def collapse(j: int, choice: str) -> Row:
    """Gas that falls to the axis or to the origin uniformly: the density at half of the time within 2 %."""
    exact, n = Collapse(j=j, e0=0.05), 40
    size, pattern = 1.0 / n, ("cylindrical", "spherical")[j - 2]
    high = 2 * size if j == 2 else 1.0
    text = (mesh((1.0, n), (high, 2 if j == 2 else n)) + walls("z_min", *(("z_max",) if j == 2 else ()))
            + box("gas", "gas_5_3", r=[0.0, 1.0], z=[0.0, high], density=1.0, energy=0.05,
                  flow={"pattern": pattern, "speed": -1.0, "radius": 1.0, "exponent": -1.0})
            + numerics(choice) + stop(0.5))

    def error(simulation: Simulation) -> float:
        line = Line(simulation, "r")
        grid = simulation.grid
        rho = grid.interior(simulation.state.rho[0])[0]
        return rho[line.x < 0.25].mean() / exact.at(simulation.time)[0] - 1.0

    return Row("gases", f"uniform collapse, j = {j}, {choice}", text, error, 0.02)


def noh_sphere(choice: str, cells: int = 40) -> Row:
    """Noh's spherical problem in r-z: the density between the centre and the shock within 10 %."""
    exact, end = Noh(3), 0.6
    text = (mesh((0.8, cells), (0.8, cells)) + walls("z_min")
            + box("gas", "gas_5_3", z=[0.0, 0.8], density=1.0, energy=0.0, flow={"pattern": "spherical", "speed": -1.0})
            + numerics(choice) + stop(end))

    def error(simulation: Simulation) -> float:
        grid = simulation.grid
        distance = np.hypot(grid.rc[grid.inside[1]][None], grid.zc[grid.inside[0]][:, None])
        reach = exact.shock_speed * simulation.time
        inner = (distance > 0.3 * reach) & (distance < 0.8 * reach)
        return grid.interior(simulation.state.rho[0])[inner].mean() / exact.rho - 1.0

    return Row("gases", f"Noh's spherical problem, {choice}", text, error, 0.1)


def bubble(density: float, speed: float) -> Row:
    """A ball of gas of 8 cells moves with the gas around it at one pressure: its density within 2 %, after 10 cells."""
    text = (mesh((0.12, 12), (0.48, 48)) + walls("r_max", z_min="transmit", z_max="transmit")
            + body("ball", "light", "sphere", centre=0.15, radius=0.08, density=density, pressure=1e5, velocity=speed)
            + box("around", "air", z=[0.0, 0.48], density=1.2, pressure=1e5, velocity=speed) + ideal("light", 5 / 3)
            + ideal("air", 1.4) + stop(0.1 / speed))
    return Row("gases", f"a bubble of {density:g} kg/m^3 moves with air at {speed:g} m/s", text,
               lambda simulation: mean_state(simulation, 0)[1] / density - 1.0, 0.02)


def corner(mach: float = 2.0, cells: int = 40) -> Row:
    """A shock that meets a wall at 30 degrees is reflected there: the pressure behind both shocks within 5 %."""
    exact, c = oblique.reflection(mach, math.radians(30.0)), math.sqrt(1.4 * 1e5 / 1.2)
    p, rho = 1e5 * exact.first.pressure, 1.2 * exact.first.density
    u = mach * c * (1.0 - 1.2 / rho)
    across, along = -u * math.cos(math.radians(30.0)), u * math.sin(math.radians(30.0))
    foot, size = mach * c / math.sin(math.radians(30.0)), 0.76 / cells
    text = (mesh((0.76, cells), (2 * 0.76, 2 * cells), geometry="planar")
            + table("boundaries", r_max="velocity", r_max_velocity=across, z_min="velocity", z_min_velocity=along)
            + body("ahead", "air", "polygon", points=[[0.0, 0.2], [0.76, 0.2 + 0.76 * math.sqrt(3.0)], [0.0, 1.52]],
                   density=1.2, pressure=1e5)
            + body("corner", "air", "polygon", points=[[0.0, 1.52], [0.76, 0.2 + 0.76 * math.sqrt(3.0)], [0.76, 1.52]],
                   join="ahead", density=1.2, pressure=1e5)
            + box("behind", "air", z=[0.0, 1.52], join="ahead", density=rho, pressure=p, velocity=[across, along])
            + ideal("air", 1.4) + stop(0.8 / foot))

    def error(simulation: Simulation) -> float:
        grid = simulation.grid
        z, p = grid.zc[grid.inside[0]], grid.interior(simulation.state.p)
        tip = 0.2 + foot * simulation.time
        near = (z > tip - 0.3) & (z < tip - 5.0 * size)
        return p[near, 0].mean() / (1e5 * exact.pressure) - 1.0

    return Row("gases", f"a shock of Mach {mach:g} meets a wall at 30 degrees, {cells} cells", text, error, 0.05)


def wedge(degrees: float, mach: float = 3.0) -> Row:
    """Gas flows along a wedge of steel: the pressure behind the oblique shock, above the surface, within 5 %."""
    c, rise = math.sqrt(1.4 * 1e5 / 1.2), math.tan(math.radians(degrees))
    exact = oblique.weak(mach, math.radians(degrees)).pressure
    text = (mesh((0.3, 30), (0.6, 60), geometry="planar")
            + walls("r_max", z_min="velocity", z_min_velocity=mach * c)
            + body("wedge", "steel_4340", "polygon", points=[[0.0, 0.1], [0.5 * rise, 0.6], [0.0, 0.6]])
            + box("gas", "air", z=[0.0, 0.6], density=1.2, pressure=1e5, velocity=mach * c) + ideal("air", 1.4)
            + stop(0.9 / (mach * c)))

    def error(simulation: Simulation) -> float:
        grid = simulation.grid
        z, r = grid.zc[grid.inside[0]], grid.rc[grid.inside[1]]
        surface = rise * (z[:, None] - 0.1)
        size = r[1] - r[0]
        near = (z[:, None] > 0.3) & (z[:, None] < 0.45) & (r > surface + size) & (r < surface + 4.0 * size)
        return grid.interior(simulation.state.p)[near].mean() / (1e5 * exact) - 1.0

    return Row("gases", f"Mach {mach:g} along a wedge of steel of {degrees:g} degrees", text, error, 0.05)


def along_a_plate(speed: float) -> Row:
    """Gas flows along a smooth plate at rest: its mean velocity within 2 %."""
    text = (mesh((0.1, 20), (0.4, 40), geometry="planar")
            + walls("r_max", z_min="transmit", z_max="transmit") + box("plate", "steel_4340", r=[0.0, 0.0225], z=[0.0, 0.4])
            + box("gas", "air", z=[0.0, 0.4], density=1.2, pressure=1e5, velocity=speed) + ideal("air", 1.4)
            + stop(0.3 / speed))
    return Row("gases", f"air along a plate of steel at {speed:g} m/s", text,
               lambda simulation: (simulation.mean_velocity(1) or 0.0) / speed - 1.0, 0.02)


# ------------------------------------------------------------------------------------------------------- flight and contact


def film_in_water(thickness: float, speed: float) -> Row:
    """A film of air of so many cells flies between two blocks of water: its energy within 5 %, after a way of ten cells."""
    size, low = 1e-4, 1.53e-3
    high = low + thickness * size
    text = (tube(50, 0.0, 50 * size) + box("below", "water", z=[0.5e-3, low], velocity=speed)
            + gas("film", low, high, 1.2, "air", pressure=1e5, velocity=speed)
            + box("above", "water", z=[high, 2.6e-3], velocity=speed) + fluid(WATER) + ideal("air", 1.4) + NO_FRACTURE
            + stop(10 * size / speed))
    return Row("flight and contact", f"a film of air of {thickness:g} cells flies in water at {speed:g} m/s", text,
               lambda simulation: mean_state(simulation, 1)[0] / (1e5 / 0.4 / 1.2) - 1.0, 0.05)


def place(simulation: Simulation, m: int) -> float:
    """Where the centre of mass of a body is along z, m."""
    s, g = simulation.state, simulation.grid
    mass = g.interior(s.vof[m] * s.rho[m] * g.volume)
    at = g.zc[g.inside[0]][:, None] + g.interior(s.centroid_z)[m] * g.dz[g.inside[0]][:, None]
    return float((mass * at).sum() / mass.sum())


def gap(width: float, speed: float, own: float = 0.0, hard: bool = False) -> Row:
    """Two plates, a gap of so many cells apart. If both fly at `speed` the gap keeps its width to a tenth of a cell.

    own : velocity of the second plate; if it is less, what it has gained before they can meet, within 2 % of the difference
    """
    size = 1e-4
    low = 1.5e-3 + 0.3 * size
    high = low + width * size
    closes = own != speed
    time = 0.6 * width * size / (speed - own) if closes else 10 * size / speed
    text = (tube(60, 0.0, 60 * size) + box("first", "Al5083", z=[0.5e-3, low], velocity=speed)
            + box("second", "Al5083", z=[high, high + 1e-3], velocity=own) + (contact("first") if hard else "") + NO_FRACTURE
            + stop(time))

    def error(simulation: Simulation) -> float:
        if closes:
            return ((simulation.mean_velocity(1) or 0.0) - own) / (speed - own)
        middle = 0.5 * (0.5e-3 + low)
        return (place(simulation, 1) - place(simulation, 0) - (high + 0.5e-3 - middle)) / size

    name = f"a gap of {width:g} cells {'closes' if closes else 'flies'}, {speed:g} and {own:g} m/s{', contact' if hard else ''}"
    return Row("flight and contact", name, text, error, 0.02 if closes else 0.1)


def slides(speed: float, hard: bool, what: str = "Al5083") -> Row:
    """A block slides along another one without friction: its velocity within 2 %."""
    text = (mesh(("4 mm", 8), ("40 mm", 80), geometry="planar") + walls("r_max")
            + box("block", what, r=[0.0, "2 mm"], z=["5 mm", "20 mm"], velocity=speed)
            + box("rail", what, r=["2 mm", "4 mm"], z=[0.0, "40 mm"])
            + (contact("block") if hard else "") + NO_FRACTURE + stop(8e-3 / speed))
    return Row("flight and contact", f"a block of {what} slides at {speed:g} m/s{', contact' if hard else ''}", text,
               lambda simulation: (simulation.mean_velocity(0) or 0.0) / speed - 1.0, 0.02)


def strikes(speed: float, hard: bool, cells: int = 120) -> Row:
    """A striker of elastic steel stops at a bar twice as long, which parts from it: its velocity within 5 %."""
    text = (tube(cells, -15e-3, 30e-3) + box("striker", "elastic", z=[-10e-3, 0.0], velocity=speed)
            + box("bar", "elastic", z=[0.0, 20e-3]) + elastic() + (contact("striker") if hard else "") + NO_FRACTURE
            + stop(60e-3 / LONGITUDINAL))
    return Row("flight and contact", f"a striker at {speed:g} m/s on a bar, {cells} cells{', contact' if hard else ''}", text,
               lambda simulation: (simulation.mean_velocity(0) or 0.0) / speed, 0.05)


def knocked(speed: float, hard: bool) -> Row:
    """A plate without strength stops at one of its own thickness, which leaves at its speed: that within 5 %."""
    text = (tube(120, -4e-3, 8e-3) + box("flyer", "aluminium", z=[-3e-3, 0.0], velocity=speed)
            + box("target", "aluminium", z=[0.0, 3e-3]) + fluid(AL_5083) + (contact("flyer") if hard else "") + NO_FRACTURE
            + stop(4.0 * 3e-3 / AL_5083.c0))
    return Row("flight and contact", f"a plate knocks on another at {speed:g} m/s{', contact' if hard else ''}", text,
               lambda simulation: (simulation.mean_velocity(1) or 0.0) / speed - 1.0, 0.05)


def spalls(speed: float, cells: int = 60) -> Row:
    """A flyer on a target twice as thick splits it in the middle: the depth of the first void from the rear within 10 %."""
    thick = 2e-3
    size = thick / cells
    text = (tube(4 * cells, -1.25 * thick, 2.75 * thick) + box("flyer", "fluid", z=[-thick, 0.0], velocity=speed)
            + box("target", "fluid", z=[0.0, 2 * thick]) + material("fluid", "Al5083", strength={"model": "hydrodynamic"})
            + stop(4.5 * thick / AL_5083.c0))

    def error(simulation: Simulation) -> float:
        share = Line(simulation).body("vof", 1)
        thickest = np.nonzero(share > 0.9)[0][-1]
        void = np.nonzero(share[:thickest] < 0.9)[0][-1]
        return share[void:].sum() * size / thick - 1.0

    return Row("flight and contact", f"spall of aluminium by a flyer at {speed:g} m/s, {cells} cells", text, error, 0.1)


# -------------------------------------------------------------------------------------------------------- edges, elastic


def under_pressure(pressure: float, after: float, cells: int = 60) -> Row:
    """A pressure acts on an elastic bar that ends at a transmitting edge: its velocity p/(rho c) within 2 %.

    after : times in which a wave crosses the bar; before 1 behind the wave, after it in the whole bar
    """
    length = 30e-3
    text = (tube(cells, 0.0, length, z_min="pressure", z_min_pressure=pressure, z_max="transmit")
            + box("bar", "elastic", z=[0.0, length]) + elastic() + NO_FRACTURE + stop(after * length / LONGITUDINAL))
    exact = pressure / (STEEL.rho0 * LONGITUDINAL)

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        front = min(LONGITUDINAL * simulation.time, length)
        return line.velocity[between(line.xv, 0.0, front, 0.2)].mean() / exact - 1.0

    return Row("edges and elastic waves", f"{pressure:g} Pa on a bar, {after:g} crossings", text, error, 0.02)


def clamped(speed: float, edge: str) -> Row:
    """An elastic bar that moves is stopped at one end: the stress rho c v within 2 %."""
    length = 30e-3
    text = (tube(60, 0.0, length, z_min=edge) + box("bar", "elastic", z=[0.0, 0.9 * length], velocity=-speed) + elastic()
            + NO_FRACTURE + stop(0.5 * length / LONGITUDINAL))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        inner = between(line.x, 0.0, LONGITUDINAL * simulation.time, 0.2)
        return line.axial_stress[inner].mean() / (STEEL.rho0 * LONGITUDINAL * speed) - 1.0

    return Row("edges and elastic waves", f"a bar at {speed:g} m/s, {edge}", text, error, 0.02)


def lets_pass(speed: float) -> Row:
    """Aluminium between transmitting edges is hit in the middle: at the end all of it has half of the speed, within 2 %."""
    text = (tube(100, -5e-3, 5e-3, z_min="transmit", z_max="transmit")
            + box("flyer", "aluminium", z=[-5e-3, 0.0], velocity=speed) + box("target", "aluminium", z=[0.0, 5e-3])
            + fluid(AL_5083) + NO_FRACTURE + stop(3.0 * 5e-3 / AL_5083.c0))

    def error(simulation: Simulation) -> float:
        return np.abs(Line(simulation).velocity / (0.5 * speed) - 1.0).max()

    return Row("edges and elastic waves", f"transmitting edges, impact at {speed:g} m/s", text, error, 0.02)


# -------------------------------------------------------------------------------------------------------------- explosives


def front(what: str, speed: float, choice: str, cells: int = 150) -> Row:
    """An explosive of the library, lit at a wall: the place of its front within 2 %."""
    length = 60e-3
    text = (tube(cells, 0.0, length, "z_min", "z_max") + box("charge", what, z=[0.0, length]) + fuse(length / cells, 2)
            + numerics(choice) + stop(0.8 * length / speed))

    def error(simulation: Simulation) -> float:
        line = Line(simulation)
        return crossing(line.x, line.pressure, 0.5 * line.pressure.max()) / (speed * simulation.time) - 1.0

    return Row("explosives", f"front of {what}, {choice}, {cells} cells", text, error, 0.02)


def gurney(what: str, density: float, speed: float, thickness: float, choice: str = "both") -> Row:
    """Two plates of copper with an explosive between: their velocity by Gurney's formula within 10 %.

    speed : sqrt(2 E) of the explosive, m/s;  thickness : of a plate, mm, half of the charge being 12 mm
    """
    exact = speed / math.sqrt(8930.0 * thickness / (density * 12.0) + 1.0 / 3.0)
    text = (tube(300, 0.0, 75e-3, "z_min") + box("charge", what, z=[0.0, 12e-3])
            + box("plate", "copper_OFHC", z=[12e-3, (12 + thickness) * 1e-3]) + fuse(0.25e-3, 2) + numerics(choice)
            + NO_FRACTURE + stop(45e-3 / exact + 2e-6))
    return Row("explosives", f"plates of {thickness:g} mm on {what}, {choice}", text,
               lambda simulation: (simulation.mean_velocity(1) or 0.0) / exact - 1.0, 0.1)


def escapes(choice: str, cells: int = 150) -> Row:
    """A charge that is free at both ends: the kinetic energy of its products within 3 %."""
    exact = Escape(1875.0, 8000.0, 50e-3)
    size = 150e-3 / cells
    text = (tube(cells, -50e-3, 100e-3) + box("charge", "charge", z=[0.0, 50e-3]) + CHARGE + fuse(size, 2, 0.5 * size)
            + numerics(choice) + NO_FRACTURE + stop("10 us"))

    def error(simulation: Simulation) -> float:
        x = np.linspace(-50e-3, 100e-3, 20001)
        rho, u, _ = exact.sample(x, simulation.time)
        energy = simulation.conservation()["kinetic_energy_J"] / (2 * simulation.grid.dr[4])
        return energy / np.trapezoid(0.5 * rho * u**2, x) - 1.0

    return Row("explosives", f"products escape at both ends, {choice}, {cells} cells", text, error, 0.03)


def gas_gun(choice: str, cells: int = 80, thickness: float = 0.05) -> Row:
    """Gas drives a projectile of 139.25 kg/m^2: its velocity within 3 %."""
    exact = Gun(70.0, 50e6, 1.4, 139.25)
    shell = Solid(139.25 / thickness, 5328.0, 1.338, 2.0)
    text = (tube(cells, -1.0, 0.6, "z_min") + gas("gas", -1.0, 0.0, 70.0, "propellant", pressure=50e6)
            + box("projectile", "shell", z=[0.0, thickness]) + ideal("propellant", 1.4) + fluid(shell, "shell")
            + numerics(choice) + NO_FRACTURE + stop(1.6e-3))
    return Row("explosives", f"a gas gun, {thickness:g} m on cells of {1.6 / cells:g} m, {choice}", text,
               lambda simulation: (simulation.mean_velocity(1) or 0.0) / exact.velocity(simulation.time) - 1.0, 0.03)


# ---------------------------------------------------------------------------------------------------------------- the rows


def renamed(row: Row, more: str) -> Row:
    """A row of `verdicts` with other numbers, under a name of its own."""
    return row._replace(name=f"{row.family}: {row.name}, {more}")


#: why a verdict is not as it should be
SPIKE = ("one cell before the shock is 0.3 MJ/kg too cold, where 28 MJ/kg are behind it: 6e-5 of the energy, but 1.3 % of the "
         "mass of a body of 80 cells, of which 1 % makes a doubt; with 120 cells it is a note")
STARTS = "overheating where a shock begins, of the method: no more heat than the deck can reach"
STICKS = ("gas and metal share the velocities at their surface, as thick as a cell: along the plate 15, 6 and 0.8 % with 10, "
          "20 and 40 cells, at the wedge 6 and 4 % with 30 and 60")
TIED = ("without contact bodies have one velocity, so that they do not slide or, with fracture off, part: 50 to 97 % wrong, "
        "but all that they do is computed rightly")
BRIDGED = ("two plates share vertices across a gap of less than two cells: the second has 20 % of the speed before they can "
           "meet, with contact nothing")

G = riemann.Gas
#: of which the answer should be right
RIGHT = [
    # shocks of metals and liquids: 22
    collide(TUNGSTEN, AL_5083, 1000.0), collide(AL_5083, TUNGSTEN, 3000.0, "ke"), collide(COPPER, AL_5083, 6000.0),
    collide(WATER, COPPER, 500.0), collide(AL_5083, AL_5083, 10000.0, hard=True),
    collide(TUNGSTEN, AL_5083, 2000.0, "momentum"), collide(PLASTIC, AL_5083, 300.0),
    collide(COPPER, COPPER, 2000.0, hard=True), collide(COPPER, COPPER, 4000.0, what="energy"),
    vaporising("Al_tillotson", 3000.0), vaporising("Al_tillotson", 10000.0),
    vaporising("Al_tillotson", 15000.0)._replace(missed=SPIKE),
    vaporising("Fe_tillotson", 8000.0, "ke"), vaporising("Cu_tillotson", 6000.0),
    free_surface(AL_5083, 2000.0), free_surface(COPPER, 4000.0), free_surface(TUNGSTEN, 1000.0),
    water_hammer(1.0, "both"), water_hammer(10.0, "momentum"), water_hammer(100.0, "ke"),
    noh_metal(1, 1000.0), noh_metal(2, 500.0),
    # gases: 15
    two_fluids("compressed air and helium", G(12.0, 0.0, 1e6, 1.4), G(0.166, 0.0, 1e5, 5 / 3), 3.5e-4),
    two_fluids("heavy and light gas", G(100.0, 0.0, 1e7, 1.4), G(1.0, 0.0, 1e5, 5 / 3), 4e-4),
    wrong(two_fluids("hot light and cold heavy gas", G(0.1, 0.0, 1e6, 5 / 3), G(10.0, 0.0, 1e5, 1.1), 1e-4, "ke"), MESH),
    two_fluids("an interface that only moves", G(1.0, 100.0, 1e5, 1.4), G(100.0, 100.0, 1e5, 1.1), 1e-3),
    two_fluids("water and gas", G(1000.0, 0.0, 1e9, 4.4, 6e8), G(50.0, 0.0, 1e5, 1.4), 1.8e-4),
    wrong(against_a_wall(1.4, 3.0, "ke"), GAINS), against_a_wall(5 / 3, 10.0, "both"), against_a_wall(1.1, 5.0, "both"),
    reflected(2.0, "both"), reflected(5.0, "momentum"), collapse(2, "both"), wrong(collapse(3, "ke"), MESH),
    bubble(0.1, 100.0), corner(), renamed(sedov(3, "both", 40), "40 cells"),
    # flight and contact: 12
    in_flight(0.6, 5000.0), in_flight(1.7, 2000.0, "momentum"), in_flight(2.5, 400.0, "ke"), in_flight(4.0, 7000.0),
    film_in_water(0.4, 300.0), film_in_water(3.0, 1000.0), gap(0.5, 1000.0, 1000.0), gap(2.0, 500.0, 500.0, hard=True),
    slides(100.0, True), strikes(10.0, True), knocked(200.0, True), spalls(300.0),
    # edges and elastic waves: 6
    under_pressure(1e8, 0.7), under_pressure(1e7, 3.0), clamped(20.0, "held"), lets_pass(200.0),
    renamed(precursor("both", 200.0), "200 m/s"), wrong(renamed(ball(20.0, 12), "12 cells")),
    # explosives: 5
    front("TNT", 6930.0, "both"), gurney("TNT", 1630.0, 2440.0, 2.0), wrong(plate_push(8.0, 2.0, "ke"), GAINS), escapes("both"),
    gas_gun("both"),
]
#: of which the answer should be wrong: too few cells, `ke` and `momentum` in strong shocks, no viscosity, the longest steps,
#: tied bodies, gas beside metal, plates thinner than a cell
WRONG = [
    # shocks of metals and liquids: 7
    collide(AL_5083, AL_5083, 3000.0, what="energy", viscosity_linear=0.0, viscosity_quadratic=0.0),
    collide(AL_5083, AL_5083, 3000.0, what="greatest pressure", courant=1.0, shock_courant=1.0),
    collide(COPPER, COPPER, 8000.0, what="greatest pressure", courant=1.0, shock_courant=1.0, viscosity_linear=0.0),
    wrong(interface_energy(6000.0), STARTS), wrong(interface_energy(2000.0), STARTS), free_surface(COPPER, 4000.0, 12),
    noh_metal(2, 3000.0, "ke"),
    # gases: 14
    wrong(against_a_wall(1.4, 100.0, "ke"), GAINS), wrong(against_a_wall(1.1, 50.0, "ke")),
    against_a_wall(5 / 3, 100.0, "momentum")._replace(missed=DISCARDS),
    against_a_wall(1.4, 3.0, "both", "energy at the wall"), noh_sphere("ke"), noh_sphere("momentum")._replace(missed=DISCARDS),
    wrong(renamed(noh(2, "both", 30), "30 cells"), MESH), renamed(sedov(3, "both", 10), "10 cells"),
    wrong(renamed(shock_tube("Sod's tube", "both", 15), "15 cells"), MESH),
    wrong(two_fluids("heavy and light gas", G(100.0, 0.0, 1e7, 1.4), G(1.0, 0.0, 1e5, 5 / 3), 4e-4, cells=12), MESH),
    wedge(10.0), wrong(wedge(20.0), STICKS), wrong(along_a_plate(300.0), STICKS), wrong(renamed(limited(2e8), "200 MPa"), THIN),
    # flight and contact: 6
    wrong(slides(100.0, False), TIED), wrong(strikes(10.0, False), TIED), wrong(knocked(200.0, False), TIED),
    wrong(gap(0.6, 100.0, 0.0), BRIDGED), wrong(spalls(300.0, 6), MESH), wrong(slides(1000.0, False), TIED),
    # elastic waves and explosives: 3
    wrong(renamed(precursor("both", 400.0, 12), "12 cells"), MESH), wrong(plate_push(0.3, 1.0, "momentum")),
    front("TNT", 6930.0, "both", 15),
]
#: where the families of `verdicts` belong here
FAMILIES = {"Sedov's blast": "gases", "Noh's problem": "gases", "tubes of gas": "gases",
            "at rest and in flight": "flight and contact", "elastic waves": "edges and elastic waves"}
DRAWN = [row._replace(family=FAMILIES.get(row.family, row.family)) for row in [*RIGHT, *WRONG]]
#: not of the draw: plates of one to two cells, which fill none of them as soon as they leave the faces on which they began; a
#: rule for films that did not ask how thick a body had been gave them a note
NOTED = [wrong(plate_push(1.0, 1.0, "momentum")), wrong(plate_push(1.2, 1.0)), wrong(plate_push(1.4, 1.0, "momentum"))]


if __name__ == "__main__":
    print_results(DRAWN)
