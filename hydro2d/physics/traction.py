"""Cells cut by a surface: the bodies in the cell have the traction across the surface in common, not the pressure.

Across the surface of a body the normal stress is continuous: n . sigma . n = -p_c for every body of the cell, with p_c = 0
next to void (explanation/mixed-cells, equations 9 to 12). The strain across the surface follows from that and is not
integrated.
"""

from math import log, sqrt

from hydro2d.jit import point

#: kinds of cells, in row KIND of `skin`: not cut; a surface against void; two groups; bodies of one group that fill the cell,
#: none or one of them a gas
WHOLE, FREE_SURFACE, INTERFACE, JOINT, BESIDE_GAS = 0.0, 1.0, 2.0, 3.0, 4.0
#: rows of `skin`
NORMAL_R, NORMAL_Z, KIND = range(3)
#: share of void from which a crack carries no tension
SURE = 1e-3
#: fall of a fraction across a cell from which the normal counts in full
STEEP = 0.1
#: largest relative change of a body's volume in a step by the traction on it
MOST_GROWTH = 0.1
#: share of its volume that a step leaves of a gas however it is compressed
LEAST_LEFT = 1e-4
#: share of a cell up to which a gas is a film, which the solids beside it keep at its temperature
FILM = 0.015
#: share of void from which it closes only in part within half a step; twice as much does not close at all
WIDE = 0.05


@point
def smoothstep(x):
    """Smooth step: 0 up to x = 0, 1 from x = 1 on, and S(x) = x^2 (3 - 2 x) between, with no slope at either end."""
    y = min(max(x, 0.0), 1.0)
    return y * y * (3.0 - 2.0 * y)


@point
def along_normal(n_r, n_z, rr, zz, rz):
    """n . s . n of a deviator, for a normal whose square is the weight of the surface (`surface_weight`)."""
    return n_r * n_r * rr + 2.0 * n_r * n_z * rz + n_z * n_z * zz


@point
def pull_left(void, weight):
    """Share of a tension that a cell of one group with void still carries: all in a closing crack, none at a surface.

    weight is that of the surface in the cell (`surface_weight`); a crack inside a body has none.
    """
    return (1.0 - weight) * (1.0 - smoothstep(void / SURE))


@point
def strained_pressure(p, bulk, strain):
    """p - K e: pressure after a volumetric strain e, Pa (explanation/lagrangian-step, equation 9)."""
    return p - bulk * strain


@point
def half_pressure(p, bulk, strain, void, pull):
    """Pressure of a cut cell after a volumetric strain: void closes first, and the share `pull` of a tension is left.

    p is the bodies' pressure, bulk their modulus (Pa), void its share. The result is continuous in all of them (explanation/
    mixed-cells, equation 9).
    """
    together = strained_pressure(p, bulk, strain)
    if together <= 0.0:
        return pull * together
    return max(together - bulk * void, 0.0) * (1.0 - smoothstep(void / WIDE - 1.0))


@point
def strain_across(p, target, modulus, shear, flow, size, along, beside, weight):
    """(strain of a body across its surface, growth of its volume, decrease of that with target), at normal stress -target.

    p is the body's pressure, modulus its bulk modulus, shear its shear modulus, flow its yield stress (Pa); size is s : s and
    along n . s . n of its deviator, strained along the surface only, beside the trace of that strain; weight is that of the
    surface: at 0 the body is part of a mixture, and its pressure goes to the target. Newton's rule solves
    p - K (beside + e) - w s_nn(e) = target with s returned to the yield surface (explanation/mixed-cells, equation 11).
    """
    free = (p - target) / modulus
    e = (p - weight * along - target - modulus * beside) / (modulus + weight * 4.0 / 3.0 * shear)
    stiffness = modulus
    for _ in range(4):
        x = 2.0 * shear * e
        norm = sqrt(max(1.5 * (size + 2.0 * x * along + 2.0 / 3.0 * x * x), 0.0))
        return_factor = min(1.0, flow / norm) if norm > 0.0 else 1.0
        stress = return_factor * (along + 2.0 / 3.0 * x)
        slope = 2.0 / 3.0
        if return_factor < 1.0:
            slope = max(return_factor * (2.0 / 3.0 - 1.5 * (stress / flow) ** 2), 0.0) if flow > 0.0 else 0.0
        stiffness = modulus + weight * 2.0 * shear * slope
        e += (p - modulus * (beside + e) - weight * stress - target) / stiffness
    e = min(max(e, -MOST_GROWTH - beside), MOST_GROWTH - beside)
    grown = weight * (beside + e) + (1.0 - weight) * min(max(free, -MOST_GROWTH), MOST_GROWTH)
    return e, grown, weight / stiffness + (1.0 - weight) / modulus


@point
def film_heat(share):
    """Part of the heat of its compression that a gas keeps, by its share of the cell: none in a FILM, which solids cool."""
    return smoothstep(share / FILM - 1.0)


@point
def gas_growth(p, target, exponent):
    """(growth of the volume of a gas from the pressure p to target, decrease of that with target), p v^exponent constant.

    A step may close a film of gas altogether. Along a straight line with its modulus K at the start, it would take part in that
    no further than to p + K, and meet the pressure at which solids give way with nearly all of its volume.
    """
    if target <= p * (1.0 + MOST_GROWTH) ** -exponent:
        return MOST_GROWTH, 1.0 / (exponent * p)
    size = max((p / target) ** (1.0 / exponent), LEAST_LEFT)
    return size - 1.0, size / (exponent * target)


@point
def gas_work(p, growth, exponent):
    """Work of a gas from the pressure p on its own growth along `gas_growth`, Pa: over its volume before."""
    less = exponent - 1.0
    if less < 1e-6:
        return p * log(1.0 + growth)
    return p * (1.0 - (1.0 + growth) ** -less) / less


@point
def tied_work(i, by_r, by_z, b0, t0, b1, t1):
    """Work of the ties of cell i against one component of its vertices' velocities, J per radian: at the start, at the end."""
    low, high = b0[i + 1] - b0[i], t0[i + 1] - t0[i]
    left, right = t0[i] - b0[i], t0[i + 1] - b0[i + 1]
    along_r = low * (low + (b1[i + 1] - b1[i])) + high * (high + (t1[i + 1] - t1[i]))
    along_z = left * (left + (t1[i] - b1[i])) + right * (right + (t1[i + 1] - b1[i + 1]))
    return 0.5 * (by_r * along_r + by_z * along_z)
