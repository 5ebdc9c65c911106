"""Johnson-Holmquist damage of brittle solids (JH-2): plastic strain over a fracture strain that grows with pressure."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point, power
from strength import cell_size
from strength.layout import DAMAGE_ROW

NAME = "johnson-holmquist"
ID = 2
THERMAL = False
EQUATION = """\
dD = dep/ef,  ef = D1 (p* + T*)^D2, not below ef_min,  p* = p/P_HEL,  T* = T/P_HEL;  crushed at D = 1
ef times (h/h0)^-m in a cell of the size h = sqrt(dr dz)"""
SOURCE = "Johnson & Holmquist, High-Pressure Science and Technology 1993, AIP Conf. Proc. 309 (1994) 981"
VALIDITY = "ceramics and glass, with the strength model of the same name"
PARAMETERS = (
    Parameter("D1", "", REQUIRED, "fracture strain at p* + T* = 1", "D1", NON_NEGATIVE),
    Parameter("D2", "", REQUIRED, "exponent of p* + T*", "D2", NON_NEGATIVE),
    Parameter("T", "Pa", REQUIRED, "largest hydrostatic tension of intact material", "T", NON_NEGATIVE),
    Parameter("P_HEL", "Pa", REQUIRED, "pressure at the Hugoniot elastic limit", "P_HEL", POSITIVE),
    Parameter("minimum_fracture_strain", "", 1e-6, "lower bound of the fracture strain", "ef_min", POSITIVE),
    *cell_size.PARAMETERS,
)

#: slots of the row
FACTOR, EXPONENT, TENSION, INVERSE_P, LEAST, INVERSE_AREA, HALF_EXPONENT = range(7)


@point
def damage_increment(dep, rate, T, p, seq, par):
    """Increment of damage for the plastic strain increment ``dep``: explanation/fracture, (7).

    The strain rate, temperature T and von Mises stress do not matter; ``p`` pressure (compression positive, Pa).
    """
    if dep == 0.0:
        return 0.0
    pressed = max(p * par[INVERSE_P] + par[TENSION], 0.0)
    strain = par[FACTOR] * power(pressed, par[EXPONENT]) if pressed > 0.0 else 0.0
    return dep / max(strain, par[LEAST])


@point
def size_factor(area, par):
    """Factor on the increment of damage in a cell of this ``area``, m^2: explanation/fracture, (7a)."""
    return cell_size.faster(area, par[INVERSE_AREA], par[HALF_EXPONENT])


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[DAMAGE_ROW]. Raises ValueError for a missing or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(DAMAGE_ROW)
    par[FACTOR], par[EXPONENT], par[LEAST] = given["D1"], given["D2"], given["minimum_fracture_strain"]
    par[INVERSE_P] = 1.0 / given["P_HEL"]
    par[TENSION] = given["T"] * par[INVERSE_P]
    par[INVERSE_AREA], par[HALF_EXPONENT] = cell_size.packed(NAME, given)
    return par
