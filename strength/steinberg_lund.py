"""Steinberg-Lund: the law of Steinberg and Guinan with a thermally activated stress added, which depends on the rate.

The activated stress y YP solves 1/rate = J(y) + C2/(YP y), J = exp((2 Uk/(k T)) (1 - y)^2)/C1: the time that a dislocation
waits at a barrier plus the time that it is dragged. Each of the two alone gives a y that is too small, and so does the tangent
of J, which is convex, in place of J: then y is the root of a quadratic equation, from which the next tangent is taken. The
number of steps is fixed and nothing branches, so that rows of cells are evaluated together.
"""

from __future__ import annotations

import math

import numpy as np

from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import exp, log, point
from strength import steinberg_guinan

NAME = "steinberg-lund"
ID = 9
CONSTANT_MODULUS = False
THERMAL = True
EQUATION = """\
Y = [YT(rate, T) + min(YA (1 + beta (ep + ep0))^n, Ymax)] G/G0,  YT not above YP
rate = 1/[exp((2 Uk/kT) (1 - YT/YP)^2)/C1 + C2/YT];  G and melting as in steinberg-guinan"""
SOURCE = "Steinberg & Lund, J. Appl. Phys. 65 (1989) 1528"
VALIDITY = "body-centred cubic metals from 1e-4 to 1e6/s; YT is 0 at rates below 1e-12/s; without Tm0 nothing melts"
PARAMETERS = (
    *steinberg_guinan.PARAMETERS,
    Parameter("peierls_stress", "Pa", REQUIRED, "Peierls stress, upper bound of the activated stress", "YP"),
    Parameter("activation_energy", "J", REQUIRED, "energy of a pair of kinks in a dislocation", "Uk", POSITIVE),
    Parameter("attempt_rate", "1/s", REQUIRED, "strain rate at the stress YP without drag", "C1", POSITIVE),
    Parameter("drag", "Pa*s", REQUIRED, "activated stress over strain rate where dislocations are dragged", "C2", POSITIVE),
)

#: further slots of a row of steinberg-guinan; KINK is 2 Uk/k, K, and DRAG is C2/YP, s
PEIERLS, KINK, ATTEMPT, DRAG = range(13, 17)
#: rate below which the activated stress is 0, 1/s; temperature that counts for lower ones, K; number of tangents
SLOWEST, COLDEST, STEPS = 1e-12, 1.0, 7
#: Boltzmann's constant, J/K
BOLTZMANN = 1.380649e-23


@point
def activated(rate, T, par):
    """Activated stress over the Peierls stress at strain ``rate`` (1/s) and temperature ``T``: explanation/strength, (20)."""
    kink = par[KINK] / (COLDEST if T < COLDEST else T)
    per_attempt = 1.0 / par[ATTEMPT]
    drag = par[DRAG]
    wait = 1.0 / (SLOWEST if rate < SLOWEST else rate)
    barrier = log(wait * par[ATTEMPT])
    from_barrier = 1.0 - math.sqrt((0.0 if barrier < 0.0 else barrier) / kink)
    from_drag = drag / wait
    y = from_drag if from_drag > from_barrier else from_barrier
    for _ in range(STEPS):
        gap = 1.0 - y
        jump = per_attempt * exp(kink * gap * gap)
        slope = 2.0 * kink * gap * jump
        b = wait - jump - slope * y
        root = math.sqrt(b * b + 4.0 * slope * drag)
        y = 2.0 * drag / (b + root) if b > 0.0 else (root - b) / (2.0 * slope)
    largest = wait <= per_attempt + drag  # dislocations are faster at YP than asked
    return 0.0 if rate < SLOWEST else (1.0 if largest else y)


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus at pressure ``p``, density ``rho`` and temperature ``T``, Pa."""
    return steinberg_guinan.shear_modulus(p, rho, T, par)


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress at plastic strain ``ep``, its ``rate`` (1/s), temperature ``T``, pressure ``p`` and density ``rho``, Pa.

    explanation/strength, (19)
    """
    return (steinberg_guinan.flow_stress(ep, rate, T, p, rho, par)
            + par[PEIERLS] * activated(rate, T, par) * steinberg_guinan.relative_modulus(p, rho, T, par))


def row(values) -> np.ndarray:
    """Packs the parameters, by name; float64[ROW]. Raises ValueError for a missing, unknown or impossible value."""
    given = collect(NAME, PARAMETERS, values)
    par = steinberg_guinan.row({parameter.name: given[parameter.name] for parameter in steinberg_guinan.PARAMETERS})
    par[PEIERLS], par[KINK] = given["peierls_stress"], 2.0 * given["activation_energy"] / BOLTZMANN
    par[ATTEMPT], par[DRAG] = given["attempt_rate"], given["drag"] / (given["peierls_stress"] or 1.0)
    return par
