"""Johnson-Cook flow stress. The rate and the temperature factor multiply everything, A included."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point, power
from strength import logarithmic_rate, thermal
from strength.layout import ROW, SHEAR, YIELD

NAME = "johnson-cook"
ID = 2
CONSTANT_MODULUS = True
THERMAL = True
EQUATION = """\
Y = (A + B ep^n) min(1 + C ln max(1, rate/rate0), Rmax) (1 - T*^m),  T* = (T - Tr)/(Tm - Tr) in [0, 1],  G constant"""
SOURCE = "Johnson & Cook, 7th Int. Symp. Ballistics, The Hague (1983) 541"
VALIDITY = "metals; the rate only hardens (no softening below rate0); no strength from Tm on, without Tm no softening"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("yield_stress", "Pa", REQUIRED, "yield stress at zero plastic strain, rate0 and Tr", "A"),
    Parameter("hardening", "Pa", 0.0, "strain hardening", "B"),
    Parameter("hardening_exponent", "", 1.0, "exponent of the plastic strain", "n", POSITIVE),
    *logarithmic_rate.PARAMETERS,
    Parameter("thermal_exponent", "", 1.0, "exponent of the homologous temperature", "m", POSITIVE),
    *thermal.PARAMETERS,
)

#: slots of the row; the common ones are SHEAR and YIELD
HARDENING, EXPONENT, RATE, INVERSE_RATE0, LARGEST, THERMAL_EXPONENT, REFERENCE_T, INVERSE_RANGE = range(2, 10)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, its ``rate`` (1/s) and temperature ``T``, Pa: explanation/strength, (5)."""
    Y = par[YIELD] + par[HARDENING] * power(0.0 if ep < 0.0 else ep, par[EXPONENT])
    Y *= logarithmic_rate.factor(rate, par[RATE], par[INVERSE_RATE0], par[LARGEST])
    return Y * thermal.softening(T, par[REFERENCE_T], par[INVERSE_RANGE], par[THERMAL_EXPONENT])


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(ROW)
    par[SHEAR], par[YIELD] = given["shear_modulus"], given["yield_stress"]
    par[HARDENING], par[EXPONENT] = given["hardening"], given["hardening_exponent"]
    par[RATE], par[INVERSE_RATE0], par[LARGEST] = logarithmic_rate.packed(NAME, given)
    par[THERMAL_EXPONENT] = given["thermal_exponent"]
    par[REFERENCE_T], par[INVERSE_RANGE] = given["reference_temperature"], thermal.inverse_range(NAME, given)
    return par
