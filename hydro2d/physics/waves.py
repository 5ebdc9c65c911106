"""Waves in a cell: the time step that they allow, and the impedances of a transmitting edge."""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.traction import smoothstep

#: causes of the time step, in the order of `step_limits` in `hydro2d.kernels.thermodynamics`
CAUSES = ("sound", "radial velocity", "axial velocity", "volume change")
#: share of the largest stable step that no deck may exceed
STABLE = 0.9
#: viscosity, over rho c_l^2, from which a cell is in a shock
SHOCKED = 1e-3


@point
def damping_speed(linear, quadratic, rho, cl, q):
    """Half of dq/d(du) over the density, m/s: the part of the viscosity q (Pa) in the wave speed of the largest stable step.

    q = rho (quadratic du^2 + linear c du) has the derivative rho sqrt((linear c)^2 + 4 quadratic q/rho). Half, since of the two
    cells next to a swinging vertex only the compressed one has a viscosity (explanation/lagrangian-step).
    """
    return sqrt(0.25 * linear * linear * cl * cl + quadratic * q / rho)


@point
def share_crossed(courant, shock_courant, rho, cl, q):
    """Share of a cell that sound may cross in a step: `courant` without viscosity, `shock_courant`, if that is less, in a
    shock, and continuous between (explanation/lagrangian-step, equation 15b)."""
    return courant - max(courant - shock_courant, 0.0) * smoothstep(q / (SHOCKED * rho * cl * cl))


@point
def sound_step(courant, shock_courant, length, linear, quadratic, rho, cl, q):
    """Time step in which sound, or a shock with the viscosity q (Pa), crosses the permitted share of a length, s; at most
    STABLE times the largest stable step."""
    damping = damping_speed(linear, quadratic, rho, cl, q)
    largest = length / (damping + sqrt(cl * cl + damping * damping))
    share = share_crossed(courant, shock_courant, rho, cl, q)
    return min(share * length / sqrt(cl * cl + 2.0 * q / rho), STABLE * largest)


@point
def crossing_step(advective, length, a, b, c, d):
    """Time step in which the fastest of four vertices, m/s, crosses the permitted share `advective` of a length, s."""
    return advective * length / max(max(abs(a), abs(b)), max(abs(c), abs(d)))


@point
def volume_step(loss):
    """Time step in which a cell loses a fifth of its volume, s; loss : the rate, 1/s."""
    return 0.2 / loss if loss > 0.0 else 1e300


@point
def impedances(j, i, rhobar, cl, bulk):
    """rho c of longitudinal and of shear waves in cell (j, i), Pa s/m; a cell with void passes on no shear.

    rho c_l^2 = K + 4 G/3 gives the shear modulus, rho c_s^2 = G.
    """
    rho = rhobar[j, i]
    stiffness = rho * cl[j, i] * cl[j, i]
    shear = max(0.75 * (stiffness - bulk[j, i]), 0.0) if bulk[j, i] > 0.0 else 0.0
    return sqrt(rho * stiffness), sqrt(rho * shear)
