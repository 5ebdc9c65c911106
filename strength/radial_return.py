"""Radial return of the deviator to the yield surface (Wilkins 1964), with hardening and rate solved implicitly.

`plastic_increment` solves one cell, `return_together` up to `LANES` cells at once. Both take the same steps, `next_trial`, so
that a cell's answer depends neither on which of them solves it nor on the cells solved with it.
"""

from __future__ import annotations

import math

from hydro2d.jit import exp, log, point, rowwise
from strength.dispatch import flow_row, flow_stress, weakened
from strength.lanes import (
    BEFORE,
    FLOW,
    HARDENED,
    HIGH,
    INCREMENT,
    LOGARITHM,
    LOW,
    RATE,
    RESIDUAL,
    STIFFNESS,
    STRAIN,
    STRESS,
    TRIAL,
)

#: tolerance on the stress as a share of the trial, and the most iterations; only roots at a kink of Y come near that number
_TOLERANCE, _ITERATIONS = 1e-10, 60

#: logarithm of the largest plastic increment over a negligible one: a third of what the tolerance allows
_SPAN = 1.0 - math.log(_TOLERANCE)

#: a trial whose residual does not shrink to this share is followed by a bisection
_PROGRESS = 0.7

#: a first rise of the flow stress beyond this share of the elastic stress is attributed to the rate
_RATE_SHARE = 0.1


@point
def first_trial(seq, stiffness, Y):
    """(whether the step is plastic, x, ln x, ln of the largest x): the root x for a constant flow stress ``Y`` is tried first.

    A NaN counts as plastic, and ends as NaN; with ``stiffness`` = 3 G = 0 no step is plastic.
    """
    excess = seq - Y
    x = (seq if excess > seq else excess) / stiffness
    return stiffness > 0.0 and not excess <= 0.0, x, log(x), log(seq / stiffness)


@point
def next_trial(first, seq, stiffness, x, u, Y, low, high, u_before, Y_before, before, log_dt):
    """(ended, dep, stress, next u, low, high, size of the residual) from the flow stress ``Y`` at the trial ``x``.

    u = ln x; ``low`` and ``high`` bracket its root, ``before`` is the size of the previous residual, Pa. Where ``ended``, dep
    and stress are the answer of `plastic_increment`, NaN where the residual is one.

    After the ``first`` trial, Y is taken to be linear in x from its value at x = 0 where it rose little, and linear in the
    logarithm of the rate, from 1/s on, where it rose much. From then on the last two points give a Y linear in u: hardening
    like x^n and rates like ln x are singular at x = 0, and x may be 1e-17. The next trial is a Newton step of this f in x or
    in u, whichever part of f is the steeper. A trial outside the bracket, and one after too little progress, is replaced by
    the middle of the bracket.
    """
    tolerance = _TOLERANCE * seq
    elastic = stiffness * x
    f = seq - elastic - Y
    size = abs(f)
    low = u if f > 0.0 else low
    high = high if f > 0.0 else u
    solved = size <= tolerance
    lost = f != f
    ended = solved or lost or 2.0 * elastic * (high - low) <= tolerance
    rise = Y - Y_before
    little = first and rise < _RATE_SHARE * elastic
    log_rate = u - log_dt
    width = (1.0 if little or log_rate < 1.0 else log_rate) if first else u - u_before
    slope = rise / width
    both = elastic + slope
    straight = little or (slope <= elastic and not first)
    # for a step in x, ln(1 + f/both) by the Pade approximant s (6 + s)/(6 + 4 s)
    trial = u + (f * (6.0 * both + f) if straight else f) / (both * (6.0 * both + 4.0 * f) if straight else both)
    good = low < trial and trial < high and size <= _PROGRESS * before
    stress = Y if solved else seq - elastic
    return (ended, f if lost else x, f if lost else stress, trial if good else 0.5 * (low + high), low, high,
            size if good else math.inf)


@point
def plastic_increment(model, seq, ep, dt, T, p, rho, G, factor, par, damage):
    """(dep, Y): increment of plastic strain over ``dt``, and the flow stress it ends on, Pa.

    ``seq`` von Mises stress of the elastic trial, ``ep`` plastic strain, ``T``, ``p`` and ``rho`` temperature, pressure
    and density, ``G`` shear modulus, ``factor`` multiplies every flow stress, ``par`` row of the strength model
    ``model``, ``damage`` the damage, for a model that it weakens.

    Where seq <= Y(ep, rate 0) the step is elastic and Y that flow stress. Otherwise x = dep >= 0 solves
    (explanation/strength, (4))

        f(x) = seq - 3 G x - factor Y(ep + x, x/dt) = 0,    f(0) > 0 >= f(seq/(3 G)),

    and the deviator is to be scaled by Y/seq: molten (Y = 0), it vanishes and dep = seq/(3 G). Without a shear modulus
    the answer is (0, 0). A NaN in any value that the answer depends on makes both NaN.
    """
    if not G > 0.0:
        return 0.0, 0.0
    stiffness, per_dt, log_dt = 3.0 * G, 1.0 / dt, log(dt)
    Y_before = factor * weakened(model, flow_stress(model, ep, 0.0, T, p, rho, par), 0.0, p, damage, par)
    plastic, x, u, high = first_trial(seq, stiffness, Y_before)
    if not plastic:
        return 0.0, Y_before
    low, u_before, before, first = high - _SPAN, u, math.inf, True
    for _ in range(_ITERATIONS):
        intact = flow_stress(model, ep + x, x * per_dt, T, p, rho, par)
        Y = factor * weakened(model, intact, x * per_dt, p, damage, par)
        ended, dep, stress, trial, low, high, before = next_trial(
            first, seq, stiffness, x, u, Y, low, high, u_before, Y_before, before, log_dt)
        if ended:
            return dep, stress
        u_before, Y_before, u, x, first = u, Y, trial, exp(trial), False
    return x, seq - stiffness * x


@rowwise
def return_together(model, number, dt, factor, par, lanes):
    """`plastic_increment` of the first ``number`` cells in ``lanes``, a multiple of `WIDTH` (strength/lanes.py).

    Reads    lanes, TRIAL to STIFFNESS
    Writes   lanes, INCREMENT: dep, and STRESS: the flow stress it ends on, Pa
    Scratch  lanes, the rest
    """
    per_dt, log_dt = 1.0 / dt, log(dt)
    for k in range(number):
        lanes[HARDENED + k] = lanes[STRAIN + k]
        lanes[RATE + k] = 0.0
    flow_row(model, number, par, lanes)
    left = 0
    for k in range(number):
        stiffness = lanes[STIFFNESS + k]
        Y = factor * lanes[FLOW + k]
        plastic, x, u, high = first_trial(lanes[TRIAL + k], stiffness, Y)
        increment = x if plastic else 0.0
        lanes[INCREMENT + k] = increment
        lanes[STRESS + k] = Y if stiffness > 0.0 else 0.0
        lanes[LOGARITHM + k] = u
        lanes[BEFORE + k] = u
        lanes[LOW + k] = high - _SPAN
        lanes[HIGH + k] = high
        lanes[RESIDUAL + k] = math.inf if plastic else -1.0
        lanes[HARDENED + k] = lanes[STRAIN + k] + increment
        lanes[RATE + k] = increment * per_dt
        left += 1 if plastic else 0
    turn = 0
    while left > 0 and turn < _ITERATIONS:
        flow_row(model, number, par, lanes)
        left = 0
        for k in range(number):
            x = lanes[INCREMENT + k]
            u = lanes[LOGARITHM + k]
            before = lanes[RESIDUAL + k]
            Y = factor * lanes[FLOW + k]
            Y_before = lanes[STRESS + k]
            ended, dep, stress, trial, low, high, size = next_trial(
                turn == 0, lanes[TRIAL + k], lanes[STIFFNESS + k], x, u, Y, lanes[LOW + k], lanes[HIGH + k],
                lanes[BEFORE + k], Y_before, before, log_dt)
            sought = before >= 0.0
            goes_on = sought and not ended
            increment = exp(trial) if goes_on else (dep if sought else x)
            lanes[INCREMENT + k] = increment
            lanes[STRESS + k] = Y if goes_on else (stress if sought else Y_before)
            lanes[LOGARITHM + k] = trial
            lanes[BEFORE + k] = u
            lanes[LOW + k] = low
            lanes[HIGH + k] = high
            lanes[RESIDUAL + k] = size if goes_on else -1.0
            lanes[HARDENED + k] = lanes[STRAIN + k] + increment
            lanes[RATE + k] = increment * per_dt
            left += 1 if goes_on else 0
        turn += 1
    if left > 0:
        for k in range(number):
            elastic = lanes[STIFFNESS + k] * lanes[INCREMENT + k]
            lanes[STRESS + k] = lanes[TRIAL + k] - elastic if lanes[RESIDUAL + k] >= 0.0 else lanes[STRESS + k]
