"""Voce hardening, which saturates, with the factors of rate and temperature of Johnson and Cook."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import exp, point
from strength import logarithmic_rate, thermal
from strength.layout import ROW, SHEAR, YIELD

NAME = "voce"
ID = 8
CONSTANT_MODULUS = True
THERMAL = True
EQUATION = """\
Y = (Y0 + Q (1 - exp(-b ep))) min(1 + C ln max(1, rate/rate0), Rmax) (1 - T*^m),  T* = (T - Tr)/(Tm - Tr) in [0, 1]
G constant"""
SOURCE = "Voce, J. Inst. Metals 74 (1948) 537; the other factors are those of Johnson & Cook (1983)"
VALIDITY = "metals whose hardening saturates; the rate only hardens; no strength from Tm on, without Tm no softening"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("yield_stress", "Pa", REQUIRED, "yield stress at zero plastic strain, rate0 and Tr", "Y0"),
    Parameter("saturation", "Pa", 0.0, "what hardening adds at most, at rate0 and Tr", "Q"),
    Parameter("hardening_rate", "", 10.0, "share of what is left of Q that a unit of plastic strain adds", "b"),
    *logarithmic_rate.PARAMETERS,
    Parameter("thermal_exponent", "", 1.0, "exponent of the homologous temperature", "m", POSITIVE),
    *thermal.PARAMETERS,
)

#: slots of the row; the common ones are SHEAR and YIELD
SATURATION, HARDENING_RATE, RATE, INVERSE_RATE0, LARGEST, THERMAL_EXPONENT, REFERENCE_T, INVERSE_RANGE = range(2, 10)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, its ``rate`` (1/s) and temperature ``T``, Pa: explanation/strength, (18)."""
    Y = par[YIELD] + par[SATURATION] * (1.0 - exp(-par[HARDENING_RATE] * (0.0 if ep < 0.0 else ep)))
    Y *= logarithmic_rate.factor(rate, par[RATE], par[INVERSE_RATE0], par[LARGEST])
    return Y * thermal.softening(T, par[REFERENCE_T], par[INVERSE_RANGE], par[THERMAL_EXPONENT])


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(ROW)
    par[SHEAR], par[YIELD] = given["shear_modulus"], given["yield_stress"]
    par[SATURATION], par[HARDENING_RATE] = given["saturation"], given["hardening_rate"]
    par[RATE], par[INVERSE_RATE0], par[LARGEST] = logarithmic_rate.packed(NAME, given)
    par[THERMAL_EXPONENT] = given["thermal_exponent"]
    par[REFERENCE_T], par[INVERSE_RANGE] = given["reference_temperature"], thermal.inverse_range(NAME, given)
    return par
