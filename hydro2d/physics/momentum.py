"""Fluxes across the faces of dual cells in a sweep, and the velocities of vertices after it (explanation/remap).

A vertex has mass M, momentum P = M u and, for each component, the kinetic energy K = M u^2/2. No velocity conserves both P and
K; the three choices of the deck's `advection` differ in which of them they keep.
"""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.advection import TINY, upwind
from hydro2d.physics.traction import smoothstep

#: mass of a vertex, over the largest next to it, below which its velocity shapes no slope
SLIGHT = 1e-4


@point
def corner_sum(share_inner, share_outer, outer_of_left, other_of_left, inner_of_right, other_of_right):
    """Sum of the corner shares of the four cells around a point: of their masses, or of the masses that cross their faces, kg.

    share_outer : share of a corner on the outer side of a cell, which the two cells to the left of the point give. The mass
    fluxes of cells give those of dual cells by the same sum, so that dual masses stay corner sums (equation 6).
    """
    return share_outer * (outer_of_left + other_of_left) + share_inner * (inner_of_right + other_of_right)


@point
def corner_mean(share_inner, share_outer, inner_low, inner_high, outer_low, outer_high):
    """Mean of a quantity over a cell from its four vertices by the corner shares, the transpose of `corner_sum`.

    A cell that gets the mean of an energy per mass of vertices gets what they lose, since their masses are corner sums.
    """
    return share_inner * (inner_low + inner_high) + share_outer * (outer_low + outer_high)


@point
def slope_weight(mass, m_ll, m_l, m_r, m_rr):
    """Half of the share of the donor that stays while ``mass`` leaves it: the factor on the limited slope.

    mass : crosses the dual face between vertices l and r, kg;  m_ll to m_rr : masses of four vertices in line, kg. The weight
    falls to 0 where the donor or a vertex next to it has almost no mass, since its velocity is then meaningless.
    """
    up = mass > 0.0
    whole = max(m_l if up else m_r, TINY)
    behind = m_ll if up else m_rr
    least, most = min(behind, min(m_l, m_r)), max(behind, max(m_l, m_r))
    there = smoothstep(least / (SLIGHT * max(most, TINY)))
    return 0.5 * there * (1.0 - min(abs(mass) / whole, 1.0))


@point
def carried(mass, weight, ll, l, r, rr, steepness):
    """Flux across the dual face between l and r of a quantity per mass, given at four vertices in line (equation 4)."""
    donor, slope = upwind(mass > 0.0, ll, l, r, rr, steepness)
    return mass * (donor + weight * slope)


@point
def velocity_of_momentum(momentum, over, here, low, high):
    """u = P/M (equation 7), kept within the velocities before the sweep of the vertex and of its two neighbours, m/s.

    over : 1/M, 1/kg. The bound removes round-off; at an open edge, where a vertex has half a cell's mass, it also makes up for
    the other half when the whole cell leaves.
    """
    return min(max(momentum * over, min(here, min(low, high))), max(here, max(low, high)))


@point
def velocity_of_energy(kinetic, over, most, mean):
    """u = sign(P) sqrt(2 K/M), |u| <= beta |P/M| (equation 8), m/s.

    kinetic : K, J;  over : 1/M, 1/kg;  most : beta;  mean : P/M, m/s
    """
    speed = min(sqrt(2.0 * kinetic * over), most * abs(mean))
    return speed if mean > 0.0 else -speed


@point
def energy_missing(kinetic, mass, velocity):
    """K - M u^2/2, J: the kinetic energy of a vertex that its velocity does not account for (equation 9)."""
    return kinetic - 0.5 * mass * velocity * velocity
