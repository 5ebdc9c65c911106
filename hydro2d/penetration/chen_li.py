"""Chen-Li: rigid penetration by two dimensionless numbers, and the velocity at which the rod stops being rigid.

The impact function I relates the rod's energy to the target's static resistance, and the geometry function N relates the
rod's slenderness to the bluntness of its nose. The depth for every nose is one function of the two. Chen & Li, Int. J.
Impact Engng 27 (2002) 619 and J. Engng Mech. 130 (2004) 123, both recalled: see explanation/penetration/chen-li.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType

from hydro2d.penetration import inputs
from hydro2d.penetration.forrestal import SHOT, Nose, Target, of_inputs
from hydro2d.penetration.model import Example, InputError, Model, Output, non_negative, positive


@dataclass(frozen=True)
class Numbers:
    """``impact`` is I = M V^2/(N1 A Y d^3), ``geometry`` is N = M/(N2 B rho d^3), infinite where B is 0."""

    impact: float
    geometry: float

    @property
    def depth(self) -> float:
        """Depth over diameter, (2/pi) N ln(1 + I/N); explanation/penetration/chen-li, equation 3."""
        ratio = self.impact / self.geometry
        if ratio < 1e-12:
            return 2.0 / math.pi * self.impact
        return 2.0 / math.pi * self.geometry * math.log1p(ratio)


def numbers(velocity: float, mass: float, nose: Nose, target: Target) -> Numbers:
    """I and N of a shot at ``velocity`` (m/s); explanation/penetration/chen-li, equations 1 and 2."""
    positive(mass=mass)
    non_negative(velocity=velocity)
    n1, n2 = nose.factors()
    geometry = mass / (n2 * target.dynamic * nose.diameter**3) if target.dynamic > 0.0 else math.inf
    return Numbers(mass * velocity**2 / (n1 * target.static * nose.diameter**3), geometry)


def transition_velocity(strength: float, nose: Nose, target: Target) -> float | None:
    """The impact velocity at which the mean pressure on the nose reaches the rod's ``strength`` (Pa), m/s.

    sqrt[(Y_p - A Y N1)/(B rho N2)]; explanation/penetration/chen-li, equation 4. 0 if the static pressure already exceeds the
    strength; None if the pressure does not grow with velocity.
    """
    positive(strength=strength)
    n1, n2 = nose.factors()
    spare = strength - n1 * target.static
    if spare <= 0.0:
        return 0.0
    return math.sqrt(spare / (n2 * target.dynamic)) if target.dynamic > 0.0 else None


def evaluate(velocity, *, rod_mass, rod_strength, **shot):
    """Depth of the rigid rod, and whether it stays rigid; keywords are those of ``MODEL.inputs``, in SI."""
    nose, target = of_inputs(**shot)
    ratios = numbers(velocity, rod_mass, nose, target)
    if not math.isfinite(ratios.geometry):
        raise InputError("cavity.b = 0: the geometry function needs a pressure that grows with velocity")
    limit = transition_velocity(rod_strength, nose, target)
    return {
        "depth": ratios.depth * nose.diameter,
        "impact_function": ratios.impact,
        "geometry_function": ratios.geometry,
        "regime": "rigid" if velocity <= limit else "semi-hydrodynamic",
        "transition_velocity": limit,
    }


def transition(*, rod_mass: float | None = None, rod_strength: float, **shot) -> float | None:
    """``transition_velocity`` of ``MODEL.inputs``; the mass does not matter."""
    return transition_velocity(rod_strength, *of_inputs(**shot))


MODEL = Model(
    name="chen-li",
    title="Chen-Li: dimensionless rigid penetration, and its end",
    source="Chen & Li, Int. J. Impact Engng 27 (2002) 619 and J. Engng Mech. 130 (2004) 123 [recalled]",
    validity="the depth holds while the rod is rigid: below the transition velocity, at normal impact on thick targets",
    inputs=(
        inputs.ROD_MASS,
        inputs.ROD_STRENGTH.but(description="dynamic strength of the rod, against the mean pressure on its nose"),
        *SHOT,
    ),
    outputs=(
        Output("depth", "m", "final depth of a rod that stays rigid", "P"),
        Output("impact_function", "1", "energy over static resistance", "I"),
        Output("geometry_function", "1", "slenderness over bluntness", "N"),
        Output("regime", "", "rigid, or semi-hydrodynamic: then the depth is beyond the model's range"),
        Output("transition_velocity", "m/s", "impact velocity above which the rod is no longer rigid", "V_c"),
    ),
    main="depth",
    example=Example(
        rod="steel_4340", target="Al6061_T651", velocity=781.0, velocities=(200.0, 1200.0),
        values=MappingProxyType({"rod.mass": 0.023, "rod.diameter": 7.11e-3, "rod.strength": 2.5e9}),
    ),
    evaluate=evaluate,
    transition=transition,
)
