"""Cracked material: the equation of state of a body whose damage model opens cracks, over that of the sound solid.

The internal variable is w, the volume of the cracks per mass. The rest of the volume is solid, and the pressure is that of
the solid. At constant w the pressure is therefore the derivative of the energy with respect to the volume:

    1/rho = 1/rho_s + w,    p = p_s(rho_s, e).

No deck names this model: a material gets it if its damage model opens cracks (`materials.cracking`).
"""

from __future__ import annotations

import numpy as np

from eos import solid
from eos.layout import E0, RHO0, SOLID_AT
from hydro2d.jit import late_bound, point
from hydro2d.mesh.fields import Field

NAME = "cracked"
ID = 7
INTERNAL = (
    Field("crack_volume", "", "body", "m^3/kg", 1, "mass", True, "volume of the cracks per mass", 0.0),
    Field("crack_growth", "", "body", "1", 1, "mass", False, "1 where cracks have opened in the last step, else 0", 0.0, 1.0),
)

#: the variables
CRACKS, GROWTH = 0, 1
#: slot of the row in addition to RHO0 and E0; the row of the solid begins at SOLID_AT
SOLID_MODEL = 2

#: the solid fills at least this share of cracked material: the remap may leave w a little above 1/rho
LEAST_SHARE = 0.1
#: relative tolerance of Newton's method for the density of the solid, and its largest number of steps
_TOLERANCE, _ITERATIONS = 1e-13, 40


@point
def solid_share(rho, cracks):
    """Share rho/rho_s of the volume that the solid fills: 1 - w rho."""
    return max(1.0 - cracks * rho, LEAST_SHARE)


@point
def density_of_solid(rho, internal, par):
    """Density of the solid, kg/m^3, at density ``rho`` and these internal variables."""
    return rho / solid_share(rho, internal[CRACKS])


@late_bound
def evaluate(rho, e, internal, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` > 0 and specific energy ``e``; SI.

    The crack volume is constant, except where cracks grow: there they take up any small change of volume, and dp/drho is zero.
    A step predicts the pressure at its middle from this modulus. explanation/fracture, (8)
    """
    share = solid_share(rho, internal[CRACKS])
    p, dpdrho, dpde, T = solid.evaluate(int(par[SOLID_MODEL]), rho / share, e, par[SOLID_AT:])
    return p, dpdrho / (share * share) if internal[GROWTH] < 0.5 else 0.0, dpde, T


@late_bound
def density_at(p, rho_s, e, par):
    """Density of the solid at the pressure ``p``, Pa, and energy ``e``, by Newton's method from ``rho_s``; kg/m^3."""
    model, own = int(par[SOLID_MODEL]), par[SOLID_AT:]
    for _ in range(_ITERATIONS):
        pressure, slope, dpde, T = solid.evaluate(model, rho_s, e, own)
        if not slope > 0.0:
            break
        step = (p - pressure) / slope
        rho_s = min(max(rho_s + step, 0.5 * rho_s), 2.0 * rho_s)
        if abs(step) <= _TOLERANCE * rho_s:
            break
    return rho_s


@late_bound
def opened(rho, e, limit, cracks, par):
    """The crack volume w, m^3/kg, at which the tension is no more than ``limit``, Pa: explanation/fracture, (9)."""
    rho_s = rho / solid_share(rho, cracks)
    p = solid.evaluate(int(par[SOLID_MODEL]), rho_s, e, par[SOLID_AT:])[0]
    if not p < -limit:
        return cracks
    return max(1.0 / rho - 1.0 / density_at(-limit, rho_s, e, par), cracks)


@late_bound
def update(rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal):
    """Closes cracks under pressure until the pressure or the cracks are gone: cracks bear none. explanation/fracture, (9)"""
    cracks = internal[CRACKS]
    if cracks <= 0.0:
        return
    rho_s = rho / solid_share(rho, cracks)
    if solid.evaluate(int(par[SOLID_MODEL]), rho_s, e, par[SOLID_AT:])[0] > 0.0:
        internal[CRACKS] = min(max(1.0 / rho - 1.0 / density_at(0.0, rho_s, e, par), 0.0), cracks)


def row(model: int, of_solid: np.ndarray) -> np.ndarray:
    """The row of cracked material from the ID and the row of its solid."""
    par = np.zeros(SOLID_AT + of_solid.size)
    par[RHO0], par[E0], par[SOLID_MODEL] = of_solid[RHO0], of_solid[E0], model
    par[SOLID_AT:] = of_solid
    return par
