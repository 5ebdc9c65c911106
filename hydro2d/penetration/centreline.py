"""Motion along the centreline of a rod and its target, which the Walker-Anderson models integrate in time.

The velocity profiles along the axis are assumed: bilinear in the rod, a hemispherical plastic flow of radius alpha Rc in the
target. The momentum equation between the tail of the rod and the edge of that flow then gives the velocity of the
interface. Anderson, Int. J. Impact Engng 108 (2017) 3, equations (54) to (57); explanation/penetration/walker-anderson.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE
from hydro2d.penetration.model import InputError, complain, positive

#: the penetration ends when the interface is no faster than this, m/s, or than this share of its initial velocity
LAST_SPEED, LAST_SHARE = 1.0, 0.01
#: the rod is used up when no more than this share of its length is left
LAST_LENGTH = 1e-6
#: relative tolerance of the integration; absolute ones for velocities and lengths are this times the impact's
TOLERANCE = 1e-7
#: upper limit of the duration, in times in which the rod travels its length; no penetration lasts as long
LONGEST = 1e4
#: largest number of evaluations of the rates in one phase; a rod of 10 000 diameters needs 22 000
MOST_EVALUATIONS = 100_000


class Checked:
    """Numbers that must be positive (the slope of a Hugoniot: not negative); ``owner`` names them in error messages."""

    owner = ""

    def __post_init__(self):
        for name, value in vars(self).items():
            complain(f"{self.owner}.{name}", value, NON_NEGATIVE if name == "hugoniot_slope" else POSITIVE)


@dataclass(frozen=True)
class Rod(Checked):
    """density rho_p, dynamic flow stress sigma_p, Young's modulus E_p, Hugoniot c0 + k u, diameter D, length L; all SI."""

    density: float
    strength: float
    youngs_modulus: float
    sound_speed: float
    hugoniot_slope: float
    diameter: float
    length: float
    owner = "rod"


@dataclass(frozen=True)
class Target(Checked):
    """density rho_t, flow stress Y_t, shear modulus G_t, Hugoniot c0 + k u; all SI."""

    density: float
    strength: float
    shear_modulus: float
    sound_speed: float
    hugoniot_slope: float
    owner = "target"


@dataclass(frozen=True)
class Track:
    """One motion in time: ``states`` has the rows tail velocity, interface velocity, rod length, depth and any further ones.

    ``eroding_depth`` is the depth at which the tail became as slow as the interface (the last depth if it did not), and ``end``
    the index in ``Centreline.ends`` of the condition that ended the motion.
    """

    times: np.ndarray
    states: np.ndarray
    regime: str
    eroding_depth: float
    end: int = 0

    @property
    def depth(self) -> float:
        return float(self.states[3, -1])


def crater_radius(velocity: float, diameter: float) -> float:
    """Rc = (D/2) (1 + 0.287 V + 0.148 V^2), V in km/s: a fit to tungsten alloy into steel; m."""
    fast = 1e-3 * velocity
    return 0.5 * diameter * (1.0 + fast * (0.287 + 0.148 * fast))


def interface_velocity(velocity: float, rod: Rod, target: Target) -> float:
    """The initial velocity of the interface, m/s, from equal pressures behind plane shocks in rod and target.

    rho_p (c_p + k_p (V - u)) (V - u) = rho_t (c_t + k_t u) u
    """
    a = rod.density * rod.hugoniot_slope - target.density * target.hugoniot_slope
    b = rod.density * (rod.sound_speed + 2.0 * rod.hugoniot_slope * velocity) + target.density * target.sound_speed
    c = rod.density * velocity * (rod.sound_speed + rod.hugoniot_slope * velocity)
    return 2.0 * c / (b + math.sqrt(b * b - 4.0 * a * c))


def plastic_extent(u: float, target: Target) -> tuple[float, float]:
    """alpha, the radius of the plastic flow in crater radii, and d(alpha)/du in s/m, at the penetration velocity u.

    Anderson (2017), eq. (57): dynamic compressible cylindrical cavity expansion,

        (1 + rho u^2/Y) sqrt(K - rho alpha^2 u^2) = (1 + rho alpha^2 u^2/(2 G)) sqrt(K - rho u^2),  K = rho (c0 + k u)^2

    Squared, and divided by rho u^2, it is a quadratic for alpha^2 with one positive root: no iteration, and a finite value
    at rest, alpha^2 = (1 + 2 K/Y)/(1 + K/G). explanation/penetration/walker-anderson, equations 6 and 7
    """
    rho, y, slope = target.density, target.strength, target.hugoniot_slope
    half_compliance = 0.5 / target.shear_modulus
    shock = target.sound_speed + slope * u
    x, x_u = rho * u * u, 2.0 * rho * u
    k, k_u = rho * shock * shock, 2.0 * rho * shock * slope
    growth, growth_u = 1.0 + x / y, x_u / y
    square = half_compliance * half_compliance
    a = square * (k - x) * x
    a_u = square * ((k_u - x_u) * x + (k - x) * x_u)
    b = 2.0 * half_compliance * (k - x) + growth * growth
    b_u = 2.0 * half_compliance * (k_u - x_u) + 2.0 * growth * growth_u
    c = 1.0 + k / y * (1.0 + growth)
    c_u = (k_u * (1.0 + growth) + k * growth_u) / y
    root = math.sqrt(b * b + 4.0 * a * c)
    q = 2.0 * c / (b + root)
    alpha = math.sqrt(q)
    return alpha, 0.5 * (c_u - q * (a_u * q + b_u)) / (root * alpha)


class Centreline:
    """The motion of one shot; the state is tail velocity v, interface velocity u, rod length L, depth, and ``more``."""

    #: initial values of quantities that a subclass adds to the state
    more: tuple[float, ...] = ()

    def __init__(self, velocity: float, rod: Rod, target: Target, radius: float | None = None):
        positive(velocity=velocity)
        self.velocity, self.rod, self.target = velocity, rod, target
        self.radius = crater_radius(velocity, rod.diameter) if radius is None else radius
        positive(**{"crater.radius": self.radius})
        self.bar_speed = math.sqrt(rod.youngs_modulus / rod.density)
        self.check()
        self.first = interface_velocity(velocity, rod, target)
        self.last = min(LAST_SPEED, LAST_SHARE * self.first)

    def check(self) -> None:
        """Raises InputError for materials that the equations cannot describe."""
        if self.target.strength >= 2.0 * self.target.shear_modulus:
            raise InputError("target.strength must be below 2 target.shear_modulus, or no plastic flow surrounds the crater")
        if self.target.sound_speed + (self.target.hugoniot_slope - 1.0) * self.velocity <= 0.0:
            raise InputError(f"velocity = {self.velocity:g}: faster than a shock in the target, whose Hugoniot is too flat")

    def resisting(self, u: float, alpha: float, state: list[float]) -> float:
        """rho_t u^2/2 + (7/3) Yt ln(alpha), Pa: the last terms of Anderson (2017), eq. (54)."""
        return 0.5 * self.target.density * u * u + 7.0 / 3.0 * self.target.strength * math.log(alpha)

    def further(self, u: float, alpha: float, state: list[float]) -> tuple[float, ...]:
        """Rates of the quantities that follow the depth in the state."""
        return ()

    def carried(self, u: float, alpha: float, alpha_u: float) -> float:
        """Mass of target per area that du/dt drives, kg/m^2: rho_t Rc ((alpha-1)/(alpha+1) + 2 u alpha'/(alpha+1)^2)."""
        return self.target.density * self.radius * (alpha - 1.0 + 2.0 * u * alpha_u / (alpha + 1.0)) / (alpha + 1.0)

    def eroding(self, time: float, state: np.ndarray) -> list[float]:
        """d(state)/dt of Anderson (2017), eqs. (54) to (56): two linear equations for dv/dt and du/dt.

        (v - u)/s = 2 u/(Rc (1 - 1/alpha^2)) depends on u alone, so that (54) stays finite where s vanishes; (55) is
        multiplied by L - s.
        """
        values = state.tolist()
        v, u, length = values[:3]
        if not self.inside(u, length):
            return [math.nan] * len(values)
        alpha, alpha_u = plastic_extent(u, self.target)
        rho, half = self.rod.density, 0.5 * self.radius
        shape, shape_u = 1.0 - alpha**-2, 2.0 * alpha**-3 * alpha_u
        slip = v / u - 1.0
        s, s_v, s_u = half * slip * shape, half * shape / u, half * (slip * shape_u - v * shape / (u * u))
        gradient_u = (1.0 - u * shape_u / shape) / (half * shape)
        wave = self.rod.strength / (rho * self.bar_speed)
        a, b = rho * (length - s), rho * s * (1.0 + 0.5 * s * gradient_u) + self.carried(u, alpha, alpha_u)
        c, d = length - s + wave * s_v, wave * s_u
        push, drag = 0.5 * rho * (v - u) ** 2 - self.resisting(u, alpha, values), -wave * (self.bar_speed + v - u)
        determinant = a * d - b * c
        slowing = (push * d - b * drag) / determinant, (a * drag - push * c) / determinant
        return [*slowing, u - v, u, *self.further(u, alpha, values)]

    def rigid(self, time: float, state: np.ndarray) -> list[float]:
        """d(state)/dt once v = u: eq. (54) with s = 0; rod and flow slow down together.

        The deceleration never exceeds that by the rod's waves, (55), because v can meet u from above only where they suffice.
        """
        values = state.tolist()
        u, length = values[1:3]
        if not self.inside(u, length):
            return [math.nan] * len(values)
        alpha, alpha_u = plastic_extent(u, self.target)
        slowing = -self.resisting(u, alpha, values) / (self.rod.density * length + self.carried(u, alpha, alpha_u))
        return [slowing, slowing, 0.0, u, *self.further(u, alpha, values)]

    def plastic_zone(self, v: float, u: float) -> float:
        """s = (Rc/2) (v/u - 1) (1 - 1/alpha^2), the length of the rod that flows, m."""
        return 0.5 * self.radius * (v / u - 1.0) * (1.0 - plastic_extent(u, self.target)[0] ** -2)

    def inside(self, u: float, length: float) -> bool:
        """Whether the equations hold; if a trial step leaves their range, the integrator takes a shorter one."""
        return 0.0 < u < 2.0 * self.velocity and length > 0.0

    def ends(self) -> list[Callable]:
        """Functions whose fall through zero ends the motion: the interface comes to rest, or the rod is used up."""
        return [lambda time, state: state[1] - self.last, lambda time, state: state[2] - LAST_LENGTH * self.rod.length]

    def solve(self) -> Track:
        """The motion from impact to its end: first eroding, then rigid once the tail is as slow as the interface."""
        start = np.array([self.velocity, self.first, self.rod.length, 0.0, *self.more])
        first = self.integrate(self.eroding, 0.0, start, [*self.ends(), lambda time, state: state[0] - state[1]])
        times, states, depth = first.t, first.y, float(first.y[3, -1])
        if not first.t_events[-1].size:
            return Track(times, states, "consumed" if _end(first) == 1 else "eroding", depth, _end(first))
        then = self.integrate(self.rigid, times[-1], states[:, -1], self.ends())
        return Track(np.append(times, then.t), np.hstack([states, then.y]), "eroding, then rigid", depth, _end(then))

    def integrate(self, rates: Callable, time: float, state: np.ndarray, events: list[Callable]):
        """One phase, to the first of its events, as ``solve_ivp`` gives it."""
        from scipy.integrate import solve_ivp

        count = itertools.count()

        def counted(time: float, state: np.ndarray) -> list[float]:
            if next(count) == MOST_EVALUATIONS:
                raise InputError(f"the Walker-Anderson equations have not ended after {MOST_EVALUATIONS} "
                                 "evaluations: the rod is too slender, or the resistance too small, for them")
            return rates(time, state)

        for event in events:
            event.terminal, event.direction = True, -1.0
        scale = np.full(state.size, self.rod.length)
        scale[:2] = self.velocity
        longest = LONGEST * self.rod.length / self.velocity
        phase = solve_ivp(
            counted, (time, time + longest), state, "DOP853", events=events, rtol=TOLERANCE, atol=TOLERANCE * scale)
        if phase.status != 1:
            raise InputError(f"the Walker-Anderson equations do not come to an end for these values ({phase.message})")
        return phase


def _end(phase) -> int:
    return next(index for index, when in enumerate(phase.t_events) if when.size)
