"""Secondary penetration: eroded rod material that hits the bottom of the crater again.

The debris of an eroding rod leaves the interface at 2 u - v. It deepens the crater if this points into the target and its
stagnation pressure exceeds the resistance. Anderson, Int. J. Impact Engng 108 (2017) 3, equation (37), with u by ``tate``;
Allen & Rogers, J. Franklin Inst. 272 (1961) 275. The criterion says whether the crater deepens, not by how much.
explanation/penetration/secondary-penetration.
"""

from __future__ import annotations

import math

from hydro2d.penetration import tate
from hydro2d.penetration.model import Example, Model, Output, non_negative


def debris_velocity(velocity: float, *, rod_density: float, rod_strength: float, target_density: float,
                    resistance: float) -> float:
    """2 u - v, m/s, positive into the target, at a velocity v (m/s) of the rod; 0 for a rigid rod, which sheds none.

    densities (kg/m^3); rod_strength Y_p and resistance R_t (Pa). Anderson (2017), section 6.3
    """
    non_negative(velocity=velocity)
    pair = tate.Pair(rod_density, rod_strength, target_density, resistance)
    if pair.regime(velocity) == tate.RIGID:
        return 0.0
    return 2.0 * pair.penetration_velocity(velocity) - velocity


def debris_pressure(velocity: float, *, rod_density: float, rod_strength: float, target_density: float,
                    resistance: float) -> float:
    """rho_p (2 u - v)^2/2 of debris that flies into the target, Pa; 0 for other debris. Anderson (2017), eq. (37)."""
    debris = debris_velocity(
        velocity, rod_density=rod_density, rod_strength=rod_strength, target_density=target_density, resistance=resistance)
    return 0.5 * rod_density * max(0.0, debris) ** 2


def onset_velocity(*, rod_density: float, rod_strength: float, target_density: float, resistance: float) -> float | None:
    """The impact velocity above which debris always penetrates, m/s; None for a rod no denser than the target.

    The larger root of rho_p (2 u - v)^2/2 = R_t, or the transition velocity if there is no root above it:
    explanation/penetration/secondary-penetration, equation 4
    """
    pair = tate.Pair(rod_density, rod_strength, target_density, resistance)
    if rod_density <= target_density:
        return None
    debris = math.sqrt(2.0 * resistance / rod_density)
    root = (rod_density * debris) ** 2 - 2.0 * rod_strength * (rod_density - target_density)
    if root < 0.0:
        return pair.transition_velocity
    u = (rod_density * debris + math.sqrt(root)) / (rod_density - target_density)
    return max(2.0 * u - debris, pair.transition_velocity)


def evaluate(velocity: float, **values: float | str | None) -> dict[str, float | str]:
    """Debris at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    pair = tate.pair_of(**values)
    pressure = debris_pressure(velocity, **vars(pair))
    return {
        "penetration_velocity": pair.penetration_velocity(velocity),
        "debris_velocity": debris_velocity(velocity, **vars(pair)),
        "debris_pressure": pressure,
        "pressure_over_resistance": pressure / pair.resistance,
        "resistance": pair.resistance,
        "regime": "secondary penetration" if pressure > pair.resistance else "none",
    }


MODEL = Model(
    name="secondary-penetration",
    title="Secondary penetration by the debris of an eroding rod",
    source="Anderson, Int. J. Impact Engng 108 (2017) 3, eq. (37); Allen & Rogers, J. Franklin Inst. 272 (1961) 275",
    validity="eroding rods denser than the target; says whether debris penetrates at impact, not how deep",
    inputs=tate.PAIR_INPUTS,
    outputs=(
        Output("penetration_velocity", "m/s", "velocity of the interface at impact", "u"),
        Output("debris_velocity", "m/s", "velocity of the debris, positive into the target", "2 u - v"),
        Output("debris_pressure", "Pa", "stagnation pressure of debris that flies into the target"),
        Output("pressure_over_resistance", "1", "that pressure over the resistance; above 1 debris penetrates"),
        Output("resistance", "Pa", "resistance of the target", "R_t"),
        Output("regime", "", "secondary penetration or none"),
    ),
    main="pressure_over_resistance",
    example=Example(rod="W_alloy", target="Al5083", velocity=2000.0, velocities=(200.0, 3000.0)),
    evaluate=evaluate,
)
