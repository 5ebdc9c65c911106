"""Eroding long rods above 2 km/s, after Luk & Piekutowski, Int. J. Impact Engng 11 (1991) 323.

A rod mushrooms (transient stage), its head penetrates while the rod is turned into a tube of ejecta (primary stage), and
the rest of rod and ejecta continues as a rigid body (secondary stage). The head's area, the penetration velocity and
the ejecta's area follow from an energy balance of the transient stage and from the conservation of mass, momentum and energy
of the primary stage, with the pressure of cavity expansion on the head. The printed equations are damaged in places; the page
gives the reading used here. explanation/penetration/luk-piekutowski
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.penetration import inputs
from hydro2d.penetration.cavity import CAVITY_VELOCITY, given_or_fitted
from hydro2d.penetration.model import Example, Input, InputError, Model, Output
from hydro2d.penetration.mushroom import Head, Rod, Target, at_velocity, fold, head

#: degree of the polynomials in lambda that represent the primary stage
DEGREE = 40


@dataclass(frozen=True)
class Penetration:
    """The penetration of a rod: cavity diameter, parts d1 to d4 of the depth (m), duration of the primary stage (s).

    ``regime`` is "slowed" if the rod falls below the critical velocity, "consumed" if it is used up before.
    """

    first: Head
    last: Head
    cavity_diameter: float
    primary: float
    rod: float
    ejecta: float
    growth: float
    duration: float
    residual_length: float
    regime: str

    @property
    def depth(self) -> float:
        return self.primary + self.rod + self.ejecta + self.growth


def penetrate(rod: Rod, target: Target, velocity: float, critical: float | None = None) -> Penetration:
    """All stages of a rod at an impact ``velocity``; ``critical`` (m/s) ends the primary stage; default: the fold."""
    first = at_velocity(rod, target, velocity)
    lowest = fold(rod, target) if critical is None else at_velocity(rod, target, critical)
    if velocity < lowest.rod:
        raise InputError(f"velocity = {velocity:g}: below the critical {lowest.rod:g} m/s")
    last, length, primary, duration, regime = _primary(rod, target, first, lowest)
    remaining, spread = length * rod.area, last.spread * rod.area
    whole = rod.density * rod.area * rod.length
    mass = min(rod.density * (remaining + spread**1.5 * 2.0 / (3.0 * math.sqrt(math.pi))), whole)
    return Penetration(
        first=first,
        last=last,
        cavity_diameter=rod.diameter * math.sqrt(first.spread),
        primary=primary,
        rod=_rigid(mass, spread, last.penetration, target),
        ejecta=_rigid(whole - mass, spread, last.ejecta, target),
        growth=_growth(rod, target, last) if regime == "consumed" else 0.0,
        duration=duration,
        residual_length=length,
        regime=regime,
    )


def _primary(rod: Rod, target: Target, first: Head, lowest: Head) -> tuple[Head, float, float, float, str]:
    """The end of the primary stage: head, length of rod, depth d1, duration, regime.

    rho_p L dV/dt = -Yp and dL/dt = -(V - U), Luk & Piekutowski (1991), eqs. (18) and (19), with lambda instead of time:
    ln L is an integral over the branch, time and depth are integrals of L. The branch is smooth in lambda, even at its
    fold, and polynomials in lambda represent it to round-off. explanation/penetration/luk-piekutowski, equations 12 to 14
    """
    from numpy.polynomial import Chebyshev
    from scipy.optimize import brentq

    if first.spread <= lowest.spread:
        return first, rod.length, 0.0, 0.0, "slowed"
    domain, scale = [lowest.spread, first.spread], rod.density / rod.strength
    u = Chebyshev.interpolate(lambda spreads: [head(rod, target, s).penetration for s in spreads], DEGREE, domain)
    v = Chebyshev.interpolate(lambda spreads: [head(rod, target, s).rod for s in spreads], DEGREE, domain)
    shrink = (scale * (v - u) * v.deriv()).integ(lbnd=first.spread)  # ln(L/Lp)
    gone = math.log(0.5 * rod.diameter / rod.length)
    consumed = shrink(lowest.spread) < gone
    end = brentq(lambda s: shrink(s) - gone, *domain, xtol=1e-13) if consumed else lowest.spread

    def integral(of) -> float:
        part = Chebyshev.interpolate(lambda s: of(s) * v.deriv()(s) * np.exp(shrink(s)), DEGREE, [end, first.spread])
        return scale * rod.length * float(part.integ(lbnd=end)(first.spread))

    length = rod.length * math.exp(shrink(end))
    regime = "consumed" if consumed else "slowed"
    return head(rod, target, end), length, integral(u), integral(np.ones_like), regime


def _rigid(mass: float, area: float, velocity: float, target: Target) -> float:
    """Depth of a rigid body of that ``area``, m: Luk & Piekutowski (1991), eqs. (30a) and (30b)."""
    return mass / (2.0 * target.dynamic * area) * math.log1p(target.dynamic / target.static * velocity**2)


def _growth(rod: Rod, target: Target, last: Head) -> float:
    """Depth by which the cavity grows on after the rod is consumed, m: Luk & Piekutowski (1991), eq. (30c)."""
    diameter = rod.diameter * math.sqrt(last.spread)
    return 0.5 * diameter * last.penetration * math.sqrt(target.density / target.plain_strength)


def pair_of(
    *, rod_diameter, rod_length, rod_density, rod_strength, rod_ultimate_strength, rod_youngs_modulus, rod_poisson_ratio,
    friction, target_density, target_strength, target_plain_strength, **cavity,
):
    """(Rod, Target) of the inputs, in SI."""
    a, b = given_or_fitted(target_density=target_density, target_strength=target_strength, **cavity)
    plain = target_strength if target_plain_strength is None else target_plain_strength
    rod = Rod(rod_diameter, rod_length, rod_density, rod_strength, rod_ultimate_strength, rod_youngs_modulus, rod_poisson_ratio)
    return rod, Target(target_density, target_strength, a, b, plain, friction)


def transition(*, critical_velocity: float | None, **values: float | None) -> float:
    """The velocity below which no mushroom head is stable and the rod counts as rigid, m/s: given, or the fold's."""
    return fold(*pair_of(**values)).rod if critical_velocity is None else critical_velocity


def evaluate(velocity: float, *, critical_velocity: float | None, **values: float | None) -> dict[str, float | str]:
    """All stages of a rod at an impact ``velocity``; keywords are those of ``MODEL.inputs``, in SI."""
    rod, target = pair_of(**values)
    shot = penetrate(rod, target, velocity, critical_velocity)
    return {
        "depth": shot.depth, "depth_over_length": shot.depth / rod.length, "cavity_diameter": shot.cavity_diameter,
        "penetration_velocity": shot.first.penetration, "ejecta_velocity": shot.first.ejecta,
        "primary_depth": shot.primary, "rod_depth": shot.rod, "ejecta_depth": shot.ejecta, "growth_depth": shot.growth,
        "duration": shot.duration, "residual_length": shot.residual_length, "limit_velocity": fold(rod, target).rod,
        "regime": shot.regime,
    }


PLAIN_STRENGTH = Input(
    "target.plain_strength", "Pa", "yield stress of the target taken as perfectly plastic; its yield stress where not given",
    "Y_t~", default=None)
CRITICAL_VELOCITY = Input(
    "critical.velocity", "m/s", "rod velocity that ends the primary stage; the least that has a solution where not given",
    "v_cr", default=None)

MODEL = Model(
    name="luk-piekutowski",
    title="Luk-Piekutowski: a mushrooming, eroding rod by the balances of mass, momentum and energy",
    source="Luk & Piekutowski, Int. J. Impact Engng 11 (1991) 323",
    validity="long metal rods above 2 km/s into thick metal targets, normal impact; depth of the secondary stage doubtful",
    inputs=(
        inputs.ROD_DIAMETER, inputs.ROD_LENGTH, inputs.ROD_DENSITY, inputs.ROD_STRENGTH, inputs.ROD_ULTIMATE_STRENGTH,
        inputs.ROD_YOUNGS_MODULUS, inputs.ROD_POISSON_RATIO,
        inputs.FRICTION.but(description="coefficient of sliding friction between head and target"),
        inputs.TARGET_DENSITY, inputs.TARGET_STRENGTH, PLAIN_STRENGTH, inputs.CAVITY_A, inputs.CAVITY_B,
        inputs.TARGET_YOUNGS_MODULUS.but(default=None), inputs.TARGET_POISSON_RATIO.but(default=None),
        inputs.TARGET_HARDENING_EXPONENT, CAVITY_VELOCITY.but(default=2400.0), CRITICAL_VELOCITY,
    ),
    outputs=(
        Output("depth", "m", "depth of all stages", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("cavity_diameter", "m", "diameter of the head and of the cavity at impact", "D_m"),
        Output("penetration_velocity", "m/s", "velocity of the head just after impact", "u"),
        Output("ejecta_velocity", "m/s", "velocity of the ejecta just after impact, positive against the flight", "v_e"),
        Output("primary_depth", "m", "depth of the primary stage", "d_1"),
        Output("rod_depth", "m", "depth by the remaining rod", "d_2"),
        Output("ejecta_depth", "m", "depth by the ejecta", "d_3"),
        Output("growth_depth", "m", "depth by which the cavity grows after the rod is used up", "d_4"),
        Output("duration", "s", "time of the primary stage", "t_1"),
        Output("residual_length", "m", "length of rod after the primary stage", "l_r"),
        Output("limit_velocity", "m/s", "least impact velocity with a solution", "v_cr"),
        Output("regime", "", "slowed to the critical velocity, or consumed before"),
    ),
    main="cavity_diameter",
    example=Example(
        rod="steel_4340", target="Al6061_T651", velocity=2660.0, velocities=(2000.0, 3500.0),
        values=MappingProxyType({
            "rod.diameter": 3.81e-3, "rod.length": 0.06963, "rod.strength": 1.6e9, "rod.ultimate_strength": 1.345e9,
            "rod.youngs_modulus": 206.8e9, "rod.poisson_ratio": 0.32, "rod.density": 7810.0, "target.density": 2710.0,
            "target.strength": 0.345e9, "target.plain_strength": 0.46e9, "cavity.a": 4.2448, "cavity.b": 1.0336,
        }),
    ),
    evaluate=evaluate,
    transition=transition,
)
