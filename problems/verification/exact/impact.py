"""Plane impact of solids without strength: Mie-Grueneisen about a straight Hugoniot U = c0 + s u.

    p(rho, e) = f(rho) + Gamma0 rho0 e,   f = rho0 c0^2 eta (1 - Gamma0 eta/2)/(1 - s eta)^2,  eta = 1 - rho0/rho >= 0
                                          f = rho0 c0^2 (rho/rho0 - 1)                         in tension

Source: the jump conditions (Zel'dovich and Raizer, chapter XI); SI units, pressure positive in compression.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.integrate import solve_ivp
from scipy.optimize import brentq


@dataclass(frozen=True)
class Solid:
    """Constants of a Mie-Grueneisen solid: kg/m^3, m/s, -, -."""

    rho0: float
    c0: float
    s: float
    gamma0: float

    def cold(self, rho: float) -> float:
        """The part f(rho) of the pressure, Pa."""
        eta = 1 - self.rho0 / rho
        stiffness = self.rho0 * self.c0**2
        if eta < 0:
            return stiffness * (rho / self.rho0 - 1)
        return stiffness * eta * (1 - self.gamma0 * eta / 2) / (1 - self.s * eta) ** 2

    def pressure(self, rho: float, e: float) -> float:
        """p(rho, e), Pa."""
        return self.cold(rho) + self.gamma0 * self.rho0 * e

    def sound_speed_squared(self, rho: float, e: float) -> float:
        """dp/drho at constant e plus p/rho^2 dp/de, m^2/s^2."""
        eta = 1 - self.rho0 / rho
        if eta < 0:
            slope = self.c0**2
        else:
            hugoniot = self.rho0 * self.c0**2 * eta / (1 - self.s * eta) ** 2
            steepness = self.rho0 * self.c0**2 * (1 + self.s * eta) / (1 - self.s * eta) ** 3
            slope = self.rho0 / rho**2 * (steepness * (1 - self.gamma0 * eta / 2) - self.gamma0 * hugoniot / 2)
        return slope + self.pressure(rho, e) / rho**2 * self.gamma0 * self.rho0


@dataclass(frozen=True)
class Shocked:
    """State behind a plane shock into a solid at rest: u and speed relative to the solid ahead."""

    rho: float
    u: float
    p: float
    e: float
    speed: float


def shock(solid: Solid, u: float) -> Shocked:
    """The shock that sets a solid at rho0, p = 0, e = 0 moving at u >= 0."""
    speed = solid.c0 + solid.s * u
    return Shocked(solid.rho0 * speed / (speed - u), u, solid.rho0 * speed * u, u**2 / 2, speed)


def shock_from(solid: Solid, rho1: float, p1: float, p: float) -> Shocked:
    """The shock from rho1, p1, e = 0 to pressure p > p1, by the Hugoniot relation e = (p + p1)/2 (1/rho1 - 1/rho)."""
    heat = solid.gamma0 * solid.rho0

    def excess(rho: float) -> float:
        return solid.cold(rho) + heat * (p + p1) / 2 * (1 / rho1 - 1 / rho) - p

    rho = brentq(excess, rho1, 0.98 * solid.rho0 / (1 - 1 / solid.s), xtol=1e-12 * rho1, rtol=1e-15)
    volume_change = 1 / rho1 - 1 / rho
    u = math.sqrt((p - p1) * volume_change)
    return Shocked(rho, u, p, (p + p1) / 2 * volume_change, (p - p1) / (rho1 * u))


@dataclass(frozen=True)
class Impact:
    """Flyer on resting target: both states in the target's frame, before any wave returns."""

    u: float
    p: float
    target: Shocked
    flyer: Shocked


def impact(flyer: Solid, target: Solid, velocity: float) -> Impact:
    """Impedance match rho_t (c_t + s_t u) u = rho_f (c_f + s_f (V - u)) (V - u), a quadratic in u."""
    a = target.rho0 * target.s - flyer.rho0 * flyer.s
    b = target.rho0 * target.c0 + flyer.rho0 * (flyer.c0 + 2 * flyer.s * velocity)
    c = -flyer.rho0 * (flyer.c0 + flyer.s * velocity) * velocity
    u = -2 * c / (b + math.sqrt(b**2 - 4 * a * c))
    behind = shock(target, u)
    return Impact(u, behind.p, behind, shock(flyer, velocity - u))


def release(solid: Solid, state: Shocked, p_end: float = 0.0) -> tuple[float, float, float]:
    """Density, energy, and velocity gained (m/s, >= 0) in isentropic release of a shocked state to p_end."""

    def along(rho, y):
        return [solid.pressure(rho, y[0]) / rho**2, -math.sqrt(solid.sound_speed_squared(rho, y[0])) / rho]

    def at_end(rho, y):
        return solid.pressure(rho, y[0]) - p_end

    at_end.terminal = True
    lowest = 0.5 * solid.rho0
    path = solve_ivp(along, (state.rho, lowest), [state.e, 0.0], events=at_end, rtol=1e-11, atol=1e-9, max_step=5.0)
    rho, (e, gained) = path.t_events[0][0], path.y_events[0][0]
    return float(rho), float(e), float(gained)


def free_surface_velocity(solid: Solid, state: Shocked) -> float:
    """Velocity of the target's free surface after the shock has come through, m/s."""
    return state.u + release(solid, state)[2]


def gas_on_solid(rho: float, p: float, gamma: float, solid: Solid, p0: float = 1e5) -> tuple[float, float, Shocked]:
    """A hot ideal gas at rest drives a solid at rest and pressure p0: p, u of the contact and the solid's shock.

    The gas expands isentropically, u = 2 c/(gamma - 1) (1 - (p*/p)^((gamma - 1)/(2 gamma))).
    """
    rho1 = brentq(lambda density: solid.cold(density) - p0, solid.rho0, 1.01 * solid.rho0, rtol=1e-15)
    c = math.sqrt(gamma * p / rho)

    def gas_velocity(p_star: float) -> float:
        return 2 * c / (gamma - 1) * (1 - (p_star / p) ** ((gamma - 1) / (2 * gamma)))

    p_star = brentq(lambda q: gas_velocity(q) - shock_from(solid, rho1, p0, q).u, p0 * 1.0001, p, rtol=1e-14)
    return p_star, gas_velocity(p_star), shock_from(solid, rho1, p0, p_star)


def pull_back(solid: Solid, p_cut: float) -> float:
    """Drop of the free-surface velocity that a spall strength p_cut causes, acoustic: 2 p_cut/(rho0 c0), m/s."""
    return 2 * p_cut / (solid.rho0 * solid.c0)


#: Constants of the CTH nose-shape study's Table 1.
TUNGSTEN = Solid(18160.0, 4030.0, 1.237, 1.67)
AL_5083 = Solid(2660.0, 5340.0, 1.40, 1.97)
AL_7039 = Solid(2770.0, 5200.0, 1.36, 2.20)
