"""Chooses strength and damage models by their integer ids.

A new model is one more entry of ``STRENGTH_MODULES`` or ``DAMAGE_MODULES`` and one more line in the chains below.
"""

from __future__ import annotations

from hydro2d.jit import point
from strength import (
    elastic_plastic,
    hydrodynamic,
    johnson_cook,
    johnson_cook_damage,
    no_damage,
    power_law,
    steinberg_guinan,
)
from strength.layout import SHEAR, YIELD

STRENGTH_MODULES = (hydrodynamic, elastic_plastic, johnson_cook, steinberg_guinan, power_law)
DAMAGE_MODULES = (no_damage, johnson_cook_damage)

#: ids of the models whose shear modulus is the number in slot SHEAR, whatever the state: no cell need be evaluated
CONSTANT_MODULUS = tuple(module.ID for module in STRENGTH_MODULES if module.CONSTANT_MODULUS)


@point
def shear_modulus(model, p, rho, T, par):
    """Shear modulus of the strength model ``model`` at pressure, density and temperature, Pa.

    ``par`` is the material's row, float64[ROW]. An unknown ``model`` gives NaN.
    """
    if model == hydrodynamic.ID:
        return hydrodynamic.shear_modulus(p, rho, T, par)
    if model == elastic_plastic.ID:
        return elastic_plastic.shear_modulus(p, rho, T, par)
    if model == johnson_cook.ID:
        return johnson_cook.shear_modulus(p, rho, T, par)
    if model == steinberg_guinan.ID:
        return steinberg_guinan.shear_modulus(p, rho, T, par)
    if model == power_law.ID:
        return power_law.shear_modulus(p, rho, T, par)
    return float("nan")


@point
def modulus_row(model, par, first, number, p, rho, T, shear):
    """Fills shear[first:first + number] with ``shear_modulus``, Pa, from rows of pressure, density and temperature.

    In a cell without material, at density 0, it is any finite number.
    """
    if model in CONSTANT_MODULUS:
        constant = par[SHEAR]
        for x in range(number):
            shear[first + x] = constant
    else:
        for x in range(number):
            i = first + x
            shear[i] = shear_modulus(model, p[i], rho[i], T[i], par) if rho[i] > 0.0 else 0.0


@point
def flow_stress(model, ep, rate, T, p, rho, par):
    """Flow stress of the strength model ``model``, Pa.

    ``ep`` plastic strain, ``rate`` its rate (1/s), ``T`` temperature (K), ``p`` pressure (compression positive, Pa),
    ``rho`` density (kg/m^3), ``par`` the material's row, float64[ROW]. An unknown ``model`` gives NaN.
    """
    if model == hydrodynamic.ID:
        return hydrodynamic.flow_stress(ep, rate, T, p, rho, par)
    if model == elastic_plastic.ID:
        return elastic_plastic.flow_stress(ep, rate, T, p, rho, par)
    if model == johnson_cook.ID:
        return johnson_cook.flow_stress(ep, rate, T, p, rho, par)
    if model == steinberg_guinan.ID:
        return steinberg_guinan.flow_stress(ep, rate, T, p, rho, par)
    if model == power_law.ID:
        return power_law.flow_stress(ep, rate, T, p, rho, par)
    return float("nan")


@point
def yield_floor(model, par):
    """A stress that the flow stress never falls below, Pa: 0 for models that soften. Saves evaluating it in elastic cells."""
    if model == power_law.ID:
        return par[YIELD]
    if model == elastic_plastic.ID and par[elastic_plastic.INVERSE_RANGE] == 0.0 and par[elastic_plastic.HARDENING] >= 0.0:
        return par[YIELD]
    return 0.0


@point
def feels_temperature(model, damage_model):
    """Whether the temperature is asked for at all."""
    return not (damage_model == no_damage.ID and (model == hydrodynamic.ID or model == power_law.ID))


@point
def damage_increment(model, dep, rate, T, p, seq, par):
    """Increment of damage of the damage model ``model``: see ``johnson_cook_damage.damage_increment``."""
    if model == no_damage.ID:
        return no_damage.damage_increment(dep, rate, T, p, seq, par)
    if model == johnson_cook_damage.ID:
        return johnson_cook_damage.damage_increment(dep, rate, T, p, seq, par)
    return float("nan")
