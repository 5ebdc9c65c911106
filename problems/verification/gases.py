"""Problems with exact solutions of gases and compressed metal: a gun, products in vacuum, a shock at a wall, Noh's problem,
and Coggeshall's flows."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

import hydro2d
from problems.verification.cells import crossing
from problems.verification.exact import oblique
from problems.verification.exact.coggeshall import Free, Slowed
from problems.verification.exact.escape import Escape
from problems.verification.exact.gun import Gun
from problems.verification.exact.impact import AL_5083
from problems.verification.exact.noh_solid import NohSolid
from problems.verification.layers import override
from problems.verification.measures import Curve, Problem, Quantity, advection, cells_of, column, lost, profile, square
from problems.verification.shells import tubes

# The gas gun

GUN, BREECH = Gun(70.0, 50e6, 1.4, 2785.0 * 0.05), 1.0


def _projectile(simulation: hydro2d.Simulation) -> float:
    return simulation.mean_velocity(0)


def _gun(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, history, time = cells_of(run), run.history, run.summary.time_s
    x, pressure = state.along(state.mean_pressure, "z")
    velocity = state.along(state.v, "z")[1]
    simple = (x > GUN.returned(time, BREECH) + 0.05) & (x < float(GUN.position(time)) - 3.0 * state.size)
    _, u, p = GUN.sample(x[simple], time)
    return [
        *(Quantity(f"velocity at {1e3 * each:g} ms", "m/s", float(GUN.velocity(each)),
                   float(np.interp(each, history["time"], history["projectile_m_s"]))) for each in (0.4e-3, 1.6e-3)),
        Quantity("distance at 1.6 ms", "mm", 1e3 * float(GUN.position(time)), 1e3 * _travelled(run)),
        profile("pressure", pressure[simple], p),
        profile("velocity of the gas", velocity[simple], u),
    ]


def _travelled(run: hydro2d.Results) -> float:
    """Distance that the middle of the projectile has moved, m."""
    state = cells_of(run)
    mass = state.vof[0] * state.rho[0] * state.volume
    return float(np.sum(mass * state.z) / np.sum(mass)) - 0.025


def _gun_curve(run: hydro2d.Results) -> Curve:
    return 1e3 * run.history["time"], run.history["projectile_m_s"]


# Products that escape

ESCAPE = Escape(1875.0, 8000.0, 0.05)


def _escape_refine(cells: int) -> list[str]:
    size = ESCAPE.length / cells
    return [*column(0.1, 3 * cells, -0.05), f"source.fuse.points={[[(k + 0.5) * size, 0.0, 0.0] for k in range(4)]}"]


def _escape(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    x, density = state.along(state.density, "z")
    pressure, velocity = state.along(state.mean_pressure, "z")[1], state.along(state.v, "z")[1]
    rho, u, p = ESCAPE.sample(x, time)
    low, high = ESCAPE.ends(time)
    fine = np.linspace(low, high, 100_001)
    exact_rho, exact_u, exact_p = ESCAPE.sample(fine, time)
    kinetic = np.trapezoid(0.5 * exact_rho * exact_u**2, fine)
    forward = np.trapezoid(exact_rho * np.maximum(exact_u, 0.0), fine)
    balance = run.summary.conservation
    total = balance.kinetic_energy_J + balance.internal_energy_J
    return [
        Quantity("largest pressure", "GPa", 1e-9 * float(exact_p.max()), 1e-9 * float(pressure.max())),
        Quantity("momentum forward", "kg/(m s)", forward, float(np.sum(density * np.maximum(velocity, 0.0)) * state.size)),
        Quantity("kinetic energy", "%", 100.0 * kinetic / (ESCAPE.energy * ESCAPE.length),
                 100.0 * balance.kinetic_energy_J / total),
        Quantity("mass beyond the exact ends", "%", 0.0,
                 100.0 * float(density[(x < low) | (x > high)].sum() / density.sum()), 100.0),
        profile("density", density, rho),
        profile("pressure", pressure, p),
        profile("momentum", density * velocity, rho * u),
    ]


def _pressure_curve(run: hydro2d.Results) -> Curve:
    state = cells_of(run)
    x, y = state.along(state.mean_pressure, "z")
    return 1e3 * x, 1e-9 * y


# The reflection of a shock

REFLECTION, AHEAD = oblique.reflection(2.0, math.radians(30.0)), (1e5, 1.2)
#: speed of the point where the shocks meet, m/s, and where it starts, m
POINT_SPEED, POINT_START = 4.0 * math.sqrt(1.4 * AHEAD[0] / AHEAD[1]), 0.2


def _reflection_refine(cells: int) -> list[str]:
    return [f"mesh.r=[{{to=0.76, cells={round(0.76 * cells)}}}]", f"mesh.z=[{{to=1.5, cells={round(1.5 * cells)}}}]"]


def _reflection(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    pressure, point = state.mean_pressure, POINT_START + POINT_SPEED * time
    once, twice = AHEAD[0] * REFLECTION.first.pressure, AHEAD[0] * REFLECTION.pressure
    behind, angle = point - state.z, np.degrees(np.arctan2(state.r, point - state.z))
    reflected = math.degrees(REFLECTION.reflected)
    here = (behind > 0.08) & (behind < 0.25) & (angle > 0.2 * reflected) & (angle < 0.7 * reflected)
    first = (state.r > 0.12) & (state.r < 0.25) & (behind > 0.1 - math.sqrt(3.0) * state.r)
    first &= behind < state.r / math.tan(REFLECTION.reflected) - 0.12
    columns = np.nonzero((state.columns > 0.05) & (state.columns < 0.15))[0]
    incident = [crossing(state.rows, pressure[:, i], 0.5 * (AHEAD[0] + once)) for i in columns]
    rows = np.nonzero((point - state.rows > 0.08) & (point - state.rows < 0.25))[0]
    second = [crossing(state.columns, pressure[j], 0.5 * (once + twice)) for j in rows]
    slope, start = np.polyfit(state.columns[columns], incident, 1)
    other = np.polyfit(point - state.rows[rows], second, 1)[0]
    density = AHEAD[1] * REFLECTION.density
    return [
        Quantity("pressure behind the first shock", "MPa", 1e-6 * once, 1e-6 * float(pressure[first].mean())),
        Quantity("pressure behind its reflection", "MPa", 1e-6 * twice, 1e-6 * float(pressure[here].mean())),
        Quantity("density behind its reflection", "kg/m3", density, float(state.density[here].mean())),
        Quantity("angle of the first shock", "degrees", 30.0, math.degrees(math.atan(1.0 / slope))),
        Quantity("angle of its reflection", "degrees", reflected, math.degrees(math.atan(other))),
        Quantity("first shock ahead of its place", "cells", 0.0, float((start - point) / state.size), 0.8 / state.size),
        lost(run),
    ]


def _wall_curve(run: hydro2d.Results) -> Curve:
    state = cells_of(run)
    here = state.rows > 0.7
    return state.rows[here], 1e-6 * state.mean_pressure[here, 0]


# Metal that converges

METAL = {j: NohSolid(j, AL_5083, 1000.0) for j in (1, 2, 3)}


def _metal(j: int, run: hydro2d.Results, cells: int) -> list[Quantity]:
    exact, state, time = METAL[j], cells_of(run), run.summary.time_s
    place = state.distance if j == 3 else state.r
    front = exact.shock_speed * time
    behind, inside = (place > 0.3 * front) & (place < 0.8 * front), place < 0.036
    rho, pressure, _ = exact.behind
    exact_rho, _, exact_p = exact.sample(place, time)

    def mean(values: np.ndarray, where: np.ndarray) -> float:
        return float(np.average(values[where], weights=state.volume[where]))

    quantities = [
        Quantity("density behind the shock", "kg/m3", rho, mean(state.density, behind)),
        Quantity("pressure behind the shock", "GPa", 1e-9 * pressure, 1e-9 * mean(state.mean_pressure, behind)),
        Quantity("density next to the centre", "kg/m3", rho, mean(state.density, place < 1.5 * state.size)),
    ]
    if j > 1:
        ahead = (place > 1.15 * front) & (place < 1.4 * front)
        quantities.append(Quantity("pressure ahead of the shock", "GPa", 1e-9 * mean(exact_p, ahead),
                                   1e-9 * mean(state.mean_pressure, ahead)))
    return [
        *quantities,
        profile("density", state.density[inside], exact_rho[inside], state.volume[inside]),
        profile("pressure", state.mean_pressure[inside], exact_p[inside], state.volume[inside]),
        lost(run),
    ]


def _metal_curve(j: int, run: hydro2d.Results) -> Curve:
    """Pressure, with distances scaled to 3 us, because the last step of a run ends a little later."""
    state = cells_of(run)
    x, y = state.shells(state.mean_pressure, 0.036) if j == 3 else state.along(state.mean_pressure, "r")
    return 1e3 * x[x < 0.036] * 3e-6 / run.summary.time_s, 1e-9 * y[x < 0.036]


def _noh_metal(j: int) -> Problem:
    name, title = {1: ("noh_metal", "planar"), 2: ("noh_metal_cylindrical", "cylindrical"),
                   3: ("noh_metal_spherical", "spherical")}[j]

    def refine(cells: int) -> list[str]:
        thin = [f"mesh.r=[{{to=0.06, cells={cells}}}]", f"mesh.z=[{{to={0.24 / cells}, cells=4}}]"]
        return square(0.06, cells) if j == 3 else thin

    return Problem(name, f"Noh's problem for a metal, {title}", f"{name}.toml", "on 60 mm", (50, 100, 200), refine,
                   partial(_metal, j), partial(_metal_curve, j), lambda x: 1e-9 * METAL[j].sample(1e-3 * x, 3e-6)[2],
                   ("distance [mm]", "pressure [GPa]"), advection("both"))


# Coggeshall's flows

COLLAPSES, EXPANDS = Free(1, 1.0, 5.0 / 3.0, 1.0, 1e5 / 3.0, 1e-3), Slowed(1, 1.0, 1.4, 1.0, 1e-3)


def _coggeshall(flow: Free | Slowed, run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, time = cells_of(run), run.summary.time_s
    here = state.r < (0.8 * flow.untouched(1.0, time) if isinstance(flow, Free) else 0.9)
    rho, u, p = flow.sample(state.r, time)
    exact, weight = (rho, np.abs(u), p), state.volume[here]
    found = {"density": (state.density, "kg/m3", 1.0), "speed": (np.abs(state.u), "m/s", 1.0),
             "pressure": (state.mean_pressure, "kPa", 1e-3)}
    quantities = []
    for (name, (values, unit, size)), right in zip(found.items(), exact, strict=True):
        quantities.append(Quantity(f"mean {name}", unit, size * float(np.average(right[here], weights=weight)),
                                   size * float(np.average(values[here], weights=weight))))
    for (name, (values, *_)), right in zip(found.items(), exact, strict=True):
        quantities.append(profile(name, values[here], right[here], weight))
    return [*quantities, lost(run)]


def _coggeshall_curve(run: hydro2d.Results) -> Curve:
    state = cells_of(run)
    x, y = state.along(state.density, "r")
    return x[x < 0.9], y[x < 0.9]


def _coggeshall_problem(number: int, flow: Free | Slowed, end: float, title: str) -> Problem:
    def refine(cells: int) -> list[str]:
        return [f"mesh.r=[{{to=1.0, cells={cells}}}]", f"mesh.z=[{{to={4 / cells}, cells=4}}]",
                override(tubes(flow, 1.0, 1.0 / cells, 4.0 / cells))]

    return Problem(f"coggeshall_{number}", title, f"coggeshall_{number}.toml", "on 1 m", (40, 80, 160), refine,
                   partial(_coggeshall, flow), _coggeshall_curve, lambda x: flow.sample(x, end)[0],
                   ("distance [m]", "density [kg/m$^3$]"), advection("both"))


PROBLEMS = (
    _noh_metal(1),
    _noh_metal(2),
    _noh_metal(3),
    Problem("shock_reflection", "A shock that meets a wall at an angle", "shock_reflection.toml", "per metre", (50, 100, 200),
            _reflection_refine, _reflection, _wall_curve,
            lambda x: np.where(x > 1.0, 0.1, 0.1 * REFLECTION.pressure),
            ("z [m]", "pressure at the wall [MPa]"), advection("both")),
    Problem("gas_gun", "A gas gun", "gas_gun.toml", "on 1.6 m", (64, 128, 256), lambda cells: column(0.6, cells, -1.0), _gun,
            _gun_curve, lambda x: GUN.velocity(1e-3 * x), ("time [ms]", "velocity [m/s]"), advection("both"),
            {"projectile_m_s": _projectile}),
    Problem("escape", "Products that escape into vacuum", "escape.toml", "on 50 mm", (50, 100, 200), _escape_refine, _escape,
            _pressure_curve, lambda x: 1e-9 * ESCAPE.sample(1e-3 * x, 10e-6)[2], ("z [mm]", "pressure [GPa]"),
            advection("both")),
    _coggeshall_problem(1, COLLAPSES, 0.4e-3, "Coggeshall's first flow, a collapse"),
    _coggeshall_problem(2, EXPANDS, 1e-3, "Coggeshall's second flow, an expansion"),
)
