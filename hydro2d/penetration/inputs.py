"""Inputs that the models share. A model changes a default with ``but``."""

from __future__ import annotations

from typing import Any

from hydro2d.base.parameters import ANY, FRACTION, NON_NEGATIVE, Required
from hydro2d.noses.base import Shaped
from hydro2d.noses.registry import BY_NAME, owners, shaped
from hydro2d.penetration.model import Input, InputError, positive

ROD_DENSITY = Input("rod.density", "kg/m^3", "density of the rod", "rho_p")
ROD_STRENGTH = Input("rod.strength", "Pa", "flow stress of the rod, against rigid-body motion or erosion", "Y_p")
ROD_ULTIMATE_STRENGTH = Input("rod.ultimate_strength", "Pa", "ultimate flow stress of the rod's material", "Y_pu")
ROD_YOUNGS_MODULUS = Input("rod.youngs_modulus", "Pa", "Young's modulus of the rod", "E_p")
ROD_POISSON_RATIO = Input("rod.poisson_ratio", "1", "Poisson's ratio of the rod", "nu_p", sign=FRACTION)
ROD_SOUND_SPEED = Input("rod.sound_speed", "m/s", "intercept of the rod's Hugoniot Us = c0 + k up", "c0_p")
ROD_HUGONIOT_SLOPE = Input("rod.hugoniot_slope", "1", "slope of the rod's Hugoniot", "k_p", sign=NON_NEGATIVE)
ROD_DIAMETER = Input("rod.diameter", "m", "diameter of the shank", "D")
ROD_LENGTH = Input("rod.length", "m", "length of a cylinder of the rod's diameter and mass", "L")
ROD_MASS = Input("rod.mass", "kg", "mass of the rod", "M")

#: the nose and the keys of every kind, of which a kind takes its own; one without a default must be given if its kind is chosen
NOSE = (
    Input("nose.shape", "", "shape of the nose", default="hemispherical", choices=tuple(BY_NAME)),
    *(Input(f"nose.{key.name}", key.unit or "1", f"{' or '.join(names)} nose: {key.description}", key.symbol,
            None if isinstance(key.default, Required) else key.default, key.sign) for key, names in owners().items()),
)
FRICTION = Input("friction", "1", "coefficient of sliding friction on the nose", "mu", default=0.0, sign=NON_NEGATIVE)

TARGET_DENSITY = Input("target.density", "kg/m^3", "density of the target", "rho_t")
TARGET_STRENGTH = Input("target.strength", "Pa", "yield stress of the target", "Y_t")
TARGET_HARDENING_EXPONENT = Input(
    "target.hardening_exponent", "1", "exponent n of power-law hardening Y (E eps/Y)^n", "n", default=0.0, sign=FRACTION)
TARGET_YOUNGS_MODULUS = Input("target.youngs_modulus", "Pa", "Young's modulus of the target", "E_t")
TARGET_POISSON_RATIO = Input("target.poisson_ratio", "1", "Poisson's ratio of the target", "nu_t", sign=FRACTION)
TARGET_SHEAR_MODULUS = Input("target.shear_modulus", "Pa", "shear modulus of the target", "G_t")
TARGET_SOUND_SPEED = Input("target.sound_speed", "m/s", "intercept of the target's Hugoniot", "c0_t")
TARGET_HUGONIOT_SLOPE = Input("target.hugoniot_slope", "1", "slope of the target's Hugoniot", "k_t", sign=NON_NEGATIVE)
TARGET_THICKNESS = Input("target.thickness", "m", "thickness of the plate", "T")
TARGET_RESISTANCE = Input("target.resistance", "Pa", "resistance of the target; from cavity expansion where not given",
                          "R_t", default=None)
CAVITY_A = Input("cavity.a", "1", "A of the cavity pressure A Y + B rho V^2; from the target if not given", "A", default=None)
CAVITY_B = Input("cavity.b", "1", "B of the cavity pressure A Y + B rho V^2; from the target if not given", "B", default=None,
                 sign=NON_NEGATIVE)
OBLIQUITY = Input("obliquity", "rad", "angle between the line of flight and the target's normal", "beta", default=0.0, sign=ANY)

#: inputs that the material library can give, by the last part of the name
FROM_LIBRARY = (
    "density", "strength", "ultimate_strength", "hardening_exponent", "youngs_modulus", "poisson_ratio", "shear_modulus",
    "sound_speed", "hugoniot_slope",
)


def nose(name: str, diameter: float, **keys: float | None) -> Shaped:
    """A nose on a shank of this diameter (m).

    keys : of any kinds, of which this kind takes its own; None: not given. InputError for impossible values.
    """
    positive(diameter=diameter)
    own = {key.name for key in BY_NAME[name].keys} if name in BY_NAME else set()
    try:
        return shaped(name, 0.5 * diameter, {key: value for key, value in keys.items() if key in own and value is not None})
    except ValueError as problem:
        raise InputError(f"nose: {problem}") from None


def taken_nose(values: dict[str, Any]) -> Shaped:
    """The nose of the inputs of a model by keyword; removes those of ``NOSE`` and rod_diameter from them."""
    word, *keys = (each.keyword for each in NOSE)
    given = {key.removeprefix("nose_"): values.pop(key) for key in keys}
    return nose(values.pop(word), values.pop("rod_diameter"), **given)
