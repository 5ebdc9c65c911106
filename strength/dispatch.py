"""Selects strength and damage models by their integer ids.

The models are those in ``registry`` when this module is imported, together with the kernels.
"""

from __future__ import annotations

from hydro2d.jit import by_id, point, rows_by_id
from strength import melting, registry
from strength.lanes import DENSITY, FLOW, HARDENED, HEAT, PRESSURE, RATE
from strength.layout import SHEAR

STRENGTH_MODULES = registry.chosen()
DAMAGE_MODULES = registry.chosen_damage()

#: ids of the models whose shear modulus is the number in slot SHEAR in every state: no cell need be evaluated
CONSTANT_MODULUS = tuple(module.ID for module in STRENGTH_MODULES if module.CONSTANT_MODULUS)
#: ids of the models that use the temperature
THERMAL = tuple(module.ID for module in STRENGTH_MODULES if module.THERMAL)
#: ids of the models that have internal variables
WITH_INTERNAL = tuple(module.ID for module in STRENGTH_MODULES if hasattr(module, "INTERNAL"))
#: ids of the models whose flow stress falls with damage, down to a strength that crushed material keeps
WEAKENS = tuple(module.ID for module in STRENGTH_MODULES if hasattr(module, "weakened"))
#: ids of the damage models that open cracks, and whose tension falls as they open
OPENS_CRACKS = tuple(module.ID for module in DAMAGE_MODULES if hasattr(module, "tension_left"))
DAMAGE_THERMAL = tuple(module.ID for module in DAMAGE_MODULES if module.THERMAL)

shear_modulus = by_id(
    STRENGTH_MODULES, "shear_modulus", registry.STRENGTH_FUNCTIONS["shear_modulus"][0],
    "Shear modulus of a strength model at pressure, density and temperature, Pa. par: the material's row, float64[ROW].")

flow_stress = by_id(
    STRENGTH_MODULES, "flow_stress", registry.STRENGTH_FUNCTIONS["flow_stress"][0],
    "Flow stress of a strength model, Pa: ep plastic strain, rate (1/s), T (K), p (compression positive, Pa), rho (kg/m^3).")

flow_row = rows_by_id(
    STRENGTH_MODULES, "flow_stress", "flow_row", "number, par, lanes", "k in range(number)",
    ", ".join([*(f"lanes[{row} + k]" for row in (HARDENED, RATE, HEAT, PRESSURE, DENSITY)), "par"]), f"lanes[{FLOW} + k]",
    "Flow stresses of the first number cells in lanes (strength/lanes.py), Pa, at HARDENED and RATE.")

weakened = by_id(
    STRENGTH_MODULES, "weakened", registry.STRENGTH_FUNCTIONS["weakened"][0],
    "Flow stress of a strength model, Pa, of damaged material: from that of intact material, rate (1/s), p (Pa) and damage.",
    "flow")

yield_floor = by_id(
    STRENGTH_MODULES, "yield_floor", registry.STRENGTH_FUNCTIONS["yield_floor"][0],
    "A stress that the flow stress never falls below, Pa: 0 for models that soften. Saves evaluating it in elastic cells.",
    "0.0")

turn = by_id(
    STRENGTH_MODULES, "turn", registry.STRENGTH_FUNCTIONS["turn"][0],
    "Turns those internal variables of a strength model that are tensors by spin = W dt. internal: float64[n], one cell's.",
    "None")

back_stress = by_id(
    STRENGTH_MODULES, "back_stress", registry.STRENGTH_FUNCTIONS["back_stress"][0],
    "(rr, zz, rz) of the deviator around which a strength model's yield surface lies, Pa: the origin for most models.",
    "(0.0, 0.0, 0.0)")

kinematic_modulus = by_id(
    STRENGTH_MODULES, "kinematic_modulus", registry.STRENGTH_FUNCTIONS["kinematic_modulus"][0],
    "Shift of the centre of the yield surface per plastic strain, as a tensile stress, Pa: 0 for most models.", "0.0")

melted = by_id(
    STRENGTH_MODULES, "melted", registry.STRENGTH_FUNCTIONS["melted"][0],
    "Internal variables of a strength model after the material has melted. internal: float64[n], one cell's.", "None")

harden = by_id(
    STRENGTH_MODULES, "harden", registry.STRENGTH_FUNCTIONS["harden"][0],
    "Internal variables after the plastic strain dep along the direction (rr, zz, rz), whose von Mises norm is 1.", "None")

damage_increment = by_id(
    DAMAGE_MODULES, "damage_increment", registry.DAMAGE_FUNCTIONS["damage_increment"][0],
    "Increment of damage of a damage model: see ``johnson_cook_damage.damage_increment``.")

size_factor = by_id(
    DAMAGE_MODULES, "size_factor", registry.DAMAGE_FUNCTIONS["size_factor"][0],
    "Factor on the increment of damage of a damage model in a cell of this area, m^2: 1 if the cell does not matter.", "1.0")

tension_left = by_id(
    DAMAGE_MODULES, "tension_left", registry.DAMAGE_FUNCTIONS["tension_left"][0],
    "Share of the fracture pressure that material bears at a damage below 1, of a damage model that opens cracks.")

full_opening = by_id(
    DAMAGE_MODULES, "full_opening", registry.DAMAGE_FUNCTIONS["full_opening"][0],
    "Volume of cracks per crack area at which the damage is 1, m, of a damage model that opens cracks.")


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
def end_at_melt(line, first, number, rho, T, shear):
    """Sets shear[first:first + number], Pa, to zero where material has reached its melting line (strength/melting.py)."""
    if melting.melts(line):
        for x in range(number):
            i = first + x
            shear[i] = melting.solid_modulus(shear[i], rho[i], T[i], line) if rho[i] > 0.0 else 0.0


@point
def feels_temperature(model, damage_model, line):
    """Whether anything here needs the temperature: the strength model, the damage model or the melting line."""
    return model in THERMAL or damage_model in DAMAGE_THERMAL or melting.melts(line)
