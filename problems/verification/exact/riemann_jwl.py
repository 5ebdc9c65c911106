"""The Riemann problem of two states of the products of an explosive, after Jones, Wilkins and Lee.

    p = f(rho) + omega rho e,   f = A (1 - omega/(R1 V)) exp(-R1 V) + B (1 - omega/(R2 V)) exp(-R2 V),   V = rho0/rho

Its isentropes are p = A exp(-R1 V) + B exp(-R2 V) + C V^-(1 + omega), and its shocks obey the jump conditions.

Source: Lee, Hornig and Kury, UCRL-50422 (1968); the problem of `shyue` is that of Shyue, J. Comput. Phys. 171 (2001) 678, which
ExactPack solves as well. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from problems.verification.exact.impact import Shocked, Solid, shock_from


@dataclass(frozen=True)
class Products:
    """Constants of the products: Pa, Pa, -, -, -, kg/m^3."""

    a: float
    b: float
    r1: float
    r2: float
    omega: float
    rho0: float

    def cold(self, rho):
        """f(rho), Pa."""
        v = self.rho0 / rho
        first = self.a * (1.0 - self.omega / (self.r1 * v)) * np.exp(-self.r1 * v)
        return first + self.b * (1.0 - self.omega / (self.r2 * v)) * np.exp(-self.r2 * v)

    def energy(self, rho: float, p: float) -> float:
        """e(rho, p), J/kg."""
        return (p - self.cold(rho)) / (self.omega * rho)


@dataclass(frozen=True)
class State:
    """A constant state of the products."""

    products: Products
    rho: float
    u: float
    p: float

    @cached_property
    def _hot(self) -> float:
        """C of the isentrope through this state."""
        m, v = self.products, self.products.rho0 / self.rho
        return (self.p - m.a * math.exp(-m.r1 * v) - m.b * math.exp(-m.r2 * v)) * v ** (1.0 + m.omega)

    def isentrope(self, rho):
        """(p, c) on the isentrope at density rho."""
        m, v = self.products, self.products.rho0 / rho
        first, second = m.a * np.exp(-m.r1 * v), m.b * np.exp(-m.r2 * v)
        third = self._hot * v ** -(1.0 + m.omega)
        stiffness = v * (m.r1 * first + m.r2 * second) + (1.0 + m.omega) * third
        return first + second + third, np.sqrt(stiffness / rho)

    def _shocked(self, p: float) -> float:
        """Density behind a shock to pressure p, from e - e0 = (p + p0)/2 (1/rho0 - 1/rho)."""
        m, e = self.products, self.products.energy(self.rho, self.p)

        def excess(rho: float) -> float:
            return m.energy(rho, p) - e - 0.5 * (p + self.p) * (1.0 / self.rho - 1.0 / rho)

        high = self.rho * (2.0 / m.omega + 1.0)
        return brentq(excess, self.rho, high, xtol=1e-13 * high)

    def behind(self, p: float) -> tuple[float, float]:
        """(density, change of velocity) behind the wave to pressure p; the change is positive for a shock."""
        if p > self.p:
            rho = self._shocked(p)
            return rho, math.sqrt((p - self.p) * (1.0 / self.rho - 1.0 / rho))
        rho = brentq(lambda rho: self.isentrope(rho)[0] - p, 1e-6 * self.rho, 1.001 * self.rho, xtol=1e-13 * self.rho)
        return rho, -self._widened(rho)[1][-1]

    def _widened(self, rho: float, points: int = 4001) -> tuple[np.ndarray, np.ndarray]:
        """Densities from this state down to rho, and the integrals of c d(rho)/rho to them, by Simpson's rule on halves."""
        logarithms = np.linspace(math.log(self.rho), math.log(rho), points)
        c = self.isentrope(np.exp(logarithms))[1]
        middle = self.isentrope(np.exp(0.5 * (logarithms[1:] + logarithms[:-1])))[1]
        steps = (c[1:] + 4.0 * middle + c[:-1]) / 6.0 * -np.diff(logarithms)
        return np.exp(logarithms), np.concatenate([[0.0], np.cumsum(steps)])


@dataclass(frozen=True)
class Solution:
    """The solution of `left | right`, self-similar in x/t."""

    left: State
    right: State
    p: float

    @property
    def u(self) -> float:
        """Velocity of the contact."""
        return 0.5 * (self.left.u - self.left.behind(self.p)[1] + self.right.u + self.right.behind(self.p)[1])

    @property
    def densities(self) -> tuple[float, float]:
        """On the left and on the right of the contact."""
        return self.left.behind(self.p)[0], self.right.behind(self.p)[0]

    def wave(self, state: State, side: int) -> tuple[float, float]:
        """Speeds of the outer and inner edge of the wave on a side, -1 or +1; equal for a shock."""
        rho, _ = state.behind(self.p)
        if self.p > state.p:
            speed = state.u + (self.u - state.u) * rho / (rho - state.rho)
            return speed, speed
        return state.u + side * float(state.isentrope(state.rho)[1]), self.u + side * float(state.isentrope(rho)[1])

    def sample(self, xi) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """rho, u, p at the similarity coordinates xi = x/t."""
        xi = np.asarray(xi, dtype=float)
        rho, u, p = np.empty(xi.shape), np.empty(xi.shape), np.empty(xi.shape)
        for state, side, here in ((self.left, -1, xi < self.u), (self.right, +1, xi >= self.u)):
            head, tail = self.wave(state, side)
            outside, fan = here & (side * xi >= side * head), here & (side * xi < side * head) & (side * xi > side * tail)
            behind = here & ~outside & ~fan
            rho[outside], u[outside], p[outside] = state.rho, state.u, state.p
            rho[behind], u[behind], p[behind] = state.behind(self.p)[0], self.u, self.p
            if fan.any():
                along, change = state._widened(state.behind(self.p)[0])
                pressure, c = state.isentrope(along)
                velocity = state.u - side * change
                place = side * (velocity + side * c)  # falls along the fan
                order = np.argsort(place)
                for out, values in ((rho, along), (u, velocity), (p, pressure)):
                    out[fan] = np.interp(side * xi[fan], place[order], values[order])
        return rho, u, p


def solve(left: State, right: State) -> Solution:
    """Solves a Riemann problem in which no vacuum opens."""
    low, high = 1e-6 * min(left.p, right.p), 4.0 * max(left.p, right.p)

    def excess(p: float) -> float:
        return left.behind(p)[1] + right.behind(p)[1] - (left.u - right.u)

    return Solution(left, right, brentq(excess, low, high, rtol=1e-14))


def shyue() -> Solution:
    """Shyue's problem: (1700, 0, 1000 GPa) | (1000, 0, 50 GPa) in the products of PBX-9404."""
    products = Products(854.5e9, 20.5e9, 4.6, 1.35, 0.25, 1840.0)
    return solve(State(products, 1700.0, 0.0, 1e12), State(products, 1000.0, 0.0, 5e10))


@dataclass(frozen=True)
class Driven:
    """Products at rest that drive a solid at rest, at x = 0: pressure and velocity of the contact, and the solid's shock."""

    products: State
    solid: Solid
    shocked: Shocked

    @property
    def p(self) -> float:
        """Pressure between the waves."""
        return self.shocked.p

    @property
    def u(self) -> float:
        """Velocity of the contact."""
        return self.shocked.u

    def sample(self, xi) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """rho, u, p at the similarity coordinates xi = x/t."""
        xi = np.asarray(xi, dtype=float)
        gas = Solution(self.products, State(self.products.products, self.products.rho, 2.0 * self.u, self.products.p), self.p)
        states = ((self.shocked.rho, self.u, self.p), (self.solid.rho0, 0.0, 0.0))
        return tuple(np.where(xi < self.u, inside, np.where(xi < self.shocked.speed, *outside))
                     for inside, *outside in zip(gas.sample(xi), *states, strict=True))


def drive(products: State, solid: Solid) -> Driven:
    """The contact at which the rarefaction of the products and the shock of the solid have the same velocity."""
    def excess(p: float) -> float:
        return shock_from(solid, solid.rho0, 0.0, p).u + products.behind(p)[1]

    p = brentq(excess, 1e-6 * products.p, products.p, rtol=1e-14)
    return Driven(products, solid, shock_from(solid, solid.rho0, 0.0, p))


def burnt(products: Products, energy: float) -> State:
    """Products burnt at constant volume; energy in J per initial m^3."""
    return State(products, products.rho0, 0.0, float(products.cold(products.rho0)) + products.omega * energy)


#: the products of PBX-9404 of the library and their energy, J/m^3
PBX9404 = (Products(852.4e9, 18.02e9, 4.6, 1.3, 0.38, 1840.0), 10.2e9)
