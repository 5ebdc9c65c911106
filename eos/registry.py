"""The equations of state: those in this folder, and those from outside, added before the kernels are loaded.

To add an equation of state, put a file in this folder and its name in ``MODULES``.
"""

from __future__ import annotations

from types import ModuleType

from hydro2d.jit import modules

MODULES = modules("eos", "mie_grueneisen", "ideal_gas", "stiffened_gas", "p_alpha", "tillotson", "johnson_holmquist", "jwl",
                  "tabular", "noble_abel_stiffened_gas")
#: models that no deck names: a material gets them with a model of another kind
BESIDE = modules("eos", "cracked")
MODELS = {module.NAME: module for module in MODULES}

#: functions of a model: their arguments and the number of values that they return
FUNCTIONS = {"evaluate": ("rho, e, par", 4)}
REQUIRED = ("evaluate",)
#: those of a model with internal variables, which `update` advances over a step
MEMORY_FUNCTIONS = {
    "evaluate": ("rho, e, internal, par", 4),
    "update": ("rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal", 0),
}
MEMORY_REQUIRED = ("evaluate", "update")

#: models from outside, as ``hydro2d/materials/outside.py`` adds them
ADDED: list[ModuleType] = []


def chosen() -> tuple[ModuleType, ...]:
    """The models that kernels choose among, in an order that does not depend on the order in which they were added."""
    return (*MODULES, *BESIDE, *sorted(ADDED, key=lambda module: module.ID))
