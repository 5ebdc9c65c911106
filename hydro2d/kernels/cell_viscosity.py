"""Artificial viscosity of a cell by the coefficients of the deck, and its bound of the time step. No model is chosen here."""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.viscosity import directional_viscosity, linear_in_step, shut
from hydro2d.physics.waves import sound_step


@point
def viscosity(rho, bulk, cl, solid, jump, length, psi, w):
    """Artificial viscosity of a cell, Pa, against a difference of velocity over a length, m/s: a jump < 0 where it compresses.

    rho, bulk, cl, solid : of the cell;  psi : 1 where velocity is smooth (explanation/lagrangian-step, equation 11)
    """
    c = bulk / rho
    c = sqrt(c) if c > 0.0 else cl
    linear = linear_in_step(w.viscosity_linear, w.dt * cl / length)
    return shut(solid) * directional_viscosity(rho, c, jump, psi, linear, w.viscosity_quadratic)


@point
def limit_of_sound(j, i, rho, q, w):
    """Bound of the time step by sound in cell (j, i) with density rho and viscosity q, s (`sound_step`)."""
    return sound_step(w.courant, w.shock_courant, min(w.dr[i], w.dz[j]), w.viscosity_linear, w.viscosity_quadratic, rho,
                      w.cl[j, i], q)
