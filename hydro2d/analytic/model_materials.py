"""The numbers that analytic models need from a material of the library, each with its source."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hydro2d.materials import curves, library
from hydro2d.penetration.model import InputError, Value

#: state of the flow stress: plastic strain rate in 1/s, and the plastic strain that counts as "ultimate"
RATE, ULTIMATE_STRAIN = 1.0, 1.0


@dataclass(frozen=True)
class Given:
    """The value of an input in SI, and its source."""

    value: Value
    source: str


def quantities(material: library.Material, strain: float = 0.0) -> dict[str, Given]:
    """Inputs that the material has, by the last part of their name (``inputs.FROM_LIBRARY``).

    ``strain`` is the equivalent plastic strain at which the strength is evaluated; 0 is initial yield. A strength at a positive
    strain includes the hardening, so that the hardening exponent is 0 there. Raises InputError.
    """
    if not (math.isfinite(strain) and strain >= 0.0):
        raise InputError(f"strain = {strain:g}: must be non-negative")
    if problem := material.strength.unread("strength"):
        raise InputError(f"{material.name}: {problem}")
    return {**_equation_of_state(material), **_elastic(material), **_strength(material, strain)}


def _printed(material: library.Material, part: str, name: str) -> str:
    model = getattr(material, part)
    return f"{material.name}: {name} of {model.name} ({model.numbers[name].confidence})"


def _equation_of_state(material: library.Material) -> dict[str, Given]:
    """Density, sound speed and, where it is a straight line, the slope of the Hugoniot."""
    numbers = material.eos.numbers
    if (curvature := numbers.get("hugoniot_slope_2")) is not None and curvature.value != 0.0:
        numbers = {name: number for name, number in numbers.items() if name != "hugoniot_slope"}
    names = {"density": "reference_density", "sound_speed": "sound_speed", "hugoniot_slope": "hugoniot_slope"}
    return {
        key: Given(numbers[name].value, _printed(material, "eos", name)) for key, name in names.items() if name in numbers
    }


def _elastic(material: library.Material) -> dict[str, Given]:
    """Shear modulus, Young's modulus and Poisson's ratio: those of the strength model, or with K = rho0 c0^2."""
    if not material.has_strength:
        return {}
    model, row, state = curves.at_rest(material)
    G = float(model.shear_modulus(*state, row))
    values = {"shear_modulus": Given(G, f"{material.name}: shear modulus of {material.strength.name} at rest")}
    own = material.strength.numbers
    if "youngs_modulus" in own and "poisson_ratio" in own:
        for key in ("youngs_modulus", "poisson_ratio"):
            values[key] = Given(own[key].value, _printed(material, "strength", key))
    elif "sound_speed" in material.eos.numbers:
        K = material.reference_density * material.eos.numbers["sound_speed"].value ** 2
        from_both = f"{material.name}: from the shear modulus and the bulk modulus rho0 c0^2 = {K / 1e9:.4g} GPa"
        values["youngs_modulus"] = Given(9.0 * K * G / (3.0 * K + G), from_both)
        values["poisson_ratio"] = Given((3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G)), from_both)
    return values


def _strength(material: library.Material, strain: float) -> dict[str, Given]:
    name = material.strength.name
    if not material.has_strength:
        return {"strength": Given(0.0, f"{material.name}: {name}, no strength")}
    model, row, (p, rho, T) = curves.at_rest(material)

    def flow_stress(at: float) -> Given:
        source = f"{material.name}: {name} at plastic strain {at:g}, {RATE:g}/s, {T:g} K"
        return Given(float(model.flow_stress(at, RATE, T, p, rho, row)), source)

    return {
        "strength": flow_stress(strain),
        "ultimate_strength": flow_stress(ULTIMATE_STRAIN),
        "hardening_exponent": _hardening(material, strain),
    }


def _hardening(material: library.Material, strain: float) -> Given:
    if material.strength.name != "power-law":
        return Given(0.0, f"{material.name}: {material.strength.name} is not a power law")
    if strain > 0.0:
        return Given(0.0, f"{material.name}: the strength at plastic strain {strain:g} includes hardening")
    return Given(material.strength.numbers["hardening_exponent"].value, _printed(material, "strength", "hardening_exponent"))
