"""Steady penetration of fluids: hydrodynamic theory, and its modification by the strength of target and jet.

In the frame of the interface both streams stagnate at the same pressure,

    rho_p (v - u)^2/2 = rho_t u^2/2 + sigma,

with sigma = 0 in the hydrodynamic theory. Eichelberger uses the difference of the two strengths as sigma, Allen and Rogers a
dynamic yield strength of the target alone. The whole rod is consumed at one velocity: P = L u/(v - u). Anderson, Int.
J. Impact Engng 108 (2017) 3, equations (10) to (14). explanation/penetration/hydrodynamic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import ANY, NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, complain, non_negative, positive

#: sigma_t over the yield stress of 7075-T6, as found by Allen and Rogers for rods of six metals: Anderson (2017), section 3.2
ALLEN_ROGERS_FACTOR = 3.9


def penetration_velocity(velocity: float, *, rod_density: float, target_density: float,
                         strength_difference: float = 0.0) -> float:
    """Velocity u of the interface, m/s: eq. (14) of Anderson (2017); for no difference eq. (11), v/(1 + sqrt(rho_t/rho_p)).

    velocity v (m/s) of the rod; densities (kg/m^3); strength_difference sigma (Pa), positive if the target is the stronger. The
    result is 0 up to the velocity sqrt(2 sigma/rho_p), below which the jet does not penetrate. InputError where a rod stronger
    than the target would not be consumed. explanation/penetration/hydrodynamic, equation 4
    """
    positive(rod_density=rod_density, target_density=target_density)
    non_negative(velocity=velocity)
    complain("strength_difference", strength_difference, ANY)
    if velocity**2 <= 2.0 * strength_difference / rod_density:
        return 0.0
    slowest = math.sqrt(max(0.0, -2.0 * strength_difference) / target_density)
    if velocity <= slowest:
        raise InputError(
            f"velocity = {velocity:g}: up to {slowest:.5g} m/s the rod is too strong to be consumed, and hydrodynamic theory "
            "does not hold (tate does)")
    u = interface_velocity(velocity, rod_density=rod_density, target_density=target_density, difference=strength_difference)
    return float(u)


def interface_velocity(
    velocity: float | np.ndarray, *, rod_density: float, target_density: float, difference: float
) -> float | np.ndarray:
    """The root u of eq. (14) at velocities at which a rod erodes and penetrates, m/s: Anderson (2017), eq. (32).

    difference: R_t - Y_p, or sigma, Pa. The form used also holds for equal densities, where eq. (32) is 0/0:
    explanation/penetration/hydrodynamic, equation 4.
    """
    mu = math.sqrt(target_density / rod_density)
    if difference == 0.0:
        return velocity / (1.0 + mu)
    squared = velocity**2 + 2.0 * difference * (1.0 / target_density - 1.0 / rod_density)
    return (velocity**2 - 2.0 * difference / rod_density) / (velocity + mu * np.sqrt(np.maximum(0.0, squared)))


def depth_over_length(velocity: float, *, rod_density: float, target_density: float, strength_difference: float = 0.0) -> float:
    """P/L = u/(v - u), Anderson (2017), eq. (13): sqrt(rho_p/rho_t) for no difference of strength."""
    positive(rod_density=rod_density, target_density=target_density)
    if strength_difference == 0.0:
        return math.sqrt(rod_density / target_density)
    u = penetration_velocity(
        velocity, rod_density=rod_density, target_density=target_density, strength_difference=strength_difference)
    return u / (velocity - u) if u > 0.0 else 0.0


def jet_depth(velocities: Sequence[float], lengths: Sequence[float], *, rod_density: float, target_density: float,
              strength_difference: float = 0.0) -> float:
    """Depth (m) of a jet cut into pieces of one velocity (m/s) and length (m) each: the sum of the pieces' depths."""
    if len(velocities) != len(lengths):
        raise InputError("a jet needs as many lengths as velocities")
    non_negative(**{f"lengths[{i}]": length for i, length in enumerate(lengths)})
    values = {"rod_density": rod_density, "target_density": target_density, "strength_difference": strength_difference}
    return sum(length * depth_over_length(velocity, **values) for velocity, length in zip(velocities, lengths, strict=True))


def evaluate(velocity: float, *, rod_density: float, rod_length: float, target_density: float) -> dict[str, float | str]:
    """Hydrodynamic depth at an impact velocity in m/s; keywords are those of ``HYDRODYNAMIC.inputs``, in SI."""
    return _penetrated(velocity, rod_density, rod_length, target_density, 0.0)


def evaluate_eichelberger(velocity: float, *, rod_density: float, rod_length: float, rod_strength: float, target_density: float,
                          target_strength: float, target_strength_factor: float) -> dict[str, float | str]:
    """Depth with sigma = factor Y_t - Y_p; keywords are those of ``EICHELBERGER.inputs``, in SI."""
    difference = target_strength_factor * target_strength - rod_strength
    return _penetrated(velocity, rod_density, rod_length, target_density, difference)


def evaluate_allen_rogers(velocity: float, *, rod_density: float, rod_length: float, target_density: float,
                          target_strength: float | None, target_dynamic_strength: float | None) -> dict[str, float | str]:
    """Depth with sigma = sigma_t, by default 3.9 Y_t; keywords are those of ``ALLEN_ROGERS.inputs``, in SI."""
    if target_dynamic_strength is None:
        if target_strength is None:
            raise InputError("target.dynamic_strength is not given: it needs target.strength")
        target_dynamic_strength = ALLEN_ROGERS_FACTOR * target_strength
    return _penetrated(velocity, rod_density, rod_length, target_density, target_dynamic_strength)


def _penetrated(velocity: float, rod_density: float, rod_length: float, target_density: float,
                difference: float) -> dict[str, float | str]:
    positive(velocity=velocity)
    values = {"rod_density": rod_density, "target_density": target_density, "strength_difference": difference}
    u = penetration_velocity(velocity, **values)
    ratio = depth_over_length(velocity, **values)
    return {
        "depth": ratio * rod_length,
        "depth_over_length": ratio,
        "penetration_velocity": u,
        "duration": rod_length / (velocity - u) if u > 0.0 else 0.0,
        "strength_difference": difference,
        "limit_velocity": math.sqrt(max(0.0, 2.0 * difference / rod_density)),
        "regime": "eroding" if u > 0.0 else "no penetration",
    }


OUTPUTS = (
    Output("depth", "m", "depth of penetration", "P"),
    Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
    Output("penetration_velocity", "m/s", "velocity of the interface", "u"),
    Output("duration", "s", "time until the rod is consumed"),
    Output("strength_difference", "Pa", "sigma, by how much the target's resistance exceeds the rod's strength", "sigma"),
    Output("limit_velocity", "m/s", "impact velocity up to which nothing penetrates"),
    Output("regime", "", "eroding or no penetration"),
)
BASICS = (inputs.ROD_DENSITY, inputs.ROD_LENGTH, inputs.TARGET_DENSITY)
ROD = MappingProxyType({"rod.length": 0.1})
EXAMPLE = Example(rod="copper_OFHC", target="steel_4340", velocity=3000.0, velocities=(500.0, 8000.0), values=ROD)
VALIDITY = "long rods or jets of steady velocity that are consumed; no shock at impact, no penetration after the last particle"

HYDRODYNAMIC = Model(
    name="hydrodynamic",
    title="Hydrodynamic theory: the depth of a jet without strength",
    source="Birkhoff, MacDougall, Pugh & Taylor, J. Appl. Phys. 19 (1948) 563; "
    "Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (10) to (13)",
    validity=VALIDITY + "; velocities at which no strength matters",
    inputs=BASICS,
    outputs=OUTPUTS,
    main="depth_over_length",
    example=EXAMPLE,
    evaluate=evaluate,
)

EICHELBERGER = Model(
    name="eichelberger",
    title="Modified hydrodynamic theory of Eichelberger: the difference of two strengths",
    source="Eichelberger, J. Appl. Phys. 27 (1956) 63; Anderson, Int. J. Impact Engng 108 (2017) 3, eq. (14)",
    validity=VALIDITY + "; jets weaker than the target",
    inputs=(
        *BASICS,
        inputs.ROD_STRENGTH.but(description="strength of the rod or jet", sign=NON_NEGATIVE, default=0.0),
        inputs.TARGET_STRENGTH,
        Input("target.strength_factor", "1", "resistance of the target over its yield stress; 1 to 3 by Eichelberger", "k",
              default=1.0),
    ),
    outputs=OUTPUTS,
    main="depth_over_length",
    example=EXAMPLE,
    evaluate=evaluate_eichelberger,
)

ALLEN_ROGERS = Model(
    name="allen-rogers",
    title="Modified hydrodynamic theory of Allen and Rogers: a dynamic yield strength of the target",
    source="Allen & Rogers, J. Franklin Inst. 272 (1961) 275; Anderson, Int. J. Impact Engng 108 (2017) 3, section 3.2",
    validity=VALIDITY + "; weak rods; the strength was found for 7075-T6, and to depend on the velocity",
    inputs=(
        *BASICS,
        inputs.TARGET_STRENGTH.but(default=None),
        Input("target.dynamic_strength", "Pa", "dynamic yield strength against a jet; 3.9 target.strength where not given",
              "sigma_t", default=None),
    ),
    outputs=OUTPUTS,
    main="depth_over_length",
    example=Example(rod="copper_OFHC", target="Al7075_T6", velocity=3000.0, velocities=(500.0, 8000.0), values=ROD),
    evaluate=evaluate_allen_rogers,
)

MODELS = (HYDRODYNAMIC, EICHELBERGER, ALLEN_ROGERS)
