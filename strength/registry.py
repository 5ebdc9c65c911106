"""The strength and damage models: those in this folder, and those from outside, added before the kernels are loaded.

To add a model, put a file in this folder and its name in ``STRENGTH_MODULES`` or ``DAMAGE_MODULES``.
"""

from __future__ import annotations

from types import ModuleType

from hydro2d.jit import modules

STRENGTH_MODULES = modules(
    "strength", "hydrodynamic", "elastic_plastic", "johnson_cook", "steinberg_guinan", "power_law",
    "kinematic_hardening", "zerilli_armstrong", "johnson_holmquist", "voce", "steinberg_lund", "preston_tonks_wallace")
DAMAGE_MODULES = modules("strength", "no_damage", "johnson_cook_damage", "johnson_holmquist_damage", "cochran_banner")
STRENGTH_MODELS = {module.NAME: module for module in STRENGTH_MODULES}
DAMAGE_MODELS = {module.NAME: module for module in DAMAGE_MODULES}

#: functions of a strength model: their arguments and the number of values that they return
STRENGTH_FUNCTIONS = {
    "shear_modulus": ("p, rho, T, par", 1),
    "flow_stress": ("ep, rate, T, p, rho, par", 1),
    "weakened": ("flow, rate, p, damage, par", 1),
    "yield_floor": ("par", 1),
    "turn": ("spin, internal", 0),
    "melted": ("internal", 0),
    "back_stress": ("internal", 3),
    "kinematic_modulus": ("par", 1),
    "harden": ("dep, rr, zz, rz, par, internal", 0),
}
STRENGTH_REQUIRED = ("shear_modulus", "flow_stress")
#: those of a damage model
DAMAGE_FUNCTIONS = {
    "damage_increment": ("dep, rate, T, p, seq, par", 1),
    "size_factor": ("area, par", 1),
    "tension_left": ("damage, par", 1),
    "full_opening": ("par", 1),
}
DAMAGE_REQUIRED = ("damage_increment",)

#: models from outside, as ``hydro2d/materials/outside.py`` adds them
STRENGTH_ADDED: list[ModuleType] = []
DAMAGE_ADDED: list[ModuleType] = []


def chosen() -> tuple[ModuleType, ...]:
    """The strength models that kernels choose among, in an order that does not depend on the order in which they were added."""
    return (*STRENGTH_MODULES, *sorted(STRENGTH_ADDED, key=lambda module: module.ID))


def chosen_damage() -> tuple[ModuleType, ...]:
    """The damage models that kernels choose among, likewise ordered."""
    return (*DAMAGE_MODULES, *sorted(DAMAGE_ADDED, key=lambda module: module.ID))
