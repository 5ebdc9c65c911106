"""Poncelet: a rigid projectile against a stress a + b v^2 on its cross-section.

rho_p L dv/dt = -(a + b v^2), Anderson, Int. J. Impact Engng 108 (2017) 3, equations (1) to (5). The constants a and b come
from a fit to measured depths; ``fit`` finds one or both. explanation/penetration/poncelet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, non_negative, positive

#: b V^2/a below which the drag term is lost in round-off
NO_DRAG = 1e-12


@dataclass(frozen=True)
class Fit:
    """Constants of the resisting stress from measured depths.

    ``a`` (Pa), ``b`` (kg/m^3), ``standard_error`` of P/L: the root of the sum of squares over the number of shots
    minus that of fitted constants.
    """

    a: float
    b: float
    standard_error: float
    shots: int


def depth_over_length(velocity: float, *, rod_density: float, a: float, b: float) -> float:
    """P/L = rho_p/(2 b) ln(1 + b V^2/a), Anderson (2017), eq. (4); with b = 0 eq. (5), rho_p V^2/(2 a).

    velocity V (m/s) at impact; rod_density rho_p (kg/m^3); a (Pa); b (kg/m^3), not negative. L is the length of a cylinder
    of the projectile's mass and diameter. For a projectile that does not deform and goes so deep that its nose does not matter.
    """
    positive(rod_density=rod_density, a=a)
    non_negative(velocity=velocity, b=b)
    drag = b * velocity**2 / a
    if drag < NO_DRAG:
        return depth_at_small_velocity(velocity, rod_density=rod_density, a=a)
    return rod_density * math.log1p(drag) / (2.0 * b)


def depth_at_small_velocity(velocity: float, *, rod_density: float, a: float) -> float:
    """P/L = rho_p V^2/(2 a): a constant resisting stress, Anderson (2017), eq. (5)."""
    positive(rod_density=rod_density, a=a)
    non_negative(velocity=velocity)
    return rod_density * velocity**2 / (2.0 * a)


def small_velocity_limit(*, a: float, b: float, tolerance: float = 0.05) -> float:
    """The impact velocity at which eq. (5) exceeds eq. (4) by ``tolerance``, relative, m/s; infinite for b = 0.

    explanation/penetration/poncelet, equation 5
    """
    from scipy.optimize import brentq

    positive(a=a, tolerance=tolerance)
    non_negative(b=b)
    if b == 0.0:
        return math.inf
    high = 1.0
    while high < (1.0 + tolerance) * math.log1p(high):
        high *= 2.0
    drag = brentq(lambda x: x - (1.0 + tolerance) * math.log1p(x), tolerance, high, xtol=1e-14 * tolerance)
    return math.sqrt(drag * a / b)


def velocity_at(depth: float, velocity: float, *, rod_density: float, rod_length: float, a: float, b: float) -> float:
    """The velocity left at a depth (m), m/s; 0 beyond the final one. explanation/penetration/poncelet, equation 3."""
    positive(rod_density=rod_density, rod_length=rod_length, a=a)
    non_negative(depth=depth, velocity=velocity, b=b)
    travelled = 2.0 * depth / (rod_density * rod_length)
    if b * velocity**2 < NO_DRAG * a:
        return math.sqrt(max(0.0, velocity**2 - a * travelled))
    return math.sqrt(max(0.0, velocity**2 * math.exp(-b * travelled) + a / b * math.expm1(-b * travelled)))


def duration(velocity: float, *, rod_density: float, rod_length: float, a: float, b: float) -> float:
    """Time from impact to rest, s: rho_p L/sqrt(a b) arctan(V sqrt(b/a)). explanation/penetration/poncelet, equation 4."""
    positive(rod_density=rod_density, rod_length=rod_length, a=a)
    non_negative(velocity=velocity, b=b)
    if b * velocity**2 < NO_DRAG * a:
        return rod_density * rod_length * velocity / a
    return rod_density * rod_length * math.atan(velocity * math.sqrt(b / a)) / math.sqrt(a * b)


def fit(velocities: Sequence[float], depths_over_length: Sequence[float], *, rod_density: float, b: float | None = None) -> Fit:
    """Least-squares a and b of measured P/L over impact velocities in m/s; a alone where b (kg/m^3) is given.

    b is not allowed to be negative. InputError for too few shots or shots without depth or velocity.
    """
    from scipy.optimize import least_squares

    v, measured = _shots(velocities, depths_over_length, fewest=2 if b is None else 1)
    positive(rod_density=rod_density)
    if b is not None:
        non_negative(b=b)
    scale = rod_density * float(np.sum(v**4) / np.sum(v**2 * measured)) / 2.0
    inertia = scale / float(np.mean(v**2))

    def constants(x):
        return scale * math.exp(x[0]), inertia * x[1] if b is None else b

    def residuals(x):
        found_a, found_b = constants(x)
        return [depth_over_length(one, rod_density=rod_density, a=found_a, b=found_b) for one in v] - measured

    start, low = ([0.0, 0.1], [-np.inf, 0.0]) if b is None else ([0.0], [-np.inf])
    solution = least_squares(residuals, start, bounds=(low, np.inf), xtol=1e-14, ftol=1e-14, gtol=1e-14, x_scale="jac")
    free = max(1, v.size - len(start))
    best_a, best_b = constants(solution.x)
    return Fit(float(best_a), float(best_b), math.sqrt(2.0 * float(solution.cost) / free), int(v.size))


def _shots(velocities: Sequence[float], depths: Sequence[float], fewest: int) -> tuple[np.ndarray, np.ndarray]:
    v, measured = np.asarray(velocities, float), np.asarray(depths, float)
    if v.ndim != 1 or v.shape != measured.shape or np.unique(v).size < fewest:
        raise InputError(f"a fit needs as many depths as velocities, and shots at {fewest} or more different velocities")
    if not (np.all(np.isfinite(v)) and np.all(np.isfinite(measured)) and np.all(v > 0.0) and np.all(measured > 0.0)):
        raise InputError("a fit needs shots with a positive velocity and a positive depth")
    return v, measured


def evaluate(velocity: float, *, rod_density: float, rod_length: float, poncelet_a: float,
             poncelet_b: float) -> dict[str, float]:
    """Depth at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    constants = {"rod_density": rod_density, "a": poncelet_a, "b": poncelet_b}
    ratio = depth_over_length(velocity, **constants)
    return {
        "depth": ratio * rod_length,
        "depth_over_length": ratio,
        "small_velocity_depth": rod_length * depth_at_small_velocity(velocity, rod_density=rod_density, a=poncelet_a),
        "duration": duration(velocity, rod_length=rod_length, **constants),
        "resistance": poncelet_a + poncelet_b * velocity**2,
    }


MODEL = Model(
    name="poncelet",
    title="Poncelet: a rigid projectile against a resisting stress a + b v^2 fitted to depths",
    source="Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (1) to (5)",
    validity="rigid projectiles, within the velocities of the shots that a and b were fitted to",
    inputs=(
        inputs.ROD_DENSITY,
        inputs.ROD_LENGTH,
        Input("poncelet.a", "Pa", "static part of the resisting stress", "a"),
        Input("poncelet.b", "kg/m^3", "factor of v^2 in the resisting stress", "b", sign=NON_NEGATIVE),
    ),
    outputs=(
        Output("depth", "m", "depth of penetration", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("small_velocity_depth", "m", "depth without the drag term, eq. (5)", "P_0"),
        Output("duration", "s", "time from impact to rest"),
        Output("resistance", "Pa", "resisting stress at impact", "a + b V^2"),
    ),
    main="depth_over_length",
    example=Example(
        rod="steel_4340", target="Al6061_T6", velocity=1000.0, velocities=(200.0, 1600.0),
        values=MappingProxyType({"rod.length": 0.0747, "poncelet.a": 1.956e9, "poncelet.b": 51.8}),
    ),
    evaluate=evaluate,
)
