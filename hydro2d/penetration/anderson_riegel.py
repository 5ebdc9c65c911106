"""Anderson-Riegel: depths of eroding rods on one curve, by similitude, with an effective flow stress of the target.

Normalised depths of long rods fall on one curve when plotted against a power of rho_p V^2 divided by the target's effective
flow stress. That stress is close to the mean of the target's adiabatic stress-strain curve, here by the Johnson-Cook model.
Anderson, Int. J. Impact Engng 108 (2017) 3, section 9.3, equations (64) and (65); Anderson & Riegel, Int. J. Impact Engng 80
(2015) 24. The published curve is given only as a figure. The coefficients here are fitted to depths by
``walker_anderson`` for four pairs of materials of that figure, not to experiments. explanation/penetration/anderson-riegel.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import FRACTION, NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, non_negative, positive

#: powers of the density ratio and of rho_p V^2/sigma in the nondimensional velocity
DENSITY_POWER, VELOCITY_POWER = -0.14, 0.2
#: plastic strain over which the stress is averaged, and strain rate, 1/s
STRAIN, STRAIN_RATE = 1.0, 1.0e3


@dataclass(frozen=True)
class Curve:
    """y = a1 + a2/(1 + 10^(a3 (a4 - x))): Anderson (2017), eq. (64)."""

    a1: float
    a2: float
    a3: float
    a4: float

    def at(self, x: float) -> float:
        return self.a1 + self.a2 / (1.0 + 10.0 ** (self.a3 * (self.a4 - x)))


#: (P/L)/lambda over the nondimensional velocity, fitted to walker_anderson: explanation/penetration/anderson-riegel
COLLAPSED = Curve(-0.0511, 1.1635, 1.9073, 1.8595)


def nondimensional_velocity(velocity: float, rod_density: float, target_density: float, stress: float) -> float:
    """lambda^-0.14 (rho_p V^2/sigma)^0.2, lambda = sqrt(rho_p/rho_t): our reading of Anderson (2017), eq. (65)."""
    ratio = math.sqrt(rod_density / target_density)
    return ratio**DENSITY_POWER * (rod_density * velocity * velocity / stress) ** VELOCITY_POWER


def depth_over_length(velocity: float, *, rod_density: float, target_density: float, stress: float,
                      curve: Curve | None = None) -> float:
    """P/L at an impact velocity in m/s from the collapsed curve, not below 0; ``stress`` is the effective one, Pa."""
    positive(velocity=velocity, **{"rod.density": rod_density, "target.density": target_density, "effective stress": stress})
    x = nondimensional_velocity(velocity, rod_density, target_density, stress)
    return max(0.0, math.sqrt(rod_density / target_density) * (curve or COLLAPSED).at(x))


def fit(x: Sequence[float], y: Sequence[float]) -> Curve:
    """The least-squares curve through points, such as the depths of one pair of materials over the velocity."""
    from scipy.optimize import curve_fit

    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.size < 4 or np.ptp(x) == 0.0 or np.ptp(y) == 0.0:
        raise InputError("a curve with four coefficients needs at least four different points")
    guess = [y.min(), np.ptp(y), 3.0 / np.ptp(x), 0.5 * (x.min() + x.max())]
    coefficients, _ = curve_fit(lambda x, *a: a[0] + a[1] / (1.0 + 10.0 ** (a[2] * (a[3] - x))), x, y, guess, maxfev=20000)
    return Curve(*(float(a) for a in coefficients))


def effective_flow_stress(*, yield_stress: float, hardening: float, exponent: float, rate_coefficient: float,
                          thermal_exponent: float, melt_temperature: float, density: float, specific_heat: float,
                          room_temperature: float = 298.0, strain: float = STRAIN, strain_rate: float = STRAIN_RATE) -> float:
    """The mean of the adiabatic stress-strain curve of Johnson and Cook from zero plastic strain to ``strain``, Pa.

    sigma = (A + B eps^n)(1 + C ln(rate)) (1 - T*^m),  T* = (T - T_room)/(T_melt - T_room),  rho c_v dT = sigma deps

    with all plastic work turned into heat. At constant rate d(T*)/(1 - T*^m) = (A + B eps^n)(...) deps/(rho c_v (T_melt -
    T_room)), and the mean is the heat, rho c_v (T - T_room), over the strain. explanation/penetration/anderson-riegel,
    equations 5 to 7
    """
    from scipy.integrate import solve_ivp

    positive(yield_stress=yield_stress, thermal_exponent=thermal_exponent, density=density, specific_heat=specific_heat,
             strain=strain, strain_rate=strain_rate)
    non_negative(hardening=hardening, exponent=exponent, rate_coefficient=rate_coefficient)
    if melt_temperature <= room_temperature:
        raise InputError("the melting temperature must be above that before impact")
    range_of_heat = density * specific_heat * (melt_temperature - room_temperature)
    cold = (yield_stress * strain + hardening * strain ** (exponent + 1.0) / (exponent + 1.0)) * (
        1.0 + rate_coefficient * math.log(max(strain_rate, 1.0)))
    end = cold / range_of_heat
    warm = solve_ivp(lambda work, hot: 1.0 - min(max(hot[0], 0.0), 1.0) ** thermal_exponent, (0.0, end), [0.0],
                     rtol=1e-9, atol=1e-12)
    return float(warm.y[0, -1]) * range_of_heat / strain


def stress_of(*, target_density: float, target_effective_flow_stress: float | None = None,
              **johnson_cook: float | None) -> float:
    """The effective flow stress, Pa: as given, or from Johnson and Cook's parameters."""
    if target_effective_flow_stress is not None:
        return target_effective_flow_stress
    missing = [entry.name for entry in JOHNSON_COOK if johnson_cook.get(entry.keyword) is None]
    if missing:
        raise InputError(f"target.effective_flow_stress is not given: from Johnson and Cook it needs {', '.join(missing)}")
    values = {name: johnson_cook[entry.keyword] for name, entry in zip(ARGUMENTS, JOHNSON_COOK, strict=True)}
    return effective_flow_stress(density=target_density, **values)


def evaluate(velocity: float, *, rod_density: float, rod_length: float, target_density: float,
             **values: float | None) -> dict[str, float]:
    """Depth at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    positive(velocity=velocity, **{"rod.length": rod_length})
    stress = stress_of(target_density=target_density, **values)
    ratio = depth_over_length(velocity, rod_density=rod_density, target_density=target_density, stress=stress)
    return {
        "depth": ratio * rod_length,
        "depth_over_length": ratio,
        "nondimensional_velocity": nondimensional_velocity(velocity, rod_density, target_density, stress),
        "effective_flow_stress": stress,
    }


#: arguments of ``effective_flow_stress`` and the inputs that give them
ARGUMENTS = (
    "yield_stress", "hardening", "exponent", "rate_coefficient", "thermal_exponent", "melt_temperature", "specific_heat",
    "room_temperature", "strain", "strain_rate",
)
JOHNSON_COOK = (
    Input("target.johnson_cook_a", "Pa", "A of Johnson and Cook, the yield stress", "A", default=None),
    Input("target.johnson_cook_b", "Pa", "B of Johnson and Cook, the hardening", "B", default=None, sign=NON_NEGATIVE),
    Input("target.johnson_cook_n", "1", "n of Johnson and Cook, the exponent of hardening", "n", default=None, sign=FRACTION),
    Input("target.johnson_cook_c", "1", "C of Johnson and Cook, of the rate over 1/s", "C", default=None, sign=NON_NEGATIVE),
    Input("target.johnson_cook_m", "1", "m of Johnson and Cook, the exponent of temperature", "m", default=None),
    Input("target.melt_temperature", "K", "melting temperature of the target", "T_melt", default=None),
    Input("target.specific_heat", "J/(kg*K)", "specific heat of the target", "c_v", default=None),
    Input("target.reference_temperature", "K", "temperature of the target before impact", "T_room", default=298.0),
    Input("target.strain", "1", "plastic strain over which the stress is averaged", "eps", default=STRAIN),
    Input("target.strain_rate", "1/s", "strain rate of the average; lower rates count as 1/s", "rate", default=STRAIN_RATE),
)

MODEL = Model(
    name="anderson-riegel",
    title="Anderson-Riegel: depths of eroding rods on one curve, by the target's effective flow stress",
    source="Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (64) and (65); Anderson & Riegel, ibid. 80 (2015) 24",
    validity="eroding rods of ten diameters in metals, 0.7 to 3 km/s; coefficients fitted to walker-anderson",
    inputs=(
        inputs.ROD_DENSITY,
        inputs.ROD_LENGTH,
        inputs.TARGET_DENSITY,
        Input("target.effective_flow_stress", "Pa", "effective flow stress; from Johnson and Cook where not given", "sigma_efs",
              default=None),
        *JOHNSON_COOK,
    ),
    outputs=(
        Output("depth", "m", "depth of penetration", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("nondimensional_velocity", "1", "lambda^-0.14 (rho_p V^2/sigma)^0.2", "V*"),
        Output("effective_flow_stress", "Pa", "effective flow stress of the target", "sigma_efs"),
    ),
    main="depth_over_length",
    example=Example(
        rod="W_alloy",
        target="steel_4340",
        velocity=1500.0,
        velocities=(700.0, 3000.0),
        values=MappingProxyType({
            "rod.length": 0.100,
            "target.johnson_cook_a": 792e6,
            "target.johnson_cook_b": 510e6,
            "target.johnson_cook_n": 0.26,
            "target.johnson_cook_c": 0.014,
            "target.johnson_cook_m": 1.03,
            "target.melt_temperature": 1793.0,
            "target.specific_heat": 477.0,
        }),
    ),
    evaluate=evaluate,
)
