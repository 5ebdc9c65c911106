"""Stress at the wall of a spherical cavity that grows from zero radius at constant velocity V in an elastic-plastic solid.

The radial stress at the wall is the pressure that models of rigid penetration put on a nose. There are closed forms for an
incompressible solid with linear or power-law hardening. For a compressible one with power-law hardening there is a similarity
solution, from which the coefficients of A Y + B rho V^2 and of A Y + B sqrt(rho Y) V + C rho V^2 follow.
explanation/penetration/cavity
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, non_negative, positive

#: the solution is integrated towards the wall, to exp(-DEEP) of the mass inside the plastic front
DEEP = 32.0
#: front velocities of the computed curve, over the bulk sound speed: a geometric series of slow ones, then even steps
SLOW, FAST = (1e-3, 0.04, 6), (0.08, 1.0, 40)
#: the weakest solid, as yield stress over Young's modulus, and the slowest cavity, m/s, that the numerics can resolve
WEAKEST, SLOWEST = 1e-6, 1.0
#: points of the least-squares fits, evenly spread over the velocities
POINTS = 400


@dataclass(frozen=True)
class Solid:
    """A target's material: rho, E, nu, Y, and n of the flow stress Y (E eps/Y)^n; SI. InputError for impossible numbers."""

    density: float
    youngs_modulus: float
    poisson_ratio: float
    strength: float
    hardening_exponent: float = 0.0

    def __post_init__(self) -> None:
        positive(density=self.density, youngs_modulus=self.youngs_modulus, strength=self.strength)
        if not 0.0 <= self.poisson_ratio < 0.5:
            raise InputError(f"target.poisson_ratio = {self.poisson_ratio:g}: must be at least 0 and below 0.5")
        if not 0.0 <= self.hardening_exponent < 1.0:
            raise InputError(f"target.hardening_exponent = {self.hardening_exponent:g}: must be at least 0 and below 1")
        if not self.strength < self.shear_modulus:
            raise InputError(f"target.strength = {self.strength:g}: must be below the shear modulus, {self.shear_modulus:g} Pa")
        if self.strength < WEAKEST * self.youngs_modulus:
            raise InputError(f"target.strength = {self.strength:g}: below a millionth of Young's modulus, "
                             f"{self.youngs_modulus:g} Pa, the plastic flow around a cavity cannot be integrated")

    @property
    def shear_modulus(self) -> float:
        return 0.5 * self.youngs_modulus / (1.0 + self.poisson_ratio)

    @property
    def bulk_modulus(self) -> float:
        return self.youngs_modulus / (3.0 * (1.0 - 2.0 * self.poisson_ratio))

    @property
    def bulk_speed(self) -> float:
        """sqrt(K/rho), m/s: the plastic front never runs faster."""
        return math.sqrt(self.bulk_modulus / self.density)

    @property
    def elastic_speed(self) -> float:
        """sqrt((K + 4 G/3)/rho), m/s: the speed of the elastic precursor."""
        return math.sqrt((self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus) / self.density)


@dataclass(frozen=True)
class Expansion:
    """A cavity: velocity of its wall and of the plastic front (m/s), radial stress at the wall (Pa, compression)."""

    velocity: float
    front: float
    stress: float


@dataclass(frozen=True)
class Coefficients:
    """Fits of the wall stress over Y: ``a`` + ``b`` x^2 and ``a`` + ``b_linear`` x + ``c`` x^2, with x = V sqrt(rho/Y).

    ``velocity`` is the largest in the fit, m/s. ``a`` is the quasi-static value; the others are least squares with ``a`` fixed.
    """

    velocity: float
    a: float
    b: float
    b_linear: float
    c: float


def incompressible_linear(
    velocity: float, density: float, youngs_modulus: float, strength: float, tangent: float = 0.0
) -> float:
    """Stress at the wall in an incompressible solid with flow stress Y + E_t eps, Pa; ``tangent`` is E_t (Pa).

    (2/3) Y [1 + ln(2E/3Y)] + (2 pi^2/27) E_t + (3/2) rho V^2; explanation/penetration/cavity, equation 3.
    With E_t = 0 Anderson (2017), eq. (42). Valid for Y and E_t far below E.
    """
    positive(density=density, youngs_modulus=youngs_modulus, strength=strength)
    non_negative(velocity=velocity, tangent=tangent)
    static = 2.0 / 3.0 * strength * (1.0 + math.log(2.0 * youngs_modulus / (3.0 * strength)))
    return static + 2.0 * math.pi**2 / 27.0 * tangent + 1.5 * density * velocity**2


def incompressible_power_law(
    velocity: float, density: float, youngs_modulus: float, strength: float, hardening_exponent: float = 0.0
) -> float:
    """Stress at the wall in an incompressible solid with flow stress Y (E eps/Y)^n, Pa.

    (2/3) Y {1 + (2E/3Y)^n integral_0^(1 - 3Y/2E) (-ln x)^n/(1 - x) dx} + (3/2) rho V^2; explanation/penetration/cavity,
    equation 4. Valid for Y far below E.
    """
    from scipy.integrate import quad

    static = incompressible_linear(velocity, density, youngs_modulus, strength)
    n, ratio = hardening_exponent, 2.0 * youngs_modulus / (3.0 * strength)
    if not 0.0 <= n < 1.0:
        raise InputError(f"target.hardening_exponent = {n:g}: must be at least 0 and below 1")
    harder, _ = quad(lambda s: (-ratio * math.log1p(-math.exp(-s))) ** n - 1.0, 0.0, math.log(ratio), epsrel=1e-10)
    return static + 2.0 / 3.0 * strength * harder


def expansion_at_front(front: float, solid: Solid) -> Expansion:
    """The cavity whose plastic front runs at ``front`` (m/s), at most the bulk sound speed.

    Integrates explanation/penetration/cavity, equation 11, from the front to the wall. InputError for a faster front.
    """
    from scipy.integrate import odeint

    positive(front=front)
    if front > solid.bulk_speed:
        raise InputError(f"front = {front:g}: the plastic front cannot outrun the bulk sound speed, {solid.bulk_speed:g} m/s")
    y, g, k = solid.strength, solid.shear_modulus, solid.bulk_modulus
    velocity, stress = _ahead_of_front(front, solid)
    volume = 1.0 - (stress - 2.0 / 3.0 * y) / k
    mass = (1.0 - velocity / front) / volume
    inertia, yield_strain = solid.density * front**2, y / (6.0 * g)

    def slopes(s: float, state: np.ndarray) -> tuple[float, float]:
        x, j = state.tolist()
        inside = mass * math.exp(s) * j
        widening = inside / (3.0 * x**2)
        flow, slope = _flow_stress(solid, yield_strain + math.log(x) - s / 3.0)
        relative = -3.0 * widening
        momentum = 2.0 * (inertia / j * relative * (x + relative) - flow) * widening / x
        hardening = 2.0 / 3.0 * slope * (widening / x - 1.0 / 3.0)
        return widening, (momentum - hardening) / (inertia * relative**2 / j**2 - k)

    x, j = odeint(slopes, [1.0, volume], [0.0, -DEEP], tfirst=True, rtol=1e-10, atol=1e-12)[-1]
    flow, _ = _flow_stress(solid, yield_strain + math.log(x) + DEEP / 3.0)
    return Expansion(float(x) * front, front, k * (1.0 - float(j)) + 2.0 / 3.0 * flow)


def expansion(velocity: float, solid: Solid) -> Expansion:
    """The cavity whose wall moves at ``velocity`` (m/s). InputError where a plastic shock would run ahead of it."""
    from scipy.optimize import newton

    positive(velocity=velocity)
    fronts, walls, _ = _curve(solid)
    if velocity > walls[-1]:
        raise InputError(f"velocity = {velocity:g}: at most {walls[-1]:.0f} m/s, beyond which a plastic shock runs ahead")

    def too_fast(front: float) -> float:
        return expansion_at_front(min(front, solid.bulk_speed), solid).velocity / velocity - 1.0

    guess = float(np.interp(velocity, walls, fronts)) if velocity > walls[0] else velocity * fronts[0] / walls[0]
    front = float(newton(too_fast, guess, x1=0.999 * guess, tol=1e-8 * guess))
    return expansion_at_front(min(front, solid.bulk_speed), solid)


@lru_cache(maxsize=64)
def coefficients(solid: Solid, velocity: float) -> Coefficients:
    """A, B and the three-term B, C by least squares over wall velocities from 0 to ``velocity`` (m/s), evenly weighted.

    explanation/penetration/cavity, equations 13 and 14. InputError beyond the range of ``expansion``.
    """
    from scipy.interpolate import CubicSpline

    positive(velocity=velocity)
    if velocity < SLOWEST:
        raise InputError(f"cavity.velocity = {velocity:g}: at least {SLOWEST:g} m/s; below it a fit sees only rounding errors")
    slowest, (_, walls, stresses) = quasi_static(solid), _curve(solid)
    if velocity > walls[-1]:
        raise InputError(f"cavity.velocity = {velocity:g}: at most {walls[-1]:.0f} m/s, where the similarity solution ends")
    v = velocity * np.arange(1, POINTS + 1) / POINTS
    x = v * math.sqrt(solid.density / solid.strength)
    above = CubicSpline(walls, stresses)(v) / solid.strength - slowest
    b = float(above @ x**2 / (x**2 @ x**2))
    b_linear, c = np.linalg.lstsq(np.stack([x, x**2], axis=1), above, rcond=None)[0]
    return Coefficients(velocity, slowest, b, float(b_linear), float(c))


def quasi_static(solid: Solid) -> float:
    """A: the stress at the wall over Y as V tends to 0."""
    return expansion_at_front(1e-4 * solid.bulk_speed, solid).stress / solid.strength


@lru_cache(maxsize=64)
def _curve(solid: Solid) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Velocities of fronts and walls, and the stresses, from a slow front to the fastest."""
    fronts = np.concatenate([np.geomspace(*SLOW), np.linspace(*FAST)]) * solid.bulk_speed
    expansions = [expansion_at_front(float(front), solid) for front in fronts]
    return fronts, np.array([each.velocity for each in expansions]), np.array([each.stress for each in expansions])


def _flow_stress(solid: Solid, hoop: float) -> tuple[float, float]:
    """Y (6 G h/Y)^n and its derivative, for the logarithmic hoop strain h; explanation/penetration/cavity, equation 8."""
    if solid.hardening_exponent == 0.0:
        return solid.strength, 0.0
    flow = solid.strength * (6.0 * solid.shear_modulus * hoop / solid.strength) ** solid.hardening_exponent
    return flow, solid.hardening_exponent * flow / hoop


def _ahead_of_front(front: float, solid: Solid) -> tuple[float, float]:
    """Particle velocity and radial stress on the elastic side of the front; explanation/penetration/cavity, equation 7."""
    z, y, g = front / solid.elastic_speed, solid.strength, solid.shear_modulus
    strain = y / (3.0 * g * (1.0 + z))
    radial, hoop = -strain * (1.0 + z + z**2), 0.5 * strain * (1.0 + z - 2.0 * z**2)
    dilatation = radial + 2.0 * hoop
    stress = -(solid.bulk_modulus - 2.0 / 3.0 * g) * dilatation - 2.0 * g * radial
    return 0.5 * y / g * front, stress


def given_or_fitted(
    cavity_a: float | None, cavity_b: float | None, *, target_density: float, target_strength: float,
    target_youngs_modulus: float | None, target_poisson_ratio: float | None, target_hardening_exponent: float,
    cavity_velocity: float,
) -> tuple[float, float]:
    """A and B as given, or from ``coefficients`` where None. InputError if elastic constants needed for that are not given."""
    if cavity_a is not None and cavity_b is not None:
        return cavity_a, cavity_b
    if target_youngs_modulus is None or target_poisson_ratio is None:
        raise InputError("give cavity.a and cavity.b, or target.youngs_modulus and target.poisson_ratio to derive them")
    solid = Solid(target_density, target_youngs_modulus, target_poisson_ratio, target_strength, target_hardening_exponent)
    fit = coefficients(solid, cavity_velocity)
    return fit.a if cavity_a is None else cavity_a, fit.b if cavity_b is None else cavity_b


def evaluate(
    velocity, *, target_density, target_strength, target_youngs_modulus, target_poisson_ratio, target_hardening_exponent,
    target_tangent_modulus, cavity_solid, cavity_velocity,
):
    """The stress at the wall of a cavity that grows at ``velocity``, and the coefficients of its fits."""
    if cavity_solid == "compressible":
        solid = Solid(target_density, target_youngs_modulus, target_poisson_ratio, target_strength, target_hardening_exponent)
        fit = coefficients(solid, cavity_velocity)
        cavity = expansion(velocity, solid) if velocity > 0.0 else Expansion(0.0, 0.0, fit.a * target_strength)
    else:
        of_hardening = (target_hardening_exponent, incompressible_power_law)
        if cavity_solid == "incompressible-linear":
            of_hardening = (target_tangent_modulus, incompressible_linear)
        hardening, stress = of_hardening
        numbers = (target_density, target_youngs_modulus, target_strength, hardening)
        front = velocity * (2.0 * target_youngs_modulus / (3.0 * target_strength)) ** (1.0 / 3.0)
        cavity = Expansion(velocity, front, stress(velocity, *numbers))
        fit = Coefficients(cavity_velocity, stress(0.0, *numbers) / target_strength, 1.5, 0.0, 1.5)
    return {
        "cavity_stress": cavity.stress, "front_velocity": cavity.front,
        "a": fit.a, "b": fit.b, "b_linear": fit.b_linear, "c": fit.c,
    }


CAVITY_VELOCITY = Input("cavity.velocity", "m/s", "largest wall velocity of the fits of A, B and C", "V_max", default=1200.0)
SOLID = Input(
    "cavity.solid", "", "model of the solid; the last has linear hardening, the others a power law",
    default="compressible", choices=("compressible", "incompressible", "incompressible-linear"),
)
TANGENT = Input(
    "target.tangent_modulus", "Pa", "slope of linear hardening, for incompressible-linear only", "E_t", default=0.0,
    sign=NON_NEGATIVE,
)

MODEL = Model(
    name="cavity",
    title="Dynamic spherical cavity expansion, which yields A and B",
    source="Luk, Forrestal & Amos, J. Appl. Mech. 58 (1991) 1 [recalled]; Anderson, Int. J. Impact Engng 108 (2017) 3, (42)",
    validity="no rate effects, no heat; pressure linear in specific volume; no plastic shock (to about 3.5 km/s in metals)",
    inputs=(
        inputs.TARGET_DENSITY, inputs.TARGET_STRENGTH, inputs.TARGET_YOUNGS_MODULUS, inputs.TARGET_POISSON_RATIO,
        inputs.TARGET_HARDENING_EXPONENT, TANGENT, SOLID, CAVITY_VELOCITY,
    ),
    outputs=(
        Output("cavity_stress", "Pa", "radial stress at the wall, compression positive", "sigma"),
        Output("front_velocity", "m/s", "velocity of the elastic-plastic front", "c"),
        Output("a", "1", "A, the quasi-static stress over Y", "A"),
        Output("b", "1", "B of A Y + B rho V^2", "B"),
        Output("b_linear", "1", "B of A Y + B sqrt(rho Y) V + C rho V^2", "B_3"),
        Output("c", "1", "C of A Y + B sqrt(rho Y) V + C rho V^2", "C_3"),
    ),
    main="cavity_stress",
    example=Example(
        rod="", target="Al6061_T651", velocity=800.0, velocities=(0.0, 2400.0),
        values=MappingProxyType({"cavity.velocity": 2400.0}),
    ),
    evaluate=evaluate,
)
