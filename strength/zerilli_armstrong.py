"""Zerilli-Armstrong flow stress of body-centred cubic metals: a thermally activated stress plus a hardening stress."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import exp, log, point, power
from strength.layout import ROW, SHEAR, YIELD

NAME = "zerilli-armstrong"
ID = 6
CONSTANT_MODULUS = True
THERMAL = True
EQUATION = """\
Y = C0 + C1 exp(-C3 T + C4 T ln rate) + C5 ep^n,  rate not below rate_min, the exponent not above 0
Y = 0 from Tm on,  G constant"""
SOURCE = "Zerilli & Armstrong, J. Appl. Phys. 61 (1987) 1816, eq. for body-centred cubic metals"
VALIDITY = "body-centred cubic metals (iron, tantalum, tungsten); hardening does not depend on temperature"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("athermal_stress", "Pa", 0.0, "stress without thermal part, of solutes and grain boundaries", "C0"),
    Parameter("thermal_stress", "Pa", REQUIRED, "thermal stress at absolute zero", "C1"),
    Parameter("thermal_softening", "1/K", REQUIRED, "decrease of its logarithm per temperature", "C3"),
    Parameter("rate_hardening", "1/K", 0.0, "increase of its logarithm per temperature and e-fold of strain rate", "C4"),
    Parameter("hardening", "Pa", 0.0, "strain hardening", "C5"),
    Parameter("hardening_exponent", "", 1.0, "exponent of the plastic strain", "n", POSITIVE),
    Parameter("lowest_rate", "1/s", 1e-3, "strain rate below which the rate does not matter", "rate_min", POSITIVE),
    Parameter("yield_temperature", "K", 298.0, "temperature at which the yield stress is quoted", "T0", POSITIVE),
    Parameter("melt_temperature", "K", math.inf, "temperature from which on there is no strength", "Tm", POSITIVE),
)

#: slots of the row; the common ones are SHEAR and YIELD
ATHERMAL, THERMAL_STRESS, SOFTENING, RATE, HARDENING, EXPONENT, LOWEST_RATE, MELT = range(2, 10)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, its ``rate`` (1/s) and temperature ``T``, Pa: explanation/strength, (13)."""
    lowest = par[LOWEST_RATE]
    softening = par[SOFTENING] - par[RATE] * log(lowest if rate < lowest else rate)
    exponent = -softening * T
    Y = par[ATHERMAL] + par[THERMAL_STRESS] * exp(0.0 if exponent > 0.0 else exponent)
    Y += par[HARDENING] * power(0.0 if ep < 0.0 else ep, par[EXPONENT])
    return 0.0 if T >= par[MELT] else Y


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(ROW)
    par[SHEAR], par[ATHERMAL], par[THERMAL_STRESS] = given["shear_modulus"], given["athermal_stress"], given["thermal_stress"]
    par[SOFTENING], par[RATE] = given["thermal_softening"], given["rate_hardening"]
    par[HARDENING], par[EXPONENT] = given["hardening"], given["hardening_exponent"]
    par[LOWEST_RATE], par[MELT] = given["lowest_rate"], given["melt_temperature"]
    par[YIELD] = flow_stress(0.0, 0.0, given["yield_temperature"], 0.0, 0.0, par)
    return par
