"""Problems with exact solutions: how each is run on three meshes, the quantities measured, and the curve that is drawn.

`table.py` runs them and prints the tables, `figures.py` draws them. The problems of `gases.py` and `liquids.py` belong to them.
"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
from scipy.optimize import curve_fit

import hydro2d
from eos import jwl
from problems.verification import gases, liquids
from problems.verification.cells import Cells, crossing
from problems.verification.exact import blake, elastic_plastic, guderley, riemann_jwl, shell, vibration
from problems.verification.exact.collapse import Collapse
from problems.verification.exact.detonation import Taylor
from problems.verification.exact.impact import AL_5083
from problems.verification.exact.noh import Noh
from problems.verification.exact.sedov import Sedov
from problems.verification.measures import Curve, Problem, Quantity, advection, cells_of, column, extrema, lost, profile, square

FOLDER = Path(__file__).parent
#: angles of rays from the axis, degrees
RAYS = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0)


def front_of(cells: Cells, values: np.ndarray, angle: float) -> float:
    """Distance of a blast front on a ray: there the values fall through half of the largest on that ray."""
    distance, profile_along = cells.ray(values, angle)
    return crossing(distance, profile_along, 0.5 * profile_along.max())


# Sedov

SEDOV = {3: Sedov(3, 1.4, 0.8510718546e6), 2: Sedov(2, 1.4, 0.9840740168e6)}


def _sedov_refine(j: int, cells: int) -> list[str]:
    radius = 3.6 / cells
    size = {2: math.pi * radius**2, 3: 4.0 / 3.0 * math.pi * radius**3}[j]
    return [*square(1.2, cells), f"body.hot.radius={radius!r}", f"body.hot.energy={SEDOV[j].energy / size!r}"]


def _sedov(j: int, run: hydro2d.Results, cells: int) -> list[Quantity]:
    exact, state, time = SEDOV[j], cells_of(run), run.summary.time_s
    radius = exact.radius(time)
    fronts = np.array([front_of(state, state.mean_pressure, angle) for angle in RAYS])
    centre = state.distance < 0.25 * radius
    rho, _, p = exact.sample(state.distance, time)
    inside = state.distance < 1.15 * radius
    return [
        Quantity("radius of the front", "m", radius, float(fronts.mean())),
        Quantity("radius at the axis", "m", radius, float(fronts[0])),
        Quantity("radius at 45 degrees", "m", radius, float(fronts[3])),
        Quantity("spread over seven rays", "m", 0.0, float(np.ptp(fronts)), radius),
        Quantity("largest density", "kg/m3", exact.behind(time)[0], float(state.density.max())),
        Quantity("pressure within R/4", "MPa", 1e-6 * exact.central_pressure(time),
                 1e-6 * float(np.average(state.mean_pressure[centre], weights=state.volume[centre]))),
        profile("density", state.density[inside], rho[inside], state.volume[inside]),
        profile("pressure", state.mean_pressure[inside], p[inside], state.volume[inside]),
        lost(run),
    ]


def _sedov_curve(run: hydro2d.Results) -> Curve:
    cells = cells_of(run)
    return cells.shells(cells.density, 1.2)


def sedov(j: int) -> Problem:
    where = {3: ("sedov", "Sedov's blast in r-z"), 2: ("sedov_plane", "Sedov's blast in the plane")}[j]
    return Problem(*where, f"{where[0]}.toml", "on 1.2 m", (50, 100, 200), partial(_sedov_refine, j), partial(_sedov, j),
                   _sedov_curve, lambda x: SEDOV[j].sample(x, 1e-3)[0], ("distance [m]", "density [kg/m$^3$]"),
                   advection())


# Noh

NOH_PLATEAU = (0.08, 0.17)  # between the heated core and the smeared shock at 0.2 m


def _noh(j: int, run: hydro2d.Results, cells: int) -> list[Quantity]:
    exact, state, time = Noh(j, speed=1000.0), cells_of(run), run.summary.time_s
    place = state.distance if j == 3 else state.r
    here = (place > NOH_PLATEAU[0]) & (place < NOH_PLATEAU[1])
    rho, middle = exact.rho, 0.5 * (exact.rho + 4.0 ** (j - 1))
    density = state.density
    if j == 3:
        fronts = np.array([crossing(*state.ray(density, angle), middle) for angle in RAYS])
    else:
        fronts = np.array([crossing(*state.along(density, "r"), middle)])
    quantities = [
        Quantity("density behind the shock", "kg/m3", rho, float(np.average(density[here], weights=state.volume[here]))),
        Quantity("place of the shock", "m", exact.shock_speed * time, float(fronts.mean())),
    ]
    if j == 3:
        quantities.append(Quantity("spread over seven rays", "m", 0.0, float(np.ptp(fronts)), exact.shock_speed * time))
    inside = place < 0.35
    exact_density = exact.sample(place, time)[0]
    return [*quantities, profile("density", density[inside], exact_density[inside], state.volume[inside]), lost(run)]


def _noh_curve(j: int, run: hydro2d.Results) -> Curve:
    cells = cells_of(run)
    x, y = cells.shells(cells.density, 0.4) if j == 3 else cells.along(cells.density, "r")
    return x[x < 0.4], y[x < 0.4]


def noh(j: int) -> Problem:
    name = {1: "planar", 2: "cylindrical", 3: "spherical"}[j]

    def refine(cells: int) -> list[str]:
        return square(1.0, cells) if j == 3 else [f"mesh.r=[{{to=1.0, cells={cells}}}]"]

    return Problem(f"noh_{name}", f"Noh's problem, {name}", f"noh_{name}.toml", "on 1 m",
                   (50, 100, 200) if j == 3 else (100, 200, 400), refine, partial(_noh, j), partial(_noh_curve, j),
                   lambda x: Noh(j, speed=1000.0).sample(x, 6e-4)[0], ("distance [m]", "density [kg/m$^3$]"),
                   advection("both"))


# The uniform collapse

COLLAPSE = Collapse(e0=5e4, end=1e-3)


def _collapse(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    rho, p, e = COLLAPSE.at(time)
    here = state.distance < 0.8 * COLLAPSE.untouched(1.0, time)
    core = state.distance < 0.1
    weights = state.volume[here]

    def mean(values: np.ndarray, where: np.ndarray) -> float:
        return float(np.average(values[where], weights=state.volume[where]))

    return [
        Quantity("mean density", "kg/m3", rho, mean(state.density, here)),
        Quantity("density within 0.1 m", "kg/m3", rho, mean(state.density, core)),
        Quantity("mean pressure", "MPa", 1e-6 * p, 1e-6 * mean(state.mean_pressure, here)),
        Quantity("pressure within 0.1 m", "MPa", 1e-6 * p, 1e-6 * mean(state.mean_pressure, core)),
        profile("density", state.density[here], np.full(weights.shape, rho), weights),
        profile("velocity", state.outward[here], COLLAPSE.velocity(state.distance[here], time), weights),
        lost(run),
    ]


def _collapse_curve(run: hydro2d.Results) -> Curve:
    cells = cells_of(run)
    return cells.shells(cells.density, 0.3)


# Guderley

GUDERLEY_WINDOW = (0.1, 0.4)
IMPLOSION = ("axis", 0.0), ("middle", 45.0), ("equator", 90.0)


def _implosion(angle: float, simulation: hydro2d.Simulation) -> float:
    """Radius of the imploding front on a ray: the density falls inward through the middle of 1 and 6."""
    cells = Cells(simulation)
    return crossing(*cells.ray(cells.density, angle), 3.5, -1)


def power_law(time, scale, end, exponent):
    """R = scale (end - t)^exponent."""
    return scale * np.maximum(end - time, 1e-12) ** exponent


def implosion_fit(time: np.ndarray, radius: np.ndarray, window: tuple[float, float] = GUDERLEY_WINDOW) -> np.ndarray:
    """(scale, end, exponent) of the power law through the radii within a window."""
    with np.errstate(invalid="ignore"):
        first = np.nonzero(~(radius > 0.0))[0]
        here = (radius > window[0]) & (radius < window[1])
    if len(first):
        here[first[first > np.argmax(here)][:1].min(initial=len(here)):] = False
    took, first = np.ptp(time[here]), time[here][0]
    scale, end, exponent = curve_fit(power_law, (time[here] - first) / took, radius[here], (window[1], 1.2, 0.7))[0]
    return np.array([scale * took**-exponent, first + end * took, exponent])


def _guderley(run: hydro2d.Results, cells: int) -> list[Quantity]:
    history = run.history
    fits = {name: implosion_fit(history["time"], history[f"front_{name}_m"]) for name, _ in IMPLOSION}
    mean = np.mean([history[f"front_{name}_m"] for name, _ in IMPLOSION], axis=0)
    alpha, size = guderley.exponent(3, 1.4), 1.4 / cells
    at = np.nonzero(mean > 0.2)[0][-1]
    fronts = [history[f"front_{name}_m"][at] for name, _ in IMPLOSION]
    ends = [fit[1] for fit in fits.values()]
    return [
        Quantity("exponent, mean of the rays", "", alpha, float(np.mean([fit[2] for fit in fits.values()]))),
        *(Quantity(f"exponent, {name}", "", alpha, float(fit[2])) for name, fit in fits.items()),
        Quantity("rays apart at 0.2 m", "cells", 0.0, float(np.ptp(fronts) / size), 0.2 / size),
        Quantity("time of collapse, spread", "s", 0.0, float(np.ptp(ends)), float(np.mean(ends))),
        lost(run),
    ]


def _guderley_curve(run: hydro2d.Results) -> Curve:
    """Mean radius against the time left to the collapse of the power law, in units of that at 0.25 m."""
    time = run.history["time"]
    mean = np.mean([run.history[f"front_{name}_m"] for name, _ in IMPLOSION], axis=0)
    scale, end, exponent = implosion_fit(time, mean)
    there = (mean > 0.02) & (time < end)
    return (end - time[there]) / (0.25 / scale) ** (1.0 / exponent), mean[there]


# Cavities

CAVITY = blake.Cavity()


def _moved(run: hydro2d.Results) -> tuple[np.ndarray, np.ndarray]:
    """Positions of the tracers at the start, (r, z), and their displacements."""
    simulation = run.simulation()
    start = np.array([(each.r, each.z) for each in simulation.deck.tracer])
    return start, simulation.stations.tracers[: len(start)] - start


def _blake(run: hydro2d.Results, cells: int) -> list[Quantity]:
    time, state = run.summary.time_s, cells_of(run)
    start, moved = _moved(run)
    distance = np.hypot(*start.T)
    moved = np.sum(moved * start, axis=1) / distance
    gas = float(np.sum(state.vof[0] * state.volume))
    grown = (3.0 * gas) ** (1.0 / 3.0) - CAVITY.radius
    here = (state.distance > 1.2 * CAVITY.radius) & (state.distance < CAVITY.radius + CAVITY.longitudinal * time)
    exact = CAVITY.displacement(distance, time)
    wall = 1e9 * float(CAVITY.displacement(CAVITY.radius, time))
    quantities = [Quantity("displacement of the wall", "nm", wall, 1e9 * grown)]
    for radii in (1.5, 3.0):
        near = np.abs(distance / CAVITY.radius - radii) < 0.01
        quantities.append(Quantity(f"displacement at {radii:g} radii", "nm", 1e9 * float(exact[near].mean()),
                                   1e9 * float(moved[near].mean())))
        quantities.append(Quantity(f"spread of three rays at {radii:g} radii", "nm", 0.0, 1e9 * float(np.ptp(moved[near])),
                                   1e9 * float(exact[near].mean())))
    weight = state.volume[here] / state.distance[here] ** 2
    return [
        *quantities,
        profile("radial velocity", state.outward[here], CAVITY.velocity(state.distance[here], time), weight),
        profile("mean pressure", state.mean_pressure[here], CAVITY.mean_pressure(state.distance[here], time), weight),
    ]


def _blake_curve(run: hydro2d.Results) -> Curve:
    cells = cells_of(run)
    x, y = cells.shells(cells.outward, 1.0)
    return x[x > CAVITY.radius], 1e3 * y[x > CAVITY.radius]


def _cylinder(run: hydro2d.Results, cells: int) -> list[Quantity]:
    start, moved = _moved(run)
    exact = blake.cylindrical(CAVITY, start[:, 0], run.summary.time_s)
    return [Quantity(f"displacement at {r / CAVITY.radius:g} radii", "nm", 1e9 * right, 1e9 * computed)
            for r, right, computed in zip(start[:, 0], exact, moved[:, 0], strict=True)]


def _cylinder_curve(run: hydro2d.Results) -> Curve:
    start, moved = _moved(run)
    return start[:, 0] / CAVITY.radius, 1e9 * moved[:, 0]


# Pistons

METAL = elastic_plastic.ALUMINIUM_EXACTPACK


def _elastic_piston(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    wave = elastic_plastic.elastic(METAL[0], METAL[1], 20.0)
    x, stress = state.along(state.axial_stress, "z")
    front, velocity = crossing(x, stress, 0.5 * wave.sigma), state.along(state.v, "z")[1]
    flat = (x > 0.2 * front) & (x < 0.8 * front)
    return [
        Quantity("speed of the wave", "m/s", wave.speed, front / time),
        Quantity("axial stress", "GPa", 1e-9 * wave.sigma, 1e-9 * float(stress[flat].mean())),
        Quantity("velocity", "m/s", wave.u, float(velocity[flat].mean())),
        Quantity("largest axial stress", "GPa", 1e-9 * wave.sigma, 1e-9 * float(stress.max())),
        profile("axial stress", stress, np.where(x < wave.speed * time, wave.sigma, 0.0)),
    ]


def _elastic_plastic_piston(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    exact = elastic_plastic.piston(*METAL, 100.0)
    first, second = exact.elastic, exact.plastic
    x, stress = state.along(state.axial_stress, "z")
    pressure = state.along(state.mean_pressure, "z")[1]
    ends = second.speed * time, first.speed * time
    shelf = (x > 0.6 * ends[0] + 0.4 * ends[1]) & (x < 0.2 * ends[0] + 0.8 * ends[1])
    flat = (x > 0.2 * second.speed * time) & (x < 0.8 * second.speed * time)
    return [
        Quantity("speed of the precursor", "m/s", first.speed, crossing(x, stress, 0.5 * first.sigma) / time),
        Quantity("stress of the precursor", "GPa", 1e-9 * first.sigma, 1e-9 * float(stress[shelf].mean())),
        Quantity("speed of the plastic shock", "m/s", second.speed,
                 crossing(x, stress, 0.5 * (first.sigma + second.sigma)) / time),
        Quantity("stress behind it", "GPa", 1e-9 * second.sigma, 1e-9 * float(stress[flat].mean())),
        Quantity("pressure behind it", "GPa", 1e-9 * second.p, 1e-9 * float(pressure[flat].mean())),
        profile("axial stress", stress, _two_waves(x, time)),
    ]


def _two_waves(x: np.ndarray, time: float) -> np.ndarray:
    exact = elastic_plastic.piston(*METAL, 100.0)
    ahead = np.where(x < exact.elastic.speed * time, exact.elastic.sigma, 0.0)
    return np.where(x < exact.plastic.speed * time, exact.plastic.sigma, ahead)


def _stress_curve(run: hydro2d.Results) -> Curve:
    cells = cells_of(run)
    x, y = cells.along(cells.axial_stress, "z")
    return 1e3 * x, 1e-9 * y


# The breathing sphere

SPHERE, SPHERE_RADIUS = vibration.Elastic(2785.0, 5328.0, 27.6e9), 0.01


def _breathes(simulation: hydro2d.Simulation) -> float:
    """The velocity of the surface in the lowest mode, by projecting the radial velocity on its shape, m/s."""
    cells = Cells(simulation)
    shape = vibration.shape(vibration.sphere(SPHERE), cells.distance / SPHERE_RADIUS)
    mass = cells.volume * cells.density
    return float(np.sum(mass * shape * cells.outward) / np.sum(mass * shape**2))


def _sphere(run: hydro2d.Results, cells: int) -> list[Quantity]:
    period = vibration.period(SPHERE, SPHERE_RADIUS, vibration.sphere(SPHERE))
    times, values = extrema(run.history["time"], run.history["mode_m_s"])
    loss = np.polyfit(times, np.log(np.abs(values)), 1)[0]
    half = np.polyfit(np.arange(len(times)), times, 1)[0]
    return [
        Quantity("period", "us", 1e6 * period, 2e6 * float(half)),
        Quantity("amplitude after seven periods", "", 1.0, math.exp(7.0 * period * loss)),
    ]


def _sphere_curve(run: hydro2d.Results) -> Curve:
    return 1e6 * run.history["time"], run.history["mode_m_s"]


def _sphere_exact(x: np.ndarray) -> np.ndarray:
    """The velocity of the mode, started by a velocity of 2 m/s times the share of the radius."""
    lowest = vibration.sphere(SPHERE)
    share = np.linspace(0.0, 1.0, 2001)
    shape = vibration.shape(lowest, share)
    start = 2.0 * np.trapezoid(share**3 * shape, share) / np.trapezoid(share**2 * shape**2, share)
    return start * np.cos(2e-6 * math.pi * x / vibration.period(SPHERE, SPHERE_RADIUS, lowest))


# Shells

BERYLLIUM = (1845.0, 0.33e9)
SHELLS = {3: (shell.Shell(3, 0.08, 0.1, *BERYLLIUM), 619.787), 2: (shell.Shell(2, 0.08, 0.1, *BERYLLIUM), 490.299)}


def _cavity(j: int, simulation: hydro2d.Simulation) -> float:
    """Radius of the empty space within the shell, by its volume, m."""
    cells = Cells(simulation)
    place = cells.distance if j == 3 else cells.r
    mass = cells.vof[0] * cells.rho[0] * cells.volume
    inside = place < np.sum(mass * place) / np.sum(mass)
    empty = float(np.sum(((1.0 - cells.vof[0]) * cells.volume)[inside]))
    return (3.0 * empty) ** (1.0 / 3.0) if j == 3 else math.sqrt(2.0 * empty / 0.008)


def _cavity_along(axis: str, simulation: hydro2d.Simulation) -> float:
    """Empty space within the shell along the axis ("z") or the equator ("r"), m."""
    cells = Cells(simulation)
    x, filled = (cells.rows, cells.vof[0][:, 0]) if axis == "z" else (cells.columns, cells.vof[0][0])
    inside = x < np.sum(x * filled) / np.sum(filled)
    return float(np.sum((1.0 - filled)[inside]) * cells.size)


def _shell(j: int, run: hydro2d.Results, cells: int) -> list[Quantity]:
    exact, speed = SHELLS[j]
    stop, time = exact.stop(speed), run.history["time"]
    radius = run.history["cavity_m"]
    last = int(np.argmin(radius))
    conservation = run.summary.conservation
    quantities = [
        Quantity("inner radius at the stop", "mm", 1e3 * stop, 1e3 * float(radius[last])),
        Quantity("kinetic energy that the remap discarded", "%", 0.0,
                 100.0 * conservation.sinks["advection"].energy_J / conservation.start_energy_J, 100.0),
    ]
    if j == 3:
        axis, equator = (run.history[f"cavity_{name}_m"][last] for name in ("axis", "equator"))
        quantities.append(Quantity("axis less equator", "mm", 0.0, 1e3 * float(axis - equator), 1e3 * stop))
    assert time[last] < run.summary.time_s, "the shell has not stopped"
    return quantities


def _shell_exact(j: int, x: np.ndarray) -> np.ndarray:
    exact, speed = SHELLS[j]
    time, radius = exact.path(speed)
    return 1e3 * np.interp(1e-6 * x, time, radius)


def _shell_curve(run: hydro2d.Results) -> Curve:
    return 1e6 * run.history["time"], 1e3 * run.history["cavity_m"]


# The Riemann problem with products

DRIVEN = riemann_jwl.drive(riemann_jwl.burnt(*riemann_jwl.PBX9404), AL_5083)


def _riemann(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    x, pressure = state.along(state.mean_pressure, "z")
    velocity, density = state.along(state.v, "z")[1], state.along(state.density, "z")[1]
    rho, u, p = DRIVEN.sample(x / time)
    contact, shock = DRIVEN.u * time, DRIVEN.shocked.speed * time
    left = (x > 0.5 * (contact - 5e-3)) & (x < contact - 1e-3)
    right = (x > contact + 1e-3) & (x < 0.85 * shock)
    return [
        Quantity("pressure of the products at the metal", "GPa", 1e-9 * DRIVEN.p, 1e-9 * float(pressure[left].mean())),
        Quantity("pressure of the metal", "GPa", 1e-9 * DRIVEN.p, 1e-9 * float(pressure[right].mean())),
        Quantity("velocity between the waves", "m/s", DRIVEN.u, float(velocity[left | right].mean())),
        Quantity("speed of the shock", "m/s", DRIVEN.shocked.speed, crossing(x, pressure, 0.5 * DRIVEN.p) / time),
        Quantity("density of the products at the metal", "kg/m3", DRIVEN.products.behind(DRIVEN.p)[0],
                 float(density[left].mean())),
        profile("density", density, rho),
        profile("pressure", pressure, p),
        profile("velocity", velocity, u),
    ]


def _axial_pressure(run: hydro2d.Results) -> Curve:
    cells = cells_of(run)
    x, y = cells.along(cells.mean_pressure, "z")
    return 1e3 * x, 1e-9 * y


# The plane detonation

CHARGE = 0.05


def _detonation_refine(cells: int) -> list[str]:
    size = CHARGE / cells
    return [*column(CHARGE, cells), f"source.fuse.points={[[(k + 0.5) * size, 0.0, 0.0] for k in range(4)]}"]


def _lit(simulation: hydro2d.Simulation) -> float:
    """Position at which half of the charge has burnt, m."""
    cells = Cells(simulation)
    return crossing(*cells.along(simulation.field("burn_fraction", "charge"), "z"), 0.5)


def _products(deck: hydro2d.Deck) -> tuple[np.ndarray, Taylor]:
    """Constants of the explosive, and the rarefaction behind its detonation."""
    row = jwl.row(deck.materials["charge"].eos.values)
    speed, pressure, _ = jwl.cj_state(row)

    def sound(rho: float, p: float) -> float:
        cold, _, slope, _ = jwl.products(rho, 0.0, row)
        _, dpdrho, dpde, _ = jwl.products(rho, (p - cold) / slope, row)
        return float(np.sqrt(dpdrho + p * dpde / rho**2))

    return row, Taylor(speed, float(row[0]), pressure, sound)


def _detonation(run: hydro2d.Results, cells: int) -> list[Quantity]:
    row, flow = _products(run.deck)
    speed, cj, _ = jwl.cj_state(row)
    state, time, history = cells_of(run), run.summary.time_s, run.history
    x, pressure = state.along(state.mean_pressure, "z")
    velocity = state.along(state.v, "z")[1]
    half = history["time"] > 0.5 * time
    end, size = speed * time, x[1] - x[0]
    behind = (x < end - 6.0 * size) & (x > 0.88 * end - 6.0 * size)
    burnt = x < end - 3.0 * size
    rho, u, p = flow.at(x[burnt], time)
    u_cj = cj / (row[0] * speed)

    def at_front(values: np.ndarray) -> float:
        return float(np.polyfit(x[behind] - end, values[behind], 2)[2])

    return [
        Quantity("speed of the front", "m/s", speed, float(np.polyfit(history["time"][half], history["front_m"][half], 1)[0])),
        Quantity("front behind D t", "cells", 0.0, float((end - history["front_m"][-1]) / size), end / size),
        Quantity("pressure of Chapman and Jouguet", "GPa", 1e-9 * cj, 1e-9 * at_front(pressure)),
        Quantity("velocity of Chapman and Jouguet", "m/s", u_cj, at_front(velocity)),
        Quantity("pressure at the wall", "GPa", 1e-9 * float(flow.p[0]), 1e-9 * float(pressure[x < 0.2 * end].mean())),
        profile("pressure", pressure[burnt], p),
        profile("velocity", velocity[burnt], u),
    ]


def _detonation_exact(x: np.ndarray) -> np.ndarray:
    problem = BY_NAME["detonation"]
    deck = hydro2d.Deck.from_file(FOLDER / problem.deck, problem.overrides("both", problem.cells[0]))
    _, flow = _products(deck)
    time = deck.stop.time
    return np.where(1e-3 * x < flow.speed * time, 1e-9 * flow.at(1e-3 * x, time)[2], 0.0)


PROBLEMS = (
    sedov(3),
    sedov(2),
    noh(1),
    noh(2),
    noh(3),
    Problem("collapse", "Uniform collapse (Noh's second problem)", "collapse.toml", "on 1 m", (50, 100, 200),
            partial(square, 1.0), _collapse, _collapse_curve, lambda x: np.full(x.shape, COLLAPSE.at(5e-4)[0]),
            ("distance [m]", "density [kg/m$^3$]"), advection("both")),
    Problem("guderley", "Guderley's implosion", "guderley.toml", "on 1.4 m", (50, 100, 200), partial(square, 1.4), _guderley,
            _guderley_curve, lambda x: 0.25 * x ** guderley.exponent(3, 1.4),
            ("time that is left, over that at 0.25 m", "radius of the front [m]"), advection("both"),
            {f"front_{name}_m": partial(_implosion, angle) for name, angle in IMPLOSION}),
    Problem("blake", "Blake's problem", "blake.toml", "per radius of the cavity", (10, 20, 40),
            lambda cells: square(1.02, round(10.2 * cells)), _blake, _blake_curve, lambda x: 1e3 * CAVITY.velocity(x, 160e-6),
            ("distance [m]", "radial velocity [mm/s]"), advection("both")),
    Problem("cavity_cylinder", "The same cavity as a cylinder", "cavity_cylinder.toml", "per radius of the cavity",
            (10, 20, 40),
            lambda cells: [f"mesh.r=[{{to=0.5, cells={5 * cells}}}]", f"mesh.z=[{{to={0.3 / cells}, cells=3}}]",
                           f"body.gas.z=[0, {0.3 / cells}]", f"body.rock.z=[0, {0.3 / cells}]",
                           *(f"tracer.at_{place}.z={0.15 / cells}" for place in (15, 20, 25))],
            _cylinder, _cylinder_curve, lambda x: 1e9 * blake.cylindrical(CAVITY, x * CAVITY.radius, 60e-6),
            ("distance [radii]", "displacement [nm]"), advection("both")),
    Problem("elastic_piston", "Elastic piston", "elastic_piston.toml", "on 40 mm", (100, 200, 400), partial(column, 0.04),
            _elastic_piston, _stress_curve,
            lambda x: np.where(1e-3 * x < 5e-6 * elastic_plastic.elastic(METAL[0], METAL[1], 20.0).speed,
                               1e-9 * elastic_plastic.elastic(METAL[0], METAL[1], 20.0).sigma, 0.0),
            ("z [mm]", "axial stress [GPa]"), advection("both")),
    Problem("elastic_plastic_piston", "Elastic-plastic piston", "elastic_plastic_piston.toml", "on 40 mm", (100, 200, 400),
            partial(column, 0.04), _elastic_plastic_piston, _stress_curve, lambda x: 1e-9 * _two_waves(1e-3 * x, 5e-6),
            ("z [mm]", "axial stress [GPa]"), advection("both")),
    Problem("breathing_sphere", "A free elastic sphere", "breathing_sphere.toml", "per radius", (10, 20, 40),
            lambda cells: square(0.0125, round(1.25 * cells)), _sphere, _sphere_curve, _sphere_exact,
            ("time [us]", "velocity of the mode [m/s]"), advection("both"), {"mode_m_s": _breathes}),
    Problem("shell_sphere", "A spherical shell that stops", "shell_sphere.toml", "across the wall", (5, 10, 20),
            lambda cells: square(0.108, round(5.4 * cells)), partial(_shell, 3), _shell_curve,
            partial(_shell_exact, 3), ("time [us]", "inner radius [mm]"),
            advection("both"), {"cavity_m": partial(_cavity, 3), "cavity_axis_m": partial(_cavity_along, "z"),
                                "cavity_equator_m": partial(_cavity_along, "r")}),
    Problem("shell_cylinder", "A cylindrical shell that stops", "shell_cylinder.toml", "across the wall", (5, 10, 20),
            lambda cells: [f"mesh.r=[{{to=0.108, cells={round(5.4 * cells)}}}]"], partial(_shell, 2), _shell_curve,
            partial(_shell_exact, 2), ("time [us]", "inner radius [mm]"),
            advection("both"), {"cavity_m": partial(_cavity, 2)}),
    Problem("riemann_jwl", "Products and aluminium", "riemann_jwl.toml", "on 80 mm", (80, 160, 320),
            lambda cells: column(0.04, cells, -0.04), _riemann, _axial_pressure,
            lambda x: 1e-9 * DRIVEN.sample(1e-3 * x / 4e-6)[2], ("z [mm]", "pressure [GPa]"), advection("both")),
    Problem("detonation", "Plane detonation of TNT", "../explosives/plane_charge.toml", "on 50 mm", (100, 200, 400),
            _detonation_refine, _detonation, _axial_pressure, _detonation_exact,
            ("z [mm]", "pressure [GPa]"), advection("both"), {"front_m": _lit}),
    *gases.PROBLEMS,
    *liquids.PROBLEMS,
)
BY_NAME = {problem.name: problem for problem in PROBLEMS}
