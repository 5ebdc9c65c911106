"""Strength and failure of solids: one file per model, scalar functions that the kernels inline.

``STRENGTH_MODELS`` and ``DAMAGE_MODELS`` map the name used in a deck to its module. Kernels call ``dispatch`` and
``radial_return``. A strength row has ``ROW`` numbers and a damage row ``DAMAGE_ROW``; in a strength row, slot ``SHEAR``
is the shear modulus and slot ``YIELD`` the yield stress of the virgin material at rest, in every model.
"""

from __future__ import annotations

from hydro2d.base.parameters import REQUIRED, Description, Parameter, by_name, described
from strength import tensile_pressure
from strength.layout import DAMAGE_ROW, ROW, SHEAR, YIELD
from strength.registry import DAMAGE_MODELS, STRENGTH_MODELS

__all__ = [
    "DAMAGE_MODELS",
    "DAMAGE_ROW",
    "REQUIRED",
    "ROW",
    "SHEAR",
    "STRENGTH_MODELS",
    "YIELD",
    "Description",
    "Parameter",
    "describe",
    "describe_damage",
]


def describe(name: str) -> Description:
    """Equation, source, validity and parameters of a strength model; ValueError for an unknown name."""
    return described(by_name(name, "strength model", STRENGTH_MODELS), "strength model")


def describe_damage(name: str) -> Description:
    """`describe` for a damage model, or for ``tensile-pressure``."""
    models = {**DAMAGE_MODELS, tensile_pressure.NAME: tensile_pressure}
    return described(by_name(name, "failure model", models), "failure model")
