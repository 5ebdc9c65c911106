"""The elastic-plastic piston: a two-wave compression in uniaxial strain.

A wall moves at constant speed into a solid at rest with constant shear modulus G and yield stress Y. The deviator
follows the true strain, s_xx = -(4/3) G ln(rho/rho0), until |s_xx| = 2 Y/3; then it stays there. Two jumps travel: the
elastic precursor to the Hugoniot elastic limit and, behind it, the plastic shock, each with the jump conditions on the
whole stress sigma = p - s_xx (positive in compression). The Mie-Grueneisen pressure is linear in e, and so each state
follows in closed form from its density.

Source: Wilkins, Calculation of elastic-plastic flow, Methods in Computational Physics 3 (1964) 211; the same problem is
ExactPack's elastic-plastic piston with the hypoelastic model. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

from problems.verification.exact.impact import Solid


@dataclass(frozen=True)
class Stress:
    """State behind a jump: density, velocity, pressure, stress (compression positive), energy, speed of the jump."""

    rho: float
    u: float
    p: float
    sigma: float
    e: float
    speed: float


@dataclass(frozen=True)
class Piston:
    """Precursor and plastic shock, with the sound speeds that a release behind them has."""

    elastic: Stress
    plastic: Stress
    c_elastic_release: float
    c_bulk_release: float


def _behind(solid: Solid, ahead: Stress, rho: float, shear: float) -> Stress:
    """The state at density rho behind a jump, where sigma = p + shear.

    e - e1 = (sigma + sigma1)/2 (1/rho1 - 1/rho) with p = f(rho) + Gamma0 rho0 e, solved for p.
    """
    heat, volume_change = solid.gamma0 * solid.rho0, 1 / ahead.rho - 1 / rho
    known = solid.cold(rho) + heat * (ahead.e + (ahead.sigma + shear) / 2 * volume_change)
    p = known / (1 - heat * volume_change / 2)
    sigma = p + shear
    e = ahead.e + (ahead.sigma + sigma) / 2 * volume_change
    gained = math.sqrt(max((sigma - ahead.sigma) * volume_change, 0.0))
    speed = ahead.u + gained * rho / (rho - ahead.rho)
    return Stress(rho, ahead.u + gained, p, sigma, e, speed)


def piston(solid: Solid, shear_modulus: float, yield_stress: float, u: float) -> Piston:
    """Solves the piston; ValueError where u does not reach the elastic limit or the shock overruns the precursor."""
    rest = Stress(solid.rho0, 0.0, 0.0, 0.0, 0.0, 0.0)
    shear = 2 * yield_stress / 3
    elastic = _behind(solid, rest, solid.rho0 * math.exp(yield_stress / (2 * shear_modulus)), shear)
    if u <= elastic.u:
        raise ValueError(f"the piston at {u:g} m/s stays elastic: the limit is at {elastic.u:g} m/s")
    densest = 0.98 * solid.rho0 / (1 - 1 / solid.s)
    rho = brentq(
        lambda density: _behind(solid, elastic, density, shear).u - u, elastic.rho * (1 + 1e-9), densest, rtol=1e-15
    )
    plastic = _behind(solid, elastic, rho, shear)
    if plastic.speed >= elastic.speed:
        raise ValueError("the plastic shock overruns the precursor")
    bulk = solid.sound_speed_squared(plastic.rho, plastic.e)
    return Piston(elastic, plastic, math.sqrt(bulk + 4 * shear_modulus / (3 * plastic.rho)), math.sqrt(bulk))


def elastic(solid: Solid, shear_modulus: float, u: float) -> Stress:
    """The only jump ahead of a piston too slow for the solid to yield, at u > 0; the deviator follows the true strain."""
    rest = Stress(solid.rho0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def behind(rho: float) -> Stress:
        return _behind(solid, rest, rho, 4 / 3 * shear_modulus * math.log(rho / solid.rho0))

    squeezed = 1.0 + 2.0 * u / solid.c0
    return behind(brentq(lambda rho: behind(rho).u - u, solid.rho0 * (1 + 1e-12), solid.rho0 * squeezed, rtol=1e-15))


#: Wilkins' aluminium, Lieberman's aluminium, and copper: solid, shear modulus, yield stress.
ALUMINIUM = (Solid(2785.0, 5328.0, 1.338, 2.0), 27.6e9, 0.3e9)
ALUMINIUM_EXACTPACK = (Solid(2790.0, 5330.0, 1.34, 2.0), 28.6e9, 0.26e9)
COPPER = (Solid(8930.0, 3940.0, 1.49, 2.0), 45e9, 90e6)
