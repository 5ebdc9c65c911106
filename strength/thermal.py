"""The homologous temperature that several models share."""

from __future__ import annotations

import math

from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.jit import point, power

PARAMETERS = (
    Parameter("reference_temperature", "K", 298.0, "temperature at which softening begins", "Tr", POSITIVE),
    Parameter("melt_temperature", "K", math.inf, "melting temperature; without it nothing softens", "Tm", POSITIVE),
)


@point
def homologous_temperature(T, reference, inverse_range):
    """T* = (T - Tr)/(Tm - Tr), clamped to [0, 1]; ``inverse_range`` is 1/(Tm - Tr), 0 where nothing melts."""
    share = (T - reference) * inverse_range
    share = 0.0 if share < 0.0 else share  # a NaN stays one
    return 1.0 if share > 1.0 else share


@point
def softening(T, reference, inverse_range, exponent):
    """1 - T*^m with the homologous temperature T*: explanation/strength, (5)."""
    hot = homologous_temperature(T, reference, inverse_range)
    return 1.0 - (hot if exponent == 1.0 else power(hot, exponent))


def inverse_range(model: str, given: dict[str, float]) -> float:
    """1/(Tm - Tr) of a model's parameters; ValueError unless Tm > Tr."""
    span = given["melt_temperature"] - given["reference_temperature"]
    if span <= 0.0:
        raise ValueError(f"{model}: melt_temperature must be above reference_temperature")
    return 1.0 / span
