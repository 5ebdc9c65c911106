"""The factor of the strain rate that several models share: it grows with the logarithm of the rate, up to a cap."""

from __future__ import annotations

import math

from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.jit import log, point

PARAMETERS = (
    Parameter("rate_coefficient", "", 0.0, "increase per e-fold of strain rate", "C"),
    Parameter("reference_rate", "1/s", 1.0, "strain rate below which the rate does not matter", "rate0", POSITIVE),
    Parameter("max_rate_factor", "", math.inf, "largest factor by which the rate raises the flow stress", "Rmax", POSITIVE,
              example=1.3),
)


@point
def factor(rate, coefficient, inverse_rate0, largest):
    """Factor at the strain ``rate``, 1/s, 1 at rate 0: explanation/strength, (17)."""
    fast = rate * inverse_rate0
    grown = 1.0 + coefficient * log(1.0 if fast < 1.0 else fast)
    return largest if grown > largest else grown


def packed(model: str, given: dict[str, float]) -> tuple[float, float, float]:
    """(coefficient, inverse_rate0, largest) of a model's parameters; ValueError for a cap below 1."""
    largest = given["max_rate_factor"]
    if largest < 1.0:
        raise ValueError(f"{model}: max_rate_factor = {largest:g}: must be at least 1, the factor at the reference rate")
    return given["rate_coefficient"], 1.0 / given["reference_rate"], largest
