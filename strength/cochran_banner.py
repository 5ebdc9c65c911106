"""Cochran-Banner damage: cracks open where the tension reaches the fracture pressure, and bear less the wider they open."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import point
from strength.layout import CRACKS, DAMAGE_ROW

NAME = "cochran-banner"
ID = 3
THERMAL = False
EQUATION = "p >= -pf (1 - D^(2/3)),  D = volume of the cracks per area of the crack / opening;  fractured at D = 1"
SOURCE = (
    "Cochran & Banner, J. Appl. Phys. 48 (1977) 2729, recalled; the sum over the neighbouring cells and the closing of cracks "
    "without pressure are ours"
)
VALIDITY = (
    "spall of metals; independent of the rate of tension; needs a fracture pressure and an equation of state without "
    "internal variables"
)
PARAMETERS = (
    Parameter("opening", "m", REQUIRED, "volume of cracks per crack area at which they bear no tension", "D0", POSITIVE),
)

#: slot of the row
OPENING = 0


@point
def damage_increment(dep, rate, T, p, seq, par):
    """Zero: plastic strain opens no cracks."""
    return 0.0


@point
def tension_left(damage, par):
    """Share of the fracture pressure that cracked material bears: explanation/fracture, (10)."""
    return max(1.0 - damage ** (2.0 / 3.0), 0.0)


@point
def full_opening(par):
    """Volume of cracks per crack area at which they bear no tension, m."""
    return par[OPENING]


def criterion(par) -> int:
    """What material that it has broken failed by: CRACKS."""
    return CRACKS


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[DAMAGE_ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(DAMAGE_ROW)
    par[OPENING] = given["opening"]
    return par
