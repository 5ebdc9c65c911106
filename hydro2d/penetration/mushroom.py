"""The mushroomed head of an eroding rod: its area, its velocity and its ejecta, after Luk & Piekutowski (1991).

They follow from an energy balance of the head's growth and the conservation of mass, momentum and energy across the steady
head, with the pressure of cavity expansion on it. Two or three solutions exist at a rod velocity; ``at_velocity`` follows
the branch that grows from the fold. explanation/penetration/luk-piekutowski, equations 1 to 11
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from hydro2d.base.parameters import FRACTION
from hydro2d.penetration.model import InputError, complain, non_negative, positive

#: ratios of head to rod area between which the fold is sought, the largest one tried, and the growth factor of the search
SPREADS, LARGEST, GROWTH = np.geomspace(1.02, 50.0, 60), 400.0, 1.25
#: values of eta - 1 at which the first root of the flow equation is sought
THINNING = np.geomspace(1e-5, 1e3, 1200)
#: values of U/V at which the root of the hypervelocity form is sought, the largest first
RATIOS = np.linspace(0.999, 0.001, 999)


@dataclass(frozen=True)
class Rod:
    """Elastic, perfectly plastic rod; SI. ``strength`` Yp, ``ultimate_strength`` Ypu of the ejecta that tear away."""

    diameter: float
    length: float
    density: float
    strength: float
    ultimate_strength: float
    youngs_modulus: float
    poisson_ratio: float

    def __post_init__(self) -> None:
        positive(diameter=self.diameter, length=self.length, density=self.density, strength=self.strength,
                 ultimate_strength=self.ultimate_strength, youngs_modulus=self.youngs_modulus)
        complain("poisson_ratio", self.poisson_ratio, FRACTION)
        if not self.poisson_ratio < 0.5:
            raise InputError(f"rod.poisson_ratio = {self.poisson_ratio:g}: must be below 0.5")
        if not self.length > 0.5 * self.diameter:
            raise InputError(f"rod.length = {self.length:g}: must be more than the radius, {0.5 * self.diameter:g} m")

    @property
    def elastic_limit(self) -> float:
        """(1 - nu)/(1 - 2 nu) Yp, Pa: Luk & Piekutowski (1991), eq. (5)."""
        return (1.0 - self.poisson_ratio) / (1.0 - 2.0 * self.poisson_ratio) * self.strength

    @property
    def area(self) -> float:
        return 0.25 * math.pi * self.diameter**2


@dataclass(frozen=True)
class Target:
    """Cavity pressure ``a`` Y + ``b`` rho V^2 with ``friction``; SI.

    ``plain_strength`` is the yield stress of the target if it is treated as perfectly plastic.
    """

    density: float
    strength: float
    a: float
    b: float
    plain_strength: float
    friction: float = 0.0

    def __post_init__(self) -> None:
        positive(density=self.density, strength=self.strength, a=self.a, b=self.b, plain_strength=self.plain_strength)
        non_negative(friction=self.friction)

    @property
    def static(self) -> float:
        """alpha Yt, Pa: Luk & Piekutowski (1991), eq. (2b)."""
        return self.a * (1.0 + 0.5 * math.pi * self.friction) * self.strength

    @property
    def dynamic(self) -> float:
        """beta Yt, kg/m^3: Luk & Piekutowski (1991), eq. (2c)."""
        return 0.5 * self.b * (1.0 + 0.25 * math.pi * self.friction) * self.density


@dataclass(frozen=True)
class Head:
    """A steady head: lambda = Am/Ap, eta = Ae/Ap, and the velocities (m/s) of rod, head and ejecta.

    The ejecta velocity is positive against the direction of flight, hence negative if the ejecta follow the head.
    """

    spread: float
    thinning: float
    rod: float
    penetration: float

    @property
    def ejecta(self) -> float:
        return (self.rod - self.penetration) / self.thinning - self.penetration


def head(rod: Rod, target: Target, spread: float) -> Head:
    """The steady head of area ``spread`` = lambda times the rod's: the first root eta > 1 of the flow equation.

    For given lambda and eta, V - U follows from the energy and U from the momentum; one equation for eta remains. Its first
    root has the large U; the others penetrate too slowly to be the solution that the paper follows.
    explanation/penetration/luk-piekutowski, equations 6 to 9. InputError if there is none.
    """
    from scipy.optimize import brentq

    with np.errstate(invalid="ignore"):
        values = _flow(rod, target, spread, 1.0 + THINNING)
    cut = np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))
    if not cut.size:
        raise InputError(f"no steady mushroom head has {spread:g} times the area of this rod in this target")
    thin = THINNING[cut[0]], THINNING[cut[0] + 1]
    thinning = 1.0 + brentq(lambda t: float(_flow(rod, target, spread, 1.0 + t)), *thin, xtol=1e-15, rtol=1e-14)
    slip, u = _velocities(rod, target, spread, thinning)
    return Head(spread, thinning, float(u + slip), float(u))


def _velocities(rod: Rod, target: Target, spread: float, thinning):
    """(V - U, U) from the conservation of energy and of momentum, Luk & Piekutowski (1991), eqs. (17) and (15)."""
    work = rod.strength * (np.log(2.0 * spread / thinning) - 1.0) + rod.ultimate_strength
    square = 2.0 * work / (1.0 - 1.0 / thinning**2)  # rho_p (V - U)^2
    push = (1.0 + 1.0 / thinning) * square + rod.strength + thinning * rod.ultimate_strength
    return np.sqrt(square / rod.density), np.sqrt((push / spread - target.static) / target.dynamic)


def _flow(rod: Rod, target: Target, spread: float, thinning):
    """Energy that the rod supplies minus that which head and target take up, Pa: Luk & Piekutowski (1991), eq. (7)."""
    slip, u = _velocities(rod, target, spread, thinning)
    v = u + slip
    resistance = rod.elastic_limit * np.log(1.0 + spread) + target.static + target.dynamic * u * u
    return rod.density * (v * v - u * u) - u / v * (1.0 + spread) * resistance


@functools.lru_cache(maxsize=64)
def fold(rod: Rod, target: Target) -> Head:
    """The slowest steady head: two solutions meet there, and below its rod velocity there is none.

    InputError if no head is slowest, so that there is no branch to follow.
    """
    from scipy.optimize import minimize_scalar

    def speed(spread: float) -> float:
        try:
            return head(rod, target, spread).rod
        except InputError:
            return math.inf

    speeds = np.array([math.inf, *(speed(spread) for spread in SPREADS), math.inf])
    slowest = int(np.argmin(speeds[1:-1]))
    if not np.all(np.isfinite(speeds[slowest : slowest + 3])):
        raise InputError("this rod and target have no lowest velocity of erosion, so the model does not apply")
    around = SPREADS[slowest - 1], SPREADS[slowest + 1]
    minimum = minimize_scalar(speed, bounds=around, method="bounded", options={"xatol": 1e-8})
    return head(rod, target, float(minimum.x))


def at_velocity(rod: Rod, target: Target, velocity: float) -> Head:
    """The steady head at a rod velocity, m/s, on the branch that grows from the fold. InputError below the fold."""
    from scipy.optimize import brentq

    positive(velocity=velocity)
    least = fold(rod, target)
    if velocity < least.rod:
        raise InputError(f"velocity = {velocity:g}: the model has no eroding solution below its critical {least.rod:.4g} m/s")
    if velocity == least.rod:
        return least
    low, high = _climb(rod, target, lambda candidate: candidate.rod >= velocity)
    return head(rod, target, brentq(lambda s: head(rod, target, s).rod - velocity, low, high, xtol=1e-12, rtol=1e-13))


def _climb(rod: Rod, target: Target, reached) -> tuple[float, float]:
    """Two lambda of the branch above the fold, between which ``reached`` becomes true. InputError if it never does."""
    low = fold(rod, target).spread
    while low < LARGEST:
        if reached(head(rod, target, GROWTH * low)):
            return low, GROWTH * low
        low *= GROWTH
    raise InputError(f"the rod's steady heads end at {LARGEST:g} times its area: see the hypervelocity form")


def critical_velocity(rod: Rod, target: Target) -> float:
    """The least impact velocity with an eroding solution, m/s: the fold."""
    return fold(rod, target).rod


def reversal_velocity(rod: Rod, target: Target) -> float:
    """The impact velocity at which the ejecta are at rest, m/s; the ejecta of slower rods follow the head."""
    from scipy.optimize import brentq

    if fold(rod, target).ejecta >= 0.0:
        raise InputError("the ejecta never follow the head of this rod in this target")
    bracket = _climb(rod, target, lambda candidate: candidate.ejecta >= 0.0)
    return head(rod, target, brentq(lambda s: head(rod, target, s).ejecta, *bracket, xtol=1e-12)).rod


def hypervelocity(rod: Rod, target: Target, velocity: float) -> float:
    """Penetration velocity of the limit eta = 1, m/s: Luk & Piekutowski (1991), eq. (29a), the largest root.

    Meant for about 4 to 7 km/s. InputError if it has no root, as at low and at very high velocity.
    """
    from scipy.optimize import brentq

    positive(velocity=velocity)

    def balance(psi):
        pressure = target.static + target.dynamic * (psi * velocity) ** 2
        spread = 2.0 * rod.density * velocity**2 * (1.0 - psi) ** 2 / pressure
        take = psi * spread * rod.elastic_limit * np.log(spread) / (rod.density * velocity**2)
        return (1.0 - psi) * (1.0 - psi + 2.0 * psi**2) - take

    values = balance(RATIOS)
    cut = np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))
    if not cut.size:
        raise InputError(f"velocity = {velocity:g}: the hypervelocity form has no solution here")
    return velocity * float(brentq(balance, RATIOS[cut[0] + 1], RATIOS[cut[0]], xtol=1e-15))
