"""Elastic-plastic: perfectly plastic, or with linear hardening, an upper bound and linear softening up to melt."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point
from strength import thermal
from strength.layout import ROW, SHEAR, YIELD

NAME = "elastic-plastic"
ID = 1
CONSTANT_MODULUS = True
THERMAL = True
EQUATION = "Y = min(Y0 + H ep, Ymax) (1 - T*),  T* = (T - Tr)/(Tm - Tr) in [0, 1],  G constant"
SOURCE = "textbook; the linear softening is that of Johnson & Cook with an exponent of 1"
VALIDITY = "rate-independent; by default perfectly plastic and independent of temperature"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("yield_stress", "Pa", REQUIRED, "initial yield stress in tension", "Y0"),
    Parameter("hardening_modulus", "Pa", 0.0, "dY/d(plastic strain)", "H"),
    Parameter("max_yield_stress", "Pa", math.inf, "upper bound of the hardened yield stress", "Ymax", POSITIVE),
    *thermal.PARAMETERS,
)

#: slots of the row; the common ones are SHEAR and YIELD
HARDENING, LARGEST, REFERENCE_T, INVERSE_RANGE = range(2, 6)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Yield stress at plastic strain ``ep`` and temperature ``T``, Pa: explanation/strength, (10)."""
    softening = 1.0 - thermal.homologous_temperature(T, par[REFERENCE_T], par[INVERSE_RANGE])
    hardened, largest = par[YIELD] + par[HARDENING] * ep, par[LARGEST]
    return (largest if hardened > largest else hardened) * softening


@point
def yield_floor(par):
    """The initial yield stress, unless it softens."""
    return par[YIELD] if par[INVERSE_RANGE] == 0.0 and par[HARDENING] >= 0.0 else 0.0


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    if given["max_yield_stress"] < given["yield_stress"]:
        raise ValueError(f"{NAME}: max_yield_stress is below yield_stress")
    par = np.zeros(ROW)
    par[SHEAR], par[YIELD] = given["shear_modulus"], given["yield_stress"]
    par[HARDENING], par[LARGEST] = given["hardening_modulus"], given["max_yield_stress"]
    par[REFERENCE_T], par[INVERSE_RANGE] = given["reference_temperature"], thermal.inverse_range(NAME, given)
    return par
