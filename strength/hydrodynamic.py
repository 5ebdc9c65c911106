"""No strength: a fluid."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import collect
from hydro2d.jit import point
from strength.layout import ROW

NAME = "hydrodynamic"
ID = 0
CONSTANT_MODULUS = True
THERMAL = False
EQUATION = "G = 0,  Y = 0"
SOURCE = "definition"
VALIDITY = "fluids, and solids under pressures far above their strength"
PARAMETERS = ()


@point
def shear_modulus(p, rho, T, par):
    """Zero."""
    return 0.0


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Zero."""
    return 0.0


def row(values) -> np.ndarray:
    """A row of zeros, float64[ROW]; ValueError for any parameter."""
    collect(NAME, PARAMETERS, values)
    return np.zeros(ROW)
