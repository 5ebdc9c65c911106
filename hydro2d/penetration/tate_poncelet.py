"""Tate-Poncelet: a rigid rod against the stress R_t + rho_t v^2/2 of the modified Bernoulli equation.

Poncelet's equation with a = R_t and b = rho_t/2, so that its constants are properties of the target: Anderson, Int. J.
Impact Engng 108 (2017) 3, equations (35) and (36). It is the rigid regime of ``tate``, extended beyond the rod's strength.
explanation/penetration/tate-poncelet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import MappingProxyType

from hydro2d.penetration import inputs, poncelet
from hydro2d.penetration.model import Example, InputError, Model, Output, positive
from hydro2d.penetration.target_resistance import RESISTANCE_INPUTS, resistance_of


def depth_over_length(velocity: float, *, rod_density: float, target_density: float, resistance: float) -> float:
    """P/L = (rho_p/rho_t) ln(1 + rho_t V^2/(2 R_t)), Anderson (2017), eq. (36).

    velocity V (m/s) at impact; densities (kg/m^3); resistance R_t (Pa), the same at all velocities and for all
    noses. For a rod that neither deforms nor erodes.
    """
    positive(target_density=target_density, resistance=resistance)
    return poncelet.depth_over_length(velocity, rod_density=rod_density, a=resistance, b=0.5 * target_density)


def resistance_from_depth(depth_over_length: float, velocity: float, *, rod_density: float, target_density: float) -> float:
    """The R_t (Pa) with which a shot's P/L follows from eq. (36): explanation/penetration/tate-poncelet, equation 3."""
    positive(depth_over_length=depth_over_length, velocity=velocity, rod_density=rod_density, target_density=target_density)
    exponent = depth_over_length * target_density / rod_density
    if exponent > math.log(1e300):
        raise InputError(f"depth_over_length = {depth_over_length:g}: too deep for any resistance")
    return 0.5 * target_density * velocity**2 / math.expm1(exponent)


def fit(velocities: Sequence[float], depths_over_length: Sequence[float], *, rod_density: float,
        target_density: float) -> poncelet.Fit:
    """Least-squares R_t, the ``a`` of the result, of P/L measured at velocities in m/s where the rods stayed rigid."""
    positive(target_density=target_density)
    return poncelet.fit(velocities, depths_over_length, rod_density=rod_density, b=0.5 * target_density)


def evaluate(velocity: float, *, rod_density: float, rod_length: float, target_density: float,
             **target: float | str | None) -> dict[str, float]:
    """Depth at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    resistance = resistance_of(**target)
    ratio = depth_over_length(velocity, rod_density=rod_density, target_density=target_density, resistance=resistance)
    return {
        "depth": ratio * rod_length,
        "depth_over_length": ratio,
        "duration": poncelet.duration(
            velocity, rod_density=rod_density, rod_length=rod_length, a=resistance, b=0.5 * target_density),
        "nose_stress": resistance + 0.5 * target_density * velocity**2,
        "resistance": resistance,
    }


MODEL = Model(
    name="tate-poncelet",
    title="Tate-Poncelet: a rigid rod against the resistance and the inertia of the target",
    source="Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (35) and (36)",
    validity="rods that stay rigid, at any velocity; the nose's shape does not enter",
    inputs=(inputs.ROD_DENSITY, inputs.ROD_LENGTH, inputs.TARGET_DENSITY, *RESISTANCE_INPUTS),
    outputs=(
        Output("depth", "m", "depth of penetration", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("duration", "s", "time from impact to rest"),
        Output("nose_stress", "Pa", "stress on the nose at impact", "sigma"),
        Output("resistance", "Pa", "resistance of the target", "R_t"),
    ),
    main="depth_over_length",
    example=Example(
        rod="W_alloy", target="Al5083", velocity=1086.0, velocities=(200.0, 1400.0),
        values=MappingProxyType({"rod.length": 0.0973}),
    ),
    evaluate=evaluate,
)
