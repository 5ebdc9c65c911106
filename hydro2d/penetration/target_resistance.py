"""Resistance of a target to penetration, from quasi-static cavity expansion or Tate's solenoidal flow.

Five closed forms for an elastic, perfectly plastic target: a spherical or a cylindrical cavity that opens slowly in an
incompressible or a compressible solid, and the flow of Tate, shaped like the field of a solenoid. Anderson, Int. J. Impact
Engng 108 (2017) 3, Table 1. All give 3 to 6 times the yield stress of a metal. No form contains the velocity, although
the measured resistance depends on it. explanation/penetration/target-resistance.
"""

from __future__ import annotations

import math

from hydro2d.base.parameters import FRACTION, NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, complain, positive

#: Tate's share of dynamic effects in the flow stress, lambda: Anderson (2017), section 6.4
DYNAMIC_FACTOR = 0.7


def spherical_incompressible(*, strength: float, youngs_modulus: float) -> float:
    """R_t = (2/3) Y [1 + ln(2 E/(3 Y))], Pa; explanation/penetration/target-resistance, equation 1.

    Y: yield stress, Pa; E: Young's modulus, Pa. For E/Y well above 1, as for all metals.
    """
    positive(strength=strength, youngs_modulus=youngs_modulus)
    return _checked(2.0 / 3.0 * strength * (1.0 + math.log(2.0 * youngs_modulus / (3.0 * strength))))


def cylindrical_incompressible(*, strength: float, youngs_modulus: float) -> float:
    """R_t = (Y/sqrt(3)) [1 + ln(sqrt(3) E/(3 Y))], Pa; explanation/penetration/target-resistance, equation 2."""
    positive(strength=strength, youngs_modulus=youngs_modulus)
    return _checked(strength / math.sqrt(3.0) * (1.0 + math.log(youngs_modulus / (math.sqrt(3.0) * strength))))


def spherical_compressible(*, strength: float, youngs_modulus: float, poisson_ratio: float) -> float:
    """R_t = (2/3) Y [1 + ln(E/(3 (1 - nu) Y))], Pa; explanation/penetration/target-resistance, equation 3.

    nu: Poisson's ratio; with nu = 1/2 this is ``spherical_incompressible``.
    """
    positive(strength=strength, youngs_modulus=youngs_modulus)
    complain("poisson_ratio", poisson_ratio, FRACTION)
    ratio = youngs_modulus / (3.0 * (1.0 - poisson_ratio) * strength)
    return _checked(2.0 / 3.0 * strength * (1.0 + math.log(ratio)))


def cylindrical_compressible(*, strength: float, youngs_modulus: float, poisson_ratio: float) -> float:
    """R_t = (Y/sqrt(3)) [1 + ln(sqrt(3) E/(6 (1 - nu) Y))], Pa; explanation/penetration/target-resistance, equation 4."""
    positive(strength=strength, youngs_modulus=youngs_modulus)
    complain("poisson_ratio", poisson_ratio, FRACTION)
    ratio = math.sqrt(3.0) * youngs_modulus / (6.0 * (1.0 - poisson_ratio) * strength)
    return _checked(strength / math.sqrt(3.0) * (1.0 + math.log(ratio)))


def solenoidal(*, strength: float, youngs_modulus: float, dynamic_factor: float = DYNAMIC_FACTOR) -> float:
    """R_t = Y [2/3 + ln(2 E/((4 - exp(-lambda)) Y))], Pa; explanation/penetration/target-resistance, equation 5.

    lambda: share of dynamic effects in the flow stress; Tate's 0.7 makes the argument of the logarithm 0.57 E/Y.
    """
    positive(strength=strength, youngs_modulus=youngs_modulus)
    complain("dynamic_factor", dynamic_factor, NON_NEGATIVE)
    ratio = 2.0 * youngs_modulus / ((4.0 - math.exp(-dynamic_factor)) * strength)
    return _checked(strength * (2.0 / 3.0 + math.log(ratio)))


#: the forms by name, and the input that each needs in addition to strength and Young's modulus
FORMS = {
    "spherical-incompressible": (spherical_incompressible, None),
    "cylindrical-incompressible": (cylindrical_incompressible, None),
    "spherical-compressible": (spherical_compressible, "poisson_ratio"),
    "cylindrical-compressible": (cylindrical_compressible, "poisson_ratio"),
    "solenoidal": (solenoidal, "dynamic_factor"),
}


def _checked(resistance: float) -> float:
    if resistance <= 0.0:
        raise InputError("target.strength is not small compared with target.youngs_modulus: no form of cavity expansion holds")
    return resistance


def resistance_of(
    *, target_resistance: float | None, target_resistance_form: str = "solenoidal", target_strength: float | None = None,
    target_youngs_modulus: float | None = None, target_poisson_ratio: float | None = None,
    target_dynamic_factor: float = DYNAMIC_FACTOR,
) -> float:
    """The resistance, Pa: as given, or from the chosen form. InputError names the inputs that the form lacks."""
    if target_resistance is not None:
        return target_resistance
    form, extra = FORMS[target_resistance_form]
    values = {"strength": target_strength, "youngs_modulus": target_youngs_modulus}
    if extra is not None:
        values[extra] = {"poisson_ratio": target_poisson_ratio, "dynamic_factor": target_dynamic_factor}[extra]
    missing = [f"target.{name}" for name, value in values.items() if value is None]
    if missing:
        raise InputError(f"target.resistance is not given: the form {target_resistance_form} needs {', '.join(missing)}")
    return form(**values)


def evaluate(velocity: float, *, target_strength: float, target_youngs_modulus: float, target_poisson_ratio: float,
             target_dynamic_factor: float) -> dict[str, float]:
    """All five resistances; they do not depend on the velocity."""
    given = {
        "strength": target_strength, "youngs_modulus": target_youngs_modulus,
        "poisson_ratio": target_poisson_ratio, "dynamic_factor": target_dynamic_factor,
    }
    resistances = {}
    for name, (form, extra) in FORMS.items():
        needed = ("strength", "youngs_modulus") + ((extra,) if extra else ())
        resistances[name.replace("-", "_")] = form(**{key: given[key] for key in needed})
    return resistances


DYNAMIC_FACTOR_INPUT = Input(
    "target.dynamic_factor", "1", "share of dynamic effects in the target's flow stress, of the solenoidal form", "lambda",
    default=DYNAMIC_FACTOR, sign=NON_NEGATIVE)
#: inputs of models whose resistance is given or comes from a form; keywords of ``resistance_of``
RESISTANCE_INPUTS = (
    inputs.TARGET_RESISTANCE.but(description="resistance of the target; from target.resistance_form where not given"),
    Input("target.resistance_form", "", "the form that gives the resistance from strength and stiffness", "",
          default="solenoidal", choices=tuple(FORMS)),
    inputs.TARGET_STRENGTH.but(default=None),
    inputs.TARGET_YOUNGS_MODULUS.but(default=None),
    inputs.TARGET_POISSON_RATIO.but(default=None),
    DYNAMIC_FACTOR_INPUT,
)

MODEL = Model(
    name="target-resistance",
    title="Resistance of a target by quasi-static cavity expansion and by Tate's solenoidal flow",
    source="Anderson, Int. J. Impact Engng 108 (2017) 3, Table 1; Hill (1950); Tate, Int. J. Mech. Sci. 28 (1986) 599",
    validity="elastic, perfectly plastic metals with E/Y well above 1; no effect of hardening, strain rate or velocity",
    inputs=(inputs.TARGET_STRENGTH, inputs.TARGET_YOUNGS_MODULUS, inputs.TARGET_POISSON_RATIO, DYNAMIC_FACTOR_INPUT),
    outputs=tuple(
        Output(name.replace("-", "_"), "Pa", f"resistance by the {name} form", "R_t") for name in FORMS
    ),
    main="solenoidal",
    example=Example(rod="W_alloy", target="Al5083", velocity=1086.0, velocities=(0.0, 2000.0)),
    evaluate=evaluate,
)
