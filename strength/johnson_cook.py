"""Johnson-Cook flow stress. The rate and the temperature factor multiply everything, A included."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import log, point, power
from strength import thermal
from strength.layout import ROW, SHEAR, YIELD

NAME = "johnson-cook"
ID = 2
CONSTANT_MODULUS = True
THERMAL = True
EQUATION = """\
Y = (A + B ep^n) (1 + C ln max(1, rate/rate0)) (1 - T*^m),  T* = (T - Tr)/(Tm - Tr) in [0, 1],  G constant"""
SOURCE = "Johnson & Cook, 7th Int. Symp. Ballistics, The Hague (1983) 541"
VALIDITY = "metals; the rate only hardens (no softening below rate0); no strength from Tm on, without Tm no softening"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("yield_stress", "Pa", REQUIRED, "yield stress at zero plastic strain, rate0 and Tr", "A"),
    Parameter("hardening", "Pa", 0.0, "strain hardening", "B"),
    Parameter("hardening_exponent", "", 1.0, "exponent of the plastic strain", "n", POSITIVE),
    Parameter("rate_coefficient", "", 0.0, "increase per e-fold of strain rate", "C"),
    Parameter("reference_rate", "1/s", 1.0, "strain rate below which the rate does not matter", "rate0", POSITIVE),
    Parameter("thermal_exponent", "", 1.0, "exponent of the homologous temperature", "m", POSITIVE),
    *thermal.PARAMETERS,
)

#: slots of the row; the common ones are SHEAR and YIELD
HARDENING, EXPONENT, RATE, INVERSE_RATE0, THERMAL_EXPONENT, REFERENCE_T, INVERSE_RANGE = range(2, 9)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, its ``rate`` (1/s) and temperature ``T``, Pa: explanation/strength, (5)."""
    hot = thermal.homologous_temperature(T, par[REFERENCE_T], par[INVERSE_RANGE])
    exponent = par[THERMAL_EXPONENT]
    fast = rate * par[INVERSE_RATE0]
    Y = par[YIELD] + par[HARDENING] * power(0.0 if ep < 0.0 else ep, par[EXPONENT])
    Y *= 1.0 + par[RATE] * log(1.0 if fast < 1.0 else fast)
    return Y * (1.0 - (hot if exponent == 1.0 else power(hot, exponent)))


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(ROW)
    par[SHEAR], par[YIELD] = given["shear_modulus"], given["yield_stress"]
    par[HARDENING], par[EXPONENT] = given["hardening"], given["hardening_exponent"]
    par[RATE], par[INVERSE_RATE0] = given["rate_coefficient"], 1.0 / given["reference_rate"]
    par[THERMAL_EXPONENT] = given["thermal_exponent"]
    par[REFERENCE_T], par[INVERSE_RANGE] = given["reference_temperature"], thermal.inverse_range(NAME, given)
    return par
