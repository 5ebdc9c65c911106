"""Fracture at a tensile pressure."""

from __future__ import annotations

import math

from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.jit import point

NAME = "tensile-pressure"
EQUATION = "fractured where p < -fracture_pressure"
SOURCE = "McGlaun, Thompson & Elrick, Int. J. Impact Engng 10 (1990) 351"
VALIDITY = "spall of ductile metals; independent of time"
PARAMETERS = (
    Parameter(
        "fracture_pressure", "Pa", math.inf, "tension at which the material opens, a positive number", "pf", POSITIVE
    ),
)


@point
def fails(p, threshold):
    """Whether the pressure ``p`` (compression positive) is a tension beyond ``threshold`` > 0; Pa."""
    return p < -threshold
