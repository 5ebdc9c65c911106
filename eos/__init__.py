"""Equations of state: one file each, scalar functions that the kernels inline.

``MODELS`` maps the name used in a deck to its module. Kernels call ``dispatch``. A row of parameters has ``ROW``
numbers; slot ``RHO0`` is the density at rest and slot ``E0`` the specific internal energy at rest, in every model.
"""

from __future__ import annotations

from eos.layout import E0, RHO0, ROW
from eos.registry import MODELS
from hydro2d.base.parameters import REQUIRED, Description, Parameter, by_name, described

__all__ = ["E0", "MODELS", "REQUIRED", "RHO0", "ROW", "Description", "Parameter", "describe"]


def describe(name: str) -> Description:
    """Equation, source, validity and parameters of an equation of state; ValueError for an unknown name."""
    return described(by_name(name, "equation of state", MODELS), "equation of state")
