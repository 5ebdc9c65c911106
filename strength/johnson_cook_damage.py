"""Johnson-Cook damage: plastic strain over a fracture strain that depends on triaxiality, rate and temperature."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.base.parameters import ANY, POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point
from strength import cell_size, thermal
from strength.layout import DAMAGE_ROW, JOHNSON_COOK, PLASTIC_STRAIN

NAME = "johnson-cook"
ID = 1
THERMAL = True
EQUATION = """\
dD = dep/ef,  ef = [D1 + D2 exp(D3 p*)] [1 + D4 ln max(1, rate/rate0)] [1 + D5 T*],  not below ef_min
or with [1 + rate/rate0]^n in the place of the logarithm
p* = mean stress (tension positive) / von Mises stress,  T* = (T - Tr)/(Tm - Tr) in [0, 1];  fractured at D = 1
ef times (h/h0)^-m in a cell of the size h = sqrt(dr dz)"""
SOURCE = "Johnson & Cook, Engng Fract. Mech. 21 (1985) 31; power of the rate: Clausen & others, Mater. Sci. Eng. A364 (2004)"
VALIDITY = "ductile metals; the fit's range of p* is about -1 to 1.5; without Tm the temperature does not matter"
PARAMETERS = (
    Parameter("D1", "", REQUIRED, "fracture strain at high triaxiality", "D1", ANY),
    Parameter("D2", "", 0.0, "factor of the triaxiality term", "D2", ANY),
    Parameter("D3", "", 0.0, "exponent of the triaxiality", "D3", ANY),
    Parameter("D4", "", 0.0, "increase per e-fold of strain rate", "D4", ANY),
    Parameter("D5", "", 0.0, "increase up to melt", "D5", ANY),
    Parameter("rate_exponent", "", 0.0, "exponent of 1 + rate/rate0, in the place of D4", "n", ANY),
    Parameter("reference_rate", "1/s", 1.0, "strain rate below which the rate does not matter", "rate0", POSITIVE),
    Parameter("minimum_fracture_strain", "", 1e-6, "lower bound of the fracture strain", "ef_min", POSITIVE),
    *thermal.PARAMETERS,
    *cell_size.PARAMETERS,
)

#: slots of the row
D1, D2, D3, D4, D5, INVERSE_RATE0, LEAST, REFERENCE_T, INVERSE_RANGE, RATE_EXPONENT, INVERSE_AREA, HALF_EXPONENT = range(12)

#: largest exponent, at which exp() is still finite; least von Mises stress in the triaxiality, Pa
_STEEPEST, _UNSTRESSED = 700.0, 1.0


@point
def fracture_strain(rate, T, p, seq, par):
    """Plastic strain at fracture under constant conditions, at least the minimum: explanation/fracture, (4)."""
    strain = par[D1]
    if par[D2] != 0.0:
        exponent = -par[D3] * p / max(seq, _UNSTRESSED)
        strain += par[D2] * math.exp(min(max(exponent, -_STEEPEST), _STEEPEST))
    fast = rate * par[INVERSE_RATE0]
    if par[D4] != 0.0 and fast > 1.0:
        strain *= 1.0 + par[D4] * math.log(fast)
    if par[RATE_EXPONENT] != 0.0:
        strain *= (1.0 + fast) ** par[RATE_EXPONENT]
    strain *= 1.0 + par[D5] * thermal.homologous_temperature(T, par[REFERENCE_T], par[INVERSE_RANGE])
    return max(strain, par[LEAST])


@point
def damage_increment(dep, rate, T, p, seq, par):
    """Increment of damage for the plastic strain increment ``dep``: explanation/fracture, (5).

    ``rate`` plastic strain rate (1/s), ``T`` temperature (K), ``p`` pressure (compression positive) and ``seq`` von
    Mises stress, hoop stress included (Pa).
    """
    if dep == 0.0:
        return 0.0
    return dep / fracture_strain(rate, T, p, seq, par)


@point
def size_factor(area, par):
    """Factor on the increment of damage in a cell of this ``area``, m^2: explanation/fracture, (7a)."""
    return cell_size.faster(area, par[INVERSE_AREA], par[HALF_EXPONENT])


def criterion(par) -> int:
    """What material that it has broken failed by: PLASTIC_STRAIN if nothing but D1 is given, else JOHNSON_COOK."""
    return JOHNSON_COOK if any(par[[D2, D4, D5, RATE_EXPONENT]]) else PLASTIC_STRAIN


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[DAMAGE_ROW]. Raises ValueError for a missing or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if given["D4"] != 0.0 and given["rate_exponent"] != 0.0:
        raise ValueError(f"{NAME}: D4 and rate_exponent are two laws of the rate: give one of them")
    par = np.zeros(DAMAGE_ROW)
    for slot, name in ((D1, "D1"), (D2, "D2"), (D3, "D3"), (D4, "D4"), (D5, "D5")):
        par[slot] = given[name]
    par[INVERSE_RATE0], par[LEAST] = 1.0 / given["reference_rate"], given["minimum_fracture_strain"]
    par[RATE_EXPONENT] = given["rate_exponent"]
    par[REFERENCE_T], par[INVERSE_RANGE] = given["reference_temperature"], thermal.inverse_range(NAME, given)
    par[INVERSE_AREA], par[HALF_EXPONENT] = cell_size.packed(NAME, given)
    return par
