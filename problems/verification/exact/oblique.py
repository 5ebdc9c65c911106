"""Oblique shocks of an ideal gas, and the regular reflection of a shock that meets a wall at an angle.

A shock at the angle beta to a flow of Mach number M turns it by theta,

    tan(theta) = 2 cot(beta) (M^2 sin^2(beta) - 1)/(M^2 (gamma + cos(2 beta)) + 2).

Seen from the point where a shock of Mach number S touches the wall at the angle alpha, gas flows along the wall at M =
S/sin(alpha), is turned towards the wall by the incident shock, and turned back by the weak reflected shock. Two shocks that
meet in a plane of symmetry are the same flow.

Source: Liepmann and Roshko, Elements of Gasdynamics (1957), chapter 4; von Neumann, Oblique reflection of shocks (1943).
Angles in radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq, minimize_scalar


def deflection(mach: float, beta: float, gamma: float = 1.4) -> float:
    """theta behind a shock at beta."""
    normal = (mach * math.sin(beta)) ** 2
    return math.atan(2.0 / math.tan(beta) * (normal - 1.0) / (mach**2 * (gamma + math.cos(2.0 * beta)) + 2.0))


@dataclass(frozen=True)
class Oblique:
    """Behind a shock at beta: ratios of pressure and density to those ahead, theta, and the Mach number."""

    beta: float
    theta: float
    pressure: float
    density: float
    mach: float


def behind(mach: float, beta: float, gamma: float = 1.4) -> Oblique:
    """The state behind a shock at beta."""
    normal, theta = (mach * math.sin(beta)) ** 2, deflection(mach, beta, gamma)
    left = (1.0 + 0.5 * (gamma - 1.0) * normal) / (gamma * normal - 0.5 * (gamma - 1.0))
    pressure = 1.0 + 2.0 * gamma / (gamma + 1.0) * (normal - 1.0)
    density = (gamma + 1.0) * normal / ((gamma - 1.0) * normal + 2.0)
    return Oblique(beta, theta, pressure, density, math.sqrt(left) / math.sin(beta - theta))


def weak(mach: float, theta: float, gamma: float = 1.4) -> Oblique:
    """The weak shock that turns a flow by theta; ValueError where none does."""
    least = math.asin(1.0 / mach)
    steepest = minimize_scalar(lambda beta: -deflection(mach, beta, gamma), bounds=(least, 0.5 * math.pi), method="bounded",
                               options={"xatol": 1e-12}).x
    if deflection(mach, steepest, gamma) < theta:
        raise ValueError("no shock at the wall turns the flow so far")
    return behind(mach, float(brentq(lambda beta: deflection(mach, beta, gamma) - theta, least, steepest, xtol=1e-14)), gamma)


@dataclass(frozen=True)
class Reflection:
    """A shock of this Mach number at the angle alpha to a wall: the states behind it and behind its reflection.

    second : relative to the state behind the first
    """

    shock_mach: float
    alpha: float
    first: Oblique
    second: Oblique

    @property
    def pressure(self) -> float:
        """Pressure at the wall over that ahead."""
        return self.first.pressure * self.second.pressure

    @property
    def density(self) -> float:
        """Density at the wall over that ahead."""
        return self.first.density * self.second.density

    @property
    def reflected(self) -> float:
        """Angle of the reflected shock to the wall."""
        return self.second.beta - self.first.theta


def reflection(shock_mach: float, alpha: float, gamma: float = 1.4) -> Reflection:
    """Regular reflection; ValueError where alpha is too large for it."""
    first = behind(shock_mach / math.sin(alpha), alpha, gamma)
    return Reflection(shock_mach, alpha, first, weak(first.mach, first.theta, gamma))
