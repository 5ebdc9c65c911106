"""Radial return of the deviator to the yield surface (Wilkins 1964), with hardening and rate solved implicitly."""

from __future__ import annotations

import math

from hydro2d.jit import point
from strength.dispatch import flow_stress

#: the stress is solved to this share of the trial; the iterations end far earlier but for roots at a kink of Y
_TOLERANCE, _ITERATIONS = 1e-10, 60

#: a residual that does not shrink to this share is answered with a bisection
_PROGRESS = 0.7


@point
def plastic_increment(model, seq, ep, dt, T, p, rho, G, factor, par):
    """(dep, Y): increment of plastic strain over ``dt``, and the flow stress it ends on, Pa.

    ``seq`` von Mises stress of the elastic trial, ``ep`` plastic strain, ``T``, ``p`` and ``rho`` temperature, pressure
    and density, ``G`` shear modulus, ``factor`` multiplies every flow stress, ``par`` row of the strength model
    ``model``.

    Where seq <= Y(ep, rate 0) the step is elastic and Y that flow stress. Otherwise x = dep >= 0 solves
    (explanation/strength, (4))

        f(x) = seq - 3 G x - factor Y(ep + x, x/dt) = 0,    f(0) > 0 >= f(seq/(3 G)),

    and the deviator is to be scaled by Y/seq: molten (Y = 0), it vanishes and dep = seq/(3 G). Without a shear modulus
    the answer is (0, 0).

    The first trial is the root for a constant Y, the second for a Y linear in x. From then on the last two points give
    a Y linear in ln x: hardening like x^n and rates like ln x are singular at x = 0, and x may be 1e-17. The next trial
    is a Newton step of this f in x or in ln x, whichever part of f is the steeper. A trial outside the bracket, and one
    after too little progress, is replaced by the bracket's geometric mean.
    """
    if not G > 0.0:
        return 0.0, 0.0
    Y = factor * flow_stress(model, ep, 0.0, T, p, rho, par)
    excess = seq - Y
    if excess <= 0.0:
        return 0.0, Y
    stiffness = 3.0 * G
    tolerance = _TOLERANCE * seq
    least = tolerance / stiffness
    low, high = 0.0, seq / stiffness
    x_before, Y_before, f_before = 0.0, Y, math.inf
    x = min(excess / stiffness, high)
    for _ in range(_ITERATIONS):
        Y = factor * flow_stress(model, ep + x, x / dt, T, p, rho, par)
        elastic = stiffness * x
        f = seq - elastic - Y
        if abs(f) <= tolerance:
            return x, Y
        if f > 0.0:
            low = x
        else:
            high = x
        if high - low <= least:
            return x, seq - elastic
        if x_before == 0.0:
            trial = x * (1.0 + f / (elastic + (Y - Y_before)))
        else:
            logarithmic = (Y - Y_before) / math.log(x / x_before)
            step = f / (elastic + logarithmic)
            trial = x * (math.exp(step) if logarithmic > elastic else 1.0 + step)
        x_before, Y_before = x, Y
        if low < trial and trial < high and abs(f) <= _PROGRESS * f_before:
            f_before = abs(f)
        else:
            trial = math.sqrt(max(low, least) * high)
            f_before = math.inf
        x = max(trial, least)
    return x, seq - stiffness * x
