"""Radial return of the deviator to the yield surface (Wilkins 1964), with hardening and rate solved implicitly."""

from __future__ import annotations

from hydro2d.jit import point
from strength.dispatch import flow_stress

_ITERATIONS = 40
_TOLERANCE = 1e-10


@point
def plastic_increment(model, seq, ep, dt, T, p, rho, G, factor, par):
    """(dep, Y): increment of plastic strain over ``dt``, and the flow stress it ends on, Pa.

    ``seq`` von Mises stress of the elastic trial, ``ep`` plastic strain, ``T``, ``p`` and ``rho`` temperature, pressure
    and density, ``G`` shear modulus, ``factor`` multiplies every flow stress, ``par`` row of the strength model
    ``model``.

    Where seq <= Y(ep, rate 0) the step is elastic and Y that flow stress. Otherwise x = dep >= 0 solves

        f(x) = seq - 3 G x - factor Y(ep + x, x/dt) = 0,    f(0) > 0 >= f(seq/(3 G)),

    and the deviator is to be scaled by Y/seq: molten (Y = 0), it vanishes and dep = seq/(3 G). Without a shear modulus
    the answer is (0, 0).

    The first trial is exact for a constant Y. Then come secants, kept inside a bracket; a trial that leaves it, or that
    shrinks it too little, is replaced by a section, close to zero as long as no x > 0 is known to be below the root:
    hardening like ep^n may be so steep at the start that dep is 1e-17. Solved to 1e-10 of ``seq`` in stress.
    """
    if not G > 0.0:
        return 0.0, 0.0
    Y = factor * flow_stress(model, ep, 0.0, T, p, rho, par)
    excess = seq - Y
    if excess <= 0.0:
        return 0.0, Y
    stiffness = 3.0 * G
    tolerance = _TOLERANCE * seq
    low, high = 0.0, seq / stiffness
    before, f_before = 0.0, excess
    x = min(excess / stiffness, high)
    for _ in range(_ITERATIONS):
        Y = factor * flow_stress(model, ep + x, x / dt, T, p, rho, par)
        f = seq - stiffness * x - Y
        if abs(f) <= tolerance:
            return x, Y
        width = high - low
        if f > 0.0:
            low = x
        else:
            high = x
        if stiffness * (high - low) <= tolerance:
            break
        trial = x - f * (x - before) / (f - f_before)
        before, f_before = x, f
        if high - low > 0.5 * width or not (low < trial and trial < high):
            trial = 0.5 * (low + high) if low > 0.0 else 0.1 * high
        x = trial
    return x, seq - stiffness * x
