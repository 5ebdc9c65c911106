"""A material that takes no damage."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import collect
from hydro2d.jit import point
from strength.layout import DAMAGE_ROW

NAME = "none"
ID = 0
THERMAL = False
EQUATION = "dD = 0"
SOURCE = "definition"
VALIDITY = "always"
PARAMETERS = ()


@point
def damage_increment(dep, rate, T, p, seq, par):
    """Zero."""
    return 0.0


def row(values) -> np.ndarray:
    """A row of zeros, float64[DAMAGE_ROW]; ValueError for any parameter."""
    collect(NAME, PARAMETERS, values)
    return np.zeros(DAMAGE_ROW)
