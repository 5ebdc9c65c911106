"""Lambert-Jonas: residual velocity behind a plate over impact velocity, with three constants fitted to shots.

v_r = a (V^p - v_bl^p)^(1/p) above the ballistic limit v_bl, 0 below. With p = 2 it expresses conservation of energy; with a = 1
as well it is the formula for a bullet without a plug. Lambert & Jonas, BRL-R-1852 (1976); Anderson, Int. J. Impact Engng 108
(2017) 3, equations (26) and (27). explanation/penetration/lambert-jonas.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.penetration.model import Example, Input, InputError, Model, non_negative, positive
from hydro2d.penetration.recht_ipson import LIMIT_VELOCITY, OUTPUTS

#: exponents from which a fit starts, and its allowed range; p = 1 would be a straight line
STARTS, EXPONENTS = (1.5, 2.0, 3.0, 5.0), (1.0, 20.0)


@dataclass(frozen=True)
class Fit:
    """Constants from shots: ``a``, ``p``, ``limit_velocity`` v_bl (m/s), ``standard_error`` of v_r (m/s), number of ``shots``.

    The standard error is the root of the sum of squares over the number of shots minus that of fitted constants.
    """

    a: float
    p: float
    limit_velocity: float
    standard_error: float
    shots: int


def residual_velocity(velocity: float, *, limit_velocity: float, a: float = 1.0, p: float = 2.0) -> float:
    """v_r = a (V^p - v_bl^p)^(1/p), m/s, and 0 up to v_bl: Anderson (2017), eq. (26).

    velocity V (m/s) at impact; limit_velocity v_bl (m/s); a, p: pure numbers, fitted, within the velocities of the shots.
    """
    positive(limit_velocity=limit_velocity, a=a, p=p)
    non_negative(velocity=velocity)
    if velocity <= limit_velocity:
        return 0.0
    return a * velocity * (-math.expm1(p * math.log(limit_velocity / velocity))) ** (1.0 / p)


def fit(velocities: Sequence[float], residual_velocities: Sequence[float], *, p: float | None = None) -> Fit:
    """Least-squares a, p and v_bl from impact and residual velocities of shots in m/s; the residual is 0 if the plate held.

    a lies in 0 to 1, p in 1 to 20 unless it is given; v_bl below the slowest shot that perforated. InputError for fewer
    perforations than constants.
    """
    v, left = _shots(velocities, residual_velocities, constants=3 if p is None else 2)
    if p is not None:
        positive(p=p)
    fits = [_fit_from(start, v, left, p) for start in (STARTS if p is None else (p,))]
    return min(fits, key=lambda each: each.standard_error)


def _fit_from(start: float, v: np.ndarray, left: np.ndarray, p: float | None) -> Fit:
    """The fit that starts from one exponent; the limit is sought as a share of the lowest velocity that perforated."""
    from scipy.optimize import least_squares

    slowest = float(v[left > 0.0].min())

    def curve(x):
        exponent = x[2] if p is None else p
        return np.array([residual_velocity(one, limit_velocity=x[0] * slowest, a=x[1], p=exponent) for one in v])

    low, high, first = [1e-6, 1e-6], [1.0, 1.0], [0.95, 0.9]
    if p is None:
        low, high, first = [*low, EXPONENTS[0]], [*high, EXPONENTS[1]], [*first, start]
    best = least_squares(lambda x: (curve(x) - left) / slowest, first, bounds=(low, high), xtol=1e-14, ftol=1e-14, gtol=1e-14)
    error = slowest * math.sqrt(2.0 * float(best.cost) / max(1, v.size - len(first)))
    exponent = float(best.x[2]) if p is None else p
    return Fit(float(best.x[1]), exponent, float(best.x[0]) * slowest, error, int(v.size))


def _shots(velocities: Sequence[float], residuals: Sequence[float], constants: int) -> tuple[np.ndarray, np.ndarray]:
    v, left = np.asarray(velocities, float), np.asarray(residuals, float)
    if v.ndim != 1 or v.shape != left.shape:
        raise InputError("a fit needs as many residual velocities as impact velocities")
    if not (np.all(np.isfinite(v)) and np.all(np.isfinite(left)) and np.all(v > 0.0) and np.all((left >= 0.0) & (left <= v))):
        raise InputError("a fit needs shots with a positive velocity and a residual velocity from 0 up to it")
    if np.unique(v[left > 0.0]).size < constants:
        raise InputError(f"a fit of {constants} constants needs perforations at {constants} or more velocities")
    return v, left


def evaluate(velocity: float, *, plate_limit_velocity: float, lambert_a: float, lambert_p: float) -> dict[str, float | str]:
    """Residual velocity at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    left = residual_velocity(velocity, limit_velocity=plate_limit_velocity, a=lambert_a, p=lambert_p)
    return {
        "residual_velocity": left,
        "residual_over_limit": left / plate_limit_velocity,
        "limit_velocity": plate_limit_velocity,
        "regime": "perforation" if left > 0.0 else "stopped",
    }


MODEL = Model(
    name="lambert-jonas",
    title="Lambert-Jonas: residual velocity behind a plate from three constants fitted to shots",
    source="Lambert & Jonas, BRL-R-1852 (1976); Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (26) and (27)",
    validity="a fit to shots of one projectile and plate, within their velocities",
    inputs=(
        LIMIT_VELOCITY,
        Input("lambert.a", "1", "slope of the residual velocity at high velocity", "a", default=1.0),
        Input("lambert.p", "1", "exponent; 2 stands for conservation of energy", "p", default=2.0),
    ),
    outputs=OUTPUTS,
    main="residual_velocity",
    example=Example(
        rod="W_alloy", target="steel_4340", velocity=1200.0, velocities=(500.0, 2000.0),
        values=MappingProxyType({"plate.limit_velocity": 900.0, "lambert.p": 2.5}),
    ),
    evaluate=evaluate,
)
